// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "view/legend.h"
#include "view/regions.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace thaw;
using namespace thaw::view;

namespace {
const Region* find(const std::vector<Region>& regions, RegionKind kind) {
    for (const Region& r : regions)
        if (r.kind == kind) return &r;
    return nullptr;
}
template <class F> void forVertices(const TriangleMesh& mesh, F&& f) {
    for (size_t i = 0; i + 2 < mesh.positions.size(); i += 3)
        f(Vec3{mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]});
}
// Two squares, one in the other, in the plane y = 0.2.
constexpr thawVec3 kSquares[] = {{-1, 0.2f, -1},       {1, 0.2f, -1},       {1, 0.2f, 1},       {-1, 0.2f, 1},
                                 {-0.5f, 0.2f, -0.5f}, {0.5f, 0.2f, -0.5f}, {0.5f, 0.2f, 0.5f}, {-0.5f, 0.2f, 0.5f}};
constexpr int32_t kSizes[] = {4, 4};
} // namespace

TEST_CASE("a path is a tube of its radius, through its points, with arrows along it") {
    const Vec3 points[] = {{0, 0, 0}, {0, 0, 0}, {0.1f, 0.02f, 0}, {0.2f, -0.03f, 0.05f}, {0.32f, 0, 0}};
    thawPathDef def;
    thawInitPathDef(&def);
    def.points = points, def.pointCount = 5, def.radius = 0.01f;
    for (const bool smooth : {false, true}) {
        def.smooth = smooth;
        const std::vector<Region> regions = pathRegions(def);
        const Region *tube = find(regions, RegionKind::path), *arrows = find(regions, RegionKind::direction);
        REQUIRE(tube);
        REQUIRE(arrows);
        // Its surface keeps the radius from the line: no point of the path is nearer, each has a ring at it.
        for (const Vec3& p : points) {
            float nearest = INFINITY;
            forVertices(*tube->mesh, [&](Vec3 q) { nearest = std::fmin(nearest, length(q - p)); });
            CHECK(std::fabs(nearest - 0.01f) < 2e-4f);
        }
        CHECK(tube->mesh->positions.size() > (smooth ? 3u : 1u) * 24 * 3 * 4);
        // Triangles turn outward.
        int against = 0;
        const TriangleMesh& m = *tube->mesh;
        for (size_t t = 0; t < m.indices.size(); t += 3) {
            const auto at = [&](const std::vector<float>& v, size_t k) {
                const size_t i = size_t(m.indices[t + k]) * 3;
                return Vec3{v[i], v[i + 1], v[i + 2]};
            };
            const Vec3 n = cross(at(m.positions, 1) - at(m.positions, 0), at(m.positions, 2) - at(m.positions, 0));
            if (dot(n, at(m.normals, 0)) <= 0) ++against;
        }
        CHECK(against == 0);
        Bounds bounds = arrows->mesh->bounds();
        CHECK(bounds.upper.x <= 0.33f);
        CHECK(bounds.lower.x >= -0.01f);
    }
    // Evenly spaced points on a straight line leave it evenly divided.
    const Vec3 even[] = {{0, 0, 0}, {0.12f, 0, 0}, {0.24f, 0, 0}, {0.36f, 0, 0}};
    def.points = even, def.pointCount = 4, def.smooth = true;
    const std::vector<Region> straight = pathRegions(def);
    int ring = 0;
    forVertices(*straight[0].mesh, [&](Vec3 p) { CHECK(std::fabs(p.x - 0.01f * float(ring++ / 25)) < 1e-5f); });
    CHECK(ring == 25 * 37);
    def.points = points, def.pointCount = 5;
    // Of a bent one each twelfth ring is about a point (the first two points are one).
    const std::vector<Region> bent = pathRegions(def);
    for (size_t k = 0; k < 4; ++k) {
        Vec3 mean{0, 0, 0};
        for (size_t i = 0; i < 24; ++i) {
            const float* p = &bent[0].mesh->positions[(k * 12 * 25 + i) * 3];
            mean = mean + Vec3{p[0], p[1], p[2]} * (1.0f / 24);
        }
        CHECK(length(mean - points[k + 1]) < 1e-5f);
    }
    // With its collider it turns and goes along.
    const thawQuat quarter{0, 0, std::sqrt(0.5f), std::sqrt(0.5f)};
    const Bounds moved = find(pathRegions(def, {5, 0, 0}, quarter), RegionKind::path)->mesh->bounds();
    CHECK(moved.upper.y == doctest::Approx(0.32).epsilon(0.05));
    CHECK(moved.center().x == doctest::Approx(5).epsilon(0.02));
    def.pointCount = 2; // the same place twice
    CHECK(pathRegions(def).empty());
}

TEST_CASE("a shape's reach runs round it at its distance, and a hole has one where it is wide enough") {
    thawShapeDef def;
    thawInitShapeDef(&def);
    def.points = kSquares, def.contourSizes = kSizes, def.contourCount = 2, def.reach = 0.2f;
    const std::vector<Region> regions = shapeRegions(def);
    const Region *contour = find(regions, RegionKind::contour), *reach = find(regions, RegionKind::reach);
    REQUIRE(contour);
    REQUIRE(reach);
    CHECK(contour->mesh->bounds().center().y == doctest::Approx(0.2));
    int inner = 0, off = 0;
    forVertices(*reach->mesh, [&](Vec3 p) {
        const float x = std::fabs(p.x), z = std::fabs(p.z),
                    outside = std::hypot(std::fmax(x - 1, 0.0f), std::fmax(z - 1, 0.0f));
        const float hole = 0.5f - std::fmax(x, z);
        if (hole > 0) ++inner;
        if (std::fabs((hole > 0 ? hole : outside) - 0.2f) > 0.045f) ++off;
    });
    CHECK(inner > 0);
    CHECK(off == 0);
    // By itself it is half of its size.
    def.reach = 0;
    CHECK(find(shapeRegions(def), RegionKind::reach)->mesh->bounds().upper.x == doctest::Approx(2).epsilon(0.03));
    def.reach = 0.55f; // the whole hole is in it
    inner = 0;
    forVertices(*find(shapeRegions(def), RegionKind::reach)->mesh,
                [&](Vec3 p) { inner += std::fmax(std::fabs(p.x), std::fabs(p.z)) < 0.5f ? 1 : 0; });
    CHECK(inner == 0);
}

TEST_CASE("a target is its mesh where it stands, and the key names each kind once") {
    const TriangleMesh box = makeBox({0.1f, 0.2f, 0.3f});
    thawShapeDef def;
    thawInitShapeDef(&def);
    def.mesh = {box.positions.data(), box.positions.size() / 3, box.indices.data(), box.indices.size() / 3};
    def.position = {0, 1, 0}, def.scale = 2;
    std::vector<Region> regions = shapeRegions(def, {3, 0, 0});
    REQUIRE(regions.size() == 1);
    CHECK(regions[0].kind == RegionKind::target);
    const Bounds b = regions[0].mesh->bounds();
    CHECK(b.lower.x == doctest::Approx(2.8));
    CHECK(b.upper.y == doctest::Approx(1.4));
    const int one = regionLegend(regions, 1).height;
    regions.push_back(regions[0]);
    CHECK(regionLegend(regions, 1).height == one);
    regions.back().kind = RegionKind::contour;
    CHECK(regionLegend(regions, 1).height > one);
}
