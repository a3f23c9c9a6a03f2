// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/field_simd.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surface/field_simd.cpp"
#include "hwy/foreach_target.h"

#include "base/simd.h"

HWY_BEFORE_NAMESPACE();
namespace thaw {
namespace HWY_NAMESPACE {

HWY_INLINE F32 outside(F32 v, float center, float half) {
    return hn::Max(hn::Sub(hn::Abs(hn::Sub(v, all(center))), all(half)), zero());
}

HWY_INLINE F32 kernel(F32 t, F32 amplitude) {
    t = hn::Max(t, zero());
    return hn::Mul(hn::Mul(amplitude, t), hn::Mul(t, t));
}

// Those of a run that reach into the box, where they stand. Up to seven more are written.
HWY_INLINE int listNear(const FillArrays& from, int begin, int end, const FillBox& box, float sharper, uint32_t* out) {
    int count = 0;
    for (int k = begin; k < end; k += kLanes) {
        const F32 dx = outside(load(from.x + k), box.center[0], box.half[0]),
                  dy = outside(load(from.y + k), box.center[1], box.half[1]),
                  dz = outside(load(from.z + k), box.center[2], box.half[2]);
        const Mask reaches =
            hn::Lt(hn::Mul(dot3(dx, dy, dz, dx, dy, dz), hn::Mul(load(from.inverse + k), all(sharper))), all(1));
        unsigned bits = bitsOf(reaches);
        if (end - k < kLanes) bits &= (1u << (end - k)) - 1;
        for (; bits != 0; bits &= bits - 1)
            out[count++] = static_cast<uint32_t>(k) + static_cast<uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
    }
    return count;
}

void sumAroundLanes(const FillArrays& from, const int* begins, const int* ends, int runs, const FillBox& box,
                    const int* which, int rows, int* sums) {
    constexpr int kRoom = 256;
    uint32_t list[kRoom + 8];
    alignas(32) float x[kRoom + 8], y[kRoom + 8], z[kRoom + 8], inverse[kRoom + 8], amplitude[kRoom + 8];
    for (int i = 0; i < rows; ++i) sums[i] = 0;
    int count = 0;
    for (int run = 0; run < runs; ++run)
        for (int begin = begins[run]; begin < ends[run]; begin += kRoom / 2) {
            const int end = begin + kRoom / 2 < ends[run] ? begin + kRoom / 2 : ends[run];
            const int found = listNear(from, begin, end, box, 1, list);
            for (int n = 0; n < found; ++n, ++count) {
                const uint32_t j = list[n];
                x[count] = from.x[j], y[count] = from.y[j], z[count] = from.z[j];
                inverse[count] = from.inverse[j], amplitude[count] = from.amplitude[j];
            }
            const bool isLast = run + 1 == runs && end == ends[run];
            if (count < kRoom / 2 && !isLast) continue;
            for (int k = count; k < count + 8; ++k) x[k] = y[k] = z[k] = inverse[k] = amplitude[k] = 0;
            for (int i = 0; i < rows; ++i) {
                const F32 px = all(from.x[which[i]]), py = all(from.y[which[i]]), pz = all(from.z[which[i]]);
                auto lanes = hn::Zero(kI32);
                for (int k = 0; k < count; k += kLanes) {
                    const F32 dx = hn::Sub(load(x + k), px), dy = hn::Sub(load(y + k), py),
                              dz = hn::Sub(load(z + k), pz);
                    const F32 t = hn::NegMulAdd(dot3(dx, dy, dz, dx, dy, dz), load(inverse + k), all(1));
                    const F32 w = kernel(t, load(amplitude + k));
                    lanes = hn::Add(lanes, hn::NearestInt(hn::Mul(w, all(1 / kFillUnit))));
                }
                sums[i] += hn::GetLane(hn::SumOfLanes(kI32, lanes));
            }
            count = 0;
        }
}

int copyNearLanes(const FillArrays& from, const uint32_t* fromRows, const int* begins, const int* ends, int runs,
                  const FillBox& box, float sharper, float* to, int stride, uint32_t* rows) {
    int count = 0;
    for (int run = 0; run < runs; ++run) count += listNear(from, begins[run], ends[run], box, sharper, rows + count);
    for (int k = 0; k < count; ++k) {
        const uint32_t j = rows[k];
        to[k] = from.x[j], to[stride + k] = from.y[j], to[2 * stride + k] = from.z[j];
        to[3 * stride + k] = from.inverse[j] * sharper;
        rows[k] = fromRows[j];
    }
    return count;
}

int weighLanes(const float* near, int stride, int count, float x, float y, float z, float* weights, uint32_t* which) {
    int found = 0;
    for (int k = 0; k < count; k += kLanes) {
        const F32 dx = hn::Sub(load(near + k), all(x)), dy = hn::Sub(load(near + stride + k), all(y)),
                  dz = hn::Sub(load(near + 2 * stride + k), all(z));
        const F32 t = hn::NegMulAdd(dot3(dx, dy, dz, dx, dy, dz), load(near + 3 * stride + k), all(1));
        unsigned bits = bitsOf(hn::Gt(t, zero()));
        if (count - k < kLanes) bits &= (1u << (count - k)) - 1;
        if (bits == 0) continue;
        alignas(32) float lane[kLanes];
        hn::Store(hn::Mul(t, hn::Mul(t, t)), kF32, lane);
        for (; bits != 0; bits &= bits - 1) {
            const uint32_t l = static_cast<uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
            weights[found] = lane[l], which[found++] = static_cast<uint32_t>(k) + l;
        }
    }
    return found;
}

} // namespace HWY_NAMESPACE
} // namespace thaw
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace thaw {

HWY_EXPORT(sumAroundLanes);
HWY_EXPORT(copyNearLanes);
HWY_EXPORT(weighLanes);

void sumAround(const FillArrays& from, const int* begins, const int* ends, int runs, const FillBox& box,
               const int* which, int count, int* sums) {
    HWY_DYNAMIC_DISPATCH(sumAroundLanes)(from, begins, ends, runs, box, which, count, sums);
}

int copyNear(const FillArrays& from, const uint32_t* fromRows, const int* begins, const int* ends, int runs,
             const FillBox& box, float sharper, float* to, int stride, uint32_t* rows) {
    return HWY_DYNAMIC_DISPATCH(copyNearLanes)(from, fromRows, begins, ends, runs, box, sharper, to, stride, rows);
}

int weigh(const float* near, int stride, int count, float x, float y, float z, float* weights, uint32_t* which) {
    return HWY_DYNAMIC_DISPATCH(weighLanes)(near, stride, count, x, y, z, weights, which);
}

} // namespace thaw
#endif
