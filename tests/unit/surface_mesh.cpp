// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/cubes.h"
#include "surface_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace thaw;

namespace {

Wax ball(float radius, Vec3 shift = {0.5f, 0.5f, 0.5f}) {
    Wax wax;
    wax.fill(int(radius) + 2, shift, [&](Vec3 p) { return dot(p, p) < radius * radius; });
    return wax;
}

void checkClosed(const Surface& s) {
    MeshFacts facts = factsOf(s);
    CHECK(facts.badEdges == 0);
    CHECK(facts.badVertices == 0);
    CHECK(facts.volume > 0);
}

} // namespace

TEST_CASE("surface: cube cases agree across faces") {
    const CubeCases& cases = cubeCases();
    // Of all triangle edges of a case, those in a face must be drawn once and only depend on the face's corners.
    std::map<std::pair<int, int>, std::vector<std::pair<int, int>>> seen; // (face axis and side, corners) -> outline
    for (int bits = 0; bits < 256; ++bits) {
        std::map<std::pair<int, int>, int> drawn;
        for (int t = 0; t < cases.triangleCount[bits]; ++t)
            for (int k = 0; k < 3; ++k)
                ++drawn[{cases.triangles[bits][3 * t + k], cases.triangles[bits][3 * t + (k + 1) % 3]}];
        auto onFace = [&](int edge, int axis, int side) {
            return edge / 4 != axis && (cases.edgeStart[edge] >> axis & 1) == side;
        };
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side) {
                int corners = 0;
                for (int c = 0, k = 0; c < 8; ++c)
                    if ((c >> axis & 1) == side) corners |= (bits >> c & 1) << k++;
                std::vector<std::pair<int, int>> outline;
                for (const auto& [edge, count] : drawn) {
                    if (!onFace(edge.first, axis, side) || !onFace(edge.second, axis, side)) continue;
                    CHECK(count == 1);
                    CHECK(drawn.count({edge.second, edge.first}) == 0);
                    // Named as the cube on the other side names it, and with its direction.
                    auto mirror = [&](int e) {
                        int start = cases.edgeStart[e] & ~(1 << axis);
                        return 16 * (e / 4) + start;
                    };
                    outline.push_back(side ? std::pair(mirror(edge.second), mirror(edge.first))
                                           : std::pair(mirror(edge.first), mirror(edge.second)));
                }
                std::sort(outline.begin(), outline.end());
                auto [it, isNew] = seen.insert({{axis, corners}, outline});
                if (!isNew) CHECK(it->second == outline);
            }
        for (const auto& [edge, count] : drawn) CHECK(count == 1);
    }
    CHECK(seen.size() == 48);
}

TEST_CASE("surface: ball is closed, points outward, has no handle") {
    Mesher mesher;
    for (float cell : {0.25f, 0.5f, 0.75f, 1.0f, 2.0f, 4.0f})
        for (int smoothing : {0, 1, 3}) {
            Surface& s = mesher(ball(9), cell, smoothing);
            MeshFacts facts = factsOf(s);
            CAPTURE(cell);
            CHECK(facts.badEdges == 0);
            CHECK(facts.badVertices == 0);
            CHECK(facts.components == 1);
            CHECK(facts.euler == 2);
            CHECK(facts.volume > 0);
            for (size_t v = 0; v < s.positions.size(); ++v) {
                CHECK(std::fabs(length(s.normals[v]) - 1) < 1e-5f);
                CHECK(dot(s.normals[v], normalizeOr(s.positions[v], {})) > 0.7f);
            }
        }
}

TEST_CASE("surface: torus has one handle, two balls are two") {
    Mesher mesher;
    Wax torus;
    torus.fill(16, {0.3f, 0.1f, 0.2f}, [](Vec3 p) {
        float ring = std::sqrt(p.x * p.x + p.z * p.z) - 10;
        return ring * ring + p.y * p.y < 4 * 4;
    });
    MeshFacts facts = factsOf(mesher(torus));
    CHECK(facts.badEdges == 0);
    CHECK(facts.badVertices == 0);
    CHECK(facts.components == 1);
    CHECK(facts.euler == 0);

    Wax two = ball(5);
    for (const Vec4& p : ball(5).positions) two.add(p.xyz() + Vec3{0.03f, 0, 0});
    facts = factsOf(mesher(two));
    CHECK(facts.components == 2);
    CHECK(facts.euler == 4);
}

