// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// Elastic solids whose particles split and merge: what their bonds bear must not change by that.
#include "levels/group.h"
#include "levels/levels.h"
#include "stability/motion_fixture.h"

#include <doctest/doctest.h>

#include <array>
#include <functional>

using namespace thaw;

namespace {

constexpr float kModulus = 1e5f, kDensity = 1000;
using Field = std::function<Vec3(Vec3)>;
using Tensor = std::array<double, 6>;

double sizeOf(const Tensor& t) {
    return std::sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2] + 2 * (t[3] * t[3] + t[4] * t[4] + t[5] * t[5]));
}

// A block of (2 nx, 2 ny, 2 nz) points, bonded in bricks of eight, then deformed by a field; its middle is the origin.
struct Bricks {
    static constexpr float kSpacing = 0.004f;
    MotionScene scene;
    Bonds bonds;
    Reference reference{scene.allocator};
    Levels levels{scene.allocator};
    uint32_t nextId = 0;
    uint64_t steps = 0;

    Bricks(int nx, int ny, int nz, const Field& deformed) : scene(kSpacing, elastic()), bonds(scene.allocator) {
        scene.gravity = {};
        std::vector<Vec3> points;
        const Vec3 low = -0.5f * kSpacing * Vec3{float(2 * nx - 1), float(2 * ny - 1), float(2 * nz - 1)};
        for (int z = 0; z < 2 * nz; ++z)
            for (int y = 0; y < 2 * ny; ++y)
                for (int x = 0; x < 2 * nx; ++x) points.push_back(low + kSpacing * Vec3{float(x), float(y), float(z)});
        const FillLattice lattice{points[0], {kSpacing, kSpacing, kSpacing}, kSpacing};
        const Groups groups = groupPoints(points, std::vector<uint8_t>(points.size(), 0), lattice);
        REQUIRE(groups.ends[3] == points.size());
        for (const uint32_t at : groups.order) {
            reference.point.push({points[at].x, points[at].y, points[at].z, 1}), reference.slope.push({0, 1, 0, 3});
            reference.home.push(reference.point[reference.point.size() - 1]);
            reference.homeSlope.push({0, 1, 0, 3});
        }
        for (uint32_t at = 0; at < points.size(); at += 8) {
            scene.add(reference.center(at, 3), false, {}, 0);
            Particles& p = scene.particles;
            const size_t k = static_cast<size_t>(p.count - 1);
            p.level[k] = 3, p.fine[k] = at + 1, p.position[k].w = supportOf(kSpacing, 3), p.want[k] = Levels::kFar;
            p.velocity[k].w = 8 * kDensity * kSpacing * kSpacing * kSpacing;
            p.enthalpy[k] = -1000 - 7.0 * static_cast<double>(at), nextId = p.id[k] + 1;
        }
        scene.weigh();
        bonds.bondAll(frame());
        move(deformed);
        bonds.deform(frame(), reference);
    }
    static thawMaterialDef elastic() {
        thawMaterialDef d = MotionScene::liquid(1);
        d.density = kDensity, d.setFraction = 0.35f, d.releaseFraction = 0.6f, d.youngModulus = kModulus;
        return d;
    }
    BondFrame frame() { return scene.bondFrame(); }
    void move(const Field& deformed) {
        Particles& p = scene.particles;
        for (size_t i = 0; i < static_cast<size_t>(p.count); ++i) p.position[i].setXyz(deformed(p.position[i].xyz()));
    }
    // Splits the rows for which which(filled at) holds, and merges where merge.
    LevelResult change(const std::function<bool(Vec3)>& which) {
        Particles& p = scene.particles;
        scene.weigh();
        for (size_t i = 0; i < static_cast<size_t>(p.count); ++i)
            p.want[i] = which(reference.homeCenter(p.fine[i] - 1, p.level[i])) ? 0 : Levels::kFar;
        LevelResult r;
        for (int k = 0; k < 16; ++k) { // what merges has its turn
            const LevelResult one =
                levels.apply({p, scene.neighbors, reference, scene.materials.data(), scene.tasks, kSpacing, 0, 3,
                              1 << 20, ++steps, nextId, nullptr, 0, nullptr, nullptr, &bonds, MotionScene::kStep});
            r.split += one.split, r.merged += one.merged;
            scene.weigh();
        }
        return r;
    }
    // By brick of the filling, J.
    std::vector<Tensor> virials() {
        bonds.lay(frame());
        std::vector<Tensor> out(reference.point.size() / 8, Tensor{});
        for (uint32_t i = 0; i < static_cast<uint32_t>(scene.particles.count); ++i) {
            const Bonds::Virial v = bonds.virial(frame(), i);
            Tensor& t = out[(scene.particles.fine[i] - 1) / 8];
            const float all[6] = {v.xx, v.yy, v.zz, v.xy, v.yz, v.zx};
            for (size_t c = 0; c < 6; ++c) t[c] += static_cast<double>(all[c]);
        }
        return out;
    }
    std::array<double, 5> sums() const { // mass, momentum, heat
        std::array<double, 5> s{};
        const Particles& p = scene.particles;
        for (size_t i = 0; i < static_cast<size_t>(p.count); ++i) {
            const Vec4 v = p.velocity[i];
            const double m = static_cast<double>(v.w);
            s[0] += m, s[1] += m * static_cast<double>(v.x), s[2] += m * static_cast<double>(v.y);
            s[3] += m * static_cast<double>(v.z), s[4] += m * p.enthalpy[i];
        }
        return s;
    }
};

