// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/mesh_fill.h"
#include "geometry/triangle_tree.h"

namespace thaw {

// Signed distance near the surface only, in bricks of 8 x 8 x 8 cells; elsewhere it is known on which side a brick
// lies. Used while filling: a dense grid of a thin vessel would not fit into memory.
struct BrickGrid {
    static constexpr int kCells = 8, kNodes = kCells + 1;
    static constexpr int32_t kOutside = -1, kInside = -2;
    Vec3 origin;
    float cell = 0;                        // m
    int nx = 0, ny = 0, nz = 0;            // bricks
    float bandInside = 0, bandOutside = 0; // m
    std::vector<int32_t> bricks;           // number of the brick's values, or its side
    std::vector<float> values;             // kNodes^3 per brick

    // Distance and gradient (not normalised). Far away: the band width with its sign, gradient zero.
    float sample(Vec3 p, Vec3& gradient) const;
};
BrickGrid makeBrickGrid(const CleanMesh& mesh, const TriangleTree& tree, float cell, float bandInside,
                        float bandOutside, Tasks& tasks);
// Bricks that makeBrickGrid would look at, to be checked before.
double brickCount(const CleanMesh& mesh, float cell, float bandOutside);

} // namespace thaw
