// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "base/types.h"
#include "geometry/colliders.h"
#include "neighbors/neighbors.h"
#include "particles/material.h"
#include "particles/particles.h"

namespace thaw {

struct MotionFrame {
    Particles& particles;
    Neighbors& neighbors;    // built and weighed at the positions of now
    const float* volume;     // per row, m^3, padded
    const float* invDensity; // per row, 1/rho for movers, 0 for fixed, padded
    const Material* materials;
    const Collider* colliders;
    int colliderCount;
    Tasks& tasks;
    float dt;     // s, of this sub-step
    int subSteps; // of this step, for the density feedback (beta falls with them)
    Vec3 gravity;
    float spacing; // m, of level 0
    int pressureIterations, viscosityIterations;
};

struct MotionStats {
    int viscosityIterations = 0;
    bool iterationsClipped = false, velocityClamped = false;
    float maxSpeed = 0, maxCompression = 0, meanCompression = 0, apparentViscosity = 0;
};

// The motion of everything that is not fixed, for one sub-step: velocity-based constant-density solve with the geometry
// frozen at its start (scheme B of the measurements), warm-started pressure before an implicit viscosity, contacts
// inside the solve. Call in this order; each is one stage of the step.
class Motion {
public:
    explicit Motion(Allocator& allocator);

    void begin(const MotionFrame& f);     // walls near each mover, compression, Jacobi coefficients, warm pressure
    void forces(const MotionFrame& f);    // gravity, cohesion, adhesion, warm pressure applied
    void viscosity(const MotionFrame& f); // conjugate gradients with the pressure fold and no-slip walls
    void pressure(const MotionFrame& f);  // Jacobi iterations, walls held inside
    void move(const MotionFrame& f);      // positions: swept when fast, minimum distance, out of walls
    const MotionStats& stats() const { return stats_; }

    // How many sub-steps depth (G = g H dt^2 / dx^2) and approach speed ask for in a step of dt, at most `limit`.
    // Without colliders, only what approaches fixed particles counts as approach.
    static int subStepsWanted(const Particles& particles, float dt, Vec3 gravity, float spacing, int limit,
                              const Collider* colliders = nullptr, int colliderCount = 0);

    static constexpr int kContacts = 4; // walls that a mover feels at once, the nearest

private:
    bool touches(size_t i) const { return contactCount_[i] || held_[i].w < INFINITY; }
    void holdAtWalls(size_t i, Vec4& velocity, float h, float dt) const;
    void returnMomentum(const MotionFrame& f);
    void applyViscosity(const MotionFrame& f, const Vec4* velocity, int begin, int end);

    // What one block of rows found, put together in block order so that workers do not change the bits.
    struct BlockSums {
        double a = 0, b = 0;
        float c = 0, d = 0;
    };

    MotionStats stats_;
    Array<Box> colliderBounds_;
    Array<Vec4> contact_;            // kContacts per mover: xyz outward normal, w distance in m; nearest first
    Array<uint8_t> contactAdhesive_; // per contact
    Array<uint8_t> contactCount_;    // per mover
    Array<Vec4> held_;         // per mover: the surface of the fixed particles around it, like a contact; w inf: none
    Array<Vec4> wallGradient_; // per mover: xyz gradient of the wall's volume fraction in 1/m, w C = density error
    Array<Vec4>
        trait_; // per row: x viscosity in Pa s (< 0: fixed), y cohesion in m/s^2, z mass in kg, w pressure in Pa
    Array<Vec4> point_;        // per row: xyz position, w pressure change of this iteration in Pa
    Array<float> coefficient_; // per entry: viscous pair coefficient, kg/m^2
    Array<Vec4> wallDrag_;     // two per mover: xx yy zz, xy xz yz of the no-slip block, kg
    Array<Vec4> diagonal_;     // per mover: 1 / diagonal of the viscous matrix, 1/kg
    Array<Vec4> before_, residual_, direction_, image_;
    Array<Vec4> target_; // per row: position at the end of the sub-step before particles are moved apart
    // Whether a mover's piece hangs on a wall or on something held: kLeaning when it does itself, the rest is searched.
    enum Piece : uint8_t { kUnknown, kLeaning, kAfloat };
    Array<Piece> piece_;    // per mover
    Array<uint32_t> queue_; // rows of the piece in hand
    Array<BlockSums> sums_;
};

} // namespace thaw
