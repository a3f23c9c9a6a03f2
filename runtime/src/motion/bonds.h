// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/state_io.h"
#include "base/tasks.h"
#include "base/types.h"
#include "geometry/colliders.h"
#include "motion/strain_fit.h"
#include "neighbors/neighbors.h"
#include "particles/material.h"
#include "particles/particles.h"
#include "particles/reference.h"

namespace thaw {

class Rigid;

struct BondFrame {
    Particles& particles;
    const Neighbors& neighbors; // of this step
    const float* volume;        // per row, m^3
    const Material* materials;
    const Collider* colliders;
    int colliderCount;
    Tasks& tasks;
    float dt; // s, of this step or sub-step
    Vec3 gravity;
    Rigid* rigid = nullptr; // pieces that move as one, when there are any
};

struct BondResult {
    int set = 0, released = 0, slept = 0, woken = 0;
    bool changed() const { return set + released + slept + woken > 0; }
};

// Elastic solids: central springs between a solid particle and those within kReach spacings when it became solid, rest
// length = the distance then. On the cubic lattice (6 + 12 neighbours of one spring constant) that is an isotropic
// solid of Poisson's ratio 1/4, C = 1/(2V) sum k r^2 nnnn; elsewhere it is so on the average. The springs' constants
// are such that the mean of their directions has the material's Young's modulus, E = sum k r^2 / (12 V), also for
// particles at the surface, which have fewer.
//
// A particle with bonds has a slot, which it keeps as rows are sorted. While it moves its bonds are laid over the
// neighbour lists, so that the viscous solve carries them in the coefficients of its pairs: backward Euler bond by
// bond. Asleep it is held (kFixed | kAsleep) and costs nothing; what stood within reach of a collider when its body was
// made, or sets there, is held for good (kFixed).
class Bonds {
public:
    explicit Bonds(Allocator& allocator);

    static constexpr int kMost = 26; // bonds of a particle; the lattice has 18
    // Of one that is coarse, or has a coarse neighbour: 48 of the finest are within reach of one of eight times their
    // mass.
    static constexpr int kMostMixed = 48;
    static constexpr float kReach = 1.5f;   // spacings
    static constexpr float kContact = 1.0f; // spacings; solids without a bond push each other from here on

    bool any() const { return live_ > 0; }

    // Frees what melted, bonds what has set, puts to sleep what is calm and wakes what is no longer balanced. Works on
    // flags; rows take their new places at the next sort. Memory for all particles is taken when the first bond is
    // made.
    BondResult update(const BondFrame& f);
    // Before a step, with the colliders on their way: wakes what sleeps and will be touched by one in this step or the
    // next. How many rows; they take their new places at the next sort.
    int wakeBefore(const BondFrame& f);
    // Bonds everything of these soft materials that is solid and has no bond yet, wherever it is and however it moves.
    BondResult bondAll(const BondFrame& f);
    // Wakes what sleeps, of one material or of all. How many rows.
    int wakeAll(Particles& p, int material = -1);
    // Ends the bonds among what is rigid: a material was elastic until now.
    void harden(Particles& p, const Material* materials);
    // Memory for so many particles; later calls take none.
    void reserve(int particles);
    // How many sub-steps of a step of dt bodies that fall on each other, or rigid pieces and such bodies, ask for, at
    // most `limit`; of the first 64 bodies.
    int subStepsWanted(const Particles& p, float dt, Vec3 gravity, float spacing, int limit) const;
    // Springs of the movers as pairs of the neighbour lists: stiffness and rest per entry.
    void lay(const BondFrame& f);
    // Plastic flow, creep and rupture, at the positions of now.
    void relax(const BondFrame& f);
    // Sets io.limits.slots. Of an image that is checked, checkSlots() then looks whether the rows name the slots.
    void state(StateIo& io, int capacity);
    void checkSlots(StateIo& io, const uint32_t* slotOfRow, size_t rows);
    struct Stress {
        float mises;      // Pa, of the virial of its bonds
        float meanStrain; // a third of the change of volume
        float bondMean;   // of its bonds' strains, as they weigh in the pressure
    };
    // Twice the stress times the volume, J, and the sum of stiffness r rest.
    struct Virial {
        float xx, yy, zz, xy, yz, zx, all;
        void add(float share, const Virial& o) {
            xx += share * o.xx, yy += share * o.yy, zz += share * o.zz;
            xy += share * o.xy, yz += share * o.yz, zx += share * o.zx;
        }
    };
    // Of a row with bonds; valid from lay() to the next sort.
    Virial virial(const BondFrame& f, uint32_t row) const { return virial(f.particles, f.materials, row); }
    Stress stress(const BondFrame& f, uint32_t row) const;

