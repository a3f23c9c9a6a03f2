// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/kernel.h"

#include <algorithm>

namespace thaw {

// No centre of a particle gets nearer to a wall than this, in spacings.
inline constexpr float kWallStandoff = 0.3f;
// Nor to the surface of what is held, half a spacing outside of the outermost fixed particles.
inline constexpr float kHeldStandoff = 0.3f;
// Nor moves a particle that is nearer already out faster than this many spacings in a step.
inline constexpr float kWallRecovery = 0.2f;

// How much of the first layer at a wall is this many spacings from it: of layers a spacing apart these add up to one.
// The first layer alone takes the drag mu A u / d, which is right for linear shear and for a plug. (The kernel's
// integral over the wall is 8 % short of it at half a spacing, 28 % at 0.6: films with a yield stress ran 16 %
// thinner.)
inline float firstLayer(float d) {
    const float s = std::clamp((d - 0.8f) / 0.4f, 0.0f, 1.0f);
    return 1 - s * s * (3 - 2 * s);
}

// The signed distance, in supports, at which a flat solid fills this share of the support: the table inverted.
inline float wallDistance(float filled) {
    const float* table = wallTable().fraction;
    int low = 0, high = WallTable::kSize; // table[low] >= filled >= table[high]
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        (table[middle] >= filled ? low : high) = middle;
    }
    const float between = table[low] > table[high] ? (table[low] - filled) / (table[low] - table[high]) : 0.0f;
    return -1 + 2 * (static_cast<float>(low) + std::clamp(between, 0.0f, 1.0f)) / WallTable::kSize;
}

} // namespace thaw
