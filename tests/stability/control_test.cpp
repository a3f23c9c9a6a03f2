// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world_fixture.h"

#include <algorithm>
#include <limits>

namespace {

thawPathDef pathDef(const std::vector<thawVec3>& points) {
    thawPathDef d;
    thawInitPathDef(&d);
    d.points = points.data(), d.pointCount = static_cast<int32_t>(points.size());
    return d;
}

thawPathId addPath(WorldFixture& f, const thawPathDef& d) {
    thawPathId id;
    REQUIRE_MESSAGE(thawCreatePath(f.world, &d, &id) == thawResult_ok, thawWorld_GetLastError(f.world));
    return id;
}

// A block of liquid on a floor on which it would lie still.
void pool(WorldFixture& f) {
    f.def.thermalTimeScale = 0;
    f.create();
    thawMaterialDef m;
    thawInitMaterialDef(&m, thawMaterial_wax);
    m.viscosityLiquid = 1;
    f.addMaterial(m);
    f.addFloor();
    f.addBox({-0.016f, 0, -0.016f}, {0.016f, 0.012f, 0.016f}, 360);
}

double meanX(const WorldFixture& f) {
    thawParticleView p;
    thawWorld_GetParticles(f.world, &p);
    double sum = 0;
    for (int i = 0; i < p.count; ++i) sum += static_cast<double>(p.positions[4 * i]);
    return sum / p.count;
}

} // namespace

TEST_CASE("control: liquid goes along a path, and stays where there is none") {
    WorldFixture with, without;
    pool(with), pool(without);
    const std::vector<thawVec3> line{{-0.02f, 0.004f, 0}, {0.06f, 0.004f, 0}, {0.12f, 0.004f, 0.04f}};
    thawPathDef d = pathDef(line);
    d.radius = 0.012f, d.reach = 0.03f, d.speed = 0.06f;
    const thawPathId id = addPath(with, d);
    CHECK(with.counters().paths == 1);
    with.step(60), without.step(60);
    CHECK(with.plan().enabled[thawStage_control]);
    CHECK(without.plan().reason[thawStage_control] == thawReason_noControl);
    CHECK(meanX(with) > 0.03);
    CHECK(std::abs(meanX(without)) < 0.002);
    thawPathState s;
    REQUIRE(thawPath_GetState(with.world, id, &s) == thawResult_ok);
    CHECK(s.mass > 0.8f * s.captured);
    CHECK(s.front > 0.05f);
    CHECK(std::isnan(s.arrivalTime));
    with.step(300);
    REQUIRE(thawPath_GetState(with.world, id, &s) == thawResult_ok);
    CHECK(s.arrived > 0.8f * s.captured);
    CHECK(s.arrivalTime > 1);
    CHECK(s.mass + s.arrived + s.spilled == doctest::Approx(s.captured).epsilon(1e-4));

    // Off, it guides nothing; gone, it is nobody's.
    d.enabled = false;
    CHECK(thawPath_Set(with.world, id, &d) == thawResult_ok);
    with.step(1);
    CHECK(with.plan().reason[thawStage_control] == thawReason_noControl);
    CHECK(thawDestroyPath(with.world, id) == thawResult_ok);
    CHECK(thawDestroyPath(with.world, id) == thawResult_staleId);
    CHECK(thawPath_GetState(with.world, id, &s) == thawResult_staleId);
    CHECK(with.counters().paths == 0);
}

TEST_CASE("control: the same bits with 1, 2 and 4 threads") {
    WorldFixture f[3];
    const std::vector<thawVec3> left{{-0.02f, 0.004f, 0}, {0.03f, 0.004f, 0}, {0.08f, 0.004f, 0.04f}},
        right{{-0.02f, 0.004f, 0}, {0.03f, 0.004f, 0}, {0.08f, 0.004f, -0.04f}};
    for (int n = 0; n < 3; ++n) {
        f[n].def.tasks.workerCount = 1 << n;
        pool(f[n]);
        for (const auto* line : {&left, &right}) {
            thawPathDef d = pathDef(*line);
            d.reach = 0.03f, d.share = line == &left ? 2.0f : 1.0f;
            addPath(f[n], d);
        }
    }
    for (int i = 0; i < 120; ++i)
        for (int n = 0; n < 3; ++n) {
            f[n].step();
            REQUIRE(thawWorld_GetStateHash(f[n].world) == thawWorld_GetStateHash(f[0].world));
        }
}

