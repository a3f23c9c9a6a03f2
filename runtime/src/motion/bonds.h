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

    static constexpr int kMost = 26;        // bonds of a particle; the lattice has 18
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
    // How many sub-steps of a step of dt bodies that fall on each other, or rigid pieces and such bodies, ask for, at
    // most `limit`; of the first 64 bodies.
    int subStepsWanted(const Particles& p, float dt, Vec3 gravity, float spacing, int limit) const;
    // Springs of the movers as pairs of the neighbour lists: stiffness and rest per entry.
    void lay(const BondFrame& f);
    // Plastic flow, creep and rupture, at the positions of now.
    void relax(const BondFrame& f);
    uint64_t hash(uint64_t h) const;
    struct Stress {
        float mises;      // Pa, of the virial of its bonds
        float meanStrain; // a third of the change of volume
        float bondMean;   // of its bonds' strains, as they weigh in the pressure
    };
    // Of a row with bonds; valid from lay() to the next sort.
    Stress stress(const BondFrame& f, uint32_t row) const;

    // Valid from lay() to the next sort.
    Array<float> stiffness, rest; // per entry of groups that are on: N/m, m; 0: no spring
    Array<uint8_t> groupOn;       // per mover group: some row of it has a slot

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

    Bond* bondsOf(uint32_t slot) { return bonds_.data() + static_cast<size_t>(slot) * kMost; }
    const Bond* bondsOf(uint32_t slot) const { return bonds_.data() + static_cast<size_t>(slot) * kMost; }
    void reserve(int particles);
    void mapRows(const Particles& p);
    uint32_t take(Particles& p, uint32_t row);
    void drop(uint32_t slot);
    void forget(uint32_t slot, uint32_t other);
    bool bonded(uint32_t slot, uint32_t other) const;
    void connect(uint32_t a, uint32_t b, float rest);
    void refill(const Particles& p, const float* volume, uint32_t slot);
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
};

} // namespace thaw
