// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "surface/field.h"
#include "surface/ranges.h"
#include "surface/smooth.h"

namespace thaw {

// What a block brings to the mesh.
struct BlockMesh {
    RangePool::Range vertices, triangles, corners; // in the arrays by block; one vertex to spare
    uint32_t vertexCount = 0, triangleCount = 0;
    uint32_t vertexBegin = 0, triangleBegin = 0; // in the mesh that is shown
    bool moved = false;                          // by the last update: they are not what they were
    int plain = -1;                              // the one material that all of it is of; -1: of several

    MeshSpan span() const {
        return {vertices.begin, vertices.begin + vertexCount, triangles.begin, triangles.begin + triangleCount};
    }
};

// Triangles and who is next to whom, in the arrays by block: kept for blocks that keep their own and their neighbours'
// vertices. Corners of triangles come as edges: 4 x which upper block + axis, x 512 + node.
class MeshLinks {
public:
    explicit MeshLinks(Allocator& allocator);
    void clear(); // forgets all blocks' corners

    // Of the blocks that are marked, by slot; edgeVertices: by slot, axis and node, the vertex on that edge, counted
    // from its block's first.
    void link(const SurfaceField& field, Array<BlockMesh>& meshes, const Array<uint16_t>& codes,
              const Array<uint16_t>& edgeVertices, const Array<uint8_t>& marked, Tasks& tasks);

    const uint32_t* points() const { return points_.data(); } // three a triangle, as vertices
    // The mesh must be closed: each vertex then sees each neighbour in exactly one corner.
    MeshCorners corners() const { return {begins_.data(), next_.data(), triangle_.data()}; }

    static int ownerOf(uint16_t code) { return code >> 11; }
    // Block at (+1 if bit 0, +1 if bit 1, +1 if bit 2) of another.
    static int upper(const SurfaceField::Block& block, int bits) {
        return block.near[SurfaceField::nearAt(bits & 1, bits >> 1 & 1, bits >> 2 & 1)];
    }

private:
    struct Source { // a block whose triangles have corners in marked ones
        int32_t slot;
        uint32_t owners; // bits: which of its upper blocks are marked
        bool all;        // are
    };

    RangePool cornerPool_;
    Array<uint32_t> points_, begins_, next_, triangle_;
    Array<uint32_t> cursors_; // by vertex
    Array<Source> sources_;
};

} // namespace thaw
