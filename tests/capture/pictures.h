// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include "view/image.h"

namespace thaw::test {

struct Mean {
    double r = 0, g = 0, b = 0; // 0..255, sRGB
    double luminance() const { return 0.2126 * r + 0.7152 * g + 0.0722 * b; }
};

/// Mean of a rectangle given in parts of the picture, 0..1 from the upper left.
Mean meanOf(const view::Image& image, double x0, double y0, double x1, double y1);
/// Where an artefact of a test goes; the folder is made.
std::string artefact(const char* name);

} // namespace thaw::test
