// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// The same bits on any number of workers, and no allocation after warm-up.
#include "base/math.h"
#include "stability/motion_fixture.h"

#include <doctest/doctest.h>

#include <bit>

using namespace thaw;

namespace {

uint64_t hashAfter(int workers) {
    thawMaterialDef material = MotionScene::liquid(0.3f);
    material.cohesion = 6, material.adhesion = 0.5f;
    MotionScene s(0.004f, material, workers);
    s.block(10, 8, 10, {}, true);
    s.block(10, 12, 10, {0, 0.05f, 0});
    s.plane({0, 1, 0}, {});
    s.sphere({0.06f, 0.03f, 0.02f}, 0.015f);
    s.run(0.6f);
    uint64_t h = 1;
    const auto mix = [&](float v) { h = hashCombine(h, std::bit_cast<uint32_t>(v)); };
    for (int i = 0; i < s.particles.count; ++i) {
        const size_t k = static_cast<size_t>(i);
        for (const Vec4& v : {s.particles.position[k], s.particles.velocity[k], s.particles.velocityChange[k]})
            mix(v.x), mix(v.y), mix(v.z), mix(v.w);
        mix(s.particles.pressure[k]), mix(s.particles.stiffness[k]);
    }
    return h;
}

} // namespace

TEST_CASE("motion: the same bits with 1, 2 and 4 workers") {
    const uint64_t one = hashAfter(1);
    CHECK(hashAfter(2) == one);
    CHECK(hashAfter(4) == one);
}

TEST_CASE("motion: no allocation after warm-up") {
    MotionScene s(0.004f, MotionScene::liquid(1));
    s.block(8, 8, 8, {});
    s.tank(8 * s.spacing, 8 * s.spacing);
    s.startAtRest(8 * s.spacing);
    s.run(1);
    const MotionFrame f = s.frame(MotionScene::kStep, 1);
    const size_t calls = s.allocator.calls();
    for (int n = 0; n < 3; ++n) {
        s.weigh();
        s.motion.begin(f), s.motion.forces(f), s.motion.viscosity(f), s.motion.pressure(f), s.motion.move(f);
    }
    CHECK(s.allocator.calls() == calls);
}
