// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "api/surface_buffers.h"

#include <cstring>

namespace thaw {

std::array<SurfaceAttribute, 7> surfaceAttributes(const thawSurfaceBuffers& b) {
    using View = thawSurfaceView;
    return {
        {{"positionOffset", b.positionOffset, 12, 4, [](const View& v) -> const void* { return v.positions; }},
         {"normalOffset", b.normalOffset, 12, 4, [](const View& v) -> const void* { return v.normals; }},
         {"temperatureOffset", b.temperatureOffset, 4, 4, [](const View& v) -> const void* { return v.temperatures; }},
         {"liquidFractionOffset", b.liquidFractionOffset, 4, 4,
          [](const View& v) -> const void* { return v.liquidFractions; }},
         {"materialOffset", b.materialOffset, 1, 1, [](const View& v) -> const void* { return v.materials; }},
         {"bodyOffset", b.bodyOffset, 2, 2, [](const View& v) -> const void* { return v.bodies; }},
         {"mixtureOffset", b.mixtureOffset, 8, 1, [](const View& v) -> const void* { return v.mixtures; }}}};
}

void writeSurface(const thawSurfaceView& view, const thawSurfaceBuffers& b, Tasks& tasks) {
    const auto attributes = surfaceAttributes(b);
    constexpr int kTogether = 4096;
    tasks.forBlocks(view.vertexCount, kTogether, [&](int begin, int end, int, int) {
        // Vertex after vertex: the host's memory may be one that is written past the caches.
        char* vertex =
            static_cast<char*>(b.vertices) + static_cast<size_t>(begin) * static_cast<size_t>(b.vertexStride);
        for (int v = begin; v < end; ++v, vertex += b.vertexStride)
            for (const SurfaceAttribute& a : attributes) {
                if (a.offset < 0) continue;
                const size_t bytes = static_cast<size_t>(a.bytes);
                std::memcpy(vertex + a.offset,
                            static_cast<const char*>(a.source(view)) + static_cast<size_t>(v) * bytes, bytes);
            }
    });
    const int indices = 3 * view.triangleCount;
    if (b.indexSize == 4) {
        if (indices > 0) std::memcpy(b.indices, view.indices, static_cast<size_t>(indices) * 4);
        return;
    }
    uint16_t* to = static_cast<uint16_t*>(b.indices);
    for (int k = 0; k < indices; ++k) to[k] = static_cast<uint16_t>(view.indices[k]);
}

} // namespace thaw
