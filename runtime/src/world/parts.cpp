// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world/parts.h"

#include "geometry/triangle_tree.h"

#include <memory>

namespace thaw {

thawResult assignParts(const thawBodyDef& def, const CleanMesh& body, const Transform& place,
                       const std::vector<Vec3>& points, Tasks& tasks, std::vector<uint8_t>& material,
                       std::string& message) {
    constexpr int kBlock = 256;
    material.assign(points.size(), static_cast<uint8_t>(def.material.index1 - 1));
    std::unique_ptr<TriangleTree> surface; // of the body, made for the first part that asks for depth
    for (int32_t k = 0; k < def.partCount; ++k) {
        const thawBodyPart& part = def.parts[k];
        const uint8_t own = static_cast<uint8_t>(part.material.index1 - 1);
        const auto assign = [&](auto&& holds) {
            tasks.forBlocks(static_cast<int>(points.size()), kBlock, [&](int begin, int end, int, int) {
                for (size_t i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i)
                    if (holds(points[i])) material[i] = own;
            });
        };
        if (!part.mesh.vertices) {
            if (!surface) surface = std::make_unique<TriangleTree>(body.vertices, body.indices);
            const float deep = part.depth * part.depth;
            assign([&](Vec3 x) { return surface->nearest(x, TriangleTree::kNoHint, deep).distance2 >= deep; });
            continue;
        }
        CleanMesh mesh;
        const thawResult r = cleanMesh(part.mesh, place, mesh, message);
        if (r != thawResult_ok) {
            message = "parts[" + std::to_string(k) + "].mesh: " + message;
            return r;
        }
        const TriangleTree tree(mesh.vertices, mesh.indices);
        assign([&](Vec3 x) { return tree.winding(x) > 0.5f; });
    }
    return thawResult_ok;
}

} // namespace thaw
