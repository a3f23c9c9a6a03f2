// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/motion.h"
#include "motion/numbers.h"
#include "motion/pairs.h"
#include "motion/walls.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

// A particle that moves farther than this many spacings in a step is followed along its way.
constexpr float kSweepFrom = 0.5f, kSweepStep = 0.5f;
// How near to the centre of a fixed particle its way ends: a square of four leaves a hole of 0.71.
constexpr float kFixedStandoff = 0.8f;
constexpr int kSweepMost = 256;
// Last resort, far above what a melt does: m/s, and spacings in a step for worlds of other sizes.
constexpr float kSpeedLimit = 30, kSpeedLimitSpacings = 100;

void pushOut(const WallFinder& walls, float standoff, Vec3& x, Vec3& v) {
    walls.forNear([&](const Collider& c) {
        Vec3 normal;
        const float d = c.distance(x, normal);
        if (d >= standoff) return;
        x += (standoff - d) * normal;
        const float into = dot(normal, v);
        if (into < 0) v -= into * normal;
    });
}

} // namespace

void Motion::move(const MotionFrame& f) {
    Particles& p = f.particles;
    if (p.moverCount == 0) return;

    Box held;
    for (int r = p.moverCount; r < p.count; ++r) held.grow(p.position[static_cast<size_t>(r)].xyz());
    const float limit = std::max(kSpeedLimit, kSpeedLimitSpacings * f.spacing / f.dt);

    f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int block, int) {
        const int last = std::min(8 * end, p.moverCount);
        BlockSums sums;
        Box around;
        float reach = 0;
        for (int r = 8 * begin; r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            const float speed = length(p.velocity[i].xyz());
            if (speed > limit) p.velocity[i].setXyz((limit / speed) * p.velocity[i].xyz()), sums.a += 1;
            const Vec3 x = p.position[i].xyz(), to = x + f.dt * p.velocity[i].xyz();
            around.grow(x), around.grow(to);
            reach = std::max(reach, p.position[i].w);
        }
        WallFinder walls;
        walls.gather(f.colliders, colliderBounds_.data(), f.colliderCount, around, reach);

        for (int r = 8 * begin; r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            const float spacing = p.position[i].w / kSupport;
            Vec3 x = p.position[i].xyz(), v = p.velocity[i].xyz();
            const Vec3 way = f.dt * v;
            if (!(dot(way, way) > kSweepFrom * kSweepFrom * spacing * spacing)) {
                x += way;
            } else {
                const float nearFixed = kFixedStandoff * spacing;
                // Distance to the nearest wall less the standoff; while it lasts nothing is in the way.
                const auto roomAt = [&](Vec3 at) {
                    float room = INFINITY;
                    walls.forNear([&](const Collider& c) {
                        Vec3 normal;
                        room = std::min(room, c.distance(at, normal));
                    });
                    return room - kWallStandoff * spacing;
                };
                float left = f.dt, room = roomAt(x);
                for (int n = 0; n < kSweepMost && left > 0; ++n) {
                    const float speed = length(v);
                    if (!(speed * left > 1e-3f * spacing)) break;
                    float stride = std::min(std::max(room, kSweepStep * spacing), speed * left);
                    const float margin = nearFixed + stride;
                    const bool amongFixed = x.x > held.lower.x - margin && x.x < held.upper.x + margin &&
                                            x.y > held.lower.y - margin && x.y < held.upper.y + margin &&
                                            x.z > held.lower.z - margin && x.z < held.upper.z + margin;
                    if (amongFixed) stride = std::min(stride, kSweepStep * spacing);
                    x += (stride / speed) * v, left -= stride / speed;
                    room = roomAt(x);
                    if (room < 0) {
                        pushOut(walls, kWallStandoff * spacing, x, v);
                        room = 0;
                    }
                    if (!amongFixed) continue;
                    // The nearest of the fixed particles that it approaches; of equals the first in row order.
                    float nearest = nearFixed * nearFixed;
                    Vec3 from;
                    f.neighbors.forCandidates(x, nearFixed, [&](int j) {
                        if (!p.fixed(j)) return;
                        const Vec3 d = x - p.position[static_cast<size_t>(j)].xyz();
                        const float r2 = dot(d, d);
                        if (r2 < nearest && dot(d, v) < 0) nearest = r2, from = d;
                    });
                    if (dot(from, from) > 0) {
                        const float distance = std::sqrt(nearest);
                        const Vec3 normal = (1 / distance) * from;
                        x += (nearFixed - distance) * normal;
                        v -= dot(normal, v) * normal;
                    }
                }
                p.velocity[i].setXyz(v);
            }
            target_[i] = {x.x, x.y, x.z, p.position[i].w};
        }
        sums_[static_cast<size_t>(block)] = sums;
    });
    for (const BlockSums& s : sums_) stats_.velocityClamped |= s.a > 0;

    const PairLists lists(f.neighbors);
    f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int block, int) {
        pairSeparation({lists, target_.data(), image_.data()}, begin, end);
        const int last = std::min(8 * end, p.moverCount);
        BlockSums sums;
        Box around;
        float reach = 0;
        for (int r = 8 * begin; r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            p.position[i].setXyz(target_[i].xyz() + image_[i].xyz());
            around.grow(p.position[i].xyz());
            reach = std::max(reach, p.position[i].w);
        }
        WallFinder walls;
        walls.gather(f.colliders, colliderBounds_.data(), f.colliderCount, around, reach);
        for (int r = 8 * begin; r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            const float standoff = kWallStandoff / kSupport * p.position[i].w;
            Vec3 x = p.position[i].xyz(), v = p.velocity[i].xyz();
            if (!walls.empty()) pushOut(walls, standoff, x, v);
            p.position[i].setXyz(x), p.velocity[i].setXyz(v);
            sums.c = std::max(sums.c, dot(v, v));
        }
        sums_[static_cast<size_t>(block)] = sums;
    });
    float fastest = 0;
    for (const BlockSums& s : sums_) fastest = std::max(fastest, s.c);
    stats_.maxSpeed = std::sqrt(fastest);
}

} // namespace thaw
