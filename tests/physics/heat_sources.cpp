// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Heat sources: closed forms against brute force, what is half hidden, and what no input may do.
#include "heat/sources.h"
#include "heat/visibility.h"
#include "heat_fixture.h"
#include "world_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <initializer_list>

using namespace thaw;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSigma = 5.670374419e-8;
float room(Vec3) { return 293.15f; }
const float kHalf = std::sqrt(0.5f);
const Quat kDown{1, 0, 0, 0}; // local +y to -y

HeatSource warm(thawHeatSourceType type, Vec3 at, float temperature, float radius, Quat turn = {}, Vec3 size = {}) {
    HeatSource s;
    s.type = type, s.position = at, s.temperature = temperature, s.radius = radius, s.rotation = turn, s.size = size;
    s.enabled = s.alive = true;
    return s;
}

// Does a ray meet the shining side?
bool meets(const HeatSource& s, Vec3 o, Vec3 d) {
    if (s.type == thawHeatSource_sphere) {
        const Vec3 v = o - s.position;
        const float b = dot(v, d), c = dot(v, v) - s.radius * s.radius;
        return c <= 0 || (b < 0 && b * b >= c);
    }
    const Vec3 axis = rotate(s.rotation, {0, 1, 0});
    const float down = dot(axis, d);
    if (down >= 0) return false;
    const float t = dot(axis, s.position - o) / down;
    if (t <= 0) return false;
    const Vec3 at = rotate(conjugate(s.rotation), o + t * d - s.position);
    return s.type == thawHeatSource_disc ? at.x * at.x + at.z * at.z <= s.radius * s.radius
                                         : std::abs(at.x) <= s.size.x && std::abs(at.z) <= s.size.z;
}

// Form factor by the projected hemisphere (Nusselt): directions over a grid of the unit disc, alike by cosine.
double bruteForce(const HeatSource& s, Vec3 o, Vec3 n) {
    const Vec3 u = normalizeOr(cross(n, std::abs(n.x) < 0.6f ? Vec3{1, 0, 0} : Vec3{0, 1, 0}), {}), v = cross(n, u);
    constexpr int kGrid = 300;
    int hit = 0, all = 0;
    for (int i = 0; i < kGrid; ++i)
        for (int j = 0; j < kGrid; ++j) {
            const float x = (static_cast<float>(2 * i + 1) / kGrid) - 1,
                        y = (static_cast<float>(2 * j + 1) / kGrid) - 1;
            const float r2 = x * x + y * y;
            if (r2 > 1) continue;
            ++all, hit += meets(s, o, x * u + y * v + std::sqrt(1 - r2) * n);
        }
    return static_cast<double>(hit) / all;
}

} // namespace

TEST_CASE("heat: form factors of sphere, rectangle and disc, at any place and turn, as by brute force") {
    uint32_t seed = 11;
    int compared = 0, cut = 0;
    for (int k = 0; k < 240; ++k) {
        const thawHeatSourceType type = k % 3 == 0   ? thawHeatSource_sphere
                                        : k % 3 == 1 ? thawHeatSource_rectangle
                                                     : thawHeatSource_disc;
        const Vec3 a = inCube(seed), b = inCube(seed), c = inCube(seed);
        const Vec3 axis = normalizeOr(a, {0, 1, 0});
        const float w = 0.7f * b.x;
        const Quat turn{axis.x * std::sqrt(1 - w * w), axis.y * std::sqrt(1 - w * w), axis.z * std::sqrt(1 - w * w), w};
        HeatSource s = warm(type, {0.1f, -0.2f, 0.3f}, 1000, 0.2f + 0.3f * uniform(seed), turn,
                            {0.1f + 0.5f * uniform(seed), 0, 0.1f + 0.3f * uniform(seed)});
        const Vec3 o = s.position + 0.9f * c, n = normalizeOr(inCube(seed), {0, 0, 1});
        const Emitter e = makeEmitter(s, 0, 0);
        const double got = static_cast<double>(irradiance(e, {o, n, 1e-6f})) / (kSigma * 1e12),
                     real = bruteForce(s, o, n);
        CAPTURE(k);
        CHECK(got == doctest::Approx(real).epsilon(0.01).scale(0.15));
        compared += real > 0.01 && got > 0.01;
        // Cut by the horizon, or inside.
        Vec3 up = highest(e, {o, n, 1e-6f}) - o, low = highest(e, {o, -n, 1e-6f}) - o;
        cut += dot(up, n) > 0 && dot(low, n) < 0 && real > 0;
        // A drop: the mean over all orientations is a quarter of the solid angle over pi.
        const double drop = static_cast<double>(irradiance(e, {o, {}, 1e-6f})) / (kSigma * 1e12);
        CHECK(drop >= 0);
        CHECK(drop <= 1.000001);
        if (type == thawHeatSource_sphere && length(o - s.position) > s.radius) {
            const double sine = static_cast<double>(s.radius) / static_cast<double>(length(o - s.position));
            CHECK(drop == doctest::Approx(0.5 * (1 - std::sqrt(1 - sine * sine))).epsilon(1e-3));
        }
    }
    CHECK(compared > 60);
    CHECK(cut > 30);
}

