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

// What a wall's no-slip does to a mover, kg. Slip: the velocity is the wall's that far behind it (Navier).
Motion::WallShear Motion::wallShear(const MotionFrame& f, size_t i, size_t c) const {
    const WallTable& table = wallTable();
    const float h = f.particles.position[i].w, nearest = kWallStandoff / kSupport, q = contact_[c].w / h,
                near = std::max(q, nearest);
    float tangent = WallTable::lookup(table.tangent, near) / near;
    const float normal = WallTable::lookup(table.normal, std::max(q, 0.0f));
    if (slippery_) tangent *= near * h / (near * h + f.colliders[contactOf_[c]].slipLength);
    const float weight = f.dt * trait_[i].x * shearMoment() * f.volume[i] / (h * h);
    return {weight * tangent, weight * (normal - tangent)};
}

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
// m/s^2. A piece that leans gets the rigid motion that leaves no residual in its sums against the drag of what it leans
// on (a Galerkin correction, which only brings the solve nearer to its solution); for walls that move or report: a blob
// hit by a plate gained 0.3 of the momentum that the plate lost, with this 1.0.
void Motion::returnMomentum(const MotionFrame& f) {
    Particles& p = f.particles;
    const uint32_t movers = static_cast<uint32_t>(p.moverCount);
    const bool every = wallsMove_ || reporting_ || heldMoves_;
    // Most movers lean themselves, or a neighbour of theirs does: the search ends where it meets the first that leans.
    if (every)
        for (uint32_t i = 0; i < movers; ++i) piece_[i] = kUnknown;
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
        moveRigidly(f, queue_.data(), size, every);
    }
}

// The rigid motion of a piece that leaves its residual without sum and without moment.
void Motion::moveRigidly(const MotionFrame& f, const uint32_t* rows, size_t size, bool leans) {
    Particles& p = f.particles;
    double mass = 0, center[3] = {};
    for (size_t n = 0; n < size; ++n) {
        const double m = trait_[rows[n]].z;
        const Vec4 x = p.position[rows[n]];
        mass += m;
        center[0] += m * x.x, center[1] += m * x.y, center[2] += m * x.z;
    }
    for (double& c : center) c /= mass;
    // Upper triangle of the matrix of the six motions, and their right side. Each particle has the inertia of a cube,
    // so that a pair and a thread have one too.
    double A[6][6] = {}, b[6] = {};
    for (size_t n = 0; n < size; ++n) {
        const size_t i = rows[n];
        const double m = trait_[i].z, edge = static_cast<double>(p.position[i].w) / kSupport;
        const double d[3] = {p.position[i].x - center[0], p.position[i].y - center[1], p.position[i].z - center[2]};
        const double r[3] = {residual_[i].x, residual_[i].y, residual_[i].z};
        double D[3][3] = {{m, 0, 0}, {0, m, 0}, {0, 0, m}};
        if (leans && contactCount_[i]) {
            const Vec4 a = wallDrag_[2 * i], c = wallDrag_[2 * i + 1];
            D[0][0] += a.x, D[1][1] += a.y, D[2][2] += a.z;
            D[0][1] += c.x, D[1][0] += c.x, D[0][2] += c.y, D[2][0] += c.y, D[1][2] += c.z, D[2][1] += c.z;
        }
        if (leans && p.moverCount < p.count) {
            const size_t first = f.neighbors.first[i >> 3] + (i & 7);
            for (uint32_t k = 0; k < f.neighbors.width[i >> 3]; ++k) {
                const size_t entry = first + 8 * static_cast<size_t>(k);
                const uint32_t j = f.neighbors.entries[entry] >> 4;
                if (j < static_cast<uint32_t>(p.moverCount) || j >= static_cast<uint32_t>(p.count)) continue;
                const Vec3 x = p.position[i].xyz() - p.position[j].xyz();
                const double c = coefficient_[entry], e[3] = {x.x, x.y, x.z};
                for (int s = 0; s < 3; ++s)
                    for (int t = 0; t < 3; ++t) D[s][t] += c * e[s] * e[t];
            }
        }
        // Velocity t + w x d: rows of R are those of (1, -[d]x).
        const double R[3][6] = {{1, 0, 0, 0, d[2], -d[1]}, {0, 1, 0, -d[2], 0, d[0]}, {0, 0, 1, d[1], -d[0], 0}};
        double DR[3][6];
        for (int s = 0; s < 3; ++s)
            for (int t = 0; t < 6; ++t) DR[s][t] = D[s][0] * R[0][t] + D[s][1] * R[1][t] + D[s][2] * R[2][t];
        for (int s = 0; s < 6; ++s) {
            for (int t = s; t < 6; ++t) A[s][t] += R[0][s] * DR[0][t] + R[1][s] * DR[1][t] + R[2][s] * DR[2][t];
            b[s] += R[0][s] * r[0] + R[1][s] * r[1] + R[2][s] * r[2];
        }
        for (int s = 3; s < 6; ++s) A[s][s] += m * edge * edge / 6;
    }
    // Cholesky; positive, for every particle has mass and inertia.
    double L[6][6] = {}, y[6];
    for (int s = 0; s < 6; ++s)
        for (int t = s; t < 6; ++t) {
            double sum = A[s][t];
            for (int k = 0; k < s; ++k) sum -= L[s][k] * L[t][k];
            if (t == s && !(sum > 0)) return;
            L[t][s] = t == s ? std::sqrt(sum) : sum / L[s][s];
        }
    for (int s = 0; s < 6; ++s) {
        y[s] = b[s];
        for (int k = 0; k < s; ++k) y[s] -= L[s][k] * y[k];
        y[s] /= L[s][s];
    }
    for (int s = 5; s >= 0; --s) {
        for (int k = s + 1; k < 6; ++k) y[s] -= L[k][s] * y[k];
        y[s] /= L[s][s];
    }
    const Vec3 drift{static_cast<float>(y[0]), static_cast<float>(y[1]), static_cast<float>(y[2])};
    const Vec3 spin{static_cast<float>(y[3]), static_cast<float>(y[4]), static_cast<float>(y[5])};
    for (size_t n = 0; n < size; ++n) {
        const size_t i = rows[n];
        const Vec3 d{static_cast<float>(p.position[i].x - center[0]), static_cast<float>(p.position[i].y - center[1]),
                     static_cast<float>(p.position[i].z - center[2])};
        p.velocity[i].setXyz(p.velocity[i].xyz() + drift + cross(spin, d));
    }
}

