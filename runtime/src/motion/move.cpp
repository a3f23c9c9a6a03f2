// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/motion.h"
#include "motion/numbers.h"
#include "motion/pairs.h"
#include "motion/rigid_liquid.h"
#include "motion/walls.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

// A particle that moves farther than this many spacings in a step is followed along its way.
constexpr float kSweepFrom = 0.5f, kSweepStep = 0.5f;
// Near walls of any thinness: less than the standoff, so that it never gets to the other half of one.
constexpr float kThinStep = 0.8f * kWallStandoff;
// How near to the centre of a fixed particle its way ends (a square of four leaves a hole of 0.71), from how far off
// they make up a surface, and how often its way may be turned by them in a step.
constexpr float kFixedStandoff = 0.8f, kFixedReach = 1.6f;
constexpr int kSweepMost = 256, kBlockedMost = 4;
// Last resort, far above what a melt does: m/s, and spacings in a step for worlds of other sizes.
constexpr float kSpeedLimit = 30, kSpeedLimitSpacings = 100;

// What walls do to the movers of a block, for those that report. Slots: of Motion, null when none does.
struct Tally {
    const Collider* colliders;
    const int32_t* slots;
    ImpulseSums* sums; // of the block, by slot
    void add(const Collider& c, Vec3 x, float mass, Vec3 change) const {
        if (!slots) return;
        const int32_t slot = slots[&c - colliders];
        if (slot >= 0) sums[slot].add(x - c.transform.position, mass, change);
    }
};

// At a share of the sub-step. start: where the mover was at its begin, about which its walls' impulses count.
void pushOut(const WallFinder& walls, float standoff, float share, const Tally& tally, Vec3 start, float mass, Vec3& x,
             Vec3& v) {
    walls.forNear(
        x, standoff,
        [&](float d, Vec3 normal, const Collider& c) {
            if (d >= standoff) return;
            x += (standoff - d) * normal;
            float into = dot(normal, v);
            if (c.moves) into -= dot(normal, c.velocityAt(x));
            if (!(into < 0)) return;
            v -= into * normal;
            tally.add(c, start, mass, -into * normal);
        },
        share);
}

struct Obstacles {
    const WallFinder& walls;
    const Neighbors& neighbors;
    const Particles& particles;
    const Box& held; // of all fixed particles
    float heldSpeed; // m/s, of the fastest of them

    // Distance to the nearest wall, infinite where none is near.
    float room(const Vec3& x, float share) const {
        float nearest = INFINITY;
        walls.forNear(
            x, INFINITY, [&](float d, Vec3, const Collider&) { nearest = std::min(nearest, d); }, share);
        return nearest;
    }
    bool nearHeld(Vec3 x, float margin) const {
        return x.x > held.lower.x - margin && x.x < held.upper.x + margin && x.y > held.lower.y - margin &&
               x.y < held.upper.y + margin && x.z > held.lower.z - margin && x.z < held.upper.z + margin;
    }
    // Fixed particles around x: how near the nearest is, and the way out of them all. A single one's direction is no
    // normal: between four of a layer it points sideways and the way down is free.
    struct Surface {
        float nearest = INFINITY;
        Vec3 out, velocity;
    };
    // after: s since the begin of the sub-step.
    Surface surface(Vec3 x, float radius, float after) const {
        float weight = 0;
        Surface s;
        neighbors.forFixedCandidates(x, radius, [&](int j) {
            Vec3 d = x - particles.position[static_cast<size_t>(j)].xyz();
            if (heldSpeed > 0) d -= after * particles.velocity[static_cast<size_t>(j)].xyz();
            const float r = length(d);
            if (!(r < radius)) return;
            s.nearest = std::min(s.nearest, r);
            if (r > 0) s.out += ((1 - r / radius) * (1 - r / radius) / r) * d;
            if (heldSpeed > 0)
                s.velocity += (1 - r / radius) * particles.velocity[static_cast<size_t>(j)].xyz(),
                    weight += 1 - r / radius;
        });
        if (weight > 0) s.velocity = (1 / weight) * s.velocity;
        return s;
    }
};

