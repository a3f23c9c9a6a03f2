// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include "view/math.h"

#include <cstdint>
#include <vector>

namespace thaw::view {

/// Triangles with a normal per vertex, counter-clockwise from outside.
struct TriangleMesh {
    std::vector<float> positions; // x y z, m
    std::vector<float> normals;   // x y z, unit; as many as positions
    std::vector<uint32_t> indices;

    Bounds bounds() const;
};

/// Box around the origin.
TriangleMesh makeBox(Vec3 halfExtents);
/// Sphere around the origin.
TriangleMesh makeSphere(float radius, int segments = 48);
/// Square in the plane y = 0, normal +y, with sides of twice halfSize.
TriangleMesh makePlane(float halfSize);
/// Closed cylinder from y = 0 to y = height with a rounded top; a wick, for one.
TriangleMesh makeCylinder(float radius, float height, int segments = 20);
/// Copy of a mesh as thaw takes it, with area-weighted normals. Triangles that name a missing vertex are left out.
TriangleMesh makeMesh(const thawMesh& mesh);

} // namespace thaw::view
