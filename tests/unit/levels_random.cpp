// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "levels/group.h"
#include "levels/levels.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

using namespace thaw;

namespace {

constexpr float kSpacing = 0.002f;
constexpr int kEdge = 10; // points

// A block of points as one body, all as coarse as they come, that is split and merged by wants out of nowhere.
struct Block {
    Allocator allocator;
    Particles particles{allocator};
    Neighbors neighbors{allocator};
    Reference reference{allocator};
    Levels levels{allocator};
    Tasks tasks{{}};
    std::vector<Material> materials;
    std::vector<uint8_t> absorbs; // by point, painted
    uint32_t nextId = 0;
    uint64_t steps = 0;
    std::mt19937 random{7};

    explicit Block(bool piece) {
        thawMaterialDef d;
        thawInitMaterialDef(&d, thawMaterial_wax);
        materials.emplace_back(d);
        std::vector<Vec3> points;
        for (int z = 0; z < kEdge; ++z)
            for (int y = 0; y < kEdge; ++y)
                for (int x = 0; x < kEdge; ++x)
                    points.push_back(kSpacing * Vec3{float(x) - 4.5f, float(y) - 4.5f, float(z) - 4.5f});
        const FillLattice lattice{points[0], {kSpacing, kSpacing, kSpacing}, kSpacing};
        const Groups groups = groupPoints(points, std::vector<uint8_t>(points.size(), 0), lattice);
        for (const uint32_t at : groups.order) {
            reference.point.push({points[at].x, points[at].y, points[at].z, 1});
            reference.slope.push({0, 0, 0, 0});
        }
        absorbs.assign(points.size(), 0);
        particles.allocate(static_cast<int>(points.size()));
        for (size_t at = 0; at < points.size(); at += size_t{1} << groups.levelOf(at)) {
            const int level = groups.levelOf(at);
            for (size_t k = at; k < at + (size_t{1} << level); ++k) reference.slope[k].w = static_cast<float>(level);
            const size_t k = static_cast<size_t>(particles.count++);
            const Vec3 x = reference.center(static_cast<uint32_t>(at), level);
            const Vec3 v = piece ? spin(x) : Vec3{};
            particles.position[k] = {x.x, x.y, x.z, supportOf(kSpacing, level)};
            particles.velocity[k] = {v.x, v.y, v.z, 7.2e-6f * static_cast<float>(1 << level)};
            particles.enthalpy[k] = -1e5 * uniform();
            particles.level[k] = static_cast<uint8_t>(level), particles.fine[k] = static_cast<uint32_t>(at) + 1;
            particles.flags[k] = kFixed | (piece ? kRigid : 0), particles.piece[k] = piece;
            particles.id[k] = nextId++;
        }
        particles.pad();
        lists();
    }
    static Vec3 spin(Vec3 x) { return cross({10, 20, -30}, x) + Vec3{0.3f, 0, 0}; }
    double uniform() { return std::uniform_real_distribution<double>(0, 1)(random); }
    void lists() { neighbors.sort(particles, tasks), neighbors.build(particles, tasks); }

    LevelResult round(int finest, int coarsest) {
        for (size_t k = 0; k < static_cast<size_t>(particles.count); ++k) {
            const double u = uniform();
            particles.want[k] = u < 0.7 ? Levels::kFar : static_cast<uint8_t>(u < 0.85 ? 0 : 60 * uniform());
        }
        const LevelResult r = levels.apply({particles, neighbors, reference, materials.data(), tasks, kSpacing, finest,
                                            coarsest, 400, ++steps, nextId, nullptr, 0, nullptr, nullptr});
        lists();
        return r;
    }
    // As rigid pieces turn: rows about the middle, and their points with them.
    void turn() {
        const double a = 6.28 * uniform(), c = std::cos(a), s = std::sin(a);
        const int axis = static_cast<int>(3 * uniform());
        const auto turned = [&](Vec3 v) {
            float e[3] = {v.x, v.y, v.z};
            const int p = (axis + 1) % 3, q = (axis + 2) % 3;
            const double x = e[p], y = e[q];
            e[p] = static_cast<float>(c * x - s * y), e[q] = static_cast<float>(s * x + c * y);
            return Vec3{e[0], e[1], e[2]};
        };
        for (size_t k = 0; k < static_cast<size_t>(particles.count); ++k) {
            particles.position[k].setXyz(turned(particles.position[k].xyz()));
            reference.turn(particles, k, turned);
            particles.velocity[k].setXyz(spin(particles.position[k].xyz()));
        }
        lists();
    }
    void paint() {
        const size_t k = static_cast<size_t>(uniform() * particles.count);
        particles.absorbs[k] = static_cast<uint8_t>(1 + 3 * uniform());
        for (uint32_t p = particles.fine[k] - 1, n = 1u << particles.level[k]; n > 0; ++p, --n)
            absorbs[p] = particles.absorbs[k];
    }

