// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world_fixture.h"

#include <algorithm>
#include <limits>

namespace {

// A plate of wax 60 x 12 x 60 mm in the sun, that stays where it is.
struct Plate : WorldFixture {
    thawBodyId body{};
    explicit Plate(float sun = 1000, float absorptivity = 0.25f) {
        def.particleSpacing = 0.003f, def.gravity = {0, 0, 0}, def.convection = 0;
        create();
        thawMaterialDef m;
        thawInitMaterialDef(&m, thawMaterial_wax);
        m.absorptivity = absorptivity, m.emissivity = 0, m.conductivitySolid = m.conductivityLiquid = 0;
        addMaterial(m);
        addFloor();
        body = addBox({0, 0, 0}, {0.06f, 0.012f, 0.06f}, 300);
        if (sun == 0) return;
        thawHeatSourceDef d;
        thawInitHeatSourceDef(&d);
        d.type = thawHeatSource_directional, d.irradiance = sun;
        d.rotation = {1, 0, 0, 0}; // downward
        thawHeatSourceId id;
        REQUIRE(thawCreateHeatSource(world, &d, &id) == thawResult_ok);
    }
    // Sum over the particles of what f(position, row) gives.
    template <class F> double over(F&& f) const {
        const thawParticleView v = particles();
        double sum = 0;
        for (int i = 0; i < v.count; ++i)
            sum += f(thawVec3{v.positions[4 * i], v.positions[4 * i + 1], v.positions[4 * i + 2]}, i);
        return sum;
    }
};

constexpr thawVec3 kMiddle{0.03f, 0.012f, 0.03f};
double farFrom(thawVec3 c, thawVec3 x) { return std::hypot(x.x - c.x, std::hypot(x.y - c.y, x.z - c.z)); }

} // namespace

TEST_CASE("paint: a black spot absorbs what it should, whole inside and fading at its edge") {
    for (const float falloff : {0.0f, 0.5f, 1.0f}) {
        CAPTURE(falloff);
        Plate plain, spot;
        const thawBrush brush{kMiddle, 0.015f, falloff};
        int32_t painted = 0;
        REQUIRE(thawBody_PaintAbsorptivity(spot.world, spot.body, &brush, 1, &painted) == thawResult_ok);
        CHECK(painted > 100);
        const auto share = [&](thawVec3 x) { // of the brush
            const double off = farFrom(kMiddle, x) / 0.015;
            return off > 1                                   ? 0.0
                   : off <= 1 - static_cast<double>(falloff) ? 1.0
                                                             : (1 - off) / static_cast<double>(falloff);
        };
        plain.step(), spot.step();
        CHECK(plain.ledger().absorbed == doctest::Approx(0.25 * 1000 * 0.06 * 0.06 / 60).epsilon(0.05));
        const thawParticleView v = spot.particles();
        const double more = spot.over([&](thawVec3 x, int i) {
            const double up = std::max(0.0f, v.normals[4 * i + 1]);
            return share(x) * 0.75 * 1000 * up * static_cast<double>(v.normals[4 * i + 3]) / 60;
        });
        CHECK(more > 0.0025);
        CHECK(spot.ledger().absorbed - plain.ledger().absorbed == doctest::Approx(more).epsilon(0.005));
        CHECK(spot.ledger().energyError < 1e-9);
        const double off = spot.over([&](thawVec3 x, int i) {
            const double is = share(x) > 0 ? (v.absorptivities[i] - 1) / 254.0 : v.absorptivities[i] ? 9.0 : 0.25;
            return std::abs(is - (0.25 + share(x) * 0.75)) > 0.6 / 254;
        });
        CHECK(off == 0);
        // White: nothing more, though what was absorbed is known.
        const thawBrush all{kMiddle, 1, 0};
        REQUIRE(thawBody_PaintAbsorptivity(spot.world, spot.body, &all, 0, &painted) == thawResult_ok);
        CHECK(painted == v.count);
        const double before = spot.ledger().absorbed;
        spot.step();
        CHECK(spot.ledger().absorbed == before);
    }
}

