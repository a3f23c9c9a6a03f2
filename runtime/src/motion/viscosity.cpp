// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/math.h"
#include "motion/motion.h"
#include "motion/numbers.h"
#include "motion/pairs.h"
#include "motion/walls.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

constexpr float kTolerance = 1e-2f; // of the change that gravity makes in a step
constexpr float kLeastGravity = 1;  // m/s^2, for that measure where there is none
// A large region that turns liquid starts stiff and softens by this much a step: half of it gone after three.
constexpr float kSofteningLog = -0.223143551f; // ln 0.8

Vec3 divide(Vec3 a, Vec4 inverse) { return {a.x * inverse.x, a.y * inverse.y, a.z * inverse.z}; }

} // namespace

// image = (M + walls + pairs) velocity, for the movers of the groups.
void Motion::applyViscosity(const MotionFrame& f, const Vec4* velocity, int begin, int end) {
    const Particles& p = f.particles;
    pairViscosity(
        {PairLists(f.neighbors), p.position.data(), trait_.data(), coefficient_.data(), velocity, image_.data()}, begin,
        end);
    const int last = std::min(8 * end, p.moverCount);
    for (int r = 8 * begin; r < last; ++r) {
        const size_t i = static_cast<size_t>(r);
        if (!contactCount_[i]) continue;
        const Vec3 v = velocity[i].xyz();
        const Vec4 a = wallDrag_[2 * i], b = wallDrag_[2 * i + 1];
        image_[i].setXyz(image_[i].xyz() + Vec3{a.x * v.x + b.x * v.y + b.y * v.z, b.x * v.x + a.y * v.y + b.z * v.z,
                                                b.y * v.x + b.z * v.y + a.z * v.z});
    }
    for (int r = last; r < 8 * end; ++r) image_[static_cast<size_t>(r)] = {};
}

