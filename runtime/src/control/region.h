// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/tasks.h"
#include "geometry/mesh_fill.h"

#include <string>
#include <vector>

namespace thaw {

// Where a shape shall be filled: on one side of closed contours on a plane, or inside a closed mesh. Places are those
// of the control's own space, regional ones p q along the plane and r out of it, or x y z for a mesh.
class Region {
public:
    // What lies inside an odd number of the contours (each closed from its last point to its first), on the plane that
    // they fit best with its upper side as its outside, or across `normal` unless that is 0. False, with the reason,
    // where they enclose nothing.
    bool make(const Vec3* points, const int32_t* sizes, int contours, Vec3 normal, Vec3 up, float spacing,
              std::string& message);
    // Inside of a mesh.
    bool make(const CleanMesh& mesh, float spacing, Tasks& tasks, std::string& message);

    bool flat() const { return flat_; }
    Vec3 into(Vec3 x) const {
        if (!flat_) return x;
        const Vec3 d = x - middle_;
        return {dot(d, u_), dot(d, v_), dot(d, n_)};
    }
    Vec3 outOf(Vec3 regional) const { return flat_ ? middle_ + direction(regional) : regional; }
    Vec3 direction(Vec3 regional) const {
        return flat_ ? regional.x * u_ + regional.y * v_ + regional.z * n_ : regional;
    }
    Vec3 normal() const { return n_; } // of the plane
    // m to the rim, < 0 inside, of a regional place; outward: regional and unit, along the plane if it is flat.
    float distance(Vec3 regional, Vec3& outward) const;
    const Box& bounds() const { return bounds_; } // regional, of the contours or the mesh
    float size() const { return size_; }          // m^2 or m^3
    uint64_t hash() const { return hash_; }
    void state(StateIo& io);

private:
    bool flat_ = false;
    Vec3 middle_, u_{1, 0, 0}, v_{0, 1, 0}, n_{0, 0, 1};
    DistanceGrid grid_; // of a flat one, two equal layers
    Box bounds_;
    float size_ = 0;
    uint64_t hash_ = 0;
};

} // namespace thaw