void Motion::viscosity(const MotionFrame& f) {
    Particles& p = f.particles;
    if (p.moverCount == 0) return;
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
            const float mass = trait_[i].z, h = p.position[i].w;
            Vec3 diagonal = diagonal_[i].xyz() + Vec3{mass, mass, mass};
            if (contactCount_[i]) {
                Vec4 a, b;
                Vec3 push;
                for (size_t c = i * kContacts, n = c + contactCount_[i]; c < n; ++c) {
                    const Vec4 k = contact_[c];
                    if (k.w >= h) continue;
                    const WallShear w = wallShear(f, i, c);
                    const float t = w.tangent, s = w.normal;
                    if (wallsMove_) push += w.on(k.xyz(), wallVelocity_[c].xyz());
                    a.x += t + s * k.x * k.x, a.y += t + s * k.y * k.y, a.z += t + s * k.z * k.z;
                    b.x += s * k.x * k.y, b.y += s * k.x * k.z, b.z += s * k.y * k.z;
                }
                wallDrag_[2 * i] = a, wallDrag_[2 * i + 1] = b;
                if (wallsMove_) wallPush_[i] = {push.x, push.y, push.z, 0};
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
            Vec3 res = trait_[i].z * before_[i].xyz() - image_[i].xyz();
            if (wallsMove_ && contactCount_[i]) res += wallPush_[i].xyz();
            const Vec3 z = divide(res, diagonal_[i]);
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
    if (sound) reportHeldDrag(f);
    if (sound && reporting_)
        forMovers([&](int begin, int, int last, BlockSums&) {
            for (int r = 8 * begin; r < last; ++r) {
                const size_t i = static_cast<size_t>(r);
                for (size_t c = i * kContacts, n = c + contactCount_[i]; c < n; ++c) {
                    if (contact_[c].w >= p.position[i].w) continue;
                    const Vec3 wall = wallsMove_ ? wallVelocity_[c].xyz() : Vec3{};
                    kick(c, (1 / trait_[i].z) * wallShear(f, i, c).on(contact_[c].xyz(), wall - p.velocity[i].xyz()));
                }
            }
        });
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
