// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/hold.h"

#include "base/kernel.h"

namespace thaw {
namespace {

// Touching: the 18 nearest of a cubic lattice (1.41 spacings) are links, the 8 body diagonals (1.73) are not.
constexpr float kLink = 1.5f;
// What sets lies against something: a neighbour of the lattice, or a wall that it stands half a spacing off.
constexpr float kTouch = 1.25f, kWallTouch = 0.8f;
// What has come to rest sets from farther away: as stiff as it is by then, the drag of wall and neighbours stops it
// short.
constexpr float kRestTouch = 1.75f, kRestWallTouch = 1.5f;
constexpr float kAnchor = 1.0f;
// In spacings a step. Nothing sets in flight.
constexpr float kSlow = 0.3f, kRest = 1e-3f;
// Pressure that a setting particle carried goes away over some frames: taken at once, its neighbours fall for a frame.
constexpr float kPressureFade = 0.81f;

bool nearCollider(const HoldFrame& f, Vec3 p, float reach) {
    for (int c = 0; c < f.colliderCount; ++c) {
        if (!f.colliders[c].alive) continue;
        Vec3 n;
        if (f.colliders[c].distance(p, n) < reach) return true;
    }
    return false;
}

template <class F> void forNeighbors(const Neighbors& nb, int i, F&& f) {
    const uint32_t g = static_cast<uint32_t>(i) >> 3, lane = static_cast<uint32_t>(i) & 7;
    const uint32_t* e = nb.entries.data() + nb.first[g] + lane;
    for (uint32_t k = 0; k < nb.width[g]; ++k, e += 8)
        if (!f(*e >> 4)) return;
}

} // namespace

HoldResult Hold::update(const HoldFrame& f) {
    Particles& p = f.particles;
    HoldResult result;
    const uint32_t n = static_cast<uint32_t>(p.count);
    enum : uint8_t { kStay, kRelease, kSet, kReached };
    state_.assign(n, kStay);

    for (uint32_t i = 0; i < n; ++i) {
        const Material& m = f.materials[p.material[i]];
        const float phi = p.liquidFraction[i];
        if (p.flags[i] & kFixed) {
            if (phi > m.def.releaseFraction) state_[i] = kRelease, ++result.released;
            if (p.pressure[i] > 0) p.pressure[i] = p.pressure[i] > 1 ? p.pressure[i] * kPressureFade : 0;
            continue;
        }
        if (phi >= m.def.setFraction) continue;
        const float spacing = p.position[i].w / kSupport;
        const float moved = length(p.velocity[i].xyz()) * f.dt;
        if (moved > kSlow * spacing) continue;
        const bool rests = moved < kRest * spacing;
        const Vec3 x = p.position[i].xyz();
        bool touches = nearCollider(f, x, (rests ? kRestWallTouch : kWallTouch) * spacing);
        if (!touches)
            forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t j) {
                if (j >= n || !(p.flags[j] & kFixed)) return true;
                const float reach = (rests ? kRestTouch : kTouch) * 0.5f * (spacing + p.position[j].w / kSupport);
                Vec3 d = p.position[j].xyz() - x;
                touches = dot(d, d) < reach * reach;
                return !touches;
            });
        if (touches) state_[i] = kSet, ++result.set;
    }

    for (uint32_t i = 0; i < n; ++i) {
        if (state_[i] == kRelease) {
            p.flags[i] = static_cast<uint8_t>(p.flags[i] & ~kFixed);
            p.velocity[i].setXyz({});
            p.velocityChange[i] = {0, 0, 0, kStiffStart};
            p.stiffness[i] = 0;
        } else if (state_[i] == kSet) {
            p.flags[i] |= kFixed;
            p.velocity[i].setXyz({});
            p.velocityChange[i] = {0, 0, 0, 1};
        }
    }

    if (!f.relabel) return result;
    queue_.clear();
    for (uint32_t i = 0; i < n; ++i) {
        if (!(p.flags[i] & kFixed)) continue;
        if (nearCollider(f, p.position[i].xyz(), kAnchor * p.position[i].w / kSupport))
            state_[i] = kReached, queue_.push(i);
    }
    for (size_t head = 0; head < queue_.size(); ++head) {
        const uint32_t i = queue_[head];
        const Vec3 x = p.position[i].xyz();
        const float h = p.position[i].w;
        forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t j) {
            if (j >= n || state_[j] == kReached || !(p.flags[j] & kFixed)) return true;
            float reach = kLink * 0.5f * (h + p.position[j].w) / kSupport;
            Vec3 d = p.position[j].xyz() - x;
            if (dot(d, d) < reach * reach) state_[j] = kReached, queue_.push(j);
            return true;
        });
    }
    for (uint32_t i = 0; i < n; ++i)
        if ((p.flags[i] & kFixed) && state_[i] != kReached) {
            p.flags[i] = static_cast<uint8_t>(p.flags[i] & ~kFixed);
            p.velocity[i].setXyz({});
            p.velocityChange[i] = {0, 0, 0, 1};
            p.stiffness[i] = 0;
            ++result.cutLoose;
        }
    return result;
}

} // namespace thaw
