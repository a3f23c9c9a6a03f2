// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/ranges.h"
#include "surface_bits.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace thaw;

namespace {

void take(Wax& wax, size_t i) { // as a world does: the last row comes to its place
    const size_t last = wax.positions.size() - 1;
    wax.positions[i] = wax.positions[last], wax.temperatures[i] = wax.temperatures[last];
    wax.liquidFractions[i] = wax.liquidFractions[last], wax.materials[i] = wax.materials[last];
    wax.bodies[i] = wax.bodies[last];
    wax.positions.pop_back(), wax.temperatures.pop_back(), wax.liquidFractions.pop_back();
    wax.materials.pop_back(), wax.bodies.pop_back();
}

Wax slab(Dice& dice) {
    Wax wax;
    for (int z = 0; z < 40; ++z)
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 40; ++x)
                wax.add(wax.spacing * (Vec3{float(x), float(y), float(z)} + 0.2f * dice.direction()), wax.spacing,
                        280 + 40 * dice.roll(), dice.roll(), uint8_t(x / 9), uint16_t(z / 20));
    return wax;
}

} // namespace

TEST_CASE("surface: what is meshed again in part has the bits of what is meshed anew") {
    Dice dice;
    Wax wax = slab(dice);
    Mesher kept(3);
    kept(wax);
    int64_t blocks = kept.surface.meshedBlocks();
    const int64_t all = blocks;
    int parts = 0;
    for (int round = 0; round < 40; ++round) {
        // A corner flows; now and then some leave, come, melt together, fly off, or are of another material.
        for (size_t i = 0; i < wax.positions.size(); ++i) {
            Vec4& p = wax.positions[i];
            if (p.x + p.z < 0.02f + 0.0002f * float(round)) p.setXyz(p.xyz() + 0.1f * wax.spacing * dice.direction());
        }
        if (round % 3 == 0)
            for (int k = 0; k < 5; ++k) take(wax, size_t(dice.roll() * float(wax.positions.size())));
        if (round % 4 == 3)
            for (int k = 0; k < 3; ++k) take(wax, wax.positions.size() - 1);
        if (round % 4 == 1)
            for (int k = 0; k < 5; ++k)
                wax.add(Vec3{0.08f * dice.roll(), 0.02f + 0.01f * dice.roll(), 0.08f * dice.roll()},
                        wax.spacing * (1 + 0.5f * dice.roll()), 350, 1, 5);
        if (round % 5 == 2) wax.positions[100].y += 0.03f;
        if (round % 7 == 3) wax.materials[200] ^= 3, wax.bodies[300] ^= 1;
        if (round % 6 == 4) std::swap(wax.positions[7], wax.positions[4000]);
        for (float& t : wax.temperatures) t += 0.01f;
        kept(wax);
        Mesher fresh;
        fresh(wax);
        CAPTURE(round);
        REQUIRE(sameBits(kept.surface, fresh.surface));
        const MeshFacts facts = factsOf(kept.surface);
        CHECK(facts.badEdges == 0);
        CHECK(facts.badVertices == 0);
        parts += kept.surface.meshedBlocks() - blocks < all / 2;
        blocks = kept.surface.meshedBlocks();
    }
    CHECK(parts >= 30); // it was not all meshed anew
}

TEST_CASE("surface: a change meshes the blocks around it, warmth alone none") {
    Dice dice;
    Wax wax = slab(dice);
    Mesher mesher;
    mesher(wax);
    const int64_t all = mesher.surface.meshedBlocks();
    for (float& t : wax.temperatures) t += 1;
    mesher(wax);
    CHECK(mesher.surface.meshedBlocks() == all);
    CHECK(mesher.surface.made() == 2);
    wax.positions[0].x += 1e-6f; // a corner
    mesher(wax);
    CHECK(mesher.surface.meshedBlocks() > all);
    CHECK(mesher.surface.meshedBlocks() <= all + 8);
}

