// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace thaw {

// Triangles of a cube whose corners are inside or not (Lorensen & Cline 1987), derived instead of typed.
// Corner c is at (c & 1, c >> 1 & 1, c >> 2 & 1). Edge 4 * axis + k starts at edgeStart[...] and runs along its axis.
struct CubeCases {
    static constexpr int kMaxTriangles = 5;
    uint8_t triangleCount[256];
    uint8_t triangles[256][3 * kMaxTriangles]; // edges; counter-clockwise seen from outside
    uint8_t edgeStart[12];                     // corner with the lower coordinate

    CubeCases();
};

// The one table of the process; constant after its first use.
const CubeCases& cubeCases();

} // namespace thaw
