// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// What the host's changes of materials and colliders do to bonds.
#include "motion/bonds.h"

namespace thaw {

int Bonds::wakeAll(Particles& p, int material) {
    int woken = 0;
    for (size_t i = 0; i < static_cast<size_t>(p.count); ++i) {
        constexpr int kBoth = kFixed | kAsleep;
        if (!p.bondSlot[i] || (p.flags[i] & kBoth) != kBoth || (material >= 0 && p.material[i] != material)) continue;
        // What was never looked at may hang on a wall.
        if (calm_[p.bondSlot[i]] == kNewborn) continue;
        wake(p, static_cast<uint32_t>(i)), ++woken;
    }
    return woken;
}

void Bonds::harden(Particles& p, const Material* materials) {
    mapRows(p);
    const auto rigid = [&](uint32_t slot) { return !materials[p.material[rowOf_[slot]]].soft(); };
    for (size_t i = 0; i < static_cast<size_t>(p.count); ++i) {
        const uint32_t slot = p.bondSlot[i];
        if (!slot || !rigid(slot)) continue;
        for (int k = count_[slot] - 1; k >= 0; --k)
            if (const uint32_t other = bondsOf(slot)[k].other; rigid(other)) forget(other, slot), forget(slot, other);
        if (count_[slot] > 0) continue;
        drop(slot);
        p.bondSlot[i] = 0;
    }
}

} // namespace thaw