TEST_CASE("control: a path that crosses itself is followed to its end") {
    WorldFixture f;
    pool(f);
    // A loop: over its own first part again, across it.
    const std::vector<thawVec3> line{{0, 0.004f, 0},         {0.06f, 0.004f, 0},     {0.09f, 0.004f, 0.03f},
                                     {0.06f, 0.004f, 0.06f}, {0.03f, 0.004f, 0.03f}, {0.03f, 0.004f, -0.03f},
                                     {0.03f, 0.004f, -0.08f}};
    thawPathDef d = pathDef(line);
    d.radius = 0.01f, d.reach = 0.03f, d.strength = 0.95f, d.speed = 0.1f;
    const thawPathId id = addPath(f, d);
    f.step(240);
    thawPathState s;
    REQUIRE(thawPath_GetState(f.world, id, &s) == thawResult_ok);
    CHECK(s.arrived > 0.5f * s.captured);
    CHECK(s.arrivalTime > 0.8f * s.length / 0.1f); // by all of the way
}

TEST_CASE("control: where paths cross, melt goes on along its own, and what follows none takes the higher priority") {
    WorldFixture f;
    pool(f);
    const std::vector<thawVec3> along{{-0.02f, 0.004f, 0}, {0.12f, 0.004f, 0}},
        across{{0.05f, 0.004f, -0.06f}, {0.05f, 0.004f, 0.06f}};
    thawPathDef d = pathDef(along);
    d.radius = 0.012f, d.reach = 0.03f, d.strength = 0.95f, d.speed = 0.08f;
    const thawPathId own = addPath(f, d);
    d.points = across.data(), d.priority = 5;
    const thawPathId other = addPath(f, d);
    f.step(300);
    thawPathState s;
    REQUIRE(thawPath_GetState(f.world, own, &s) == thawResult_ok);
    CHECK(s.arrived > 0.85f * s.captured);
    REQUIRE(thawPath_GetState(f.world, other, &s) == thawResult_ok);
    CHECK(s.captured < 0.001f);

    // The same block where both begin.
    for (const int first : {1, -1}) {
        WorldFixture g;
        pool(g);
        const std::vector<thawVec3> left{{0, 0.004f, 0}, {-0.1f, 0.004f, 0}}, right{{0, 0.004f, 0}, {0.1f, 0.004f, 0}};
        d = pathDef(left), d.reach = 0.04f, d.priority = -first;
        addPath(g, d);
        d.points = right.data(), d.priority = first;
        addPath(g, d);
        g.step(90);
        CHECK(static_cast<float>(first) * meanX(g) > 0.02);
    }
}

TEST_CASE("control: a path moves with its collider and goes with it") {
    WorldFixture f;
    pool(f);
    thawColliderDef c;
    thawInitColliderDef(&c, thawCollider_sphere);
    c.size = {0.001f, 0, 0}, c.position = {0, 0.5f, 0};
    thawColliderId collider;
    REQUIRE(thawCreateCollider(f.world, &c, &collider, nullptr) == thawResult_ok);
    // In its space half a metre below it.
    const std::vector<thawVec3> line{{-0.03f, -0.496f, 0}, {0.03f, -0.496f, 0}};
    thawPathDef d = pathDef(line);
    d.radius = 0.012f, d.reach = 0.04f, d.strength = 1, d.speed = 0, d.collider = collider;
    const thawPathId id = addPath(f, d);
    for (int i = 1; i <= 120; ++i) {
        REQUIRE(thawCollider_SetTransform(f.world, collider, {0, 0.5f, 0.0005f * static_cast<float>(i)},
                                          {0, 0, 0, 1}) == thawResult_ok);
        f.step();
    }
    thawParticleView p;
    thawWorld_GetParticles(f.world, &p);
    double z = 0;
    for (int i = 0; i < p.count; ++i) z += static_cast<double>(p.positions[4 * i + 2]) / p.count;
    CHECK(z > 0.045);
    CHECK(thawDestroyCollider(f.world, collider) == thawResult_ok);
    thawPathState s;
    CHECK(thawPath_GetState(f.world, id, &s) == thawResult_staleId);
    f.step(5);
}

