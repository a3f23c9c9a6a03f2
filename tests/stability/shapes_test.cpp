// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "shapes_fixture.h"

#include <limits>
#include <string>

TEST_CASE("shapes: liquid fills a ring, sets in it, and the heat for that is in the ledger") {
    WorldFixture f;
    pool(f);
    Drawing ring;
    ring.ellipse(0, 0, 0.03f, 0.03f).ellipse(0, 0, 0.012f, 0.012f);
    const thawShapeId id = addShape(f, ring.def());
    CHECK(f.counters().shapes == 1);
    CHECK(stateOf(f, id).size == doctest::Approx(3.14159 * (0.03 * 0.03 - 0.012 * 0.012)).epsilon(0.01).scale(0));
    CHECK(std::isnan(stateOf(f, id).filledAfter));
    thawLedger before, after;
    thawWorld_GetLedger(f.world, &before);
    f.step(400);
    const thawShapeState s = stateOf(f, id);
    CHECK(s.fill > 0.95f);
    CHECK(s.set == doctest::Approx(s.mass).scale(0));
    CHECK(s.inside > 0.98f * s.mass);
    CHECK(s.filledAfter > 0.1f);
    CHECK(s.captured == doctest::Approx(s.mass + s.lost).scale(0));
    const auto inRing = [](const float* x) { return std::abs(std::hypot(x[0], x[2]) - 0.021f) < 0.0105f; };
    CHECK(shareOf(f, inRing) > 0.98);
    thawWorld_GetLedger(f.world, &after);
    CHECK(after.controlHeat > 0.5 * s.mass * 1.5e5); // most of the latent heat
    CHECK(after.energyNow == doctest::Approx(before.energyNow - after.controlHeat).epsilon(1e-12).scale(0));
    CHECK(after.energyError < 1e-12);
    CHECK(f.counters().moving == 0);

    // What has set stays; nothing is left to do.
    CHECK(thawDestroyShape(f.world, id) == thawResult_ok);
    CHECK(thawDestroyShape(f.world, id) == thawResult_staleId);
    thawShapeState gone;
    CHECK(thawShape_GetState(f.world, id, &gone) == thawResult_staleId);
    f.step(60);
    CHECK(f.plan().reason[thawStage_control] == thawReason_noControl);
    CHECK(shareOf(f, inRing) > 0.98);
}

TEST_CASE("shapes: off or without strength they do nothing, and off what they held flows on") {
    WorldFixture plain, off, weak, on;
    Drawing disc;
    disc.ellipse(0.03f, 0, 0.02f, 0.02f);
    for (WorldFixture* f : {&plain, &off, &weak, &on}) pool(*f);
    thawShapeDef d = disc.def();
    d.reach = 0.06f, d.sets = false;
    const thawShapeId id = addShape(on, d);
    d.strength = 0;
    addShape(weak, d);
    d.strength = 1, d.enabled = false;
    addShape(off, d);
    for (WorldFixture* f : {&plain, &off, &weak, &on}) f->step(120);
    const auto right = [](const float* x) { return x[0] > 0.01f; };
    CHECK(shareOf(on, right) > 0.95);
    CHECK(shareOf(off, right) == shareOf(plain, right));
    CHECK(shareOf(weak, right) == shareOf(plain, right));
    CHECK(off.plan().reason[thawStage_control] == thawReason_noControl);
    const auto held = [](const float* x) { return std::hypot(x[0] - 0.03f, x[2]) < 0.021f; };
    CHECK(shareOf(on, held) > 0.98);
    CHECK(thawShape_Set(on.world, id, &d) == thawResult_ok);
    on.step(120);
    CHECK(shareOf(on, held) < 0.9);
}

TEST_CASE("shapes: the same bits with 1, 2 and 4 threads") {
    WorldFixture f[3];
    Drawing flat;
    flat.ellipse(0.02f, 0, 0.02f, 0.02f).ellipse(0.02f, 0, 0.008f, 0.008f).ellipse(-0.045f, 0, 0.015f, 0.012f);
    const Ball ball(0.013f);
    for (int n = 0; n < 3; ++n) {
        f[n].def.tasks.workerCount = 1 << n;
        pool(f[n], 20);
        thawShapeDef d = ball.def();
        d.position = {0, 0.03f, 0.03f}, d.reach = 0.05f, d.priority = 1;
        addShape(f[n], flat.def()), addShape(f[n], d);
    }
    for (int i = 0; i < 150; ++i)
        for (int n = 0; n < 3; ++n) {
            f[n].step();
            REQUIRE(thawWorld_GetStateHash(f[n].world) == thawWorld_GetStateHash(f[0].world));
        }
}

