// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/safe_points.h"
#include "base/tasks.h"
#include "base/types.h"
#include "geometry/colliders.h"
#include "motion/bonds.h"
#include "neighbors/neighbors.h"
#include "particles/material.h"
#include "particles/particles.h"
#include "particles/reference.h"

namespace thaw {

class Rigid;
class RigidLiquid;

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
    float heldSpeed = 0;             // m/s, of the fastest fixed particle: what hangs on a collider moves with it
    Bonds* bonds = nullptr;          // null, or without any: nothing is elastic
    Rigid* rigid = nullptr;          // pieces that move as one, when there are any
    RigidLiquid* coupling = nullptr; // with rigid
    Reference* reference = nullptr;  // of untouched solids, when there are any that are coarse
    // Per mover: xyz velocity in m/s that it shall have, w how much more its mass weighs for that (an implicit drag);
    // null: nothing guides the flow.
    const Vec4* guide = nullptr;
    const Vec4* unguided =
        nullptr; // with guide, per mover: a unit direction that its drag leaves free, or 0; null: all 0
    // With guide, per mover: xyz the inward normal of a rim that holds it like a smooth wall, w how far off that is in
    // m, infinity: none does; null: none at all. rimVelocity: m/s, of the rims, null: they stand.
    const Vec4* rim = nullptr;
    const Vec4* rimVelocity = nullptr;
    SafePoints* safePoints = nullptr;          // at each of which iterations may be given up; null: none are
    int leastViscosity = 1, leastPressure = 1; // iterations that are done however late it is

    // Of a mover's velocity, what the guide has a say in.
    Vec3 guided(size_t i, Vec3 v) const { return unguided ? v - dot(unguided[i].xyz(), v) * unguided[i].xyz() : v; }
    BondFrame bondFrame() const {
        return {particles, neighbors, volume, materials, colliders, colliderCount, tasks, dt, gravity, rigid};
    }
};

struct MotionStats {
    int viscosityIterations = 0, pressureIterations = 0;
    double guideImpulse[3] = {}, guideEnergy = 0; // kg m/s, J that the guide gave
    bool iterationsClipped = false, velocityClamped = false;
    float maxSpeed = 0, maxCompression = 0, meanCompression = 0, apparentViscosity = 0;
};

struct ImpulseSums {
    double linear[3], angular[3]; // N s, N m s about the collider's position
    void add(Vec3 arm, float mass, Vec3 change) {
        const double m = mass, x = m * change.x, y = m * change.y, z = m * change.z;
        linear[0] += x, linear[1] += y, linear[2] += z;
        angular[0] += arm.y * z - arm.z * y, angular[1] += arm.z * x - arm.x * z, angular[2] += arm.x * y - arm.y * x;
    }
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
    // Per mover of the last begin(), w: the density error that the pressure saw.
    const Vec4* densityErrors() const { return wallGradient_.data(); }
    const MotionStats& stats() const { return stats_; }
    // Adds to each reporting collider what the last sub-step's movers did to it.
    void addImpulses(Collider* colliders, int colliderCount) const;

    // How many sub-steps depth (G = g H dt^2 / dx^2) and what comes to fixed particles or to walls that move ask for in
    // a step of dt, at most `limit`. Colliders that move do so by their motion of the whole step.
    static int subStepsWanted(const Particles& particles, float dt, Vec3 gravity, float spacing, int limit,
                              const Collider* colliders = nullptr, int colliderCount = 0);

