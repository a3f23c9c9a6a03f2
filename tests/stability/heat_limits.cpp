// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world_fixture.h"

#include <algorithm>
#include <limits>

namespace {

// Melt of a material that undercools, in cold air, between a seed of its own solid and a drop apart.
uint64_t undercooledHash(int threads, float& setShare) {
    WorldFixture f;
    f.def.tasks.workerCount = threads;
    f.def.particleSpacing = 0.004f, f.def.thermalTimeScale = 20, f.def.ambientTemperature = 285;
    f.create();
    thawMaterialDef m;
    thawInitMaterialDef(&m, thawMaterial_wax);
    m.undercooling = 20;
    f.addMaterial(m);
    f.addFloor();
    f.addBox({-0.04f, 0, -0.03f}, {0.01f, 0.05f, 0.03f}, 336);
    f.addBox({0.014f, 0, -0.03f}, {0.04f, 0.02f, 0.03f}, 300);
    f.addBox({0.1f, 0, 0}, {0.12f, 0.02f, 0.02f}, 336);
    f.step();
    const float before = f.counters().meltedFraction;
    f.step(240);
    setShare = before - f.counters().meltedFraction;
    CHECK(f.ledger().energyError < 1e-9);
    return thawWorld_GetStateHash(f.world);
}

} // namespace

TEST_CASE("world: melt that undercools and sets has the same state hash with 1, 2 and 3 threads") {
    float share[3];
    const uint64_t one = undercooledHash(1, share[0]);
    CHECK(undercooledHash(2, share[1]) == one);
    CHECK(undercooledHash(3, share[2]) == one);
    // Something has set that was liquid, and something is liquid still.
    CHECK(share[0] > 0.01f);
    CHECK(share[0] < 0.8f);
}

TEST_CASE("world: thermalTimeScale 0 is no heat, 1e5 stays bounded, and the rest is refused") {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
    for (const float scale : {0.0f, 1e-6f, 1e5f}) {
        CAPTURE(scale);
        WorldFixture f;
        f.def.particleSpacing = 0.004f, f.def.thermalTimeScale = scale;
        f.create();
        f.addMaterial();
        f.addFloor();
        f.addBox({-0.02f, 0, -0.02f}, {0.02f, 0.03f, 0.02f}, 310);
        f.addSource({0, 0.015f, 0}, 1e6f);     // inside of it
        f.addSource({0.02f, 0.03f, 0}, -1e5f); // on its edge
        thawHeatSourceDef sun;
        thawInitHeatSourceDef(&sun);
        sun.type = thawHeatSource_sphere, sun.position = {0, 0.03f, 0}, sun.temperature = 1e9f;
        thawHeatSourceId id;
        REQUIRE(thawCreateHeatSource(f.world, &sun, &id) == thawResult_ok);
        for (int frame = 0; frame < 20; ++frame) {
            const uint32_t status = f.step();
            REQUIRE((status & thawStep_badParticlesRemoved) == 0);
            const thawParticleView v = f.particles();
            for (int i = 0; i < v.count; ++i) {
                REQUIRE(std::isfinite(v.temperatures[i]));
                REQUIRE(v.temperatures[i] >= 0);
                REQUIRE(v.temperatures[i] <= 1.001e5f);
                if (scale == 0) REQUIRE(v.temperatures[i] == doctest::Approx(310).epsilon(1e-6));
                for (int k = 0; k < 3; ++k) REQUIRE(std::isfinite(v.positions[4 * i + k]));
            }
        }
        CHECK(f.ledger().energyError < 1e-5);
        CHECK((f.ledger().absorbed == 0) == (scale == 0));
        CHECK((f.counters().maxTemperature > 1000) == (scale > 0));
        const uint64_t hash = thawWorld_GetStateHash(f.world);
        for (const float bad : {-1.0f, kNan, 1e6f, kInf, -kInf}) {
            CHECK(thawWorld_SetThermalTimeScale(f.world, bad) == thawResult_invalidArgument);
            CHECK(std::string(thawWorld_GetLastError(f.world)).find("scale") != std::string::npos);
        }
        CHECK(thawWorld_GetStateHash(f.world) == hash);
        CHECK(thawWorld_SetThermalTimeScale(f.world, 0) == thawResult_ok);
        const double absorbed = f.ledger().absorbed;
        f.step(3);
        CHECK(f.ledger().absorbed == absorbed);
    }
}