TEST_CASE("shapes: melt gathers in a ball in the air, sets there, and falls when the shape is gone") {
    WorldFixture f;
    pool(f);
    const Ball ball(0.0125f); // of the block's 12.3 cm^3 two thirds
    thawShapeDef d = ball.def();
    d.position = {0, 0.035f, 0.01f}, d.reach = 0.05f, d.speed = 0.2f;
    const thawShapeId id = addShape(f, d);
    CHECK(stateOf(f, id).size == doctest::Approx(4 / 3.0 * 3.14159 * 0.0125 * 0.0125 * 0.0125).epsilon(0.05).scale(0));
    f.step(600);
    const thawShapeState s = stateOf(f, id);
    CHECK(s.fill > 0.9f);
    CHECK(s.set > 0.98f * s.inside);
    CHECK(s.inside > 0.9f * s.size * 800);
    const auto inBall = [](const float* x) { return std::hypot(x[0], x[1] - 0.035f, x[2] - 0.01f) < 0.0135f; };
    const double held = shareOf(f, inBall);
    CHECK(held > 0.55);
    CHECK(held < 0.75); // the rest found no room and is on the floor
    CHECK(shareOf(f, [](const float* x) { return x[1] < 0.01f; }) > 0.95 - held);
    f.step(60);
    CHECK(shareOf(f, inBall) == held);
    CHECK(thawDestroyShape(f.world, id) == thawResult_ok);
    f.step(60);
    CHECK(shareOf(f, inBall) < 0.05);
    CHECK(shareOf(f, [](const float* x) { return x[1] < 0.03f; }) > 0.99);
}

TEST_CASE("shapes: one moves with its collider and goes with it") {
    WorldFixture f;
    pool(f);
    thawColliderDef c;
    thawInitColliderDef(&c, thawCollider_sphere);
    c.size = {0.001f, 0, 0}, c.position = {0, 0.5f, 0};
    thawColliderId collider;
    REQUIRE(thawCreateCollider(f.world, &c, &collider, nullptr) == thawResult_ok);
    Drawing disc; // in its space half a metre below it
    disc.ellipse(0, 0, 0.025f, 0.025f, 40, -0.5f);
    thawShapeDef d = disc.def();
    d.collider = collider, d.sets = false;
    const thawShapeId id = addShape(f, d);
    f.step(60);
    for (int i = 1; i <= 240; ++i) {
        REQUIRE(thawCollider_SetTransform(f.world, collider, {0, 0.5f, 0.0004f * static_cast<float>(i)},
                                          {0, 0, 0, 1}) == thawResult_ok);
        f.step();
    }
    CHECK(shareOf(f, [](const float* x) { return std::hypot(x[0], x[2] - 0.096f) < 0.026f; }) > 0.95);
    CHECK(thawDestroyCollider(f.world, collider) == thawResult_ok);
    thawShapeState s;
    CHECK(thawShape_GetState(f.world, id, &s) == thawResult_staleId);
    CHECK(f.counters().shapes == 0);
    f.step(5);
}

TEST_CASE("shapes: a thickness is what one takes, the rest is let go") {
    WorldFixture f;
    pool(f);
    Drawing disc;
    disc.ellipse(0, 0, 0.02f, 0.02f);
    thawShapeDef d = disc.def();
    d.thickness = 0.005f, d.sets = false;
    const thawShapeId id = addShape(f, d);
    f.step(300);
    const thawShapeState s = stateOf(f, id);
    CHECK(s.inside == doctest::Approx(static_cast<double>(s.size) * 0.005 * 800).epsilon(0.12).scale(0));
    CHECK(s.captured < 1.02f * s.size * 0.005f * 800);
    CHECK(f.counters().moving > 0);
    CHECK(s.fill > 0.9f);
}

