// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/motion.h"
#include "motion/numbers.h"
#include "motion/pairs.h"
#include "motion/rigid_liquid.h"

#include <algorithm>

namespace thaw {

void Motion::forces(const MotionFrame& f) {
    Particles& p = f.particles;
    if (p.moverCount == 0) return;
    bool cohesive = false;
    forMaterials(p, p.count, [&](uint8_t m) { cohesive |= f.materials[m].def.cohesion > 0; });
    const ForcePass pass{PairLists(f.neighbors),
                         p.position.data(),
                         trait_.data(),
                         f.volume,
                         f.invDensity,
                         f.dt,
                         cohesive,
                         severalMaterials_ ? ownViscosity_.data() : nullptr,
                         image_.data(),
                         inverse_.data(),
                         cross_.data(),
                         coefficient_.data()};
    const Vec3 down = normalizeOr(f.gravity, {});
    f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int, int) {
        pairForces(pass, begin, end);
        if (bonded_) addSprings(f, begin, end);
        for (int r = 8 * begin, last = std::min(8 * end, p.moverCount); r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            const float spacing = p.position[i].w / kSupport, pull = f.materials[p.material[i]].def.adhesion * kGravity;
            target_[i] = p.velocity[i];
            Vec3 v = p.velocity[i].xyz() + f.dt * f.gravity + image_[i].xyz() -
                     (f.dt * f.invDensity[i] * trait_[i].w) * wallGradient_[i].xyz();
            if (unlike_) v += pushMirrors(f, i, trait_.data());
            for (size_t c = i * kContacts, n = c + contactCount_[i]; c < n; ++c) {
                const Vec4 k = contact_[c];
                if (!contactAdhesive_[c] || dot(k.xyz(), down) < -kFloorCosine) continue;
                if (k.w <= kAdhesionFrom * spacing || k.w >= kAdhesionReach * spacing) continue;
                const float fade = std::min(1.0f, (kAdhesionReach * spacing - k.w) / (kAdhesionFade * spacing));
                v -= (pull * fade * f.dt) * k.xyz();
                kick(c, -(pull * fade * f.dt) * k.xyz());
            }
            if (held_[i].w < INFINITY && pull > 0) {
                const Vec3 change = heldPull(f, i, pull, down);
                v += change;
                if (reporting_) heldKick_[i].setXyz(heldKick_[i].xyz() + change);
            }
            // The viscous solve of what is bonded starts from the velocity of the last step: from where springs and
            // gravity send it, it blows up within three frames (BAKEOFF 4).
            if (bonded_ && p.bondSlot[i]) p.velocityChange[i].setXyz(p.velocity[i].xyz() - v);
            p.velocity[i].setXyz(v);
        }
    });
    if (!f.coupling) return;
    f.coupling->gather(f, trait_.data(), target_.data());
    if (f.coupling->any()) f.coupling->settle(f);
}

} // namespace thaw