void Motion::viscosity(const MotionFrame& f) {
    Particles& p = f.particles;
    if (p.moverCount == 0) return;
    const WallTable& table = wallTable();
    const float shear = shearMoment();
    const float scale = std::max(length(f.gravity), kLeastGravity) * f.dt;
    const auto forMovers = [&](auto&& body) {
        f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int block, int) {
            sums_[static_cast<size_t>(block)] = {};
            body(begin, end, std::min(8 * end, p.moverCount), sums_[static_cast<size_t>(block)]);
        });
    };
    const auto total = [&](double BlockSums::*which) {
        double sum = 0;
        for (const BlockSums& s : sums_) sum += s.*which;
        return sum;
    };

    // No-slip walls as if the liquid went on behind them with the velocity mirrored linearly, and the diagonal. The
    // start is what the last solve did to the velocities.
    forMovers([&](int begin, int end, int last, BlockSums& sums) {
        for (int r = 8 * begin; r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            const float mass = trait_[i].z, h = p.position[i].w, nearest = kWallStandoff / kSupport;
            Vec3 diagonal = diagonal_[i].xyz() + Vec3{mass, mass, mass};
            if (contactCount_[i]) {
                Vec4 a, b;
                for (size_t c = i * kContacts, n = c + contactCount_[i]; c < n; ++c) {
                    const Vec4 k = contact_[c];
                    const float q = k.w / h;
                    if (q >= 1) continue;
                    const float tangent = WallTable::lookup(table.tangent, std::max(q, nearest)) / std::max(q, nearest);
                    const float normal = WallTable::lookup(table.normal, std::max(q, 0.0f)) - tangent;
                    const float weight = f.dt * trait_[i].x * shear * f.volume[i] / (h * h);
                    const float t = weight * tangent, s = weight * normal;
                    a.x += t + s * k.x * k.x, a.y += t + s * k.y * k.y, a.z += t + s * k.z * k.z;
                    b.x += s * k.x * k.y, b.y += s * k.x * k.z, b.z += s * k.y * k.z;
                }
                wallDrag_[2 * i] = a, wallDrag_[2 * i + 1] = b;
                diagonal += a.xyz();
            }
            diagonal_[i] = {1 / diagonal.x, 1 / diagonal.y, 1 / diagonal.z, 0};
            before_[i] = p.velocity[i];
            p.velocity[i].setXyz(p.velocity[i].xyz() + p.velocityChange[i].xyz());
            const double allowed = static_cast<double>(mass) * scale;
            sums.a += allowed * allowed;
        }
        for (int r = last; r < 8 * end; ++r) {
            const size_t i = static_cast<size_t>(r);
            diagonal_[i] = residual_[i] = {};
        }
    });
    const double allowed = static_cast<double>(kTolerance) * kTolerance * total(&BlockSums::a);

    forMovers([&](int begin, int end, int last, BlockSums& sums) {
        applyViscosity(f, p.velocity.data(), begin, end);
        for (int r = 8 * begin; r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            const Vec3 res = trait_[i].z * before_[i].xyz() - image_[i].xyz(), z = divide(res, diagonal_[i]);
            residual_[i] = {res.x, res.y, res.z, 0};
            direction_[i] = {z.x, z.y, z.z, 0};
            sums.a += static_cast<double>(dot(res, z)), sums.b += static_cast<double>(dot(res, res));
        }
    });
    double rz = total(&BlockSums::a), rr = total(&BlockSums::b);

    int iteration = 0;
    for (; iteration < f.viscosityIterations && rr > allowed && rz > 0; ++iteration) {
        forMovers([&](int begin, int end, int, BlockSums& sums) {
            applyViscosity(f, direction_.data(), begin, end);
            sums.a = innerProduct(direction_.data(), image_.data(), 8 * begin, 8 * end);
        });
        const double curvature = total(&BlockSums::a);
        if (!(curvature > 0)) break;
        forMovers([&](int begin, int end, int, BlockSums& sums) {
            const Dots dots = advance(static_cast<float>(rz / curvature), direction_.data(), image_.data(),
                                      diagonal_.data(), p.velocity.data(), residual_.data(), 8 * begin, 8 * end);
            sums.a = dots.a, sums.b = dots.b;
        });
        const double next = total(&BlockSums::a);
        rr = total(&BlockSums::b);
        const float keep = static_cast<float>(next / rz);
        rz = next;
        if (!(rr > allowed)) continue;
        forMovers([&](int begin, int end, int, BlockSums&) {
            turn(keep, residual_.data(), diagonal_.data(), direction_.data(), 8 * begin, 8 * end);
        });
    }
    stats_.viscosityIterations = iteration;
    stats_.iterationsClipped = rr > allowed;

    // A solve that met a number that is not finite must not spread it.
    const bool sound = std::isfinite(rr) && std::isfinite(rz);

    // What is left of the residual adds up to momentum that came from nowhere. With nothing to lean on it is given back
    // evenly (the correction of the translations alone, exact where walls and held particles take no part).
    Vec3 drift;
    if (sound && !leaning_) {
        double mass = 0, lost[3] = {};
        for (int r = 0; r < p.moverCount; ++r) {
            const size_t i = static_cast<size_t>(r);
            mass += static_cast<double>(trait_[i].z);
            lost[0] += static_cast<double>(residual_[i].x), lost[1] += static_cast<double>(residual_[i].y);
            lost[2] += static_cast<double>(residual_[i].z);
        }
        drift = {static_cast<float>(lost[0] / mass), static_cast<float>(lost[1] / mass),
                 static_cast<float>(lost[2] / mass)};
    }

    const float soften = detExp(kSofteningLog / static_cast<float>(std::max(1, f.subSteps)));
    forMovers([&](int begin, int, int last, BlockSums&) {
        for (int r = 8 * begin; r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            if (!sound) p.velocity[i] = before_[i];
            const Vec3 change = p.velocity[i].xyz() + drift - before_[i].xyz();
            p.velocity[i].setXyz(before_[i].xyz() + change);
            p.velocityChange[i] = {change.x, change.y, change.z, std::max(1.0f, soften * p.velocityChange[i].w)};
            if (touches(i)) holdAtWalls(i, p.velocity[i], p.position[i].w, f.dt);
        }
    });
}

} // namespace thaw
