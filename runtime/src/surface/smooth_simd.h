// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/types.h"

#include <cstdint>

namespace thaw {

// Corners of a mesh by vertex: those of v are [begins[v], begins[v + 1]).
struct MeshCorners {
    const uint32_t* begins;
    const uint32_t* next;     // the vertex after it in its triangle
    const uint32_t* triangle; // its triangle
};

// Of vertices [begin, end). xyz: to = from + step (mean of the neighbours - from), without 1 - w of the part along the
// vertex's normal; w stays.
void moveToNeighbors(const MeshCorners& mesh, const uint32_t* indices, const Vec4* from, Vec4* to, float step,
                     int begin, int end);
// Twice the area times the normal of triangles [begin, end).
void triangleNormals(const uint32_t* indices, const Vec4* positions, Vec4* out, int begin, int end);
// Unit normals of vertices [begin, end): of the sum over their triangles, or over themselves and their neighbours.
void normalsOfTriangles(const MeshCorners& mesh, const Vec4* triangles, Vec4* out, int begin, int end);
void meanNormals(const MeshCorners& mesh, const Vec4* from, Vec4* to, int begin, int end);

} // namespace thaw
