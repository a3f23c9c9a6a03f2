// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include "view/color_map.h"
#include "view/renderer.h"

#include <vector>

namespace thaw::view {

/// What the colours of one picture stand for.
struct DataScale {
    float temperatureLow = 0, temperatureHigh = 0; // K
    float low = 0, high = 1;                       // of the particles' colours, in the unit of their legend
    std::array<int, kLevelColors> levelCounts{};   // particles by level
};
/// As the view asks for it, or from the data. values: 0..1 in the heat colours for each particle; none without them.
DataScale dataScale(const Scene& scene, const View& view, std::vector<float>& values);
/// The scale or key that goes with a picture; nothing for one that needs none.
Image legendOf(const Scene& scene, const View& view, const DataScale& scale, int size);

} // namespace thaw::view
