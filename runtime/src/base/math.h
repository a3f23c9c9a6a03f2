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

// FNV-1a style 64-bit mixing over words; order matters.
inline uint64_t hashCombine(uint64_t h, uint64_t v) {
    h ^= v;
    h *= 0x9e3779b97f4a7c15ULL;
    return h ^ (h >> 32);
}

} // namespace thaw