// Moves x by v for `time`, sliding along walls and fixed particles that are in the way or come along; v loses what
// went into them and takes up what they push.
void sweep(const Obstacles& around, const Tally& tally, float spacing, float mass, bool thin, float time, Vec3& x,
           Vec3& v, Vec4* heldKick) {
    const float wallStandoff = kWallStandoff * spacing, standoff = kFixedStandoff * spacing;
    const float radius = kFixedReach * spacing, least = (thin ? kThinStep : kSweepStep) * spacing, whole = time;
    const float wallSpeed = around.walls.motion() / whole;
    const Vec3 start = x;
    float room = around.room(x, 0) - wallStandoff, limit = kSweepStep * spacing;
    Obstacles::Surface here;
    bool known = false; // what `here` says is of x
    for (int n = 0, blocked = 0; n < kSweepMost && time > 0; ++n) {
        const float speed = length(v);
        const bool amongMoving = around.heldSpeed > 0 && around.nearHeld(x, radius + around.heldSpeed * whole);
        const float closing = speed + std::max(wallSpeed, amongMoving ? around.heldSpeed : 0.0f);
        if (!(closing * time > 1e-3f * spacing)) return;
        float stride = std::min(std::max(room, least), closing * time);
        const bool amongFixed = amongMoving || around.nearHeld(x, radius + stride);
        if (amongFixed) stride = std::min(stride, limit);
        const Vec3 to = x + (stride / closing) * v;
        const float after = whole - time + stride / closing;
        if (amongFixed) {
            if (!known) here = around.surface(x, radius, whole - time), known = true;
            const Obstacles::Surface there = around.surface(to, radius, after);
            if (there.nearest < standoff && there.nearest < here.nearest) {
                // Up to it by halves, then on along it.
                if (limit > 0.2f * kSweepStep * spacing) {
                    limit *= 0.5f;
                    continue;
                }
                const Vec3 out = normalizeOr(here.out + there.out, {});
                const float into = dot(out, v - there.velocity);
                if (into < 0) v -= into * out;
                if (into < 0 && heldKick) heldKick->setXyz(heldKick->xyz() - into * out);
                // A corner or a hollow: it stays.
                if (++blocked == kBlockedMost || !(into < -1e-3f * closing)) {
                    const Vec3 away = normalizeOr(there.out, {});
                    const Vec3 stop = -std::min(0.0f, dot(away, v - there.velocity)) * away;
                    v += stop;
                    if (heldKick) heldKick->setXyz(heldKick->xyz() + stop);
                    if (around.heldSpeed > 0) x += time * there.velocity; // where what it lies in goes
                    return;
                }
                limit = kSweepStep * spacing;
                continue;
            }
            here = there;
        }
        known = amongFixed, limit = kSweepStep * spacing;
        x = to, time -= stride / closing;
        const float share = 1 - time / whole;
        room = around.room(x, share) - wallStandoff;
        if (room < 0) pushOut(around.walls, wallStandoff, share, tally, start, mass, x, v), room = 0, known = false;
    }
}

} // namespace

