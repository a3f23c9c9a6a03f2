// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include "view/math.h"

namespace thaw::view {

/// Where a picture is taken from.
struct Camera {
    Vec3 eye{0, 0.1f, 0.5f}, target{0, 0.1f, 0}, up{0, 1, 0}; // m
    float fieldOfView = 0.5f;                                 // rad, vertical; range 0.01..3
};

/// How a camera goes around what it looks at.
struct Orbit {
    float azimuth = 0.45f;     // rad about +y, 0 looks along -z
    float elevation = 0.16f;   // rad above the horizon; range -1.5..1.5
    float fieldOfView = 0.42f; // rad, vertical
    float margin = 1.12f;      // 1, room around the bounds; 1 touches the frame
};

/// Camera that sees all of the bounds in a picture of this aspect (width / height). Empty bounds: a default camera.
Camera frame(const Bounds& bounds, const Orbit& orbit, float aspect);

/// Bounds of the vertices of a surface; empty when it has none.
Bounds surfaceBounds(const thawSurfaceView& surface);

} // namespace thaw::view
