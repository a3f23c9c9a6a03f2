// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/state_io.h"
#include "base/types.h"

#include <cmath>

// What rigid pieces compute with: double, because a piece of 5,000 particles at rest must not creep by rounding.
namespace thaw {

struct Double3 {
    double x = 0, y = 0, z = 0;
};
inline Double3 operator+(Double3 a, Double3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Double3 operator-(Double3 a, Double3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Double3 operator*(double s, Double3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline Double3& operator+=(Double3& a, Double3 b) { return a = a + b; }
inline Double3& operator-=(Double3& a, Double3 b) { return a = a - b; }
inline double dot(Double3 a, Double3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Double3 cross(Double3 a, Double3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Double3 a) { return std::sqrt(dot(a, a)); }
inline Double3 wide(Vec3 a) { return {a.x, a.y, a.z}; }
inline Vec3 narrow(Double3 a) { return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)}; }

// A symmetric matrix: inertia and its inverse.
struct Symmetric3 {
    double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
    // Of a mass at d from the centre, and the share of a cube of that mass and edge about its own centre.
    void addMass(double mass, Double3 d, double edge) {
        const double own = mass * edge * edge / 6;
        xx += mass * (d.y * d.y + d.z * d.z) + own, yy += mass * (d.x * d.x + d.z * d.z) + own;
        zz += mass * (d.x * d.x + d.y * d.y) + own;
        xy -= mass * d.x * d.y, xz -= mass * d.x * d.z, yz -= mass * d.y * d.z;
    }
};
template <> inline constexpr bool kGapless<Double3> = true;
template <> inline constexpr bool kGapless<Symmetric3> = true;
inline Double3 operator*(const Symmetric3& a, Double3 v) {
    return {a.xx * v.x + a.xy * v.y + a.xz * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
            a.xz * v.x + a.yz * v.y + a.zz * v.z};
}
inline Symmetric3 inverse(const Symmetric3& a) {
    const double cx = a.yy * a.zz - a.yz * a.yz, cy = a.xz * a.yz - a.xy * a.zz, cz = a.xy * a.yz - a.xz * a.yy;
    const double s = 1 / (a.xx * cx + a.xy * cy + a.xz * cz);
    return {s * cx, s * (a.xx * a.zz - a.xz * a.xz), s * (a.xx * a.yy - a.xy * a.xy), s * cy,
            s * cz, s * (a.xy * a.xz - a.xx * a.yz)};
}

// Cholesky of a symmetric matrix of six motions by its lower triangle, in place. False where it is not positive.
inline bool factorise(double (&a)[6][6]) {
    for (int r = 0; r < 6; ++r)
        for (int c = 0; c <= r; ++c) {
            double z = a[r][c];
            for (int k = 0; k < c; ++k) z -= a[r][k] * a[c][k];
            if (r == c && !(z > 0)) return false;
            a[r][c] = r == c ? std::sqrt(z) : z / a[c][c];
        }
    return true;
}
// Solves with the factor; b becomes the solution.
inline void solve(const double (&factor)[6][6], double (&b)[6]) {
    for (int q = 0; q < 6; ++q) {
        for (int k = 0; k < q; ++k) b[q] -= factor[q][k] * b[k];
        b[q] /= factor[q][q];
    }
    for (int q = 5; q >= 0; --q) {
        for (int k = q + 1; k < 6; ++k) b[q] -= factor[k][q] * b[k];
        b[q] /= factor[q][q];
    }
}

// A rotation by its rows.
struct Rotation3 {
    Double3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    Double3 apply(Double3 v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
    Double3 applyBack(Double3 v) const { return v.x * x + v.y * y + v.z * z; }
};
// a after b.
inline Rotation3 operator*(const Rotation3& a, const Rotation3& b) {
    return {b.applyBack(a.x), b.applyBack(a.y), b.applyBack(a.z)};
}
// R S R^T
inline Symmetric3 turned(const Rotation3& r, const Symmetric3& s) {
    const Double3 x = s * r.x, y = s * r.y, z = s * r.z;
    return {dot(r.x, x), dot(r.y, y), dot(r.z, z), dot(r.x, y), dot(r.x, z), dot(r.y, z)};
}
// By the vector's direction and length (rad). Own series and a unit quaternion: sin and cos of the C library differ
// between machines. Exact to rounding below 2 rad, a rotation whatever the angle.
inline Rotation3 rotationBy(Double3 angle) {
    const double t = 0.25 * dot(angle, angle); // half the angle, squared
    double s = 1, c = 1;
    for (int k = 9; k > 0; --k) s = 1 - s * t / ((2 * k) * (2 * k + 1)), c = 1 - c * t / ((2 * k - 1) * (2 * k));
    Double3 v = (0.5 * s) * angle;
    const double l = 1 / std::sqrt(dot(v, v) + c * c), w = l * c;
    v = l * v;
    const double xx = v.x * v.x, yy = v.y * v.y, zz = v.z * v.z;
    return {{1 - 2 * (yy + zz), 2 * (v.x * v.y - w * v.z), 2 * (v.x * v.z + w * v.y)},
            {2 * (v.x * v.y + w * v.z), 1 - 2 * (xx + zz), 2 * (v.y * v.z - w * v.x)},
            {2 * (v.x * v.z - w * v.y), 2 * (v.y * v.z + w * v.x), 1 - 2 * (xx + yy)}};
}

} // namespace thaw