TEST_CASE("heat: a far source is a point of its power, whatever its shape") {
    const Receiver r{{0, 0, 0}, {0, 1, 0}, 1e-6f};
    for (const float d : {3.0f, 300.0f}) {
        const double M = kSigma * 1e12, R = 0.01, d2 = static_cast<double>(d) * d;
        const HeatSource ball = warm(thawHeatSource_sphere, {0, d, 0}, 1000, 0.01f);
        const HeatSource disc = warm(thawHeatSource_disc, {0, d, 0}, 1000, 0.01f, kDown);
        const HeatSource plate = warm(thawHeatSource_rectangle, {0, d, 0}, 1000, 0.01f, kDown, {0.01f, 0, 0.02f});
        CHECK(static_cast<double>(irradiance(makeEmitter(ball, 0, 0), r)) ==
              doctest::Approx(M * R * R / d2).epsilon(1e-3));
        CHECK(static_cast<double>(irradiance(makeEmitter(disc, 0, 0), r)) ==
              doctest::Approx(M * R * R / d2).epsilon(1e-3));
        CHECK(static_cast<double>(irradiance(makeEmitter(plate, 0, 0), r)) ==
              doctest::Approx(M * 8 * R * R / (kPi * d2)).epsilon(1e-3));
        // From behind nothing; at ambient nothing; below it cools.
        CHECK(irradiance(makeEmitter(warm(thawHeatSource_disc, {0, d, 0}, 1000, 0.01f), 0, 0), r) == 0);
        CHECK(strengthOf(warm(thawHeatSource_disc, {0, d, 0}, 293.15f, 0.01f), 293.15f) == 0);
        CHECK(irradiance(makeEmitter(warm(thawHeatSource_disc, {0, d, 0}, 200, 0.01f, kDown), 0, 293.15f), r) < 0);
    }
    HeatSource sun;
    sun.type = thawHeatSource_directional, sun.rotation = kDown, sun.irradiance = 900, sun.enabled = sun.alive = true;
    CHECK(irradiance(makeEmitter(sun, 0, 300), r) == doctest::Approx(900));
    CHECK(irradiance(makeEmitter(sun, 0, 300), {{0, 0, 0}, {0, -1, 0}, 1}) == 0);
    CHECK(irradiance(makeEmitter(sun, 0, 300), {{0, 0, 0}, {0, kHalf, kHalf}, 1}) == doctest::Approx(900 * kHalf));
}

