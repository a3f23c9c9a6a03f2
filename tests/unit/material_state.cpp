// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "particles/material.h"

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>

using namespace thaw;

namespace {

thawMaterialDef wax() {
    thawMaterialDef d{};
    d.density = 880, d.solidus = 325, d.liquidus = 331, d.latentHeat = 190e3f;
    d.specificHeatSolid = 2200, d.specificHeatLiquid = 2400, d.conductivitySolid = 0.24f, d.conductivityLiquid = 0.15f;
    d.viscositySolid = 1e4f, d.viscosityLiquid = 0.01f;
    return d;
}

} // namespace

TEST_CASE("material: temperature and enthalpy are inverse, and both rise") {
    thawMaterialDef sharp = wax(), dry = wax(), both = wax();
    sharp.solidus = sharp.liquidus;
    dry.latentHeat = 0;
    both.solidus = both.liquidus, both.latentHeat = 0;
    for (const thawMaterialDef& d : {wax(), sharp, dry, both}) {
        const Material m(d);
        double last = m.enthalpyFloor() - 1;
        for (float T = 0; T < 1000; T += 0.37f) {
            const double H = m.enthalpy(T);
            REQUIRE(H > last);
            last = H;
            REQUIRE(std::abs(m.kelvin(H) - static_cast<double>(T)) < 1e-6);
        }
        // Temperature never falls with enthalpy, across both corners.
        double before = 0;
        for (double H = -2000; H < m.latent + 2000; H += 1 + m.latent * 1e-3) {
            REQUIRE(m.kelvin(H) >= before);
            before = m.kelvin(H);
        }
        CHECK(m.kelvin(m.enthalpyFloor()) == doctest::Approx(0).epsilon(1e-12));
        CHECK(m.liquidFraction(-1) == 0);
        CHECK(m.liquidFraction(m.latent + 1) == 1);
    }
}

TEST_CASE("material: the heat between solidus and liquidus") {
    const Material m(wax());
    // Latent heat, and what warms half solid half liquid through the range.
    CHECK(m.enthalpy(331) - m.enthalpy(325) == doctest::Approx(190e3 + 6 * 2300));
    CHECK(m.enthalpy(325) - m.enthalpy(315) == doctest::Approx(22000));
    CHECK(m.enthalpy(341) - m.enthalpy(331) == doctest::Approx(24000));
    CHECK(m.liquidFraction(0.25 * m.latent) == doctest::Approx(0.25));
    CHECK(m.conductivity(0.5f) == doctest::Approx(2 * 0.24f * 0.15f / (0.24f + 0.15f)));
    // Log blend.
    CHECK(m.viscosity(0.5f) == doctest::Approx(10).epsilon(1e-4).scale(0));
    CHECK(m.viscosity(0) == doctest::Approx(1e4).epsilon(1e-4).scale(0));
    CHECK(m.viscosity(1) == doctest::Approx(0.01).epsilon(1e-4).scale(0));
}

TEST_CASE("material: a yield stress is what remains of the stress when the shear rate goes to zero") {
    thawMaterialDef d = wax();
    d.yieldStress = 36;
    for (const float mu : {0.5f, 8.7f})
        for (const float rate : {0.5f, 5.0f, 50.0f}) {
            d.flow = thawFlow_bingham;
            const double bingham = static_cast<double>((mu + Material(d).yieldViscosity(mu, rate)) * rate);
            CHECK(bingham == doctest::Approx(36 + static_cast<double>(mu * rate)).epsilon(0.003));
            d.flow = thawFlow_casson;
            const double casson = static_cast<double>((mu + Material(d).yieldViscosity(mu, rate)) * rate);
            CHECK(std::sqrt(casson) ==
                  doctest::Approx(std::sqrt(36.0) + std::sqrt(static_cast<double>(mu * rate))).epsilon(0.003));
        }
    d.flow = thawFlow_bingham;
    CHECK(Material(d).yieldViscosity(1, 0) * 1e-3f == doctest::Approx(36)); // no more than this at rest
    d.yieldStress = 0;
    CHECK(Material(d).yieldViscosity(1, 0) == 0);
}
