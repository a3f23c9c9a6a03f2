// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace thaw {

// exp and log whose bits depend on nothing but the argument: the C library's differ between versions, and both feed
// state. Relative error below 1e-7 over the whole range; arithmetic in double, no fused operations (-ffp-contract=off).
inline float detExp(float xf) {
    double x = xf;
    if (!(x > -87.0)) return 0.0f;
    if (x > 88.0) x = 88.0;
    double k = std::floor(x * 1.4426950408889634 + 0.5);
    double r = x - k * 0.693147180559945309;
    double p =
        1.0 + r * (1.0 + r * (1.0 / 2 + r * (1.0 / 6 + r * (1.0 / 24 + r * (1.0 / 120 + r * (1.0 / 720 + r / 5040))))));
    return static_cast<float>(p * std::bit_cast<double>(static_cast<uint64_t>(static_cast<int64_t>(k) + 1023) << 52));
}

// x > 0 and normal.
inline float detLog(float xf) {
    uint64_t bits = std::bit_cast<uint64_t>(static_cast<double>(xf));
    int e = static_cast<int>((bits >> 52) & 0x7ff) - 1023;
    double m = std::bit_cast<double>((bits & 0xfffffffffffffULL) | 0x3ff0000000000000ULL); // [1, 2)
    if (m > 1.4142135623730951) m *= 0.5, ++e;
    double s = (m - 1) / (m + 1), s2 = s * s;
    double a = s * (2 + s2 * (2.0 / 3 + s2 * (2.0 / 5 + s2 * (2.0 / 7 + s2 * (2.0 / 9 + s2 * (2.0 / 11))))));
    return static_cast<float>(e * 0.693147180559945309 + a);
}

// Cube root by Newton from a log estimate; x >= 0.
inline float detCbrt(float x) {
    if (!(x > 0)) return 0;
    double y = detExp(detLog(x) * (1.0f / 3)), a = x;
    y -= (y * y * y - a) / (3 * y * y);
    y -= (y * y * y - a) / (3 * y * y);
    return static_cast<float>(y);
}

// atan within 1e-15: by the nearest quarter, whose arctangent is known, and the series of the rest, |r| <= 1/8.
inline double detAtan(double x) {
    constexpr double kKnown[] = {0, 0.24497866312686414, 0.46364760900080612, 0.64350110879328437, 0.78539816339744831};
    constexpr double kHalfPi = 1.57079632679489662;
    const double a = std::abs(x), t = a > 1 ? 1 / a : a;
    const int k = static_cast<int>(4 * t + 0.5);
    const double c = 0.25 * k, r = (t - c) / (1 + t * c), r2 = r * r;
    const double series =
        r * (1 - r2 * (1.0 / 3 - r2 * (1.0 / 5 - r2 * (1.0 / 7 - r2 * (1.0 / 9 - r2 * (1.0 / 11 - r2 / 13))))));
    const double angle = kKnown[k] + series;
    return std::copysign(a > 1 ? kHalfPi - angle : angle, x);
}
// Angle of (x, y) for y >= 0, 0..pi; 0 at the origin.
inline double detAngle(double y, double x) {
    constexpr double kPi = 3.14159265358979324;
    if (x == 0) return y > 0 ? 0.5 * kPi : 0;
    return x > 0 ? detAtan(y / x) : kPi + detAtan(y / x);
}
// Of x in -1..1 (clamped).
inline double detAcos(double x) {
    const double c = x < -1 ? -1 : x > 1 ? 1 : x;
    return detAngle(std::sqrt((1 - c) * (1 + c)), c);
}
// sin and cos of 2 pi u, 0 <= u < 1, within 1e-7.
inline void detTurn(float u, float& sine, float& cosine) {
    const int octant = static_cast<int>(8 * u); // of the circle; the rest is within an eighth of it
    const double x = (u - 0.125 * octant) * 6.28318530717958648, x2 = x * x;
    const double s = x * (1 - x2 * (1.0 / 6 - x2 * (1.0 / 120 - x2 * (1.0 / 5040 - x2 / 362880))));
    const double c = 1 - x2 * (0.5 - x2 * (1.0 / 24 - x2 * (1.0 / 720 - x2 / 40320)));
    constexpr double kDiagonal = 0.70710678118654752;
    constexpr double kCos[] = {1, kDiagonal, 0, -kDiagonal, -1, -kDiagonal, 0, kDiagonal};
    const double C = kCos[octant & 7], S = kCos[(octant + 6) & 7];
    sine = static_cast<float>(s * C + c * S), cosine = static_cast<float>(c * C - s * S);
}

// FNV-1a style 64-bit mixing over words; order matters.
inline uint64_t hashCombine(uint64_t h, uint64_t v) {
    h ^= v;
    h *= 0x9e3779b97f4a7c15ULL;
    return h ^ (h >> 32);
}

} // namespace thaw
