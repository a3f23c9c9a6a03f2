// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/kernel.h"
#include "motion/motion.h"
#include "motion/numbers.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

// Strain of a landing piece in a step, along its way and with half of it outwards. A cube of 48 mm of 0.02 / 1 Pa s at
// 1.4 m/s and 4 mm left to walls and pressure compresses by up to (mean) 33 / 29 % in four sub-steps, at 2 mm by 139 %.
constexpr float kLandingStrain = 0.1f;
// s: what has landed is as stiff as so many times the pressure of its own height, and softens as what turns liquid
// does. The worst then, 0.02 / 1 / 10 Pa s at 4 mm: 3 / 4 / 5 %, at 2 mm 1 / 2 / 4 %; without 9 / 7 / 5 and 10 / 8 / 4
// %.
constexpr float kLandingStiff = 0.05f;
// Where its first particles come to a stop, in spacings from the wall: where they rest.
constexpr float kFirstLayer = 0.5f;
// Fewer than these, and less than a hundredth of what moves, are a drip, which needs nothing (9 % at worst).
constexpr int kLeastLanding = 16;

} // namespace

// What runs into a wall faster than the frozen geometry can follow piles up on it layer by layer: pressure travels few
// layers in an iteration, and more iterations or sub-steps only make jets of it. So the first step of a landing is
// solved beforehand: the piece that comes on (all that hangs together and approaches) is brought to where its first
// particles touch, and what is behind them may follow by a small strain only, with the flow of a drop that meets a
// wall: u = -e z, and e r / 2 outwards, which changes no volume. The wall takes up the rest, as it would. From the next
// step on it stands there like what has just turned liquid: with the pressure of its height, and stiff for a while.
void Motion::land(const MotionFrame& f) {
    Particles& p = f.particles;
    const uint32_t movers = static_cast<uint32_t>(p.moverCount);
    const size_t few = static_cast<size_t>(std::max(kLeastLanding, p.moverCount / 100));
    const float share = 1 / static_cast<float>(f.subSteps), most = kLandingStrain * share;
    for (uint32_t i = 0; i < movers; ++i) image_[i].w = 0;
    for (uint32_t seed = 0; seed < movers; ++seed) {
        if (landing_[seed].w == INFINITY || image_[seed].w > 0) continue;
        const Vec3 n = landing_[seed].xyz();
        const auto approach = [&](size_t i) { return -f.dt * dot(n, p.velocity[i].xyz()); };
        const float falls = -f.dt * f.dt * dot(n, f.gravity);
        size_t size = 0, lowest = seed, seeds = 0;
        float gap = INFINITY;
        double center[3] = {}, mean = 0, viscosity = 0;
        queue_[size++] = seed, image_[seed].w = 1;
        for (size_t head = 0; head < size; ++head) {
            const uint32_t i = queue_[head];
            const Vec4 x = p.position[i];
            center[0] += x.x, center[1] += x.y, center[2] += x.z, mean += approach(i);
            viscosity += trait_[i].x;
            if (landing_[i].w < INFINITY) {
                ++seeds;
                const float room = landing_[i].w - kFirstLayer * x.w / kSupport;
                if (room < gap) gap = room, lowest = i;
            }
            forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t j) {
                if (j >= movers) return false;
                if (image_[j].w == 0 && approach(j) > kLandingFrom * share * p.position[j].w / kSupport)
                    image_[j].w = 1, queue_[size++] = j;
                return true;
            });
        }
        if (seeds < few) continue;
        gap = std::max(gap, 0.0f);
        const double each = 1 / static_cast<double>(size);
        const Vec3 c{static_cast<float>(each * center[0]), static_cast<float>(each * center[1]),
                     static_cast<float>(each * center[2])};
        float radius = 0;
        for (size_t k = 0; k < size; ++k) {
            const Vec3 d = p.position[queue_[k]].xyz() - c;
            radius = std::max(radius, length(d - dot(d, n) * n));
        }
        // Not more than its viscosity allows, and not so much that it leaves faster than it came.
        const float way = static_cast<float>(each * mean);
        const float yields = way * way / (3 * f.dt * static_cast<float>(each * viscosity) * f.invDensity[seed]);
        const float squash = std::min({most, yields, 2 * way / std::max(radius, 1e-12f)});
        const Vec3 from = p.position[lowest].xyz();
        float top = 0;
        for (size_t k = 0; k < size; ++k) top = std::max(top, dot(n, p.position[queue_[k]].xyz() - from));
        const float weight = std::max(0.0f, -dot(n, f.gravity)) / f.invDensity[seed];
        for (size_t k = 0; k < size; ++k) {
            const size_t i = queue_[k];
            const Vec3 x = p.position[i].xyz(), d = x - c;
            const float height = std::max(0.0f, dot(n, x - from)), pressure = weight * (top - height);
            p.pressure[i] = std::max(p.pressure[i], pressure);
            p.velocityChange[i].w = std::max(p.velocityChange[i].w, kLandingStiff * pressure);
            const float over = approach(i) + falls - gap - squash * height;
            landing_[i].w = -1; // nothing is between it and the wall yet that could drag
            if (!(over > 0)) continue;
            const Vec3 out = d - dot(d, n) * n;
            const Vec3 change = (over / f.dt) * n + (0.5f * squash / f.dt) * out;
            p.velocity[i].setXyz(p.velocity[i].xyz() + change);
            const int32_t slot = reportSlot_[landingOn_[seed]];
            if (slot >= 0)
                reports_[static_cast<size_t>(slot)].add(x - f.colliders[landingOn_[seed]].transform.position,
                                                        p.velocity[i].w, change);
        }
    }
}

} // namespace thaw