TEST_CASE("heat: what is half hidden gives half, what is hidden gives nothing") {
    // A heater of 0.4 by 0.4 m over a plate; a screen right under one half of it.
    const auto make = [](HeatFixture& f, std::vector<Collider> colliders, thawHeatSourceType type) {
        f.addBlock({-0.1f, 0, -0.1f}, 20, 4, 20, room);
        f.sources = {warm(type, {0, 0.44f, 0}, 1200, 0.2f, kDown, {0.2f, 0, 0.2f})};
        f.colliders = std::move(colliders);
        f.build();
    };
    for (const thawHeatSourceType type : {thawHeatSource_sphere, thawHeatSource_rectangle, thawHeatSource_disc}) {
        // Under the sphere, which is nearer by its radius.
        const float y = type == thawHeatSource_sphere ? 0.2f : 0.439f;
        HeatFixture open(0.01f), half(0.01f), full(0.01f), coarse(0.01f);
        coarse.raysPerSource = 4;
        make(open, {}, type);
        const Collider right = box({0.5f, y, 0}, {0.5f, 0.0005f, 1});
        make(half, {right}, type), make(coarse, {right}, type);
        make(full, {right, box({-0.5f, y, 0}, {0.5f, 0.0005f, 1})}, type);
        CAPTURE(type);
        const double all = sum(absorbed(open));
        CHECK(all > 0);
        CHECK(sum(absorbed(half)) == doctest::Approx(0.5 * all).epsilon(0.01).scale(0));
        CHECK(sum(absorbed(coarse)) == doctest::Approx(0.5 * all).epsilon(0.03).scale(0));
        CHECK(sum(absorbed(full)) == 0);
    }
}

TEST_CASE("heat: what rests under sources that rest casts no rays, and what moves wakes only what it can concern") {
    for (const uint64_t version : {0, 1}) { // found out by looking, or told by the world
        HeatFixture f(0.01f);
        f.surfaceVersion = version;
        f.addBlock({-0.1f, 0, -0.1f}, 20, 4, 20, room);
        f.sources = {warm(thawHeatSource_rectangle, {-0.3f, 0.5f, 0}, 1200, 0.1f, kDown, {0.01f, 0, 0.01f})};
        f.colliders = {box({0, 0.2f, 0}, {0.01f, 0.01f, 0.3f})};
        f.build();
        const double first = sum(absorbed(f));
        CHECK(f.heat.stats().rays >= 16 * 380);
        for (int k = 0; k < 200; ++k) {
            const double now = sum(absorbed(f));
            REQUIRE(f.heat.stats().rays == 0);
            REQUIRE(now == doctest::Approx(first).epsilon(1e-9));
        }
        // Stronger, not elsewhere: no rays either.
        f.sources[0].temperature = 1400;
        const double hotter = sum(absorbed(f));
        const double ratio = (std::pow(1400.0, 4) - std::pow(293.15, 4)) / (std::pow(1200.0, 4) - std::pow(293.15, 4));
        CHECK(hotter == doctest::Approx(ratio * first).epsilon(1e-5));
        CHECK(f.heat.stats().rays == 0);
        // Behind everything: concerns nobody.
        f.colliders.push_back(box({0, 3, 0}, {1, 1, 1})), ++f.colliderVersion;
        absorbed(f);
        CHECK(f.heat.stats().rays == 0);
        f.colliders[1].transform.position.y = 4, ++f.colliderVersion;
        absorbed(f);
        CHECK(f.heat.stats().rays == 0);
        // Between one end and the source: only those.
        f.colliders[0].transform.position.x = 0.04f, ++f.colliderVersion;
        absorbed(f);
        const int some = f.heat.stats().rays;
        CHECK(some > 0);
        CHECK(some < 16 * 330);
        HeatFixture fresh(0.01f);
        fresh.addBlock({-0.1f, 0, -0.1f}, 20, 4, 20, room);
        fresh.sources = f.sources, fresh.colliders = f.colliders;
        fresh.build();
        const std::vector<double> a = absorbed(f), b = absorbed(fresh);
        for (size_t i = 0; i < a.size(); ++i) REQUIRE(a[i] == doctest::Approx(b[i]).epsilon(1e-6));
        // The source moves: all look.
        f.sources[0].position.x += 0.05f;
        absorbed(f);
        CHECK(f.heat.stats().rays > 16 * 380);
    }
}