TEST_CASE("surface: any scatter of particles gives a closed manifold") {
    Mesher mesher;
    Dice dice;
    for (int round = 0; round < 6; ++round) {
        Wax wax;
        for (int k = 0; k < 1500; ++k) {
            Vec3 p{0.04f * dice.roll() - 0.02f, 0.04f * dice.roll() - 0.02f, 0.04f * dice.roll() - 0.02f};
            wax.add(p, wax.spacing * (1 + 1.5f * dice.roll()));
        }
        Surface& s = mesher(wax, round < 3 ? 0.75f : 0.4f, round);
        CHECK(s.indices.size() > 3000);
        checkClosed(s);
    }
}

TEST_CASE("surface: flats are flat and where they should be") {
    Mesher mesher;
    Dice dice;
    // Twelve layers of one spacing, then one with coarse particles in its core, as levels put them.
    for (int kind = 0; kind < 2; ++kind)
        for (float cell : {0.5f, 0.75f, 1.0f}) {
            Wax wax;
            Vec3 shift{dice.roll(), dice.roll(), dice.roll()};
            auto isCore = [&](Vec3 p) {
                return kind == 1 && std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) < 6;
            };
            for (int z = -10; z < 10; ++z)
                for (int y = -10; y < 10; ++y)
                    for (int x = -10; x < 10; ++x) {
                        Vec3 p{float(x) + 0.5f, float(y) + 0.5f, float(z) + 0.5f};
                        if (!isCore(p)) wax.add(wax.spacing * (p + shift));
                    }
            if (kind == 1)
                for (int z = -3; z < 3; ++z)
                    for (int y = -3; y < 3; ++y)
                        for (int x = -3; x < 3; ++x)
                            wax.add(wax.spacing *
                                        (Vec3{2.0f * float(x) + 1, 2.0f * float(y) + 1, 2.0f * float(z) + 1} + shift),
                                    2 * wax.spacing);
            Surface& s = mesher(wax, cell);
            double worst = 0, worstNormal = 1;
            int onFace = 0;
            for (size_t v = 0; v < s.positions.size(); ++v) {
                Vec3 p = (1 / wax.spacing) * s.positions[v] - shift;
                float at[3] = {p.x, p.y, p.z}, normal[3] = {s.normals[v].x, s.normals[v].y, s.normals[v].z};
                for (int axis = 0; axis < 3; ++axis) {
                    if (std::fabs(at[(axis + 1) % 3]) > 7.5f || std::fabs(at[(axis + 2) % 3]) > 7.5f) continue;
                    ++onFace;
                    worst = std::max(worst, std::fabs(double(std::fabs(at[axis])) - 10));
                    worstNormal = std::min(worstNormal, double(normal[axis] * (at[axis] > 0 ? 1 : -1)));
                }
            }
            CAPTURE(kind);
            CAPTURE(cell);
            CHECK(onFace > 500);
            CHECK(worst < (cell < 0.9f ? 0.03 : 0.1)); // spacings; a full body has no other vertices there
            CHECK(worstNormal > 0.998);
            CHECK(factsOf(s).components == 1);
        }
}

TEST_CASE("surface: a level change in a flat does not bulge") {
    Mesher mesher;
    Wax wax; // fine on the left, twice as coarse on the right, one common top
    for (int z = -10; z < 10; ++z)
        for (int y = -12; y < 0; ++y)
            for (int x = -16; x < 0; ++x)
                wax.add(wax.spacing * Vec3{float(x) + 0.5f, float(y) + 0.5f, float(z) + 0.5f});
    for (int z = -5; z < 5; ++z)
        for (int y = -6; y < 0; ++y)
            for (int x = 0; x < 8; ++x)
                wax.add(wax.spacing * Vec3{2.0f * float(x) + 1, 2.0f * float(y) + 1, 2.0f * float(z) + 1},
                        2 * wax.spacing);
    Surface& s = mesher(wax);
    double highest = -1, lowest = 1;
    for (const Vec3& v : s.positions) {
        Vec3 p = (1 / wax.spacing) * v;
        if (std::fabs(p.z) > 6 || p.x < -12 || p.x > 12 || p.y < -3) continue;
        highest = std::max(highest, double(p.y)), lowest = std::min(lowest, double(p.y));
    }
    MESSAGE("level change: top of the flat from " << lowest << " to " << highest << " spacings");
    CHECK(highest < 0.2);
    CHECK(lowest > -0.2);
}