TEST_CASE("control: what cannot be a path is refused with a reason, and what is odd does no harm") {
    WorldFixture f;
    f.def.maxPaths = 2;
    pool(f);
    const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<thawVec3> line{{0, 0.004f, 0}, {0.05f, 0.004f, 0}}, same(5, thawVec3{1, 1, 1}),
        broken{{0, 0, 0}, {nan, 0, 0}};
    thawPathId id;
    const uint64_t before = thawWorld_GetStateHash(f.world);
    const auto refused = [&](const thawPathDef& d, const char* field) {
        CHECK(thawCreatePath(f.world, &d, &id) != thawResult_ok);
        CHECK_MESSAGE(std::string(thawWorld_GetLastError(f.world)).find(field) != std::string::npos,
                      thawWorld_GetLastError(f.world));
        CHECK(id.index1 == 0);
    };
    thawPathDef d = pathDef(line);
    d.pointCount = 1, refused(d, "pointCount");
    d = pathDef(line), d.points = nullptr, refused(d, "points");
    refused(pathDef(same), "points");
    refused(pathDef(broken), "points[1]");
    d = pathDef(line), d.radius = 0, refused(d, "radius");
    d = pathDef(line), d.reach = 0.001f, refused(d, "reach");
    d = pathDef(line), d.strength = 1.5f, refused(d, "strength");
    d = pathDef(line), d.speed = inf, refused(d, "speed");
    d = pathDef(line), d.arrivalTime = nan, refused(d, "arrivalTime");
    d = pathDef(line), d.beadSpacing = 0.01f, refused(d, "beadSpacing");
    d = pathDef(line), d.startAbsorptivity = 2, refused(d, "startAbsorptivity");
    d = pathDef(line), d.collider = {7, 7, 7}, refused(d, "collider");
    thawPathDef raw{};
    CHECK(thawCreatePath(f.world, &raw, &id) == thawResult_notInitialised);
    CHECK(thawWorld_GetStateHash(f.world) == before);

    // A million points, all over; far from everything; as strong as can be, as short as can be.
    std::vector<thawVec3> many;
    for (int k = 0; k < 1000000; ++k)
        many.push_back({0.1f * std::sin(0.001f * static_cast<float>(k)), 0.004f,
                        0.1f * std::cos(0.0007f * static_cast<float>(k))});
    d = pathDef(many), d.strength = 1, d.speed = 1;
    addPath(f, d);
    const std::vector<thawVec3> dot{{0, 0.004f, 0}, {0.00001f, 0.004f, 0}};
    d = pathDef(dot), d.strength = 1, d.speed = 100, d.priority = 5;
    addPath(f, d);
    CHECK(thawCreatePath(f.world, &d, &id) == thawResult_capacity);
    f.step(120);
    thawParticleView p;
    thawWorld_GetParticles(f.world, &p);
    for (int i = 0; i < p.count; ++i) REQUIRE(std::abs(p.positions[4 * i]) < 5);
}

TEST_CASE("control: a path's start takes up more heat") {
    float melted[2];
    for (int k = 0; k < 2; ++k) {
        WorldFixture f;
        f.def.thermalTimeScale = 50;
        f.create();
        thawMaterialDef m;
        thawInitMaterialDef(&m, thawMaterial_wax);
        m.absorptivity = 0.2f;
        f.addMaterial(m);
        f.addFloor();
        f.addBox({-0.01f, 0, -0.01f}, {0.01f, 0.02f, 0.01f}, 320);
        f.addSource({0, 0.06f, 0}, 150);
        const std::vector<thawVec3> line{{0, 0.02f, 0}, {0.02f, 0, 0}};
        thawPathDef d = pathDef(line);
        d.strength = 0.01f, d.speed = 0;
        if (k) d.startAbsorptivity = 1;
        addPath(f, d);
        f.step(150);
        melted[k] = f.counters().meltedFraction;
        thawLedger l;
        thawWorld_GetLedger(f.world, &l);
        CHECK(l.energyError < 1e-9);
    }
    CHECK(melted[1] > 1.5f * melted[0]);
    CHECK(melted[0] > 0.005f);
}

TEST_CASE("paths: melt that was at the end of one follows another in its place") {
    WorldFixture f;
    pool(f);
    const std::vector<thawVec3> there{{-0.02f, 0.004f, 0}, {0.01f, 0.004f, 0}},
        back{{0.08f, 0.004f, 0}, {-0.05f, 0.004f, 0}};
    thawPathDef d = pathDef(there);
    d.radius = 0.02f, d.speed = 0.1f;
    const thawPathId first = addPath(f, d);
    f.step(240);
    thawPathState s;
    REQUIRE(thawPath_GetState(f.world, first, &s) == thawResult_ok);
    const float arrived = s.arrived;
    REQUIRE(arrived > 0.5f * static_cast<float>(f.ledger().massNow));
    REQUIRE(thawDestroyPath(f.world, first) == thawResult_ok);
    d.points = back.data(), d.radius = 0.05f;
    const thawPathId second = addPath(f, d);
    REQUIRE(second.index1 == first.index1);
    f.step(8);
    REQUIRE(thawPath_GetState(f.world, second, &s) == thawResult_ok);
    CHECK(s.captured == doctest::Approx(f.ledger().massNow).epsilon(1e-3).scale(0));
}