    // Valid from lay() to the next sort.
    Array<float> stiffness, rest; // per entry of groups that are on: N/m, m; 0: no spring
    Array<uint8_t> groupOn;       // per mover group: some row of it has a slot

    // Coarse particles of elastic solids (bonds_levels.cpp). After a step: their points in the reference, and the
    // slopes of what lies beside them, go with what is around them.
    void deform(const BondFrame& f, Reference& reference);
    // Rows that are about to split, at the positions of now: the strain and the gradients that their parts will have.
    void beforeSplits(const Particles& p, const Material* materials, const uint32_t* rows, size_t count);
    // The one with that place among them has split: `rows` are its parts, each with the slot of the whole still. They
    // get bonds of their own, with the stress that was, and move on as it did.
    void split(Particles& p, const Reference& reference, size_t place, const uint32_t* rows, size_t count);
    // Whether these rows are the parts of one and may be one again: in one piece, bent no more than it could tell,
    // calm.
    bool mayUnite(const Particles& p, const Reference& reference, const uint32_t* rows, size_t count, float dt) const;
    // Groups of `size` rows that are about to be one each.
    void beforeMergers(const Particles& p, const Material* materials, const uint32_t* rows, size_t count, size_t size);
    // The group of that place is one now, rows[0], where it has come to and with its mass: the others go.
    void unite(Particles& p, const Reference& reference, size_t place, const uint32_t* rows, size_t size);
    // After splits and mergers: stiffness and stress of what came to be.
    void settleBonds(const Particles& p, const Material* materials);

    // N/m, of a layer of the solid at this row: as what presses on its surface meets it.
    float stiffnessOfLayer(const BondFrame& f, uint32_t row) const;
    // What a rigid piece gives a particle, N, by slot; until the next lay() while it moves.
    void bear(uint32_t slot, Vec3 force) { borne_[slot] = force; }

    // How a wall held a particle in the last solve, and how hard the walls pushed it times their friction, m/s^2; by
    // slot.
    enum Pressed : uint8_t { kFree, kSticks, kSlips };
    uint8_t& pressed(uint32_t slot) { return pressed_[slot]; }
    float& rubbed(uint32_t slot) { return rubbed_[slot]; }

private:
    struct Bond {
        uint32_t other; // slot
        float rest;     // m
        float weight;   // 1; less while it breaks
    };
    // A solid particle's part in the stiffness of its pairs.
    struct Elastic {
        float modulus = 0; // Pa; 0: as stiff as the other
        float share = 1;   // 1 - liquid fraction / release fraction
        float inverseFill = 0;
    };
    struct Strain {
        float mean, release; // of its bonds; share of the deviatoric strain that relaxes in this step
    };
    enum : uint8_t { kStay, kSets, kSleeps, kWakes, kAnchors };
    static constexpr uint32_t kNoRow = ~0u;
    static constexpr uint8_t kNewborn = 255; // calm_ of what was never looked at

    // What a row that splits leaves to its parts.
    struct Parent {
        SmallStrain strain;
        float slope[6][3]; // 1/m, of the strain
        Tensor3 velocity;  // 1/s, its gradient
        Virial virial;
    };
    // Rows that came to be out of one, or of several, which bore that virial together; or one beside them.
    struct Changed {
        uint32_t rows[8], count, slot; // of the first
        bool beside;
        float across; // new bonds of what lies beside
        Virial virial, lacks;
    };
    struct NewBond {
        uint32_t a, b; // slots
    };
    struct Kept { // of slots that go, for those that come
        Bond bonds[kMostMixed * 8];
        int count = 0;
        uint8_t calm = 0, pressed = 0;
        Vec3 borne;
        float rubbed = 0;
    };

