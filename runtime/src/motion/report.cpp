// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// What the movers do to colliders by way of the held particles that hang on them. Walls themselves are counted where
// they act (Motion::kick); pairs are not kept one by one, so those with a held partner are gone through again, for
// reporting colliders only.
#include "base/kernel.h"
#include "motion/motion.h"
#include "motion/numbers.h"
#include "motion/pairs.h"

#include <algorithm>
#include <cmath>

namespace thaw {

void Motion::addImpulses(Collider* colliders, int colliderCount) const {
    if (!reporting_) return;
    for (int c = 0; c < colliderCount; ++c) {
        const int32_t slot = reportSlot_[static_cast<size_t>(c)];
        if (slot < 0) continue;
        for (size_t b = static_cast<size_t>(slot); b < reports_.size(); b += reporters_)
            for (int k = 0; k < 3; ++k) {
                // The blocks hold what the movers felt.
                colliders[c].impulse[k] -= reports_[b].linear[k];
                colliders[c].impulse[3 + k] -= reports_[b].angular[k];
            }
    }
}

bool Motion::reports(const MotionFrame& f, uint16_t anchor) const {
    return anchor > 0 && anchor <= f.colliderCount && reportSlot_[anchor - 1u] >= 0;
}

void Motion::report(const MotionFrame& f, int block, uint16_t anchor, Vec3 x, float mass, Vec3 change) {
    const size_t slot = static_cast<size_t>(block) * reporters_ + static_cast<size_t>(reportSlot_[anchor - 1u]);
    reports_[slot].add(x - f.colliders[anchor - 1].transform.position, mass, change);
}

template <class F> void Motion::forHeldPairs(const MotionFrame& f, F&& change) {
    const Particles& p = f.particles;
    if (!reporting_ || p.moverCount == p.count) return;
    f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int block, int) {
        for (int r = 8 * begin, last = std::min(8 * end, p.moverCount); r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            const uint32_t g = static_cast<uint32_t>(r) >> 3;
            const size_t first = f.neighbors.first[g] + (static_cast<uint32_t>(r) & 7);
            for (uint32_t k = 0; k < f.neighbors.width[g]; ++k) {
                const size_t entry = first + 8 * static_cast<size_t>(k);
                const uint32_t j = f.neighbors.entries[entry] >> 4;
                if (j < static_cast<uint32_t>(p.moverCount) || j >= static_cast<uint32_t>(p.count)) continue;
                if (!reports(f, p.anchor[j])) continue;
                const Vec3 x = point_[i].xyz(), y = point_[j].xyz();
                report(f, block, p.anchor[j], x, p.velocity[i].w, change(i, j, entry, x - y));
            }
        }
    });
}

void Motion::reportHeldDrag(const MotionFrame& f) {
    const Particles& p = f.particles;
    forHeldPairs(f, [&](size_t i, size_t j, size_t entry, Vec3 x) {
        const float along = dot(p.velocity[i].xyz() - p.velocity[j].xyz(), x);
        return (-coefficient_[entry] * along / p.velocity[i].w) * x;
    });
}

// Pressure as it is now, warm start and iterations together, and cohesion (see pairForces).
void Motion::reportHeldPush(const MotionFrame& f) {
    const Particles& p = f.particles;
    forHeldPairs(f, [&](size_t i, size_t j, size_t entry, Vec3 x) {
        const float mirrored = p.bondSlot[i] || !mirrors(f, j) ? 0 : p.pressure[i];
        float push = -f.dt * f.invDensity[i] * (p.pressure[i] + mirrored + trait_[j].w) * f.neighbors.gradient[entry];
        const float h = 0.5f * (p.position[i].w + p.position[j].w), r = length(x), d = h / kSupport;
        if (r > d && r < h) {
            push -= f.dt * 0.5f * kCohesionPeak * (r - d) * (h - r) * (trait_[i].y + trait_[j].y) / (h * h * r);
        }
        return push * x;
    });
}

// What clamps at the surface of held particles did goes to what the nearest of them hangs on.
void Motion::reportHeldKicks(const MotionFrame& f) {
    const Particles& p = f.particles;
    if (!reporting_ || p.moverCount == p.count) return;
    f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int block, int) {
        for (int r = 8 * begin, last = std::min(8 * end, p.moverCount); r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            const Vec3 kicked = heldKick_[i].xyz(), x = point_[i].xyz();
            if (!(dot(kicked, kicked) > 0)) continue;
            float nearest = INFINITY;
            uint16_t anchor = 0;
            forNeighbors(f.neighbors, r, [&](uint32_t j) {
                if (j < static_cast<uint32_t>(p.moverCount) || j >= static_cast<uint32_t>(p.count)) return true;
                const Vec3 d = x - point_[j].xyz();
                if (dot(d, d) < nearest) nearest = dot(d, d), anchor = p.anchor[j];
                return true;
            });
            if (reports(f, anchor)) report(f, block, anchor, x, p.velocity[i].w, kicked);
        }
    });
}

} // namespace thaw
