// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/widgets.h"

#include <cstdarg>
#include <cstring>

namespace thaw::editor::ui {

namespace {
Controls* noted = nullptr; // ImGui itself is one context for one thread

std::string nameOf(const char* label) {
    const char* hidden = std::strstr(label, "##");
    return hidden ? hidden + 2 : label;
}
} // namespace

void noteIn(Controls* controls) { noted = controls; }

void note(const std::string& name) {
    if (noted && ImGui::IsItemVisible()) noted->add(name, ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
}

bool button(const char* label, ImVec2 size) {
    const bool pressed = ImGui::Button(label, size);
    note(nameOf(label));
    return pressed;
}

bool toggle(const char* label, bool* on) {
    const bool changed = ImGui::Checkbox(label, on);
    note(nameOf(label));
    return changed;
}

bool choice(const char* label, bool chosen, ImVec2 size) {
    if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    const bool pressed = button(label, size);
    if (chosen) ImGui::PopStyleColor();
    return pressed;
}

void tip(const char* text, const char* key) {
    if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(24 * ImGui::GetFontSize());
    ImGui::TextUnformatted(text);
    if (key) ImGui::TextDisabled("%s", key);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void quiet(const char* text) { ImGui::TextDisabled("%s", text); }

void quietf(const char* format, ...) {
    va_list args;
    va_start(args, format);
    ImGui::TextDisabledV(format, args);
    va_end(args);
}

void value(const char* label, const char* format, ...) {
    field(label);
    va_list args;
    va_start(args, format);
    ImGui::TextV(format, args);
    va_end(args);
}

void beside(const char* label, float extra) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float end =
        ImGui::GetItemRectMax().x + style.ItemSpacing.x + ImGui::CalcTextSize(label, nullptr, true).x + extra;
    if (end < ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x) ImGui::SameLine();
}

bool section(const char* label, bool open) {
    const bool shown = ImGui::CollapsingHeader(label, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    note(nameOf(label));
    return shown;
}

void field(const char* label) {
    const float width = ImGui::GetWindowContentRegionMax().x;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(label);
    ImGui::SameLine(0.44f * width);
    ImGui::SetNextItemWidth(-1);
}

} // namespace thaw::editor::ui
