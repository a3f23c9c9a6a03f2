// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// The walls near each mover, and what they add to its density.
#include "base/kernel.h"
#include "motion/motion.h"
#include "motion/numbers.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

struct Contact {
    Vec3 normal;
    float distance;
    bool adhesive;
    uint16_t collider;
};

// How many particles the layer behind a curved wall has of that before it: two layers half a spacing before and behind
// the face of a ball differ in their areas. Without this a ball of 3.75 spacings floats as if it were 13 % larger.
float bendOf(const Collider& c, float spacing) {
    if (c.type != thawCollider_sphere) return 1;
    const float inner = std::max(0.0f, c.size.x - 0.5f * spacing) / (c.size.x + 0.5f * spacing);
    return inner * inner;
}

// Keeps the nearest, nearest first; of equals the one that came first.
void keep(const Contact& k, Contact (&out)[Motion::kContacts], int& n) {
    int at = n < Motion::kContacts ? n++ : n;
    if (at == Motion::kContacts && !(k.distance < out[--at].distance)) return;
    for (; at > 0 && k.distance < out[at - 1].distance; --at) out[at] = out[at - 1];
    out[at] = k;
}

// The nearest walls in reach.
int findContacts(const WallFinder& walls, const Collider* colliders, Vec3 p, float reach,
                 Contact (&out)[Motion::kContacts]) {
    int n = 0;
    walls.forNear(p, reach, [&](float distance, Vec3 normal, const Collider& c) {
        // What comes near within the sub-step is met now.
        if (!(distance < reach) && !(c.moves && distance - dot(normal, c.displacement(p)) < reach)) return;
        keep({normal, distance, c.adhesive, static_cast<uint16_t>(&c - colliders)}, out, n);
    });
    return n;
}

} // namespace

// Into contact_ and what goes with it, and landing_; the block's sum b counts what lands.
void Motion::findWalls(const MotionFrame& f, int begin, int end, int block) {
    const Particles& p = f.particles;
    const int last = std::min(8 * end, p.moverCount);
    Box around;
    float reach = 0;
    for (int r = 8 * begin; r < last; ++r) {
        const Vec4 x = p.position[static_cast<size_t>(r)];
        around.grow(x.xyz());
        const float way = f.dt * length(p.velocity[static_cast<size_t>(r)].xyz());
        reach = std::max({reach, std::max(1.0f, kAdhesionReach / kSupport) * x.w, x.w + way});
    }
    WallFinder walls;
    walls.gather(f.colliders, colliderBounds_.data(), f.colliderCount, around, reach);
    for (int r = 8 * begin; r < last; ++r) {
        const size_t i = static_cast<size_t>(r);
        const Vec3 x = p.position[i].xyz();
        const float h = p.position[i].w, spacing = h / kSupport;

        landing_[i].w = INFINITY;
        // Without the gravity of this step, which what rests on the wall has too.
        const Vec3 way = f.dt * p.velocity[i].xyz();
        const float fast = kLandingFrom * spacing / static_cast<float>(f.subSteps);
        if (dot(way, way) > fast * fast && !walls.empty())
            walls.forNear(x, length(way) + spacing, [&](float distance, Vec3 normal, const Collider& c) {
                if (c.moves) return; // asks for sub-steps
                const float into = -dot(normal, way);
                if (!(into > fast && distance - into < 0.5f * spacing)) return;
                if (landing_[i].w == INFINITY) sums_[static_cast<size_t>(block)].b += 1;
                if (!(distance < landing_[i].w)) return;
                landing_[i] = {normal.x, normal.y, normal.z, distance};
                landingOn_[i] = static_cast<uint16_t>(&c - f.colliders);
            });

        Contact found[kContacts];
        const float far = std::max(1.0f, kAdhesionReach / kSupport) * h;
        int n = walls.empty() ? 0 : findContacts(walls, f.colliders, x, far, found);
        if (rims_ && f.rim[i].w < h) keep({f.rim[i].xyz(), f.rim[i].w, false, kRim}, found, n);
        contactCount_[i] = static_cast<uint8_t>(n);
        for (int k = 0; k < n; ++k) {
            const size_t c = i * kContacts + static_cast<size_t>(k);
            contact_[c] = {found[k].normal.x, found[k].normal.y, found[k].normal.z, found[k].distance};
            contactAdhesive_[c] = found[k].adhesive, contactOf_[c] = found[k].collider;
            if (!wallsMove_) continue;
            const Vec3 rim = rims_ && f.rimVelocity ? f.rimVelocity[i].xyz() : Vec3{};
            const Vec3 u = found[k].collider == kRim ? rim : f.colliders[found[k].collider].velocityAt(x);
            wallVelocity_[c] = {u.x, u.y, u.z, 0};
        }
    }
}

// Share of the support of a mover inside the walls and its gradient; overlapping walls by the product rule.
void Motion::weighWalls(const MotionFrame& f, size_t i, float& fraction, Vec3& gradient) {
    const WallTable& table = wallTable();
    const float h = f.particles.position[i].w;
    const size_t first = i * kContacts;
    const int n = contactCount_[i];
    float share[kContacts], slope[kContacts], open = 1;
    for (int k = 0; k < n; ++k) {
        const size_t c = first + static_cast<size_t>(k);
        const float distance = unlike_ ? mirrorDistance(f, i, c) : contact_[c].w, q = std::max(-1.0f, distance / h);
        const bool rim = contactOf_[c] == kRim;
        const float bend = !(q < 1) ? 0 : rim ? 1 : bendOf(f.colliders[contactOf_[c]], h / kSupport);
        share[k] = q < 1 ? bend * WallTable::lookup(table.mirrored, q) : 0;
        slope[k] = q < 1 ? -bend * WallTable::lookup(table.mirroredGradient, q) / h : 0;
        open *= 1 - share[k];
    }
    gradient = {};
    for (int k = 0; k < n; ++k) {
        float others = slope[k];
        for (int l = 0; l < n && others != 0; ++l)
            if (l != k) others *= 1 - share[l];
        if (others != 0) gradient += others * contact_[first + static_cast<size_t>(k)].xyz();
        if (kicks() || wallsMove_) contactSlope_[first + static_cast<size_t>(k)] = others;
    }
    fraction = 1 - open;
}

} // namespace thaw