    struct Sums {
        double mass = 0, energy = 0, momentum[3] = {}, moment[3] = {};
    };
    Sums sums() const {
        Sums s;
        for (size_t k = 0; k < static_cast<size_t>(particles.count); ++k) {
            const Vec4 &x = particles.position[k], &v = particles.velocity[k];
            const double m = v.w;
            s.mass += m, s.energy += m * particles.enthalpy[k];
            s.momentum[0] += m * v.x, s.momentum[1] += m * v.y, s.momentum[2] += m * v.z;
            s.moment[0] += m * x.x, s.moment[1] += m * x.y, s.moment[2] += m * x.z;
        }
        return s;
    }
    // Every point in one row, with the paint that it got, and every row where its points are.
    void check() {
        std::vector<int> seen(reference.point.size(), 0);
        std::set<uint32_t> ids;
        bool paint = true;
        for (size_t k = 0; k < static_cast<size_t>(particles.count); ++k) {
            ids.insert(particles.id[k]);
            for (uint32_t p = particles.fine[k] - 1, n = 1u << particles.level[k]; n > 0; ++p, --n)
                ++seen[p], paint &= absorbs[p] == particles.absorbs[k];
        }
        CHECK(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
        CHECK(ids.size() == static_cast<size_t>(particles.count));
        CHECK(paint);
    }
};

} // namespace

TEST_CASE("levels: ten thousand splits and merges at random keep mass, momentum, energy, paint and the places") {
    for (const bool piece : {false, true}) {
        CAPTURE(piece);
        Block b(piece);
        const Block::Sums before = b.sums();
        int split = 0, merged = 0;
        double drift = 0; // of momentum in a round
        for (int round = 0; split + merged < 20000 && round < 2000; ++round) {
            const Block::Sums was = b.sums();
            const LevelResult r = b.round(0, round % 5 == 0 ? 2 : 3);
            const Block::Sums is = b.sums();
            for (int a = 0; a < 3; ++a) drift = std::max(drift, std::abs(is.momentum[a] - was.momentum[a]));
            split += r.split, merged += r.merged;
            if (piece) b.turn();
            if (round % 50 == 49) b.paint(), b.check();
        }
        CHECK(split >= 10000);
        CHECK(merged >= 5000);
        const Block::Sums after = b.sums();
        CHECK(after.mass == doctest::Approx(before.mass).epsilon(1e-12));
        CHECK(after.energy == doctest::Approx(before.energy).epsilon(1e-12));
        CHECK(drift <= 1e-6 * before.mass * 0.3);
        for (const double m : after.moment) CHECK(std::abs(m) <= 1e-4 * before.mass * static_cast<double>(kSpacing));
        std::vector<uint32_t> rows(static_cast<size_t>(b.particles.count));
        for (uint32_t k = 0; k < rows.size(); ++k) rows[k] = k;
        CHECK(b.levels.splitFully({b.particles, b.neighbors, b.reference, b.materials.data(), b.tasks, kSpacing, 0, 3,
                                   1, 0, b.nextId, nullptr, 0, nullptr, nullptr},
                                  rows.data(), rows.size()));
        REQUIRE(b.particles.count == kEdge * kEdge * kEdge);
        b.check();
        float farthest = 0;
        for (size_t k = 0; k < static_cast<size_t>(b.particles.count); ++k)
            farthest = std::max(
                farthest, length(b.particles.position[k].xyz() - b.reference.point[b.particles.fine[k] - 1].xyz()));
        CHECK(farthest <= 1e-3f * kSpacing);
    }
}
