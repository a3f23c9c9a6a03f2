// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/kernel.h"

#include <algorithm>

// Numbers of the motion solve, with where they come from (BAKEOFF: measured at one step of 1/60 s, spacing 2 and 4 mm).
namespace thaw {

// Groups of 8 rows per task. Fixed, because sums are taken block by block.
inline constexpr int kBlock = 32;
// m/s^2, the unit of cohesion and adhesion: they are properties of the material, whatever the world's gravity.
inline constexpr float kGravity = 9.81f;

// Jacobi coefficient at most this many times the bulk value; warm pressure rescaled where the density error is below.
// That only ever takes pressure away, and melt that a sinking piece drives along loses more by it than the iterations
// give: so beside pieces only what is not compressed is rescaled. Butter after 3.5 s in a pan, 4 iterations: mean
// compression 8.1 % with 0.3 there as well, 1.9 % so.
inline constexpr float kStiffnessCap = 2, kRescaleBelow = 0.3f, kRescaleBesidePiece = 0;

// Adhesion acts from half a spacing to 4 (fading over the last 1.1): farther than a film is thick, or what leaves it
// never comes back (33-69 % lost at the support's 2.2).
inline constexpr float kAdhesionFrom = 0.5f, kAdhesionReach = 4, kAdhesionFade = 1.1f;
// A wall whose normal is within this cosine of straight up is a floor: nothing hangs on it.
inline constexpr float kFloorCosine = 0.7f;

// A wall whose half is thinner than this many spacings is one that a particle could be pushed out of on the wrong side.
inline constexpr float kThinWall = 0.5f;

// Of the pressure that a particle carried when it set is left after a step: taken at once, its neighbours fall for a
// frame.
inline constexpr float kPressureFade = 0.81f;

// Sub-steps: k = sqrt(G / kDepthPerStep), and so many spacings of travel in each.
inline constexpr float kDepthPerStep = 15, kApproachPerStep = 1;

// What would run into a wall farther than this many spacings in a step lands: see Motion::land.
inline constexpr float kLandingFrom = 0.3f;

// Share of the density error taken back in a step. Feedback adds the velocity error / dt, so it falls with dt.
inline float densityFeedback(int subSteps) { return subSteps <= 2 ? 0.3f : subSteps == 3 ? 0.2f : 0.1f; }
inline float jacobiWeight(int subSteps) { return subSteps <= 3 ? 0.4f : 0.25f; }
// Under pressure P a liquid is at least as viscous as fold P dt: the geometry is frozen, and without it pressure
// directions are unstable above P dt^2 / (rho dx^2) of about 1. The root of the squares of that and its own: with the
// sum films of 5 Pa s run 12 % slow.
inline float pressureFold(int subSteps) { return subSteps <= 2 ? 0.5f : 1.0f; }

// Pa s. What moves faster than the geometry can follow is held together by this much at least. Measured on a solid that
// melts under liquid of 0.02 Pa s, fastest over free fall at 2 / 4 mm: 0 gives 0.79 / 0.82, 0.15 0.77 / 0.79, 0.3 0.77
// / 0.78, 0.6 0.73 / 0.62. (Before fixed particles were one surface, 0 gave 0.78 / 2.35.) Beads at 0.1 Pa s compress by
// 10 % instead of 5 % with less than 0.6.
inline float apparentFloor(float density, float spacing, float stepTime, float speed) {
    constexpr float kFloor = 0.3f, kMoving = 0.25f;
    const float moved = speed * stepTime / spacing;
    return kFloor * density * spacing * spacing / stepTime * std::min(1.0f, moved / kMoving);
}

// Viscous pairs with what is held count so often: it mirrors the velocity (held.cpp). Of a linear shear between layers
// of a lattice, pairs with rows that stand still carry half, whatever the kernel.
inline constexpr float kHeldDrag = 2;

} // namespace thaw
