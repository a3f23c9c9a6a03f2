// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/bonds.h"

#include "base/kernel.h"
#include "base/math.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace thaw {
namespace {

// The corner of a cube has 0.3 of the bonds of the inside. What hangs by less is as weak as it looks.
constexpr float kLeastFill = 0.3f;

// Of a slot of an image.
enum : uint8_t { kUsed = 1, kHasRow = 2, kNamed = 4 };

} // namespace

Bonds::Bonds(Allocator& a)
    : stiffness(a), rest(a), groupOn(a), bonds_(a), count_(a), calm_(a), pressed_(a), borne_(a), rubbed_(a), fill_(a),
      fillGoal_(a), rowOf_(a), free_(a), state_(a), strain_(a), touched_(a), queue_(a), colliderBounds_(a),
      strainFit_(a), strainStamp_(a), watchStamp_(a), ownerOf_(a), parents_(a), changed_(a), newBonds_(a),
      imageSlots_(a) {}

void Bonds::reserve(int particles) {
    const size_t n = static_cast<size_t>(particles) + 1;
    if (rowOf_.size() >= n) return;
    bonds_.resizeRaw(n * kMostMixed);
    count_.assign(n, 0), calm_.assign(n, 0), pressed_.assign(n, 0), touched_.assign(n, 0);
    borne_.assign(n, {}), rubbed_.assign(n, 0), fill_.assign(n, 0), fillGoal_.assign(n, 0), rowOf_.assign(n, kNoRow);
    state_.resizeRaw(n), strain_.resizeRaw(n);
    free_.reserve(n), queue_.reserve(n);
    for (size_t s = n - 1; s > 0; --s) free_.push(static_cast<uint32_t>(s));
}

// Where the slots are now. A slot that no row names any more lost its particle: its bonds go.
void Bonds::mapRows(const Particles& p) {
    if (live_ == 0) return;
    std::fill(rowOf_.begin(), rowOf_.end(), kNoRow);
    int found = 0;
    for (int i = 0; i < p.count; ++i) {
        const uint32_t slot = p.bondSlot[static_cast<size_t>(i)];
        if (slot) rowOf_[slot] = static_cast<uint32_t>(i), ++found;
    }
    if (found == live_) return;
    for (uint32_t s = 1; s < rowOf_.size(); ++s)
        if (rowOf_[s] == kNoRow && calm_[s] != 0) drop(s);
}

uint32_t Bonds::take(Particles& p, uint32_t row) {
    const uint32_t slot = free_[free_.size() - 1];
    free_.resizeRaw(free_.size() - 1);
    ++live_;
    count_[slot] = pressed_[slot] = 0, calm_[slot] = kNewborn, fill_[slot] = fillGoal_[slot] = 0;
    borne_[slot] = {}, rubbed_[slot] = 0, rowOf_[slot] = row, p.bondSlot[row] = slot;
    return slot;
}

void Bonds::forget(uint32_t slot, uint32_t other) {
    Bond* b = bondsOf(slot);
    const int n = count_[slot];
    for (int k = 0; k < n; ++k) {
        if (b[k].other != other) continue;
        for (int l = k + 1; l < n; ++l) b[l - 1] = b[l]; // in order: laying them out is quicker
        --count_[slot], touched_[slot] = 1;
        return;
    }
}

void Bonds::drop(uint32_t slot) {
    for (int k = 0; k < count_[slot]; ++k) forget(bondsOf(slot)[k].other, slot);
    count_[slot] = 0, calm_[slot] = 0, touched_[slot] = 0, rowOf_[slot] = kNoRow;
    free_.push(slot);
    --live_;
}

bool Bonds::bonded(uint32_t slot, uint32_t other) const {
    const Bond* b = bondsOf(slot);
    for (int k = 0; k < count_[slot]; ++k)
        if (b[k].other == other) return true;
    return false;
}

void Bonds::connect(uint32_t a, uint32_t b, float length, int most, float weight) {
    if (count_[a] >= most || count_[b] >= most) return;
    bondsOf(a)[count_[a]++] = {b, length, weight}, bondsOf(b)[count_[b]++] = {a, length, weight};
    touched_[a] = touched_[b] = 1;
}

void Bonds::refill(const Particles& p, float volume, uint32_t slot) {
    const uint32_t row = rowOf_[slot];
    const Bond* b = bondsOf(slot);
    float sum = 0;
    for (int k = 0; k < count_[slot]; ++k)
        sum += mixed(p, row, rowOf_[b[k].other]) * b[k].weight * b[k].rest * b[k].rest;
    constexpr float kBulk = 2.5f * kSupport; // times 1/h: 30 dx^2 / (12 dx^3)
    const float bulk = kBulk / p.position[row].w;
    // Of what the surface misses, the part across it misses least along it: 1 / fill makes a column of 8 x 8 particles
    // 11 % too stiff (sag), its root 1 %. On the lattice 1.21 is right for a face, where 1 / fill is 1.43.
    fillGoal_[slot] = std::sqrt(std::max(sum / (12 * volume), kLeastFill * bulk) * bulk);
    if (!(fill_[slot] > 0)) fill_[slot] = fillGoal_[slot];
    touched_[slot] = 0;
}

Bonds::Elastic Bonds::elastic(const Material* materials, const Particles& p, uint32_t row) const {
    const Material& m = materials[p.material[row]];
    Elastic e;
    e.modulus = m.def.youngModulus;
    if (m.soft()) e.share = std::max(0.0f, 1 - p.liquidFraction[row] / m.def.releaseFraction);
    const float fill = fill_[p.bondSlot[row]];
    if (fill > 0) e.inverseFill = 1 / fill;
    return e;
}

