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
      strainFit_(a), strainStamp_(a), watchStamp_(a), ownerOf_(a), parents_(a), changed_(a), newBonds_(a) {}

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

uint64_t Bonds::hash(uint64_t h) const {
    if (live_ == 0) return h;
    const auto bits = [](float v) {
        uint32_t u;
        std::memcpy(&u, &v, sizeof u);
        return u;
    };
    h = hashCombine(h, steps_);
    for (uint32_t s = 1; s < rowOf_.size(); ++s) {
        if (calm_[s] == 0) continue;
        h = hashCombine(h, s | static_cast<uint64_t>(calm_[s]) << 32 | static_cast<uint64_t>(pressed_[s]) << 40);
        if (const Vec3 b = borne_[s]; dot(b, b) > 0)
            h = hashCombine(hashCombine(h, bits(b.x) | static_cast<uint64_t>(bits(b.y)) << 32), bits(b.z));
        if (pressed_[s]) h = hashCombine(h, bits(rubbed_[s]));
        h = hashCombine(h, bits(fill_[s]) | static_cast<uint64_t>(bits(fillGoal_[s])) << 32);
        for (int k = 0; k < count_[s]; ++k) {
            const Bond& b = bondsOf(s)[k];
            h = hashCombine(h, b.other | static_cast<uint64_t>(bits(b.rest)) << 32);
            h = hashCombine(h, bits(b.weight));
        }
    }
    // Which slot is taken next.
    return hashCombine(h, free_.empty() ? 0 : free_[free_.size() - 1]);
}

} // namespace thaw
