// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/mesh_fill.h"

#include <vector>

namespace thaw {

struct Flat {
    float x = 0, y = 0;
};

// Distance to closed contours in a plane, negative inside an odd number of them, on a grid with two equal layers
// (sample it half a cell up). Contours lie one after the other in `points`, sizes[k] points each. Exact to where the
// nearest edge of two is nearly as near. cell is enlarged when it would need more than maxNodes nodes. Returns the area
// inside.
float outlineDistance(const std::vector<Flat>& points, const int32_t* sizes, int contours, float cell, float margin,
                      size_t maxNodes, DistanceGrid& out);

} // namespace thaw
