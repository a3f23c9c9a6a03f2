// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "control/outline.h"
#include "control/fill_flow.h"
#include "control/region.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace thaw;

namespace {

// A star with a triangular hole.
struct Star {
    std::vector<Flat> points;
    std::vector<int32_t> sizes{10, 3};

    Star() {
        for (int k = 0; k < 10; ++k) {
            const float a = 0.62831853f * static_cast<float>(k), r = k % 2 ? 0.02f : 0.05f;
            points.push_back({r * std::sin(a), r * std::cos(a)});
        }
        points.push_back({0.01f, 0}), points.push_back({-0.005f, 0.008f}), points.push_back({-0.005f, -0.008f});
    }
    // By looking at every edge.
    float distance(float x, float y) const {
        float best = INFINITY;
        bool inside = false;
        for (size_t c = 0, first = 0; c < sizes.size(); first += static_cast<size_t>(sizes[c++]))
            for (size_t k = 0, n = static_cast<size_t>(sizes[c]); k < n; ++k) {
                const Flat a = points[first + k], b = points[first + (k + 1) % n];
                const float dx = b.x - a.x, dy = b.y - a.y;
                float t = ((x - a.x) * dx + (y - a.y) * dy) / (dx * dx + dy * dy);
                t = t < 0 ? 0 : t > 1 ? 1 : t;
                best = std::min(best, std::hypot(x - a.x - t * dx, y - a.y - t * dy));
                if ((a.y > y) != (b.y > y) && x < a.x + (y - a.y) / dy * dx) inside = !inside;
            }
        return inside ? -best : best;
    }
};

} // namespace

TEST_CASE("outline: distances are those to the nearest edge, negative inside an odd number of contours") {
    const Star star;
    DistanceGrid grid;
    const float area = outlineDistance(star.points, star.sizes.data(), 2, 0.0005f, 0.01f, size_t{1} << 20, grid);
    CHECK(area ==
          doctest::Approx(10 * 0.5 * 0.02 * 0.05 * std::sin(0.62831853) - 0.5 * 0.015 * 0.016).epsilon(0.002).scale(0));
    float worst = 0;
    for (int j = 0; j < grid.ny; ++j)
        for (int i = 0; i < grid.nx; ++i) {
            const float x = grid.origin.x + static_cast<float>(i) * grid.cell,
                        y = grid.origin.y + static_cast<float>(j) * grid.cell;
            worst = std::max(worst, std::abs(grid.values[static_cast<size_t>(j * grid.nx + i)] - star.distance(x, y)));
        }
    CHECK(worst < 1e-5f);
    Vec3 outward;
    CHECK(grid.sample({0, 0.046f, 0.5f * grid.cell}, outward) ==
          doctest::Approx(star.distance(0, 0.046f)).epsilon(0.1).scale(0));
    // With few nodes it is coarser, but as wide.
    outlineDistance(star.points, star.sizes.data(), 2, 0.0001f, 0.01f, 5000, grid);
    CHECK(grid.nx * grid.ny < 5400);
    CHECK(grid.cell * static_cast<float>(grid.nx - 1) > 0.11f);
}

