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

// The colliders near a block of rows: rows of a block lie together, so most colliders are ruled out once for all.
class WallFinder {
public:
    // Those that some point of the box may be nearer to than `reach`. bounds: of every collider, or null when they are
    // not at hand.
    void gather(const Collider* colliders, const Box* bounds, int colliderCount, const Box& box, float reach);
    bool empty() const { return count_ == 0; }
    // Calls f(distance, normal, collider) at p for every one of them, in order of index; f may move p. Those whose
    // bounds are farther than `reach` may be left out.
    template <class F> void forNear(const Vec3& p, float reach, F&& f) const {
        Vec3 n;
        if (all_) {
            for (int c = 0; c < colliderCount_; ++c)
                if (colliders_[c].alive && !(bounds_ && beyond(bounds_[c], p, reach))) {
                    const float d = colliders_[c].distance(p, n);
                    f(d, n, colliders_[c]);
                }
            return;
        }
        for (int k = 0; k < count_; ++k) {
            const Near& w = near_[k];
            if (beyond(w.bounds, p, reach)) continue;
            float d;
            if (w.collider->type == thawCollider_plane)
                d = dot(w.normal, p - w.collider->transform.position), n = w.normal;
            else
                d = w.collider->distance(p, n);
            f(d, n, *w.collider);
        }
    }

private:
    static constexpr int kNear = 32;
    struct Near {
        const Collider* collider;
        Box bounds;
        Vec3 normal; // of a plane, which is the same everywhere: turning it for every particle was half the cost
    };
    // With a margin for grids, whose slope is not quite 1: one may say less than the distance to its bounds.
    static bool beyond(const Box& b, Vec3 p, float reach) {
        const float r = 1.25f * reach;
        return p.x < b.lower.x - r || p.x > b.upper.x + r || p.y < b.lower.y - r || p.y > b.upper.y + r ||
               p.z < b.lower.z - r || p.z > b.upper.z + r;
    }

    const Collider* colliders_ = nullptr;
    const Box* bounds_ = nullptr;
    Near near_[kNear];
    int count_ = 0, colliderCount_ = 0;
    bool all_ = false;
};

} // namespace thaw
