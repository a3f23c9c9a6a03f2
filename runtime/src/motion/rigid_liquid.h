// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "motion/pairs.h"
#include "motion/rigid.h"
#include "motion/soft_contacts.h"

namespace thaw {

// What liquid and rigid pieces do to each other, inside the iterations: handed over after the solve, light pieces blow
// up and others float wrongly. Every impulse on a mover by a row of a piece is on that piece too. In the viscosity
// solve a piece has six unknowns of its own, whatever carries it: one that is frozen there because a wall carries it,
// and gets what the pairs say at the end, is driven by its own drag, and slid about in a pool at 0.04 m/s. (Contacts
// have to be converged for that, kSweepsBetween.) What sleeps is no unknown.
class RigidLiquid {
public:
    explicit RigidLiquid(Allocator& allocator);

    // A mover that lies against pieces: how much of what it lies against is each of them, and the impulse that holding
    // it out took.
    struct Near {
        static constexpr int kPieces = 3;
        uint32_t mover;
        uint16_t piece[kPieces]; // 0: no more
        float share[kPieces];    // 0..1
        Vec3 impulse;            // N s, on all that it lies against
    };

    struct Six {
        Double3 linear, angular;
    };
    struct Unknown {
        uint32_t slot;
        bool springs; // elastic solids push it
        bool visited; // by the search of what floats
        size_t firstPair, endPair;
        Six before, residual, direction, image, z;
        double factor[6][6]; // Cholesky, of mass and pairs: the exact block
    };

    // After the forces: finds the pairs, and hands over what pressure and cohesion did. trait: see Motion. moverStart:
    // velocities before the sub-step.
    void gather(const MotionFrame& f, const Vec4* trait, const Vec4* moverStart);
    bool any() const { return !pairs_.empty(); }
    Near* near(size_t mover) { return pairs_.empty() || !nearOf_[mover] ? nullptr : &near_[nearOf_[mover] - 1]; }
    // The unknown of a piece that swims; null for what is held, carried or asleep.
    Unknown* unknownOf(uint16_t piece);
    Array<Unknown>& unknowns() { return unknowns_; }
    Array<uint32_t>& group() { return group_; } // scratch of Motion::returnShared
    Vec3 velocityAt(const MotionFrame& f, const Near& n) const;

    // The conjugate gradients of the viscosity solve: the pieces' part of each of its steps. Rows of pieces get
    // velocity and direction of theirs.
    void prime(const MotionFrame& f);
    Dots start(const MotionFrame& f, Vec4* direction);
    void aimBack(const MotionFrame& f, Vec4* direction); // toward the velocities of the start of the sub-step
    double slope() const;
    double curvature(const MotionFrame& f, Vec4* direction);
    Dots advance(double along);
    void turn(const MotionFrame& f, double keep, Vec4* direction);
    void show(const MotionFrame& f); // gives the rows the velocities that the iterations have come to
    void finish(const MotionFrame& f, bool sound);
    // Contacts of elastic solids: between two rounds of the solve, which of them push, stick and slip; true when that
    // changed something. Of a mover; null for most.
    bool decideSoft(const MotionFrame& f);
    const SoftContacts::Contact* softOf(size_t mover) const { return soft_.of(mover); }
    void state(StateIo& io) { soft_.state(io); }

    void press(const MotionFrame& f, const Vec4* point); // after a pressure iteration; w: its change, Pa
    void pushSwept(const MotionFrame& f);                // gives the pieces what stopping fast movers took
    void settle(const MotionFrame& f);                   // hands over what holding out took; contacts, velocities

private:
    struct Pair {
        uint32_t mover, row, slot;
        Vec3 x;            // m, from the row to the mover
        float coefficient; // kg/m^2, viscous
        float push;        // m s, impulse of 1 Pa over x
    };
    static double dot6(const Six& a, const Six& b) { return dot(a.linear, b.linear) + dot(a.angular, b.angular); }
    Six massTimes(const RigidPiece& b, const Six& v) const { return {b.mass * v.linear, b.inertia * v.angular}; }
    void factorise(const MotionFrame& f, Unknown& u);
    static Six precondition(const Unknown& u);
    void addDrag(const MotionFrame& f, const Unknown& u, const Vec4* velocity, float sign, Six& sum) const;
    void addPush(const MotionFrame& f, const Unknown& u, Six& sum) const;
    Dots measure();
    void spread(const MotionFrame& f, const Unknown& u, const Six& v, Vec4* rows) const;

    Rigid* rigid_ = nullptr;
    Array<Pair> pairs_;
    Array<Near> near_;
    Array<uint32_t> nearOf_; // per mover: index + 1
    Array<Unknown> unknowns_;
    Array<uint32_t> group_;
    SoftContacts soft_;
};

} // namespace thaw
