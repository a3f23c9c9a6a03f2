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

// In kFillUnit, which is in the amplitude.
HWY_INLINE hn::Vec<TagI32> share(F32 dx, F32 dy, F32 dz, F32 inverse, F32 amplitude) {
    const F32 t = hn::Max(hn::NegMulAdd(dot3(dx, dy, dz, dx, dy, dz), inverse, all(1)), zero());
    return hn::NearestInt(hn::Mul(hn::Mul(amplitude, t), hn::Mul(t, t)));
}

HWY_INLINE Mask reaches(F32 x, F32 y, F32 z, F32 inverse, const FillBox& box) {
    const F32 dx = outside(x, box.center[0], box.half[0]), dy = outside(y, box.center[1], box.half[1]),
              dz = outside(z, box.center[2], box.half[2]);
    return hn::Lt(hn::Mul(dot3(dx, dy, dz, dx, dy, dz), inverse), all(1));
}

// Lanes that are wanted are few, and gathered in a word first: a loop over each vector's own is a branch each that is
// not foreseen, and CompressStore to memory takes 100 cycles and more on some processors.
constexpr int kWord = 64;
HWY_INLINE uint64_t firstBits(int count) { return count < kWord ? (uint64_t{1} << count) - 1 : ~uint64_t{0}; }

// Those of a run that reach into the box, where they stand.
HWY_INLINE int listNear(const FillArrays& from, int begin, int end, const FillBox& box, float sharper, uint32_t* out) {
    int count = 0;
    for (int word = begin; word < end; word += kWord) {
        const int last = end < word + kWord ? end : word + kWord;
        uint64_t bits = 0;
        for (int k = word; k < last; k += kLanes)
            bits |= static_cast<uint64_t>(bitsOf(reaches(load(from.x + k), load(from.y + k), load(from.z + k),
                                                         hn::Mul(load(from.inverse + k), all(sharper)), box)))
                    << (k - word);
        for (bits &= firstBits(last - word); bits != 0; bits &= bits - 1)
            out[count++] = static_cast<uint32_t>(word + static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(bits)));
    }
    return count;
}

void sumAroundLanes(const FillArrays& from, const int* begins, const int* ends, int runs, const int* which, int rows,
                    int* sums) {
    // Four at a time share what is loaded. All of the runs: to pick first what is near costs more than it saves.
    for (int i = 0; i < rows; i += 4) {
        const int left = rows - i, a = which[i], b = which[left > 1 ? i + 1 : i], c = which[left > 2 ? i + 2 : i],
                  d = which[left > 3 ? i + 3 : i];
        const F32 x0 = all(from.x[a]), x1 = all(from.x[b]), x2 = all(from.x[c]), x3 = all(from.x[d]);
        const F32 y0 = all(from.y[a]), y1 = all(from.y[b]), y2 = all(from.y[c]), y3 = all(from.y[d]);
        const F32 z0 = all(from.z[a]), z1 = all(from.z[b]), z2 = all(from.z[c]), z3 = all(from.z[d]);
        auto s0 = hn::Zero(kI32), s1 = s0, s2 = s0, s3 = s0;
        for (int run = 0; run < runs; ++run)
            for (int k = begins[run]; k < ends[run]; k += kLanes) {
                const F32 x = load(from.x + k), y = load(from.y + k), z = load(from.z + k);
                const F32 inverse = load(from.inverse + k);
                const F32 amplitude = hn::IfThenElseZero(hn::FirstN(kF32, static_cast<size_t>(ends[run] - k)),
                                                         hn::Mul(load(from.amplitude + k), all(1 / kFillUnit)));
                s0 = hn::Add(s0, share(hn::Sub(x, x0), hn::Sub(y, y0), hn::Sub(z, z0), inverse, amplitude));
                s1 = hn::Add(s1, share(hn::Sub(x, x1), hn::Sub(y, y1), hn::Sub(z, z1), inverse, amplitude));
                s2 = hn::Add(s2, share(hn::Sub(x, x2), hn::Sub(y, y2), hn::Sub(z, z2), inverse, amplitude));
                s3 = hn::Add(s3, share(hn::Sub(x, x3), hn::Sub(y, y3), hn::Sub(z, z3), inverse, amplitude));
            }
        sums[i] = hn::GetLane(hn::SumOfLanes(kI32, s0));
        if (left > 1) sums[i + 1] = hn::GetLane(hn::SumOfLanes(kI32, s1));
        if (left > 2) sums[i + 2] = hn::GetLane(hn::SumOfLanes(kI32, s2));
        if (left > 3) sums[i + 3] = hn::GetLane(hn::SumOfLanes(kI32, s3));
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
    alignas(32) float cubes[kWord];
    int found = 0;
    for (int word = 0; word < count; word += kWord) {
        const int end = count < word + kWord ? count : word + kWord;
        uint64_t bits = 0;
        for (int k = word; k < end; k += kLanes) {
            const F32 dx = hn::Sub(load(near + k), all(x)), dy = hn::Sub(load(near + stride + k), all(y)),
                      dz = hn::Sub(load(near + 2 * stride + k), all(z));
            const F32 t = hn::NegMulAdd(dot3(dx, dy, dz, dx, dy, dz), load(near + 3 * stride + k), all(1));
            hn::Store(hn::Mul(t, hn::Mul(t, t)), kF32, cubes + (k - word));
            bits |= static_cast<uint64_t>(bitsOf(hn::Gt(t, zero()))) << (k - word);
        }
        for (bits &= firstBits(end - word); bits != 0; bits &= bits - 1) {
            const int l = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(bits));
            weights[found] = cubes[l], which[found++] = static_cast<uint32_t>(word + l);
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

void sumAround(const FillArrays& from, const int* begins, const int* ends, int runs, const int* which, int count,
               int* sums) {
    HWY_DYNAMIC_DISPATCH(sumAroundLanes)(from, begins, ends, runs, which, count, sums);
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