TEST_CASE("heat: a small budget of rays goes to where the most may have changed") {
    HeatFixture f(0.01f);
    f.rayRefresh = 0.1f;
    f.addBlock({-0.1f, 0, -0.1f}, 20, 4, 20, room);
    f.sources = {warm(thawHeatSource_disc, {0, 0.5f, 0}, 1200, 0.05f, kDown)};
    f.colliders = {box({0, 0.1f, 0}, {0.02f, 0.005f, 0.02f})};
    f.build();
    absorbed(f);
    // A finger over the plate: the shadow is right at once, although few may look.
    for (int k = 0; k < 20; ++k) {
        f.colliders[0].transform.position.x = 0.003f * static_cast<float>(k), ++f.colliderVersion;
        absorbed(f);
        CHECK(f.heat.stats().rays <= 16 * 48);
    }
    HeatFixture fresh(0.01f);
    fresh.addBlock({-0.1f, 0, -0.1f}, 20, 4, 20, room);
    fresh.sources = f.sources, fresh.colliders = f.colliders;
    fresh.build();
    const std::vector<double> now = absorbed(f), exact = absorbed(fresh);
    double wrong = 0;
    for (size_t i = 0; i < now.size(); ++i) wrong += std::abs(now[i] - exact[i]);
    CHECK(wrong < 0.03 * sum(exact));
}

TEST_CASE("visibility: colliders that move get a new place, no new tree, and shade as if made there") {
    CleanMesh mesh;
    const Vec3 half{0.1f, 0.3f, 0.2f};
    for (int k = 0; k < 8; ++k)
        mesh.vertices.push_back({k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y, k & 4 ? half.z : -half.z});
    mesh.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                    2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    for (const Vec3& v : mesh.vertices) mesh.bounds.grow(v);
    Collider a;
    a.type = thawCollider_mesh, a.alive = true, a.mesh = std::make_shared<CleanMesh>(mesh);
    Allocator allocator;
    Visibility v(allocator);
    std::vector<Collider> colliders{a, box({0, 2, 0}, {0.2f, 0.1f, 0.3f})};
    uint32_t seed = 3;
    uint64_t version = 1;
    int blockedTotal = 0;
    for (int round = 0; round < 60; ++round) {
        const Vec3 axis = normalizeOr(inCube(seed), {0, 1, 0});
        const float w = uniform(seed), s = std::sqrt(1 - w * w);
        for (Collider& c : colliders) c.transform = {inCube(seed), {s * axis.x, s * axis.y, s * axis.z, w}, 1};
        v.clearStirs();
        v.setColliders(colliders.data(), 2, ++version);
        v.commit();
        CHECK(v.stirs().size() >= 2);
        for (int k = 0; k < 20; ++k) {
            Ray rays[8];
            bool blocked[8], expected[8];
            for (int i = 0; i < 8; ++i) {
                const Vec3 from = 2 * inCube(seed), to = 2 * inCube(seed);
                rays[i].surface = rays[i].raised = from, rays[i].skip = 0;
                rays[i].distance = length(to - from), rays[i].direction = normalizeOr(to - from, {0, 1, 0});
                expected[i] = false;
                for (const Collider& c : colliders) {
                    // Steps along it: entering counts.
                    const Vec3 size = c.type == thawCollider_mesh ? half : c.size;
                    const auto inside = [&](float t) {
                        const Vec3 p =
                            rotate(conjugate(c.transform.rotation), from + t * (to - from) - c.transform.position);
                        return std::abs(p.x) < size.x && std::abs(p.y) < size.y && std::abs(p.z) < size.z;
                    };
                    bool was = inside(0);
                    for (int t = 1; t <= 400; ++t) {
                        const bool now = inside(static_cast<float>(t) / 400);
                        expected[i] |= now && !was, was = now;
                    }
                }
            }
            v.cast(rays, 8, blocked);
            for (int i = 0; i < 8; ++i) {
                if (expected[i]) REQUIRE(blocked[i]); // a graze may be missed by the steps, not the other way round
                blockedTotal += blocked[i] - expected[i];
            }
        }
    }
    CHECK(blockedTotal < 60); // grazes, of 9600
    CHECK(v.colliderBuilds() == 1);
    CHECK(v.colliderMoves() >= 118);
}

