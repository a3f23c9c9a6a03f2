// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/kernel.h"
#include "motion/bonds.h"
#include "motion/hold.h"
#include "motion/links.h"
#include "motion/numbers.h"
#include "motion/rigid.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

// Spacings: what sets lies as near to a solid as this, and moves against it by less than so much a step.
constexpr float kTouch = 1.25f, kDrift = 0.1f;
constexpr int kApproachMost = 4, kPieceApproachMost = 12; // sub-steps

} // namespace

// Whether a particle that is cold enough lies calmly against something solid, or something that sets with it.
bool Bonds::findTouch(const BondFrame& f, uint32_t row) const {
    const Particles& p = f.particles;
    const Vec4 x = p.position[row];
    bool touches = false;
    forNeighbors(f.neighbors, static_cast<int>(row), [&](uint32_t j) {
        if (j >= static_cast<uint32_t>(p.count)) return false;
        if (!p.bondSlot[j] && !(p.flags[j] & kFixed) && state_[j] != kSets) return true;
        const float d = 0.5f * (x.w + p.position[j].w) / kSupport;
        const Vec3 to = p.position[j].xyz() - x.xyz();
        if (dot(to, to) > kTouch * kTouch * d * d) return true;
        touches = length(p.velocity[j].xyz() - p.velocity[row].xyz()) * f.dt < kDrift * d;
        return !touches;
    });
    return touches;
}

// Bonds of the rows that state_ marks as setting, with everything solid around them.
void Bonds::bondRows(const BondFrame& f, BondResult& result) {
    Particles& p = f.particles;
    const uint32_t n = static_cast<uint32_t>(p.count);
    reserve(p.capacity);
    for (uint32_t i = 0; i < n; ++i)
        if (state_[i] == kSets && !p.bondSlot[i]) take(p, i), ++result.set;
    for (uint32_t i = 0; i < n; ++i) {
        if (state_[i] != kSets) continue;
        forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t j) {
            if (j >= n) return false;
            if (state_[j] == kSets && j > i) return true; // its turn comes
            if (!p.bondSlot[j] && !(p.flags[j] & kFixed)) return true;
            const float d = 0.5f * (p.position[i].w + p.position[j].w) / kSupport;
            const float r = length(p.position[j].xyz() - p.position[i].xyz());
            if (!(r < kReach * d) || !(r > 0)) return true;
            if (!p.bondSlot[j]) calm_[take(p, j)] = 1;
            connect(p.bondSlot[i], p.bondSlot[j], r, p.level[i] | p.level[j] ? kMostMixed : kMost);
            return true;
        });
    }
    for (uint32_t i = 0; i < n; ++i)
        if (const uint32_t slot = p.bondSlot[i]; slot && touched_[slot]) refill(p, f.volume[i], slot);
}

BondResult Bonds::bondAll(const BondFrame& f) {
    Particles& p = f.particles;
    BondResult result;
    reserve(p.capacity);
    mapRows(p);
    for (size_t i = 0; i < static_cast<size_t>(p.count); ++i) {
        const Material& m = f.materials[p.material[i]];
        const bool sets = !p.bondSlot[i] && m.soft() && p.liquidFraction[i] < m.def.releaseFraction;
        state_[i] = sets ? kSets : kStay;
    }
    bondRows(f, result);
    return result;
}