TEST_CASE("surface: a particle beside a vertex that takes nothing from its block leaves no trace") {
    Wax wax;
    constexpr float kCell = 1.5f;
    const float cell = kCell * wax.spacing;
    // So many in one place that the surface is outside of all kernels; and one that is nearer, next door.
    for (int k = 0; k < 200; ++k) wax.add(cell * Vec3{0.01f, 2.96f, 4.01f}, wax.spacing, 300);
    wax.add(cell * Vec3{-1.33f, 4.746f, 4}, wax.spacing, 900, 0, 7, 7);
    Mesher kept, fresh;
    REQUIRE(kept(wax, kCell, 0).positions.size() > 20);
    take(wax, 200);
    kept(wax, kCell, 0);
    for (float t : kept.surface.temperatures) CHECK(t == doctest::Approx(300));
    CHECK(sameBits(kept.surface, fresh(wax, kCell, 0)));
}

TEST_CASE(
    "surface: the particle nearest to a vertex outside of all kernels does not depend on what was meshed before") {
    Wax wax;
    constexpr float kCell = 1.5f;
    const float cell = kCell * wax.spacing;
    // A crowd whose surface is clear of its kernels, one that is nearer to it but reaches less far than from there, and
    // a large one that comes and goes.
    for (int k = 0; k < 200; ++k) wax.add(cell * Vec3{2.01f, 4.01f, 4.01f}, wax.spacing, 300);
    wax.add(cell * Vec3{5.4f, 4.01f, 4.01f}, wax.spacing, 900);
    wax.add(cell * Vec3{60, 4, 4}, 1.6f * wax.spacing, 300);
    Mesher kept, fresh;
    kept(wax, kCell, 0);
    take(wax, 201);
    kept(wax, kCell, 0);
    CHECK(sameBits(kept.surface, fresh(wax, kCell, 0)));
    const Array<float>& t = fresh.surface.temperatures;
    const Array<Vec3>& p = fresh.surface.positions;
    size_t nearest = 0;
    for (size_t v = 0; v < p.size(); ++v)
        if (length(p[v] - cell * Vec3{3.98f, 4, 4}) < length(p[nearest] - cell * Vec3{3.98f, 4, 4})) nearest = v;
    CHECK(length(p[nearest] - cell * Vec3{3.98f, 4, 4}) < 0.2f * cell);
    CHECK(t[nearest] == doctest::Approx(900));
}

TEST_CASE("surface: a particle is known in whatever row it stands") {
    Dice dice;
    Wax wax = slab(dice);
    for (int k = 0; k < 3; ++k) wax.add(wax.positions[925 + 7 * size_t(k)].xyz(), wax.spacing, 400 + 50 * float(k), 1);
    Mesher kept(2);
    kept(wax);
    const int64_t all = kept.surface.meshedBlocks();
    int64_t blocks = all;
    for (int round = 0; round < 24; ++round) {
        const int what = round % 4;
        const auto turn = [&](size_t begin, size_t middle, size_t end) {
            const auto one = [&](auto& a) {
                const auto at = [&](size_t k) { return a.begin() + std::ptrdiff_t(k); };
                std::rotate(at(begin), at(middle), at(end));
            };
            one(wax.positions), one(wax.temperatures), one(wax.liquidFractions), one(wax.materials), one(wax.bodies);
        };
        const size_t count = wax.positions.size(), some = size_t(dice.roll() * 0.9f * float(count));
        if (what == 0) turn(0, some, some + 1);            // one melts: it comes first, and the others one farther
        if (what == 1) turn(some, some + 300, some + 900); // cells of the sort shift
        if (what == 2) turn(0, count / 2, count);          // all
        if (what == 3)                                     // neighbours
            for (int k = 0; k < 200; ++k)
                turn(some + 2 * size_t(k), some + 2 * size_t(k) + 1, some + 2 * size_t(k) + 2);
        if (round % 3 == 1) wax.positions[some].y += 0.0003f;
        if (round % 5 == 3) wax.materials[some] ^= 1;
        if (round % 6 == 5) take(wax, some);
        for (float& t : wax.temperatures) t += 0.01f;
        kept(wax);
        Mesher fresh;
        CAPTURE(round);
        REQUIRE(sameBits(kept.surface, fresh(wax)));
        if (what == 0) CHECK(kept.surface.meshedBlocks() - blocks < all / 4);
        if (what == 1) CHECK(kept.surface.meshedBlocks() - blocks < all / 4);
        blocks = kept.surface.meshedBlocks();
    }
}