    static constexpr int kContacts = 4; // walls that a mover feels at once, the nearest

private:
    static constexpr uint16_t kRim = 0xffff; // in place of a collider
    bool touches(size_t i) const { return contactCount_[i] || held_[i].w < INFINITY; }
    void land(const MotionFrame& f);
    void findWalls(const MotionFrame& f, int begin, int end, int block);
    void weighWalls(const MotionFrame& f, size_t i, float& fraction, Vec3& gradient);
    bool mirrors(const MotionFrame& f, size_t held) const;
    Vec3 heldMirror(const MotionFrame& f, size_t i, Vec3 all) const;
    template <class F> void forHeldNeighbors(const MotionFrame& f, size_t i, F&& body) const;
    float broughtByHeld(const MotionFrame& f, size_t i) const;
    Vec3 heldPull(const MotionFrame& f, size_t i, float pull, Vec3 down) const;
    void findUnlike(const MotionFrame& f);
    template <class F> void forMirrors(const MotionFrame& f, size_t i, F&& body) const;
    template <class F> void forMirrorPush(const MotionFrame& f, size_t i, F&& body) const;
    float unlikeness(const MotionFrame& f, size_t i) const;
    float mirrorDistance(const MotionFrame& f, size_t i, size_t contact) const;
    void weighMirrors(const MotionFrame& f);
    void moveMirrors(const MotionFrame& f, int begin, int end);
    Vec3 pushMirrors(const MotionFrame& f, size_t i, const Vec4* pressure) const;
    void reportMirrors(const MotionFrame& f, size_t i);
    void holdAtWalls(const MotionFrame& f, size_t i);
    void meetMovingWalls(const MotionFrame& f);
    bool reports(const MotionFrame& f, uint16_t anchor) const;
    void report(const MotionFrame& f, int block, uint16_t anchor, Vec3 x, float mass, Vec3 change);
    template <class F> void forHeldPairs(const MotionFrame& f, F&& change);
    void reportHeldDrag(const MotionFrame& f);
    void reportHeldPush(const MotionFrame& f);
    void reportHeldKicks(const MotionFrame& f);
    bool kicks() const { return reporting_ || rims_; }
    void kick(size_t contact, Vec3 change) {
        if (kicks()) kick_[contact].setXyz(kick_[contact].xyz() + change);
    }
    void returnMomentum(const MotionFrame& f, bool every);
    void returnShared(const MotionFrame& f);
    void returnSpin(const MotionFrame& f);
    void addRigidMotion(const MotionFrame& f, const uint32_t* rows, size_t count, const double (&linear)[3],
                        const double (&angular)[3]);
    void moveRigidly(const MotionFrame& f, const uint32_t* rows, size_t size);
    void applyViscosity(const MotionFrame& f, const Vec4* velocity, int begin, int end, bool walls);
    void addSprings(const MotionFrame& f, int begin, int end);
    bool regrip(const MotionFrame& f);
    void bookGuide(const MotionFrame& f);
    void bookRims(const MotionFrame& f);
    void reportGrip(const MotionFrame& f);
    bool gripped(size_t i) const { return bonded_ && grip_[i].w > 0; }
    bool slides(size_t i) const { return bonded_ && grip_[i].w >= kSlides; }
    // Of a velocity or impulse, what the walls that grip a mover leave free, friction aside.
    Vec3 freeOf(size_t i, Vec3 v) const {
        if (!slides(i)) return {};
        const Slide& s = slide_[i];
        const Vec3 along = dot(s.axis, v) * s.axis;
        return s.edge ? along : v - along;
    }
    // The velocity nearest to v that the walls that grip it allow.
    Vec3 heldTo(size_t i, Vec3 v) const { return grip_[i].xyz() + freeOf(i, v - grip_[i].xyz()); }
    void setSlide(size_t i);
    void leaveGripped(const MotionFrame& f);
    void findBodies(const MotionFrame& f);
    void weighBodies(const MotionFrame& f);
    bool moveAsOne(const MotionFrame& f);
    void thicken(const MotionFrame& f);

    struct WallShear {
        float tangent, normal; // kg: tangent (v - n (n v)) + (tangent + normal) n (n v)
        Vec3 on(Vec3 n, Vec3 v) const { return tangent * v + (normal * dot(n, v)) * n; }
    };
    WallShear wallShear(const MotionFrame& f, size_t mover, size_t contact) const;

    // What one block of rows found, put together in block order so that workers do not change the bits.
    struct BlockSums {
        double a = 0, b = 0;
        float c = 0, d = 0;
    };

