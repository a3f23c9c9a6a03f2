// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include <imgui/imgui.h>

#include <map>
#include <string>

namespace thaw::editor {

/// Where controls are on the screen, by name, as of the last frame: for tests that click on them, and for the file of
/// --controls.
class Controls {
public:
    struct Place {
        float x = 0, y = 0, width = 0, height = 0; // pixels from the upper left corner
        bool operator==(const Place&) const = default;
    };
    void begin() { next_.clear(); }
    void end() {
        before_.swap(places_);
        places_.swap(next_);
    }
    void add(const std::string& name, ImVec2 low, ImVec2 high) {
        next_[name] = {low.x, low.y, high.x - low.x, high.y - low.y};
    }
    const std::map<std::string, Place>& all() const { return places_; }
    /// Whether it was there in the frame before too: a window that opens takes a frame to find its size.
    bool still(const std::string& name, const Place& place) const {
        const auto was = before_.find(name);
        return was != before_.end() && was->second == place;
    }

private:
    std::map<std::string, Place> places_, next_, before_;
};

namespace ui {

/// Where the following controls are noted; may be null.
void noteIn(Controls* controls);
/// Notes the last item by this name.
void note(const std::string& name);

/// The same as ImGui's, noted by their label, or by what follows ## in it.
bool button(const char* label, ImVec2 size = {0, 0});
bool toggle(const char* label, bool* on);
/// A button that shows that it is chosen.
bool choice(const char* label, bool chosen, ImVec2 size = {0, 0});
/// Of the last item, when the pointer rests on it. key: a shortcut, or null.
void tip(const char* text, const char* key = nullptr);
/// A line of text in a quieter colour.
void quiet(const char* text);
void quietf(const char* format, ...) IM_FMTARGS(1);
/// Label and value of a line of numbers.
void value(const char* label, const char* format, ...) IM_FMTARGS(2);
/// The next control stands beside the last one where it fits, else below it. label: that it will have; extra: pixels of
/// it beside its label.
void beside(const char* label, float extra);
/// A heading that folds; open at first.
bool section(const char* label, bool open = true);
/// Begins a line with its label at the left and the control at the right, which takes the rest.
void field(const char* label);

} // namespace ui
} // namespace thaw::editor
