// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/panels.h"
#include "app/place_fields.h"

#include <imgui/imgui_stdlib.h>

namespace thaw::editor {

namespace {

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
            ImGui::PushTextWrapPos(0);
            ui::quietf("its mesh was repaired: %u open edges, %u with more than two faces, %u faces without area%s",
                       r.openEdges, r.nonManifoldEdges, r.degenerateTriangles, r.inverted ? ", inside out" : "");
            ImGui::PopTextWrapPos();
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
        showPath(studio, i);
        break;
    case Kind::shape:
        showShape(studio, i);
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
