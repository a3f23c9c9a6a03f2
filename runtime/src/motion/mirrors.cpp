// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// A wall is met as the mirror of the layer before it. Among liquids of one density every particle may take itself for
// that layer. Beside a liquid of another density it must not: its own pressure balances its own weight, whatever its
// neighbours', so that nothing lifts what is light off a floor, and its mirror moves away from it when it does rise,
// which takes that pressure too. There the mirror of a particle is that of its neighbours along the wall: their mean
// distance, their mean velocity in the divergence and, as the adjoint of that, their shares of its pressure.
//
// Of 1000 light and 1000 heavy particles side by side in a tank 10 cells by 20, 0.05 / 0.5 Pa s, so many of the light
// are in the layer on the floor after 10 s: 94 / 94 with own mirrors, and for good. With the neighbours' mean pressure
// alone 42 / 43 and 0.4 % mean compression, for it boils (16 % with all of it); with the mirrors of here everywhere 7 /
// 6 and 0.4 / 0.25 %, and 5 / 2 mm/s that do not calm down; with them beside unlike liquids 1 / 0 and 0.1 %.
#include "base/kernel.h"
#include "motion/motion.h"
#include "motion/numbers.h"
#include "motion/walls.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

// A particle's own mirror counts as much among them as a neighbour one spacing away; 0 leaves twice the compression, 4
// the light ones where they are.
float ownWeight(float volume, float h) {
    constexpr float kRoom = 1 - 1 / kSupport, kShape = kWendlandGradient * kRoom * kRoom * kRoom;
    return volume * kShape / (h * h * h * h * h * latticeSum());
}
// From this share of unlike neighbours on it is all theirs: 1/2 leaves a quarter of the light ones after 10 s, from any
// on compression is three times as much.
constexpr float kUnlikeFrom = 0.125f;

} // namespace

void Motion::findUnlike(const MotionFrame& f) {
    float least = INFINITY, most = 0;
    for (int r = 0; r < f.particles.moverCount; ++r) {
        const float v = f.invDensity[static_cast<size_t>(r)];
        least = std::min(least, v), most = std::max(most, v);
    }
    unlike_ = least < most;
    if (!unlike_) return;
    mirror_.assign(static_cast<size_t>(8 * f.neighbors.moverGroups), {});
    mirrorChange_.assign(static_cast<size_t>(8 * f.neighbors.moverGroups), 0);
}

// Calls body(j, a) for the movers j that stand along the wall with i, itself too; a is symmetric.
template <class F> void Motion::forMirrors(const MotionFrame& f, size_t i, F&& body) const {
    const Particles& p = f.particles;
    const Vec3 wall = wallGradient_[i].xyz();
    if ((wall.x == 0 && wall.y == 0 && wall.z == 0) || p.bondSlot[i]) return;
    body(i, f.volume[i] * ownWeight(f.volume[i], p.position[i].w) * dot(wall, wall));
    const size_t first = f.neighbors.first[i >> 3] + (i & 7);
    for (uint32_t k = 0; k < f.neighbors.width[i >> 3]; ++k) {
        const size_t entry = first + 8 * static_cast<size_t>(k), j = f.neighbors.entries[entry] >> 4;
        if (j >= static_cast<size_t>(p.moverCount)) break; // ascending
        if (p.bondSlot[j]) continue;
        const float along = dot(wall, wallGradient_[j].xyz());
        if (along > 0) body(j, -f.volume[i] * f.neighbors.gradient[entry] * along);
    }
}

// How much of a mover's mirror is its neighbours', 0..1.
float Motion::unlikeness(const MotionFrame& f, size_t i) const {
    const size_t movers = static_cast<size_t>(f.particles.moverCount);
    const size_t first = f.neighbors.first[i >> 3] + (i & 7);
    float unlike = 0, all = 0;
    for (uint32_t k = 0; k < f.neighbors.width[i >> 3]; ++k) {
        const size_t entry = first + 8 * static_cast<size_t>(k), j = f.neighbors.entries[entry] >> 4;
        if (j >= movers) break;
        const float w = -f.neighbors.gradient[entry];
        all += w, unlike += f.invDensity[j] == f.invDensity[i] ? 0.0f : w;
    }
    return all > 0 ? std::min(1.0f, unlike / (kUnlikeFrom * all)) : 0.0f;
}

