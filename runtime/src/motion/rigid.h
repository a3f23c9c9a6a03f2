// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "motion/motion.h"
#include "motion/rigid_math.h"

namespace thaw {

// A piece of solid that nothing anchors: six degrees of freedom. Its rows are those whose Particles::piece is its slot
// + 1; they are fixed rows to everyone else, with the velocity of the piece at their place.
struct RigidPiece {
    bool alive = false, asleep = false;
    bool fresh = false;    // has not moved freely yet: half of gravity in its first step makes free fall exact
    bool lostRows = false; // may have fallen apart
    bool restless = false, drowsy = false; // scratch of Bonds
    bool solved = false;                   // was an unknown of the last viscosity solve
    bool carried = false;                  // something bore some of it in the step before
    bool bedded = false;                   // elastic solids that move did
    uint16_t calm = 0;                     // steps
    uint32_t id = 0;                       // stable, never reused
    uint32_t first = 0;                    // its rows in Rigid::rows
    uint32_t rows = 0;                     //
    double mass = 0;                       // kg
    double radius = 0;                     // m, from the centre to the farthest corner
    Double3 center;                        // m
    Double3 velocity, spin;                // m/s, rad/s
    Symmetric3 inertia, inverseInertia;    // kg m^2 about the centre, in world axes
    Double3 linear, angular;               // kg m/s, kg m^2/s: what the liquid did to it in this sub-step
    Double3 pushed;                        // kg m/s: of that, by the contacts of elastic solids
    Double3 drag, dragSpin;                // m/s, rad/s: what the last viscosity solve changed, its warm start
    Double3 startVelocity, startSpin;
    Double3 load, restLoad; // N: push of other pieces and of liquid; now, and when it fell asleep
    Box bounds;             // m, of its rows

    Rotation3 turnIn(double time) const; // free of torque
    Double3 velocityAt(Double3 x) const { return velocity + cross(spin, x - center); }
    double reach() const { return length(velocity) + length(spin) * radius; } // m/s, of its fastest point at most
    void push(Double3 impulse, Double3 at) {
        velocity += (1 / mass) * impulse;
        spin += inverseInertia * cross(at - center, impulse);
    }
};

// Where a piece touches something. Bodies are pieces by slot; whatever else holds against it has no mass to move.
struct RigidContact {
    static constexpr uint32_t kWall = 0x80000000u, kHeld = 0x40000000u; // else the slot of a piece
    uint32_t a = 0, other = 0;                                          // kWall | index of the collider
    uint32_t id = 0;                                                    // of the particle that found it
    bool loaded = false;                                                // it carried something in the step before
    Double3 normal, point;                                              // from the other toward a; m
    double gap = 0;                                                     // m, < 0 inside
    float friction = 0;
    Double3 surface; // m/s, of a wall at the point
    double push = 0; // N s along the normal
    Double3 rub;     // N s across it
    Double3 t1, t2, armA, armB;
    double massN = 0, mass1 = 0, mass2 = 0; // kg, that a push in these directions meets
    double spacing = 0;                     // m, of the particle that found it
};

// The pieces of a world: who belongs to which, their contacts and their motion.
class Rigid {
public:
    explicit Rigid(Allocator& allocator);

    bool any() const { return alive_ > 0; }
    bool moving() const; // some piece is awake
    const Array<RigidPiece>& pieces() const { return pieces_; }
    Array<RigidPiece>& pieces() { return pieces_; }
    const RigidPiece& pieceOf(uint16_t piece) const { return pieces_[piece - 1u]; }
    int awakeRows() const;

    // Makes a piece of these rows; parent: the piece that they were part of, or 0. Returns its number, 0 when there are
    // too many pieces. Its velocity is what the rows' velocities add up to.
    uint16_t create(Particles& p, const uint32_t* rows, size_t count, uint16_t parent);
    void reserve() { pieces_.reserve(pieces_.size() + 1); } // so that the next one allocates nothing
    // Row i, a mover until now, sets against the piece: momentum is kept.
    void join(Particles& p, uint32_t i, uint16_t piece);
    void lost(uint16_t piece); // a row left it
    void wake(uint16_t piece) { pieces_[piece - 1u].asleep = false, pieces_[piece - 1u].calm = 0; }
    void wakeAll();
    void layToRest(uint16_t piece); // with the elastic solid under it, which sleeps from now on
    bool lostRows() const;          // some piece may have fallen apart
    void intact(uint16_t piece) { pieces_[piece - 1u].lostRows = false; }
    // Rows and masses of now; pieces without rows end. After rows changed order or membership.
    void gather(const Particles& p);
    // The rows of a piece, after gather.
    const uint32_t* rowsOf(const RigidPiece& b) const { return rows_.data() + b.first; }

    // Start of a sub-step, at the positions of the lists: velocities with gravity and contacts, for the liquid to see.
    void begin(const MotionFrame& f);
    // Between: velocities with what the liquid did so far.
    void settle(const MotionFrame& f);
    // End of it: velocities by what the liquid did, gravity and contacts, from those of the start; what moves beside a
    // piece is to see it where it was, with this velocity. Then its new place.
    void decide(const MotionFrame& f);
    void advance(const MotionFrame& f);
    float fastest() const; // m/s, of any point of a piece at most

    // Adds to each reporting collider what pieces did to it in the last sub-step.
    void addImpulses(Collider* colliders) const;

    void state(StateIo& io); // sets io.limits.pieces

private:
    struct Load { // of a contact in the step before; sorted by (a, other, id)
        uint32_t a, other, id;
        double push;        // N s
        Double3 rub, total; // N s; total: on a
    };
    void measure(RigidPiece& b, const Particles& p);
    void setVelocities(const MotionFrame& f);
    void kick(const MotionFrame& f);
    void findContacts(const MotionFrame& f);
    void findWalls(const MotionFrame& f, uint32_t slot);
    void findSolids(const MotionFrame& f);
    void reduceContacts();
    void prepareContacts(double dt);
    void solve(int sweeps, double dt, bool recover);
    void apply(const RigidContact& c, Double3 impulse);
    Double3 approach(const RigidContact& c) const;
    bool wakeHit(double dt);
    void followWalls(const MotionFrame& f, uint32_t slot);
    void followTurn(const MotionFrame& f, uint32_t slot);
    void followSolids(const MotionFrame& f, uint32_t slot);
    void integrate(const MotionFrame& f, uint32_t slot);
    void keepLoads(double dt);
    void rest(const MotionFrame& f);
    void wakeNear(const Collider& collider, float spacing);
    double margin(const RigidPiece& b, const MotionFrame& f) const;
    const Load* before(uint32_t a, uint32_t other, uint32_t id) const;
    bool awake(uint32_t slot) const { return pieces_[slot].alive && !pieces_[slot].asleep; }

    Array<RigidPiece> pieces_;
    Array<uint32_t> rows_;
    Array<RigidContact> candidates_, contacts_;
    Array<Load> loads_, loadsBefore_;
    Array<Box> colliderBounds_;
    Array<double> shares_; // per piece: of the sub-step until it comes close to something
    int alive_ = 0;
    uint32_t nextId_ = 1;
    double loadStep_ = 0; // s, of the sub-step that loads_ is of
};

} // namespace thaw
