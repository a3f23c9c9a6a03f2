// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/gizmo.h"

#include "app/toolkit.h"
#include "view/math.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace thaw::editor {

using namespace thaw::view;

namespace {

constexpr float kPixels = 84, kNear = 9; // of the handle's arms; how near the pointer must be
constexpr int kRing = 48;
constexpr float kDegree = std::numbers::pi_v<float> / 180;

Vec3 axisOf(int i) { return {i == 0 ? 1.0f : 0, i == 1 ? 1.0f : 0, i == 2 ? 1.0f : 0}; }
ImU32 colorOf(int i, bool hot) {
    if (hot) return IM_COL32(255, 214, 64, 255);
    const ImU32 colors[] = {IM_COL32(235, 84, 84, 255), IM_COL32(110, 205, 96, 255), IM_COL32(92, 148, 255, 255)};
    return colors[i];
}

float distanceTo(ImVec2 p, ImVec2 a, ImVec2 b) {
    const float dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    const float u = square > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / square, 0.0f, 1.0f) : 0;
    return std::hypot(p.x - a.x - u * dx, p.y - a.y - u * dy);
}

/// Along an axis through a point, the place nearest to a ray.
float alongAxis(Vec3 origin, Vec3 axis, const Ray& ray) {
    const Vec3 w = origin - ray.origin;
    const float b = dot(axis, ray.direction), d = dot(axis, w), e = dot(ray.direction, w), square = 1 - b * b;
    return square > 1e-5f ? (b * e - d) / square : 0;
}

std::optional<Vec3> onPlane(Vec3 origin, Vec3 normal, const Ray& ray) {
    const float down = dot(normal, ray.direction);
    if (std::fabs(down) < 1e-4f) return {};
    const float t = dot(normal, origin - ray.origin) / down;
    if (!(t > 0)) return {};
    return ray.origin + ray.direction * t;
}

float snapped(float value, float step, bool on) { return on && step > 0 ? std::round(value / step) * step : value; }

} // namespace

Gizmo::Part Gizmo::partAt(Tool tool, const Lens& lens, Vec3 pivot, float size, ImVec2 at) const {
    const std::optional<ImVec2> middle = lens.project(pivot);
    if (!middle) return Part::none;
    if (tool == Tool::scale || tool == Tool::move)
        if (std::hypot(at.x - middle->x, at.y - middle->y) < kNear) return Part::screen;
    if (tool == Tool::scale)
        return std::fabs(std::hypot(at.x - middle->x, at.y - middle->y) - 0.8f * kPixels) < kNear ? Part::screen
                                                                                                  : Part::none;
    float best = kNear;
    Part part = Part::none;
    for (int i = 0; i < 3; ++i) {
        const Vec3 axis = axisOf(i), u = axisOf((i + 1) % 3), v = axisOf((i + 2) % 3);
        if (tool == Tool::move) {
            const std::optional<ImVec2> tip = lens.project(pivot + axis * size);
            if (tip)
                if (const float d = distanceTo(at, *middle, *tip); d < best) best = d, part = Part(1 + i);
            const std::optional<ImVec2> square = lens.project(pivot + (u + v) * (0.38f * size));
            if (square && std::hypot(at.x - square->x, at.y - square->y) < kNear) return Part(4 + i);
        } else {
            for (int k = 0; k < kRing; ++k) {
                const float a = 2 * std::numbers::pi_v<float> * float(k) / kRing,
                            b = 2 * std::numbers::pi_v<float> * float(k + 1) / kRing;
                const Vec3 p = pivot + u * (size * std::cos(a)) + v * (size * std::sin(a)),
                           q = pivot + u * (size * std::cos(b)) + v * (size * std::sin(b));
                const std::optional<ImVec2> x = lens.project(p), y = lens.project(q);
                if (!x || !y) continue;
                // Of two rings that cross on the screen the one in front.
                const float behind = length(p - lens.camera().eye) > length(pivot - lens.camera().eye) ? 2.0f : 0.0f;
                if (const float d = distanceTo(at, *x, *y) + behind; d < best) best = d, part = Part(1 + i);
            }
        }
    }
    return part;
}