TEST_CASE("region: contours lie on the plane that they fit, whichever way they run") {
    // A square and one in it, on a plane that leans, in both directions.
    const Vec3 u{0.8f, 0.6f, 0}, v{0, 0, 1}, at{1, 2, 3};
    std::vector<Vec3> points;
    for (const float size : {0.05f, -0.02f})
        for (const auto& [a, b] : {std::pair{-1.0f, -1.0f}, {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}})
            points.push_back(at + (size < 0 ? -size * b : size * a) * u + (size < 0 ? -size * a : size * b) * v);
    const int32_t sizes[2] = {4, 4};
    Region r;
    std::string message;
    REQUIRE(r.make(points.data(), sizes, 2, {}, {0, 1, 0}, 0.002f, message));
    CHECK(r.size() == doctest::Approx(0.1 * 0.1 - 0.04 * 0.04).epsilon(0.01).scale(0));
    CHECK(std::abs(r.normal().x + 0.6f) < 1e-4f);
    CHECK(std::abs(r.normal().y - 0.8f) < 1e-4f); // upward
    Vec3 outward;
    CHECK(r.distance(r.into(at + 0.035f * u + 0.01f * r.normal()), outward) ==
          doctest::Approx(-0.015).epsilon(0.02).scale(0));
    CHECK(r.distance(r.into(at), outward) == doctest::Approx(0.02).epsilon(0.02).scale(0));
    const Vec3 back = r.outOf(r.into({1.01f, 2.02f, 2.97f}));
    CHECK(length(back - Vec3{1.01f, 2.02f, 2.97f}) < 1e-5f);
    CHECK(r.distance(r.into(at + 0.06f * u), outward) == doctest::Approx(0.01).epsilon(0.02).scale(0));
    CHECK(dot(r.direction(outward), u) > 0.99f);
    // Where it is told, not where it fits.
    REQUIRE(r.make(points.data(), sizes, 2, {0, 3, 0}, {0, 1, 0}, 0.002f, message));
    CHECK(r.normal().y == doctest::Approx(1));
    CHECK(r.size() == doctest::Approx(0.8 * (0.1 * 0.1 - 0.04 * 0.04)).epsilon(0.01).scale(0));
}

TEST_CASE("fill flow: melt is led from where there is too much to where some is missing") {
    // A bar of 12 by 4 cm, all melt on its left quarter.
    std::vector<Vec3> points{{-0.06f, 0, -0.02f}, {0.06f, 0, -0.02f}, {0.06f, 0, 0.02f}, {-0.06f, 0, 0.02f}};
    const int32_t size = 4;
    Region r;
    std::string message;
    constexpr float kSpacing = 0.002f;
    REQUIRE(r.make(points.data(), &size, 1, {}, {0, 1, 0}, kSpacing, message));
    FillFlow flow;
    flow.make(r, 0.02f, kSpacing);
    const auto put = [&](double to, int rows) {
        flow.clear();
        for (double x = -0.059; x < to; x += 0.002)
            for (double z = -0.019; z < 0.02; z += 0.002)
                for (int k = 0; k < rows; ++k)
                    flow.addLiquid(r.into({static_cast<float>(x), 0, static_cast<float>(z)}),
                                   kSpacing * kSpacing * kSpacing);
    };
    for (int n = 0; n < 40; ++n) put(-0.03, 8), flow.solve({}, 0, kSpacing);
    CHECK(flow.level() == doctest::Approx(2 * kSpacing).epsilon(0.05).scale(0));
    CHECK(flow.fill() == doctest::Approx(0.25).epsilon(0.15).scale(0));
    const Vec3 way = r.direction(flow.velocity(r.into({-0.032f, 0, 0})));
    CHECK(way.x > 0.01f);
    CHECK(std::abs(way.z) < 0.1f * way.x);
    CHECK_FALSE(flow.full());
    // Even, it is at rest.
    for (int n = 0; n < 40; ++n) put(0.06, 2), flow.solve({}, 0, kSpacing);
    CHECK(flow.fill() > 0.98f);
    CHECK(length(flow.velocity(r.into({0.01f, 0, 0}))) == 0);
    // As thick as it may be, it is full.
    flow.solve({}, 1.5f * kSpacing, kSpacing);
    CHECK(flow.full());
    CHECK_FALSE(flow.open());
    // Behind a wall across the bar nothing is led to.
    for (size_t k = 0; k < flow.cells(); ++k) flow.block(k, std::abs(r.outOf(flow.middleOf(k)).x) < 0.006f);
    for (int n = 0; n < 200; ++n) put(-0.03, 4), flow.solve({}, 0, kSpacing);
    CHECK(r.direction(flow.velocity(r.into({-0.032f, 0, 0}))).x > 0.01f);
    CHECK(length(flow.velocity(r.into({0.04f, 0, 0}))) < 0.05f * length(flow.velocity(r.into({-0.032f, 0, 0}))));
}
