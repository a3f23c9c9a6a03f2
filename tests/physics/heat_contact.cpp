// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Walls that heat and cool what touches them: a pan, a cold plate, a hand.
#include "heat_fixture.h"
#include "world_fixture.h"

#include <doctest/doctest.h>

#include <initializer_list>

using namespace thaw;

namespace {

constexpr double kPi = 3.14159265358979323846;

Collider plate(Vec3 at, Quat turn, float temperature, float conductance = INFINITY) {
    Collider c;
    c.transform = {at, turn, 1}, c.alive = true;
    c.temperature = temperature, c.conductance = conductance;
    return c;
}
// Local +y to +x and to -x.
const float kHalf = std::sqrt(0.5f);
const Quat kRight{0, 0, -kHalf, kHalf}, kLeft{0, 0, kHalf, kHalf};

// A bar along x of `layers`, between two plates, each `gap` spacings from the centres of the first layer.
struct Pressed : HeatFixture {
    int layers = 20;
    double length = 0;
    Pressed(float gap, float left, float right, float start, float conductance = INFINITY) : HeatFixture(0.01f) {
        length = (layers - 1 + 2 * static_cast<double>(gap)) * 0.01;
        const float edge = (0.5f - gap) * 0.01f;
        colliders = {plate({edge, 0, 0}, kRight, left, conductance),
                     plate({edge + static_cast<float>(length), 0, 0}, kLeft, right, conductance)};
        addBlock({0, 0, 0}, layers, 13, 13, [=](Vec3) { return start; });
        build();
    }
    double at(size_t row) const { return static_cast<double>(particles.position[row].x) - 0.005; }
};

} // namespace

TEST_CASE("heat: slab pressed between two plates follows the series") {
    for (const float gap : {0.5f, 0.35f})
        for (const double dt : {5.0, 40.0, 100.0}) { // explicit, sub-cycled, implicit
            Pressed f(gap, 100, 100, 101);
            f.ambient = 100;
            // Of the implicit steps, which are of first order: 80 of them, 2.4 % of the last mean.
            const double tolerance = dt > 90 ? 0.035 : 0.015;
            double t = 0;
            for (const double fo : {0.05, 0.1, 0.2}) {
                const double end = fo * f.length * f.length / 1e-6;
                while (t < end - 1e-6) {
                    const double step = std::min(dt, end - t);
                    f.step(step, HeatFixture::kConduction), t += step;
                }
                double mean = 0, exact = 0, centre = 0;
                int middle = 0;
                for (size_t i = 0; i < f.size(); ++i) {
                    const double x = (f.at(i) + static_cast<double>(gap) * 0.01) / f.length;
                    mean += static_cast<double>(f.particles.temperature[i]) - 100, exact += slab(x, fo);
                    if (std::abs(x - 0.5) * f.length > 0.006) continue;
                    centre += static_cast<double>(f.particles.temperature[i]) - 100, ++middle;
                }
                CAPTURE(gap);
                CAPTURE(dt);
                CAPTURE(fo);
                CHECK(mean == doctest::Approx(exact).epsilon(tolerance));
                CHECK(centre / middle == doctest::Approx(slab(0.475, fo)).epsilon(tolerance));
            }
            // What came in is what there is.
            CHECK(f.total.contact == doctest::Approx(f.energy() - f.mass() * 1000 * (101 - 5000)).epsilon(1e-9));
        }
}

TEST_CASE("heat: a plate of finite conductance is in series with the melt") {
    // Steady, from 400 K to 300 K through 1 / h, the slab, and 1 / h.
    const float h = 20;
    Pressed f(0.5f, 400, 300, 350, h);
    for (int k = 0; k < 400; ++k) f.step(400, HeatFixture::kConduction);
    const double flux = 100 / (2 / static_cast<double>(h) + f.length / 1);
    double first = 0;
    int n = 0;
    for (size_t i = 0; i < f.size(); ++i)
        if (f.at(i) < 0.001) first += static_cast<double>(f.particles.temperature[i]), ++n;
    CHECK(first / n == doctest::Approx(400 - flux * (1 / static_cast<double>(h) + 0.005)).epsilon(0.0005));
    const double before = f.total.contact;
    // And the flux that goes in is the flux that goes out.
    f.colliders[1].temperature = NAN;
    f.step(1, HeatFixture::kConduction);
    CHECK(f.total.contact - before == doctest::Approx(flux * 0.13 * 0.13).epsilon(0.015));
}