// From the wall to half way between a mover and its mirror.
float Motion::mirrorDistance(const MotionFrame& f, size_t i, size_t contact) const {
    const Particles& p = f.particles;
    const float own = contact_[contact].w, h = p.position[i].w, share = mirror_[i].unlike;
    if (own >= h || share == 0) return own;
    const size_t first = f.neighbors.first[i >> 3] + (i & 7);
    float weight = ownWeight(f.volume[i], h) * firstLayer(own / h * kSupport), sum = weight * own;
    for (uint32_t k = 0; k < f.neighbors.width[i >> 3]; ++k) {
        const size_t entry = first + 8 * static_cast<size_t>(k), j = f.neighbors.entries[entry] >> 4;
        if (j >= static_cast<size_t>(p.moverCount)) break;
        if (p.bondSlot[j]) continue;
        for (size_t c = j * kContacts, n = c + contactCount_[j]; c < n; ++c) {
            if (contactOf_[c] != contactOf_[contact]) continue;
            const float w = -f.neighbors.gradient[entry] * firstLayer(contact_[c].w / p.position[j].w * kSupport);
            sum += w * contact_[c].w, weight += w;
        }
    }
    return weight > 0 ? own + 0.5f * share * (sum / weight - own) : own;
}

void Motion::weighMirrors(const MotionFrame& f) {
    f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int, int) {
        for (int r = 8 * begin, last = std::min(8 * end, f.particles.moverCount); r < last; ++r) {
            Mirror& m = mirror_[static_cast<size_t>(r)];
            float sum = 0;
            if (m.unlike > 0) forMirrors(f, static_cast<size_t>(r), [&](size_t, float a) { sum += a; });
            m.share = sum > 0 ? 0.5f * m.unlike / sum : 0, m.own = sum > 0 ? 0.5f * m.unlike : 0;
        }
    });
}

// What the mirror's way changes of the density error of a step, beyond that of the particle itself.
void Motion::moveMirrors(const MotionFrame& f, int begin, int end) {
    const Vec4* velocity = f.particles.velocity.data();
    for (int r = 8 * begin, last = std::min(8 * end, f.particles.moverCount); r < last; ++r) {
        const size_t i = static_cast<size_t>(r);
        const Mirror& m = mirror_[i];
        if (m.share == 0) continue;
        Vec3 way = -m.own * velocity[i].xyz();
        forMirrors(f, i, [&](size_t j, float a) { way += (m.share * a) * velocity[j].xyz(); });
        mirrorChange_[i] = f.dt * dot(wallGradient_[i].xyz(), way);
    }
}

// Calls body(j, k) with what wall gradients of neighbours j, times these pressures, push i, beyond its own.
template <class F> void Motion::forMirrorPush(const MotionFrame& f, size_t i, F&& body) const {
    if (mirror_[i].own > 0) body(i, -mirror_[i].own);
    forMirrors(f, i, [&](size_t j, float a) {
        if (mirror_[j].share > 0) body(j, a * mirror_[j].share * f.volume[j] / f.volume[i]);
    });
}

// The change of velocity by this.
Vec3 Motion::pushMirrors(const MotionFrame& f, size_t i, const Vec4* pressure) const {
    Vec3 sum;
    forMirrorPush(f, i, [&](size_t j, float k) { sum += (k * pressure[j].w) * wallGradient_[j].xyz(); });
    return (-f.dt * f.invDensity[i]) * sum;
}

// The same as impulses on the walls: where the particle has a wall of a neighbour's collider, to that.
void Motion::reportMirrors(const MotionFrame& f, size_t i) {
    const size_t first = i * kContacts, own = first + contactCount_[i];
    if (first == own) return;
    forMirrorPush(f, i, [&](size_t j, float k) {
        const float push = f.dt * f.invDensity[i] * k * f.particles.pressure[j];
        for (size_t c = j * kContacts, n = c + contactCount_[j]; c < n; ++c) {
            size_t to = first;
            for (size_t o = first; o < own; ++o)
                if (contactOf_[o] == contactOf_[c]) to = o;
            kick(to, -(push * contactSlope_[c]) * contact_[c].xyz());
        }
    });
}

} // namespace thaw
