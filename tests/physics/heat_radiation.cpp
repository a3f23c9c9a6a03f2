// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "heat/visibility.h"
#include "heat_fixture.h"

#include <doctest/doctest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <initializer_list>

using namespace thaw;

namespace {

constexpr double kPi = 3.14159265358979323846;
float room(Vec3) { return 293.15f; }

HeatSource lamp(Vec3 position, float power, float radius = 0.001f) { return {position, power, radius, true, true}; }

Ray between(Vec3 from, Vec3 to) {
    Ray r;
    r.surface = r.raised = from, r.distance = length(to - from), r.direction = normalizeOr(to - from, {0, 1, 0});
    r.skip = 0;
    return r;
}

} // namespace

TEST_CASE("heat: a plate under a lamp gets the inverse square times the cosine") {
    HeatFixture f(0.01f);
    f.addBlock({0, 0, 0}, 20, 6, 20, room);
    f.sources = {lamp({0.03f, 0.25f, 0.12f}, 40)};
    f.build();
    const std::vector<double> e = absorbed(f, 0.5);
    int checked = 0;
    for (size_t i = 0; i < f.size(); ++i) {
        const Vec4 p = f.particles.position[i];
        const bool inner = p.x > 0.02f && p.x < 0.18f && p.z > 0.02f && p.z < 0.18f;
        if (!inner) continue;
        if (p.y < 0.05f) {
            REQUIRE(e[f.particles.id[i]] == 0);
            continue;
        }
        const double dx = 0.03 - static_cast<double>(p.x), dz = 0.12 - static_cast<double>(p.z), dy = 0.25 - 0.06;
        const double d2 = dx * dx + dy * dy + dz * dz;
        CHECK(e[f.particles.id[i]] ==
              doctest::Approx(0.5 * 40 * (dy / std::sqrt(d2)) / (4 * kPi * d2) * 1e-4).epsilon(0.03).scale(0));
        ++checked;
    }
    CHECK(checked == 256);
    CHECK(sum(e) == doctest::Approx(f.heat.stats().absorbed).epsilon(1e-9).scale(0));
    // Linear in power, negative cools, switched off is off.
    HeatFixture g(0.01f);
    g.addBlock({0, 0, 0}, 20, 6, 20, room);
    g.sources = {lamp({0.03f, 0.25f, 0.12f}, -80)};
    g.build();
    CHECK(sum(absorbed(g, 0.5)) == doctest::Approx(-2 * sum(e)).epsilon(1e-6).scale(0));
    g.sources[0].enabled = false;
    CHECK(sum(absorbed(g, 0.5)) == 0);
}

TEST_CASE("heat: a ball takes what its solid angle catches, and nothing on its back") {
    for (float radius : {6.0f, 10.0f})
        for (float far : {1.6f, 3.0f}) {
            HeatFixture f(0.01f);
            const float R = radius * 0.01f;
            f.addBall({0, 0, 0}, R, 293.15f);
            const Vec3 way = normalizeOr({0.3f, 0.8f, -0.5f}, {});
            f.sources = {lamp(far * R * way, 30)};
            f.build();
            const std::vector<double> e = absorbed(f);
            const double sine = 1 / static_cast<double>(far);
            CAPTURE(radius);
            CAPTURE(far);
            CHECK(sum(e) == doctest::Approx(30 / 2.0 * (1 - std::sqrt(1 - sine * sine))).epsilon(0.05).scale(0));
            for (size_t i = 0; i < f.size(); ++i)
                if (dot(normalizeOr(f.particles.position[i].xyz(), {}), way) < -0.1f)
                    REQUIRE(e[f.particles.id[i]] == 0);
        }
}

TEST_CASE("heat: a ball cut out of a lattice is not shaded by its own steps") {
    for (float radius : {6.3f, 10.0f}) {
        HeatFixture f(0.01f);
        const int n = static_cast<int>(radius) + 2;
        for (int i = -n; i <= n; ++i)
            for (int j = -n; j <= n; ++j)
                for (int k = -n; k <= n; ++k) {
                    const Vec3 x{static_cast<float>(i) + 0.3f, static_cast<float>(j) + 0.1f,
                                 static_cast<float>(k) + 0.77f};
                    if (dot(x, x) < radius * radius) f.add(0.01f * x, 293.15f);
                }
        const float R = radius * 0.01f;
        f.sources = {lamp(3 * R * normalizeOr({0.3f, 0.8f, -0.5f}, {}), 30)};
        f.build();
        CAPTURE(radius);
        CHECK(sum(absorbed(f)) == doctest::Approx(15 * (1 - std::sqrt(1 - 1.0 / 9))).epsilon(0.05).scale(0));
    }
}