TEST_CASE("heat: sources inside, at distance nought, cold, and of a thousand million kelvin stay bounded") {
    for (const thawHeatSourceType type : {thawHeatSource_point, thawHeatSource_sphere, thawHeatSource_rectangle,
                                          thawHeatSource_disc, thawHeatSource_directional})
        for (const Vec3 at : {Vec3{0.03f, 0.03f, 0.03f}, Vec3{0.03f, 0.06f, 0.03f}, Vec3{0.035f, 0.055f, 0.035f},
                              Vec3{0.03f, 1e5f, 0.03f}})
            for (const float strength : {-1e12f, -3.0f, 0.0f, 1e-30f, 1e12f})
                for (const float kelvin : {0.0f, 293.15f, 1e9f}) {
                    if (strength != 1e12f && type != thawHeatSource_point && type != thawHeatSource_directional)
                        continue;
                    HeatFixture f(0.01f);
                    f.convection = 5;
                    f.addBlock({0, 0, 0}, 6, 6, 6, room);
                    HeatSource s = warm(type, at, kelvin, 0.01f, kDown, {0.02f, 0, 0.02f});
                    s.power = s.irradiance = strength;
                    f.sources = {s};
                    f.build();
                    const double before = f.energy();
                    for (int k = 0; k < 4; ++k) f.step(k % 2 ? 1.0 : 100.0);
                    for (size_t i = 0; i < f.size(); ++i) {
                        REQUIRE(f.particles.temperature[i] >= 0);
                        REQUIRE(f.particles.temperature[i] <= 1.001e5f);
                        REQUIRE(std::isfinite(f.particles.enthalpy[i]));
                    }
                    const double in = f.total.absorbed - f.total.emitted - f.total.convected;
                    REQUIRE(std::isfinite(in));
                    const double moved =
                        std::max({std::abs(f.total.absorbed), std::abs(f.total.emitted), std::abs(before)});
                    REQUIRE(std::abs(f.energy() - before - in) <= 1e-6 * moved);
                    if (type == thawHeatSource_sphere && kelvin == 1e9f && at.y == 0.06f) REQUIRE(f.total.absorbed > 0);
                }
}

TEST_CASE("heat: the host answers rays in place of Embree") {
    struct Host {
        int calls = 0, rays = 0, longest = 0;
        float wall = 0; // blocks what begins beyond x = wall
        static void occluded(const thawRay* rays, int32_t count, bool* blocked, void* user) {
            Host& h = *static_cast<Host*>(user);
            ++h.calls, h.rays += count, h.longest = std::max(h.longest, static_cast<int>(count));
            for (int32_t k = 0; k < count; ++k) {
                if (blocked[k]) h.calls = -1000000;
                const thawVec3 d = rays[k].direction;
                if (std::abs(d.x * d.x + d.y * d.y + d.z * d.z - 1) > 1e-4f || !(rays[k].distance > 0))
                    h.calls = -1000000;
                blocked[k] = rays[k].origin.x > h.wall;
            }
        }
    };
    const auto run = [](bool hook, bool melt, int workers, Host& host, uint64_t* hash) {
        WorldFixture f;
        f.def.particleSpacing = 0.01f, f.def.tasks.workerCount = workers;
        if (hook) f.def.rays = {Host::occluded, melt, &host};
        f.create(), f.addMaterial();
        f.addFloor();
        f.addBox({-0.1f, 0, -0.1f}, {0.1f, 0.04f, 0.1f});
        f.addBox({-0.1f, 0.1f, -0.02f}, {0.1f, 0.14f, 0.02f}); // shades the one below
        thawHeatSourceDef d;
        thawInitHeatSourceDef(&d);
        d.type = thawHeatSource_disc, d.position = {0, 0.6f, 0}, d.rotation = {1, 0, 0, 0}, d.radius = 0.05f;
        thawHeatSourceId id;
        REQUIRE(thawCreateHeatSource(f.world, &d, &id) == thawResult_ok);
        f.step(1);
        if (hash) *hash = thawWorld_GetStateHash(f.world);
        return f.ledger().absorbed;
    };
    Host nothing, half, open;
    nothing.wall = half.wall = open.wall = 10;
    const double own = run(false, false, 1, nothing, nullptr);
    CHECK(nothing.calls == 0);
    CHECK(own > 0);
    // A host without obstacles: the melt shades itself all the same, unless the host answers for it too.
    CHECK(run(true, false, 1, open, nullptr) == doctest::Approx(own).epsilon(1e-6));
    CHECK(open.calls > 0);
    CHECK(open.longest > 8);
    CHECK(open.longest <= 512);
    CHECK(run(true, true, 1, open, nullptr) > 1.05 * own);
    half.wall = 0;
    uint64_t one = 0, four = 1;
    CHECK(run(true, false, 1, half, &one) == doctest::Approx(0.5 * own).epsilon(0.01));
    CHECK(run(true, false, 4, half, &four) == doctest::Approx(0.5 * own).epsilon(0.01));
    CHECK(one == four);
    CHECK(half.calls > 0);
}