void Gizmo::paint(Tool tool, const Lens& lens, Vec3 pivot, float size, ImDrawList& draw) const {
    const std::optional<ImVec2> middle = lens.project(pivot);
    if (!middle) return;
    if (tool == Tool::scale) {
        const ImU32 color = part_ == Part::screen ? colorOf(0, true) : IM_COL32(240, 240, 240, 230);
        draw.AddCircle(*middle, 0.8f * kPixels, color, kRing, 2.5f);
        draw.AddRectFilled({middle->x - 5, middle->y - 5}, {middle->x + 5, middle->y + 5}, color);
        return;
    }
    for (int i = 0; i < 3; ++i) {
        const Vec3 axis = axisOf(i), u = axisOf((i + 1) % 3), v = axisOf((i + 2) % 3);
        const ImU32 color = colorOf(i, part_ == Part(1 + i));
        if (tool == Tool::move) {
            const std::optional<ImVec2> tip = lens.project(pivot + axis * size);
            if (!tip) continue;
            draw.AddLine(*middle, *tip, color, 3);
            const float l = std::hypot(tip->x - middle->x, tip->y - middle->y);
            if (l > 4) {
                const ImVec2 d((tip->x - middle->x) / l, (tip->y - middle->y) / l);
                draw.AddTriangleFilled({tip->x + 9 * d.x, tip->y + 9 * d.y}, {tip->x - 5 * d.y, tip->y + 5 * d.x},
                                       {tip->x + 5 * d.y, tip->y - 5 * d.x}, color);
            }
            if (const std::optional<ImVec2> square = lens.project(pivot + (u + v) * (0.38f * size)))
                draw.AddRectFilled({square->x - 5, square->y - 5}, {square->x + 5, square->y + 5},
                                   colorOf(i, part_ == Part(4 + i)));
        } else {
            ImVec2 points[kRing];
            int count = 0;
            for (int k = 0; k < kRing; ++k) {
                const float a = 2 * std::numbers::pi_v<float> * float(k) / kRing;
                if (const auto p = lens.project(pivot + u * (size * std::cos(a)) + v * (size * std::sin(a))))
                    points[count++] = *p;
            }
            draw.AddPolyline(points, count, color, ImDrawFlags_Closed, 2.5f);
        }
    }
    draw.AddCircleFilled(*middle, 5, part_ == Part::screen ? colorOf(0, true) : IM_COL32(240, 240, 240, 255));
}

bool Gizmo::update(Studio& studio, const Lens& lens, const Pointer& pointer, ImDrawList& draw) {
    const Item item = studio.selection();
    const Tool tool = studio.tool;
    if ((tool != Tool::move && tool != Tool::turn && tool != Tool::scale) || !exists(studio.scene(), item) ||
        !hasPlace(item.kind)) {
        drop();
        return false;
    }
    const Vec3 at = pivotOf(studio.scene(), item);
    const float size = kPixels * lens.pixelSize(at);
    if (!grabbed_) {
        part_ = pointer.over ? partAt(tool, lens, at, size, pointer.at) : Part::none;
        if (pointer.pressed && part_ != Part::none) {
            grabbed_ = true, before_ = studio.scene(), pivot_ = at, from_ = pointer.at, shown_ = 0;
            ++drags_;
        }
    } else if (pointer.held) {
        drag(studio, lens, pointer);
    } else {
        studio.endGesture();
        drop();
    }
    paint(tool, lens, exists(studio.scene(), item) ? pivotOf(studio.scene(), item) : at, size, draw);
    if (grabbed_) {
        char text[48];
        std::snprintf(text, sizeof text,
                      tool == Tool::move   ? "%+.1f mm"
                      : tool == Tool::turn ? "%+.1f deg"
                                           : "x %.2f",
                      double(tool == Tool::move ? 1000 * shown_ : shown_));
        draw.AddText({pointer.at.x + 16, pointer.at.y + 12}, IM_COL32(255, 255, 255, 255), text);
    }
    return part_ != Part::none || grabbed_;
}

