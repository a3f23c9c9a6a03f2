// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "motion/pairs.h"

namespace thaw {

// Springs between pairs of the neighbour lists, for the movers of groups that are on (Bonds): backward Euler along each
// spring is its force now and dt^2 k / r^2 more in the viscous coefficient of its pair.
struct BondPass {
    PairLists lists;
    const Vec4* position;
    const Vec4* trait;      // z mass
    const uint8_t* groupOn; // per group
    const float* stiffness; // per entry, N/m; 0: none
    const float* rest;      // per entry, m
    float dt;
    // Added to, as pairForces wrote them.
    Vec4* change;
    Vec4* diagonal;
    Vec4* cross;
    float* coefficient;
};
// A spring pressed by more than this share of its length pushes no harder: what is turned inside out must find back.
inline constexpr float kMostPress = 0.3f;
void pairSprings(const BondPass& p, int begin, int end);

} // namespace thaw
