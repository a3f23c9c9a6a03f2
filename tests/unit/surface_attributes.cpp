// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/mixtures.h"
#include "surface_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

using namespace thaw;

TEST_CASE("surface: temperature, liquid fraction and material follow the particles") {
    Mesher mesher;
    Wax wax;
    for (int z = -6; z < 6; ++z)
        for (int y = -6; y < 6; ++y)
            for (int x = -10; x < 10; ++x) {
                Vec3 p = wax.spacing * Vec3{float(x) + 0.5f, float(y) + 0.5f, float(z) + 0.5f};
                bool hot = x >= 0;
                wax.add(p, wax.spacing, hot ? 350.0f : 290.0f, hot ? 0.9f : 0.1f, hot ? 7 : 2);
            }
    for (float cell : {0.5f, 0.75f, 2.0f}) {
        Surface& s = mesher(wax, cell);
        REQUIRE(s.positions.size() > 100);
        CHECK(s.temperatures.size() == s.positions.size());
        CHECK(s.liquidFractions.size() == s.positions.size());
        CHECK(s.materials.size() == s.positions.size());
        float widest = 3 + 2 * cell; // spacings that the kernel and the cell blur
        int left = 0, right = 0, between = 0;
        for (size_t v = 0; v < s.positions.size(); ++v) {
            float x = s.positions[v].x / wax.spacing, t = s.temperatures[v], l = s.liquidFractions[v];
            CHECK(t > 290 - 0.01f);
            CHECK(t < 350 + 0.01f);
            CHECK(l > 0.1f - 1e-4f);
            CHECK(l < 0.9f + 1e-4f);
            if (x < -widest) {
                ++left;
                CHECK(t < 290.01f);
                CHECK(l < 0.1001f);
            } else if (x > widest) {
                ++right;
                CHECK(t > 349.99f);
                CHECK(l > 0.8999f);
            } else if (std::fabs(x) < 0.3f) {
                ++between;
                CHECK(t > 300);
                CHECK(t < 340);
            }
            if (std::fabs(x) > 0.3f * (1 + cell))
                CHECK(s.materials[v] == (x > 0 ? 7 : 2)); // smoothing moves vertices a little
        }
        CHECK(left > 20);
        CHECK(right > 20);
        if (cell < 1) CHECK(between > 10);
    }
}

TEST_CASE("surface: one hot particle colours its own drop only") {
    Mesher mesher;
    Wax wax;
    wax.add({0, 0, 0}, wax.spacing, 280, 0.25f, 1, 7);
    wax.add({0.02f, 0, 0}, wax.spacing, 400, 1, 3, 500);
    Surface& s = mesher(wax);
    REQUIRE(factsOf(s).components == 2);
    for (size_t v = 0; v < s.positions.size(); ++v) {
        bool hot = s.positions[v].x > 0.01f;
        CHECK(std::fabs(s.temperatures[v] - (hot ? 400 : 280)) < 1e-3f);
        CHECK(std::fabs(s.liquidFractions[v] - (hot ? 1.0f : 0.25f)) < 1e-5f);
        CHECK(s.liquidFractions[v] <= 1);
        CHECK(s.materials[v] == (hot ? 3 : 1));
        CHECK(s.bodies[v] == (hot ? 500 : 7));
        CHECK(s.mixtures[v].material[0] == (hot ? 3 : 1));
        CHECK(s.mixtures[v].share[0] == 255);
        CHECK(s.mixtures[v].share[1] == 0);
    }
}

TEST_CASE("surface: materials mix where they meet, and add up") {
    // A bar of three materials, the middle one a layer of one particle.
    Wax wax;
    for (int x = -6; x <= 6; ++x)
        for (int y = -3; y <= 3; ++y)
            for (int z = -3; z <= 3; ++z)
                wax.add(wax.spacing * Vec3{float(x), float(y), float(z)}, wax.spacing, 300, 0,
                        uint8_t(x < 0   ? 4
                                : x > 0 ? 200
                                        : 7));
    Mesher mesher;
    Surface& s = mesher(wax);
    int mixed = 0;
    for (size_t v = 0; v < s.positions.size(); ++v) {
        const Surface::Mixture& m = s.mixtures[v];
        int sum = 0;
        for (int k = 0; k < 4; ++k) {
            sum += m.share[k];
            if (k > 0) CHECK(m.share[k] <= m.share[k - 1]);
            if (m.share[k] == 0) CHECK(m.material[k] == 0);
        }
        CHECK(sum == 255);
        const float x = s.positions[v].x / wax.spacing;
        const auto share = [&](uint8_t material) {
            for (int k = 0; k < 4; ++k)
                if (m.share[k] && m.material[k] == material) return int(m.share[k]);
            return 0;
        };
        if (x < -2.5f) CHECK(share(4) == 255);
        if (x > 2.5f) CHECK(share(200) == 255);
        if (std::fabs(x) < 0.1f) {
            CHECK(share(7) > 80);
            CHECK(std::abs(share(4) - share(200)) < 60);
            ++mixed;
        }
    }
    CHECK(mixed > 20);
}

TEST_CASE("surface: of materials with the same shares the first has no less than the others") {
    const uint8_t materials[] = {3, 9, 1, 5};
    for (int kinds = 2; kinds <= 4; ++kinds) {
        Origins origins{};
        for (int k = 0; k < kinds; ++k) origins.row[k] = uint32_t(k), origins.share[k] = 1 / float(kinds);
        Surface::Mixture m;
        mixOf(origins, materials, m);
        int sum = m.share[0];
        for (int k = 1; k < 4; ++k) {
            sum += m.share[k];
            CHECK(m.share[k] <= m.share[k - 1]);
        }
        CHECK(sum == 255);
    }
}

TEST_CASE("surface: one particle of another material has no edge") {
    Wax wax;
    for (int x = -8; x <= 8; ++x)
        for (int y = -3; y <= 0; ++y)
            for (int z = -8; z <= 8; ++z)
                wax.add(wax.spacing * Vec3{float(x), float(y), float(z)}, wax.spacing, 300, 0,
                        x == 0 && y == 0 && z == 0 ? 9 : 2);
    Mesher mesher;
    Surface& s = mesher(wax);
    const auto share = [&](uint32_t v) {
        for (int k = 0; k < 4; ++k)
            if (s.mixtures[v].share[k] && s.mixtures[v].material[k] == 9) return int(s.mixtures[v].share[k]);
        return 0;
    };
    int most = 0, step = 0, touched = 0;
    for (size_t t = 0; t < s.indices.size(); ++t)
        step = std::max(step, std::abs(share(s.indices[t]) - share(s.indices[t % 3 == 2 ? t - 2 : t + 1])));
    for (uint32_t v = 0; v < s.positions.size(); ++v) {
        const Vec3 p = s.positions[v];
        most = std::max(most, share(v));
        touched += share(v) > 0;
        if (std::hypot(p.x, p.z) > 5 * wax.spacing) CHECK(share(v) == 0);
    }
    CHECK(most > 35); // it is seen
    CHECK(step < 50); // and fades
    CHECK(touched > 12);
}
