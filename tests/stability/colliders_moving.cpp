// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world_fixture.h"

#include <cmath>

namespace {

thawColliderId addWall(WorldFixture& f, thawVec3 half, thawVec3 at, bool report = true) {
    thawColliderDef d;
    thawInitColliderDef(&d, thawCollider_box);
    d.size = half, d.position = at, d.reportImpulse = report;
    thawColliderId id;
    REQUIRE(thawCreateCollider(f.world, &d, &id, nullptr) == thawResult_ok);
    return id;
}

thawQuat aboutZ(double angle) {
    return {0, 0, static_cast<float>(std::sin(0.5 * angle)), static_cast<float>(std::cos(0.5 * angle))};
}

// A solid block on a plate that turns and goes up, and liquid on a floor that a paddle goes through.
struct Workshop : WorldFixture {
    thawColliderId plate, paddle;
    explicit Workshop(int workers) {
        def.particleSpacing = 0.004f;
        def.tasks.workerCount = workers;
        def.thermalTimeScale = 0;
        create();
        thawMaterialDef m;
        thawInitMaterialDef(&m, thawMaterial_wax);
        m.solidus = 300, m.liquidus = 310, m.viscosityLiquid = 0.5f;
        addMaterial(m);
        addFloor();
        plate = addWall(*this, {0.02f, 0.004f, 0.02f}, {0.1f, 0.046f, 0});
        paddle = addWall(*this, {0.001f, 0.02f, 0.02f}, {-0.05f, 0.022f, 0});
        WorldFixture::addBox({0.088f, 0.05f, -0.012f}, {0.112f, 0.066f, 0.012f}, 280);
        WorldFixture::addBox({-0.03f, 0, -0.02f}, {0.02f, 0.024f, 0.02f}, 320);
    }
    void move(int frame) {
        const float t = static_cast<float>(frame) / 60;
        REQUIRE(thawCollider_SetTransform(world, plate, {0.1f, 0.046f + 0.05f * t, 0}, aboutZ(0.4f * t)) ==
                thawResult_ok);
        REQUIRE(thawCollider_SetTransform(world, paddle, {-0.05f + 0.2f * t, 0.022f, 0}, {0, 0, 0, 1}) ==
                thawResult_ok);
    }
};

} // namespace

TEST_CASE("colliders that move: same bits at any number of workers, impulses too") {
    uint64_t hash = 0;
    thawColliderImpulse first{};
    for (int workers : {1, 2, 3}) {
        Workshop w(workers);
        for (int f = 1; f <= 40; ++f) w.move(f), w.step();
        thawColliderImpulse i;
        REQUIRE(thawCollider_GetImpulse(w.world, w.paddle, &i) == thawResult_ok);
        CHECK(i.linear.x < 0);
        if (workers == 1) {
            hash = thawWorld_GetStateHash(w.world), first = i;
            // A target is state before the step that goes there.
            w.move(41);
            CHECK(thawWorld_GetStateHash(w.world) != hash);
        } else {
            CHECK(thawWorld_GetStateHash(w.world) == hash);
            CHECK(i.linear.x == first.linear.x);
            CHECK(i.angular.z == first.angular.z);
        }
    }
}

TEST_CASE("colliders that move: what hangs on one goes along, and falls when it goes") {
    Workshop w(2);
    w.step(2);
    const auto start = w.positions();
    for (int f = 1; f <= 30; ++f) w.move(f), w.step();
    // The plate rose by 25 mm and turned by 0.2 about z.
    const double c = std::cos(0.2), s = std::sin(0.2);
    int held = 0;
    for (const auto& [id, x] : w.positions()) {
        const thawVec3 a = start.at(id);
        if (a.x < 0.08f) continue;
        const double dx = static_cast<double>(a.x) - 0.1, dy = static_cast<double>(a.y) - 0.046;
        CHECK(static_cast<double>(x.x) == doctest::Approx(0.1 + c * dx - s * dy).epsilon(1e-5));
        CHECK(static_cast<double>(x.y) == doctest::Approx(0.071 + s * dx + c * dy).epsilon(1e-5));
        ++held;
    }
    CHECK(held > 100);
    thawColliderImpulse i;
    w.step(2); // stands still now: its weight alone
    REQUIRE(thawCollider_GetImpulse(w.world, w.plate, &i) == thawResult_ok);
    const thawParticleView v = w.particles();
    CHECK(i.linear.y * 60 == doctest::Approx(-9.81f * static_cast<float>(held) * v.velocities[3]).epsilon(0.05));
    REQUIRE(thawDestroyCollider(w.world, w.plate) == thawResult_ok);
    w.step(20);
    float highest = 0;
    for (const auto& [id, x] : w.positions())
        if (x.x > 0.08f) highest = std::max(highest, x.y);
    CHECK(highest < 0.07f);
}

