// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Conduction against the series and similarity solutions of Carslaw and Jaeger.
#include "heat_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <initializer_list>

using namespace thaw;

namespace {

constexpr double kPi = 3.14159265358979323846;

// A bar along x whose first and last `held` layers are put back to their temperature after every step. The plane that
// is held is the centre of the innermost held layer.
struct Bar : HeatFixture {
    using HeatFixture::HeatFixture;
    int layers = 0, held = 2;
    int layerOf(size_t row) const { return static_cast<int>(particles.position[row].x / spacing); }
    void hold(float left, float right) {
        for (size_t i = 0; i < size(); ++i) {
            if (layerOf(i) < held) setTemperature(i, left);
            if (layerOf(i) >= layers - held) setTemperature(i, right);
        }
    }
};

} // namespace

TEST_CASE("heat: slab with both faces held follows the series") {
    Bar f(0.01f);
    f.ambient = 0; // kelvin of the test count from 100
    f.layers = 23, f.held = 2;
    f.addBlock({0, 0, 0}, f.layers, 7, 7, [](Vec3) { return 101.0f; });
    f.build();
    const double length = (f.layers - 2 * f.held + 1) * 0.01, alpha = 1e-6, dt = 5;
    double t = 0;
    for (double fo : {0.05, 0.1, 0.2}) {
        while (t < fo * length * length / alpha) {
            f.hold(100, 100);
            f.step(dt, Bar::kConduction);
            t += dt;
        }
        f.hold(100, 100);
        CAPTURE(fo);
        const double now = alpha * t / (length * length);
        // Layer by layer, and the mean of the cross-section.
        for (int layer = f.held; layer < f.layers - f.held; ++layer) {
            double sum = 0;
            int n = 0;
            for (size_t i = 0; i < f.size(); ++i)
                if (f.layerOf(i) == layer) sum += f.particles.temperature[i] - 100, ++n;
            const double x = (layer - f.held + 1) * 0.01 / length;
            CHECK(sum / n == doctest::Approx(slab(x, now)).epsilon(0.02).scale(0));
        }
    }
}

TEST_CASE("heat: an insulated cosine decays at the nominal rate") {
    // Through sub-cycles and through the implicit solve alike.
    for (double dt : {10.0, 100.0, 400.0}) {
        HeatFixture f(0.01f);
        f.cycles = 8;
        const int n = 20;
        const double L = n * 0.01, k = kPi / L, alpha = 1e-6;
        f.addBlock({0, 0, 0}, n, 8, 8, [&](Vec3 x) { return static_cast<float>(300 + 10 * std::cos(k * x.x)); });
        f.build();
        const double before = f.energy();
        const int steps = static_cast<int>(1 / (alpha * k * k * dt));
        for (int s = 0; s < steps; ++s) f.step(dt, HeatFixture::kConduction);
        double a = 0, norm = 0;
        for (size_t i = 0; i < f.size(); ++i) {
            const double c = std::cos(k * static_cast<double>(f.particles.position[i].x));
            a += c * (f.particles.enthalpy[i] - f.materials[0].enthalpy(300)) / 1000, norm += 10 * c * c;
        }
        CAPTURE(dt);
        // Backward Euler decays by 1 / (1 + x) a step instead of exp(-x).
        const double x = alpha * k * k * dt;
        const double expected = dt > 200 ? std::pow(1 + x, -steps) : std::exp(-x * steps);
        CHECK(-std::log(a / norm) == doctest::Approx(-std::log(expected)).epsilon(0.015).scale(0));
        CHECK(std::abs(f.energy() - before) < 1e-12 * std::abs(before));
    }
}

