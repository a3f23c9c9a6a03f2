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
