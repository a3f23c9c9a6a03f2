// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/math.h"
#include "base/state_io.h"
#include "thaw/thaw.h"

#include <algorithm>

namespace thaw {

// A validated material with what the inner loops need ready. The one thermal state is the specific enthalpy H in J/kg:
//   H < 0: solid, T = Ts + H / cs;  0..L: melting, T from solidus to liquidus;  H > L: liquid, T = Tl + (H - L) / cl.
// With a melting range and latentHeat 0, the range still needs heat: L is at least the mean specific heat times the
// range.
// What a step reads of a definition.
inline thawMaterialDef stepped(thawMaterialDef d) {
    d.color = {};
    if (d.yieldStress == 0) d.flow = thawFlow_bingham;
    return d;
}

struct Material {
    thawMaterialDef def{};
    double latent = 0; // J/kg between solidus and liquidus, > 0 or exactly 0 when solidus == liquidus
    float logViscositySolid = 0, logViscosityLiquid = 0;

    explicit Material(const thawMaterialDef& d) : def(d) {
        double range = static_cast<double>(d.liquidus) - d.solidus;
        latent = d.latentHeat + 0.5 * range * (static_cast<double>(d.specificHeatSolid) + d.specificHeatLiquid);
        logViscositySolid = detLog(d.viscositySolid), logViscosityLiquid = detLog(d.viscosityLiquid);
    }
    Material() = default;
    // What a step reads of it is state; how it is shown is a report.
    void state(StateIo& io);

    bool soft() const { return def.youngModulus > 0; }
    double kelvin(double H) const {
        if (H < 0) return def.solidus + H / def.specificHeatSolid;
        if (H >= latent) return def.liquidus + (H - latent) / def.specificHeatLiquid;
        return def.solidus + (static_cast<double>(def.liquidus) - def.solidus) * (H / latent);
    }
    float temperature(double H) const { return static_cast<float>(kelvin(H)); }
    float liquidFraction(double H) const {
        if (H <= 0) return 0;
        return H >= latent ? 1.0f : static_cast<float>(H / latent);
    }
    // The same of what is unseeded (ParticleFlag): below liquidus the liquid's line goes on.
    double kelvin(double H, bool unseeded) const {
        return unseeded ? def.liquidus + (H - latent) / def.specificHeatLiquid : kelvin(H);
    }
    float liquidFraction(double H, bool unseeded) const { return unseeded ? 1.0f : liquidFraction(H); }
    double enthalpy(double T, bool unseeded) const {
        return unseeded ? latent + (T - def.liquidus) * def.specificHeatLiquid : enthalpy(T);
    }
    // What is unseeded stays so down to here; and never where a solid has more heat at 0 K.
    double undercooledEnthalpy() const {
        const double coldest = static_cast<double>(def.solidus) - def.undercooling;
        return std::max(latent + (coldest - def.liquidus) * def.specificHeatLiquid, enthalpyFloor());
    }
    double enthalpy(double T) const {
        if (T < def.solidus) return (T - def.solidus) * def.specificHeatSolid;
        if (T > def.liquidus || def.liquidus == def.solidus)
            return T > def.liquidus ? latent + (T - def.liquidus) * def.specificHeatLiquid : 0.0;
        return latent * (T - def.solidus) / (static_cast<double>(def.liquidus) - def.solidus);
    }
    // Lowest possible enthalpy: 0 K.
    double enthalpyFloor() const { return -static_cast<double>(def.solidus) * def.specificHeatSolid; }
    // Log blend: a linear one keeps mush solid until it is all but molten.
    float viscosity(float phi) const { return detExp((1 - phi) * logViscositySolid + phi * logViscosityLiquid); }
    // Pa s at shear rate in 1/s, above mu: what the yield stress adds to it. tau / rate - mu of thawFlow, with the rate
    // kept from zero: a melt below its yield stress creeps.
    float yieldViscosity(float mu, float rate) const {
        constexpr float kCreep = 1e-3f; // 1/s, of what is at half its yield stress
        const float thick = def.yieldStress / (rate + kCreep);
        return def.flow == thawFlow_casson ? thick + 2 * std::sqrt(thick * mu) : thick;
    }
    // Solid and liquid in series: what melts is a front that heat crosses. Side by side (the plain mean) melting ice is
    // 4.3 % ahead of Stefan's front at 6 layers, this way 2.9 %.
    float conductivity(float phi) const {
        const float a = def.conductivitySolid, b = def.conductivityLiquid;
        const float mix = phi * a + (1 - phi) * b;
        return mix > 0 ? a * b / mix : 0;
    }
};

inline void Material::state(StateIo& io) {
    thawMaterialDef d = io.hashes() ? stepped(def) : def;
    io(d);
    if (!io.restores()) return;
    const bool sound = d.density >= 1 && d.solidus > 0 && d.liquidus >= d.solidus && d.latentHeat >= 0 &&
                       d.specificHeatSolid >= 1 && d.specificHeatLiquid >= 1 && d.viscositySolid > 0 &&
                       d.viscosityLiquid > 0 && d.releaseFraction >= d.setFraction;
    if (!sound) return io.fail("a material that cannot be");
    *this = Material(d);
}

} // namespace thaw