void Gizmo::drag(Studio& studio, const Lens& lens, const Pointer& pointer) {
    const Item item = studio.selection();
    const Tool tool = studio.tool;
    const bool snap = studio.settings.snap != pointer.ctrl;
    const Ray a = lens.ray(from_), b = lens.ray(pointer.at);
    const std::string gesture = "gizmo " + std::to_string(drags_), title = titleOf(studio.scene(), item);
    const auto apply = [&](const char* what, auto&& change) {
        studio.edit(
            std::string(what) + " " + title,
            [&](scene::Scene& s) {
                s = before_;
                change(s);
            },
            gesture);
    };
    if (tool == Tool::move) {
        Vec3 by{};
        const float step = studio.settings.snapStep;
        if (part_ >= Part::x && part_ <= Part::z) {
            const Vec3 axis = axisOf(int(part_) - int(Part::x));
            by = axis * snapped(alongAxis(pivot_, axis, b) - alongAxis(pivot_, axis, a), step, snap);
        } else {
            const Vec3 normal = part_ == Part::screen ? normalize(lens.camera().target - lens.camera().eye)
                                                      : axisOf(int(part_) - int(Part::yz));
            const std::optional<Vec3> p = onPlane(pivot_, normal, a), q = onPlane(pivot_, normal, b);
            if (!p || !q) return;
            by = *q - *p;
            by = {snapped(by.x, step, snap), snapped(by.y, step, snap), snapped(by.z, step, snap)};
        }
        // Towards the horizon a plane has no end.
        if (!(length(by) < 100 * lens.distance)) return;
        shown_ = length(by);
        apply("Move", [&](scene::Scene& s) { move(s, item, by); });
    } else if (tool == Tool::turn) {
        if (part_ < Part::x || part_ > Part::z) return;
        const int i = int(part_) - int(Part::x);
        const Vec3 axis = axisOf(i), u = axisOf((i + 1) % 3), v = axisOf((i + 2) % 3);
        const std::optional<Vec3> p = onPlane(pivot_, axis, a), q = onPlane(pivot_, axis, b);
        if (!p || !q) return;
        const auto angle = [&](Vec3 x) { return std::atan2(dot(x - pivot_, v), dot(x - pivot_, u)); };
        float by = angle(*q) - angle(*p);
        if (by > std::numbers::pi_v<float>) by -= 2 * std::numbers::pi_v<float>;
        if (by < -std::numbers::pi_v<float>) by += 2 * std::numbers::pi_v<float>;
        by = snapped(by, studio.settings.snapDegrees * kDegree, snap);
        shown_ = by / kDegree;
        const float s2 = std::sin(by / 2);
        const thawQuat q2{axis.x * s2, axis.y * s2, axis.z * s2, std::cos(by / 2)};
        apply("Turn", [&](scene::Scene& s) { turn(s, item, pivot_, q2); });
    } else {
        const std::optional<ImVec2> middle = lens.project(pivot_);
        if (!middle) return;
        const float was = std::max(std::hypot(from_.x - middle->x, from_.y - middle->y), 12.0f);
        // From the middle outwards is larger, from the middle sideways as well: no dead handle.
        const float is = was > 12.5f ? std::hypot(pointer.at.x - middle->x, pointer.at.y - middle->y)
                                     : 12 + (pointer.at.x - from_.x) * 0.12f;
        const float factor = std::clamp(snapped(is / was, 0.1f, snap), 0.01f, 100.0f);
        shown_ = factor;
        apply("Scale", [&](scene::Scene& s) { resize(s, item, pivot_, factor); });
    }
}

} // namespace thaw::editor
