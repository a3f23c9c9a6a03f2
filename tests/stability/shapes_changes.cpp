// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Shapes that their host changes, whose collider moves, or that lose what is in them.
#include "shapes_fixture.h"

namespace {

thawColliderId addSmallSphere(WorldFixture& f, thawVec3 position, bool report = false) {
    thawColliderDef c;
    thawInitColliderDef(&c, thawCollider_sphere);
    c.size = {0.001f, 0, 0}, c.position = position, c.reportImpulse = report;
    thawColliderId id;
    REQUIRE(thawCreateCollider(f.world, &c, &id, nullptr) == thawResult_ok);
    return id;
}

void moveTo(WorldFixture& f, thawColliderId id, thawVec3 position) {
    REQUIRE(thawCollider_SetTransform(f.world, id, position, {0, 0, 0, 1}) == thawResult_ok);
}

} // namespace

TEST_CASE("shapes: what has set in the air moves with the shape's collider and weighs on it") {
    enum { movesLate, movesBefore, reports };
    for (const int kind : {movesLate, movesBefore, reports}) {
        CAPTURE(kind);
        WorldFixture f;
        pool(f);
        const thawColliderId collider = addSmallSphere(f, {0, 0.5f, 0}, kind == reports);
        if (kind == movesBefore) moveTo(f, collider, {0, 0.5f, 0});
        const Ball ball(0.0125f);
        thawShapeDef d = ball.def();
        d.collider = collider, d.position = {0, -0.465f, 0.01f}, d.reach = 0.05f, d.speed = 0.2f;
        const thawShapeId id = addShape(f, d);
        f.step(500);
        const auto inBall = [&](float height) {
            return shareOf(f, [&](const float* x) { return std::hypot(x[0], x[1] - height, x[2] - 0.01f) < 0.0135f; });
        };
        const double held = inBall(0.035f);
        REQUIRE(held > 0.6);
        const thawShapeState before = stateOf(f, id);
        for (int i = 1; i <= 60; ++i) moveTo(f, collider, {0, 0.5f + 0.002f * static_cast<float>(i), 0}), f.step();
        CHECK(inBall(0.155f) == held);
        f.step(20);
        CHECK(inBall(0.155f) == held);
        CHECK(stateOf(f, id).inside == before.inside);
        CHECK(stateOf(f, id).fill == doctest::Approx(before.fill).epsilon(1e-3).scale(0));
        if (kind != reports) continue;
        thawColliderImpulse impulse;
        REQUIRE(thawCollider_GetImpulse(f.world, collider, &impulse) == thawResult_ok);
        const double mass = held * f.ledger().massNow;
        CHECK(impulse.linear.y == doctest::Approx(-mass * 9.81 / 60).epsilon(0.01).scale(0));
    }
}

TEST_CASE("shapes: what sets outside of one is outside") {
    WorldFixture f;
    f.def.thermalTimeScale = 100;
    f.create();
    thawMaterialDef m;
    thawInitMaterialDef(&m, thawMaterial_wax);
    m.viscosityLiquid = 0.5f;
    f.addMaterial(m);
    thawColliderDef c;
    thawInitColliderDef(&c, thawCollider_plane);
    c.temperature = 280;
    thawColliderId floor;
    REQUIRE(thawCreateCollider(f.world, &c, &floor, nullptr) == thawResult_ok);
    f.addBox({-0.016f, 0, -0.016f}, {0.016f, 0.012f, 0.016f}, 345);
    const Ball ball(0.01f);
    thawShapeDef d = ball.def(); // too weak to lift any
    d.position = {0, 0.05f, 0}, d.reach = 0.08f, d.strength = 0.05f;
    const thawShapeId id = addShape(f, d);
    f.step(420);
    REQUIRE(f.counters().moving == 0);
    const thawShapeState s = stateOf(f, id);
    CHECK(s.mass > 0.5f * static_cast<float>(f.ledger().massNow));
    CHECK(s.set == s.mass);
    CHECK(s.inside == 0);
    CHECK(s.spilled == s.mass);
    CHECK(s.meanDistance > 0.02f);
}

TEST_CASE("shapes: what is gone obeys none") {
    WorldFixture f;
    f.def.thermalTimeScale = 0;
    f.create();
    thawMaterialDef m;
    thawInitMaterialDef(&m, thawMaterial_wax);
    m.viscosityLiquid = 0.5f;
    f.addMaterial(m);
    f.addFloor();
    const thawBodyId left = f.addBox({-0.032f, 0, -0.008f}, {-0.016f, 0.008f, 0.008f}, 345),
                     right = f.addBox({0.016f, 0, -0.008f}, {0.032f, 0.008f, 0.008f}, 345);
    Drawing disc;
    disc.ellipse(0, 0, 0.03f, 0.03f);
    thawShapeDef d = disc.def();
    d.setTime = 0.1f, d.setFill = 0.2f;
    const thawShapeId id = addShape(f, d);
    f.step(400);
    REQUIRE(f.counters().moving == 0);
    const thawShapeState before = stateOf(f, id);
    CHECK(before.set == before.mass);
    REQUIRE(thawDestroyBody(f.world, left) == thawResult_ok);
    f.step(2);
    CHECK(stateOf(f, id).mass == doctest::Approx(0.5 * before.mass).epsilon(0.01).scale(0));
    CHECK(stateOf(f, id).fill < 0.9f * before.fill);
    REQUIRE(thawDestroyBody(f.world, right) == thawResult_ok);
    f.step(2);
    const thawShapeState s = stateOf(f, id);
    CHECK(s.mass == 0);
    CHECK(s.set == 0);
    CHECK(s.inside == 0);
    CHECK(s.fill == 0);
    CHECK(f.plan().reason[thawStage_control] == thawReason_noParticles);
}

TEST_CASE("shapes: what has set beside one does not keep it from setting") {
    WorldFixture f;
    f.def.thermalTimeScale = 0;
    f.create();
    thawMaterialDef m;
    thawInitMaterialDef(&m, thawMaterial_wax);
    m.viscosityLiquid = 0.5f;
    f.addMaterial(m);
    f.addFloor();
    f.addBox({-0.008f, 0, -0.008f}, {0.008f, 0.008f, 0.008f}, 345);
    const thawBodyId beside = f.addBox({0.032f, 0, -0.008f}, {0.048f, 0.008f, 0.008f}, 345);
    Drawing disc;
    disc.ellipse(0, 0, 0.012f, 0.012f);
    thawShapeDef d = disc.def();
    d.setTime = 0.1f, d.reach = 0.06f;
    const thawShapeId id = addShape(f, d);
    f.step(10); // all obey it
    const thawBrush all{{0.04f, 0, 0}, 1, 0};
    REQUIRE(thawBody_PaintTemperature(f.world, beside, &all, 300, nullptr) == thawResult_ok);
    f.step(300);
    const thawShapeState s = stateOf(f, id);
    CHECK(s.mass == doctest::Approx(f.ledger().massNow).epsilon(1e-5).scale(0));
    CHECK(s.spilled > 0.3f * s.mass);
    CHECK(s.set == s.mass);
    CHECK(std::isfinite(s.filledAfter));
}
