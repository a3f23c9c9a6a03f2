// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/kernel.h"
#include "motion/motion.h"
#include "motion/rigid_math.h"

#include <cmath>

namespace thaw {

// Gives a piece linear (kg m/s) and angular momentum (kg m^2/s, about its centre of mass) as one rigid motion.
void Motion::addRigidMotion(const MotionFrame& f, const uint32_t* rows, size_t count, const double (&linear)[3],
                            const double (&angular)[3]) {
    Particles& p = f.particles;
    double mass = 0, center[3] = {};
    for (size_t n = 0; n < count; ++n) {
        const size_t i = rows[n];
        const double m = trait_[i].z;
        const Vec4 x = p.position[i];
        mass += m, center[0] += m * x.x, center[1] += m * x.y, center[2] += m * x.z;
    }
    for (double& c : center) c /= mass;
    // Inertia about the centre, with a trace of the particles' own so that a pair and a thread can be divided by it
    // too. All of it (a sixth of a cube's) is not in the velocities: a blob of ten spacings would get 98 % of what it
    // lost.
    constexpr double kOwn = 1e-6;
    double I[3][3] = {};
    for (size_t n = 0; n < count; ++n) {
        const size_t i = rows[n];
        const double m = trait_[i].z, edge = static_cast<double>(p.position[i].w) / kSupport,
                     own = kOwn * m * edge * edge;
        const double d[3] = {p.position[i].x - center[0], p.position[i].y - center[1], p.position[i].z - center[2]};
        const double d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        for (int a = 0; a < 3; ++a)
            for (int k = 0; k < 3; ++k) I[a][k] += (a == k ? m * d2 + own : 0) - m * d[a] * d[k];
    }
    const auto minor = [&](int a, int b) {
        const int a1 = (a + 1) % 3, a2 = (a + 2) % 3, b1 = (b + 1) % 3, b2 = (b + 2) % 3;
        return I[a1][b1] * I[a2][b2] - I[a1][b2] * I[a2][b1];
    };
    const double det = I[0][0] * minor(0, 0) + I[0][1] * minor(0, 1) + I[0][2] * minor(0, 2);
    double spin[3] = {};
    if (det > 0)
        for (int a = 0; a < 3; ++a)
            spin[a] = (minor(0, a) * angular[0] + minor(1, a) * angular[1] + minor(2, a) * angular[2]) / det;
    for (size_t n = 0; n < count; ++n) {
        const size_t i = rows[n];
        const double d[3] = {p.position[i].x - center[0], p.position[i].y - center[1], p.position[i].z - center[2]};
        const double v[3] = {linear[0] / mass + spin[1] * d[2] - spin[2] * d[1],
                             linear[1] / mass + spin[2] * d[0] - spin[0] * d[2],
                             linear[2] / mass + spin[0] * d[1] - spin[1] * d[0]};
        Vec4& u = p.velocity[i];
        u.x = static_cast<float>(u.x + v[0]), u.y = static_cast<float>(u.y + v[1]);
        u.z = static_cast<float>(u.z + v[2]);
    }
}

// Viscosity changes neither momentum of a piece that leans on no wall and nothing held, the capped solve does: the
// piece gets back what it lost as one rigid motion. Left in, it is in the next warm start too and grows: a clump of
// twelve setting particles, whose own stiffness keeps its drift out of reach of the iterations, took off at 15 m/s^2.
// Measured from the velocities and not from the residual, whose recurrence rounds (2e-4 of a stiff blob's momentum in
// a second), and also where the start was good enough to need no iteration.
void Motion::returnMomentum(const MotionFrame& f, bool every) {
    Particles& p = f.particles;
    const uint32_t movers = static_cast<uint32_t>(p.moverCount);
    size_t start = 0;
    floatingPieces_ = 0;
    for (uint32_t i = 0; every && i < movers; ++i)
        piece_[i] = gripped(i) ? kLeaning : piece_[i] == kLeaning ? kTouching : kUnknown;
    // Most movers lean themselves, or a neighbour of theirs does: the search ends where it meets the first that leans.
    for (uint32_t seed = 0; seed < movers; ++seed) {
        if (piece_[seed] != kUnknown && piece_[seed] != kTouching) continue;
        size_t size = start;
        bool leaning = false, touching = piece_[seed] == kTouching;
        queue_[size++] = seed, piece_[seed] = kAfloat;
        for (size_t head = start; head < size && !leaning; ++head)
            forNeighbors(f.neighbors, static_cast<int>(queue_[head]), [&](uint32_t j) {
                if (j >= movers) return false; // from here on held rows, known to lean on, and dummies
                if (piece_[j] == kAfloat) return true;
                leaning = piece_[j] == kLeaning, touching |= piece_[j] == kTouching;
                if (!leaning) piece_[j] = kAfloat, queue_[size++] = j;
                return !leaning;
            });
        if (leaning) {
            for (size_t n = start; n < size; ++n) piece_[queue_[n]] = kLeaning;
            continue;
        }
        if (touching) {
            moveRigidly(f, queue_.data() + start, size - start);
            continue;
        }
        double lost[3] = {}, turned[3] = {}, center[3] = {}, mass = 0;
        for (size_t n = start; n < size; ++n) {
            const size_t i = queue_[n];
            const double m = trait_[i].z;
            const Vec4 x = p.position[i];
            mass += m, center[0] += m * x.x, center[1] += m * x.y, center[2] += m * x.z;
        }
        for (size_t n = start; n < size; ++n) {
            const size_t i = queue_[n];
            const Vec4 x = p.position[i], u = before_[i], v = p.velocity[i];
            const double m = trait_[i].z, r[3] = {m * (u.x - v.x), m * (u.y - v.y), m * (u.z - v.z)};
            const double d[3] = {x.x - center[0] / mass, x.y - center[1] / mass, x.z - center[2] / mass};
            for (int a = 0; a < 3; ++a) {
                const int b = (a + 1) % 3, c = (a + 2) % 3;
                lost[a] += r[a], turned[a] += d[b] * r[c] - d[c] * r[b];
            }
        }
        addRigidMotion(f, queue_.data() + start, size - start, lost, turned);
        pieceEnd_[floatingPieces_++] = static_cast<uint32_t>(size);
        start = size;
    }
}

// A piece that leans gets the rigid motion that leaves no residual in its sums against the drag of what it leans on (a
// Galerkin correction, which only brings the solve nearer to its solution); for walls that move or report: a blob hit
// by a plate gained 0.3 of the momentum that the plate lost, with this 1.0.
void Motion::moveRigidly(const MotionFrame& f, const uint32_t* rows, size_t size) {
    Particles& p = f.particles;
    double mass = 0, center[3] = {};
    for (size_t n = 0; n < size; ++n) {
        const double m = trait_[rows[n]].z;
        const Vec4 x = p.position[rows[n]];
        mass += m;
        center[0] += m * x.x, center[1] += m * x.y, center[2] += m * x.z;
    }
    for (double& c : center) c /= mass;
    // Lower triangle of the matrix of the six motions, and their right side. Each particle has the inertia of a cube,
    // so that a pair and a thread have one too.
    double A[6][6] = {}, b[6] = {};
    for (size_t n = 0; n < size; ++n) {
        const size_t i = rows[n];
        const double m = trait_[i].z, edge = static_cast<double>(p.position[i].w) / kSupport;
        const double d[3] = {p.position[i].x - center[0], p.position[i].y - center[1], p.position[i].z - center[2]};
        const double r[3] = {residual_[i].x, residual_[i].y, residual_[i].z};
        double D[3][3] = {{m, 0, 0}, {0, m, 0}, {0, 0, m}};
        if (f.guide) {
            const Vec3 axis = f.unguided ? f.unguided[i].xyz() : Vec3{};
            const double a[3] = {axis.x, axis.y, axis.z}, w = m * static_cast<double>(f.guide[i].w);
            for (int s = 0; s < 3; ++s)
                for (int t = 0; t < 3; ++t) D[s][t] += w * ((s == t ? 1 : 0) - a[s] * a[t]);
        }
        if (contactCount_[i]) {
            const Vec4 a = wallDrag_[2 * i], c = wallDrag_[2 * i + 1];
            D[0][0] += a.x, D[1][1] += a.y, D[2][2] += a.z;
            D[0][1] += c.x, D[1][0] += c.x, D[0][2] += c.y, D[2][0] += c.y, D[1][2] += c.z, D[2][1] += c.z;
        }
        if (p.moverCount < p.count) {
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
            for (int t = s; t < 6; ++t) A[t][s] += R[0][s] * DR[0][t] + R[1][s] * DR[1][t] + R[2][s] * DR[2][t];
            b[s] += R[0][s] * r[0] + R[1][s] * r[1] + R[2][s] * r[2];
        }
        for (int s = 3; s < 6; ++s) A[s][s] += m * edge * edge / 6;
    }
    if (!factorise(A)) return;
    solve(A, b);
    const Vec3 drift{static_cast<float>(b[0]), static_cast<float>(b[1]), static_cast<float>(b[2])};
    const Vec3 spin{static_cast<float>(b[3]), static_cast<float>(b[4]), static_cast<float>(b[5])};
    for (size_t n = 0; n < size; ++n) {
        const size_t i = rows[n];
        const Vec3 d{static_cast<float>(p.position[i].x - center[0]), static_cast<float>(p.position[i].y - center[1]),
                     static_cast<float>(p.position[i].z - center[2])};
        p.velocity[i].setXyz(p.velocity[i].xyz() + drift + cross(spin, d));
    }
}

// Moving particles apart (image_) changes what their velocities amount to as a spin: a floating piece gets that back.
void Motion::returnSpin(const MotionFrame& f) {
    Particles& p = f.particles;
    size_t start = 0;
    for (size_t piece = 0; piece < floatingPieces_; ++piece) {
        const size_t end = pieceEnd_[piece];
        double gained[3] = {};
        for (size_t n = start; n < end; ++n) {
            const size_t i = queue_[n];
            const double m = trait_[i].z;
            const Vec4 s = image_[i], v = p.velocity[i];
            gained[0] -= m * (static_cast<double>(s.y) * v.z - static_cast<double>(s.z) * v.y);
            gained[1] -= m * (static_cast<double>(s.z) * v.x - static_cast<double>(s.x) * v.z);
            gained[2] -= m * (static_cast<double>(s.x) * v.y - static_cast<double>(s.y) * v.x);
        }
        if (gained[0] != 0 || gained[1] != 0 || gained[2] != 0)
            addRigidMotion(f, queue_.data() + start, end - start, {0, 0, 0}, gained);
        start = end;
    }
}

} // namespace thaw