TEST_CASE("heat: contact never overshoots and stays finite, at any time step and conductance") {
    for (const double dt : {1e-4, 1.0, 100.0, 1e4, 1e9})
        for (const float h : {1e-3f, 500.0f, 1e30f, INFINITY})
            for (const float wall : {0.0f, 250.0f, 1e5f}) {
                Pressed f(0.3f, wall, NAN, 300, h);
                for (int k = 0; k < 3; ++k) {
                    const double was = f.energy();
                    f.total = {};
                    f.step(dt, HeatFixture::kConduction);
                    REQUIRE(std::isfinite(f.energy()));
                    REQUIRE(std::abs(f.energy() - was - f.total.contact) <=
                            1e-9 * std::max(std::abs(was), std::abs(f.total.contact)));
                    for (size_t i = 0; i < f.size(); ++i) {
                        REQUIRE(f.particles.temperature[i] >= std::min(wall, 300.0f) - 0.01f);
                        REQUIRE(f.particles.temperature[i] <= std::max(wall, 300.0f) * 1.00001f);
                    }
                }
            }
}

TEST_CASE("heat: a turned block has its real area against a plate") {
    // A layer's centre is anywhere between 0 and 1 spacing from the wall. One small step: h A dT dt.
    for (const double degrees : {0.0, 20.0, 45.0}) {
        HeatFixture f(0.01f);
        const float a = static_cast<float>(degrees * kPi / 180), c = std::cos(a), s = std::sin(a);
        f.colliders = {plate({0, 0, 0}, {}, 310, 1)}; // 1 W/(m^2 K): the melt's part is small
        double cut = 0;
        for (int k = 0; k < 8; ++k)
            for (int j = -40; j < 40; ++j)
                for (int i = -40; i < 40; ++i) {
                    const float x = 0.01f * (static_cast<float>(i) + 0.5f), y = 0.01f * (static_cast<float>(j) + 0.5f);
                    const Vec3 p{c * x - s * y, s * x + c * y, 0.01f * static_cast<float>(k)};
                    if (p.y > 0 && p.y < 0.05f && std::abs(p.x) < 0.15f) f.add(p, 300);
                }
        f.build();
        f.step(1e-3, HeatFixture::kConduction);
        cut = 0.3 * 0.08;
        CAPTURE(degrees);
        CHECK(f.total.contact == doctest::Approx(1 / (1 + 0.005) * cut * 10 * 1e-3).epsilon(0.03));
    }
}

TEST_CASE("heat: a pan melts butter, switches off, and the ledger books it") {
    WorldFixture f;
    f.def.particleSpacing = 0.004f, f.def.thermalTimeScale = 20;
    f.create();
    f.addMaterial(thawMaterial_butter);
    thawColliderDef d;
    thawInitColliderDef(&d, thawCollider_box);
    d.position = {0, -0.01f, 0}, d.size = {0.1f, 0.01f, 0.1f};
    d.temperature = 430, d.contactConductance = 1000;
    thawColliderId pan;
    REQUIRE(thawCreateCollider(f.world, &d, &pan, nullptr) == thawResult_ok);
    const thawBodyId butter = f.addBox({-0.02f, 0, -0.02f}, {0.02f, 0.02f, 0.02f}, 278);
    f.step(90);
    CHECK(f.ledger().contact > 0);
    CHECK(f.ledger().energyError < 1e-9);
    thawBodyState state;
    REQUIRE(thawBody_GetState(f.world, butter, &state) == thawResult_ok);
    CHECK(state.meltedFraction > 0.1f);
    CHECK(f.counters().maxTemperature > 290);
    CHECK(f.counters().maxTemperature <= 430);

    const uint64_t hash = thawWorld_GetStateHash(f.world);
    REQUIRE(thawCollider_SetHeat(f.world, pan, NAN, 1000) == thawResult_ok);
    CHECK(thawWorld_GetStateHash(f.world) != hash);
    const double before = f.ledger().contact;
    f.step(5);
    CHECK(f.ledger().contact == before);
    // Cold: it takes heat away again.
    REQUIRE(thawCollider_SetHeat(f.world, pan, 260, INFINITY) == thawResult_ok);
    f.step(5);
    CHECK(f.ledger().contact < before);
    CHECK(f.ledger().energyError < 1e-9);

    // Taken from under it: what it no longer touches it no longer cools.
    REQUIRE(thawCollider_Teleport(f.world, pan, {0, -0.5f, 0}, {0, 0, 0, 1}) == thawResult_ok);
    const double left = f.ledger().contact;
    f.step();
    CHECK(f.ledger().contact == left);
    REQUIRE(thawCollider_Teleport(f.world, pan, {0, -0.01f, 0}, {0, 0, 0, 1}) == thawResult_ok);
    f.step();
    CHECK(f.ledger().contact < left);

    CHECK(thawCollider_SetHeat(f.world, pan, -1, 1) == thawResult_invalidArgument);
    CHECK(std::string(thawWorld_GetLastError(f.world)).find("temperature") != std::string::npos);
    CHECK(thawCollider_SetHeat(f.world, pan, 300, NAN) == thawResult_invalidArgument);
    CHECK(thawCollider_SetHeat(f.world, {}, 300, 1) == thawResult_staleId);
    d.contactConductance = -1;
    CHECK(thawCreateCollider(f.world, &d, &pan, nullptr) == thawResult_invalidArgument);
    CHECK(std::string(thawWorld_GetLastError(f.world)).find("contactConductance") != std::string::npos);
}
