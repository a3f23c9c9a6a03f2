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
            pairJacobi({lists, p.position.data(), p.velocity.data(), wallGradient_.data(), p.stiffness.data(),
                        f.invDensity, f.dt, feedback, weight, p.pressure.data(), point_.data()},
                       begin, end);
        });
        f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int, int) {
            pairPush({lists, point_.data(), wallGradient_.data(), f.invDensity, f.dt, p.velocity.data()}, begin, end);
            for (int r = 8 * begin, last = std::min(8 * end, p.moverCount); r < last; ++r) {
                const size_t i = static_cast<size_t>(r);
                if (touches(i)) holdAtWalls(i, p.velocity[i], p.position[i].w, f.dt);
            }
        });
    }
}

} // namespace thaw
