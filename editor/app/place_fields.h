// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Fields of where something stands and what form it has.
#pragma once

#include "app/fields.h"

#include <cstring>

namespace thaw::editor {

constexpr float kDegrees = 180 / std::numbers::pi_v<float>;
inline const char* const kShapes[] = {"plane", "box", "sphere", "cylinder", "cone", "torus", "mesh"};

/// Degrees about x, y and z of a turn, in the order of scene::quatFromDegrees.
inline void eulerOf(const thawQuat& q, float out[3]) {
    const float sinY = std::clamp(2 * (q.w * q.y - q.z * q.x), -1.0f, 1.0f);
    out[0] = kDegrees * std::atan2(2 * (q.w * q.x + q.y * q.z), 1 - 2 * (q.x * q.x + q.y * q.y));
    out[1] = kDegrees * std::asin(sinY);
    out[2] = kDegrees * std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));
}

template <class Access> void rotationField(Studio& studio, Access access) {
    // What is typed stays what is typed: angles of one turn are not unique.
    static float degrees[3];
    static thawQuat of{0, 0, 0, 0};
    const thawQuat now = access(studio.scene());
    if (std::memcmp(&of, &now, sizeof of) != 0) eulerOf(now, degrees), of = now;
    ui::field("rotation");
    ImGui::PushID("rotation");
    if (ImGui::DragFloat3("##v", degrees, 0.5f, -360, 360, "%.1f°")) {
        const thawQuat to = scene::quatFromDegrees(double(degrees[0]), double(degrees[1]), double(degrees[2]));
        if (studio.edit(
                "Set rotation", [&](scene::Scene& s) { access(s) = to; }, "field rotation"))
            of = access(studio.scene());
    }
    ui::note("rotation");
    if (ImGui::IsItemDeactivatedAfterEdit()) studio.endGesture();
    ui::tip("Degrees about x, then y, then z.");
    ImGui::PopID();
}

template <class Access> void placementFields(Studio& studio, Access access) {
    ui::vector(
        studio, "position", [=](auto& s) -> auto& { return access(s).position; }, 1000, 0.5f, "%.1f", 1e4f,
        "Where its origin is, in mm: x, y (up), z.");
    rotationField(
        studio, [=](auto& s) -> auto& { return access(s).rotation; });
    ui::real(
        studio, "scale", [=](auto& s) -> auto& { return access(s).scale; }, {1e-6f, 1e6f, "x %.3g", false, 1, 0.005f},
        "Factor on its size. 0.001 for a mesh in millimetres.");
}

template <class Access> void shapeFields(Studio& studio, Access access, bool planes) {
    const scene::Shape shape = access(studio.scene());
    if (shape.type == scene::ShapeType::mesh) {
        ui::value("mesh", "%s", shape.meshFile.c_str());
        ui::tip("File of the mesh, beside the scene.");
    } else {
        int type = int(shape.type) - (planes ? 0 : 1);
        ui::field("shape");
        ImGui::PushID("shape");
        if (ImGui::Combo("##v", &type, kShapes + (planes ? 0 : 1), planes ? 6 : 5))
            studio.edit("Set shape", [&](scene::Scene& s) {
                scene::Shape& to = access(s);
                to.type = scene::ShapeType(type + (planes ? 0 : 1));
                to.tubeRadius = std::min(to.tubeRadius, 0.5f * to.radius);
            });
        ui::note("shape");
        ImGui::PopID();
    }
    const auto length = [&](const char* label, auto member, const char* help) {
        ui::real(
            studio, label, [=](auto& s) -> auto& { return access(s).*member; },
            {1e-5f, 1e3f, "%.1f mm", false, 1000, 0.2f}, help);
    };
    switch (shape.type) {
    case scene::ShapeType::box: {
        thawVec3 size = shape.size;
        float v[3] = {1000 * size.x, 1000 * size.y, 1000 * size.z};
        ui::field("size");
        ImGui::PushID("size");
        if (ImGui::DragFloat3("##v", v, 0.2f, 0.01f, 1e6f, "%.1f", ImGuiSliderFlags_AlwaysClamp))
            studio.edit(
                "Set size",
                [&](scene::Scene& s) {
                    const auto keep = [](float x) { return std::clamp(x / 1000, 1e-5f, 1e3f); };
                    access(s).size = {keep(v[0]), keep(v[1]), keep(v[2])};
                },
                "field size");
        ui::note("size");
        if (ImGui::IsItemDeactivatedAfterEdit()) studio.endGesture();
        ui::tip("Lengths of its edges in mm.");
        ImGui::PopID();
        break;
    }
    case scene::ShapeType::cylinder:
    case scene::ShapeType::cone:
        length("height", &scene::Shape::height, "Along its axis.");
        [[fallthrough]];
    case scene::ShapeType::sphere:
        length("radius", &scene::Shape::radius, "Of the round part.");
        break;
    case scene::ShapeType::torus:
        length("radius", &scene::Shape::radius, "Of the ring, to the middle of its tube.");
        length("tube radius", &scene::Shape::tubeRadius, "Of the tube; smaller than that of the ring.");
        break;
    default:
        break;
    }
}

} // namespace thaw::editor
