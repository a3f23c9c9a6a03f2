// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/pairs.h"

#include "base/kernel.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

// Calls f(entry, j) for every entry of row i, the unused ones included: they have gradient 0 and a partner far away.
template <class F> void forEntries(const PairLists& lists, int i, F&& f) {
    const int group = i >> 3, lane = i & 7;
    const uint32_t start = lists.first[group] + static_cast<uint32_t>(lane);
    for (uint32_t k = 0; k < lists.width[group]; ++k) f(start + 8 * k, lists.entries[start + 8 * k] >> 4);
}

} // namespace

void pairForces(const ForcePass& p, int begin, int end) {
    const float weight = 10 * latticeSum() * p.dt;
    for (int i = 8 * begin; i < 8 * end; ++i) {
        const Vec4 xi = p.position[i], ti = p.trait[i];
        Vec3 push, pull, diagonal;
        forEntries(p.lists, i, [&](uint32_t e, uint32_t j) {
            const Vec4 xj = p.position[j], tj = p.trait[j];
            const float g = p.lists.gradient[e];
            const Vec3 x = xi.xyz() - xj.xyz();
            const float r2 = dot(x, x), h = 0.5f * (xi.w + xj.w);
            const bool fixed = tj.x < 0;
            push += ((ti.w + tj.w) * g) * x;
            // Viscous coefficient (Weiler et al. 2018, projected form): mean of the two viscosities keeps it symmetric.
            const float mu = fixed ? ti.x : 0.5f * (ti.x + tj.x);
            const float k = weight * mu * p.volume[i] * -g / (r2 + 0.01f * h * h);
            p.coefficient[e] = k;
            diagonal += k * Vec3{x.x * x.x, x.y * x.y, x.z * x.z};
            // Cohesion: none up to one spacing, none at the support, largest between.
            const float r = std::sqrt(r2), d = h / kSupport;
            if (r > d && r < h) {
                const float shape = (r - d) * (h - r) * 4 / ((h - d) * (h - d));
                const float mass = fixed ? ti.z : 2 * ti.z * tj.z / (ti.z + tj.z);
                pull += (-0.5f * (ti.y + tj.y) * mass * shape / r) * x;
            }
        });
        const Vec3 change = (-p.dt * p.invDensity[i]) * push + (ti.z > 0 ? p.dt / ti.z : 0.0f) * pull;
        p.change[i] = {change.x, change.y, change.z, 0};
        p.diagonal[i] = {diagonal.x, diagonal.y, diagonal.z, 0};
    }
}

void pairViscosity(const ViscousPass& p, int begin, int end) {
    for (int i = 8 * begin; i < 8 * end; ++i) {
        const Vec3 xi = p.position[i].xyz(), vi = p.velocity[i].xyz();
        Vec3 sum;
        forEntries(p.lists, i, [&](uint32_t e, uint32_t j) {
            const Vec3 x = xi - p.position[j].xyz();
            sum += (p.coefficient[e] * dot(vi - p.velocity[j].xyz(), x)) * x;
        });
        p.out[i] = {sum.x, sum.y, sum.z, 0};
    }
}

void pairDivergence(const DivergencePass& p, int begin, int end) {
    for (int i = 8 * begin; i < 8 * end; ++i) {
        const Vec3 xi = p.point[i].xyz(), vi = p.velocity[i].xyz();
        float sum = 0;
        forEntries(p.lists, i, [&](uint32_t e, uint32_t j) {
            sum += p.lists.gradient[e] * dot(vi - p.velocity[j].xyz(), xi - p.point[j].xyz());
        });
        p.out[i] = sum;
    }
}

void pairGradient(const GradientPass& p, int begin, int end) {
    for (int i = 8 * begin; i < 8 * end; ++i) {
        const Vec4 xi = p.point[i];
        Vec3 sum;
        forEntries(p.lists, i, [&](uint32_t e, uint32_t j) {
            const Vec4 xj = p.point[j];
            sum += ((xi.w + xj.w) * p.lists.gradient[e]) * (xi.xyz() - xj.xyz());
        });
        p.out[i] = {sum.x, sum.y, sum.z, 0};
    }
}

void pairSeparation(const SeparationPass& p, int begin, int end) {
    // Measured: pairs nearer than 0.65 spacings clump (28 % of a puddle without this pass, none with it); moving more
    // than 0.3 of that distance at once, or all of the overlap, throws neighbours.
    constexpr float kShare = 0.65f, kStep = 0.3f, kRelax = 0.7f;
    for (int i = 8 * begin; i < 8 * end; ++i) {
        const Vec4 xi = p.position[i];
        Vec3 sum;
        forEntries(p.lists, i, [&](uint32_t, uint32_t j) {
            const Vec4 xj = p.position[j];
            Vec3 x = xi.xyz() - xj.xyz();
            const float d = kShare / kSupport * 0.5f * (xi.w + xj.w);
            float r2 = dot(x, x);
            if (!(r2 < d * d)) return;
            float r = std::sqrt(r2);
            if (r < 1e-3f * d) {
                r = 1e-3f * d;
                x = {static_cast<uint32_t>(i) < j ? r : -r, 0, 0};
            }
            const float share = p.trait[j].x < 0 ? 1.0f : 0.5f;
            sum += (kRelax * share * std::min(d - r, kStep * d) / r) * x;
        });
        p.out[i] = {sum.x, sum.y, sum.z, 0};
    }
}

} // namespace thaw
