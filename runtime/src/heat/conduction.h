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

} // namespace thaw
