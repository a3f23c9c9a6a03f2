// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/motion.h"
#include "motion/numbers.h"
#include "motion/pairs.h"

#include <algorithm>

namespace thaw {

void Motion::pressure(const MotionFrame& f) {
    Particles& p = f.particles;
    if (p.moverCount == 0) return;
    const PairLists lists(f.neighbors);
    const float feedback = densityFeedback(f.subSteps), weight = jacobiWeight(f.subSteps) / (f.dt * f.dt);
    for (int iteration = 0; iteration < f.pressureIterations; ++iteration) {
        f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int, int) {
            pairDivergence({lists, point_.data(), p.velocity.data(), scalar_.data()}, begin, end);
            for (int r = 8 * begin, last = std::min(8 * end, p.moverCount); r < last; ++r) {
                const size_t i = static_cast<size_t>(r);
                const Vec4 wall = wallGradient_[i];
                const float error = (wall.w > 0 ? feedback * wall.w : wall.w) +
                                    f.dt * (scalar_[i] + dot(wall.xyz(), p.velocity[i].xyz()));
                const float next = std::max(0.0f, p.pressure[i] + weight * error * p.stiffness[i]);
                point_[i].w = next - p.pressure[i];
                p.pressure[i] = next;
            }
        });
        f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int, int) {
            pairGradient({lists, point_.data(), image_.data()}, begin, end);
            for (int r = 8 * begin, last = std::min(8 * end, p.moverCount); r < last; ++r) {
                const size_t i = static_cast<size_t>(r);
                const Vec3 push = image_[i].xyz() + point_[i].w * wallGradient_[i].xyz();
                p.velocity[i].setXyz(p.velocity[i].xyz() - (f.dt * f.invDensity[i]) * push);
                holdAtWalls(i, p.velocity[i], p.position[i].w, f.dt);
            }
        });
    }
}

} // namespace thaw
