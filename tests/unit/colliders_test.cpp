// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "geometry_shapes.h"

#include "geometry/colliders.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace thaw;

namespace {

bool near(Vec3 a, Vec3 b, float tolerance = 1e-5f) { return length(a - b) < tolerance; }

DistanceGrid gridOf(const shapes::Mesh& mesh, float cell, float margin, size_t maxNodes, int workers = 1) {
    CleanMesh clean;
    std::string message;
    REQUIRE(cleanMesh(mesh.view(), {}, clean, message) == thawResult_ok);
    thawTaskSystem system{};
    system.workerCount = workers;
    Tasks tasks(system);
    return makeDistanceGrid(clean, cell, margin, maxNodes, tasks);
}

} // namespace

TEST_CASE("plane: solid below its local +y") {
    Collider c;
    c.transform.position = {1, 2, 3};
    Vec3 n;
    CHECK(c.distance({7, 5, -9}, n) == doctest::Approx(3));
    CHECK(near(n, {0, 1, 0}));
    CHECK(c.distance({0, 0, 0}, n) == doctest::Approx(-2));
    c.transform.rotation = {0, 0, -0.70710678f, 0.70710678f}; // +y turns to +x
    CHECK(c.distance({4, 0, 0}, n) == doctest::Approx(3));
    CHECK(near(n, {1, 0, 0}));
    CHECK(c.bounds().lower.x == -INFINITY);
    CHECK(c.bounds().upper.y == INFINITY);
}

TEST_CASE("box: exact inside, rounded outside, turned") {
    Collider c;
    c.type = thawCollider_box, c.size = {1, 2, 3};
    Vec3 n;
    CHECK(c.distance({0.5f, 0, 0}, n) == doctest::Approx(-0.5));
    CHECK(near(n, {1, 0, 0}));
    CHECK(c.distance({0, -1.9f, 0}, n) == doctest::Approx(-0.1));
    CHECK(near(n, {0, -1, 0}));
    CHECK(c.distance({4, 6, 3}, n) == doctest::Approx(5)); // 3-4-5 off the edge
    CHECK(near(n, {0.6f, 0.8f, 0}));
    CHECK(c.distance({-2, -3, -4}, n) == doctest::Approx(std::sqrt(3.0)));
    CHECK(near(n, {-0.57735f, -0.57735f, -0.57735f}));
    CHECK(c.distance({1, 0, 0}, n) == doctest::Approx(0));
    CHECK(near(n, {1, 0, 0}));
    c.transform.rotation = {0, 0, 0.38268343f, 0.92387953f}, c.transform.position = {5, 0, 0}; // 45 degrees about z
    float s = std::sqrt(0.5f);
    CHECK(c.distance({5 + 3 * s, 3 * s, 0}, n) == doctest::Approx(2)); // along its own +x
    CHECK(near(n, {s, s, 0}));
    Box b = c.bounds();
    CHECK(b.upper.x == doctest::Approx(5 + 3 * s));
    CHECK(b.lower.y == doctest::Approx(-3 * s));
    CHECK(b.upper.z == doctest::Approx(3));
}

TEST_CASE("sphere") {
    Collider c;
    c.type = thawCollider_sphere, c.size = {2, 0, 0}, c.transform.position = {1, 1, 1};
    Vec3 n;
    CHECK(c.distance({1, 6, 1}, n) == doctest::Approx(3));
    CHECK(near(n, {0, 1, 0}));
    CHECK(c.distance({1, 1, 1}, n) == doctest::Approx(-2));
    CHECK(length(n) == doctest::Approx(1));
    CHECK(near(c.bounds().lower, {-1, -1, -1}));
}