TEST_CASE("paint: temperature is exact, booked, and melts") {
    Plate f(0);
    const thawBrush brush{kMiddle, 0.01f, 0};
    int32_t painted = 0;
    for (const float kelvin : {0.0f, 250.0f, 327.5f, 400.0f, 1e5f, 400.0f}) {
        CAPTURE(kelvin);
        const double before = f.ledger().energyNow;
        const double added = f.ledger().painted;
        REQUIRE(thawBody_PaintTemperature(f.world, f.body, &brush, kelvin, &painted) == thawResult_ok);
        CHECK(painted > 50);
        const thawParticleView v = f.particles();
        int seen = 0;
        for (int i = 0; i < v.count; ++i) {
            const bool in =
                farFrom(kMiddle, {v.positions[4 * i], v.positions[4 * i + 1], v.positions[4 * i + 2]}) <= 0.01;
            seen += in;
            REQUIRE(v.temperatures[i] == doctest::Approx(in ? kelvin : 300.0f).epsilon(1e-6));
            REQUIRE(v.liquidFractions[i] == (in && kelvin > 331   ? 1.0f
                                             : in && kelvin > 320 ? v.liquidFractions[i]
                                                                  : 0.0f));
        }
        CHECK(seen == painted);
        CHECK(f.ledger().painted - added == doctest::Approx(f.ledger().energyNow - before).epsilon(1e-9));
        CHECK(f.ledger().energyError < 1e-9);
    }
    CHECK(f.counters().meltedFraction > 0);
    f.step(5);
    CHECK(f.counters().moving == painted);
    CHECK(f.ledger().energyError < 1e-9);
    // Fading: halfway out, half of the way.
    Plate g(0);
    const thawBrush soft{kMiddle, 0.02f, 1};
    REQUIRE(thawBody_PaintTemperature(g.world, g.body, &soft, 310, nullptr) == thawResult_ok);
    const thawParticleView v = g.particles();
    for (int i = 0; i < v.count; ++i) {
        const double off =
            farFrom(kMiddle, {v.positions[4 * i], v.positions[4 * i + 1], v.positions[4 * i + 2]}) / 0.02;
        REQUIRE(v.temperatures[i] == doctest::Approx(300 + 10 * std::max(0.0, 1 - off)).epsilon(1e-6));
    }
}

TEST_CASE("paint: only the body that is named, refused with its reason, part of the state") {
    Plate f(0);
    const thawBodyId other = f.addBox({0.07f, 0, 0}, {0.09f, 0.01f, 0.02f}, 300);
    const thawBrush all{{0, 0, 0}, 10, 0};
    uint64_t hash = thawWorld_GetStateHash(f.world);
    const auto refused = [&](thawBrush brush, float value, const char* field, thawResult why) {
        CAPTURE(field);
        int32_t painted = 7;
        CHECK(thawBody_PaintTemperature(f.world, f.body, &brush, value, &painted) == why);
        CHECK(painted == 0);
        CHECK(std::string(thawWorld_GetLastError(f.world)).find(field) != std::string::npos);
        CHECK(thawBody_PaintAbsorptivity(f.world, f.body, &brush, value, &painted) == why);
        CHECK(thawWorld_GetStateHash(f.world) == hash);
    };
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
    for (const float bad : {kNan, kInf, -1.0f}) {
        refused(all, bad, "temperature", thawResult_invalidArgument);
        refused({{0, 0, 0}, bad, 0}, 0.5f, "brush.radius", thawResult_invalidArgument);
        refused({{0, 0, 0}, 1, bad}, 0.5f, "brush.falloff", thawResult_invalidArgument);
    }
    refused({{0, kNan, 0}, 1, 0}, 0.5f, "brush.center", thawResult_invalidArgument);
    CHECK(thawBody_PaintAbsorptivity(f.world, f.body, &all, 1.01f, nullptr) == thawResult_invalidArgument);
    CHECK(thawBody_PaintTemperature(f.world, f.body, &all, 1.01e5f, nullptr) == thawResult_invalidArgument);
    CHECK(thawBody_PaintTemperature(f.world, f.body, nullptr, 300, nullptr) == thawResult_invalidArgument);
    CHECK(thawBody_PaintTemperature(f.world, {}, &all, 300, nullptr) == thawResult_staleId);
    CHECK(thawBody_PaintAbsorptivity(nullptr, f.body, &all, 1, nullptr) == thawResult_invalidArgument);
    CHECK(thawWorld_GetStateHash(f.world) == hash);

    thawBodyState state;
    REQUIRE(thawBody_PaintTemperature(f.world, other, &all, 310, nullptr) == thawResult_ok);
    REQUIRE(thawBody_GetState(f.world, other, &state) == thawResult_ok);
    CHECK(state.meanTemperature == doctest::Approx(310));
    REQUIRE(thawBody_GetState(f.world, f.body, &state) == thawResult_ok);
    CHECK(state.meanTemperature == doctest::Approx(300));
    CHECK(thawWorld_GetStateHash(f.world) != hash);
    hash = thawWorld_GetStateHash(f.world);
    int32_t painted = 0;
    REQUIRE(thawBody_PaintAbsorptivity(f.world, other, &all, 0.5f, &painted) == thawResult_ok);
    REQUIRE(thawBody_GetState(f.world, other, &state) == thawResult_ok);
    CHECK(painted == state.particles);
    CHECK(thawWorld_GetStateHash(f.world) != hash);
    // It stays with the particles through sorting and flowing.
    f.step(30);
    const thawParticleView v = f.particles();
    for (int i = 0; i < v.count; ++i) REQUIRE(v.absorptivities[i] == (v.bodies[i] == other.index1 - 1 ? 128 : 0));
    const thawBrush nothing{{5, 5, 5}, 1, 0};
    REQUIRE(thawBody_PaintTemperature(f.world, other, &nothing, 310, &painted) == thawResult_ok);
    CHECK(painted == 0);
}
