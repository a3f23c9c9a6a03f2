// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/panels.h"
#include "app/place_fields.h"

#include "model/stroke.h"

#include <algorithm>

namespace thaw::editor {

namespace {

void controlFields(Studio& studio, bool path, size_t i) {
    const scene::Scene& s = studio.scene();
    const int collider = path ? s.paths[i].collider : s.shapes[i].collider;
    ui::value("moves with", "%s", collider < 0 ? "nothing" : titleOf(s, {Kind::collider, collider}).c_str());
    ui::tip("The collider that it was drawn on.");
}

} // namespace

void showPath(Studio& studio, size_t i) {
    const auto p = [i](auto& s) -> auto& { return s.paths[i].def; };
    ui::flag(
        studio, "enabled", [=](auto& s) -> auto& { return p(s).enabled; }, "It is on.");
    ui::real(
        studio, "radius", [=](auto& s) -> auto& { return p(s).radius; }, {1e-4f, 10, "%.1f mm", false, 1000, 0.1f},
        "Half the width of the stream.",
        [=](scene::Scene& s) {
            thawPathDef& d = p(s);
            if (d.reach > 0) d.reach = std::max(d.reach, d.radius);
            if (d.beadSpacing > 0) d.beadSpacing = std::max(d.beadSpacing, 2 * d.radius);
        });
    ui::maybe(
        studio, "reach", [=](auto& s) -> auto& { return p(s).reach; }, 0, 3 * studio.scene().paths[i].def.radius,
        "twice the radius", {studio.scene().paths[i].def.radius, 10, "%.1f mm", false, 1000, 0.2f},
        "From where melt is drawn to it.");
    ui::real(
        studio, "strength", [=](auto& s) -> auto& { return p(s).strength; }, {0, 1, "%.2f"},
        "0: nothing, 0.5: a hint, 1: a lock.");
    ui::real(
        studio, "speed", [=](auto& s) -> auto& { return p(s).speed; }, {0, 100, "%.0f mm/s", false, 1000, 1},
        "Along the path; 0: the melt's own.");
    ui::maybe(
        studio, "arrival", [=](auto& s) -> auto& { return p(s).arrivalTime; }, 0, 4, "by its speed",
        {0, 1e4f, "%.1f s", false, 1, 0.05f}, "When the first melt is at the end; goes before the speed.");
    ui::real(
        studio, "share", [=](auto& s) -> auto& { return p(s).share; }, {0, 1e6f, "%.2f", false, 1, 0.02f},
        "Of what flows where paths part, in relation to the others'.");
    ui::maybe(
        studio, "beads", [=](auto& s) -> auto& { return p(s).beadSpacing; }, 0,
        std::max(4 * studio.scene().paths[i].def.radius, 0.01f), "an even stream",
        {2 * studio.scene().paths[i].def.radius, 10, "%.1f mm", false, 1000, 0.2f},
        "Along it between beads; at least twice the radius.");
    ui::maybe(
        studio, "start takes up", [=](auto& s) -> auto& { return p(s).startAbsorptivity; }, NAN, 1, "as the material",
        {0, 1, "%.2f", false, 1, 0.01f}, "Share of radiation at its first point: melting starts there.");
    ui::whole(
        studio, "priority", [=](auto& s) -> auto& { return p(s).priority; }, -10, 10, "%d",
        "Where paths cross, melt takes the highest.");
    ui::flag(
        studio, "smooth", [=](auto& s) -> auto& { return p(s).smooth; },
        "A spline through its nodes; off: straight from one to the next.");
    controlFields(studio, true, i);
    const std::vector<thawVec3>& points = studio.scene().paths[i].points;
    ui::value("nodes", "%zu, %.1f mm long", points.size(), double(1000 * lengthOf(points, false)));
    if (ui::button("Smooth"))
        studio.edit("Smooth path", [&](scene::Scene& s) { s.paths[i].points = smoothed(s.paths[i].points, 2, false); });
    ui::tip("Takes trembling out of the line.");
    ImGui::SameLine();
    if (ui::button("Fewer nodes"))
        studio.edit("Fewer nodes", [&](scene::Scene& s) {
            auto& line = s.paths[i].points;
            line = resampled(line, 1.5f * lengthOf(line, false) / float(line.size()), false);
        });
    ImGui::SameLine();
    if (ui::button("Turn round"))
        studio.edit("Turn path round",
                    [&](scene::Scene& s) { std::reverse(s.paths[i].points.begin(), s.paths[i].points.end()); });
    ui::tip("It flows the other way.");
    if (studio.node >= 0 && size_t(studio.node) < points.size()) {
        const size_t n = size_t(studio.node);
        ui::vector(
            studio, "node", [=](auto& s) -> auto& { return s.paths[i].points[n]; }, 1000, 0.5f, "%.1f", 1e4f,
            "The chosen node, in mm.");
    }
    if (i < studio.frame().paths.size()) {
        const thawPathState& now = studio.frame().paths[i];
        ImGui::Separator();
        ui::value("follows now", "%.2f g", double(1000 * now.mass));
        ui::value("arrived", "%.2f g", double(1000 * now.arrived));
        ui::value("spilled", "%.2f g", double(1000 * now.spilled));
        ui::value("off the line", "%.1f mm", double(1000 * now.meanDistance));
        if (std::isfinite(now.arrivalTime)) ui::value("was there after", "%.2f s", double(now.arrivalTime));
    }
}

void showShape(Studio& studio, size_t i) {
    const auto p = [i](auto& s) -> auto& { return s.shapes[i].def; };
    ui::flag(
        studio, "enabled", [=](auto& s) -> auto& { return p(s).enabled; }, "It is on.");
    ui::real(
        studio, "strength", [=](auto& s) -> auto& { return p(s).strength; }, {0, 1, "%.2f"},
        "0: nothing, 0.5: a hint, 1: a lock.");
    ui::maybe(
        studio, "reach", [=](auto& s) -> auto& { return p(s).reach; }, 0, 0.03f, "half its size",
        {1e-4f, 10, "%.1f mm", false, 1000, 0.5f}, "Beyond its rim, from where melt is drawn.");
    ui::real(
        studio, "speed", [=](auto& s) -> auto& { return p(s).speed; }, {1e-4f, 100, "%.0f mm/s", false, 1000, 1},
        "At most, at which melt is led.");
    const bool flat = !studio.scene().shapes[i].contours.empty();
    if (flat) {
        ui::maybe(
            studio, "depth", [=](auto& s) -> auto& { return p(s).depth; }, 0, 0.02f, "as its reach",
            {1e-4f, 10, "%.1f mm", false, 1000, 0.2f}, "Off the surface to both sides, where it works.");
        ui::maybe(
            studio, "thickness", [=](auto& s) -> auto& { return p(s).thickness; }, 0,
            3 * studio.scene().world.particleSpacing, "all melt there is", {0, 10, "%.1f mm", false, 1000, 0.1f},
            "At which it is full and takes up no more.");
    }
    ui::flag(
        studio, "sets", [=](auto& s) -> auto& { return p(s).sets; },
        "What is in it is cooled until it sets, once it is full.");
    ui::real(
        studio, "set at", [=](auto& s) -> auto& { return p(s).setFill; }, {0, 1, "%.2f"},
        "Share of it that is covered, or filled, when that begins.");
    ui::real(
        studio, "set time", [=](auto& s) -> auto& { return p(s).setTime; }, {0, 1e4f, "%.1f s", false, 1, 0.05f},
        "That it takes about.");
    ui::whole(
        studio, "priority", [=](auto& s) -> auto& { return p(s).priority; }, -10, 10, "%d",
        "Where shapes overlap, melt obeys the highest.");
    controlFields(studio, false, i);
    if (flat) {
        const auto& contours = studio.scene().shapes[i].contours;
        ui::value("contours", "%zu", contours.size());
        if (ui::button("Smooth"))
            studio.edit("Smooth shape", [&](scene::Scene& s) {
                for (auto& c : s.shapes[i].contours) c = smoothed(c, 2, true);
            });
        ImGui::SameLine();
        if (ui::button("Fewer nodes"))
            studio.edit("Fewer nodes", [&](scene::Scene& s) {
                for (auto& c : s.shapes[i].contours) c = resampled(c, 1.5f * lengthOf(c, true) / float(c.size()), true);
            });
    } else {
        shapeFields(
            studio, [i](auto& s) -> auto& { return s.shapes[i].shape; }, false);
        placementFields(
            studio, [i](auto& s) -> auto& { return s.shapes[i].placement; });
    }
    if (i < studio.frame().shapes.size()) {
        const thawShapeState& now = studio.frame().shapes[i];
        ImGui::Separator();
        ui::value("filled", "%.0f %%", double(100 * now.fill));
        ui::value("inside", "%.2f g", double(1000 * now.inside));
        ui::value("spilled", "%.2f g", double(1000 * now.spilled));
        ui::value("set", "%.2f g", double(1000 * now.set));
    }
}

} // namespace thaw::editor
