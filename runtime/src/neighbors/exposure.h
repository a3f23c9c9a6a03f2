// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/tasks.h"
#include "geometry/colliders.h"
#include "neighbors/neighbors.h"
#include "particles/particles.h"
#include "particles/reference.h"

namespace thaw {

// Finds which particles are surface: fills Particles::normal (outward unit normal, exposed area in m^2; zero inside)
// and the kSurface flag of every row from the neighbour sums (Neighbors::weigh) and the walls (what rests on a floor is
// not exposed to it). The areas of a body add up to its real surface (within 5 %, tested on sphere, cube and scan).
// Coarse particles of an untouched solid, and fine ones beside them, have the surface of their points in `reference`
// (null: there are none). Returns their number.
int findExposure(Particles& particles, const Neighbors& neighbors, const float* volume, const Collider* colliders,
                 int colliderCount, const Reference* reference, Tasks& tasks);

} // namespace thaw
