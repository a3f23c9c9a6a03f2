// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/kernel.h"
#include "base/memory.h"
#include "base/state_io.h"
#include "particles/particles.h"

namespace thaw {

// Where the finest particles of solids are that were not touched since they were filled: the reference configuration.
// A coarse particle of level l stands for the 2^l points [fine - 1, fine - 1 + 2^l) of this list (Particles::fine), is
// their centre of mass, and splits into the two halves of that range, so that what is split to the end stands exactly
// where the filling put it. Points turn with their solid; they do not move along: only differences mean something.
struct Reference {
    explicit Reference(Allocator& allocator)
        : point(allocator), slope(allocator), home(allocator), homeSlope(allocator) {}

    Array<Vec4> point; // xyz m; w share of its support that the whole body fills (Neighbors::volumeFraction)
    Array<Vec4> slope; // xyz gradient of that, 1/m (Neighbors::gradientSum); w: highest level of its group, 0..3
    // Elastic solids bend: their points go with the deformation around them (Bonds::deform), and these are as filled.
    // Empty as long as no elastic body has coarse particles.
    Array<Vec4> home, homeSlope;

    // Sets io.limits.points.
    void state(StateIo& io) {
        constexpr size_t kMost = size_t{1} << 27;
        io.limits.points = io.count(point.size(), kMost);
        const auto all = [&](Array<Vec4>& a, size_t n) {
            io.block(a, kMost);
            if (io.checks() && n != io.lastCount()) io.fail("points of another number");
        };
        all(point, io.limits.points), all(slope, io.limits.points);
        const size_t homes = io.count(home.size(), kMost);
        if (io.reads() && homes != 0 && homes != io.limits.points) io.fail("points of another number");
        all(home, homes), all(homeSlope, homes);
    }

    // Mean of the 2^level points from `begin` on.
    Vec3 center(uint32_t begin, int level) const { return mean(point, begin, level); }
    Vec3 homeCenter(uint32_t begin, int level) const { return mean(home, begin, level); }
    int highestLevel(uint32_t begin) const { return static_cast<int>(slope[begin].w); }

    // Calls f(place, k) for the finest points of a row that has some: where they are now, and their index.
    template <class F> void forPoints(const Particles& p, size_t row, F&& f) const {
        const uint32_t begin = p.fine[row] - 1;
        const Vec3 shift = p.position[row].xyz() - center(begin, p.level[row]);
        for (uint32_t k = begin, end = begin + (1u << p.level[row]); k < end; ++k) f(point[k].xyz() + shift, k);
    }
    // A row turns: turn(v) is where a vector of its solid points from now on.
    template <class F> void turn(const Particles& p, size_t row, F&& turn) {
        if (!p.fine[row]) return;
        const uint32_t begin = p.fine[row] - 1;
        for (uint32_t k = begin, end = begin + (1u << p.level[row]); k < end; ++k)
            point[k].setXyz(turn(point[k].xyz())), slope[k].setXyz(turn(slope[k].xyz()));
    }

private:
    static Vec3 mean(const Array<Vec4>& of, uint32_t begin, int level) {
        double sum[3] = {};
        const uint32_t n = 1u << level;
        for (uint32_t k = begin; k < begin + n; ++k) sum[0] += of[k].x, sum[1] += of[k].y, sum[2] += of[k].z;
        return {static_cast<float>(sum[0] / n), static_cast<float>(sum[1] / n), static_cast<float>(sum[2] / n)};
    }
};

// Support radius of a particle of a level, m.
inline float supportOf(float spacing, int level) {
    constexpr float kEdge[4] = {1, 1.25992105f, 1.58740105f, 2}; // 2^(level/3)
    return kSupport * spacing * kEdge[level];
}
inline constexpr int kHighestLevel = 3;

} // namespace thaw
