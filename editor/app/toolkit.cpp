// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/toolkit.h"

#include "model/lines.h"
#include "view/math.h"

#include <algorithm>
#include <cmath>

namespace thaw::editor {

using namespace thaw::view;

const char* ToolKit::help(Tool tool) {
    switch (tool) {
    case Tool::select:
        return "Click what you want to change. Right drag turns the view, Shift + right drag moves it, the wheel "
               "zooms.";
    case Tool::move:
        return "Drag an arrow, a square or the middle of the handle. Ctrl: in steps.";
    case Tool::turn:
        return "Drag a ring of the handle. Ctrl: in steps.";
    case Tool::scale:
        return "Drag the ring of the handle. Ctrl: in steps.";
    case Tool::path:
        return "Drag over a surface to draw where the melt runs. Drag a node to move it, double click the line for "
               "another, "
               "Delete takes it out.";
    case Tool::shape:
        return "Drag around what the melt shall fill. Inside a chosen shape: a hole. Shift: another part of it.";
    case Tool::source:
        return "Click a surface to place heat before it; drag to choose how far.";
    case Tool::collider:
        return "Click a surface to stand something solid on it.";
    case Tool::temperature:
        return "Drag over a body: it starts with this temperature there. Ctrl + wheel: size of the brush.";
    case Tool::absorptivity:
        return "Drag over a body: it takes up this share of radiation there. Ctrl + wheel: size of the brush.";
    case Tool::erase:
        return "Drag over paths, contours and paint to take them away. Ctrl + wheel: size.";
    case Tool::probe:
        return "Click a particle to see all that it knows.";
    }
    return "";
}

std::optional<Hit> ToolKit::under(Studio& studio, const Lens& lens, ImVec2 at) const {
    std::optional<Hit> hit = studio.picker().cast(lens.ray(at));
    // The picture may be older than the last edit.
    if (hit && !exists(studio.scene(), hit->item)) hit->item = {};
    return hit;
}

std::optional<ToolKit::Touch> ToolKit::touched(const Studio& studio, const Lens& lens, ImVec2 at) const {
    const scene::Scene& s = studio.scene();
    // Nodes of what is chosen come first, then what is nearest.
    const Item chosen = studio.selection();
    if (chosen.kind == Kind::path || chosen.kind == Kind::shape) {
        float best = kReach;
        Touch found{chosen, 0, -1};
        const std::vector<Line> lines = linesOf(s, chosen);
        for (size_t c = 0; c < lines.size(); ++c)
            for (size_t i = 0; i < lines[c].points.size(); ++i)
                if (const auto p = lens.project(lines[c].points[i]))
                    if (const float d = between(*p, at); d < best)
                        best = d, found.contour = int(c), found.node = int(i);
        if (found.node >= 0) return found;
    }
    float best = kReach;
    std::optional<Touch> found;
    for (size_t i = 0; i < s.heatSources.size(); ++i) {
        if (s.heatSources[i].type == thawHeatSource_directional) continue;
        if (const auto p = lens.project(s.heatSources[i].position))
            if (const float d = between(*p, at) - 4; d < best) best = d, found = Touch{{Kind::source, int(i)}, 0, -1};
    }
    const auto along = [&](Item item) {
        const std::vector<Line> lines = linesOf(s, item);
        for (size_t c = 0; c < lines.size(); ++c) {
            const std::vector<thawVec3>& points = lines[c].points;
            const size_t n = points.size(), segments = lines[c].closed ? n : n - 1;
            for (size_t i = 0; i < segments; ++i) {
                const auto a = lens.project(points[i]), b = lens.project(points[(i + 1) % n]);
                if (!a || !b) continue;
                const ImVec2 d(b->x - a->x, b->y - a->y);
                const float square = d.x * d.x + d.y * d.y;
                const float u =
                    square > 0 ? std::clamp(((at.x - a->x) * d.x + (at.y - a->y) * d.y) / square, 0.0f, 1.0f) : 0;
                const float far = between(at, {a->x + u * d.x, a->y + u * d.y});
                if (far < best) best = far, found = Touch{item, int(c), -1};
            }
        }
    };
    if (studio.view.icons) {
        for (size_t i = 0; i < s.paths.size(); ++i) along({Kind::path, int(i)});
        for (size_t i = 0; i < s.shapes.size(); ++i) along({Kind::shape, int(i)});
    }
    return found;
}

bool ToolKit::cancel() {
    const bool was = !line_.empty() || anchor_.has_value() || dragging_ || gizmo_.held();
    line_.clear(), lineColliders_.clear(), anchor_.reset(), dragging_ = false;
    gizmo_.drop();
    return was;
}

void ToolKit::select(Studio& studio, const Lens& lens, const Pointer& pointer) {
    if (dragNode(studio, lens, pointer)) return;
    if (pointer.clickedTwice && (studio.selection().kind == Kind::path || studio.selection().kind == Kind::shape))
        return insertNode(studio, lens, pointer);
    if (!pointer.pressed) return;
    if (const std::optional<Touch> touch = touched(studio, lens, pointer.at)) return studio.select(touch->item);
    const std::optional<Hit> hit = under(studio, lens, pointer.at);
    studio.select(hit ? hit->item : Item{});
}

void ToolKit::update(Studio& studio, const Lens& lens, const Pointer& pointer, ImDrawList& draw) {
    overlay(studio, lens, pointer, draw);
    const ImGuiIO& io = ImGui::GetIO();
    if (pointer.over && io.KeyCtrl && io.MouseWheel != 0)
        studio.tools.brushRadius = std::clamp(studio.tools.brushRadius * std::pow(1.1f, io.MouseWheel), 1e-4f, 1.0f);
    switch (studio.tool) {
    case Tool::select:
        return select(studio, lens, pointer);
    case Tool::move:
    case Tool::turn:
    case Tool::scale:
        if (!gizmo_.update(studio, lens, pointer, draw)) select(studio, lens, pointer);
        return;
    case Tool::path:
        return drawLine(studio, lens, pointer, false);
    case Tool::shape:
        return drawLine(studio, lens, pointer, true);
    case Tool::source:
        return placeSource(studio, lens, pointer, draw);
    case Tool::collider:
        return placeCollider(studio, lens, pointer);
    case Tool::temperature:
    case Tool::absorptivity:
        return paint(studio, lens, pointer);
    case Tool::erase:
        return wipe(studio, lens, pointer);
    case Tool::probe:
        return probe(studio, lens, pointer);
    }
}

void ToolKit::probe(Studio& studio, const Lens& lens, const Pointer& pointer) const {
    if (!pointer.pressed) return;
    // The first ball of half a spacing that the ray meets.
    const thawParticleView all = studio.frame().particles.view();
    const Ray ray = lens.ray(pointer.at);
    float best = INFINITY;
    for (int i = 0; i < all.count; ++i) {
        const float* p = all.positions + 4 * size_t(i);
        const Vec3 d = Vec3{p[0], p[1], p[2]} - ray.origin;
        const float along = dot(d, ray.direction), square = dot(d, d) - along * along;
        const float r = 0.6f * studio.scene().world.particleSpacing * std::exp2(float(all.levels[i]) / 3);
        if (along > 0 && square < r * r && along < best)
            best = along, studio.pickedParticle = all.ids[i], studio.hasPickedParticle = true;
    }
    if (best == INFINITY) studio.tell("no particle there");
}

} // namespace thaw::editor
