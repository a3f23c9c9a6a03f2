// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/walls.h"

namespace thaw {

void WallFinder::gather(const Collider* colliders, const Box* bounds, int colliderCount, const Box& box, float reach) {
    count_ = 0, colliders_ = colliders, all_ = false, colliderCount_ = colliderCount;
    if (box.empty()) return;
    const Vec3 center = 0.5f * (box.lower + box.upper), grow{reach, reach, reach};
    const Vec3 lower = box.lower - grow, upper = box.upper + grow;
    // No distance changes faster than the point moves; the rest is for grids, whose slope is not quite 1.
    const float far = 1.25f * (0.5f * length(box.upper - box.lower) + reach);
    for (int c = 0; c < colliderCount; ++c) {
        const Box& b = bounds[c];
        if (!colliders[c].alive || b.lower.x > upper.x || b.upper.x < lower.x || b.lower.y > upper.y ||
            b.upper.y < lower.y || b.lower.z > upper.z || b.upper.z < lower.z)
            continue;
        Vec3 normal;
        if (colliders[c].distance(center, normal) > far) continue;
        if (count_ == kNear) {
            all_ = true;
            return;
        }
        near_[count_++] = {&colliders[c], normal};
    }
}

} // namespace thaw
