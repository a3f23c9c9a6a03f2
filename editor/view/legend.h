// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include "view/image.h"

#include <string>

namespace thaw::view {

/// Bar of the heat colours with numbers in degrees Celsius on the left and kelvin on the right. Half-transparent panel.
/// scale: size of the text, 1 = a font 5 x 7.
Image temperatureLegend(float lowKelvin, float highKelvin, int scale);
/// Bar of the heat colours over any range, e.g. "m/s".
Image rangeLegend(const std::string& title, const std::string& unit, float low, float high, int scale);
/// Solid, mushy and liquid with their colours.
Image phaseLegend(int scale);

} // namespace thaw::view
