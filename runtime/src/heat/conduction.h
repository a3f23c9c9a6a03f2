// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/types.h"
#include "neighbors/neighbors.h"

namespace thaw {

// Share of nominal by which the pair conduction is too strong on the cubic lattice: sum V |W'| / r x^2 / s0 (1.006).
float conductionMoment();

// The pair pass of conduction: per row the sum over neighbours of g_ij 4 k_i k_j / (k_i + k_j) (T_i - T_j), where
// g_ij = V_j W' / (r s0) <= 0 is Neighbors::gradient. W' / r needs no regularisation: it is finite at r = 0.
struct ConductionPass {
    const uint32_t* entries;
    const float* gradient;
    const uint32_t* first;
    const uint32_t* width;
    const Vec4* state; // x temperature (any zero point), y conductivity; padded, dummies 0
    float* flow;       // per row the sum; padded to groups of 8
    float* weight;     // per row the sum of -g_ij 4 k_i k_j / (k_i + k_j); may be null
};
void conductionPass(const ConductionPass& pass, int beginGroup, int endGroup);

} // namespace thaw
