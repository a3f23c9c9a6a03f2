// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/motion.h"
#include "motion/numbers.h"
#include "motion/pairs.h"
#include "motion/rigid_liquid.h"

#include <algorithm>

namespace thaw {

// The density error that walls bring about by their own motion, in the form in which the iterations take it back
// whole: they take back only a share of an error that is there already.
void Motion::meetMovingWalls(const MotionFrame& f) {
    const float feedback = densityFeedback(f.subSteps);
    f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int, int) {
        for (int r = 8 * begin, last = std::min(8 * end, f.particles.moverCount); r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            float brought = heldMoves_ ? broughtByHeld(f, i) : 0;
            for (size_t c = i * kContacts, n = c + contactCount_[i]; wallsMove_ && c < n; ++c)
                brought -= f.dt * contactSlope_[c] * dot(contact_[c].xyz(), wallVelocity_[c].xyz());
            if (brought == 0) continue;
            float& error = wallGradient_[i].w;
            error = (error > 0 ? feedback * error : error) + brought;
            if (error > 0) error /= feedback;
        }
    });
}

void Motion::pressure(const MotionFrame& f) {
    Particles& p = f.particles;
    if (p.moverCount == 0) return;
    const PairLists lists(f.neighbors);
    const float feedback = densityFeedback(f.subSteps), weight = jacobiWeight(f.subSteps) / (f.dt * f.dt);
    if (wallsMove_ || heldMoves_) meetMovingWalls(f);
    for (int iteration = 0; iteration < f.pressureIterations; ++iteration) {
        if (iteration >= f.leastPressure && f.safePoints && f.safePoints->late()) break;
        ++stats_.pressureIterations;
        f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int, int) {
            if (unlike_) moveMirrors(f, begin, end);
            pairJacobi({lists, p.position.data(), p.velocity.data(), wallGradient_.data(), p.stiffness.data(),
                        unlike_ ? mirrorChange_.data() : nullptr, f.invDensity, f.dt, feedback, weight,
                        p.pressure.data(), point_.data()},
                       begin, end);
        });
        f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int, int) {
            pairPush({lists, point_.data(), wallGradient_.data(), f.invDensity, f.dt, p.velocity.data()}, begin, end);
            for (int r = 8 * begin, last = std::min(8 * end, p.moverCount); r < last; ++r) {
                const size_t i = static_cast<size_t>(r);
                if (unlike_) p.velocity[i].setXyz(p.velocity[i].xyz() + pushMirrors(f, i, point_.data()));
                if (gripped(i))
                    p.velocity[i].setXyz(heldTo(i, p.velocity[i].xyz()));
                else if (touches(i))
                    holdAtWalls(f, i);
            }
        });
        if (f.coupling && f.coupling->any()) f.coupling->press(f, point_.data()), f.coupling->settle(f);
    }
    if (!kicks()) return;
    if (reporting_) reportHeldPush(f);
    // Warm start and iterations together have applied the pressure as it is now.
    f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int, int) {
        for (int r = 8 * begin, last = std::min(8 * end, p.moverCount); r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            const float push = f.dt * f.invDensity[i] * p.pressure[i];
            for (size_t c = i * kContacts, n = c + contactCount_[i]; c < n; ++c)
                kick(c, -(push * contactSlope_[c]) * contact_[c].xyz());
            if (unlike_) reportMirrors(f, i);
        }
    });
    if (rims_) bookRims(f);
}

} // namespace thaw
