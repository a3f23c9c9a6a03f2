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

// What is left of the residual adds up to momentum that came from nowhere. A piece that leans on no wall and nothing
// held gets it back as one rigid motion, which is exact. Left in, it is in the next warm start too and grows: a clump
// of twelve setting particles, whose own stiffness keeps its drift out of reach of the iterations, took off at 15
// m/s^2.
void Motion::returnMomentum(const MotionFrame& f) {
    Particles& p = f.particles;
    const uint32_t movers = static_cast<uint32_t>(p.moverCount);
    // Most movers lean themselves, or a neighbour of theirs does: the search ends where it meets the first that leans.
    for (uint32_t seed = 0; seed < movers; ++seed) {
        if (piece_[seed] != kUnknown) continue;
        size_t size = 0;
        bool leaning = false;
        queue_[size++] = seed, piece_[seed] = kAfloat;
        for (size_t head = 0; head < size && !leaning; ++head)
            forNeighbors(f.neighbors, static_cast<int>(queue_[head]), [&](uint32_t j) {
                if (j >= movers) return false; // from here on held rows, known to lean on, and dummies
                if (piece_[j] == kAfloat) return true;
                leaning = piece_[j] == kLeaning;
                if (!leaning) piece_[j] = kAfloat, queue_[size++] = j;
                return !leaning;
            });
        if (leaning) {
            for (size_t n = 0; n < size; ++n) piece_[queue_[n]] = kLeaning;
            continue;
        }

        double mass = 0, lost[3] = {}, center[3] = {};
        for (size_t n = 0; n < size; ++n) {
            const size_t i = queue_[n];
            const double m = trait_[i].z;
            const Vec4 x = p.position[i], r = residual_[i];
            mass += m, lost[0] += r.x, lost[1] += r.y, lost[2] += r.z;
            center[0] += m * x.x, center[1] += m * x.y, center[2] += m * x.z;
        }
        for (double& c : center) c /= mass;
        // Angular: inertia about the centre, each particle a cube, so that a pair and a thread have one too.
        double I[3][3] = {}, L[3] = {};
        for (size_t n = 0; n < size; ++n) {
            const size_t i = queue_[n];
            const double m = trait_[i].z, edge = static_cast<double>(p.position[i].w) / kSupport,
                         own = m * edge * edge / 6;
            const double d[3] = {p.position[i].x - center[0], p.position[i].y - center[1], p.position[i].z - center[2]};
            const double r[3] = {residual_[i].x, residual_[i].y, residual_[i].z};
            const double d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            for (int a = 0; a < 3; ++a) {
                const int b = (a + 1) % 3, c = (a + 2) % 3;
                L[a] += d[b] * r[c] - d[c] * r[b];
                for (int k = 0; k < 3; ++k) I[a][k] += (a == k ? m * d2 + own : 0) - m * d[a] * d[k];
            }
        }
        const auto minor = [&](int a, int b) {
            const int a1 = (a + 1) % 3, a2 = (a + 2) % 3, b1 = (b + 1) % 3, b2 = (b + 2) % 3;
            return I[a1][b1] * I[a2][b2] - I[a1][b2] * I[a2][b1];
        };
        const double det = I[0][0] * minor(0, 0) + I[0][1] * minor(0, 1) + I[0][2] * minor(0, 2);
        Vec3 spin;
        if (det > 0) {
            double w[3];
            for (int a = 0; a < 3; ++a) w[a] = (minor(0, a) * L[0] + minor(1, a) * L[1] + minor(2, a) * L[2]) / det;
            spin = {static_cast<float>(w[0]), static_cast<float>(w[1]), static_cast<float>(w[2])};
        }
        const Vec3 drift{static_cast<float>(lost[0] / mass), static_cast<float>(lost[1] / mass),
                         static_cast<float>(lost[2] / mass)};
        for (size_t n = 0; n < size; ++n) {
            const size_t i = queue_[n];
            const Vec3 d{static_cast<float>(p.position[i].x - center[0]),
                         static_cast<float>(p.position[i].y - center[1]),
                         static_cast<float>(p.position[i].z - center[2])};
            p.velocity[i].setXyz(p.velocity[i].xyz() + drift + cross(spin, d));
        }
    }
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

    if (sound && stats_.viscosityIterations > 0) returnMomentum(f);
    const float soften = detExp(kSofteningLog / static_cast<float>(std::max(1, f.subSteps)));
    forMovers([&](int begin, int, int last, BlockSums&) {
        for (int r = 8 * begin; r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            if (!sound) p.velocity[i] = before_[i];
            const Vec3 change = p.velocity[i].xyz() - before_[i].xyz();
            p.velocityChange[i] = {change.x, change.y, change.z, std::max(1.0f, soften * p.velocityChange[i].w)};
            if (touches(i)) holdAtWalls(i, p.velocity[i], p.position[i].w, f.dt);
        }
    });
}

} // namespace thaw
