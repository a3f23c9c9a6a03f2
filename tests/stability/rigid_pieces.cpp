// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// Rigid pieces as a host sees them. What they do in free fall, on walls and in liquid: `thaw validate motion rigid`.
#include "world_fixture.h"

#include <algorithm>

namespace {

std::vector<thawPieceState> piecesOf(const WorldFixture& f) {
    std::vector<thawPieceState> all(static_cast<size_t>(thawWorld_GetPieces(f.world, nullptr, 0)));
    CHECK(thawWorld_GetPieces(f.world, all.data(), static_cast<int32_t>(all.size())) ==
          static_cast<int32_t>(all.size()));
    return all;
}

thawBodyId looseBox(WorldFixture& f, thawVec3 low, thawVec3 high, thawVec3 velocity = {}, thawVec3 spin = {}) {
    Shape s = boxShape(low, high);
    thawBodyDef d;
    thawInitBodyDef(&d);
    CHECK(d.anchored);
    d.material = f.material, d.mesh = s.mesh(), d.anchored = false, d.velocity = velocity, d.angularVelocity = spin;
    thawBodyId id;
    REQUIRE(thawCreateBody(f.world, &d, &id, nullptr) == thawResult_ok);
    return id;
}

} // namespace

TEST_CASE("rigid: a body on the floor is held when it is anchored, and a piece when it is not") {
    WorldFixture f;
    f.create();
    f.addMaterial();
    f.addFloor();
    f.addBox({-0.03f, 0, -0.008f}, {-0.014f, 0.016f, 0.008f});
    looseBox(f, {0.014f, 0, -0.008f}, {0.03f, 0.016f, 0.008f});
    f.step();
    const auto pieces = piecesOf(f);
    REQUIRE(pieces.size() == 1);
    CHECK(pieces[0].particles > f.counters().particles / 2 - 4);
    CHECK(pieces[0].particles < f.counters().particles / 2 + 4);
    CHECK(pieces[0].center.x == doctest::Approx(0.022f).epsilon(0.02));
    CHECK(f.counters().pieces == 1);
    const thawParticleView v = f.particles();
    for (int i = 0; i < v.count; ++i) {
        CHECK((v.flags[i] & thawParticle_fixed) != 0);
        CHECK(((v.flags[i] & thawParticle_rigid) != 0) == (v.positions[4 * i] > 0));
    }
}

TEST_CASE("rigid: a body of two parts is two pieces, each with its share of the motion") {
    WorldFixture f;
    f.def.gravity = {0, 0, 0};
    f.create();
    f.addMaterial();
    Shape s = boxShape({-0.03f, 0, 0}, {-0.018f, 0.012f, 0.012f});
    const Shape other = boxShape({0.018f, 0, 0}, {0.03f, 0.012f, 0.012f});
    const uint32_t first = static_cast<uint32_t>(s.vertices.size() / 3);
    s.vertices.insert(s.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (uint32_t i : other.indices) s.indices.push_back(first + i);
    thawBodyDef d;
    thawInitBodyDef(&d);
    d.material = f.material, d.mesh = s.mesh(), d.velocity = {0.1f, 0, 0}, d.angularVelocity = {0, 0, 10};
    thawBodyId id;
    REQUIRE(thawCreateBody(f.world, &d, &id, nullptr) == thawResult_ok);
    f.step();
    auto pieces = piecesOf(f);
    REQUIRE(pieces.size() == 2);
    std::sort(pieces.begin(), pieces.end(), [](auto& a, auto& b) { return a.center.x < b.center.x; });
    // v = V + w x r about the common centre, at x = 0.
    for (int k = 0; k < 2; ++k) {
        CHECK(pieces[k].velocity.x == doctest::Approx(0.1).epsilon(1e-4));
        CHECK(pieces[k].velocity.y == doctest::Approx(k ? 0.24 : -0.24).epsilon(2e-3));
        CHECK(pieces[k].angularVelocity.z == doctest::Approx(10).epsilon(1e-4));
    }
    CHECK(pieces[0].id != pieces[1].id);
}

TEST_CASE("rigid: a piece sleeps at rest, costs nothing, and wakes when it is hit or loses its floor") {
    WorldFixture f;
    f.create();
    f.addMaterial();
    const thawColliderId floor = f.addFloor();
    looseBox(f, {-0.008f, 0, -0.008f}, {0.008f, 0.016f, 0.008f});
    f.step(60);
    REQUIRE(piecesOf(f)[0].asleep);
    CHECK(f.counters().moving == 0);
    CHECK_FALSE(f.plan().enabled[thawStage_neighbors]);
    CHECK_FALSE(f.plan().enabled[thawStage_collision]);
    looseBox(f, {-0.06f, 0.002f, -0.006f}, {-0.044f, 0.018f, 0.01f}, {1.2f, 0, 0});
    int woke = 0;
    for (int frame = 0; frame < 60; ++frame) f.step(), woke += !piecesOf(f)[0].asleep;
    CHECK(woke > 0);
    CHECK(piecesOf(f)[0].center.x > 0.002f);
    f.step(60);
    REQUIRE(piecesOf(f)[0].asleep);
    REQUIRE(thawDestroyCollider(f.world, floor) == thawResult_ok);
    f.step(10);
    CHECK(piecesOf(f)[0].velocity.y == doctest::Approx(-9.81 * 10 / 60).epsilon(0.06));
}

TEST_CASE("rigid: pieces in liquid give the same bits with 1, 2 and 4 threads") {
    uint64_t expected = 0;
    for (int workers : {1, 2, 4}) {
        WorldFixture f;
        f.def.tasks.workerCount = workers;
        f.create();
        f.addMaterial();
        f.addFloor();
        f.addBox({-0.012f, 0, -0.012f}, {0.012f, 0.012f, 0.012f}, 350); // liquid
        looseBox(f, {-0.006f, 0.016f, -0.006f}, {0.006f, 0.028f, 0.006f}, {0, -0.3f, 0}, {0, 0, 4});
        f.step(40);
        CHECK(f.counters().pieces == 1);
        const uint64_t h = thawWorld_GetStateHash(f.world);
        if (workers == 1) expected = h;
        CHECK(h == expected);
    }
}
