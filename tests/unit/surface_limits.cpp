// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface_bits.h"

#include <doctest/doctest.h>

using namespace thaw;

namespace {

// A disordered lump with strays and two materials.
Wax lump() {
    Wax wax;
    Dice dice;
    for (int z = -9; z < 9; ++z)
        for (int y = -9; y < 9; ++y)
            for (int x = -9; x < 9; ++x) {
                if (x * x + y * y + z * z > 80 && dice.roll() > 0.1f) continue;
                Vec3 p = Vec3{float(x), float(y), float(z)} + 0.4f * dice.direction();
                wax.add(wax.spacing * p, wax.spacing * (dice.roll() < 0.1f ? 1.26f : 1.0f), 280 + 40 * dice.roll(),
                        dice.roll(), uint8_t(x > y));
            }
    return wax;
}

} // namespace

TEST_CASE("surface: same bits on any number of workers") {
    Wax wax = lump();
    Mesher one(1);
    for (float cell : {0.4f, 0.75f}) {
        one(wax, cell);
        REQUIRE(one.surface.indices.size() > 3000);
        for (int workers : {2, 3, 4, 8}) {
            Mesher many(workers);
            CHECK(sameBits(many(wax, cell), one.surface));
        }
    }
}

TEST_CASE("surface: what was meshed before does not matter") {
    Wax wax = lump(), other;
    Dice dice;
    other.scatterBox(20, 20, 20, dice);
    Mesher fresh, used;
    fresh(wax);
    used(other, 0.5f);
    used(wax, 1.0f, 2);
    CHECK(sameBits(used(wax), fresh.surface));
}

TEST_CASE("surface: the second extraction allocates nothing") {
    Wax wax = lump();
    for (int workers : {1, 4}) {
        Mesher mesher(workers);
        mesher(wax);
        size_t calls = mesher.allocator.calls(), bytes = mesher.allocator.bytes();
        CHECK(calls > 0);
        for (int k = 0; k < 3; ++k) ++wax.temperatures[0], mesher(wax);
        CHECK(mesher.surface.made() == 4);
        CHECK(mesher.allocator.calls() == calls);
        CHECK(mesher.allocator.bytes() == bytes);
    }
}

TEST_CASE("surface: what has not changed is not made again, what has is") {
    Wax wax = lump();
    Mesher mesher;
    mesher(wax);
    CHECK(mesher.surface.made() == 1);
    const auto again = [&](float cell = 0.75f, int smoothing = 1) {
        const int before = mesher.surface.made();
        mesher(wax, cell, smoothing);
        Mesher fresh;
        CHECK(sameBits(mesher.surface, fresh(wax, cell, smoothing)));
        return mesher.surface.made() - before;
    };
    CHECK(again() == 0);
    const size_t last = wax.positions.size() - 1;
    wax.positions[last].y += 1e-7f;
    CHECK(again() == 1);
    wax.temperatures[last] += 1;
    CHECK(again() == 1);
    wax.liquidFractions[0] = 0.5f;
    CHECK(again() == 1);
    wax.materials[last] = 2;
    CHECK(again() == 1);
    wax.bodies[0] = 9;
    CHECK(again() == 1);
    CHECK(again(1) == 1);
    CHECK(again(1, 3) == 1);
    CHECK(again(1, 3) == 0);
    wax.add({1, 1, 1});
    CHECK(again(1, 3) == 1);
    wax.spacing *= 1.1f;
    CHECK(again(1, 3) == 1);
    wax = {};
    CHECK(again(1, 3) == 1);
    CHECK(again(1, 3) == 0);
}

TEST_CASE("surface: no particle, one, two, many in one place") {
    Mesher mesher;
    Wax wax;
    CHECK(mesher(wax).indices.empty());
    CHECK(mesher.surface.positions.empty());
    wax.add({0.5f, -0.25f, 0.125f});
    CHECK(factsOf(mesher(wax)).euler == 2);
    wax.add({0.5f, -0.25f, 0.125f});
    MeshFacts facts = factsOf(mesher(wax));
    CHECK(facts.euler == 2);
    CHECK(facts.badEdges == 0);
    for (int k = 0; k < 500; ++k) wax.add({0.5f, -0.25f, 0.125f});
    facts = factsOf(mesher(wax));
    CHECK(facts.euler == 2);
    CHECK(facts.badEdges == 0);
    for (const Vec3& p : mesher.surface.positions) CHECK(isFinite(p));
    CHECK(mesher(Wax{}).indices.empty()); // nothing is left of the last mesh
}

TEST_CASE("surface: particles far apart cost no more than near ones") {
    Mesher mesher;
    Wax wax;
    wax.spacing = 0.05f;
    for (float x : {-1e4f, 0.0f, 1e4f})
        for (float y : {-1e4f, 1e4f}) wax.add({x, y, -x});
    Surface& s = mesher(wax);
    MeshFacts facts = factsOf(s);
    CHECK(facts.badEdges == 0);
    CHECK(facts.components == 6);
    CHECK(facts.euler == 12);
    CHECK(mesher.allocator.bytes() < size_t(4) << 20);

    // Finer than float positions out there: the cell grows to what they can tell apart, and it still closes.
    Wax fine;
    fine.spacing = 1e-4f;
    for (float x : {-1e4f, 1e4f}) fine.add({x, 3, 4});
    CHECK(factsOf(mesher(fine, 0.25f)).badEdges == 0);
    CHECK(mesher.allocator.bytes() < size_t(8) << 20);
}

TEST_CASE("surface: a field too large for memory gets coarser cells") {
    Mesher mesher;
    Wax wax;
    wax.spacing = 1e-3f;
    wax.add({0, 0, 0}, 0.2f); // 200 spacings wide: 24 million blocks at the cell that is asked for
    Surface& s = mesher(wax, 0.25f);
    MeshFacts facts = factsOf(s);
    CHECK(facts.badEdges == 0);
    CHECK(facts.components == 1);
    CHECK(facts.euler == 2);
    CHECK(facts.volume / wax.volume > 0.5);
    CHECK(facts.volume / wax.volume < 1.3);
    CHECK(mesher.allocator.bytes() < size_t(2) << 30);
}