TEST_CASE("heat: a cube's lit face is not shaded by itself, its other faces get nothing") {
    HeatFixture f(0.01f);
    f.addBlock({0, 0, 0}, 14, 14, 14, room);
    f.sources = {lamp({0.07f, 0.4f, 0.07f}, 30)};
    f.build();
    const std::vector<double> e = absorbed(f);
    // View factor of a square of side a seen from height h above its middle, times the power.
    const double a = 0.14, h = 0.4 - 0.14;
    const double solid = 4 * std::asin(a * a / (a * a + 4 * h * h));
    CHECK(sum(e) == doctest::Approx(30 * solid / (4 * kPi)).epsilon(0.05).scale(0));
    for (size_t i = 0; i < f.size(); ++i)
        if (f.particles.position[i].y < 0.125f) REQUIRE(e[f.particles.id[i]] == 0);
}

TEST_CASE("heat: obstacles shade, half and fully") {
    const auto plate = [](HeatFixture& f) {
        f.addBlock({-0.1f, 0, -0.1f}, 20, 4, 20, room);
        f.sources = {lamp({0, 0.4f, 0}, 30)};
        f.build();
    };
    HeatFixture open(0.01f);
    plate(open);
    const std::vector<double> free = absorbed(open);
    CHECK(open.heat.stats().rays >= 400);

    CleanMesh mesh;
    const Vec3 lower{0, 0.19f, -0.5f}, upper{0.5f, 0.21f, 0.5f};
    for (int k = 0; k < 8; ++k)
        mesh.vertices.push_back({k & 1 ? upper.x : lower.x, k & 2 ? upper.y : lower.y, k & 4 ? upper.z : lower.z});
    mesh.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                    2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    Collider solidMesh;
    solidMesh.type = thawCollider_mesh, solidMesh.alive = true;
    solidMesh.mesh = std::make_shared<CleanMesh>(mesh);
    // Over x > 0 only: exactly one half of the plate is dark.
    for (const Collider& half : {box({0.25f, 0.2f, 0}, {0.25f, 0.01f, 0.5f}), solidMesh}) {
        HeatFixture f(0.01f);
        f.colliders = {half};
        plate(f);
        const std::vector<double> e = absorbed(f);
        CAPTURE(half.type);
        CHECK(sum(e) == doctest::Approx(0.5 * sum(free)).epsilon(0.01).scale(0));
        for (size_t i = 0; i < f.size(); ++i) {
            const uint32_t id = f.particles.id[i];
            if (f.particles.position[i].x > 0.001f)
                REQUIRE(e[id] == 0);
            else
                REQUIRE(e[id] == free[id]);
        }
        // An obstacle that is no occluder shades nothing, and is noticed by its version.
        f.colliders[0].occluder = false, ++f.colliderVersion;
        CHECK(sum(absorbed(f)) == doctest::Approx(sum(free)).epsilon(1e-6).scale(0));
    }
    Collider ball;
    ball.type = thawCollider_sphere, ball.alive = true, ball.transform.position = {0, 0.25f, 0}, ball.size.x = 0.13f;
    Collider ground; // between plate and lamp: the lamp is under ground
    ground.alive = true, ground.transform.position = {0, 0.5f, 0};
    for (const Collider& full :
         {ball, box({0, 0.2f, 0}, {0.3f, 0.01f, 0.3f}, {0, 0.3826834f, 0, 0.9238795f}), ground}) {
        HeatFixture f(0.01f);
        f.colliders = {full};
        plate(f);
        f.colliders.back().occluder = true;
        CHECK(sum(absorbed(f)) == 0);
    }
}

TEST_CASE("heat: one body shades another, and no more when it has gone") {
    HeatFixture f(0.01f);
    f.addBlock({-0.1f, 0, -0.1f}, 20, 4, 20, room);
    f.addBlock({-0.05f, 0.2f, -0.05f}, 10, 5, 10, room);
    f.sources = {lamp({0, 0.6f, 0}, 30)};
    f.build();
    const std::vector<double> e = absorbed(f);
    for (size_t i = 0; i < f.size(); ++i) {
        const Vec4 p = f.particles.position[i];
        const double reach = std::max(std::abs(p.x), std::abs(p.z)), umbra = 0.05 * (0.6 - 0.04) / (0.6 - 0.2);
        if (p.y < 0.03f || p.y > 0.1f) continue;
        if (reach < umbra - 0.01) REQUIRE(e[f.particles.id[i]] == 0);
        if (reach > umbra + 0.01 && reach < 0.08) REQUIRE(e[f.particles.id[i]] > 0);
    }
    for (size_t i = 0; i < f.size(); ++i)
        if (f.particles.position[i].y > 0.1f) f.particles.position[i].y += 3;
    f.refresh();
    const std::vector<double> later = absorbed(f);
    for (size_t i = 0; i < f.size(); ++i) {
        const Vec4 p = f.particles.position[i];
        if (p.y > 0.03f && p.y < 0.1f) REQUIRE(later[f.particles.id[i]] > 0);
    }
}