TEST_CASE("heat: sources are checked, move, and switch") {
    WorldFixture f;
    f.def.particleSpacing = 0.01f;
    f.create(), f.addMaterial();
    f.addFloor();
    f.addBox({-0.05f, 0, -0.05f}, {0.05f, 0.04f, 0.05f});
    thawHeatSourceDef d;
    thawInitHeatSourceDef(&d);
    d.type = thawHeatSource_rectangle, d.position = {0, 0.3f, 0}, d.rotation = {1, 0, 0, 0};
    thawHeatSourceId id;
    REQUIRE(thawCreateHeatSource(f.world, &d, &id) == thawResult_ok);
    f.step(3);
    CHECK(f.counters().rays == 0);
    const double a = f.ledger().absorbed;
    CHECK(a > 0);
    // Turned away, and off.
    d.rotation = {0, 0, 0, 1};
    REQUIRE(thawHeatSource_Set(f.world, id, &d) == thawResult_ok);
    f.step();
    CHECK(f.ledger().absorbed == a);
    d.rotation = {1, 0, 0, 0}, d.enabled = false;
    REQUIRE(thawHeatSource_Set(f.world, id, &d) == thawResult_ok);
    f.step();
    CHECK(f.ledger().absorbed == a);
    CHECK(f.plan().reason[thawStage_radiation] == thawReason_noSource);
    d.enabled = true, d.temperature = f.def.ambientTemperature;
    REQUIRE(thawHeatSource_Set(f.world, id, &d) == thawResult_ok);
    f.step();
    CHECK(f.plan().reason[thawStage_radiation] == thawReason_noSource);
    d.temperature = 1e9f;
    REQUIRE(thawHeatSource_Set(f.world, id, &d) == thawResult_ok);
    f.step(2);
    CHECK(f.counters().maxTemperature <= 1.001e5f);
    CHECK(f.ledger().energyError < 1e-6);

    struct Bad {
        const char* field;
        void (*spoil)(thawHeatSourceDef&);
    };
    for (const Bad& bad : {Bad{"temperature", [](thawHeatSourceDef& x) { x.temperature = NAN; }},
                           Bad{"temperature", [](thawHeatSourceDef& x) { x.temperature = INFINITY; }},
                           Bad{"temperature", [](thawHeatSourceDef& x) { x.temperature = -1; }},
                           Bad{"power", [](thawHeatSourceDef& x) { x.power = INFINITY; }},
                           Bad{"irradiance", [](thawHeatSourceDef& x) { x.irradiance = NAN; }},
                           Bad{"emissivity", [](thawHeatSourceDef& x) { x.emissivity = 2; }},
                           Bad{"rotation", [](thawHeatSourceDef& x) { x.rotation = {}; }},
                           Bad{"size.x", [](thawHeatSourceDef& x) { x.size.x = 0; }},
                           Bad{"type", [](thawHeatSourceDef& x) { x.type = static_cast<thawHeatSourceType>(5); }}}) {
        thawHeatSourceDef x = d;
        bad.spoil(x);
        CHECK(thawHeatSource_Set(f.world, id, &x) == thawResult_invalidArgument);
        CHECK(std::string(thawWorld_GetLastError(f.world)).find(bad.field) != std::string::npos);
    }
}
