// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/shelf.h"
#include "base/state_io.h"
#include "geometry/mesh_fill.h"

#include <algorithm>
#include <memory>
#include <vector>

namespace thaw {

// What a collider's mesh is made into, in its own space and scaled.
struct ColliderForm {
    uint64_t key = 0;
    CleanMesh mesh;
    DistanceGrid grid;
    void state(StateIo& io);
};
using ColliderForms = Shelf<ColliderForm>;

// One obstacle as a signed distance, positive outside of it. It stands still, or moves through a sub-step from
// `transform` by `shift` and `turn`.
struct Collider {
    thawColliderType type = thawCollider_plane;
    Transform transform; // now; during a sub-step where it was at its start
    Vec3 size;
    bool adhesive = true, occluder = true;
    bool alive = false;
    float slipLength = 0;         // m, how far behind the wall the liquid's velocity would be the wall's; 0 sticks
    float friction = 0.5f;        // Coulomb coefficient of what is solid or rigid on it
    float temperature = NAN;      // K, of what heats and cools by contact; NaN: adiabatic
    float conductance = INFINITY; // W/(m^2 K), of that contact
    std::shared_ptr<const DistanceGrid> grid; // mesh: scaled, but neither turned nor moved
    std::shared_ptr<const CleanMesh> mesh;    // mesh: of the same space, for rays
    uint64_t form = 0;                        // mesh: the key of both
    void take(const std::shared_ptr<const ColliderForm>& made) {
        grid = {made, &made->grid}, mesh = {made, &made->mesh}, form = made->key;
    }
    // All that lives from step to step. Forms that are not there are refused.
    void state(StateIo& io, const ColliderForms& forms);

    bool heats() const { return alive && conductance > 0 && std::isfinite(temperature); }

    bool report = false;    // the host asks for its impulse
    bool kinematic = false; // the host has moved it: what hangs on it is kept apart from what hangs on the rest
    bool hasTarget = false; // where it shall be at the end of the next step
    Transform target;       // valid with hasTarget
    Transform next;         // at the end of the sub-step in hand
    bool moves = false;     // shift, turn and rate are of the sub-step in hand, or the last one
    Vec3 shift;             // m
    Quat turn;              // about transform.position
    float rate = 0;         // 1/s, one over the length of the sub-step
    double impulse[6] = {}; // N s and N m s about transform.position, of the last step, with `report`

    // Way of the material point at x in the sub-step, m; exact also for large turns.
    Vec3 displacement(Vec3 x) const {
        const Vec3 u{turn.x, turn.y, turn.z}, t = 2 * cross(u, x - transform.position);
        return shift + (turn.w * t + cross(u, t));
    }
    Vec3 velocityAt(Vec3 x) const { return moves ? rate * displacement(x) : Vec3{}; } // m/s
    // No point within `radius` of x goes farther in the sub-step.
    float reachOfMotion(Vec3 x, float radius) const;
    // Its place a share of the sub-step later.
    Transform at(float share) const;
    // Sets shift, turn and rate for a sub-step of dt that ends at `to`.
    void moveTo(const Transform& to, float dt);

    // Distance from p to the surface in m, > 0 outside; normal is the unit outward direction (gradient) there. Sizes
    // are in m: the transform's scale is not applied to them. Infinity and +y when p is not finite, or a mesh has no
    // grid.
    float distance(Vec3 p, Vec3& normal) const;
    // The same at a share of the sub-step.
    float distance(Vec3 p, Vec3& normal, float share) const;
    // m, how deep its inside is at the least where it is thin; 0 for a mesh, which may have any form.
    float halfThickness() const {
        return type == thawCollider_plane    ? INFINITY
               : type == thawCollider_sphere ? size.x
               : type == thawCollider_box    ? std::min(size.x, std::min(size.y, size.z))
                                             : 0;
    }
    // Bounds, infinite for a plane, empty for a mesh without triangles.
    Box bounds() const;
    // Bounds of all places in the sub-step.
    Box sweptBounds() const;
};

// Place on the straight way from one to the other, turned the short way round.
Transform between(const Transform& from, const Transform& to, float share);

// The colliders near a block of rows: rows of a block lie together, so most colliders are ruled out once for all.
class WallFinder {
public:
    // Those that some point of the box may be nearer to than `reach` in the sub-step. bounds: swept ones of every
    // collider, or null when they are not at hand.
    void gather(const Collider* colliders, const Box* bounds, int colliderCount, const Box& box, float reach);
    bool empty() const { return count_ == 0; }
    bool moving() const { return motion_ > 0; }
    float motion() const { return motion_; } // m, no point of any near the box goes farther in the sub-step
    // Calls f(distance, normal, collider) at p for every one of them, in order of index; f may move p. Those whose
    // bounds are farther than `reach` may be left out. Places are those at `share` of the sub-step.
    template <class F> void forNear(const Vec3& p, float reach, F&& f, float share = 0) const {
        Vec3 n;
        if (all_) {
            for (int c = 0; c < colliderCount_; ++c)
                if (colliders_[c].alive && !(bounds_ && beyond(bounds_[c], p, reach))) {
                    const float d = colliders_[c].distance(p, n, share);
                    f(d, n, colliders_[c]);
                }
            return;
        }
        for (int k = 0; k < count_; ++k) {
            const Near& w = near_[k];
            if (beyond(w.bounds, p, reach)) continue;
            float d;
            if (w.collider->moves)
                d = w.collider->distance(p, n, share);
            else if (w.collider->type == thawCollider_plane)
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
    float motion_ = 0;
    bool all_ = false;
};

} // namespace thaw
