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

HWY_EXPORT(copyNearLanes);
HWY_EXPORT(weighLanes);

int copyNear(const FillArrays& from, const uint32_t* fromRows, const int* begins, const int* ends, int runs,
             const FillBox& box, float sharper, float* to, int stride, uint32_t* rows) {
    return HWY_DYNAMIC_DISPATCH(copyNearLanes)(from, fromRows, begins, ends, runs, box, sharper, to, stride, rows);
}

int weigh(const float* near, int stride, int count, float x, float y, float z, float* weights, uint32_t* which) {
    return HWY_DYNAMIC_DISPATCH(weighLanes)(near, stride, count, x, y, z, weights, which);
}

} // namespace thaw
#endif
