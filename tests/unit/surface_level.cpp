// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world/surface_level.h"

#include <doctest/doctest.h>

using namespace thaw;

namespace {

// A mesh that takes so long at level 0, and 0.62 times as long at each level more.
int made(SurfaceLevel& level, float milliseconds, float limit, int finest = 0, int coarsest = 3) {
    const int l = level.choose(limit, finest, coarsest);
    float ms = milliseconds;
    for (int k = 0; k < l; ++k) ms *= 0.62f;
    level.learn({l, ms, 100, 5000});
    return l;
}

} // namespace

TEST_CASE("surface level: coarser at once, finer after a while, and bounds") {
    SurfaceLevel level(SurfaceLevel::Prices::learnt);
    for (int k = 0; k < 10; ++k) CHECK(made(level, 3, 0) == 0); // no limit
    int l = 0;
    for (int k = 0; k < 4; ++k) l = made(level, 3, 2);
    CHECK(l == 1);
    for (int k = 0; k < 4; ++k) l = made(level, 3, 0.8f);
    CHECK(l == 3);
    for (int k = 0; k < 400; ++k) CHECK(made(level, 3, 0.8f) == 3); // it does not swing
    int frames = 0;
    while (made(level, 0.5f, 0.8f) > 0 && frames < 2000) ++frames;
    CHECK(frames > 180); // a second for each level
    CHECK(frames < 600);
    CHECK(made(level, 0.5f, 0.8f, 1) == 1);
    for (int k = 0; k < 10; ++k) l = made(level, 50, 0.8f, 0, 2);
    CHECK(l == 2);
    CHECK(made(level, 50, 0.8f, 3, 2) == 3); // thawBudget.most goes before least
    CHECK(made(level, 1, 0, 2, 1) == 2);
}

TEST_CASE("surface level: one mesh that was interrupted changes nothing") {
    SurfaceLevel level(SurfaceLevel::Prices::learnt);
    for (int k = 0; k < 10; ++k) made(level, 1, 2);
    made(level, 30, 2);
    for (int k = 0; k < 10; ++k) CHECK(made(level, 1, 2) == 0);
}

TEST_CASE("surface level: by fixed prices a clock does not count") {
    SurfaceLevel a(SurfaceLevel::Prices::fixed), b(SurfaceLevel::Prices::fixed);
    for (int k = 0; k < 200; ++k) {
        const int l = a.choose(1, 0, 3);
        CHECK(b.choose(1, 0, 3) == l);
        a.learn({l, 0.001f, 100 + k, 5000}), b.learn({l, 900, 100 + k, 5000});
    }
    CHECK(a.choose(1, 0, 3) > 0);
}
