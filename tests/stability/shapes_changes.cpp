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
    waxOnFloor(f);
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
    waxOnFloor(f);
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

TEST_CASE("shapes: setting one to what it is changes nothing, speed and strength start nothing anew") {
    for (const bool mesh : {false, true}) {
        CAPTURE(mesh);
        WorldFixture set, left;
        Drawing disc;
        disc.ellipse(0.01f, 0, 0.03f, 0.03f);
        const Ball ball(0.0125f);
        thawShapeDef d = mesh ? ball.def() : disc.def();
        if (mesh) d.position = {0, 0.035f, 0.01f}, d.reach = 0.05f, d.speed = 0.2f;
        pool(set), pool(left);
        const thawShapeId id = addShape(set, d);
        addShape(left, d);
        // The flow's cells are looked at anew, some in each step.
        thawColliderId sphere[2] = {addSmallSphere(set, {0.03f, 0.02f, 0}), addSmallSphere(left, {0.03f, 0.02f, 0})};
        for (int i = 0; i < 120; ++i) {
            if (i == 60) {
                const thawVec3 to{0.03f, 0.004f, 0};
                REQUIRE(thawCollider_Teleport(set.world, sphere[0], to, {0, 0, 0, 1}) == thawResult_ok);
                REQUIRE(thawCollider_Teleport(left.world, sphere[1], to, {0, 0, 0, 1}) == thawResult_ok);
            }
            REQUIRE(thawShape_Set(set.world, id, &d) == thawResult_ok);
            set.step(), left.step();
            REQUIRE(thawWorld_GetStateHash(set.world) == thawWorld_GetStateHash(left.world));
        }
        for (int i = 0; i < 400; ++i) {
            d.speed = 0.2f - 1e-4f * static_cast<float>(i), d.strength = i % 3 ? 0.99f : 1;
            REQUIRE(thawShape_Set(set.world, id, &d) == thawResult_ok);
            set.step();
        }
        const thawShapeState s = stateOf(set, id);
        CHECK(s.set > 0.98f * s.inside);
        CHECK(s.fill > 0.9f);
    }
}

TEST_CASE("shapes: another place or reach lets no more in than there is room for") {
    for (const bool moves : {false, true}) {
        WorldFixture f;
        pool(f);
        const Ball ball(0.0115f); // of the melt half
        thawShapeDef d = ball.def();
        d.position = {0, 0.03f, 0}, d.reach = 0.05f, d.sets = false;
        const thawShapeId id = addShape(f, d);
        float most = 0;
        for (int i = 0; i < 120; ++i) {
            (moves ? d.position.x : d.reach) += 1e-4f;
            REQUIRE(thawShape_Set(f.world, id, &d) == thawResult_ok);
            f.step();
            most = std::max(most, stateOf(f, id).mass);
        }
        const float room = stateOf(f, id).size * 800;
        CHECK(most < 1.05f * room);
        CHECK(most > 0.8f * room);
    }
}

TEST_CASE("shapes: one that is on again cools from what it finds") {
    WorldFixture f;
    waxOnFloor(f);
    const thawBodyId body = f.addBox({-0.016f, 0, -0.016f}, {0.016f, 0.012f, 0.016f}, 345);
    Drawing disc;
    disc.ellipse(0, 0, 0.025f, 0.025f);
    thawShapeDef d = disc.def();
    d.setTime = 20, d.thickness = 0.005f;
    const thawShapeId id = addShape(f, d);
    f.step(300);
    const double first = f.ledger().controlHeat;
    REQUIRE(first > 0);
    d.enabled = false;
    REQUIRE(thawShape_Set(f.world, id, &d) == thawResult_ok);
    f.step(10);
    CHECK(f.ledger().controlHeat == first);
    CHECK(stateOf(f, id).mass == 0);
    CHECK(stateOf(f, id).inside == 0);
    const thawBrush all{{0, 0, 0}, 1, 0};
    REQUIRE(thawBody_PaintTemperature(f.world, body, &all, 400, nullptr) == thawResult_ok);
    d.enabled = true;
    REQUIRE(thawShape_Set(f.world, id, &d) == thawResult_ok);
    double most = 0, all20 = 0;
    for (int i = 0; i < 20; ++i) {
        const double before = f.ledger().controlHeat;
        f.step();
        most = std::max(most, f.ledger().controlHeat - before), all20 = f.ledger().controlHeat - first;
    }
    CHECK(all20 > 0);
    CHECK(most < 0.1 * all20);
}

TEST_CASE("shapes: what a drawing lies on takes none of its room") {
    for (const float thickness : {0.0f, 0.004f}) {
        CAPTURE(thickness);
        WorldFixture f;
        f.def.thermalTimeScale = 0, f.def.maxParticles = 16384;
        f.create();
        thawMaterialDef m;
        thawInitMaterialDef(&m, thawMaterial_wax);
        m.viscosityLiquid = 0.5f, m.density = 800;
        f.addMaterial(m);
        f.addFloor(-0.016f);
        f.addBox({-0.032f, -0.016f, -0.032f}, {0.032f, 0, 0.032f}, 290);
        f.addBox({-0.012f, 0, -0.012f}, {0.012f, 0.012f, 0.012f}, 345);
        Drawing disc;
        disc.ellipse(0, 0, 0.02f, 0.02f);
        thawShapeDef d = disc.def();
        d.sets = false, d.thickness = thickness;
        const thawShapeId id = addShape(f, d);
        f.step(300);
        const thawShapeState s = stateOf(f, id);
        const float depth = thickness > 0 ? thickness : 0.024f * 0.024f * 0.012f / s.size;
        CHECK(s.mass == doctest::Approx(static_cast<double>(s.size * depth * 800)).epsilon(0.1).scale(0));
        CHECK(s.inside > 0.95f * s.mass);
        CHECK(s.level == doctest::Approx(static_cast<double>(depth)).epsilon(0.1).scale(0));
        CHECK(s.fill > 0.9f);
    }
}