TEST_CASE("what is not finite is nowhere near, for every type") {
    shapes::Mesh mesh = shapes::icosphere(1, 2);
    for (int type = 0; type < 4; ++type) {
        Collider c;
        c.type = thawColliderType(type), c.size = {1, 1, 1};
        if (type == thawCollider_mesh) c.grid = std::make_shared<DistanceGrid>(gridOf(mesh, 0.2f, 0.3f, 10000));
        Vec3 n;
        for (Vec3 p : {Vec3{NAN, 0, 0}, {0, NAN, 0}, {0, 0, NAN}, {INFINITY, 0, 0}, {0, -INFINITY, 0}}) {
            CHECK(c.distance(p, n) == INFINITY);
            CHECK(near(n, {0, 1, 0}));
        }
        CHECK(c.distance({1e30f, 0, 0}, n) >= 0); // squares overflow there
        CHECK(isFinite(n));
    }
    Collider none;
    none.type = thawCollider_mesh;
    Vec3 n;
    CHECK(none.distance({0, 0, 0}, n) == INFINITY);
}

TEST_CASE("distance grid of a sphere, inside, outside and far away") {
    DistanceGrid grid = gridOf(shapes::icosphere(1, 5), 0.05f, 0.3f, 1000000);
    CHECK(grid.cell == doctest::Approx(0.05));
    double worst = 0, worstNormal = 0;
    uint32_t r = 3;
    auto random = [&] { return r = r * 1664525u + 1013904223u, 2.6f * (float(r >> 8) / 16777216.0f - 0.5f); };
    for (int i = 0; i < 20000; ++i) {
        Vec3 p{random(), random(), random()}, n;
        float l = length(p);
        if (l < 0.15f) continue; // the gradient turns within a cell there
        worst = std::max(worst, double(std::abs(grid.sample(p, n) - (l - 1))));
        worstNormal = std::max(worstNormal, double(length(n - (1 / l) * p)));
        CHECK(length(n) == doctest::Approx(1).epsilon(1e-4));
    }
    CHECK(worst < 0.01);
    CHECK(worstNormal < 0.2);
    Vec3 n;
    for (Vec3 p : {Vec3{30, 0, 0}, {0, -7, 4}, {500, 400, -300}}) {
        CHECK(grid.sample(p, n) == doctest::Approx(length(p) - 1).epsilon(0.01));
        CHECK(near(n, (1 / length(p)) * p, 0.05f));
    }
}

TEST_CASE("grid nodes are exact for a box, the node limit holds, workers do not matter") {
    shapes::Mesh mesh = shapes::box({2, 1, 3});
    DistanceGrid grid = gridOf(mesh, 0.1f, 0.35f, 1000000), three = gridOf(mesh, 0.1f, 0.35f, 1000000, 3);
    CHECK(grid.values == three.values);
    Collider box;
    box.type = thawCollider_box, box.size = {1, 0.5f, 1.5f};
    double worst = 0;
    for (int z = 0; z < grid.nz; ++z)
        for (int y = 0; y < grid.ny; ++y)
            for (int x = 0; x < grid.nx; ++x) {
                Vec3 p = grid.origin + Vec3{float(x) * grid.cell, float(y) * grid.cell, float(z) * grid.cell}, n;
                float v = grid.values[size_t(x) + size_t(grid.nx) * (size_t(y) + size_t(grid.ny) * size_t(z))];
                worst = std::max(worst, double(std::abs(v - box.distance(p, n))));
            }
    CHECK(worst < 1e-5);
    CHECK(grid.origin.x <= -1.35f + 1e-4f);
    DistanceGrid coarse = gridOf(mesh, 0.001f, 0.35f, 5000);
    CHECK(coarse.values.size() <= 5000);
    CHECK(coarse.values.size() > 3000);
    CHECK(coarse.cell > 0.05f);
}