// Product of the shares: a pair goes soft as (1 - phi)^2 where both melt alike, and without a step when one of them
// lets go. Sums of two are the same from both ends to the last bit.
float Bonds::pairStiffness(const Elastic& a, const Elastic& b) {
    float modulus = a.modulus + b.modulus;
    if (a.modulus > 0 && b.modulus > 0) modulus = 2 * (a.modulus * b.modulus) / modulus;
    return modulus * (a.share * b.share) * (0.5f * (a.inverseFill + b.inverseFill));
}

void Bonds::state(StateIo& io, int capacity) {
    if (io.hashes() && live_ == 0) return;
    // Slots are taken from the top of free_: below lie those that never were in use, which are the last ones.
    uint32_t live = static_cast<uint32_t>(live_), used = 0;
    size_t untouched = 0;
    if (!io.reads() && rowOf_.size() > 1) {
        while (untouched < free_.size() && free_[untouched] == rowOf_.size() - 1 - untouched) ++untouched;
        used = static_cast<uint32_t>(rowOf_.size() - 1 - untouched);
    }
    {
        StateIo::Trial trial(io);
        io(live, used);
    }
    io(steps_);
    if (io.reads() && (!io.good() || used > static_cast<uint32_t>(capacity) || live > used))
        return io.fail("bonds of too many particles");
    if (io.reads()) untouched = static_cast<size_t>(capacity) - used;
    const uint32_t slots = used + 1, freed = used - live;
    io.limits.slots = used;
    if (io.checks()) {
        imageLive_ = live;
        if (used > 0) reserve(capacity), imageSlots_.assign(slots, 0);
    }
    if (io.restores()) {
        live_ = static_cast<int>(live);
        if (rowOf_.size() > 1) reset(), free_.resizeRaw(untouched);
    }
    for (uint32_t k = 0; k < freed && io.good(); ++k) {
        uint32_t slot = io.reads() ? 0 : free_[untouched + k];
        StateIo::Trial trial(io);
        io.index(slot, slots);
        trial.end();
        if (io.restores() && rowOf_.size() > 1) free_.push(slot);
    }
    // A slot in one piece, and its bonds: 18 of them, one by one, took ten times as long.
    struct One {
        uint32_t slot;
        float borne[3], fill, goal, rubbed;
        uint8_t count, calm, pressed, touched;
    };
    static_assert(sizeof(One) == 32 && sizeof(Bond) == 12);
    uint32_t slot = 0;
    for (uint32_t k = 0; k < live && io.good(); ++k) {
        One one;
        if (!io.reads()) {
            for (++slot; calm_[slot] == 0;) ++slot;
            const Vec3 b = borne_[slot];
            one = {slot,         {b.x, b.y, b.z}, fill_[slot],    fillGoal_[slot], rubbed_[slot],
                   count_[slot], calm_[slot],     pressed_[slot], touched_[slot]};
            if (io.hashes()) one.rubbed = one.pressed ? one.rubbed : 0, one.touched = 0;
            io.bytes(&one, sizeof one);
            io.bytes(bondsOf(slot), one.count * sizeof(Bond));
            continue;
        }
        const unsigned char* head = io.look(sizeof one);
        if (!head) return;
        std::memcpy(&one, head, sizeof one);
        if (one.slot <= slot || one.slot >= slots || one.count > kMostMixed || one.calm == 0 || one.pressed > kSlips ||
            one.touched > 1)
            return io.fail("bonds that cannot be");
        slot = one.slot;
        const unsigned char* bonds = io.look(one.count * sizeof(Bond));
        if (!bonds) return;
        if (io.checks()) {
            for (int b = 0; b < one.count; ++b) {
                Bond bond;
                std::memcpy(&bond, bonds + static_cast<size_t>(b) * sizeof bond, sizeof bond);
                if (bond.other == 0 || bond.other >= slots) return io.fail("a bond with nobody");
                imageSlots_[bond.other] |= kNamed;
            }
            imageSlots_[slot] |= kUsed;
            continue;
        }
        count_[slot] = one.count, calm_[slot] = one.calm, pressed_[slot] = one.pressed, touched_[slot] = one.touched;
        borne_[slot] = {one.borne[0], one.borne[1], one.borne[2]}, rubbed_[slot] = one.rubbed;
        fill_[slot] = one.fill, fillGoal_[slot] = one.goal;
        std::memcpy(bondsOf(slot), bonds, one.count * sizeof(Bond));
    }
}

void Bonds::checkSlots(StateIo& io, const uint32_t* slotOfRow, size_t rows) {
    uint32_t found = 0;
    for (size_t i = 0; i < rows; ++i) {
        const uint32_t slot = slotOfRow[i];
        if (!slot) continue;
        if (imageLive_ == 0 || (imageSlots_[slot] & (kUsed | kHasRow)) != kUsed)
            return io.fail("bonds of a particle that has none");
        imageSlots_[slot] |= kHasRow, ++found;
    }
    if (found != imageLive_) return io.fail("bonds of no particle");
    for (size_t s = 0; s < imageSlots_.size() && imageLive_ > 0; ++s)
        if ((imageSlots_[s] & (kNamed | kUsed)) == kNamed) return io.fail("a bond with nobody");
}

void Bonds::reset() {
    const uint32_t n = static_cast<uint32_t>(rowOf_.size());
    std::fill(count_.begin(), count_.end(), uint8_t{0}), std::fill(calm_.begin(), calm_.end(), uint8_t{0});
    std::fill(touched_.begin(), touched_.end(), uint8_t{0}), std::fill(rowOf_.begin(), rowOf_.end(), kNoRow);
    free_.clear();
    for (uint32_t s = n - 1; s > 0; --s) free_.push(s);
}

} // namespace thaw