struct Jump {
    double mean, local; // of the body's mean stress; rms over its bricks over their rms
};
Jump jumpOf(const std::vector<Tensor>& before, const std::vector<Tensor>& after) {
    Tensor sum{}, change{};
    double all = 0, off = 0;
    for (size_t k = 0; k < before.size(); ++k) {
        Tensor d;
        for (size_t c = 0; c < 6; ++c) d[c] = after[k][c] - before[k][c], sum[c] += before[k][c], change[c] += d[c];
        all += sizeOf(before[k]) * sizeOf(before[k]), off += sizeOf(d) * sizeOf(d);
    }
    return {sizeOf(change) / sizeOf(sum), std::sqrt(off / all)};
}

// Its own weight on a column of height 16 spacings, rho g (H - y) / E: the exact field of a bar.
Vec3 weight(Vec3 x) {
    const float k = kDensity * 9.81f / kModulus * 20, y = x.y + 8 * Bricks::kSpacing,
                top = 16 * Bricks::kSpacing; // 20 g
    return x + Vec3{0.25f * k * (top - y) * x.x, -k * (top * y - 0.5f * y * y) - 0.125f * k * (x.x * x.x + x.z * x.z),
                    0.25f * k * (top - y) * x.z};
}

const struct {
    const char* name;
    Field field;
} kLoads[] = {
    {"weight of 20 g", weight},
    {"stretched by 10 %",
     [](Vec3 x) {
         return Vec3{0.975f * x.x, 1.1f * x.y, 0.975f * x.z};
     }},
    {"sheared by 10 %",
     [](Vec3 x) {
         return Vec3{x.x + 0.1f * x.y, x.y, x.z};
     }},
    {"pressed by 5 %, turned by a third",
     [](Vec3 x) {
         const float c = std::cos(1.0f), s = std::sin(1.0f), y = 0.95f * x.y;
         return Vec3{c * x.x - s * y, s * x.x + c * y, x.z};
     }},
};
const struct {
    const char* name;
    std::function<bool(Vec3)> which;
} kParts[] = {
    {"all", [](Vec3) { return true; }},
    {"upper half", [](Vec3 x) { return x.y > 0; }},
    {"single ones",
     [](Vec3 x) {
         const float s = 2 * Bricks::kSpacing;
         return std::abs(x.x - 0.5f * s) < 0.6f * s && std::abs(x.z - 0.5f * s) < 0.6f * s &&
                std::abs(std::abs(x.y) - 1.5f * s) < 0.6f * s;
     }},
};

} // namespace

TEST_CASE("bonds, levels: a split changes the stress of a loaded elastic solid by 2 % at most") {
    for (const auto& load : kLoads)
        for (const auto& part : kParts) {
            Bricks b(4, 8, 4, load.field);
            const auto before = b.virials();
            const auto sums = b.sums();
            const LevelResult r = b.change(part.which);
            REQUIRE(r.split > 0);
            const Jump j = jumpOf(before, b.virials());
            MESSAGE(std::string(load.name)
                    << ", " << std::string(part.name) << ": mean " << 100 * j.mean << " %, by brick " << 100 * j.local
                    << " %, rows " << b.scene.particles.count);
            CHECK(j.mean <= 0.02);
            const auto now = b.sums();
            for (size_t c = 0; c < 5; ++c) CHECK(now[c] == doctest::Approx(sums[c]).epsilon(1e-9));
        }
}

TEST_CASE("bonds, levels: what has split for nothing merges back, and bears what it bore") {
    for (const auto& load : kLoads) {
        Bricks b(4, 8, 4, load.field);
        const auto before = b.virials();
        const auto sums = b.sums();
        const int rows = b.scene.particles.count;
        b.change([](Vec3) { return true; });
        REQUIRE(b.scene.particles.count == 8 * rows);
        const auto split = b.virials();
        for (int k = 0; k < 8; ++k) b.change([](Vec3) { return false; });
        REQUIRE(b.scene.particles.count == rows);
        const Jump j = jumpOf(before, b.virials());
        MESSAGE(std::string(load.name) << ": mean " << 100 * j.mean << " %, by brick " << 100 * j.local << " %");
        CHECK(j.mean <= 0.02);
        CHECK(jumpOf(split, b.virials()).mean <= 0.02);
        const auto now = b.sums();
        for (size_t c = 0; c < 5; ++c) CHECK(now[c] == doctest::Approx(sums[c]).epsilon(1e-9));
    }
}
