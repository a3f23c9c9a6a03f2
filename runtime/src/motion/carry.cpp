// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/carry.h"

#include "motion/motion.h"

#include <cmath>

namespace thaw {

float beginCarry(Particles& p, Collider* colliders, int colliderCount, Vec3 gravity, float dt) {
    float fastest = 0;
    for (int r = p.moverCount; r < p.count; ++r) {
        const size_t i = static_cast<size_t>(r);
        const int c = static_cast<int>(p.anchor[i]) - 1;
        Vec3 v;
        if (c >= 0 && c < colliderCount && colliders[c].alive) {
            Collider& on = colliders[c];
            const Vec3 x = p.position[i].xyz();
            v = on.velocityAt(x);
            if (on.report) {
                ImpulseSums sums{};
                sums.add(x - on.transform.position, p.velocity[i].w, dt * gravity - (v - p.velocity[i].xyz()));
                for (int k = 0; k < 3; ++k) on.impulse[k] += sums.linear[k], on.impulse[3 + k] += sums.angular[k];
            }
        }
        p.velocity[i].setXyz(v);
        fastest = std::max(fastest, dot(v, v));
    }
    return std::sqrt(fastest);
}

void endCarry(Particles& p, Reference& reference, const Collider* colliders, int colliderCount) {
    for (int r = p.moverCount; r < p.count; ++r) {
        const size_t i = static_cast<size_t>(r);
        const int c = static_cast<int>(p.anchor[i]) - 1;
        if (c < 0 || c >= colliderCount || !colliders[c].moves) continue;
        const Vec3 x = p.position[i].xyz(), to = x + colliders[c].displacement(x);
        p.position[i].setXyz(to);
        reference.turn(p, i, [&](Vec3 v) { return x + v + colliders[c].displacement(x + v) - to; });
    }
}

} // namespace thaw