TEST_CASE("a hole is closed in the distance grid") {
    shapes::Mesh mesh = shapes::box({2, 2, 2});
    mesh.indices.resize(mesh.indices.size() - 3); // half of the +x face
    DistanceGrid grid = gridOf(mesh, 0.1f, 0.4f, 1000000);
    CHECK(grid.sample({0, 0, 0}) < -0.7f);
    Vec3 n;
    // Above the middle of the hole the number 0.5 is passed near the missing face.
    float crossing = 0;
    for (float x = 0.2f; x < 1.35f; x += 0.01f)
        if (grid.sample({x, -0.35f, 0.35f}, n) > 0 && crossing == 0) crossing = x;
    for (float x = 0.2f; x < 1.35f; x += 0.01f)
        if (grid.sample({x, 0.35f, -0.35f}, n) > 0 && crossing == 0) crossing = x;
    CHECK(crossing > 0.7f);
    CHECK(crossing < 1.2f);
    float before = grid.sample({0.2f, 0, 0}), worst = 0;
    for (float y = -0.9f; y < 0.9f; y += 0.1f) // no jump where there is no triangle
        for (float x = 0.2f; x < 1.3f; x += 0.02f) {
            float d = grid.sample({x, y, -y}, n);
            if (x > 0.21f) worst = std::max(worst, std::abs(d - before));
            before = d;
        }
    CHECK(worst < 0.06f);
}

TEST_CASE("a collider that moves: way of its points, distance along the way, swept bounds") {
    Collider c;
    c.type = thawCollider_box, c.alive = true, c.size = {0.3f, 0.02f, 0.1f};
    c.transform = {{0.2f, 0.1f, -0.3f}, {0, 0, 0.38268343f, 0.92387953f}, 1};       // 45 degrees about z
    const Transform to{{0.25f, 0.15f, -0.3f}, {0, 0, 0.79335334f, 0.60876143f}, 1}; // 105
    c.moveTo(to, 0.5f);
    CHECK(c.moves);
    uint32_t r = 5;
    auto random = [&] { return r = r * 1664525u + 1013904223u, float(r >> 8) / 16777216.0f - 0.5f; };
    const Box swept = c.sweptBounds();
    for (int i = 0; i < 200; ++i) {
        const Vec3 local{random(), random(), random()}, x = c.transform.apply(local);
        CHECK(near(x + c.displacement(x), to.apply(local), 1e-6f));
        CHECK(near(c.velocityAt(x), 2 * c.displacement(x), 1e-6f));
        CHECK(length(c.displacement(x)) <= c.reachOfMotion({}, length(x)) + 1e-6f);
        // A point fixed to it keeps its distance, with the normal turned along.
        for (float share : {0.0f, 0.3f, 1.0f}) {
            const Transform now = c.at(share);
            Vec3 n, m;
            CHECK(c.distance(now.apply(local), n, share) == doctest::Approx(c.distance(x, m)).epsilon(1e-4));
            CHECK(near(rotate(conjugate(now.rotation), n), rotate(conjugate(c.transform.rotation), m), 1e-3f));
        }
    }
    CHECK(near(c.at(1).position, to.position, 1e-6f));
    for (float share : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f})
        for (int k = 0; k < 8; ++k) {
            const Vec3 corner = c.at(share).apply({k & 1 ? 0.3f : -0.3f, k & 2 ? 0.02f : -0.02f, k & 4 ? 0.1f : -0.1f});
            CHECK(corner.x >= swept.lower.x);
            CHECK(corner.y <= swept.upper.y);
            CHECK(corner.x <= swept.upper.x);
            CHECK(corner.y >= swept.lower.y);
        }
    // Turning to and fro a thousand times neither grows nor shrinks what goes along.
    Vec3 a{0.5f, 0.4f, 0.1f}, b{-0.1f, 0.2f, 0.3f};
    const float apart = length(a - b);
    for (int k = 0; k < 2000; ++k) {
        Transform next = c.transform;
        const float angle = 0.05f * float(k % 40 < 20 ? 1 : -1);
        const Quat q{0, std::sin(angle), 0, std::cos(angle)}, o = next.rotation;
        next.rotation = {q.w * o.x + q.y * o.z, q.w * o.y + q.y * o.w, q.w * o.z - q.y * o.x, q.w * o.w - q.y * o.y};
        c.moveTo(next, 0.1f);
        const Vec3 da = c.displacement(a), db = c.displacement(b);
        a += da, b += db, c.transform = c.next;
    }
    CHECK(length(a - b) == doctest::Approx(apart).epsilon(2e-5));
}
