// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/tasks.h"
#include "geometry/colliders.h"
#include "neighbors/neighbors.h"
#include "particles/material.h"
#include "particles/particles.h"

namespace thaw {

struct ControlFrame {
    Particles& particles;
    const Neighbors& neighbors; // of the rows as they are
    const Collider* colliders;
    int colliderCount;
    uint64_t wallVersion; // of the colliders and their places
    const Material* materials;
    Tasks& tasks;
    float dt; // s, of the step, or of the sub-step for guide()
    uint64_t step;
    Vec3 gravity;
    float spacing; // m, of level 0
};

// How movers are guided, as MotionFrame has it: guide, unguided, rim and rimVelocity.
struct Guide {
    Vec4 *drag = nullptr, *free = nullptr, *rim = nullptr, *rimVelocity = nullptr;
};

// Places and directions of a control's own space in the world, and back: that of the collider that it moves with
// (index + 1), or the world's (0).
struct OwnSpace {
    const Collider* collider;
    OwnSpace(uint32_t index1, const Collider* colliders) : collider(index1 ? &colliders[index1 - 1] : nullptr) {}
    Vec3 into(Vec3 x) const { return collider ? collider->transform.invert(x) : x; }
    Vec3 out(Vec3 x) const { return collider ? collider->transform.apply(x) : x; }
    Vec3 turn(Vec3 v) const { return collider ? rotate(collider->transform.rotation, v) : v; }
    Vec3 turnInto(Vec3 v) const { return collider ? rotate(conjugate(collider->transform.rotation), v) : v; }
    Vec3 velocityAt(Vec3 x) const { return collider ? collider->velocityAt(x) : Vec3{}; }
};

// How much more a mass weighs for the velocity that a control of this strength asks for, dt in s.
inline float dragOf(float strength, float dt) {
    constexpr float kHint = 15; // 1/s, at strength 1/2
    constexpr float kMost = 16; // beyond, the capped solve no longer finds it
    return strength < 1 ? std::min(kMost, kHint * dt * strength / (1 - strength)) : kMost;
}

} // namespace thaw
