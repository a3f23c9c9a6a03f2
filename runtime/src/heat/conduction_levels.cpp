// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "heat/conduction.h"
#include "heat/conduction_solve.h"

#include <atomic>
#include <cmath>

namespace thaw {
namespace {

constexpr int kRowBlock = 512;

// f = base + slope (n . e)^2 of a particle of level 1 (n along it) and 2 (n across it): such that the second moments of
// its lattice, with 1 / filled, are those of the cubic one in all directions. Without, heat passes along bars of level
// 1 as if they conducted 35 % along their bricks, and 86 % in the plane of those of level 2.
constexpr float kBase[] = {1, 0.94606f, 1.22382f};
constexpr float kSlope[] = {0, 2.35928f, -0.30073f};
constexpr float kFull[] = {1, 1.09458f, 1.02086f}; // filled share inside these lattices

bool isBrick(const Particles& p, size_t i) { return p.fine[i] && (p.level[i] == 1 || p.level[i] == 2); }

// Of a brick: unit.
Vec3 axisOf(const Particles& p, size_t i, const Reference& reference) {
    const uint32_t begin = p.fine[i] - 1;
    const auto at = [&](uint32_t k) { return reference.point[begin + k].xyz(); };
    if (p.level[i] == 1) return normalizeOr(at(1) - at(0), {});
    const Vec3 halves = at(2) + at(3) - at(0) - at(1), within = at(1) + at(3) - at(0) - at(2);
    return normalizeOr(cross(normalizeOr(halves, {}), normalizeOr(within, {})), {});
}

} // namespace

void Conduction::scalePairs(const HeatFrame& f) {
    const Particles& p = f.particles;
    const Neighbors& n = f.neighbors;
    bricks = false;
    if (!f.reference) return;
    axis.resizeRaw(state.size());
    std::atomic<bool> any{false};
    f.tasks.forBlocks(static_cast<int>(axis.size()), kRowBlock, [&](int begin, int end, int, int) {
        bool found = false;
        for (int i = begin; i < end; ++i) {
            const size_t k = static_cast<size_t>(i);
            axis[k] = {0, 0, 0, 1};
            if (i >= p.count || !isBrick(p, k)) continue;
            const float slope = kSlope[p.level[k]];
            // At a bare side the support of a brick is emptier than that of its points, by more than its length lacks
            // of the moment.
            float share = 0;
            const uint32_t from = p.fine[k] - 1, parts = 1u << p.level[k];
            for (uint32_t q = from; q < from + parts; ++q) share += f.reference->point[q].w;
            share *= kFull[p.level[k]] / static_cast<float>(parts);
            const float filled = f.neighbors.volumeFraction[k] / (walls ? walls[k].covered : 1.0f);
            const float emptier = share > 0 ? std::clamp(filled / share, 0.5f, 1.0f) : 1.0f;
            const Vec3 a = std::sqrt(std::abs(slope) * (p.level[k] == 1 ? emptier : 1)) * axisOf(p, k, *f.reference);
            axis[k] = {a.x, a.y, a.z, std::copysign(kBase[p.level[k]], slope)};
            found = true;
        }
        if (found) any.store(true, std::memory_order_relaxed);
    });
    bricks = any.load();
    if (!bricks) return;
    scaled.resizeRaw(n.entries.size()), groupScaled.resizeRaw(static_cast<size_t>(n.groupCount));
    const ConductionFactors factors{n.entries.data(),  n.gradient.data(), n.first.data(), n.width.data(),
                                    p.position.data(), axis.data(),       scaled.data()};
    f.tasks.forBlocks(n.groupCount, kRowBlock / 8, [&](int begin, int end, int, int) {
        for (int g = begin; g < end; ++g) {
            bool near = false; // a brick among the rows and their neighbours
            for (int i = 8 * g; i < std::min(8 * g + 8, p.count) && !near; ++i) {
                near = axis[static_cast<size_t>(i)].w != 1;
                if (!near)
                    forNeighbors(n, i, [&](uint32_t j) {
                        near = axis[j].w != 1;
                        return !near;
                    });
            }
            groupScaled[static_cast<size_t>(g)] = near;
            if (near) conductionFactors(factors, g);
        }
    });
}

} // namespace thaw
