// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include "view/mesh.h"

#include <memory>
#include <vector>

namespace thaw::view {

/// What is drawn of the paths and shapes that lead melt.
enum class RegionKind {
    path,      // the stream's tube
    direction, // which way it flows
    contour,
    reach, // from where a shape draws melt
    target // a mesh that melt gathers in
};
constexpr int kRegionKinds = 5;

struct Region {
    RegionKind kind = RegionKind::path;
    std::shared_ptr<const TriangleMesh> mesh; // in the world; not null; must not change while a renderer knows it
};

/// Linear RGB; they stay apart for the common kinds of colour blindness (M. Okabe, K. Ito, 2008).
Vec3 regionColor(RegionKind kind);
/// "path", "its way", ...
const char* regionName(RegionKind kind);

/// Tube and arrows of a path. position and rotation: of its collider, or none.
std::vector<Region> pathRegions(const thawPathDef& def, Vec3 position = {0, 0, 0}, thawQuat rotation = {0, 0, 0, 1});
/// Contours and how far they reach, or the mesh, of a shape. position and rotation: of its collider, or none.
std::vector<Region> shapeRegions(const thawShapeDef& def, Vec3 position = {0, 0, 0}, thawQuat rotation = {0, 0, 0, 1});

} // namespace thaw::view
