// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/fields.h"
#include "app/panels.h"

#include "model/stroke.h"

#include <imgui/imgui_stdlib.h>

#include <cstring>

namespace thaw::editor {

namespace {

constexpr float kDegrees = 180 / std::numbers::pi_v<float>;
const char* const kShapes[] = {"plane", "box", "sphere", "cylinder", "cone", "torus", "mesh"};

void nameField(Studio& studio, Item item) {
    static std::string text; // while it is typed
    static bool typing = false;
    ui::field("name");
    ImGui::PushID("name");
    const std::string was = titleOf(studio.scene(), item);
    if (!typing) text = was;
    ImGui::InputText("##name", &text, ImGuiInputTextFlags_AutoSelectAll);
    typing = ImGui::IsItemActive();
    if (ImGui::IsItemDeactivatedAfterEdit()) {
        const std::string name = scene::oneLine(text, 120);
        if (!name.empty() && name != was)
            studio.edit("Rename " + was, [&](scene::Scene& s) {
                *nameOf(s, item) = item.kind == Kind::material ? freeName(s, item.kind, name) : name;
            });
    }
    ui::note("name");
    ui::tip("How it is called here and in the file.");
    ImGui::PopID();
}

/// Degrees about x, y and z of a turn, in the order of scene::quatFromDegrees.
void eulerOf(const thawQuat& q, float out[3]) {
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

void materialCombo(Studio& studio, size_t body) {
    const scene::Scene& s = studio.scene();
    ui::field("material");
    ImGui::PushID("material");
    const int now = s.bodies[body].material;
    if (ImGui::BeginCombo("##v", s.materials[size_t(now)].name.c_str())) {
        for (int i = 0; i < int(s.materials.size()); ++i)
            if (ImGui::Selectable((s.materials[size_t(i)].name + "##" + std::to_string(i)).c_str(), i == now))
                studio.edit("Set material", [&](scene::Scene& t) { t.bodies[body].material = i; });
        ImGui::Separator();
        for (int p = 0; p < int(thawMaterial_presetCount); ++p) {
            const std::string label = std::string("new: ") + thawMaterialPresetName(thawMaterialPreset(p));
            if (ImGui::Selectable(label.c_str()))
                studio.edit("Set material", [&](scene::Scene& t) {
                    t.bodies[body].material = addMaterial(t, thawMaterialPreset(p)).index;
                });
        }
        ImGui::EndCombo();
    }
    ui::note("material");
    ui::tip("What it is made of. Materials can be shared between bodies.");
    ImGui::PopID();
}

void bodyFields(Studio& studio, size_t i) {
    const auto body = [i](auto& s) -> auto& { return s.bodies[i]; };
    materialCombo(studio, i);
    ui::maybe(
        studio, "temperature", [=](auto& s) -> auto& { return body(s).temperature; }, NAN,
        studio.scene().world.ambientTemperature, "that of the air", {100, 10000, "%.1f K", false, 1, 0.5f},
        "What it has at the start.");
    ui::flag(
        studio, "anchored", [=](auto& s) -> auto& { return body(s).anchored; },
        "Stuck to the collider that it touches. Off: it stands free and can fall over.");
    ui::whole(
        studio, "coarsest level", [=](auto& s) -> auto& { return body(s).coarsestLevel; }, 0, 3, "%d",
        "Its solid starts with particles of up to 2^this times the mass of the finest: faster, and it splits before "
        "heat gets "
        "there.");
    shapeFields(
        studio, [=](auto& s) -> auto& { return body(s).shape; }, false);
    placementFields(
        studio, [=](auto& s) -> auto& { return body(s).placement; });
    const size_t dabs = studio.scene().bodies[i].paint.size();
    ui::value("paint", "%zu dabs", dabs);
    if (dabs > 0 && ui::button("Clear paint"))
        studio.edit("Clear paint", [&](scene::Scene& s) { s.bodies[i].paint.clear(); });
    const Frame& f = studio.frame();
    if (i < f.bodies.size()) {
        const thawBodyState& now = f.bodies[i];
        ImGui::Separator();
        ui::value("particles", "%d", now.particles);
        ui::value("mass", "%.2f g", double(1000 * now.mass));
        ui::value("molten", "%.1f %%", double(100 * now.meltedFraction));
        ui::value("mean", "%.1f K (%.1f °C)", double(now.meanTemperature), double(now.meanTemperature) - 273.15);
    }
    if (i < f.bodyReports.size()) {
        const thawMeshReport& r = f.bodyReports[i];
        if (r.openEdges + r.nonManifoldEdges + r.inconsistentEdges + r.degenerateTriangles > 0 || r.inverted) {
            ui::quietf("its mesh was repaired: %u open edges, %u with more than two faces, %u faces without area%s",
                       r.openEdges, r.nonManifoldEdges, r.degenerateTriangles, r.inverted ? ", inside out" : "");
        }
    }
}

void colliderFields(Studio& studio, size_t i) {
    const auto c = [i](auto& s) -> auto& { return s.colliders[i]; };
    shapeFields(
        studio, [=](auto& s) -> auto& { return c(s).shape; }, true);
    placementFields(
        studio, [=](auto& s) -> auto& { return c(s).placement; });
    ui::flag(
        studio, "adhesive", [=](auto& s) -> auto& { return c(s).adhesive; }, "Melt clings to it.");
    ui::flag(
        studio, "occluder", [=](auto& s) -> auto& { return c(s).occluder; }, "It shades heat sources.");
    ui::real(
        studio, "friction", [=](auto& s) -> auto& { return c(s).friction; }, {0, 10, "%.2f", false, 1, 0.01f},
        "Coulomb's coefficient for what is solid.");
    ui::real(
        studio, "slip length", [=](auto& s) -> auto& { return c(s).slipLength; },
        {0, 1e4f, "%.2f mm", false, 1000, 0.05f}, "How far behind it liquid would stand still; 0: it sticks.");
    ui::maybe(
        studio, "temperature", [=](auto& s) -> auto& { return c(s).temperature; }, NAN, 400, "exchanges no heat",
        {0, 1e5f, "%.1f K", false, 1, 1}, "It heats or cools what touches it.");
    if (!std::isnan(studio.scene().colliders[i].temperature))
        ui::maybe(
            studio, "conductance", [=](auto& s) -> auto& { return c(s).contactConductance; }, INFINITY, 3000,
            "perfect contact", {0, 1e9f, "%.0f W/m²K", false, 1, 10}, "Of the contact. A hand about 500, a pan 3000.");
    ui::flag(
        studio, "visible", [=](auto& s) -> auto& { return c(s).visible; }, "It is drawn.");
    ui::color(
        studio, "colour", [=](auto& s) -> auto& { return c(s).color; }, "Of its surface.");
}

void sourceFields(Studio& studio, size_t i) {
    static const char* const types[] = {"point", "sphere", "rectangle", "disc", "directional"};
    static const char* const looks[] = {"not drawn", "flame", "glow"};
    const auto h = [i](auto& s) -> auto& { return s.heatSources[i]; };
    const scene::HeatSource now = studio.scene().heatSources[i];
    ui::flag(
        studio, "enabled", [=](auto& s) -> auto& { return h(s).enabled; }, "It is on.");
    ui::words(
        studio, "type", [=](auto& s) -> auto& { return h(s).type; }, types, 5,
        "point: power in all directions. sphere, rectangle, disc: radiate by their temperature. directional: the sun.");
    if (now.type == thawHeatSource_point)
        ui::real(
            studio, "power", [=](auto& s) -> auto& { return h(s).power; }, {-1e6f, 1e6f, "%.1f W", false, 1, 0.5f},
            "Radiated in all directions alike; below 0 it cools. A candle's flame about 80 W.");
    else if (now.type == thawHeatSource_directional)
        ui::real(
            studio, "irradiance", [=](auto& s) -> auto& { return h(s).irradiance; },
            {-1e6f, 1e6f, "%.0f W/m²", false, 1, 10}, "On a surface that faces it. The sun about 1000.");
    else {
        ui::real(
            studio, "temperature", [=](auto& s) -> auto& { return h(s).temperature; }, {0, 1e5f, "%.0f K", false, 1, 5},
            "Of its surface, which radiates with the fourth power of it.");
        ui::real(
            studio, "emissivity", [=](auto& s) -> auto& { return h(s).emissivity; }, {0, 1, "%.2f"}, "1: black.");
    }
    if (now.type != thawHeatSource_directional)
        ui::vector(
            studio, "position", [=](auto& s) -> auto& { return h(s).position; }, 1000, 0.5f, "%.1f", 1e4f,
            "Of its centre, in mm: x, y (up), z.");
    if (now.type == thawHeatSource_rectangle)
        ui::vector(
            studio, "size", [=](auto& s) -> auto& { return h(s).size; }, 1000, 1, "%.0f", 1e3f,
            "Edges x and z in mm; y is not used.");
    else if (now.type != thawHeatSource_directional)
        ui::real(
            studio, "radius", [=](auto& s) -> auto& { return h(s).radius; }, {1e-4f, 10, "%.1f mm", false, 1000, 0.1f},
            "Of its surface; nothing gets closer to a point than this.");
    if (now.type == thawHeatSource_rectangle || now.type == thawHeatSource_disc ||
        now.type == thawHeatSource_directional)
        rotationField(
            studio, [=](auto& s) -> auto& { return h(s).rotation; });
    ui::words(
        studio, "looks", [=](auto& s) -> auto& { return h(s).visual; }, looks, 3,
        "How it is drawn. It heats in any case.");
}

void controlFields(Studio& studio, bool path, size_t i) {
    const scene::Scene& s = studio.scene();
    const int collider = path ? s.paths[i].collider : s.shapes[i].collider;
    ui::value("moves with", "%s", collider < 0 ? "nothing" : titleOf(s, {Kind::collider, collider}).c_str());
    ui::tip("The collider that it was drawn on.");
}

void pathFields(Studio& studio, size_t i) {
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

void shapeFieldsOf(Studio& studio, size_t i) {
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

void worldFields(Studio& studio) {
    const auto w = [](auto& s) -> auto& { return s.world; };
    ui::real(
        studio, "spacing", [=](auto& s) -> auto& { return w(s).particleSpacing; },
        {1e-4f, 1, "%.2f mm", false, 1000, 0.01f},
        "Distance of neighbouring particles. Half of it means eight times as many.");
    ui::vector(
        studio, "gravity", [=](auto& s) -> auto& { return w(s).gravity; }, 1, 0.05f, "%.2f", 1000,
        "m/s²: x, y (up), z.");
    ui::real(
        studio, "ambient", [=](auto& s) -> auto& { return w(s).ambientTemperature; },
        {100, 10000, "%.1f K", false, 1, 0.5f}, "Air and far surroundings.");
    ui::real(
        studio, "convection", [=](auto& s) -> auto& { return w(s).convection; },
        {0, 1e4f, "%.1f W/m²K", false, 1, 0.2f}, "Heat that goes over to the air. Still air about 10.");
    ui::real(
        studio, "heat is faster", [=](auto& s) -> auto& { return w(s).thermalTimeScale; }, {0, 1e5f, "x %.3g", true},
        "Seconds of heat in a second of motion: real melting takes minutes.");
    ImGui::Separator();
    ui::real(
        studio, "length", [](auto& s) -> auto& { return s.defaults.seconds; }, {0.01f, 3600, "%.1f s", false, 1, 0.1f},
        "Of a run, and of the loop.");
    ui::real(
        studio, "exposure", [](auto& s) -> auto& { return s.look.exposure; }, {0.01f, 100, "x %.2f", true},
        "Brightness of pictures.");
    ui::vector(
        studio, "sun", [](auto& s) -> auto& { return s.look.sunDirection; }, 1, 0.01f, "%.2f", 10,
        "Direction towards the main light.");
}

void cameraFields(Studio& studio) {
    const auto c = [](auto& s) -> auto& { return s.camera; };
    ui::vector(
        studio, "eye", [=](auto& s) -> auto& { return c(s).eye; }, 1000, 1, "%.0f", 1e4f, "Where it is, in mm.");
    ui::vector(
        studio, "target", [=](auto& s) -> auto& { return c(s).target; }, 1000, 1, "%.0f", 1e4f,
        "What it looks at, in mm.");
    ui::real(
        studio, "field of view", [=](auto& s) -> auto& { return c(s).fieldOfViewDegrees; },
        {1, 150, "%.1f°", false, 1, 0.1f}, "Vertical.");
    const size_t keys = studio.scene().camera.keys.size();
    ui::value("keys", "%zu", keys);
    if (keys > 0 && ui::button("Clear keys"))
        studio.edit("Clear camera keys", [](scene::Scene& s) { s.camera.keys.clear(); });
}

} // namespace

void showInspector(Studio& studio) {
    const Item item = studio.selection();
    const scene::Scene& s = studio.scene();
    if (!exists(s, item)) {
        showToolSettings(studio);
        return;
    }
    ImGui::PushID(int(item.kind) * 100000 + item.index);
    ImGui::Text("%s", kindName(item.kind));
    if (item.kind != Kind::world && item.kind != Kind::camera) nameField(studio, item);
    const size_t i = size_t(item.index);
    switch (item.kind) {
    case Kind::world:
        worldFields(studio);
        break;
    case Kind::camera:
        cameraFields(studio);
        break;
    case Kind::material:
        showMaterial(studio, item.index);
        break;
    case Kind::body:
        bodyFields(studio, i);
        if (exists(studio.scene(), item) && ui::section("Material##body material", false))
            showMaterial(studio, studio.scene().bodies[i].material);
        break;
    case Kind::collider:
        colliderFields(studio, i);
        break;
    case Kind::source:
        sourceFields(studio, i);
        break;
    case Kind::path:
        pathFields(studio, i);
        break;
    case Kind::shape:
        shapeFieldsOf(studio, i);
        break;
    case Kind::prop:
        shapeFields(
            studio, [i](auto& t) -> auto& { return t.props[i].shape; }, false);
        placementFields(
            studio, [i](auto& t) -> auto& { return t.props[i].placement; });
        ui::color(
            studio, "colour", [i](auto& t) -> auto& { return t.props[i].color; }, "Of its surface.");
        break;
    case Kind::none:
        break;
    }
    ImGui::PopID();
    ImGui::Spacing();
    showToolSettings(studio);
}

} // namespace thaw::editor
