// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/field_simd.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surface/field_simd.cpp"
#include "hwy/foreach_target.h"

#include "base/simd.h"

HWY_BEFORE_NAMESPACE();
namespace thaw {
namespace HWY_NAMESPACE {

HWY_INLINE F32 kernel(F32 t, F32 amplitude) {
    t = hn::Max(t, zero());
    return hn::Mul(hn::Mul(amplitude, t), hn::Mul(t, t));
}

float sumRunsLanes(const FillArrays& from, const int* begins, const int* ends, int runs, float x, float y, float z,
                   float enough) {
    const F32 px = all(x), py = all(y), pz = all(z), one = all(1);
    float sum = 0;
    for (int run = 0; run < runs && sum < enough; ++run) {
        F32 lanes = zero();
        for (int k = begins[run]; k < ends[run]; k += kLanes) {
            F32 dx = hn::Sub(load(from.x + k), px), dy = hn::Sub(load(from.y + k), py),
                dz = hn::Sub(load(from.z + k), pz);
            F32 t = hn::NegMulAdd(dot3(dx, dy, dz, dx, dy, dz), load(from.inverse + k), one);
            F32 w = kernel(t, load(from.amplitude + k));
            lanes = hn::Add(lanes, hn::IfThenElseZero(hn::FirstN(kF32, size_t(ends[run] - k)), w));
        }
        sum += float(sumOfLanes(lanes));
    }
    return sum;
}

void splatSourceLanes(const FillSource& s, float* values) {
    constexpr int kSide = 8, kNodes = 512;
    const float squared = s.radius * s.radius, inverse = 1 / squared;
    alignas(64) float alongX[kSide];
    for (int l = 0; l < kSide; ++l) alongX[l] = 1 - (float(l) - s.x) * (float(l) - s.x) * inverse;
    const F32 amplitude = all(s.amplitude), c0 = all(s.carried[0]), c1 = all(s.carried[1]), c2 = all(s.carried[2]);
    int zBegin = static_cast<int>(std::ceil(s.z - s.radius)), zEnd = static_cast<int>(std::floor(s.z + s.radius));
    if (zBegin < 0) zBegin = 0;
    if (zEnd > kSide - 1) zEnd = kSide - 1;
    for (int nz = zBegin; nz <= zEnd; ++nz) {
        const float dz = float(nz) - s.z, rest = squared - dz * dz, half = rest > 0 ? std::sqrt(rest) : 0;
        int yBegin = static_cast<int>(std::ceil(s.y - half)), yEnd = static_cast<int>(std::floor(s.y + half));
        if (yBegin < 0) yBegin = 0;
        if (yEnd > kSide - 1) yEnd = kSide - 1;
        for (int ny = yBegin; ny <= yEnd; ++ny) {
            const float dy = float(ny) - s.y;
            const F32 across = all((dy * dy + dz * dz) * inverse);
            for (int part = 0; part < kSide; part += kLanes) {
                float* row = values + (nz * kSide + ny) * kSide + part;
                const F32 w = kernel(hn::Sub(load(alongX + part), across), amplitude);
                store(hn::Add(load(row), w), row);
                store(hn::MulAdd(w, c0, load(row + kNodes)), row + kNodes);
                store(hn::MulAdd(w, c1, load(row + 2 * kNodes)), row + 2 * kNodes);
                store(hn::MulAdd(w, c2, load(row + 3 * kNodes)), row + 3 * kNodes);
            }
        }
    }
}

} // namespace HWY_NAMESPACE
} // namespace thaw
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace thaw {

HWY_EXPORT(sumRunsLanes);
HWY_EXPORT(splatSourceLanes);

float sumRuns(const FillArrays& from, const int* begins, const int* ends, int runs, float x, float y, float z,
              float enough) {
    return HWY_DYNAMIC_DISPATCH(sumRunsLanes)(from, begins, ends, runs, x, y, z, enough);
}

void splatSource(const FillSource& source, float* values) { HWY_DYNAMIC_DISPATCH(splatSourceLanes)(source, values); }

} // namespace thaw
#endif
