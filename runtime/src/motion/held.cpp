// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// What is held, as a wall to the liquid beside it: it mirrors pressure and velocity, and pulls.
#include "motion/motion.h"
#include "motion/numbers.h"
#include "motion/walls.h"

#include <algorithm>
#include <cmath>

namespace thaw {

// What is held mirrors a liquid as walls do. Its pressure: its own would be none, and the first layer pushed half as
// hard, so it counts once more in the gradient. Its velocity, turned round: with none the liquid stands still at the
// first layer of particles instead of their surface, half a spacing outside (kHeldDrag). On a flat solid of held
// particles / a collider the first layer lies 0.47 to 0.51 / 0.49 to 0.51 spacings off, and films of 3, 6, 4 and 6
// layers run -4, -10, 0, -8 / +5, -8, -2, -6 % off theory (0.34 to 0.38 and +52, +18, +30, +13 % with neither, +23, +6,
// +21, +6 % with the pressure alone). Pieces and elastic solids, which move by what pushes them, are left out.
bool Motion::mirrors(const MotionFrame& f, size_t held) const {
    return !otherHeld_ || !(f.particles.piece[held] || f.particles.bondSlot[held]);
}

template <class F> void Motion::forHeldNeighbors(const MotionFrame& f, size_t i, F&& body) const {
    const Particles& p = f.particles;
    const size_t first = f.neighbors.first[i >> 3] + (i & 7);
    for (uint32_t k = f.neighbors.width[i >> 3]; k-- > 0;) { // ascending: the fixed ones are the last
        const size_t entry = first + 8 * static_cast<size_t>(k), j = f.neighbors.entries[entry] >> 4;
        if (j >= static_cast<size_t>(p.count)) continue;
        if (j < static_cast<size_t>(p.moverCount)) break;
        body(j, f.neighbors.gradient[entry]);
    }
}

// all: sum of the gradients of all that is fixed.
Vec3 Motion::heldMirror(const MotionFrame& f, size_t i, Vec3 all) const {
    if (f.particles.bondSlot[i]) return {};
    if (!otherHeld_) return all;
    Vec3 sum;
    const Particles& p = f.particles;
    forHeldNeighbors(f, i, [&](size_t j, float gradient) {
        if (mirrors(f, j)) sum += gradient * (p.position[i].xyz() - p.position[j].xyz());
    });
    return sum;
}

// What that mirror's motion adds to the density error of a step.
float Motion::broughtByHeld(const MotionFrame& f, size_t i) const {
    if (!(held_[i].w < INFINITY)) return 0;
    const Particles& p = f.particles;
    float sum = 0;
    forHeldNeighbors(f, i, [&](size_t j, float gradient) {
        if (mirrors(f, j)) sum -= gradient * dot(p.position[i].xyz() - p.position[j].xyz(), p.velocity[j].xyz());
    });
    return f.dt * sum;
}

// The change of velocity in a sub-step by which what is held pulls, as far as it is seen: as a wall does (forces.cpp).
Vec3 Motion::heldPull(const MotionFrame& f, size_t i, float pull, Vec3 down) const {
    const Vec4 held = held_[i];
    const float spacing = f.particles.position[i].w / kSupport;
    if (!(held.w > kAdhesionFrom * spacing && held.w < kAdhesionReach * spacing)) return {};
    if (dot(held.xyz(), down) < -kFloorCosine) return {};
    bool alone = true;
    if (otherHeld_) forHeldNeighbors(f, i, [&](size_t j, float) { alone &= mirrors(f, j); });
    if (!alone) return {};
    const float fade = std::min(1.0f, (kAdhesionReach * spacing - held.w) / (kAdhesionFade * spacing));
    return -(pull * fade * f.dt) * held.xyz();
}

} // namespace thaw