TEST_CASE("shapes: one that is thinner than a particle is filled as well") {
    WorldFixture f;
    pool(f);
    Drawing strip;
    strip.points = {{-0.03f, 0, 0.0003f}, {0.03f, 0, 0.0003f}, {0.03f, 0, 0.0008f}, {-0.03f, 0, 0.0008f}};
    strip.sizes = {4};
    thawShapeDef d = strip.def();
    d.sets = false;
    const thawShapeId id = addShape(f, d);
    f.step(120);
    const thawShapeState s = stateOf(f, id);
    CHECK(s.size == doctest::Approx(0.06 * 0.0005).epsilon(0.02).scale(0));
    CHECK(s.level == doctest::Approx(static_cast<double>(s.mass / 800 / s.size)).epsilon(0.02).scale(0));
    CHECK(s.fill > 0.9f);
}

TEST_CASE("shapes: the state hash knows which side of a drawing is up") {
    WorldFixture up, down;
    pool(up), pool(down);
    Drawing disc;
    disc.ellipse(0, 0, 0.02f, 0.02f);
    REQUIRE(thawWorld_SetGravity(down.world, {0, 9.81f, 0}) == thawResult_ok);
    addShape(up, disc.def()), addShape(down, disc.def());
    REQUIRE(thawWorld_SetGravity(down.world, up.def.gravity) == thawResult_ok);
    CHECK(thawWorld_GetStateHash(up.world) != thawWorld_GetStateHash(down.world));
}

TEST_CASE("shapes: the same bits and nothing odd with all that changes at once") {
    WorldFixture f[3];
    Drawing flat;
    flat.ellipse(0.02f, 0, 0.02f, 0.02f).ellipse(-0.02f, 0, 0.015f, 0.012f);
    const Ball ball(0.013f);
    thawColliderId sphere[3];
    thawShapeId disc[3], mould[3];
    thawShapeDef drawn = flat.def(), round = ball.def();
    round.position = {0, -0.47f, 0.03f}, round.reach = 0.05f, round.priority = 1, round.setTime = 0.2f;
    for (int n = 0; n < 3; ++n) {
        f[n].def.tasks.workerCount = 1 << n;
        pool(f[n], 20);
        thawMaterialDef m; // sinks into the other
        thawInitMaterialDef(&m, thawMaterial_wax);
        m.viscosityLiquid = 0.1f, m.density = 1600;
        f[n].addMaterial(m);
        f[n].addBox({-0.03f, 0.016f, -0.016f}, {0.004f, 0.028f, 0.016f}, 345);
        sphere[n] = addSmallSphere(f[n], {0, 0.5f, 0}, true);
        round.collider = sphere[n];
        disc[n] = addShape(f[n], drawn), mould[n] = addShape(f[n], round);
        f[n].budget.work.leastSubSteps = 2;
    }
    for (int i = 0; i < 110; ++i)
        for (int n = 0; n < 3; ++n) {
            WorldFixture& w = f[n];
            if (i < 95) moveTo(w, sphere[n], {0, 0.5f, 0.0002f * static_cast<float>(i)});
            if (i == 30) REQUIRE(thawWorld_SetGravity(w.world, {0, 0, 0}) == thawResult_ok);
            if (i == 45) REQUIRE(thawWorld_SetGravity(w.world, {4, -9, 0}) == thawResult_ok);
            drawn.enabled = i % 35 < 27, drawn.strength = i < 75 ? 1 : 0.5f;
            REQUIRE(thawShape_Set(w.world, disc[n], &drawn) == thawResult_ok);
            if (i == 95) REQUIRE(thawDestroyCollider(w.world, sphere[n]) == thawResult_ok);
            CHECK((w.step() & thawStep_badParticlesRemoved) == 0);
            REQUIRE(thawWorld_GetStateHash(w.world) == thawWorld_GetStateHash(f[0].world));
            const thawLedger l = w.ledger();
            CHECK(l.energyError < 1e-9);
            CHECK(l.massError < 1e-12);
            CHECK(std::isfinite(l.controlEnergy + l.controlImpulse[0] + l.controlImpulse[1] + l.controlImpulse[2]));
            for (const thawShapeId id : {disc[n], mould[n]}) {
                thawShapeState s;
                if (thawShape_GetState(w.world, id, &s) != thawResult_ok) continue;
                const float obeys = id.index1 == mould[n].index1 || drawn.enabled ? s.captured - s.lost : 0;
                CHECK(s.mass == doctest::Approx(obeys).epsilon(1e-4).scale(1e-4));
                CHECK(s.mass == doctest::Approx(s.inside + s.spilled).epsilon(1e-4).scale(1e-4));
                CHECK(std::isfinite(s.fill + s.level + s.meanDistance));
            }
        }
    CHECK(f[0].counters().shapes == 1);
}
