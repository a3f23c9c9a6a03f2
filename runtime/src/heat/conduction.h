// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/types.h"
#include "neighbors/neighbors.h"

namespace thaw {

// Share of nominal by which the pair conduction is too strong on the cubic lattice: sum V |W'| / r x^2 / s0 (1.006).
float conductionMoment();

// The pair pass of conduction: per row the sum over neighbours of w_ij (T_i - T_j) with
//   w_ij = g_ij 4 k_i k_j / (k_i + k_j) (1/c_i + 1/c_j) / 2,
// the flux-continuous mean of the conductivities (Cleary and Monaghan 1999), g_ij = V_j W' / (r s0) <= 0 of
// Neighbors::gradient (W' / r needs no regularisation: it is finite at r = 0), and c the filled share of the support:
// a surface particle lacks 17 % of the second moment along the surface and 16 % of c, so that heat runs along a surface
// as fast as inside.
struct ConductionPass {
    const uint32_t* entries;
    const float* gradient;
    const uint32_t* first;
    const uint32_t* width;
    const Vec4* state; // x temperature (any zero point), y conductivity, z half of 1 / c, see kBare; padded, dummies 0
    float* flow;       // per row the sum; padded to groups of 8
    float* weight;     // per row the sum of -w_ij; may be null
};
void conductionPass(const ConductionPass& pass, int beginGroup, int endGroup);

// Particles of level 1 and 2 are bricks of 2 x 1 x 1 and 2 x 2 x 1 fine ones, whose lattices lack 66 % of the second
// moment along the length of the one and 16 % across the thickness of the other. Per entry, the gradient times
// f_i f_j (2 / (f_i^2 + f_j^2))^(1/2) with f = |w| + sign(w) (n . e)^2, e the direction of the pair: the more even one
// of a pair counts for more, since what lies beside a brick samples it as well. (Heat that crosses from level 3 to
// bricks end on: 5 % too much with the plain mean, 3 % too little with the smaller one, 1.5 % with this.)
struct ConductionFactors {
    const uint32_t* entries;
    const float* gradient;
    const uint32_t* first;
    const uint32_t* width;
    const Vec4* position;
    const Vec4* axis; // xyz n, w; padded; w 1 of what needs no factor, and of dummies
    float* out;       // like gradient
};
void conductionFactors(const ConductionFactors& factors, int group);

} // namespace thaw
