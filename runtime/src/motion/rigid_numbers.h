// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

// Numbers of rigid pieces (BAKEOFF2 B1: measured at one step of 1/60 s, spacing 2 and 4 mm).
namespace thaw {

// A piece of fewer particles goes on as a lump of the material's solid viscosity: those of 4 in a melting stump spin at
// 300 rad/s and hit the floor's film so that 400 drops fly, up to 1 m; with 20 none does under 30 sources of 30.
inline constexpr size_t kLeastPiece = 20;

// 1, Coulomb, of solid on solid; colliders have their own.
inline constexpr float kFriction = 0.5f;
// What may touch within the step is a contact before it does (without: 5-11 spacings of penetration): so many spacings
// beyond what both can move. Of a curved wall, the normal at the nearest point is good this far.
inline constexpr double kContactMargin = 1, kCurvedMargin = 2;
// Of a support, filled by another solid: below, it does not touch.
inline constexpr double kLeastFilled = 0.005;
// Points of a face that are kept: all of them and 20 sweeps, and a flat drop sinks in by 1.4 spacings.
inline constexpr size_t kFacePoints = 17;

// 20 sweeps let a stack at 2 mm creep by 0.2 spacings, 40 do not. While the liquid solve runs as well: what the pieces
// have left there the liquid takes for motion, and with 4 two blocks on each other in a pool were at 400 rad/s within
// 11 steps. There they end when no impulse changes by more than that share of the largest any more.
inline constexpr int kSweeps = 40, kSweepsAfter = 10, kSweepsBetween = 40;
inline constexpr double kSolved = 1e-4;
// Share of a penetration beyond the slop that is taken back in a step, and the most, both in spacings.
inline constexpr double kRecover = 0.2, kSlop = 0.005, kRecoverMost = 0.2;

// A piece slower than this for so many steps, with something under it, sleeps.
inline constexpr double kCalmSpeed = 0.005; // m/s
inline constexpr int kCalmSteps = 30;
// Share of its weight by which the push on it has to change to wake it.
inline constexpr double kWakeShare = 0.1;

// What goes farther than this in a step toward a wall, or toward a solid, is followed along its way, and stops so far
// short of a wall that it would hit; in spacings.
inline constexpr double kFollowFrom = 1, kStopShort = 1;
inline constexpr float kFollowSolidFrom = 0.25f;
// What turns by more than this in a step, rad, comes into a wall by no more than so many spacings.
inline constexpr double kFollowTurn = 0.1, kTurnIn = 0.1;

} // namespace thaw
