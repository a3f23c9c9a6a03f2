// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include <imgui/imgui.h>

#include <deque>
#include <vector>

namespace thaw::editor {

/// What mouse and keyboard did, in order. A frame is given no more of it than it can tell apart, so that nothing is
/// lost or happens in another place where pictures come slowly: a key that went down and up between two of them, a
/// drag that was over before the next.
class InputQueue {
public:
    void moved(ImVec2 to) { events_.push_back({Event::move, 0, false, to}); }
    /// The pointer is not over the window any more.
    void left();
    /// button: 0 to 4. seconds: when, of any clock; what is a double click does not depend on how fast pictures come.
    void button(int button, bool down, double seconds);
    void scrolled(ImVec2 steps) { events_.push_back({Event::wheel, 0, false, steps}); }
    /// key: 0 to 511, as in ImGuiIO::KeysDown.
    void key(int key, bool down);
    void text(unsigned character) { events_.push_back({Event::text, int(character), false, {0, 0}}); }

    /// Into ImGuiIO what the next frame is to know; before ImGui::NewFrame. Keys that hold Ctrl, Shift, Alt and Super
    /// are named by keys.
    struct Modifiers {
        int ctrl[2], shift[2], alt[2], super[2];
    };
    void feed(const Modifiers& keys);
    /// Where the pointer went while that happened, the newest last.
    const std::vector<ImVec2>& trail() const { return trail_; }
    bool empty() const { return events_.empty(); }

private:
    struct Event {
        enum Kind { move, button, wheel, key, text } kind;
        int code;
        bool down;
        ImVec2 at;
        double seconds = 0;
    };
    std::deque<Event> events_;
    std::vector<ImVec2> trail_;
    ImVec2 at_{-1e30f, -1e30f};
    bool buttons_[5] = {};
    double clicked_[5] = {-1e9, -1e9, -1e9, -1e9, -1e9}; // when each went down last
};

} // namespace thaw::editor
