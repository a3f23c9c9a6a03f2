// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "heat_fixture.h"

#include <doctest/doctest.h>

#include <initializer_list>

using namespace thaw;

namespace {

constexpr double kPi = 3.14159265358979323846;
float room(Vec3) { return 293.15f; }

double unit(HeatFixture& f) { return static_cast<double>(f.spacing) * f.spacing; }

// All lattice points of a lattice at `offset` (in spacings) within the ball.
void addCutBall(HeatFixture& f, double radius, Vec3 offset) {
    const int n = static_cast<int>(radius) + 2;
    for (int i = -n; i <= n; ++i)
        for (int j = -n; j <= n; ++j)
            for (int k = -n; k <= n; ++k) {
                const Vec3 x = Vec3{static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)} + offset;
                if (dot(x, x) < radius * radius) f.add(f.spacing * x, 293.15f);
            }
}

} // namespace

TEST_CASE("exposure: the areas of a cube add up") {
    for (int n : {10, 16, 24}) {
        HeatFixture f;
        f.addBlock({0, 0, 0}, n, n, n, room);
        f.build();
        CAPTURE(n);
        CHECK(f.area() / (6.0 * n * n * unit(f)) == doctest::Approx(1).epsilon(0.05).scale(0));
        CHECK(f.exposed == n * n * n - (n - 2) * (n - 2) * (n - 2));
        for (size_t i = 0; i < f.size(); ++i) {
            const Vec4 p = f.particles.position[i];
            const auto inner = [&](float x) { return x > f.spacing && x < static_cast<float>(n - 1) * f.spacing; };
            const bool inside = inner(p.x) && inner(p.y) && inner(p.z);
            const Vec4 s = f.particles.normal[i];
            REQUIRE(((f.particles.flags[i] & kSurface) != 0) == !inside);
            if (inside)
                REQUIRE((s.x == 0 && s.y == 0 && s.z == 0 && s.w == 0));
            else
                REQUIRE(length(s.xyz()) == doctest::Approx(1).epsilon(1e-5).scale(0));
        }
    }
}

TEST_CASE("exposure: the areas of a ball add up") {
    for (float radius : {5.0f, 8.0f, 12.0f}) {
        HeatFixture f;
        f.addBall({0, 0, 0}, radius * f.spacing, 293.15f);
        f.build();
        CAPTURE(radius);
        CHECK(f.area() / (4 * kPi * radius * radius * unit(f)) == doctest::Approx(1).epsilon(0.05).scale(0));
        // Outward, within the disorder of the shells.
        for (size_t i = 0; i < f.size(); ++i) {
            if (!(f.particles.flags[i] & kSurface)) continue;
            const Vec3 out = normalizeOr(f.particles.position[i].xyz(), {});
            if (length(f.particles.position[i].xyz()) > (radius - 1) * f.spacing)
                REQUIRE(dot(out, f.particles.normal[i].xyz()) > 0.95f);
        }
    }
}

TEST_CASE("exposure: the areas of a ball cut out of a lattice add up") {
    for (double radius : {5.2, 6.3, 8.1, 12.0})
        for (Vec3 offset : {Vec3{0.31f, 0.12f, 0.77f}, Vec3{0.9f, 0.45f, 0.2f}}) {
            HeatFixture f;
            addCutBall(f, radius, offset);
            f.build();
            CAPTURE(radius);
            CAPTURE(offset.x);
            // The ball of as many cells.
            const double r = std::cbrt(f.particles.count * 3 / (4 * kPi));
            CHECK(f.area() / (4 * kPi * r * r * unit(f)) == doctest::Approx(1).epsilon(0.05).scale(0));
        }
}

TEST_CASE("exposure: a block at any angle to its lattice") {
    HeatFixture f;
    const float c = std::cos(0.5f), s = std::sin(0.5f), half = 6 * f.spacing;
    for (int i = -16; i <= 16; ++i)
        for (int j = -16; j <= 16; ++j)
            for (int k = -16; k <= 16; ++k) {
                const float x = c * static_cast<float>(i) - s * static_cast<float>(j),
                            y = s * static_cast<float>(i) + c * static_cast<float>(j), z = static_cast<float>(k);
                const Vec3 p = f.spacing * Vec3{x, c * y - s * z, s * y + c * z};
                if (std::abs(p.x) < half && std::abs(p.y) < half && std::abs(p.z) < half) f.add(p, 293.15f);
            }
    f.build();
    const double side = std::cbrt(f.particles.count);
    CHECK(f.area() / (6 * side * side * unit(f)) == doctest::Approx(1).epsilon(0.05).scale(0));
}

