// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/types.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace thaw {

// A bounding box tree over triangles that answers two questions: how often does the mesh wind around a point, and what
// is the nearest point of it. Built once, then read from any thread. At most 2^27 triangles.
class TriangleTree {
public:
    // Indices must be in range; nothing is kept of the input. Throws std::bad_alloc.
    TriangleTree(const std::vector<Vec3>& vertices, const std::vector<uint32_t>& indices);

    // Generalised winding number: 1 inside a closed outward mesh, 0 outside, between them near holes. Far groups of
    // triangles enter by their dipole and quadrupole (Barill et al. 2018); error below 0.1.
    float winding(Vec3 q) const;

    struct Nearest {
        float distance2 = INFINITY; // m^2
        uint32_t triangle = 0;      // a number of the tree, to be used as hint; not of the input
        Vec3 point;
    };
    static constexpr uint32_t kNoHint = 0xffffffffu;
    // Nearest point within sqrt(maxDistance2), else distance2 = maxDistance2 is returned. The triangle of a query
    // nearby as hint saves most of the search.
    Nearest nearest(Vec3 q, uint32_t hint = kNoHint, float maxDistance2 = INFINITY) const;
    // Unit normal of a tree triangle, by the order of its corners.
    Vec3 triangleNormal(uint32_t triangle) const;

    size_t triangleCount() const { return triangles_.size(); }

private:
    struct Triangle {
        Vec3 a, b, c;
    };
    // Boxes of both children side by side, {lower, lower, -upper, -upper} per axis, so that both distances come from
    // one walk through a vector; and what they are: leaf bit and first triangle << 3 | count, or the number of the
    // node.
    struct alignas(16) Node {
        float x[4], y[4], z[4];
        uint32_t child[2];
        void setBox(int side, const Box& box);
        Box box(int side) const;
    };
    struct Moments { // of one child
        Vec3 center;
        float reach2;     // beyond this squared distance the expansion is used
        Vec3 dipole;      // sum of area vectors
        float xx, yy, zz; // sum of (centroid - center) area vector^T, symmetric part
        float xy, xz, yz; // each the sum of both off-diagonal entries
    };
    struct Build;
    std::vector<Triangle> triangles_;
    std::vector<Node> nodes_;
    std::vector<Moments> moments_; // two per node
};

// The winding number by summing every triangle in double: slow, for checks.
double exactWinding(const std::vector<Vec3>& vertices, const std::vector<uint32_t>& indices, Vec3 q);

} // namespace thaw
