// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>

using namespace thaw;

namespace {

struct Ratio {
    double least = 1e9, mean = 0, most = 0;
};

// Mesh volume over particle volume, over many positions and directions.
Ratio volumeRatio(Mesher& mesher, float cell, int rounds, const std::function<void(Wax&, Dice&)>& make) {
    Ratio ratio;
    Dice dice;
    for (int k = 0; k < rounds; ++k) {
        Wax wax;
        make(wax, dice);
        double r = factsOf(mesher(wax, cell)).volume / wax.volume;
        ratio.least = std::min(ratio.least, r), ratio.most = std::max(ratio.most, r), ratio.mean += r / rounds;
    }
    return ratio;
}

void beads(Wax& wax, Dice& dice, int count) { // count particles in a row, any direction
    Vec3 at{0.1f * dice.roll(), 0.1f * dice.roll(), 0.1f * dice.roll()}, along = wax.spacing * dice.direction();
    for (int k = 0; k < count; ++k) wax.add(at + float(k) * along);
}

void tetrahedron(Wax& wax, Dice& dice) {
    Vec3 at{0.1f * dice.roll(), 0.1f * dice.roll(), 0.1f * dice.roll()};
    float e = wax.spacing / std::sqrt(2.0f);
    for (Vec3 corner : {Vec3{0, 0, 0}, Vec3{e, e, 0}, Vec3{e, 0, e}, Vec3{0, e, e}}) wax.add(at + corner);
}

} // namespace

TEST_CASE("surface: filled boxes and balls keep their volume") {
    Mesher mesher;
    for (float cell : {0.5f, 0.75f, 1.0f}) {
        Ratio box = volumeRatio(mesher, cell, 6, [](Wax& w, Dice& d) { w.scatterBox(14, 12, 16, d); });
        Ratio ball = volumeRatio(mesher, cell, 6, [](Wax& w, Dice& d) {
            Vec3 shift{d.roll(), d.roll(), d.roll()};
            w.fill(10, shift, [](Vec3 p) { return dot(p, p) < 9 * 9; });
        });
        MESSAGE("cell " << cell << ": box " << box.least << ".." << box.most << ", ball " << ball.least << ".."
                        << ball.most);
        CHECK(box.least > 0.97);
        CHECK(box.most < 1.03);
        CHECK(ball.least > 0.97);
        CHECK(ball.most < 1.03);
    }
    // However often it is smoothed.
    Wax wax;
    wax.fill(10, {0.4f, 0.2f, 0.1f}, [](Vec3 p) { return dot(p, p) < 9 * 9; });
    for (int smoothing : {0, 1, 3, 8}) {
        double ratio = factsOf(mesher(wax, 0.75f, smoothing)).volume / wax.volume;
        CHECK(ratio > 0.97);
        CHECK(ratio < 1.03);
    }
}

TEST_CASE("surface: small drops stay visible and keep about their volume") {
    Mesher mesher;
    for (float cell : {0.25f, 0.5f, 0.75f, 1.0f}) {
        int rounds = 100;
        Ratio one = volumeRatio(mesher, cell, rounds, [](Wax& w, Dice& d) { beads(w, d, 1); });
        Ratio two = volumeRatio(mesher, cell, rounds, [](Wax& w, Dice& d) { beads(w, d, 2); });
        Ratio four = volumeRatio(mesher, cell, rounds, tetrahedron);
        Ratio eight = volumeRatio(mesher, cell, rounds, [](Wax& w, Dice& d) { w.scatterBox(2, 2, 2, d); });
        Ratio thread = volumeRatio(mesher, cell, 20, [](Wax& w, Dice& d) { beads(w, d, 30); });
        Ratio sheet = volumeRatio(mesher, cell, 10, [](Wax& w, Dice& d) { w.scatterBox(20, 1, 20, d); });
        MESSAGE("cell " << cell << ": one " << one.mean << " (" << one.least << ".." << one.most << "), two "
                        << two.mean << ", four " << four.mean << ", eight " << eight.mean << ", thread " << thread.mean
                        << ", sheet " << sheet.mean);
        CHECK(one.least > 0.5);
        CHECK(one.most < 1.3);
        CHECK(two.least > 0.5);
        CHECK(two.most < 1.3);
        CHECK(four.least > 0.15);
        CHECK(four.mean > (cell < 0.9f ? 0.55 : 0.35));
        CHECK(four.most < 1.3);
        CHECK(thread.mean > 0.8);
        CHECK(thread.most < 1.3);
        CHECK(sheet.mean > 0.9);
        CHECK(sheet.mean < 1.3);
    }
}

TEST_CASE("surface: coarse particles alone are coarse beads") {
    Mesher mesher;
    Ratio one = volumeRatio(mesher, 0.75f, 100, [](Wax& w, Dice& d) {
        w.add({0.1f * d.roll(), 0.1f * d.roll(), 0.1f * d.roll()}, 2 * w.spacing);
    });
    CHECK(one.least > 0.5);
    CHECK(one.most < 1.3);
}
