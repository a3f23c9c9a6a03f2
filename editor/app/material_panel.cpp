// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/fields.h"
#include "app/panels.h"

#include "model/presets.h"

#include <imgui/imgui_stdlib.h>

namespace thaw::editor {

namespace {

/// Viscosity over temperature, on a logarithmic scale. Its two corners can be dragged: what is solid flows like the
/// left one, what is liquid like the right one.
void viscosityCurve(Studio& studio, size_t m) {
    const thawMaterialDef d = studio.scene().materials[m].def;
    const ImVec2 low = ImGui::GetCursorScreenPos(), size(ImGui::GetContentRegionAvail().x, 8.5f * ImGui::GetFontSize());
    const float span = std::max(d.liquidus - d.solidus, 2.0f);
    const float t0 = d.solidus - span, t1 = d.liquidus + span; // K
    const float bottom = -4, top = 7;                          // powers of ten, of the ranges in thaw.h
    const float left = 3.2f * ImGui::GetFontSize(), below = 1.4f * ImGui::GetFontSize();
    const ImVec2 a(low.x + left, low.y + 4), b(low.x + size.x - 4, low.y + size.y - below);
    const auto x = [&](float t) { return a.x + (t - t0) / (t1 - t0) * (b.x - a.x); };
    const auto y = [&](float mu) {
        return b.y - (std::log10(std::max(mu, 1e-6f)) - bottom) / (top - bottom) * (b.y - a.y);
    };
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(a, b, ImGui::GetColorU32(ImGuiCol_FrameBg), 3);
    for (int p = int(bottom); p <= int(top); p += 2) {
        const float at = y(std::pow(10.0f, float(p)));
        list.AddLine({a.x, at}, {b.x, at}, ImGui::GetColorU32(ImGuiCol_Border));
        char text[16];
        std::snprintf(text, sizeof text, "1e%d", p);
        list.AddText({low.x, at - 0.5f * ImGui::GetFontSize()}, ImGui::GetColorU32(ImGuiCol_TextDisabled), text);
    }
    list.AddRectFilled({x(d.solidus), a.y}, {x(d.liquidus), b.y}, IM_COL32(255, 180, 80, 28));
    const ImVec2 points[] = {{a.x, y(d.viscositySolid)},
                             {x(d.solidus), y(d.viscositySolid)},
                             {x(d.liquidus), y(d.viscosityLiquid)},
                             {b.x, y(d.viscosityLiquid)}};
    // Log-blended over the liquid fraction, which rises evenly from solidus to liquidus: straight here.
    list.AddPolyline(points, 4, IM_COL32(255, 200, 110, 255), 0, 2.5f);
    char text[64];
    std::snprintf(text, sizeof text, "%.1f K", double(d.solidus));
    list.AddText({x(d.solidus) - 2.2f * ImGui::GetFontSize(), b.y + 2}, ImGui::GetColorU32(ImGuiCol_TextDisabled),
                 text);
    std::snprintf(text, sizeof text, "%.1f K", double(d.liquidus));
    list.AddText({x(d.liquidus), b.y + 2}, ImGui::GetColorU32(ImGuiCol_TextDisabled), text);

    ImGui::InvisibleButton("viscosity curve", size);
    ui::note("viscosity curve");
    ui::tip("Viscosity in Pa s over temperature. Drag the corners: up and down for the viscosity, left and right for "
            "where melting begins and ends.");
    static int held = -1;
    static float from = 0, perPixel = 0;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (ImGui::IsItemActivated()) {
        const auto far = [&](ImVec2 p) { return std::hypot(p.x - mouse.x, p.y - mouse.y); };
        held = far(points[1]) < far(points[2]) ? 1 : 2;
        from = held == 1 ? d.solidus : d.liquidus;
        perPixel = (t1 - t0) / (b.x - a.x);
    }
    if (ImGui::IsItemActive() && held > 0) {
        const ImVec2 way = ImGui::GetMouseDragDelta(ImGuiMouseButton_Left, 0);
        const float mu = std::pow(10.0f, bottom + (b.y - mouse.y) / (b.y - a.y) * (top - bottom));
        const float t = from + way.x * perPixel;
        studio.edit(
            "Set viscosity curve",
            [&](scene::Scene& s) {
                thawMaterialDef& to = s.materials[m].def;
                if (held == 1) {
                    to.viscositySolid = std::clamp(mu, 1e-3f, 1e7f);
                    to.solidus = std::clamp(t, 100.0f, to.liquidus);
                    to.undercooling = std::min(to.undercooling, to.solidus - 1);
                } else {
                    to.viscosityLiquid = std::clamp(mu, 1e-4f, 1e6f);
                    to.liquidus = std::clamp(t, to.solidus, 10000.0f);
                    if (to.burnTemperature > 0) to.burnTemperature = std::max(to.burnTemperature, to.liquidus);
                }
            },
            "viscosity curve");
    }
    if (ImGui::IsItemDeactivated()) studio.endGesture(), held = -1;
    for (const int i : {1, 2}) list.AddCircleFilled(points[i], held == i ? 7.0f : 5.0f, IM_COL32(255, 230, 160, 255));
}

} // namespace

void showMaterial(Studio& studio, int index) {
    const size_t i = size_t(index);
    const auto d = [i](auto& s) -> auto& { return s.materials[i].def; };
    const auto number = [&](const char* label, auto member, const ui::Range& range, const char* help) {
        ui::real(
            studio, label, [=](auto& s) -> auto& { return d(s).*member; }, range, help);
    };

    ui::field("preset");
    ImGui::PushID("preset");
    if (ImGui::BeginCombo("##v", thawMaterialPresetName(studio.scene().materials[i].preset))) {
        for (int p = 0; p < int(thawMaterial_presetCount); ++p)
            if (ImGui::Selectable(thawMaterialPresetName(thawMaterialPreset(p))))
                studio.edit("Set preset", [&](scene::Scene& s) {
                    s.materials[i].preset = thawMaterialPreset(p);
                    thawInitMaterialDef(&s.materials[i].def, thawMaterialPreset(p));
                });
        const std::vector<std::string> own = ownPresets(studio.places);
        if (!own.empty()) ImGui::Separator();
        for (const std::string& name : own)
            if (ImGui::Selectable((name + "##own").c_str())) {
                try {
                    const scene::Material found = loadPreset(studio.places, name);
                    studio.edit("Set preset", [&](scene::Scene& s) {
                        const std::string keep = s.materials[i].name;
                        s.materials[i] = found;
                        s.materials[i].name = keep;
                    });
                } catch (const std::exception& e) {
                    studio.complain("This preset cannot be read", e.what());
                }
            }
        ImGui::EndCombo();
    }
    ui::note("preset");
    ui::tip("Numbers to begin with: third_party_notes/data_sources.md says where they are from.");
    ImGui::PopID();
    if (ui::button("Reset"))
        studio.edit("Reset material",
                    [&](scene::Scene& s) { thawInitMaterialDef(&s.materials[i].def, s.materials[i].preset); });
    ui::tip("All numbers as in the preset.");
    ImGui::SameLine();
    if (ui::button("Save as preset")) {
        try {
            savePreset(studio.places, studio.scene().materials[i]);
            studio.tell("saved the preset " + studio.scene().materials[i].name);
        } catch (const std::exception& e) {
            studio.complain("The preset is not saved", e.what());
        }
    }
    ui::tip("By its name, for every scene.");

    viscosityCurve(studio, i);
    number("solid", &thawMaterialDef::viscositySolid, {1e-3f, 1e7f, "%.3g Pa s", true},
           "Viscosity of mush, and of pieces that lost their hold.");
    number("liquid", &thawMaterialDef::viscosityLiquid, {1e-4f, 1e6f, "%.3g Pa s", true},
           "Viscosity when all is molten. Water 0.001, honey 10.");
    const thawMaterialDef now = studio.scene().materials[i].def;
    number("melts from", &thawMaterialDef::solidus, {100, now.liquidus, "%.1f K", false, 1, 0.1f}, "Solidus.");
    number("melts until", &thawMaterialDef::liquidus, {now.solidus, 10000, "%.1f K", false, 1, 0.1f}, "Liquidus.");
    ui::color(
        studio, "colour", [=](auto& s) -> auto& { return d(s).color; }, "Of the melt and the solid.");
    if (ui::section("Heat")) {
        number("latent heat", &thawMaterialDef::latentHeat, {0, 1e7f, "%.0f J/kg", false, 1, 500},
               "That melting takes, at no rise in temperature.");
        number("heat, solid", &thawMaterialDef::specificHeatSolid, {1, 1e5f, "%.0f J/kgK", true}, "Specific heat.");
        number("heat, liquid", &thawMaterialDef::specificHeatLiquid, {1, 1e5f, "%.0f J/kgK", true}, "Specific heat.");
        number("conducts, solid", &thawMaterialDef::conductivitySolid, {0, 1e4f, "%.3g W/mK", true}, "Conductivity.");
        number("conducts, liquid", &thawMaterialDef::conductivityLiquid, {0, 1e4f, "%.3g W/mK", true}, "Conductivity.");
        number("absorptivity", &thawMaterialDef::absorptivity, {0, 1, "%.2f"}, "Share of radiation that it takes up.");
        number("emissivity", &thawMaterialDef::emissivity, {0, 1, "%.2f"}, "Of thermal radiation.");
    }
    if (ui::section("Flow")) {
        static const char* const flows[] = {"Bingham", "Casson"};
        number("density", &thawMaterialDef::density, {1, 3e4f, "%.0f kg/m³", true}, "Of both phases.");
        number("yield stress", &thawMaterialDef::yieldStress, {0, 1e6f, "%.2f Pa", true}, "Below it the melt stands.");
        if (now.yieldStress > 0)
            ui::words(
                studio, "above it", [=](auto& s) -> auto& { return d(s).flow; }, flows, 2,
                "How stress grows with speed.");
        number("cohesion", &thawMaterialDef::cohesion, {0, 20, "%.1f"}, "Pull between particles: beads and drips.");
        number("adhesion", &thawMaterialDef::adhesion, {0, 5, "%.2f"}, "Pull to walls: films that cling.");
        number("sets below", &thawMaterialDef::setFraction, {0, now.releaseFraction, "%.2f"},
               "Liquid fraction at which liquid that touches a solid sets.");
        number("lets go above", &thawMaterialDef::releaseFraction, {now.setFraction, 1, "%.2f"},
               "Liquid fraction at which solid lets go.");
    }
    if (ui::section("Elastic solid", now.youngModulus > 0)) {
        number("Young's modulus", &thawMaterialDef::youngModulus, {0, 1e8f, "%.3g Pa", true}, "0: rigid.");
        if (now.youngModulus > 0) {
            number("yields at", &thawMaterialDef::solidYieldStress, {0, 1e8f, "%.3g Pa", true}, "0: never.");
            number("relaxes in", &thawMaterialDef::relaxationTime, {0, 1e9f, "%.3g s", true}, "0: never.");
            number("tears at", &thawMaterialDef::breakStrain, {0, 1, "%.2f"}, "Stretch; 0: never.");
        }
    }
    if (ui::section("Burning and undercooling", now.burnTemperature > 0 || now.undercooling > 0)) {
        ui::maybe(
            studio, "burns above", [=](auto& s) -> auto& { return d(s).burnTemperature; }, 0, now.liquidus + 80,
            "never", {now.liquidus, 1e5f, "%.0f K", false, 1, 1}, "What is hotter turns to vapour.");
        if (now.burnTemperature > 0) {
            number("vapour takes", &thawMaterialDef::vapourHeat, {0, 1e8f, "%.3g J/kg", true},
                   "Above that temperature.");
            number("burns at", &thawMaterialDef::burnRate, {0, 1e6f, "%.3g 1/s", true}, "Share a second of heat time.");
        }
        number("undercooling", &thawMaterialDef::undercooling,
               {0, std::min(1000.0f, now.solidus - 1), "%.1f K", false, 1, 0.1f},
               "Melt stays liquid so far below melting until something solid touches it.");
    }
}

} // namespace thaw::editor
