// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/kernel.h"
#include "base/types.h"
#include "neighbors/neighbors.h"

// The loops over neighbour pairs of the motion solve. Each handles the groups [begin, end) of 8 rows and writes to
// those rows only; what it writes for rows that do not move is masked to zero or meaningless, as said.
namespace thaw {

// Cohesion of a pair, from one spacing to the support: this times (r - d)(h - r) / h^2 is 1 at its largest.
inline constexpr float kCohesionPeak = 4 / ((1 - 1 / kSupport) * (1 - 1 / kSupport));

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
    bool cohesive;    // some material coheres
    const float* own; // of the trait's viscosity, what is the material's; null: a pair has the mean of both
    // Out, per row: dv by cohesion and warm pressure (pairs only), the 3 x 3 diagonal block of the viscous pair matrix;
    // per entry: the viscous coefficient.
    Vec4* change;
    Vec4* diagonal; // xx yy zz of its block
    Vec4* cross;    // xy xz yz
    float* coefficient;
};
void pairForces(const ForcePass& p, int begin, int end);

// out_i = m_i v_i + sum_j k_ij ((v_i - v_j) . x_ij) x_ij
struct ViscousPass {
    PairLists lists;
    const Vec4* position;
    const Vec4* trait;
    const float* coefficient;
    const Vec4* velocity; // w is not read
    Vec4* out;            // w = 0
};
void pairViscosity(const ViscousPass& p, int begin, int end);

// out.x = sum of w_ij ((v_i - v_j) . x_ij)^2 in 1/s^2, out.y = sum of w_ij |x_ij|^4, w_ij = -g_ij / (|x_ij|^2 + 0.01
// h^2): what the viscous pairs dissipate, and how much of the lattice is there to do it.
struct StrainPass {
    PairLists lists;
    const Vec4* position;
    const Vec4* velocity;
    Vec4* out;
};
void pairStrain(const StrainPass& p, int begin, int end);

// Jacobi update of the pressure: error_i = (C_i, times feedback when > 0) + change_i + dt (wall_i . v_i + sum_j g_ij .
// (v_i - v_j)), P_i = max(0, P_i + weight error_i stiffness_i); rows with inverse density 0 keep theirs.
struct JacobiPass {
    PairLists lists;
    const Vec4* position;
    const Vec4* velocity;
    const Vec4* wall; // xyz gradient of the wall's fraction, w C
    const float* stiffness;
    const float* change; // or null
    const float* invDensity;
    float dt, feedback, weight;
    float* pressure;
    Vec4* point; // out: xyz position, w change of the pressure
};
void pairJacobi(const JacobiPass& p, int begin, int end);

// v_i -= dt / rho_i (dP_i wall_i + sum_j (dP_i + dP_j) g_ij), dP in point.w
struct PushPass {
    PairLists lists;
    const Vec4* point;
    const Vec4* wall;
    const float* invDensity;
    float dt;
    Vec4* velocity; // w is kept
};
void pairPush(const PushPass& p, int begin, int end);

// What of the support of a mover is fixed: xyz sum of g_ij over the fixed neighbours in 1/m, w their volume fraction.
struct HeldPass {
    PairLists lists;
    const Vec4* position;
    const float* volume;
    int moverCount; // > 0
    Vec4* out;
};
void pairHeld(const HeldPass& p, int begin, int end);

// out_i = push apart of pairs closer than a share of their mean spacing. Pairs nearer than kNear clump (28 % of a
// puddle without this pass, none with it). Held particles keep a little more: between four of them the way in would be
// free below 0.71.
inline constexpr float kNear = 0.65f, kNearHeld = 0.73f;
// The support by which a held row takes only so much of what it keeps more, 0..1.
inline float heldSupport(float support, float more) { return support * (1 - (1 - more) * 2 * (1 - kNear / kNearHeld)); }
struct SeparationPass {
    PairLists lists;
    // xyz; w support, negative for held rows (heldSupport), which leave all of it to their partner.
    const Vec4* position;
    Vec4* out; // w = 0
};
void pairSeparation(const SeparationPass& p, int begin, int end);

// The vector work of the conjugate gradients on rows [begin, end), multiples of 8, every component alike: what has no
// part in the solve must be zero in direction, image, residual and inverse.
struct Dots {
    double a = 0, b = 0;
};
// v += along d; r -= along q; q = inverse r; returns r . (inverse r) and r . r. inverse: xx yy zz, cross: xy xz yz.
Dots advance(float along, const Vec4* direction, Vec4* image, const Vec4* inverse, const Vec4* cross, Vec4* velocity,
             Vec4* residual, int begin, int end);
// d = z + keep d
void turn(float keep, const Vec4* z, Vec4* direction, int begin, int end);
double innerProduct(const Vec4* a, const Vec4* b, int begin, int end);

} // namespace thaw
