// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/bond_pass.h"
#include "motion/motion.h"
#include "motion/numbers.h"
#include "motion/walls.h"

#include <algorithm>

namespace thaw {
namespace {

// Where the centre of an elastic particle stands on a wall, in spacings: its body's surface is there.
constexpr float kStand = 0.5f;
// What was pressed against a wall stays so within this many spacings of it, until it would have to be pulled.
constexpr float kStill = 0.1f;
// What a wall that moves has come into by more than this many spacings it drives out.
constexpr float kSunk = 0.05f;
// Pull that releases, and approach that grips, as shares of what gravity does in a step.
constexpr float kPull = 0.01f;

} // namespace

void Motion::addSprings(const MotionFrame& f, int begin, int end) {
    pairSprings({PairLists(f.neighbors), f.particles.position.data(), trait_.data(), f.bonds->groupOn.data(),
                 f.bonds->stiffness.data(), f.bonds->rest.data(), f.dt, image_.data(), inverse_.data(), cross_.data(),
                 coefficient_.data()},
                begin, end);
}

// Contact of elastic solids with walls, inside of the solve (clamped after it they blew up, BAKEOFF 4): what would end
// the step in a wall ends it on the wall and sticks there, for as long as that takes a push. residual_ is of the
// velocities of now, with what the walls did left out where a particle is gripped. True when some particle's grip
// changed.
bool Motion::regrip(const MotionFrame& f) {
    Particles& p = f.particles;
    const float scale = kPull * f.dt * kGravity; // m/s
    f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int block, int) {
        BlockSums& sums = sums_[static_cast<size_t>(block)];
        sums = {};
        for (int r = 8 * begin, last = std::min(8 * end, p.moverCount); r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            const uint32_t slot = p.bondSlot[i];
            if (!slot || !contactCount_[i]) continue;
            const float spacing = p.position[i].w / kSupport;
            uint8_t& pressed = f.bonds->pressed(slot);
            const int before = static_cast<int>(grip_[i].w); // a bit for each wall
            const Vec3 v = p.velocity[i].xyz();
            // What the walls give it is what it lacks. One that would have to pull lets go, the others hold on: or what
            // is lifted off the floor by a plate that comes goes through the plate.
            const Vec3 push = before ? -1.0f / trait_[i].z * residual_[i].xyz() : Vec3{};
            Vec3 on;
            int now = 0;
            const auto forWalls = [&](auto&& body) {
                for (size_t c = i * kContacts, n = c + contactCount_[i]; c < n; ++c) {
                    const Vec3 normal = contact_[c].xyz(), wall = wallsMove_ ? wallVelocity_[c].xyz() : Vec3{};
                    const float gap = contact_[c].w - kStand * spacing, in = -gap - kSunk * spacing;
                    const float need = gap > 0      ? -gap / f.dt
                                       : wallsMove_ ? std::clamp(in, 0.0f, kWallRecovery * spacing) / f.dt
                                                    : 0;
                    if (!body(1 << (c - i * kContacts), normal, wall, gap, need)) continue;
                    // With the nearest, and out of the others: one that moves on goes through what another holds.
                    if (!now)
                        on = wall + need * normal;
                    else
                        on += std::max(0.0f, need + dot(normal, wall - on)) * normal;
                    now |= 1 << (c - i * kContacts);
                }
            };
            forWalls([&](int bit, Vec3 normal, Vec3 wall, float gap, float need) {
                if (before & bit)
                    return !(gap > kStill * spacing && !(dot(normal, grip_[i].xyz() - wall) <= need + scale)) &&
                           !(dot(normal, push) < -scale);
                return dot(normal, v - wall) < need - scale || (!before && pressed && gap < kStill * spacing);
            });
            // What one lets go the others may hold in its way.
            if (now)
                forWalls([&](int bit, Vec3 normal, Vec3 wall, float, float need) {
                    return !(now & bit) && dot(normal, on - wall) < need - scale;
                });
            pressed = now != 0;
            if (now == before) continue;
            grip_[i] = {on.x, on.y, on.z, static_cast<float>(now)};
            if (now) p.velocity[i].setXyz(on);
            sums.a += 1;
        }
    });
    double changed = 0;
    for (const BlockSums& s : sums_) changed += s.a;
    return changed > 0;
}

// What walls gave to what they grip; residual_ as regrip reads it, 0 there afterwards.
void Motion::reportGrip(const MotionFrame& f) {
    f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int, int) {
        for (int r = 8 * begin, last = std::min(8 * end, f.particles.moverCount); r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            if (!(grip_[i].w > 0)) continue;
            kick(i * kContacts, -1.0f / trait_[i].z * residual_[i].xyz());
            residual_[i] = {};
        }
    });
}

} // namespace thaw
