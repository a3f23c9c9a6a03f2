// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include "thaw/thaw.h"

#include <array>
#include <cmath>

namespace thaw::view {

using Vec3 = thawVec3;

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline float length(Vec3 a) { return std::sqrt(dot(a, a)); }

/// Unit vector along a, or fallback when a has no direction.
inline Vec3 normalize(Vec3 a, Vec3 fallback = {0, 1, 0}) {
    const float l = length(a);
    return l > 1e-20f ? a * (1 / l) : fallback;
}

/// Any unit vector at right angles to the unit vector n.
inline Vec3 perpendicular(Vec3 n) {
    return normalize(std::fabs(n.y) < 0.9f ? cross({0, 1, 0}, n) : cross({1, 0, 0}, n), {1, 0, 0});
}

inline Vec3 rotate(thawQuat q, Vec3 v) {
    const Vec3 u{q.x, q.y, q.z};
    const Vec3 t = cross(u, v) * 2;
    return v + t * q.w + cross(u, t);
}

/// Column-major, as OpenGL reads it.
struct Mat4 {
    std::array<float, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
};

inline Mat4 operator*(const Mat4& a, const Mat4& b) {
    Mat4 r;
    for (int c = 0; c < 4; ++c)
        for (int row = 0; row < 4; ++row) {
            float s = 0;
            for (int k = 0; k < 4; ++k) s += a.m[k * 4 + row] * b.m[c * 4 + k];
            r.m[c * 4 + row] = s;
        }
    return r;
}

/// World to view; the camera looks along -z of the view. right, up and forward must be orthonormal.
inline Mat4 viewMatrix(Vec3 eye, Vec3 right, Vec3 up, Vec3 forward) {
    Mat4 r;
    r.m = {right.x, up.x, -forward.x, 0, right.y,          up.y,          -forward.y,        0,
           right.z, up.z, -forward.z, 0, -dot(right, eye), -dot(up, eye), dot(forward, eye), 1};
    return r;
}

/// tanHalf: tangent of half the vertical field of view.
inline Mat4 perspective(float tanHalf, float aspect, float near, float far) {
    Mat4 r;
    r.m = {1 / (tanHalf * aspect),        0, 0, 0, 0, 1 / tanHalf, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0,
           2 * far * near / (near - far), 0};
    return r;
}

/// Box of half width and height `half`, from near to far in front of the view.
inline Mat4 orthographic(float half, float near, float far) {
    Mat4 r;
    r.m = {1 / half, 0, 0, 0, 0, 1 / half, 0, 0, 0, 0, 2 / (near - far), 0, 0, 0, (far + near) / (near - far), 1};
    return r;
}

inline Mat4 transform(Vec3 position, thawQuat rotation, float scale) {
    const Vec3 x = rotate(rotation, {scale, 0, 0}), y = rotate(rotation, {0, scale, 0}),
               z = rotate(rotation, {0, 0, scale});
    Mat4 r;
    r.m = {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, position.x, position.y, position.z, 1};
    return r;
}

/// Axis-aligned box; empty while lower > upper.
struct Bounds {
    Vec3 lower{INFINITY, INFINITY, INFINITY}, upper{-INFINITY, -INFINITY, -INFINITY};

    bool empty() const { return !(lower.x <= upper.x); }
    void add(Vec3 p) {
        lower = {std::fmin(lower.x, p.x), std::fmin(lower.y, p.y), std::fmin(lower.z, p.z)};
        upper = {std::fmax(upper.x, p.x), std::fmax(upper.y, p.y), std::fmax(upper.z, p.z)};
    }
    void add(const Bounds& b) {
        if (!b.empty()) add(b.lower), add(b.upper);
    }
    Vec3 center() const { return (lower + upper) * 0.5f; }
    float radius() const { return empty() ? 0 : 0.5f * length(upper - lower); }
};

} // namespace thaw::view