TEST_CASE("heat: two half-spaces in contact take the temperature between their effusivities") {
    for (float ratio : {10.0f, 100.0f}) {
        Bar f(0.01f);
        thawMaterialDef slow = HeatFixture::plain(), fast = HeatFixture::plain();
        fast.conductivitySolid = ratio;
        f.addMaterial(slow), f.addMaterial(fast);
        const int left = 20, right = ratio > 50 ? 120 : 50;
        f.ambient = 350;
        f.addBlock(
            {0, 0, 0}, left + right, 5, 5, [&](Vec3 x) { return x.x < 0.2f ? 400.0f : 300.0f; },
            [&](Vec3 x) { return x.x < 0.2f ? 0 : 1; });
        f.build();
        const double a1 = 1e-6, a2 = a1 * static_cast<double>(ratio);
        // Until the cold side has been reached five spacings deep.
        const double end = 0.05 * 0.05 / (4 * a1), dt = 0.2 / (4 * a2 / 1e-4);
        const int steps = static_cast<int>(end / dt);
        for (int s = 0; s < steps; ++s) f.step(dt, HeatFixture::kConduction);
        const double t = steps * dt, e1 = std::sqrt(1.0 * 1e6), e2 = std::sqrt(static_cast<double>(ratio) * 1e6);
        const double contact = (e1 * 400 + e2 * 300) / (e1 + e2);
        CAPTURE(ratio);
        double worst = 0, passed = 0;
        for (size_t i = 0; i < f.size(); ++i) {
            const double x = static_cast<double>(f.particles.position[i].x) - 0.2, T = f.particles.temperature[i];
            const double exact = x < 0 ? 400 + (contact - 400) * std::erfc(-x / (2 * std::sqrt(a1 * t)))
                                       : 300 + (contact - 300) * std::erfc(x / (2 * std::sqrt(a2 * t)));
            worst = std::max(worst, std::abs(T - exact));
            if (x < 0) passed += (400 - T) * 1000 * 1000 * 1e-6;
        }
        CHECK(worst < 3); // of 100 K
        const double exact = 2 * e1 * (400 - contact) * std::sqrt(t / kPi) * 25 * 1e-4;
        CHECK(passed == doctest::Approx(exact).epsilon(0.03).scale(0));
    }
}

TEST_CASE("heat: the Stefan front in wax and in ice") {
    struct Case {
        const char* name;
        float density, conductivity, heat, latent, melting, wall;
        double lambda; // lambda e^(lambda^2) erf lambda = St / sqrt(pi)
    };
    for (const Case& c : {Case{"wax", 880, 0.15f, 2400, 190e3f, 328.15f, 353.15f, 0.37864486},
                          Case{"water", 1000, 0.56f, 4218, 333.6e3f, 273.15f, 293.15f, 0.34189118}}) {
        Bar f(0.001f);
        thawMaterialDef d = HeatFixture::plain();
        d.density = c.density, d.solidus = d.liquidus = c.melting, d.latentHeat = c.latent;
        d.specificHeatSolid = d.specificHeatLiquid = c.heat;
        d.conductivitySolid = d.conductivityLiquid = c.conductivity;
        f.addMaterial(d);
        f.layers = 22, f.held = 2;
        f.ambient = c.melting;
        f.addBlock({0, 0, 0}, f.layers, 6, 6, [&](Vec3) { return c.melting; });
        f.build();
        const double alpha = static_cast<double>(c.conductivity) / (static_cast<double>(c.density) * c.heat);
        const double dt = 0.15 * 1e-6 / alpha;
        double t = 0;
        CAPTURE(c.name);
        for (double depth : {6.0, 10.0, 14.0}) {
            const double end = std::pow(depth * 1e-3 / (2 * c.lambda), 2) / alpha;
            while (t < end) {
                for (size_t i = 0; i < f.size(); ++i)
                    if (f.layerOf(i) < f.held) f.setTemperature(i, c.wall);
                f.step(dt, HeatFixture::kConduction);
                t += dt;
            }
            double molten = 0;
            for (size_t i = 0; i < f.size(); ++i)
                if (f.layerOf(i) >= f.held) molten += static_cast<double>(f.particles.liquidFraction[i]);
            const double front = (0.5 + molten / 36) * 1e-3;
            CAPTURE(depth);
            CHECK(front == doctest::Approx(2 * c.lambda * std::sqrt(alpha * t)).epsilon(0.05).scale(0));
        }
    }
}

TEST_CASE("heat: conduction never overshoots, at any time step") {
    for (double dt : {1.0, 9.0, 12.0, 14.0, 17.0, 25.0, 60.0, 200.0, 300.0, 1e4, 1e7}) {
        HeatFixture f(0.01f);
        f.addMaterial(HeatFixture::plain());
        thawMaterialDef melts = HeatFixture::plain();
        melts.solidus = 340, melts.liquidus = 341, melts.conductivityLiquid = 50;
        f.addMaterial(melts);
        // One hot particle in the cold, a hot corner, two materials.
        f.addBlock(
            {0, 0, 0}, 9, 9, 9, [](Vec3 x) { return x.x < 0.03f && x.y < 0.03f ? 400.0f : 290.0f; },
            [](Vec3 x) { return x.z < 0.045f ? 0 : 1; });
        f.build();
        size_t hot = 0;
        for (size_t i = 0; i < f.size(); ++i)
            if (length(f.particles.position[i].xyz() - Vec3{0.065f, 0.065f, 0.045f}) < 0.006f) hot = i;
        f.setTemperature(hot, 1000);
        double before = 0;
        const auto energy = [&] { // from 0 K
            double e = 0;
            for (size_t i = 0; i < f.size(); ++i)
                e += f.particles.velocity[i].w *
                     (f.particles.enthalpy[i] - f.materials[f.particles.material[i]].enthalpyFloor());
            return e;
        };
        before = energy();
        float high = 1000;
        CAPTURE(dt);
        for (int s = 0; s < 20; ++s) {
            f.step(dt, HeatFixture::kConduction);
            float low = 1e9f, top = 0;
            for (size_t i = 0; i < f.size(); ++i)
                low = std::min(low, f.particles.temperature[i]), top = std::max(top, f.particles.temperature[i]);
            REQUIRE(low >= 290 - 1e-3f);
            REQUIRE(top <= high + 1e-3f);
            high = top;
        }
        CHECK(std::abs(energy() - before) < 1e-12 * before);
        if (dt >= 1e7) CHECK(high < 345); // all but even
    }
}

