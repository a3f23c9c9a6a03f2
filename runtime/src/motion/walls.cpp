// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/walls.h"

namespace thaw {

void WallFinder::gather(const Collider* colliders, const Box* bounds, int colliderCount, const Box& around) {
    count_ = 0, colliders_ = colliders, all_ = false, colliderCount_ = colliderCount;
    for (int c = 0; c < colliderCount; ++c) {
        const Box& b = bounds[c];
        if (!colliders[c].alive || b.lower.x > around.upper.x || b.upper.x < around.lower.x ||
            b.lower.y > around.upper.y || b.upper.y < around.lower.y || b.lower.z > around.upper.z ||
            b.upper.z < around.lower.z)
            continue;
        if (count_ == kNear) {
            all_ = true;
            return;
        }
        near_[count_++] = c;
    }
}

} // namespace thaw