TEST_CASE("visibility: the same answers as trying every sphere, while spheres come, go and move") {
    Allocator allocator;
    Visibility v(allocator);
    uint32_t seed = 7;
    std::vector<Vec4> spheres;
    std::vector<uint32_t> ids;
    uint32_t nextId = 0;
    for (; nextId < 300; ++nextId) {
        const Vec3 x = inCube(seed);
        spheres.push_back({x.x, x.y, x.z, 0.06f}), ids.push_back(nextId);
    }
    int blockedTotal = 0, compared = 0;
    for (int round = 0; round < 80; ++round) {
        for (Vec4& s : spheres) s.setXyz(s.xyz() + 0.03f * inCube(seed));
        // Some sink, some come up, the order changes.
        for (int k = 0; k < 9; ++k) {
            const size_t i = scramble(seed) % spheres.size();
            spheres[i] = spheres.back(), ids[i] = ids.back();
            spheres.pop_back(), ids.pop_back();
        }
        for (int k = 0; k < 8 + round % 4; ++k) {
            const Vec3 x = inCube(seed);
            spheres.push_back({x.x, x.y, x.z, 0.05f}), ids.push_back(nextId++);
        }
        v.setSpheres(spheres.data(), ids.data(), static_cast<int>(spheres.size()));
        v.commit();
        for (int batch = 0; batch < 20; ++batch) {
            Ray rays[8];
            const int n = 1 + batch % 8;
            for (int k = 0; k < n; ++k) rays[k] = between(2 * inCube(seed), 2 * inCube(seed));
            bool blocked[8];
            v.cast(rays, n, blocked);
            for (int k = 0; k < n; ++k) {
                bool expected = false, close = false;
                for (const Vec4& s : spheres) {
                    const double ox = rays[k].surface.x - s.x, oy = rays[k].surface.y - s.y,
                                 oz = rays[k].surface.z - s.z;
                    const double b = ox * rays[k].direction.x + oy * rays[k].direction.y + oz * rays[k].direction.z;
                    const double disc = b * b - (ox * ox + oy * oy + oz * oz - s.w * s.w),
                                 t = -b - std::sqrt(std::max(0.0, disc));
                    close |= std::abs(disc) < 1e-5 || std::abs(t) < 1e-4 || std::abs(t - rays[k].distance) < 1e-4;
                    expected |= disc >= 0 && t > 0 && t < rays[k].distance;
                }
                if (close) continue;
                REQUIRE(blocked[k] == expected);
                ++compared, blockedTotal += expected;
            }
        }
    }
    CHECK(compared > 5000);
    CHECK(blockedTotal > compared / 10);
    CHECK(v.meltBuilds() == 80);
    // Nothing moved: nothing is done.
    v.setSpheres(spheres.data(), ids.data(), static_cast<int>(spheres.size()));
    v.commit();
    CHECK(v.meltBuilds() == 80);
    // The neighbourhood of the ray's beginning shades nothing, what is behind it does.
    const Vec4 pair[2] = {{1, 0, 0, 0.2f}, {5, 0, 0, 0.2f}};
    const uint32_t names[2] = {1, 2};
    Ray near = between({0, 0, 0}, {3, 0, 0}), past = between({0, 0, 0}, {9, 0, 0});
    for (float skip : {0.0f, 1.0f}) {
        v.setSpheres(pair, names, 2);
        v.commit();
        near.skip = past.skip = skip;
        bool nearBlocked = false, pastBlocked = false;
        v.cast(&near, 1, &nearBlocked), v.cast(&past, 1, &pastBlocked);
        CHECK(nearBlocked == (skip == 0));
        CHECK(pastBlocked);
    }
    v.setSpheres(nullptr, nullptr, 0);
    v.commit();
    Ray ray = between({-3, -3, -3}, {3, 3, 3});
    bool blocked = true;
    v.cast(&ray, 1, &blocked);
    CHECK_FALSE(blocked);
}

