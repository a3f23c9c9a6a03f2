// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// Nothing goes through anything, however fast.
#include "stability/motion_fixture.h"

#include <doctest/doctest.h>

using namespace thaw;

TEST_CASE("motion: a drop does not cross a plate of one spacing") {
    for (float mu : {0.1f, 5.0f}) {
        MotionScene s(0.002f, MotionScene::liquid(mu));
        const float top = 0.05f, half = 0.5f * s.spacing;
        s.box({0, top - half, 0}, {0.3f, half, 0.3f});
        // 10 cm of fall: 1.4 m/s, twelve plates' thickness in a step.
        s.block(5, 5, 5, {-2.5f * s.spacing, top + 0.1f, -2.5f * s.spacing});
        float lowest = 1;
        s.run(1, [&] { s.forMovers([&](size_t i) { lowest = std::min(lowest, s.positionOf(i).y); }); });
        CHECK(s.finite());
        CHECK(lowest > top);
        CHECK(s.mean(&Vec4::y) < static_cast<double>(top) + 5 * 0.002);
    }
}

TEST_CASE("motion: particles at 5 m/s stop at a plane and a sphere") {
    for (int shape = 0; shape < 2; ++shape) {
        MotionScene s(0.002f, MotionScene::liquid(0.1f));
        if (shape == 0)
            s.plane(normalizeOr({0.3f, 1, 0.2f}, {}), {});
        else
            s.sphere({0, -0.01f, 0}, 0.01f);
        for (int k = 0; k < 60; ++k) {
            const Vec3 from{0.02f * s.noise(), 0.1f + 0.05f * s.noise(), 0.02f * s.noise()};
            s.add(from, false, 5 * normalizeOr(Vec3{} - from, {}));
        }
        float nearest = 1;
        double fastest = 0;
        s.run(0.5f, [&] {
            s.forMovers([&](size_t i) {
                Vec3 n;
                nearest = std::min(nearest, s.colliders[0].distance(s.positionOf(i), n));
            });
            fastest = std::max(fastest, s.fastest());
        });
        MESSAGE("nearest ", nearest / s.spacing, " spacings, fastest ", fastest);
        CHECK(s.finite());
        CHECK(nearest > 0.29f * s.spacing);
        CHECK(nearest < 0.5f * s.spacing); // they did get there
        CHECK(fastest < 12);
    }
}

TEST_CASE("motion: particles at 5 m/s stay out of a fixed block") {
    MotionScene s(0.002f, MotionScene::liquid(0.1f));
    constexpr int n = 12;
    const float side = n * s.spacing;
    s.block(n, n, n, {}, true);
    for (int k = 0; k < 60; ++k) {
        const Vec3 from{0.5f * side + 0.02f * s.noise(), side + 0.1f + 0.05f * s.noise(),
                        0.5f * side + 0.02f * s.noise()};
        const Vec3 to{0.5f * side + 0.4f * side * s.noise(), 0.5f * side, 0.5f * side + 0.4f * side * s.noise()};
        s.add(from, false, 5 * normalizeOr(to - from, {}));
    }
    int inside = 0, touched = 0;
    s.run(0.3f, [&] {
        s.forMovers([&](size_t i) {
            const Vec3 x = s.positionOf(i);
            const float in = std::min({x.x, x.y, x.z, side - x.x, side - x.y, side - x.z});
            inside += in > 0.2f * s.spacing;
            touched += in > -1.0f * s.spacing;
        });
    });
    CHECK(s.finite());
    CHECK(inside == 0);
    CHECK(touched > 30);
}

TEST_CASE("motion: melt that lies on a solid does not seep into it") {
    // Started without pressure and pulled in by cohesion: between single particles a quarter of it would sink in.
    for (float cohesion : {0.0f, 6.0f}) {
        thawMaterialDef material = MotionScene::liquid(0.1f);
        material.cohesion = cohesion;
        MotionScene s(0.002f, material);
        constexpr int n = 12;
        const float side = n * s.spacing;
        s.block(n, n, n, {}, true);
        s.block(10, 4, 10, {s.spacing, side, s.spacing});
        s.run(1);
        int inside = 0, near = 0;
        s.forMovers([&](size_t i) {
            const Vec3 x = s.positionOf(i);
            const float in = std::min({x.x, x.y, x.z, side - x.x, side - x.y, side - x.z}) / s.spacing;
            inside += in > 0.1f, near += in > -1;
        });
        CHECK(inside == 0);
        CHECK(near > 50);
    }
}

TEST_CASE("motion: the speed limit acts and says so") {
    MotionScene s(0.002f, MotionScene::liquid(0.1f));
    s.gravity = {};
    s.add({0, 1, 0}, false, {500, 0, 0});
    s.step();
    CHECK(s.motion.stats().velocityClamped);
    CHECK(s.motion.stats().maxSpeed < 100);
    s.step();
    CHECK_FALSE(s.motion.stats().velocityClamped);
}

TEST_CASE("motion: nothing to move is nothing to do") {
    MotionScene s(0.002f, MotionScene::liquid(0.1f));
    s.step();
    s.block(3, 3, 3, {}, true);
    const Vec4 before = s.particles.position[0];
    s.step();
    CHECK(s.subSteps == 2);
    CHECK(s.motion.stats().maxSpeed == 0);
    CHECK(s.particles.position[0].x == before.x);
}
