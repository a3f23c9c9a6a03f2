// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/colliders.h"

namespace thaw {

// No centre of a particle gets nearer to a wall than this, in spacings.
inline constexpr float kWallStandoff = 0.3f;
// Nor moves a particle that is nearer already out faster than this many spacings in a step.
inline constexpr float kWallRecovery = 0.2f;

// The colliders near a block of rows: rows of a block lie together, so most colliders are ruled out once for all.
class WallFinder {
public:
    // Those that some point of the box may be nearer to than `reach`.
    void gather(const Collider* colliders, const Box* bounds, int colliderCount, const Box& box, float reach);
    bool empty() const { return count_ == 0; }
    // Calls f(collider) for every one of them, in order of index.
    template <class F> void forNear(F&& f) const {
        if (all_) {
            for (int c = 0; c < colliderCount_; ++c)
                if (colliders_[c].alive) f(colliders_[c]);
        } else {
            for (int k = 0; k < count_; ++k) f(colliders_[near_[k]]);
        }
    }

private:
    static constexpr int kNear = 32;
    const Collider* colliders_ = nullptr;
    int near_[kNear], count_ = 0, colliderCount_ = 0;
    bool all_ = false;
};

} // namespace thaw
