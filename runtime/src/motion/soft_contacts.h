// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "motion/rigid.h"

namespace thaw {

// Where movers of elastic solids touch rigid pieces: against the smooth surface of all rows of the piece around the
// mover, as everything else touches solids. (Springs between particle and particle stand on the tips of a lattice:
// pieces slid off into its hollows, and sank in by three spacings.) A spring across the surface, as stiff as one layer
// of the solid and only pushing, and one along it which slips when it passes the friction, both taken at the end of the
// sub-step: part of the viscous solve, whose rounds find out which of them push, stick and slip.
class SoftContacts {
public:
    explicit SoftContacts(Allocator& allocator);

    struct Contact {
        enum State : uint8_t { kOpen, kSticks, kSlips };
        uint32_t mover, row; // the nearest row of the piece: it has the piece's velocity
        uint32_t slot;       // of the piece
        Vec3 normal;         // from the piece to the mover
        float gap;           // m, < 0 inside
        float across, along; // N/m
        State state;
        Vec3 slid; // m, along the surface, since it sticks; slipping: as far as its friction goes
        float rub; // N, while it slips

        // Impulse on the mover over the velocity of the mover against the piece, and what it is at none.
        Vec3 drag(float dt, Vec3 v) const;
        Vec3 push(float dt) const;
    };

    void clear() { contacts_.clear(), of_.clear(); }
    // nearest: lists the mover's neighbours. Reads what was kept of the sub-step before.
    void begin(size_t movers) { contacts_.clear(), of_.assign(movers, 0); }
    void add(const MotionFrame& f, uint32_t mover);
    bool any() const { return !contacts_.empty(); }
    const Array<Contact>& all() const { return contacts_; }
    const Contact* of(size_t mover) const {
        return contacts_.empty() || !of_[mover] ? nullptr : &contacts_[of_[mover] - 1];
    }
    // Which of them push, stick and slip at these velocities. True when that changed something.
    bool decide(const MotionFrame& f, const Vec4* movers, const Vec4* rows);
    // Keeps them for the next sub-step, and tells the bonds what they bear.
    void keep(const MotionFrame& f, const Vec4* velocity);
    void state(StateIo& io);

private:
    struct Kept { // by particle and piece
        uint32_t id, piece;
        Contact::State state;
        Vec3 slid;
        float rub;
    };
    const Kept* before(uint32_t id, uint32_t piece) const;

    Array<Contact> contacts_;
    Array<uint32_t> of_; // per mover: index + 1
    Array<Kept> kept_;   // sorted
};

} // namespace thaw
