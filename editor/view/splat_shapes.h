// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include "view/math.h"

#include <vector>

namespace thaw::view {

/// A particle as an ellipsoid of revolution.
struct SplatShape {
    Vec3 center, axis; // m; unit, out of the surface
    float along, out;  // m, half axes along the surface and out of it
};

/// Ellipsoids for the particles of a melt, in their order: balls inside and where one is alone, flat where there is a
/// surface. Those of a surface are moved along their normals toward what their neighbours that look the same way say,
/// so that beads at outlines go and drips and sheets keep their thickness. positions and count must be set, normals and
/// levels may be. spacing: m, at level 0.
void makeSplatShapes(const thawParticleView& particles, float spacing, std::vector<SplatShape>& out);

} // namespace thaw::view
