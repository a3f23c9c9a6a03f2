// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/toolkit.h"

#include "model/lines.h"
#include "view/math.h"

#include <cmath>

namespace thaw::editor {

using namespace thaw::view;

void ToolKit::overlay(Studio& studio, const Lens& lens, const Pointer& pointer, ImDrawList& draw) const {
    const scene::Scene& s = studio.scene();
    const Item chosen = studio.selection();
    const auto polyline = [&](const std::vector<thawVec3>& points, bool closed, ImU32 color, float width) {
        std::vector<ImVec2> run;
        const auto flush = [&](bool whole) {
            if (run.size() > 1)
                draw.AddPolyline(run.data(), int(run.size()), color, whole && closed ? ImDrawFlags_Closed : 0, width);
            run.clear();
        };
        bool whole = true;
        for (const thawVec3& p : points) {
            if (const auto at = lens.project(p))
                run.push_back(*at);
            else
                whole = false, flush(false);
        }
        flush(whole);
    };
    if (studio.view.icons) {
        const auto lines = [&](Item item, ImU32 color) {
            for (const Line& line : linesOf(s, item)) {
                const bool on = item == chosen;
                polyline(line.points, line.closed, on ? IM_COL32(255, 230, 90, 255) : color, on ? 2.5f : 1.5f);
            }
        };
        for (size_t i = 0; i < s.paths.size(); ++i) lines({Kind::path, int(i)}, IM_COL32(110, 200, 255, 200));
        for (size_t i = 0; i < s.shapes.size(); ++i) lines({Kind::shape, int(i)}, IM_COL32(120, 235, 160, 200));
        for (size_t i = 0; i < s.heatSources.size(); ++i) {
            const scene::HeatSource& h = s.heatSources[i];
            if (h.type == thawHeatSource_directional) continue;
            const auto p = lens.project(h.position);
            if (!p) continue;
            const bool on = chosen == Item{Kind::source, int(i)};
            const ImU32 color = on          ? IM_COL32(255, 230, 90, 255)
                                : h.enabled ? IM_COL32(255, 160, 60, 230)
                                            : IM_COL32(150, 150, 150, 200);
            draw.AddCircle(*p, 7, color, 20, 2);
            for (int k = 0; k < 8; ++k) {
                const float a = 0.785398f * float(k);
                draw.AddLine({p->x + 10 * std::cos(a), p->y + 10 * std::sin(a)},
                             {p->x + 14 * std::cos(a), p->y + 14 * std::sin(a)}, color, 2);
            }
        }
    }
    if (exists(s, chosen) && (chosen.kind == Kind::path || chosen.kind == Kind::shape)) {
        const std::vector<Line> lines = linesOf(s, chosen);
        for (size_t c = 0; c < lines.size(); ++c)
            for (size_t i = 0; i < lines[c].points.size(); ++i)
                if (const auto p = lens.project(lines[c].points[i])) {
                    const bool on = studio.node == int(i) && studio.contour == int(c);
                    draw.AddCircleFilled(*p, on ? 6.0f : 4.0f,
                                         on ? IM_COL32(255, 120, 60, 255) : IM_COL32(255, 240, 160, 255));
                    draw.AddCircle(*p, on ? 6.0f : 4.0f, IM_COL32(40, 30, 0, 255), 12, 1);
                }
    } else if (exists(s, chosen)) {
        box(studio, lens, chosen, draw);
    }
    if (!line_.empty()) {
        polyline(line_, false, IM_COL32(255, 230, 90, 255), 3);
        if (studio.tool == Tool::shape && line_.size() > 2)
            polyline({line_.back(), line_.front()}, false, IM_COL32(255, 230, 90, 110), 1.5f);
    }
    const Tool tool = studio.tool;
    if (tool == Tool::probe && studio.hasPickedParticle) {
        const thawParticleView all = studio.frame().particles.view();
        for (int i = 0; i < all.count; ++i) {
            if (all.ids[i] != studio.pickedParticle) continue;
            const float* x = all.positions + 4 * size_t(i);
            if (const auto p = lens.project({x[0], x[1], x[2]})) {
                draw.AddCircle(*p, 9, IM_COL32(0, 0, 0, 200), 24, 4);
                draw.AddCircle(*p, 9, IM_COL32(255, 255, 255, 255), 24, 2);
            }
            break;
        }
    }
    const bool brush = tool == Tool::temperature || tool == Tool::absorptivity || tool == Tool::erase;
    if ((brush || tool == Tool::path) && pointer.over)
        if (const std::optional<Hit> hit = under(studio, lens, pointer.at)) {
            const float spacing = s.world.particleSpacing;
            const float radius = brush                       ? studio.tools.brushRadius
                                 : chosen.kind == Kind::path ? s.paths[size_t(chosen.index)].def.radius
                                                             : 4 * spacing;
            const Vec3 u = perpendicular(hit->normal), v = cross(hit->normal, u);
            std::vector<thawVec3> ring;
            for (int k = 0; k < 40; ++k) {
                const float a = 0.15707963f * float(k);
                ring.push_back(hit->point + u * (radius * std::cos(a)) + v * (radius * std::sin(a)));
            }
            polyline(ring, true, tool == Tool::erase ? IM_COL32(255, 110, 110, 230) : IM_COL32(255, 255, 255, 200),
                     1.5f);
        }
}

void ToolKit::box(const Studio& studio, const Lens& lens, Item item, ImDrawList& draw) const {
    const Frame& f = studio.frame();
    const scene::Scene& s = studio.scene();
    if (!f.meshes) return;
    const scene::TriMesh* mesh = nullptr;
    const scene::Placement* at = nullptr;
    const size_t i = size_t(item.index);
    if (item.kind == Kind::body && i < f.meshes->bodies.size())
        mesh = &f.meshes->bodies[i], at = &s.bodies[i].placement;
    if (item.kind == Kind::collider && i < f.meshes->colliders.size())
        mesh = &f.meshes->colliders[i], at = &s.colliders[i].placement;
    if (item.kind == Kind::prop && i < f.meshes->props.size()) mesh = &f.meshes->props[i], at = &s.props[i].placement;
    if (!mesh || mesh->vertices.empty()) return;
    if (f.meshes != boxMeshes_ || item != boxItem_)
        boxMeshes_ = f.meshes, boxItem_ = item, boxBounds_ = scene::boundsOf(*mesh);
    const scene::Bounds& b = boxBounds_;
    std::optional<ImVec2> corner[8];
    for (int k = 0; k < 8; ++k) {
        const Vec3 p{k & 1 ? b.upper.x : b.lower.x, k & 2 ? b.upper.y : b.lower.y, k & 4 ? b.upper.z : b.lower.z};
        corner[k] = lens.project(rotate(at->rotation, p * at->scale) + at->position);
    }
    for (int k = 0; k < 8; ++k)
        for (const int bit : {1, 2, 4})
            if (!(k & bit) && corner[k] && corner[k | bit])
                draw.AddLine(*corner[k], *corner[k | bit], IM_COL32(255, 230, 90, 170), 1.5f);
}

} // namespace thaw::editor