TEST_CASE("colliders: impulse of a pool at rest is its weight, shared by those that hold it") {
    WorldFixture f;
    f.def.particleSpacing = 0.004f;
    f.def.thermalTimeScale = 0;
    f.create();
    thawMaterialDef m;
    thawInitMaterialDef(&m, thawMaterial_wax);
    m.viscosityLiquid = 5, m.cohesion = 0, m.adhesion = 0;
    f.addMaterial(m);
    const thawColliderId floor = addWall(f, {0.04f, 0.01f, 0.04f}, {0, -0.01f, 0});
    const thawColliderId right = addWall(f, {0.01f, 0.04f, 0.04f}, {0.03f, 0.04f, 0});
    addWall(f, {0.01f, 0.04f, 0.04f}, {-0.03f, 0.04f, 0});
    addWall(f, {0.02f, 0.04f, 0.01f}, {0, 0.04f, 0.03f});
    addWall(f, {0.02f, 0.04f, 0.01f}, {0, 0.04f, -0.03f});
    f.addBox({-0.02f, 0, -0.02f}, {0.02f, 0.032f, 0.02f}, 400);
    f.step(90);
    thawColliderImpulse a, b;
    REQUIRE(thawCollider_GetImpulse(f.world, floor, &a) == thawResult_ok);
    REQUIRE(thawCollider_GetImpulse(f.world, right, &b) == thawResult_ok);
    const double weight = f.ledger().massNow * 9.81, g = 9.81, density = static_cast<double>(m.density);
    CHECK(static_cast<double>(a.linear.y) * 60 == doctest::Approx(-weight).epsilon(0.05));
    // Hydrostatic on a side wall: rho g H^2 / 2 times its width.
    CHECK(static_cast<double>(b.linear.x) * 60 ==
          doctest::Approx(0.5 * density * g * 0.032 * 0.032 * 0.04).epsilon(0.15));
}

TEST_CASE("colliders: a slippery wall lets a film run that a sticky one holds") {
    float speed[2] = {};
    for (int slippery : {0, 1}) {
        WorldFixture f;
        f.def.particleSpacing = 0.004f;
        f.def.thermalTimeScale = 0;
        f.def.gravity = {3, -9.81f, 0};
        f.create();
        thawMaterialDef m;
        thawInitMaterialDef(&m, thawMaterial_wax);
        m.viscosityLiquid = 20, m.cohesion = 0;
        f.addMaterial(m);
        thawColliderDef d;
        thawInitColliderDef(&d, thawCollider_plane);
        d.slipLength = slippery ? 1e4f : 0, d.reportImpulse = true; // the solve then keeps what it leaves over
        thawColliderId id;
        REQUIRE(thawCreateCollider(f.world, &d, &id, nullptr) == thawResult_ok);
        f.addBox({-0.02f, 0, -0.02f}, {0.02f, 0.012f, 0.02f}, 400);
        f.step(30);
        const thawParticleView v = f.particles();
        for (int i = 0; i < v.count; ++i) speed[slippery] += v.velocities[4 * i] / static_cast<float>(v.count);
    }
    CHECK(speed[1] == doctest::Approx(1.5f).epsilon(0.05)); // free: 3 m/s^2 for half a second
    CHECK(speed[0] < 0.1f);
}

TEST_CASE("colliders: what is refused when they move") {
    WorldFixture f, g;
    f.create(), g.create();
    const thawColliderId quiet = addWall(f, {1, 1, 1}, {}, false);
    thawColliderImpulse i;
    CHECK(thawCollider_GetImpulse(f.world, quiet, &i) == thawResult_invalidArgument);
    CHECK(thawCollider_GetImpulse(g.world, quiet, &i) == thawResult_staleId);
    CHECK(thawCollider_SetTransform(f.world, quiet, {NAN, 0, 0}, {0, 0, 0, 1}) == thawResult_invalidArgument);
    CHECK(std::string(thawWorld_GetLastError(f.world)).find("position") != std::string::npos);
    CHECK(thawCollider_SetTransform(f.world, quiet, {}, {0, 0, 0, 2}) == thawResult_invalidArgument);
    CHECK(thawCollider_Teleport(g.world, quiet, {}, {0, 0, 0, 1}) == thawResult_staleId);
    CHECK(thawCollider_Teleport(f.world, quiet, {3, 0, 0}, {0, 0, 0, 1}) == thawResult_ok);
    thawVec3 x;
    thawQuat q;
    REQUIRE(thawCollider_GetTransform(f.world, quiet, &x, &q) == thawResult_ok);
    CHECK(x.x == 3);
    thawColliderDef d;
    thawInitColliderDef(&d, thawCollider_plane);
    d.slipLength = -1;
    thawColliderId id;
    CHECK(thawCreateCollider(f.world, &d, &id, nullptr) == thawResult_invalidArgument);
    CHECK(std::string(thawWorld_GetLastError(f.world)).find("slipLength") != std::string::npos);
    thawInitColliderDef(&d, thawCollider_plane);
    d.friction = NAN;
    CHECK(thawCreateCollider(f.world, &d, &id, nullptr) == thawResult_invalidArgument);
}