void Motion::move(const MotionFrame& f) {
    Particles& p = f.particles;
    if (f.rigid) f.rigid->decide(f);
    if (p.moverCount == 0) {
        if (f.rigid) f.rigid->advance(f);
        return;
    }
    const float heldSpeed = f.rigid ? std::max(f.heldSpeed, f.rigid->fastest()) : f.heldSpeed;

    const Box nothing; // springs keep solids apart
    Box held;
    for (int r = p.moverCount; r < p.count; ++r) held.grow(p.position[static_cast<size_t>(r)].xyz());
    const float limit = std::max(kSpeedLimit, kSpeedLimitSpacings * f.spacing / f.dt);
    const auto tallyOf = [&](int block) {
        return Tally{f.colliders, reporting_ ? reportSlot_.data() : nullptr,
                     reporting_ ? &reports_[static_cast<size_t>(block) * reporters_] : nullptr};
    };

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
        const bool thin = thinWalls_ && !walls.empty();
        const float sweepFrom = thin ? kThinStep : kSweepFrom, wallWay = walls.motion() + f.dt * heldSpeed;
        const Tally tally = tallyOf(block);

        for (int r = 8 * begin; r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            const float spacing = p.position[i].w / kSupport;
            Vec3 x = p.position[i].xyz(), v = p.velocity[i].xyz();
            const Vec3 way = f.dt * v;
            const float far = std::max(0.0f, sweepFrom * spacing - wallWay);
            if (!(dot(way, way) > far * far)) {
                x += way;
            } else {
                RigidLiquid::Near* piece = f.coupling ? f.coupling->near(i) : nullptr;
                Vec4 kick;
                sweep(Obstacles{walls, f.neighbors, p, p.bondSlot[i] ? nothing : held, heldSpeed}, tally, spacing,
                      p.velocity[i].w, thin, f.dt, x, v, reporting_ || piece ? &kick : nullptr);
                if (reporting_) heldKick_[i].setXyz(heldKick_[i].xyz() + kick.xyz());
                if (piece) piece->impulse -= p.velocity[i].w * kick.xyz();
                p.velocity[i].setXyz(v);
            }
            target_[i] = {x.x, x.y, x.z, p.bondSlot[i] ? -p.position[i].w : p.position[i].w};
        }
        sums_[static_cast<size_t>(block)] = sums;
    });
    for (const BlockSums& s : sums_) stats_.velocityClamped |= s.a > 0;
    if (f.rigid) {
        if (f.coupling->any()) f.coupling->pushSwept(f);
        f.rigid->advance(f);
        for (int r = p.moverCount; r < p.count; ++r) {
            const size_t i = static_cast<size_t>(r);
            if (p.piece[i]) target_[i].setXyz(p.position[i].xyz());
        }
    }

    const PairLists lists(f.neighbors);
    f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int block, int) {
        pairSeparation({lists, target_.data(), image_.data()}, begin, end);
        const int last = std::min(8 * end, p.moverCount);
        const Tally tally = tallyOf(block);
        BlockSums sums;
        Box around;
        float reach = 0;
        for (int r = 8 * begin; r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            Vec3 apart = p.bondSlot[i] ? Vec3{} : image_[i].xyz();
            if (thinWalls_) {
                const float most = kThinStep / kSupport * std::abs(target_[i].w), l = length(apart);
                if (l > most) apart = (most / l) * apart;
            }
            p.position[i].setXyz(target_[i].xyz() + apart);
            around.grow(p.position[i].xyz());
            reach = std::max(reach, p.position[i].w);
        }
        WallFinder walls;
        walls.gather(f.colliders, colliderBounds_.data(), f.colliderCount, around, reach);
        for (int r = 8 * begin; r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            const float standoff = kWallStandoff / kSupport * p.position[i].w;
            Vec3 x = p.position[i].xyz(), v = p.velocity[i].xyz();
            const Vec3 start{point_[i].x, point_[i].y, point_[i].z};
            if (!walls.empty()) pushOut(walls, standoff, 1, tally, start, p.velocity[i].w, x, v);
            p.position[i].setXyz(x), p.velocity[i].setXyz(v);
            for (size_t c = i * kContacts, n = c + contactCount_[i]; reporting_ && c < n; ++c)
                if (contactOf_[c] != kRim)
                    tally.add(f.colliders[contactOf_[c]], start, p.velocity[i].w, kick_[c].xyz());
            sums.c = std::max(sums.c, dot(v, v));
        }
        sums_[static_cast<size_t>(block)] = sums;
    });
    reportHeldKicks(f);
    returnSpin(f);
    float fastest = 0;
    for (const BlockSums& s : sums_) fastest = std::max(fastest, s.c);
    stats_.maxSpeed = std::sqrt(fastest);
    if (bonded_) f.bonds->relax(f.bondFrame());
}

} // namespace thaw
