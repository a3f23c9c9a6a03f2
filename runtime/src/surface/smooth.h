// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "base/types.h"
#include "surface/smooth_simd.h"

namespace thaw {

// Smoothing and normals of a closed manifold mesh.
class MeshSmoother {
public:
    explicit MeshSmoother(Allocator& allocator);

    // Reads who is next to whom; keeps looking at the indices. The mesh must be closed: each vertex then sees each
    // neighbour in exactly one corner.
    void connect(size_t vertexCount, const Array<uint32_t>& indices);
    // w is the vertex's mobility, 0..1: its share of the motion along the normal; 0 only evens out the triangles.
    void smooth(Array<Vec4>& positions, int passes, Tasks& tasks);
    // Unit, outward; averaged with their neighbours' passes times.
    void normals(const Array<Vec4>& positions, Array<Vec4>& out, int passes, Tasks& tasks);

    // Of the mesh that was connected.
    MeshCorners corners() const { return {begins_.data(), next_.data(), triangle_.data()}; }

private:
    Array<uint32_t> begins_, next_, triangle_;
    const uint32_t* indices_ = nullptr;
    Array<Vec4> other_, triangleNormals_;
};

} // namespace thaw
