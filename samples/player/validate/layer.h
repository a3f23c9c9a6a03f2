// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "validate/lab.h"

namespace thaw::player {

// A layer of liquid on y = 0 with gravity turned by `slope` (radians), so that +x is down the incline: the same as an
// incline, with the particles' lattice along the layer.
struct Layer {
    enum Ground { kPlane, kHeld };
    Lab lab;
    double spacing, length;
    Ground ground;

    // channel: between two walls on which it slides freely, so that it cannot spread. ground: a collider, or a slab of
    // solid that is held, its lattice half a spacing aside of the liquid's.
    Layer(const thawMaterialDef& material, float spacing, int layers, double slope, int along, int across, bool channel,
          Ground ground = kPlane);

    struct Middle {
        double thickness; // m, volume over area
        double surface;   // m/s, of the topmost layer, extrapolated to the surface by the parabola of the theory
        double mean;      // m/s
        double first;     // m, mean height of what is nearest to the ground
    };
    // Of a window of `window` spacings around the middle of all that lies within `side` spacings of the centre line.
    Middle middle(double at, int window = 12, int side = 4) const;
};

} // namespace thaw::player
