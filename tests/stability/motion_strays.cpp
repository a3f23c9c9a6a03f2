// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// No particle is thrown: neither by a solid that melts under a liquid nor by an impact.
#include "stability/motion_fixture.h"

#include <doctest/doctest.h>

using namespace thaw;

namespace {

// Liquid of 6 x 4 x 6 on a solid block of 8 x 10 x 8, whose upper half melts from the top between 1 s and 3 s.
double melt(float spacing, float viscosity, float cohesion) {
    constexpr int height = 10, solid = 8 * 10 * 8;
    thawMaterialDef material = MotionScene::liquid(viscosity);
    material.cohesion = cohesion;
    MotionScene s(spacing, material);
    s.block(8, height, 8, {}, true);
    s.block(6, 4, 6, {spacing, height * spacing, spacing});
    s.plane({0, 1, 0}, {});
    std::vector<float> releaseAt(static_cast<size_t>(s.particles.count), 1e9f);
    for (int i = 0; i < solid; ++i) {
        const size_t k = static_cast<size_t>(i);
        const float depth = 1 - s.particles.position[k].y / (height * spacing);
        if (depth < 0.5f) releaseAt[k] = 1 + 0.7f + 2 * depth;
    }
    double fastest = 0;
    float time = 0;
    s.run(4, [&] {
        time += MotionScene::kStep;
        for (int i = 0; i < s.particles.count; ++i) {
            const size_t k = static_cast<size_t>(i);
            if (s.particles.fixed(i) && time > releaseAt[s.particles.id[k]]) s.particles.flags[k] = 0;
        }
        fastest = std::max(fastest, s.fastest());
    });
    CHECK(s.finite());
    CHECK(s.particles.moverCount == 144 + 8 * 8 * 5);
    const double bound = std::sqrt(2 * 9.81 * 14 * static_cast<double>(spacing));
    MESSAGE("spacing ", spacing, " mu ", viscosity, " cohesion ", cohesion, ": fastest ", fastest,
            " m/s = ", fastest / bound, " of free fall");
    return fastest / bound;
}

} // namespace

TEST_CASE("motion: no strays where a solid melts under a liquid, 2 mm") {
    for (float mu : {0.02f, 0.1f, 1.0f}) CHECK(melt(0.002f, mu, 0) < 1.2);
    CHECK(melt(0.002f, 0.1f, 6) < 1.2);
}

TEST_CASE("motion: no strays where a solid melts under a liquid, 4 mm") {
    for (float mu : {0.02f, 0.1f, 1.0f}) CHECK(melt(0.004f, mu, 0) < 1.2);
    CHECK(melt(0.004f, 0.1f, 6) < 1.2);
}

TEST_CASE("motion: an impact throws nothing faster than it came and recovers") {
    for (float mu : {0.1f, 10.0f}) {
        MotionScene s(0.004f, MotionScene::liquid(mu));
        s.block(10, 10, 10, {0, 0.1f, 0});
        s.plane({0, 1, 0}, {});
        double fastest = 0, worst = 0;
        s.run(2, [&] {
            fastest = std::max(fastest, s.fastest());
            worst = std::max(worst, static_cast<double>(s.motion.stats().meanCompression));
        });
        double mean = 0, most = 0;
        s.compression(mean, most);
        MESSAGE("mu ", mu, ": fastest ", fastest, ", worst compression ", 100 * worst, " %, at the end ", 100 * mean,
                " %, sub-steps ", static_cast<double>(s.subSteps) / s.steps);
        CHECK(s.finite());
        CHECK(fastest < 1.3 * std::sqrt(2 * 9.81 * 0.14));
        CHECK(worst < 0.4); // 169 % in one step without sub-steps on approach
        CHECK(mean < 0.005);
        CHECK(static_cast<double>(s.subSteps) / s.steps < 1.3);
    }
}
