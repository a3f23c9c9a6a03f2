// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "base/types.h"

namespace thaw {

// What the mesher reads. Several spacings may stand side by side.
struct SurfaceInput {
    int count = 0;
    const Vec4* positions = nullptr;     // xyz, w: support radius h = 2.2 * spacing of that particle
    const float* temperatures = nullptr; // K
    const float* liquidFractions = nullptr;
    const uint8_t* materials = nullptr;
    const uint8_t* flags = nullptr; // thawParticleFlags
    float spacing = 0;              // m, of level 0
};

// The mesh of the melt: a distance-like field on sparse blocks, triangles, smoothed, with attributes.
class Surface {
public:
    explicit Surface(Allocator& allocator);

    // cellSize in spacings, smoothing in passes. Output is the same on any number of workers. Watertight.
    void extract(const SurfaceInput& input, float cellSize, int smoothing, Tasks& tasks);

    Array<Vec3> positions, normals;
    Array<float> temperatures, liquidFractions;
    Array<uint8_t> materials;
    Array<uint32_t> indices;

private:
    struct Block;
    Allocator& allocator_;
};

} // namespace thaw