TEST_CASE("heat: a hot spot never leaves its neighbours colder than before, around the explicit limit") {
    for (double dt = 12; dt < 60; dt += 4) {
        HeatFixture f(0.01f);
        f.addBlock({0, 0, 0}, 9, 9, 9, [](Vec3) { return 290.0f; });
        f.build();
        for (size_t i = 0; i < f.size(); ++i)
            if (length(f.particles.position[i].xyz() - Vec3{0.045f, 0.045f, 0.045f}) < 0.005f)
                f.setTemperature(i, 1000);
        CAPTURE(dt);
        for (int s = 0; s < 4; ++s) {
            f.step(dt, HeatFixture::kConduction);
            for (size_t i = 0; i < f.size(); ++i) REQUIRE(f.particles.temperature[i] >= 290 - 1e-3f);
        }
    }
}

TEST_CASE("heat: bodies of one temperature sleep, whom something warmer touches does not") {
    // Two bodies that touch, of which one is warmer; one alone that is warm inside; one alone that is not.
    const auto bodyOf = [](Vec3 x) {
        return static_cast<uint16_t>(x.x < 0.05f ? 0 : x.x < 0.2f ? 1 : x.x < 0.4f ? 2 : 3);
    };
    std::vector<double> apart;
    for (const int told : {0, 4}) {
        HeatFixture f(0.01f);
        f.bodyCount = told;
        f.addBlock({0, 0, 0}, 5, 5, 5, [](Vec3) { return 300.0f; });
        f.addBlock({0.05f, 0, 0}, 5, 5, 5, [](Vec3) { return 310.0f; });
        f.addBlock({0.3f, 0, 0}, 5, 5, 5, [](Vec3 x) { return 300.0f + 10 * x.x; });
        f.addBlock({0.5f, 0, 0}, 5, 5, 5, [](Vec3) { return 305.0f; });
        f.build();
        const auto mark = [&] {
            for (size_t i = 0; i < f.size(); ++i) f.particles.body[i] = bodyOf(f.particles.position[i].xyz());
        };
        mark();
        const double before = f.energy();
        const std::vector<double> start = f.enthalpies();
        for (int k = 0; k < 50; ++k) f.step(5, HeatFixture::kConduction);
        CHECK(f.heat.stats().sleeping == (told ? 125 : 0));
        CHECK(f.energy() == doctest::Approx(before).epsilon(1e-12));
        const std::vector<double> h = f.enthalpies();
        if (told == 0) {
            apart = h;
            continue;
        }
        for (size_t id = 0; id < h.size(); ++id) {
            if (id >= 375) REQUIRE(h[id] == start[id]);
            REQUIRE(h[id] == doctest::Approx(apart[id]).epsilon(1e-9));
        }
        CHECK(std::abs(h[0] - start[0]) > 10);
        CHECK(std::abs(h[250] - start[250]) > 10);
        // A wall that is warmer wakes it, and so does a thousandth of a degree and more within.
        Collider wall = box({0.525f, -0.1f, 0.025f}, {0.05f, 0.1f, 0.05f});
        wall.temperature = 306;
        f.colliders = {wall};
        f.step(5, HeatFixture::kConduction);
        CHECK(f.heat.stats().sleeping == 0);
        CHECK(f.total.contact > 0);
        f.colliders.clear();
        for (size_t i = 0; i < f.size(); ++i) f.setTemperature(i, i == 0 ? 305.01f : 305.0f);
        const uint16_t warm = f.particles.body[0];
        f.step(1e-3, HeatFixture::kConduction);
        CHECK(f.heat.stats().sleeping == (warm < 2 ? 250 : 375));
    }
}
