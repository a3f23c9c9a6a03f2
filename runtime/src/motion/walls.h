// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/colliders.h"

namespace thaw {

// No centre of a particle gets nearer to a wall than this, in spacings.
inline constexpr float kWallStandoff = 0.3f;
// Nor to the surface of what is held, half a spacing outside of the outermost fixed particles.
inline constexpr float kHeldStandoff = 0.3f;
// Nor moves a particle that is nearer already out faster than this many spacings in a step.
inline constexpr float kWallRecovery = 0.2f;

// The colliders near a block of rows: rows of a block lie together, so most colliders are ruled out once for all.
class WallFinder {
public:
    // Those that some point of the box may be nearer to than `reach`.
    void gather(const Collider* colliders, const Box* bounds, int colliderCount, const Box& box, float reach);
    bool empty() const { return count_ == 0; }
    // Calls f(distance, normal, collider) at p for every one of them, in order of index; f may move p.
    template <class F> void forNear(const Vec3& p, F&& f) const {
        Vec3 n;
        if (all_) {
            for (int c = 0; c < colliderCount_; ++c)
                if (colliders_[c].alive) {
                    const float d = colliders_[c].distance(p, n);
                    f(d, n, colliders_[c]);
                }
            return;
        }
        for (int k = 0; k < count_; ++k) {
            const Near& w = near_[k];
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
        Vec3 normal; // of a plane, which is the same everywhere: turning it for every particle was half the cost
    };
    const Collider* colliders_ = nullptr;
    Near near_[kNear];
    int count_ = 0, colliderCount_ = 0;
    bool all_ = false;
};

} // namespace thaw
