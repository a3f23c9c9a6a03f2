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
    uint32_t next = 0; // the slot before the one in hand
    for (uint32_t k = 0; k < live && io.good(); ++k) {
        if (!io.reads())
            for (++next; calm_[next] == 0;) ++next;
        StateIo::Trial trial(io);
        const uint32_t before = next;
        io.index(next, slots);
        if (!io.good() || (io.restores() && (next == 0 || (k > 0 && next <= before && io.reads())))) {
            io.fail("bonds out of order");
            return;
        }
        uint8_t count = count_[next], calm = calm_[next], pressed = pressed_[next], touched = touched_[next];
        io(count, calm);
        io.index(pressed, kSlips + 1);
        if (count > kMostMixed || calm == 0) return io.fail("more bonds than a particle has");
        Vec3 borne = borne_[next];
        float rubbed = rubbed_[next], fill = fill_[next], goal = fillGoal_[next];
        io(borne, fill, goal);
        if (pressed || !io.hashes()) io(rubbed);
        io.report(touched);
        Bond own[kMostMixed];
        Bond* bonds = io.reads() ? own : bondsOf(next);
        for (int b = 0; b < count; ++b) {
            io.index(bonds[b].other, slots);
            io(bonds[b].rest, bonds[b].weight);
        }
        trial.end();
        if (io.checks() && io.good()) imageSlots_[next] = 1;
        if (!io.restores() || !io.good()) continue;
        count_[next] = count, calm_[next] = calm, pressed_[next] = pressed, touched_[next] = touched;
        borne_[next] = borne, rubbed_[next] = rubbed, fill_[next] = fill, fillGoal_[next] = goal;
        std::copy_n(own, count, bondsOf(next));
    }
}

void Bonds::checkSlots(StateIo& io, const uint32_t* slotOfRow, size_t rows) {
    // 1: in use, 2: and some row has it
    uint32_t found = 0;
    for (size_t i = 0; i < rows; ++i) {
        const uint32_t slot = slotOfRow[i];
        if (!slot) continue;
        if (imageLive_ == 0 || imageSlots_[slot] != 1) return io.fail("bonds of a particle that has none");
        imageSlots_[slot] = 2, ++found;
    }
    if (found != imageLive_) io.fail("bonds of no particle");
}

void Bonds::reset() {
    const uint32_t n = static_cast<uint32_t>(rowOf_.size());
    std::fill(count_.begin(), count_.end(), uint8_t{0}), std::fill(calm_.begin(), calm_.end(), uint8_t{0});
    std::fill(touched_.begin(), touched_.end(), uint8_t{0}), std::fill(rowOf_.begin(), rowOf_.end(), kNoRow);
    free_.clear();
    for (uint32_t s = n - 1; s > 0; --s) free_.push(s);
}

} // namespace thaw
