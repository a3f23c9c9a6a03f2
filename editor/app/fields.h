// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Controls that edit the scene: each shows a value with its unit, takes part in undo (a drag is one step), keeps to its
// range, and says what it is when the pointer rests on it.
#pragma once

#include "app/studio.h"
#include "app/widgets.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace thaw::editor::ui {

struct Range {
    float low = 0, high = 1;
    const char* format = "%.3g"; // with its unit
    bool logarithmic = false;    // a slider for what spans decades
    float unit = 1;              // of what is shown: 1000 shows metres in millimetres
    float speed = 0;             // of dragging, in what is shown by pixel; 0: a slider from low to high
};

/// What else has to follow when a value changes, so that the scene stays one.
using Repair = std::function<void(scene::Scene&)>;

/// access: [](auto& scene) -> auto& { a float of it }. True when it was changed now.
template <class Access>
bool real(Studio& studio, const char* label, Access access, const Range& range, const char* help,
          const Repair& repair = {}) {
    float value = access(studio.scene()) * range.unit;
    field(label);
    ImGui::PushID(label);
    const float low = range.low * range.unit, high = range.high * range.unit;
    const ImGuiSliderFlags flags =
        ImGuiSliderFlags_AlwaysClamp | (range.logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
    const bool changed = range.speed > 0 ? ImGui::DragFloat("##v", &value, range.speed, low, high, range.format, flags)
                                         : ImGui::SliderFloat("##v", &value, low, high, range.format, flags);
    note(label);
    const bool ended = ImGui::IsItemDeactivatedAfterEdit();
    tip(help);
    ImGui::PopID();
    if (changed && std::isfinite(value))
        studio.edit(
            std::string("Set ") + label,
            [&](scene::Scene& s) {
                access(s) = std::clamp(value / range.unit, range.low, range.high);
                if (repair) repair(s);
            },
            std::string("field ") + label);
    if (ended) studio.endGesture();
    return changed;
}

/// Three numbers in a line.
template <class Access>
bool vector(Studio& studio, const char* label, Access access, float unit, float speed, const char* format, float limit,
            const char* help) {
    const thawVec3 was = access(studio.scene());
    float v[3] = {was.x * unit, was.y * unit, was.z * unit};
    field(label);
    ImGui::PushID(label);
    const bool changed = ImGui::DragFloat3("##v", v, speed, -limit * unit, limit * unit, format);
    note(label);
    const bool ended = ImGui::IsItemDeactivatedAfterEdit();
    tip(help);
    ImGui::PopID();
    if (changed && std::isfinite(v[0] + v[1] + v[2]))
        studio.edit(
            std::string("Set ") + label,
            [&](scene::Scene& s) {
                const auto keep = [&](float x) { return std::clamp(x / unit, -limit, limit); };
                access(s) = {keep(v[0]), keep(v[1]), keep(v[2])};
            },
            std::string("field ") + label);
    if (ended) studio.endGesture();
    return changed;
}

template <class Access> bool flag(Studio& studio, const char* label, Access access, const char* help) {
    bool value = access(studio.scene());
    field(label);
    ImGui::PushID(label);
    const bool changed = ImGui::Checkbox("##v", &value);
    note(label);
    tip(help);
    ImGui::PopID();
    if (changed) studio.edit(std::string("Set ") + label, [&](scene::Scene& s) { access(s) = value; });
    return changed;
}

template <class Access>
bool whole(Studio& studio, const char* label, Access access, int low, int high, const char* format, const char* help) {
    int value = access(studio.scene());
    field(label);
    ImGui::PushID(label);
    const bool changed = ImGui::SliderInt("##v", &value, low, high, format, ImGuiSliderFlags_AlwaysClamp);
    note(label);
    const bool ended = ImGui::IsItemDeactivatedAfterEdit();
    tip(help);
    ImGui::PopID();
    if (changed)
        studio.edit(
            std::string("Set ") + label, [&](scene::Scene& s) { access(s) = std::clamp(value, low, high); },
            std::string("field ") + label);
    if (ended) studio.endGesture();
    return changed;
}

/// One of some words; access gives something that an int can be made of and that can be made of one.
template <class Access>
bool words(Studio& studio, const char* label, Access access, const char* const* names, int count, const char* help) {
    int value = int(access(studio.scene()));
    field(label);
    ImGui::PushID(label);
    const bool changed = ImGui::Combo("##v", &value, names, count);
    note(label);
    tip(help);
    ImGui::PopID();
    if (changed)
        studio.edit(std::string("Set ") + label, [&](scene::Scene& s) {
            auto& to = access(s);
            to = std::remove_reference_t<decltype(to)>(value);
        });
    return changed;
}

template <class Access> bool color(Studio& studio, const char* label, Access access, const char* help) {
    const thawVec3 was = access(studio.scene());
    // Linear light in the file, what the eye takes for even on the screen.
    const auto shown = [](float x) { return std::pow(std::clamp(x, 0.0f, 1.0f), 1 / 2.2f); };
    float v[3] = {shown(was.x), shown(was.y), shown(was.z)};
    field(label);
    ImGui::PushID(label);
    const bool changed = ImGui::ColorEdit3("##v", v);
    note(label);
    const bool ended = ImGui::IsItemDeactivatedAfterEdit();
    tip(help);
    ImGui::PopID();
    if (changed)
        studio.edit(
            std::string("Set ") + label,
            [&](scene::Scene& s) {
                access(s) = {std::pow(v[0], 2.2f), std::pow(v[1], 2.2f), std::pow(v[2], 2.2f)};
            },
            std::string("field ") + label);
    if (ended) studio.endGesture();
    return changed;
}

/// A number that may be left to something else, as NaN or another value says.
template <class Access>
bool maybe(Studio& studio, const char* label, Access access, float none, float some, const char* otherwise,
           const Range& range, const char* help) {
    const float was = access(studio.scene());
    bool has = std::isnan(none) ? !std::isnan(was) : was != none;
    field(label);
    ImGui::PushID(label);
    const bool switched = ImGui::Checkbox("##on", &has);
    tip(help);
    if (switched) studio.edit(std::string("Set ") + label, [&](scene::Scene& s) { access(s) = has ? some : none; });
    ImGui::PopID();
    ImGui::SameLine();
    if (!has) {
        quiet(otherwise);
        return switched;
    }
    ImGui::PushID(label);
    float value = access(studio.scene()) * range.unit;
    ImGui::SetNextItemWidth(-1);
    const bool changed = ImGui::DragFloat("##v", &value, range.speed > 0 ? range.speed : 1, range.low * range.unit,
                                          range.high * range.unit, range.format, ImGuiSliderFlags_AlwaysClamp);
    note(label);
    const bool ended = ImGui::IsItemDeactivatedAfterEdit();
    tip(help);
    ImGui::PopID();
    if (changed && std::isfinite(value))
        studio.edit(
            std::string("Set ") + label,
            [&](scene::Scene& s) { access(s) = std::clamp(value / range.unit, range.low, range.high); },
            std::string("field ") + label);
    if (ended) studio.endGesture();
    return changed || switched;
}

} // namespace thaw::editor::ui