TEST_CASE("exposure: drops, films and threads") {
    HeatFixture drop;
    drop.add({0, 0, 0}, 293.15f);
    drop.build();
    // The sphere of its volume.
    CHECK(drop.area() / unit(drop) == doctest::Approx(std::cbrt(36 * kPi)).epsilon(0.01).scale(0));
    CHECK(length(drop.particles.normal[0].xyz()) == 0);
    for (int layers : {1, 2}) {
        HeatFixture film;
        film.addBlock({0, 0, 0}, 30, 30, layers, room);
        film.build();
        CAPTURE(layers);
        CHECK(film.area() / (2 * 900 * unit(film)) == doctest::Approx(1).epsilon(0.15).scale(0));
        CHECK(film.exposed == 900 * layers);
    }
    HeatFixture thread;
    thread.addBlock({0, 0, 0}, 40, 1, 1, room);
    thread.build();
    CHECK(thread.area() / (40 * 2 * std::sqrt(kPi) * unit(thread)) == doctest::Approx(1).epsilon(0.15).scale(0));
}

TEST_CASE("exposure: a film of one layer has its area, however thick the layer is") {
    for (const float thickness : {0.55f, 0.8f, 1.0f, 1.2f}) {
        HeatFixture f;
        f.addBlock({0, 0, 0}, 30, 1, 30, room);
        f.build();
        for (size_t i = 0; i < f.size(); ++i) f.particles.velocity[i].w *= thickness;
        f.refresh();
        CAPTURE(thickness);
        const double rim = 4.0 * 30 * static_cast<double>(thickness);
        CHECK(f.area() / ((2.0 * 30 * 30 + rim) * unit(f)) == doctest::Approx(1).epsilon(0.08).scale(0));
        CHECK(f.exposed == 900);
    }
}

TEST_CASE("exposure: what rests on a floor is not exposed to it") {
    for (float height : {0.3f, 0.5f, 0.7f}) {
        HeatFixture f;
        Collider floor;
        floor.alive = true;
        f.colliders.push_back(floor);
        f.addBlock({0, (height - 0.5f) * f.spacing, 0}, 12, 8, 12, room);
        f.build();
        CAPTURE(height);
        CHECK(f.area() / ((144 + 4 * 96) * unit(f)) == doctest::Approx(1).epsilon(0.06).scale(0));
        for (size_t i = 0; i < f.size(); ++i) {
            const Vec4 p = f.particles.position[i];
            const auto inner = [&](float x) { return x > f.spacing && x < 11 * f.spacing; };
            if (p.y < f.spacing && inner(p.x) && inner(p.z)) REQUIRE_FALSE((f.particles.flags[i] & kSurface));
            // Along the foot only the side is bare.
            if (p.y < f.spacing && inner(p.x) != inner(p.z))
                REQUIRE(static_cast<double>(f.particles.normal[i].w) / unit(f) ==
                        doctest::Approx(1).epsilon(0.1).scale(0));
        }
    }
    // And is exposed again when it hangs above it.
    HeatFixture f;
    Collider floor;
    floor.alive = true;
    f.colliders.push_back(floor);
    f.addBlock({0, 1.2f * f.spacing, 0}, 12, 8, 12, room);
    f.build();
    CHECK(f.area() / ((2 * 144 + 4 * 96) * unit(f)) == doctest::Approx(1).epsilon(0.05).scale(0));
}

TEST_CASE("exposure: fixed or moving makes no difference") {
    HeatFixture a, b;
    a.addBlock({0, 0, 0}, 10, 10, 10, room);
    b.addBlock({0, 0, 0}, 10, 10, 10, room);
    a.build(0), b.build(3);
    CHECK(a.exposed == b.exposed);
    CHECK(a.area() == doctest::Approx(b.area()).epsilon(1e-6).scale(0));
}
