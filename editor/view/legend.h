// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include "view/color_map.h"
#include "view/image.h"
#include "view/regions.h"

#include <array>
#include <string>
#include <vector>

namespace thaw::view {

/// Bar of the heat colours with numbers in degrees Celsius on the left and kelvin on the right. Half-transparent panel.
/// scale: size of the text, 1 = a font 5 x 7.
Image temperatureLegend(float lowKelvin, float highKelvin, int scale);
/// Bar of the heat colours over any range, e.g. "m/s". reversed: the low end is the hot one.
Image rangeLegend(const std::string& title, const std::string& unit, float low, float high, int scale,
                  bool reversed = false);
/// The levels of particles with their colours and how many there are of each.
Image levelLegend(const std::array<int, kLevelColors>& counts, int scale);
/// Solid, mushy and liquid with their colours.
Image phaseLegend(int scale);
/// The kinds of these regions with their colours, each once.
Image regionLegend(const std::vector<Region>& regions, int scale);

} // namespace thaw::view
