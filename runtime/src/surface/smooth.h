// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "base/types.h"
#include "surface/smooth_simd.h"

namespace thaw {

// Vertices and triangles that stand side by side.
struct MeshSpan {
    uint32_t vertexBegin, vertexEnd, triangleBegin, triangleEnd;
};

// Smoothing and normals of a closed manifold mesh, of some of its spans: the others keep theirs, and what they were
// after each step.
class MeshSmoother {
public:
    explicit MeshSmoother(Allocator& allocator);

    // How far one vertex shows in another's normal, in edges; passes: up to kKept.
    static constexpr int kKept = 1;
    static constexpr int reach(int passes) { return kSteps * passes + 1 + kNormalPasses; }
    // points: three a triangle. w of a position is the vertex's mobility, 0..1: its share of the motion along the
    // normal; 0 only evens out the triangles. Of more passes than kKept all spans must be given. Normals are unit,
    // outward.
    void smooth(const MeshCorners& corners, const uint32_t* points, const Array<Vec4>& positions, size_t triangles,
                const Array<MeshSpan>& spans, int passes, Tasks& tasks);

    // Of the last call; the first as long as the positions that were given.
    const Vec4* positions() const { return positions_; }
    const Vec4* normals() const { return normals_[kNormalPasses].data(); }

private:
    static constexpr int kSteps = 4;
    // Shading shows bumps that the outline does not: two passes hide them on disordered particles, three flatten drips.
    static constexpr int kNormalPasses = 2;

    Array<Vec4> steps_[kKept * kSteps], triangleNormals_, normals_[1 + kNormalPasses];
    const Vec4* positions_ = nullptr;
};

} // namespace thaw
