// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include "thaw/thaw.h"

#include <array>

namespace thaw::view {

/// Cold to hot: dark blue, violet, red, orange. Lightness rises evenly, so that order can be read without hue.
/// t in 0..1, clamped. Linear RGB.
thawVec3 heatColor(float t);

/// Where the colour of a particle's level is in the heat colours.
constexpr int kLevelColors = 4;
constexpr float levelTint(int level) {
    return level < kLevelColors ? static_cast<float>(level) / static_cast<float>(kLevelColors - 1) : 1.0f;
}

enum class Phase { solid, mushy, liquid };
constexpr float kSolidBelow = 0.02f, kLiquidAbove = 0.98f; // liquid fractions that part the phases in pictures
Phase phaseOf(float liquidFraction);
/// Linear RGB; three colours that stay apart for the common kinds of colour blindness.
thawVec3 phaseColor(Phase phase);

/// 0..1 linear to 0..255 sRGB.
unsigned char encodeSrgb(float linear);

} // namespace thaw::view
