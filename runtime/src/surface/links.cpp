// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/links.h"

#include <algorithm>
#include <utility>

namespace thaw {
namespace {

constexpr int kNodes = SurfaceField::kNodes, kOwners = 8;

} // namespace

MeshLinks::MeshLinks(Allocator& allocator)
    : cornerPool_(allocator), points_(allocator), begins_(allocator), next_(allocator), triangle_(allocator),
      cursors_(allocator), sources_(allocator) {}

void MeshLinks::clear() { cornerPool_.clear(); }

void MeshLinks::link(const SurfaceField& field, Array<BlockMesh>& meshes, const Array<uint16_t>& codes,
                     const Array<uint16_t>& edgeVertices, const Array<uint8_t>& marked, Tasks& tasks) {
    const Array<int32_t>& order = field.order();
    points_.resizeRaw(codes.size());
    sources_.clear();
    size_t vertices = 0;
    for (int32_t slot : order) {
        const BlockMesh& mesh = meshes[slot];
        vertices = std::max<size_t>(vertices, mesh.vertices.begin + mesh.vertices.capacity);
        if (mesh.triangleCount == 0) continue;
        uint32_t owners = 0, others = 0;
        for (int n = 0; n < kOwners; ++n)
            if (const int owner = upper(field.block(slot), n); owner >= 0) (marked[owner] ? owners : others) |= 1u << n;
        if (owners != 0) sources_.push({slot, owners, others == 0});
    }
    tasks.forBlocks(int(sources_.size()), 16, [&](int begin, int end, int, int) {
        for (int s = begin; s < end; ++s) {
            if (!(sources_[s].owners & 1)) continue; // keeps its own
            const int32_t slot = sources_[s].slot;
            const BlockMesh& mesh = meshes[slot];
            const uint16_t* edges[kOwners];
            uint32_t firsts[kOwners];
            for (int n = 0; n < kOwners; ++n) {
                const int owner = upper(field.block(slot), n);
                edges[n] = owner < 0 ? nullptr : edgeVertices.data() + size_t(owner) * 3 * kNodes;
                firsts[n] = owner < 0 ? 0 : meshes[owner].vertices.begin;
            }
            const uint32_t first = 3 * mesh.triangles.begin;
            for (uint32_t k = first; k < first + 3 * mesh.triangleCount; ++k) {
                const int owner = ownerOf(codes[k]);
                points_[k] = firsts[owner] + edges[owner][codes[k] % (4 * kNodes)];
            }
        }
    });

    begins_.resizeRaw(vertices), cursors_.resizeRaw(vertices);
    const auto forMarked = [&](auto&& f) {
        for (int32_t slot : order)
            if (marked[slot] && meshes[slot].vertexCount > 0) f(meshes[slot]);
    };
    // f(first code of a triangle, which corner) of those in marked blocks.
    const auto forCorners = [&](auto&& f) {
        for (const Source& source : sources_) {
            const BlockMesh& mesh = meshes[source.slot];
            const uint32_t end = 3 * (mesh.triangles.begin + mesh.triangleCount);
            for (uint32_t k = 3 * mesh.triangles.begin; k < end; k += 3)
                if (source.all)
                    f(k, 0), f(k, 1), f(k, 2);
                else
                    for (uint32_t c = 0; c < 3; ++c)
                        if (source.owners >> ownerOf(codes[k + c]) & 1) f(k, c);
        }
    };
    forMarked([&](const BlockMesh& mesh) { std::fill_n(cursors_.data() + mesh.vertices.begin, mesh.vertexCount, 0u); });
    forCorners([&](uint32_t k, uint32_t c) { ++cursors_[points_[k + c]]; });
    forMarked([&](BlockMesh& mesh) {
        uint32_t sum = 0;
        for (uint32_t v = 0; v < mesh.vertexCount; ++v) sum += cursors_[mesh.vertices.begin + v];
        cornerPool_.fit(mesh.corners, sum);
        uint32_t next = mesh.corners.begin;
        for (uint32_t v = mesh.vertices.begin; v < mesh.vertices.begin + mesh.vertexCount; ++v) {
            begins_[v] = next;
            next += std::exchange(cursors_[v], next);
        }
        begins_[mesh.vertices.begin + mesh.vertexCount] = next;
    });
    next_.resizeRaw(cornerPool_.size()), triangle_.resizeRaw(cornerPool_.size());
    constexpr uint32_t kAfter[3] = {1, 2, 0};
    forCorners([&](uint32_t k, uint32_t c) {
        const uint32_t to = cursors_[points_[k + c]]++;
        next_[to] = points_[k + kAfter[c]], triangle_[to] = k / 3;
    });
}

} // namespace thaw
