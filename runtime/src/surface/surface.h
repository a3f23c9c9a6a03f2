// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "base/types.h"
#include "surface/field.h"
#include "surface/smooth.h"

namespace thaw {

// The mesh of the melt: a field on sparse blocks, marching cubes, smoothed, with attributes. Everything is kept between
// calls, so that extracting as much as the last time allocates nothing.
class Surface {
public:
    explicit Surface(Allocator& allocator);

    // cellSize in spacings, smoothing in passes. Output is the same on any number of workers. Watertight and manifold.
    // Throws std::bad_alloc when the allocator refuses; the arrays are then empty. Input that is what it was the last
    // time leaves the mesh as it is and takes a look at it only.
    void extract(const SurfaceInput& input, float cellSize, int smoothing, Tasks& tasks);

    Array<Vec3> positions, normals;
    Array<float> temperatures, liquidFractions;
    Array<uint8_t> materials;
    Array<uint16_t> bodies;
    struct Mixture { // the largest share first; shares sum to 255
        uint8_t material[4], share[4];
    };
    Array<Mixture> mixtures;
    Array<uint32_t> indices; // three per triangle, counter-clockwise from outside

    int made() const { return made_; } // meshes since the beginning

private:
    // The input of the last mesh.
    struct Last {
        explicit Last(Allocator& a) : position(a), temperature(a), liquidFraction(a), material(a), body(a) {}
        Array<Vec4> position;
        Array<float> temperature, liquidFraction;
        Array<uint8_t> material;
        Array<uint16_t> body;
        float spacing = 0, cellSize = 0;
        int smoothing = -1;
    };
    bool same(const SurfaceInput& input, float cellSize, int smoothing) const;
    void remember(const SurfaceInput& input, float cellSize, int smoothing);

    // What a block brings to the mesh; its vertices and its indices are one range each.
    struct BlockMesh {
        uint32_t vertexBegin, vertexCount;
        uint32_t indexBegin, indexCount;
    };

    void clear();
    void makeMesh(const SurfaceInput& input, float cellSize, Tasks& tasks);
    void count(int block);
    void emit(int block, const SurfaceInput& input);

    SurfaceField field_;
    MeshSmoother smoother_;
    Array<BlockMesh> meshes_;
    Array<uint16_t> edgeVertices_; // per block, axis and node: the vertex on that edge, counted from the block's first
    Last last_;
    int made_ = 0;
    Array<float> mobility_; // per vertex: share of the smoothing that it takes, 0 in small drops
};

} // namespace thaw
