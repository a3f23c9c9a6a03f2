// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "base/types.h"

namespace thaw {

// Smoothing and normals of a closed manifold mesh.
class MeshSmoother {
public:
    explicit MeshSmoother(Allocator& allocator);

    // Reads who is next to whom. The mesh must be closed: each vertex then sees each neighbour in exactly one corner.
    void connect(size_t vertexCount, const Array<uint32_t>& indices);
    // mobility per vertex, 0..1: share of the motion along the normal; 0 only evens out the triangles.
    void smooth(Array<Vec3>& positions, const Array<float>& mobility, int passes, Tasks& tasks);
    // Unit, outward; averaged with their neighbours' passes times.
    void normals(const Array<Vec3>& positions, Array<Vec3>& out, int passes, Tasks& tasks);

private:
    void sweep(const Array<Vec3>& from, Array<Vec3>& to, const Array<float>& mobility, float step, Tasks& tasks) const;

    Vec3 normalAt(const Array<Vec3>& positions, size_t v) const;

    struct Corner {
        uint32_t next, previous; // the other two vertices of a triangle, in its order
    };
    Array<uint32_t> begins_;
    Array<Corner> corners_;
    Array<Vec3> other_;
};

} // namespace thaw
