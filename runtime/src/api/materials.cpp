// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "api/defs.h"

namespace thaw {
namespace {

struct Preset {
    const char* name;
    float density, solidus, liquidus, latent, cs, cl, ks, kl, muSolid, muLiquid, yield, absorptivity, emissivity;
    float cohesion, adhesion;
    thawVec3 color;
    thawFlow flow = thawFlow_bingham;
};

// third_party_notes/data_sources.md says where each number is from. One density for both phases (their mean where they
// differ).
constexpr Preset kPresets[thawMaterial_presetCount] = {
    {"wax",
     830,
     325.15f,
     331.15f,
     190e3f,
     2200,
     2400,
     0.24f,
     0.15f,
     1e4f,
     5e-3f,
     0,
     0.7f,
     0.94f,
     6,
     0.5f,
     {0.93f, 0.86f, 0.70f}},
    {"chocolate",
     1270,
     302.15f,
     307.15f,
     46e3f,
     1590,
     1670,
     0.24f,
     0.26f,
     1e4f,
     8.7f,
     36.0f,
     0.9f,
     0.92f,
     6,
     0.5f,
     {0.17f, 0.07f, 0.03f}},
    {"butter",
     911,
     283.15f,
     310.15f,
     100e3f,
     2200,
     2100,
     0.2f,
     0.17f,
     2e3f,
     0.035f,
     0,
     0.8f,
     0.92f,
     6,
     0.5f,
     {0.95f, 0.78f, 0.30f}},
    {"ice",
     958,
     272.65f,
     273.65f,
     333.6e3f,
     2110,
     4218,
     2.14f,
     0.56f,
     1e5f,
     1.8e-3f,
     0,
     0.9f,
     0.96f,
     6,
     0.5f,
     {0.75f, 0.88f, 0.95f}},
    {"icecream",
     550,
     255.15f,
     271.15f,
     175e3f,
     3000,
     3300,
     0.25f,
     0.3f,
     3e3f,
     0.4f,
     0,
     0.85f,
     0.95f,
     6,
     0.5f,
     {0.96f, 0.80f, 0.78f}},
    {"darkchocolate",
     1270,
     302.15f,
     307.15f,
     46e3f,
     1590,
     1670,
     0.24f,
     0.26f,
     1e4f,
     6.056f,
     29.02f,
     0.92f,
     0.92f,
     6,
     0.5f,
     {0.07f, 0.03f, 0.015f},
     thawFlow_casson},
    {"aluminium",
     2460,
     932.97f,
     933.97f,
     397e3f,
     1080,
     1180,
     211,
     94,
     1e5f,
     1.3e-3f,
     0,
     0.2f,
     0.2f,
     6,
     0.5f,
     {0.8f, 0.81f, 0.83f}},
    {"iron",
     7100,
     1810.5f,
     1811.5f,
     247e3f,
     760,
     820,
     34,
     33,
     1e5f,
     6e-3f,
     0,
     0.35f,
     0.3f,
     6,
     0.5f,
     {0.45f, 0.44f, 0.43f}},
    {"lava",
     2700,
     1273.15f,
     1473.15f,
     375e3f,
     1200,
     1200,
     1.5f,
     1.5f,
     1e6f,
     100,
     0,
     0.95f,
     0.95f,
     6,
     0.5f,
     {0.06f, 0.05f, 0.05f}},
};

} // namespace

thawMaterialDef materialPreset(thawMaterialPreset preset) {
    const bool known = preset >= 0 && preset < thawMaterial_presetCount;
    const Preset& p = kPresets[known ? preset : thawMaterial_wax];
    thawMaterialDef d{};
    d.structSize = sizeof d, d.cookie = kDefCookie;
    d.density = p.density;
    d.solidus = p.solidus, d.liquidus = p.liquidus, d.latentHeat = p.latent;
    d.specificHeatSolid = p.cs, d.specificHeatLiquid = p.cl;
    d.conductivitySolid = p.ks, d.conductivityLiquid = p.kl;
    d.viscositySolid = p.muSolid, d.viscosityLiquid = p.muLiquid;
    d.yieldStress = p.yield, d.flow = p.flow;
    d.absorptivity = p.absorptivity, d.emissivity = p.emissivity;
    d.cohesion = p.cohesion, d.adhesion = p.adhesion;
    d.setFraction = 0.35f, d.releaseFraction = 0.6f;
    d.color = p.color;
    d.burnRate = 1;
    return d;
}

const char* materialPresetName(thawMaterialPreset preset) {
    return preset >= 0 && preset < thawMaterial_presetCount ? kPresets[preset].name : nullptr;
}

} // namespace thaw