TEST_CASE(
    "surface: of one material, then of two, smoothed once, twice or not at all: the bits of what is meshed anew") {
    Dice dice;
    Wax wax = slab(dice);
    std::fill(wax.materials.begin(), wax.materials.end(), uint8_t(2));
    Mesher kept;
    const auto check = [&](int smoothing) {
        kept(wax, 0.75f, smoothing);
        Mesher fresh;
        CHECK(sameBits(kept.surface, fresh(wax, 0.75f, smoothing)));
    };
    const auto move = [&] { wax.positions[0].y -= 0.0001f; };
    check(1);
    wax.materials[39] = 1; // a corner
    check(1);
    const auto share = [&] {
        int other = 0;
        for (const auto& m : kept.surface.mixtures) other += m.material[0] != 2 || m.share[0] != 255;
        return other;
    };
    CHECK(share() > 10);
    move(), check(1);
    CHECK(share() > 10);
    wax.materials[39] = 2;
    check(1);
    CHECK(share() == 0);
    move(), wax.materials[0] = 1, check(1);
    CHECK(share() > 10);
    for (int smoothing : {1, 2, 2, 0, 0, 1, 1}) {
        move();
        CAPTURE(smoothing);
        check(smoothing);
        check(smoothing);
    }
}

TEST_CASE("surface: more particles in one place than a sum of fill has room for are no hole") {
    Wax few, many;
    Dice dice;
    for (int k = 0; k < 45000; ++k) {
        const Vec3 at = 0.01f * many.spacing * dice.direction();
        many.add(at);
        if (k < 25000) few.add(at);
    }
    Mesher mesher;
    const MeshFacts facts = factsOf(mesher(few));
    CHECK(facts.badEdges == 0);
    CHECK(facts.components == 1);
    for (int round = 0; round < 2; ++round) {
        mesher(many);
        const MeshFacts crowded = factsOf(mesher.surface);
        CHECK(crowded.badEdges == 0);
        CHECK(crowded.components == 1);
        CHECK(crowded.volume > facts.volume);
        CHECK(crowded.volume < 1.2 * facts.volume);
        // Some leave: sums fit again, or not yet.
        for (size_t left : {40000u, 25000u}) {
            Wax less = many;
            while (less.positions.size() > left) take(less, less.positions.size() - 1);
            Mesher fresh;
            CHECK(sameBits(mesher(less), fresh(less)));
        }
    }
}

TEST_CASE("surface: what changes for long takes no more memory") {
    Dice dice;
    Wax wax = slab(dice);
    Mesher mesher;
    size_t most = 0;
    const std::vector<Vec4> rest = wax.positions;
    for (int round = 0; round < 60; ++round) {
        for (size_t i = 0; i < wax.positions.size() / 3; ++i)
            wax.positions[i].setXyz(rest[i].xyz() + wax.spacing * 0.5f * dice.direction());
        mesher(wax);
        if (round == 19) most = mesher.allocator.bytes();
    }
    CHECK(mesher.allocator.bytes() < most + most / 8);
    Mesher fresh;
    CHECK(sameBits(mesher.surface, fresh(wax)));
}

TEST_CASE("surface: ranges do not overlap, stay where they fit, and are used again") {
    Allocator allocator;
    RangePool pool(allocator);
    Dice dice;
    RangePool::Range ranges[50];
    uint32_t counts[50] = {};
    size_t size = 0;
    for (int round = 0; round < 4000; ++round) {
        const size_t k = size_t(dice.roll() * 50);
        const RangePool::Range before = ranges[k];
        counts[k] = dice.roll() < 0.2f ? 0 : uint32_t(dice.roll() * dice.roll() * 1500);
        pool.fit(ranges[k], counts[k]);
        REQUIRE(ranges[k].capacity >= counts[k]);
        if (counts[k] > 0 && counts[k] <= before.capacity && 2 * counts[k] >= before.capacity)
            CHECK(ranges[k].begin == before.begin);
        CHECK(ranges[k].capacity <= 4 * counts[k] + 64);
        for (size_t n = 0; n < 50; ++n) {
            if (n == k || ranges[n].capacity == 0 || ranges[k].capacity == 0) continue;
            const bool apart = ranges[n].begin + ranges[n].capacity <= ranges[k].begin ||
                               ranges[k].begin + ranges[k].capacity <= ranges[n].begin;
            REQUIRE(apart);
        }
        REQUIRE(ranges[k].begin + ranges[k].capacity <= pool.size());
        if (round == 2000) size = pool.size();
    }
    CHECK(pool.size() < size + size / 4);
}