    MotionStats stats_;
    size_t reporters_ = 0; // colliders that report
    bool wallsMove_ = false, reporting_ = false, thinWalls_ = false, heldMoves_ = false, slippery_ = false;
    bool rims_ = false;      // some movers are held by rims
    bool unlike_ = false;    // liquids of different densities move
    bool otherHeld_ = false; // not all that is fixed is still or carried along (see mirrors)
    Array<Box> colliderBounds_;
    Array<Vec4> contact_;            // kContacts per mover: xyz outward normal, w distance in m; nearest first
    Array<uint8_t> contactAdhesive_; // per contact
    Array<uint8_t> contactCount_;    // per mover
    Array<uint16_t> contactOf_;      // per contact: the collider, or kRim
    Array<float> contactSlope_;      // per contact: its part of the wall gradient along its normal, 1/m
    // Of a mover's mirror in its walls: unlike: how much is its neighbours', 0..1; own: what of that it lacks itself;
    // share: what each neighbour has, by weight.
    struct Mirror {
        float unlike, own, share;
    };
    Array<Mirror> mirror_;      // per mover; when unlike
    Array<float> mirrorChange_; // per mover, of the density error in this iteration; when unlike
    Array<Vec4> wallVelocity_;  // per contact, m/s; when walls move
    Array<Vec4> wallPush_;      // per mover: no-slip block times wall velocity, kg m/s; when walls move
    Array<Vec4> heldVelocity_;  // per mover: of the fixed particles around it, m/s; when they move
    Array<Vec4> kick_; // per contact: what the wall did to the velocity, m/s; when some collider reports, or with rims
    Array<Vec4> heldKick_;       // per mover: what clamps at held particles did, m/s; the same
    Array<int32_t> reportSlot_;  // per collider: its number among those that report, -1: none
    Array<ImpulseSums> reports_; // per block and reporting collider
    Array<Vec4> held_;           // per mover: the surface of the fixed particles around it, like a contact; w inf: none
    Array<Vec4> landing_; // per mover: the wall that it would run into in this sub-step, like a contact; w inf: none, w
                          // < 0: its piece is landing
    Array<uint16_t> landingOn_; // per mover: the collider of that wall
    Array<Vec4> wallGradient_;  // per mover: xyz gradient of the wall's volume fraction in 1/m, w C = density error
    Array<Vec4> trait_; // per row: x viscosity in Pa s (< 0: fixed, minus how often its pairs count), y cohesion in
                        // m/s^2, z mass in kg, w pressure in Pa
    // Per row: of that viscosity the material's, start in stiffness and yield included; the rest is the solver's; when
    // several materials move. Where layers meet there is one stress, so their viscosities are in series: with the
    // arithmetic mean a film of 10 Pa s on one of 100 / 1000 ran 20 / 28 % slow, 8 / 7 % with theirs in series (10 % on
    // its like). With all in series what lands loses the damping of its own speed: a block of 0.02 Pa s at 2 mm came to
    // rest after 1.9 s instead of 0.05.
    Array<float> ownViscosity_;
    bool severalMaterials_ = false;
    Array<Vec4> point_;           // per row: xyz position, w pressure change of this iteration in Pa
    Array<float> coefficient_;    // per entry: viscous pair coefficient, kg/m^2
    Array<Vec4> wallDrag_;        // two per mover: xx yy zz, xy xz yz of the no-slip block, kg
    Array<Vec4> inverse_, cross_; // per mover: xx yy zz and xy xz yz of its inverted viscous block, 1/kg
    Array<Vec4> before_, residual_, direction_, image_;
    // Elastic solids: whether there are any; per mover, what a wall that it is pressed against makes of its velocity in
    // the viscous solve; w: bits of the contacts that do, 0: none, and kSlides when it slides along them.
    bool bonded_ = false;
    static constexpr int kSlides = 1 << kContacts;
    Array<Vec4> grip_;
    struct Slide {
        Vec3 axis; // of the edge that two walls leave free, else the normal of the one wall
        bool edge;
        float drag; // kg, friction of this sub-step over the velocity along the wall of the round before
    };
    Array<Slide> slide_; // per mover; of those that slide
    // What of elastic solids hangs together or touches, for friction.
    struct Body {
        size_t end;                 // of its rows in bodyRow_
        bool held;                  // against something that does not move by the solve
        bool flat;                  // on walls of one normal alone
        Vec3 normal;                // of those
        double mass;                // kg
        double taken[3], pushed[3]; // kg m/s, what it got of everything outside of it; what walls seem to have pushed
        double rubbed;              // kg m/s, as far as walls rub at what they seem to push
        // Of what walls seem to push along n, how much is true: stiff solids that the iterations did not bring to rest
        // press some of their particles on the wall far too hard and pull at others. What comes of it for the whole
        // body is right.
        float believed(Vec3 n) const;
        // m/s that the walls lack to hold it along them, < 0 when they hold it. When flat and not held.
        float slip() const;
    };
    Array<Body> bodies_;
    Array<uint32_t> bodyRow_, bodyOf_; // bodyOf_: per mover, index + 1
    Array<Vec4> block_;  // two per mover: xx yy zz, xy xz yz of its viscous block, kg; when elastic and near walls
    Array<Vec4> unslid_; // two per mover that slides: inverse_ and cross_ of all directions
    // Per row: first the velocity at the start of the sub-step, then the position at its end before particles are moved
    // apart.
    Array<Vec4> target_;
    // Whether a mover's piece hangs on a wall or on something held: kLeaning when it does itself, the rest is
    // searched; kTouching instead where whole pieces are wanted.
    enum Piece : uint8_t { kUnknown, kLeaning, kAfloat, kTouching, kShared };
    Array<Piece> piece_;       // per mover
    Array<uint32_t> queue_;    // rows of the floating pieces of this sub-step, one after another
    Array<uint32_t> pieceEnd_; // per floating piece, its end in the above
    size_t floatingPieces_ = 0;
    Array<BlockSums> sums_;
};

} // namespace thaw
