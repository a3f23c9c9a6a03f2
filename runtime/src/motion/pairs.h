// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/types.h"
#include "neighbors/neighbors.h"

// The loops over neighbour pairs of the motion solve. Each handles the groups [begin, end) of 8 rows and writes to
// those rows only; what it writes for rows that do not move is masked to zero or meaningless, as said.
namespace thaw {

struct PairLists {
    const uint32_t* entries;
    const uint32_t* first;
    const uint32_t* width;
    const float* gradient;

    explicit PairLists(const Neighbors& n)
        : entries(n.entries.data()), first(n.first.data()), width(n.width.data()), gradient(n.gradient.data()) {}
};

struct ForcePass {
    PairLists lists;
    const Vec4* position;    // xyz, w support
    const Vec4* trait;       // see Motion
    const float* volume;     // m^3
    const float* invDensity; // 0 for fixed
    float dt;
    bool cohesive; // some material coheres
    // Out, per row: dv by cohesion and warm pressure (pairs only), the diagonal of the viscous pair matrix; per entry:
    // the viscous coefficient.
    Vec4* change;
    Vec4* diagonal;
    float* coefficient;
};
void pairForces(const ForcePass& p, int begin, int end);

// out_i = sum_j k_ij ((v_i - v_j) . x_ij) x_ij
struct ViscousPass {
    PairLists lists;
    const Vec4* position;
    const float* coefficient;
    const Vec4* velocity; // w is not read
    Vec4* out;            // w = 0
};
void pairViscosity(const ViscousPass& p, int begin, int end);

// out_i = sum_j g_ij . (v_i - v_j)
struct DivergencePass {
    PairLists lists;
    const Vec4* point;
    const Vec4* velocity;
    float* out;
};
void pairDivergence(const DivergencePass& p, int begin, int end);

// out_i = sum_j (P_i + P_j) g_ij, P in point.w
struct GradientPass {
    PairLists lists;
    const Vec4* point;
    Vec4* out; // w = 0
};
void pairGradient(const GradientPass& p, int begin, int end);

// out_i = push apart of pairs closer than a share of their mean spacing
struct SeparationPass {
    PairLists lists;
    const Vec4* position; // xyz; w support, negative for fixed rows, which leave all of it to their partner
    Vec4* out;            // w = 0
};
void pairSeparation(const SeparationPass& p, int begin, int end);

} // namespace thaw
