// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// How far a piece may turn in a step.
#include "base/kernel.h"
#include "motion/rigid.h"
#include "motion/rigid_numbers.h"
#include "motion/walls.h"

#include <algorithm>
#include <cmath>

namespace thaw {

// Angular momentum stays, so that the axis does not unless the piece is a ball. By midpoints of so few radians: with
// one step by the spin of its start a rod at 32 rad/s gains a tenth of its energy in a step, or loses as much momentum
// when the energy is kept.
Rotation3 RigidPiece::turnIn(double time) const {
    constexpr double kMost = 0.05; // rad
    const int n = static_cast<int>(std::min(64.0, std::ceil(length(spin) * time / kMost)));
    const Double3 kept = inertia * spin;
    Rotation3 whole;
    Double3 axis = spin;
    for (int k = 0; k < n; ++k) {
        const double part = time / n;
        const Rotation3 half = rotationBy((0.5 * part) * axis) * whole;
        const Double3 middle = inverse(turned(half, inertia)) * kept;
        whole = rotationBy(part * middle) * whole;
        axis = inverse(turned(whole, inertia)) * kept;
    }
    return whole;
}

// Contacts know where the points of a piece go along a line, not that they turn: a cube that hits the floor with a
// corner at 5 m/s turns by 1.3 rad in the next step, and its other corners came in by 5 spacings. It stops where one of
// them touches, and has its contact there in the step after.
void Rigid::followTurn(const MotionFrame& f, uint32_t slot) {
    const RigidPiece& b = pieces_[slot];
    const double dt = f.dt;
    if (!(length(b.spin) * dt > kFollowTurn)) return;
    const Particles& p = f.particles;
    double& share = shares_[slot];
    WallFinder walls;
    const float way = static_cast<float>(b.reach() * dt) + f.spacing;
    walls.gather(f.colliders, colliderBounds_.data(), f.colliderCount, b.bounds, way);
    if (walls.empty()) return;
    Rotation3 whole = b.turnIn(share * dt);
    const uint32_t* rows = rowsOf(b);
    for (uint32_t k = 0; k < b.rows; ++k) {
        const Vec4 x = p.position[rows[k]];
        const Double3 d = wide(x.xyz()) - b.center;
        const double edge = static_cast<double>(x.w) / kSupport;
        walls.forNear(x.xyz(), way, [&](float distance, Vec3, const Collider& c) {
            const Double3 walled = c.moves ? wide(c.displacement(x.xyz())) : Double3{};
            const double least = std::min(static_cast<double>(distance), 0.5 * edge) - kTurnIn * edge;
            const auto in = [&](double part, const Rotation3& turn) {
                const Double3 to = b.center + (part * dt) * b.velocity + turn.apply(d) - part * walled;
                Vec3 normal;
                return static_cast<double>(c.distance(narrow(to), normal)) < least;
            };
            if (!in(share, whole)) return;
            double low = 0, high = share;
            for (int n = 0; n < 10; ++n) {
                const double middle = 0.5 * (low + high);
                (in(middle, b.turnIn(middle * dt)) ? high : low) = middle;
            }
            share = high, whole = b.turnIn(share * dt);
        });
    }
}

} // namespace thaw