// Sub-steps so that bodies that fall on each other come nearer by a spacing in each: by their boxes and mean
// velocities. What a rigid piece falls in a sub-step from rest counts too: its springs hold it against the gravity of
// now, which the lists do not know of.
int Bonds::subStepsWanted(const Particles& p, float dt, Vec3 gravity, float spacing, int limit) const {
    if (live_ == 0 || p.moverCount == 0) return 1;
    struct Crowd { // what has bonds of a body, or is in pieces
        Box box;
        Vec3 velocity; // summed
        float count = 0;
        bool soft = false, moves = false;
    };
    constexpr size_t kBodies = 64;
    Crowd crowd[kBodies];
    for (size_t i = 0; i < static_cast<size_t>(p.count); ++i) {
        if ((!p.bondSlot[i] && !p.piece[i]) || p.body[i] >= kBodies) continue;
        Crowd& c = crowd[p.body[i]];
        const Vec3 v = p.velocity[i].xyz();
        c.box.grow(p.position[i].xyz()), c.velocity += v, c.count += 1;
        c.soft |= p.bondSlot[i] != 0;
        c.moves |= p.piece[i] ? dot(v, v) > 0 : i < static_cast<size_t>(p.moverCount); // pieces asleep have none at all
    }
    int wanted = 1;
    for (size_t a = 0; a < kBodies; ++a)
        for (size_t b = 0; b < a; ++b) {
            const Crowd &x = crowd[a], &y = crowd[b];
            if (x.count == 0 || y.count == 0 || !(x.soft || y.soft)) continue;
            const Vec3 way = dt * ((1 / x.count) * x.velocity - (1 / y.count) * y.velocity);
            const float near = spacing + length(way);
            if (x.box.lower.x - y.box.upper.x > near || y.box.lower.x - x.box.upper.x > near ||
                x.box.lower.y - y.box.upper.y > near || y.box.lower.y - x.box.upper.y > near ||
                x.box.lower.z - y.box.upper.z > near || y.box.lower.z - x.box.upper.z > near)
                continue;
            const bool piece = !x.soft || !y.soft;
            const float fall = piece && x.moves && y.moves ? dt * dt * length(gravity) / spacing : 0;
            const float approach = length(way) / (spacing * kApproachPerStep);
            const int most = piece ? kPieceApproachMost : kApproachMost;
            int n = 1;
            while (n < most && approach / static_cast<float>(n) + fall / static_cast<float>(n * n) > 1) ++n;
            wanted = std::max(wanted, n);
        }
    return std::min(wanted, limit);
}

BondResult Bonds::update(const BondFrame& f) {
    Particles& p = f.particles;
    BondResult result;
    const size_t n = static_cast<size_t>(p.count);
    ++steps_;
    mapRows(p);
    bool setting = false;
    if (state_.size() < n) state_.resizeRaw(static_cast<size_t>(p.capacity) + 1);
    for (size_t i = 0; i < n; ++i) {
        const Material& m = f.materials[p.material[i]];
        state_[i] = kStay;
        if (const uint32_t slot = p.bondSlot[i]) {
            if (!(p.liquidFraction[i] > m.def.releaseFraction)) continue;
            drop(slot);
            p.bondSlot[i] = 0;
            ++result.released;
            if (p.fine[i]) {
                p.fine[i] = 0;
                // What it covered may be bare from now on, whatever the reference says.
                forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t j) {
                    if (j >= n) return false;
                    if (p.level[j] == 0) p.fine[j] = 0;
                    return true;
                });
            }
            p.anchor[i] = 0;
            p.flags[i] = static_cast<uint8_t>(p.flags[i] & ~(kFixed | kAsleep));
            if (!(p.velocityChange[i].w > 0))
                p.velocityChange[i] = {0, 0, 0,
                                       stiffStart(m.viscosity(p.liquidFraction[i]), m.def.density,
                                                  p.position[i].w / kSupport, p.pressure[i])};
            p.stiffness[i] = 0;
        } else if (m.soft() && p.liquidFraction[i] < m.def.setFraction) {
            state_[i] = kSets, setting = true;
        }
    }
    if (setting) {
        setting = false;
        for (size_t i = 0; i < n; ++i)
            if (state_[i] == kSets && !(p.flags[i] & kFixed) && !findTouch(f, static_cast<uint32_t>(i)))
                state_[i] = kStay;
            else
                setting |= state_[i] == kSets;
    }
    if (setting)
        bondRows(f, result);
    else if (result.released)
        for (uint32_t s = 1; s < rowOf_.size(); ++s)
            if (calm_[s] && touched_[s]) refill(p, f.volume[rowOf_[s]], s);
    if (live_ == 0) return result;
    colliderBounds_.resizeRaw(static_cast<size_t>(f.colliderCount));
    for (int c = 0; c < f.colliderCount; ++c)
        if (f.colliders[c].alive) colliderBounds_[static_cast<size_t>(c)] = f.colliders[c].bounds();
    settle(f, result);
    return result;
}

} // namespace thaw
