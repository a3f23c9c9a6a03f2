// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/toolkit.h"

#include "model/lines.h"
#include "model/stroke.h"
#include "view/math.h"

#include <algorithm>
#include <cmath>

namespace thaw::editor {

using namespace thaw::view;

void ToolKit::paint(Studio& studio, const Lens& lens, const Pointer& pointer) {
    if (pointer.pressed) ++strokes_, last_.reset();
    if (!pointer.held) {
        if (last_) studio.endGesture(), last_.reset();
        return;
    }
    for (const ImVec2 at : pointer.trail) {
        const std::optional<Hit> hit = under(studio, lens, at);
        if (!hit || hit->item.kind != Kind::body) continue;
        const float radius = studio.tools.brushRadius;
        if (last_ && length(last_->point - hit->point) < 0.5f * radius) continue;
        last_ = hit;
        scene::Paint dab;
        dab.brush = {hit->point, radius, studio.tools.falloff};
        const bool heat = studio.tool == Tool::temperature;
        (heat ? dab.temperature : dab.absorptivity) =
            heat ? studio.tools.paintTemperature : studio.tools.paintAbsorptivity;
        studio.edit(
            heat ? "Paint temperature" : "Paint absorptivity",
            [&](scene::Scene& s) { s.bodies[size_t(hit->item.index)].paint.push_back(dab); },
            "paint " + std::to_string(strokes_));
    }
}

void ToolKit::wipe(Studio& studio, const Lens& lens, const Pointer& pointer) {
    if (pointer.pressed) ++strokes_;
    if (pointer.released) studio.endGesture();
    if (!pointer.held) return;
    const std::optional<Hit> hit = under(studio, lens, pointer.at);
    if (!hit) return;
    const thawVec3 at = hit->point;
    const float radius = studio.tools.brushRadius;
    const auto near = [&](thawVec3 p) { return length(p - at) < radius; };
    studio.edit(
        "Erase",
        [&](scene::Scene& s) {
            for (size_t i = 0; i < s.paths.size();) {
                const scene::Path path = s.paths[i];
                const std::vector<thawVec3> line = worldPoints(s, path.points, path.collider);
                const Nearest nearest = nearestOn(line, at, false);
                if (nearest.distance >= radius) {
                    ++i;
                    continue;
                }
                const auto rest = cutOut(line, at, radius);
                s.paths.erase(s.paths.begin() + int(i));
                for (size_t k = 0; k < rest.size(); ++k, ++i) {
                    scene::Path piece = path;
                    piece.points.clear();
                    for (const thawVec3& p : rest[k]) piece.points.push_back(fromWorld(s, path.collider, p));
                    if (k > 0) piece.name = freeName(s, Kind::path, path.name);
                    s.paths.insert(s.paths.begin() + int(i), piece);
                }
            }
            for (size_t i = 0; i < s.shapes.size();) {
                scene::FillShape& shape = s.shapes[i];
                const bool drawn = !shape.contours.empty();
                for (auto& contour : shape.contours)
                    std::erase_if(contour, [&](thawVec3 p) { return near(toWorld(s, shape.collider, p)); });
                std::erase_if(shape.contours, [](const auto& c) { return c.size() < 3; });
                if (drawn && shape.contours.empty())
                    s.shapes.erase(s.shapes.begin() + int(i));
                else
                    ++i;
            }
            for (scene::Body& body : s.bodies)
                std::erase_if(body.paint, [&](const scene::Paint& p) { return near(p.brush.center); });
        },
        "erase " + std::to_string(strokes_));
}

} // namespace thaw::editor
