// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/colliders.h"
#include "particles/particles.h"
#include "particles/reference.h"

// What is held goes where its collider goes, rigidly.
namespace thaw {

// A collider that is told apart from the rest: particles know that they hang on it.
inline bool toldApart(const Collider& c) { return c.alive && (c.kinematic || c.report); }

// Before a sub-step of dt s: gives the fixed rows the velocity of what they hang on, and the reporting colliders the
// weight and inertia of what hangs on them. Returns the speed of the fastest, m/s.
float beginCarry(Particles& particles, Collider* colliders, int colliderCount, Vec3 gravity, float dt);
// After it: their new places.
void endCarry(Particles& particles, Reference& reference, const Collider* colliders, int colliderCount);

} // namespace thaw