TEST_CASE("visibility: leaves the host's TBB and floating point mode alone") {
    const size_t allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    const int concurrency = tbb::this_task_arena::max_concurrency();
    const size_t later = allowed + 3;
    {
        // More than the machine has, so that a cap would be seen on any machine.
        tbb::global_control host(tbb::global_control::max_allowed_parallelism, later);
        HeatFixture f(0.01f);
        f.addBall({0, 0, 0}, 0.06f, 293.15f);
        f.colliders = {box({0, 1, 0}, {0.1f, 0.1f, 0.1f})};
        f.sources = {lamp({0.2f, 0, 0}, 30)};
        f.build();
#if defined(__SSE2__)
        const unsigned mode = _mm_getcsr() & 0xffc0u;
#endif
        CHECK(sum(absorbed(f)) > 0);
#if defined(__SSE2__)
        CHECK((_mm_getcsr() & 0xffc0u) == mode);
#endif
        CHECK(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism) == later);
        CHECK(tbb::this_task_arena::max_concurrency() == concurrency);
    }
    CHECK(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism) == allowed);
}

TEST_CASE("heat: forty lamps, more than are remembered") {
    HeatFixture one(0.01f), many(0.01f);
    for (HeatFixture* f : {&one, &many}) {
        f->addBlock({-0.1f, 0, -0.1f}, 20, 4, 20, room);
        f->colliders = {box({0.25f, 0.2f, 0}, {0.25f, 0.01f, 0.5f})};
        f->rayRefresh = 0.2f;
    }
    one.sources = {lamp({0, 0.4f, 0}, 40)};
    for (int k = 0; k < 40; ++k) many.sources.push_back(lamp({0, 0.4f, 0}, 1));
    one.build(), many.build();
    for (int step = 0; step < 4; ++step) {
        const double a = sum(absorbed(one)), b = sum(absorbed(many));
        CHECK(a > 0);
        CHECK(b == doctest::Approx(a).epsilon(1e-5).scale(0));
    }
}

TEST_CASE("heat: part of the rays each step, all within the round") {
    const auto make = [](HeatFixture& f) {
        f.addBlock({-0.1f, 0, -0.1f}, 20, 4, 20, room);
        f.colliders = {box({0.25f, 0.2f, 0}, {0.25f, 0.01f, 0.5f})};
        f.sources = {lamp({0, 0.4f, 0}, 30), lamp({0.05f, 0.5f, 0.1f}, -5)};
        f.build(5);
    };
    HeatFixture full(0.01f), part(0.01f);
    make(full), make(part);
    part.rayRefresh = 0.1f;
    // The first step knows nothing and casts all.
    absorbed(full), absorbed(part);
    const int all = full.heat.stats().rays;
    CHECK(part.heat.stats().rays == all);
    CHECK_FALSE(part.heat.stats().raysReduced);
    // Nothing changes: what is remembered is what would be seen, also with a source that moves in sight of the same.
    for (int step = 0; step < 12; ++step) {
        for (HeatFixture* f : {&full, &part}) f->sources[0].position.y += 0.001f;
        const double a = sum(absorbed(full)), b = sum(absorbed(part));
        CHECK(b == doctest::Approx(a).epsilon(1e-6).scale(0));
        CHECK(part.heat.stats().rays < all / 6);
        CHECK(part.heat.stats().rays > all / 20);
        CHECK(part.heat.stats().raysReduced);
    }
    // The obstacle goes: within the round everything is lit.
    for (HeatFixture* f : {&full, &part}) f->colliders[0].alive = false, ++f->colliderVersion;
    const double lit = sum(absorbed(full)), first = sum(absorbed(part));
    CHECK(first < 0.7 * lit);
    for (int step = 0; step < 12; ++step) absorbed(part);
    CHECK(sum(absorbed(part)) == doctest::Approx(lit).epsilon(1e-5).scale(0));
    // What was inside comes to light: its new surface is seen at once.
    std::vector<bool> fresh(part.size());
    for (HeatFixture* f : {&full, &part}) {
        f->convection = 0;
        for (size_t i = 0; i < f->size(); ++i)
            if (f->particles.position[i].x > 0) f->particles.position[i].x += 0.03f;
        f->refresh();
    }
    for (size_t i = 0; i < part.size(); ++i)
        fresh[part.particles.id[i]] = (part.particles.flags[i] & kSurface) && part.particles.rayAge[i] == 0;
    const std::vector<double> a = absorbed(full), b = absorbed(part);
    CHECK(part.heat.stats().raysReduced);
    int lights = 0;
    for (size_t id = 0; id < part.size(); ++id) {
        if (!fresh[id]) continue;
        lights += a[id] > 0;
        REQUIRE(b[id] == a[id]);
    }
    CHECK(lights > 20);
}
