// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// What should come to rest does, at the right height, and stays there.
#include "stability/motion_fixture.h"

#include <doctest/doctest.h>

using namespace thaw;

namespace {

struct Rest {
    double error, rms, height;
};

// A closed pool of 10^3, 4 s after it turned liquid.
Rest pool(float spacing, float viscosity) {
    constexpr int n = 10;
    MotionScene s(spacing, MotionScene::liquid(viscosity));
    s.block(n, n, n, {});
    s.tank(n * spacing, n * spacing);
    s.startAtRest(n * spacing);
    s.run(4);
    CHECK(s.finite());
    CHECK(s.particles.moverCount == n * n * n);
    Rest r{};
    double most = 0;
    r.rms = s.rmsSpeed();
    r.height = s.mean(&Vec4::y) / (0.5 * n * static_cast<double>(spacing));
    s.compression(r.error, most);
    MESSAGE("spacing ", spacing, " mu ", viscosity, ": error ", 100 * r.error, " %, rms ", r.rms, " m/s, height ",
            r.height, ", iterations ", static_cast<double>(s.iterations) / s.subSteps);
    return r;
}

} // namespace

// Limits: 1.5 times the worst of what the measurements of the scheme gave at rest (0.08 %, 0.0005 m/s), height 0.997.
TEST_CASE("motion: a pool comes to rest at 2 mm") {
    for (float mu : {0.005f, 0.1f, 10.0f}) {
        const Rest r = pool(0.002f, mu);
        CHECK(r.error < 0.0022);
        CHECK(r.rms < 0.00075);
        CHECK(r.height > 0.99);
        CHECK(r.height < 1.01);
    }
}

TEST_CASE("motion: a pool comes to rest at 4 mm") {
    for (float mu : {0.005f, 0.1f, 10.0f}) {
        const Rest r = pool(0.004f, mu);
        CHECK(r.error < 0.0015);
        CHECK(r.rms < 0.00075);
        CHECK(r.height > 0.99);
        CHECK(r.height < 1.01);
    }
}

TEST_CASE("motion: a pool that starts without pressure collapses for a moment and recovers") {
    MotionScene s(0.004f, MotionScene::liquid(0.1f));
    s.block(8, 8, 8, {});
    s.tank(8 * s.spacing, 8 * s.spacing);
    double fastest = 0;
    s.run(3, [&] { fastest = std::max(fastest, s.fastest()); });
    double mean = 0, most = 0;
    s.compression(mean, most);
    CHECK(s.finite());
    CHECK(fastest < 2 * std::sqrt(2 * 9.81 * 8 * 0.004));
    CHECK(mean < 0.004);
    CHECK(s.mean(&Vec4::y) / (4 * 0.004) > 0.98);
}

TEST_CASE("motion: a deep column asks for sub-steps and stands") {
    constexpr int layers = 35; // 14 cm: G = g H dt^2 / dx^2 = 24
    MotionScene s(0.004f, MotionScene::liquid(0.1f));
    s.block(6, layers, 6, {});
    s.tank(6 * s.spacing, 6 * s.spacing);
    s.startAtRest(layers * s.spacing);
    double worst = 0;
    s.run(3, [&] { worst = std::max(worst, static_cast<double>(s.motion.stats().meanCompression)); });
    double mean = 0, most = 0;
    s.compression(mean, most);
    const double height = s.mean(&Vec4::y) / 0.07;
    MESSAGE("sub-steps ", static_cast<double>(s.subSteps) / s.steps, ", worst ", 100 * worst, " %, end ", 100 * mean,
            " %, height ", height);
    CHECK(s.subSteps == 2 * s.steps);
    CHECK(worst < 0.06);
    CHECK(mean < 0.003);
    CHECK(height > 0.98);
    CHECK(height < 1.04);
}

TEST_CASE("motion: a lump of 1,000 Pa s keeps its shape") {
    MotionScene s(0.004f, MotionScene::liquid(1000));
    s.block(8, 8, 8, {});
    s.plane({0, 1, 0}, {});
    s.run(1); // settles onto the floor
    std::vector<Vec3> before(512);
    s.forMovers([&](size_t i) { before[s.particles.id[i]] = s.positionOf(i); });
    s.run(2);
    float farthest = 0;
    s.forMovers([&](size_t i) { farthest = std::max(farthest, length(s.positionOf(i) - before[s.particles.id[i]])); });
    MESSAGE("moved ", farthest / s.spacing, " spacings in 2 s");
    // A cube of 3.2 cm sags at about rho g H / (3 mu) = 0.1 per second: a quarter of a spacing... of 8 layers in 2 s.
    CHECK(farthest < 2.5f * s.spacing);
    CHECK(farthest > 0.05f * s.spacing);
}
