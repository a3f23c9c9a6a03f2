// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/mesh_fill.h"

#include <memory>
#include <vector>

namespace thaw {

// One static obstacle as a signed distance, positive outside of it.
struct Collider {
    thawColliderType type = thawCollider_plane;
    Transform transform;
    Vec3 size;
    bool adhesive = true, occluder = true;
    bool alive = false;
    std::shared_ptr<const DistanceGrid> grid; // mesh: world space, transform already applied
    std::shared_ptr<const CleanMesh> mesh;    // mesh: for rays
    // Distance from p to the surface in m, > 0 outside; normal is the unit outward direction (gradient) there. Sizes
    // are in m: the transform's scale is not applied to them. Infinity and +y when p is not finite, or a mesh has no
    // grid.
    float distance(Vec3 p, Vec3& normal) const;
    // Bounds, infinite for a plane, empty for a mesh without triangles.
    Box bounds() const;
};

} // namespace thaw