TEST_CASE("shapes: what cannot be a shape is refused with a reason, and what is odd does no harm") {
    WorldFixture f;
    f.def.maxShapes = 4;
    pool(f);
    const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const uint64_t before = thawWorld_GetStateHash(f.world);
    thawShapeId id;
    const auto refused = [&](const thawShapeDef& d, const char* field) {
        CHECK(thawCreateShape(f.world, &d, &id) != thawResult_ok);
        CHECK_MESSAGE(std::string(thawWorld_GetLastError(f.world)).find(field) != std::string::npos,
                      thawWorld_GetLastError(f.world));
        CHECK(id.index1 == 0);
    };
    Drawing disc;
    disc.ellipse(0, 0, 0.02f, 0.02f);
    const Ball ball(0.01f);
    thawShapeDef d;
    thawInitShapeDef(&d), refused(d, "contourCount");
    d = disc.def(), d.points = nullptr, refused(d, "points");
    d = disc.def(), d.contourSizes = nullptr, refused(d, "contourSizes");
    int32_t two = 2;
    d = disc.def(), d.contourSizes = &two, refused(d, "contourSizes[0]");
    d = disc.def(), d.mesh = ball.def().mesh, refused(d, "contourCount");
    Drawing broken = disc;
    broken.points[7].z = nan, refused(broken.def(), "points[7]");
    Drawing line; // encloses nothing
    for (int k = 0; k < 5; ++k) line.points.push_back({0.01f * static_cast<float>(k), 0, 0});
    line.sizes = {5}, refused(line.def(), "no area");
    Drawing same; // neither does one point
    same.points.assign(4, {1, 1, 1}), same.sizes = {4}, refused(same.def(), "no area");
    Drawing twice = disc; // inside of none an odd number of times
    twice.ellipse(0, 0, 0.02f, 0.02f), refused(twice.def(), "less than one particle");
    Drawing tiny;
    tiny.ellipse(0, 0, 0.0003f, 0.0003f), refused(tiny.def(), "less than one particle");
    refused(Ball(0.0003f).def(), "less than one particle");
    d = disc.def(), d.strength = 1.5f, refused(d, "strength");
    d = disc.def(), d.speed = 0, refused(d, "speed");
    d = disc.def(), d.reach = nan, refused(d, "reach");
    d = disc.def(), d.depth = -1, refused(d, "depth");
    d = disc.def(), d.thickness = inf, refused(d, "thickness");
    d = disc.def(), d.setFill = 2, refused(d, "setFill");
    d = disc.def(), d.setTime = -1, refused(d, "setTime");
    d = disc.def(), d.normal = {nan, 0, 0}, refused(d, "normal");
    d = disc.def(), d.collider = {7, 7, 7}, refused(d, "collider");
    d = ball.def(), d.scale = 0, refused(d, "scale");
    d = ball.def(), d.rotation = {1, 1, 1, 1}, refused(d, "rotation");
    thawShapeDef raw{};
    CHECK(thawCreateShape(f.world, &raw, &id) == thawResult_notInitialised);
    CHECK(thawWorld_GetStateHash(f.world) == before);

    // A million points that cross each other all over; an eight, whose halves turn against each other; one that is far
    // away, and one that is open, which is closed.
    Drawing many;
    for (int k = 0; k < 1000000; ++k)
        many.points.push_back({0.02f * std::sin(0.0111f * static_cast<float>(k)), 0.001f,
                               0.02f * std::cos(0.0171f * static_cast<float>(k))});
    many.sizes = {1000000};
    d = many.def(), d.priority = 1;
    addShape(f, d);
    Drawing eight;
    for (int k = 0; k < 64; ++k) {
        const float a = 6.2831853f * static_cast<float>(k) / 64;
        eight.points.push_back({0.03f * std::sin(a), 0, 0.015f * std::sin(2 * a)});
    }
    eight.sizes = {64};
    const thawShapeId lobes = addShape(f, eight.def());
    CHECK(stateOf(f, lobes).size == doctest::Approx(4 * 0.03 * 0.015 * 2 / 3).epsilon(0.02).scale(0));
    Drawing far;
    far.ellipse(9e4f, 9e4f, 50, 50), d = far.def(), d.reach = 10, addShape(f, d);
    Drawing open;
    for (int k = 0; k < 30; ++k)
        open.points.push_back(
            {0.02f * std::cos(0.2f * static_cast<float>(k)), 0, 0.02f * std::sin(0.2f * static_cast<float>(k))});
    open.sizes = {30};
    const thawShapeId closed = addShape(f, open.def());
    CHECK(stateOf(f, closed).size == doctest::Approx(3.14159 * 0.02 * 0.02).epsilon(0.02).scale(0));
    CHECK(thawCreateShape(f.world, &d, &id) == thawResult_capacity);
    f.step(120);
    CHECK(shareOf(f, [](const float* x) { return std::hypot(x[0], x[1], x[2]) < 0.2f; }) == 1);
    // Another form under the same id.
    d = disc.def(), d.sets = false;
    CHECK(thawShape_Set(f.world, lobes, &d) == thawResult_ok);
    CHECK(stateOf(f, lobes).size == doctest::Approx(3.14159 * 0.02 * 0.02).epsilon(0.02).scale(0));
    f.step(30);
}

TEST_CASE("shapes: a step takes no memory") {
    WorldFixture f;
    pool(f);
    Drawing disc;
    disc.ellipse(0.01f, 0, 0.03f, 0.03f).ellipse(0.01f, 0, 0.01f, 0.01f);
    thawShapeDef d = disc.def();
    d.sets = false;
    addShape(f, d);
    f.step(60);
    const size_t taken = f.counters().memoryBytes;
    f.step(120);
    CHECK(f.counters().memoryBytes == taken);

    // Colliders take theirs when they come, not when the shape looks for them.
    thawColliderDef c;
    thawInitColliderDef(&c, thawCollider_sphere);
    c.size = {0.002f, 0, 0};
    for (int k = 0; k < 40; ++k) {
        c.position = {0.01f, 0.03f, 0.001f * static_cast<float>(k)};
        thawColliderId id;
        REQUIRE(thawCreateCollider(f.world, &c, &id, nullptr) == thawResult_ok);
    }
    const size_t with = f.counters().memoryBytes;
    CHECK(with > taken);
    f.step(1);
    const size_t lists = f.counters().memoryBytes; // the motion's own, of contacts
    f.step(60);
    CHECK(f.counters().memoryBytes == lists);
}