    Bond* bondsOf(uint32_t slot) { return bonds_.data() + static_cast<size_t>(slot) * kMostMixed; }
    const Bond* bondsOf(uint32_t slot) const { return bonds_.data() + static_cast<size_t>(slot) * kMostMixed; }
    // Springs across levels, of all others: see kMixed.
    static float mixed(const Particles& p, uint32_t i, uint32_t j) { return p.level[i] == p.level[j] ? 1.0f : kMixed; }
    // The lattice and one of twice its spacing, half a spacing of each apart: bonds across them (12 per coarse one) and
    // those within would make up 1.11 times the stiffness of either one, and the layer between 1.26 times. With this
    // both are 1.01: 3/4 of each spring makes the sums of rest^2 those of the lattices.
    static constexpr float kMixed = 0.75f;
    void reset(); // nobody has a slot
    void mapRows(const Particles& p);
    uint32_t take(Particles& p, uint32_t row);
    void drop(uint32_t slot);
    void forget(uint32_t slot, uint32_t other);
    bool bonded(uint32_t slot, uint32_t other) const;
    void connect(uint32_t a, uint32_t b, float rest, int most = kMost, float weight = 1);
    void refill(const Particles& p, float volume, uint32_t slot);
    const SmallStrain& strainOf(const Particles& p, uint32_t slot);
    void rebond(const Particles& p, const Reference& reference, uint32_t a, uint32_t b, float weight);
    bool deformation(const Particles& p, const Reference& reference, uint32_t row, Tensor3& f, Tensor3& rotation) const;
    void watch(const Particles& p, const Material* materials, uint32_t slot);
    void keep(uint32_t slot, bool first);
    void restore(uint32_t slot, float share);
    Virial virial(const Particles& p, const Material* materials, uint32_t row) const;
    float relaxed(const Particles& p, uint32_t a, uint32_t b);
    void afterUniting(Particles& p, const Reference& reference, uint32_t row);
    Elastic elastic(const Material* materials, const Particles& p, uint32_t row) const;
    static float pairStiffness(const Elastic& a, const Elastic& b);
    static float contactStiffness(const Elastic& a, const Elastic& b, float spacing);
    void bondRows(const BondFrame& f, BondResult& result);
    bool findTouch(const BondFrame& f, uint32_t row) const;
    void gather(const BondFrame& f, int begin, int end, WallFinder& walls) const;
    Vec3 imbalance(const BondFrame& f, uint32_t row) const;
    float rounding(const BondFrame& f, uint32_t row) const;
    Box hittingPieces(const BondFrame& f) const;
    bool touchedByPiece(const BondFrame& f, uint32_t row) const;
    template <class F> void forTouching(const BondFrame& f, bool asleep, F&& body) const;
    void wakePieces(const BondFrame& f);
    void wake(Particles& p, uint32_t row);
    void settlePieces(const BondFrame& f);
    void settle(const BondFrame& f, BondResult& result);
    void weld(const BondFrame& f);
    // Whether a row that is held has a mover in its support: movers come first in its list.
    static bool beside(const BondFrame& f, uint32_t row) {
        const uint32_t g = row >> 3;
        return f.neighbors.width[g] > 0 && f.neighbors.entries[f.neighbors.first[g] + (row & 7)] >> 4 <
                                               static_cast<uint32_t>(f.particles.moverCount);
    }

    int live_ = 0; // slots in use
    uint32_t steps_ = 0;
    Array<Bond> bonds_; // kMost per slot; slot 0 is nobody's
    Array<uint8_t> count_, calm_, pressed_;
    Array<Vec3> borne_;            // N, by rigid pieces
    Array<float> rubbed_;          // m/s^2, as far as walls rub at most
    Array<float> fill_, fillGoal_; // sum of weight rest^2 / (12 V), 1/m; what it goes to
    Array<uint32_t> rowOf_;        // kNoRow: free
    Array<uint32_t> free_;         // stack
    Array<uint8_t> state_;         // per row
    Array<Strain> strain_;         // per row
    Array<uint8_t> touched_;       // per slot: its bonds changed in number or weight
    Array<uint32_t> queue_;        // rows, of wakeBefore
    Array<Box> colliderBounds_;
    Array<SmallStrain> strainFit_; // per slot, where strainStamp_ is stamp_; of rows that split and those around them
    Array<uint32_t> strainStamp_, watchStamp_, ownerOf_; // watched: its virial shall stay
    uint32_t stamp_ = 1;                                 // of what splits and merges together
    Array<Parent> parents_;
    Array<Changed> changed_;
    Array<NewBond> newBonds_;
    Kept kept_;
    Array<uint8_t> imageSlots_; // of an image that is checked: who is in use
    uint32_t imageLive_ = 0;
};

} // namespace thaw
