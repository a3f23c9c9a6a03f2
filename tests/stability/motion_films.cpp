// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// Films cling, drops bead.
#include "stability/motion_fixture.h"

#include <doctest/doctest.h>

using namespace thaw;

TEST_CASE("motion: a film on a vertical wall stays on it and runs down") {
    struct Case {
        float spacing, viscosity;
    };
    for (Case c : {Case{0.002f, 0.5f}, Case{0.002f, 1}, Case{0.004f, 1}, Case{0.004f, 3}}) {
        thawMaterialDef material = MotionScene::liquid(c.viscosity);
        material.adhesion = 0.5f;
        MotionScene s(c.spacing, material);
        s.block(3, 24, 12, {});
        s.plane({1, 0, 0}, {});
        s.run(0.1f);
        // Down the middle, before the film has thinned: against the speed of a film without end.
        double speed = 0, n = 0;
        const auto measure = [&] {
            const double middle = s.mean(&Vec4::y);
            s.forMovers([&](size_t i) {
                if (std::abs(static_cast<double>(s.positionOf(i).y) - middle) < 6 * static_cast<double>(s.spacing))
                    speed -= static_cast<double>(s.velocityOf(i).y), ++n;
            });
        };
        s.run(0.1f, measure);
        const double h = 3 * static_cast<double>(s.spacing),
                     theory = 1000 * 9.81 * h * h / (3 * static_cast<double>(c.viscosity));
        s.run(1.0f);
        MESSAGE("spacing ", c.spacing, " mu ", c.viscosity, ": speed over theory ", speed / n / theory, ", detached ",
                100 * s.detached(), " %");
        CHECK(s.finite());
        CHECK(s.detached() == 0);
        CHECK(speed / n / theory > 0.4);
        CHECK(speed / n / theory < 1.5);
    }
}

TEST_CASE("motion: without adhesion the same film leaves") {
    MotionScene s(0.002f, MotionScene::liquid(0.1f));
    s.block(3, 24, 12, {});
    s.plane({1, 0, 0}, {});
    s.run(1.5f);
    CHECK(s.detached() > 0.3);
}

TEST_CASE("motion: a drop on a wall beads") {
    struct Case {
        float spacing, viscosity;
    };
    for (Case c : {Case{0.002f, 1}, Case{0.004f, 3}}) {
        thawMaterialDef material = MotionScene::liquid(c.viscosity);
        material.cohesion = 6, material.adhesion = 0.5f;
        MotionScene s(c.spacing, material);
        for (int k = -6; k < 6; ++k)
            for (int j = -6; j < 6; ++j)
                for (int i = 0; i < 6; ++i) {
                    const Vec3 q{static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f,
                                 static_cast<float>(k) + 0.5f};
                    if (dot(q, q) < 4.6f * 4.6f) s.add(s.spacing * q);
                }
        s.plane({1, 0, 0}, {});
        s.run(3);
        double mean = 0, most = 0, speed = 0;
        s.forMovers([&](size_t i) { speed -= static_cast<double>(s.velocityOf(i).y) / s.particles.moverCount; });
        const double detached = s.detached();
        Box box;
        s.forMovers([&](size_t i) { box.grow(s.positionOf(i)); });
        s.compression(mean, most);
        MESSAGE("spacing ", c.spacing, " mu ", c.viscosity, ": ", speed, " m/s, high ", box.upper.x / s.spacing,
                ", long ", (box.upper.y - box.lower.y) / s.spacing, ", wide ", (box.upper.z - box.lower.z) / s.spacing,
                " spacings, compression ", 100 * mean, " %");
        CHECK(detached == 0);
        CHECK(box.upper.x / s.spacing > 2);                  // it stands up from the wall
        CHECK((box.upper.y - box.lower.y) / s.spacing < 18); // and is one piece, not a streak
        CHECK((box.upper.z - box.lower.z) / s.spacing < 14);
        CHECK(mean < 0.05);
        CHECK(speed > 0.03);
        CHECK(speed < 0.3);
    }
}

TEST_CASE("motion: a layer below its yield stress stays, a thicker one flows") {
    // On a slope of 30 degrees the weight of the layer shears its foot by rho g sin(30) H.
    for (const thawFlow flow : {thawFlow_bingham, thawFlow_casson}) {
        double speed[2];
        for (const int thick : {0, 1}) {
            thawMaterialDef material = MotionScene::liquid(2);
            material.flow = flow;
            const int layers = 5;
            const float load = 1000 * 9.81f * 0.5f * layers * 0.004f; // Pa
            material.yieldStress = load * (thick ? 0.5f : 1.4f);
            MotionScene s(0.004f, material);
            s.block(24, layers, 16, {});
            s.plane({0, 1, 0}, {});
            s.gravity = {9.81f * 0.5f, -9.81f * 0.866f, 0};
            // Thick enough it runs off within the first second: looked at before.
            s.run(thick ? 0.5f : 2);
            CHECK(s.finite());
            double sum = 0;
            s.forMovers([&](size_t i) { sum += static_cast<double>(s.velocityOf(i).x); });
            speed[thick] = sum / s.particles.moverCount;
        }
        MESSAGE("below ", speed[0], ", above ", speed[1], " m/s");
        CHECK(speed[0] < 1e-4);
        CHECK(speed[1] > 2e-3);
    }
}
