// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "base/types.h"
#include "surface/field.h"
#include "surface/links.h"
#include "surface/mesh.h"
#include "surface/mixtures.h"
#include "surface/origins.h"
#include "surface/ranges.h"
#include "surface/smooth.h"

namespace thaw {

// The mesh of the melt: a field on sparse blocks, marching cubes, smoothed, with attributes. Everything is kept between
// calls: blocks around which nothing has changed are not meshed again, and extracting as much as the last time
// allocates nothing. What comes out depends on the input alone.
class Surface : public SurfaceMesh {
public:
    explicit Surface(Allocator& allocator);

    // cellSize in spacings, smoothing in passes. Output is the same on any number of workers. Watertight and manifold.
    // Throws std::bad_alloc when the allocator refuses; the arrays are then empty. Input that is what it was the last
    // time leaves the mesh as it is and takes a look at it only.
    void extract(const SurfaceInput& input, float cellSize, int smoothing, Tasks& tasks);

    int made() const { return made_; }                     // meshes since the beginning
    int64_t meshedBlocks() const { return blocksMeshed_; } // of them all

private:
    struct Warmth {
        float temperature, liquidFraction;
    };

    void drop();
    void meshBlocks(const SurfaceInput& input, bool all, Tasks& tasks);
    void followRows();
    void count(int slot);
    void emit(int slot, const SurfaceInput& input, int worker);
    void emitVertex(int slot, int x, int y, int z, int axis, const OriginFinder& finder, const SurfaceInput& input,
                    uint32_t to);
    void markNear(bool all);
    void blend(Tasks& tasks);
    void finishShape(bool all, int smoothing, Tasks& tasks);
    void assemble(Tasks& tasks);
    bool keepWarmth(const SurfaceInput& input);
    void setWarmth(Tasks& tasks);

    SurfaceField field_;
    MeshLinks links_;
    MeshSmoother smoother_;
    MixtureBlender blender_;
    bool blended_ = false;    // the blender has the mixtures of all blocks
    Array<BlockMesh> meshes_; // by slot
    Array<int32_t> changed_;
    RangePool vertexPool_, trianglePool_;
    Array<uint8_t> marked_; // by slot: blocks near those that have moved
    Array<MeshSpan> spans_; // theirs

    // By block: vertices before smoothing, w their mobility, what they take their attributes from; and the corners of
    // the triangles, as edges: which upper block, axis and node.
    Array<Vec4> raw_;
    Array<Origins> origins_;
    Array<Mixture> rawMixtures_;
    Array<uint8_t> rawMaterials_;
    Array<uint16_t> rawBodies_;
    Array<uint16_t> codes_;
    Array<uint16_t> edgeVertices_; // by slot, axis and node: the vertex on that edge, counted from the block's first

    Array<float> floats_; // for finding origins, by worker
    Array<uint32_t> ints_;
    int stride_ = 0;
    Array<Warmth> warmth_; // of the particles
    int smoothing_ = -1;   // of the mesh that is there
    int made_ = 0;
    int64_t blocksMeshed_ = 0;
};

} // namespace thaw
