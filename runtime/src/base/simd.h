// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Eight rows at a time on whatever the machine has (Highway, chosen at run time): 8 lanes on AVX2 and AVX-512, 2 x 4 on
// SSE, NEON and WebAssembly, 8 x 1 where there is nothing. This header is compiled once per target, so it has no
// include guard of the usual kind and is only for files of this shape (say motion/matvec_simd.cpp):
//
//     #include "motion/matvec.h"              // declares struct MatvecArgs and void matvec(const MatvecArgs&, int,
//     int)
//
//     #undef HWY_TARGET_INCLUDE
//     #define HWY_TARGET_INCLUDE "motion/matvec_simd.cpp"   // this very file, from runtime/src
//     #include "hwy/foreach_target.h"
//
//     #include "base/simd.h"
//
//     HWY_BEFORE_NAMESPACE();
//     namespace thaw {
//     namespace HWY_NAMESPACE {
//
//     // y_i = sum_j c_ij (x_i - x_j) over groups [begin, end)
//     void matvecGroups(const MatvecArgs& a, int begin, int end) {
//         for (int g = begin; g < end; ++g)
//             for (int part = 0; part < 8; part += kLanes) {      // 1 turn with AVX2, 2 with SSE, 8 without
//                 const uint32_t* entry = a.entries + a.first[g] + part;
//                 const float* c = a.gradient + a.first[g] + part;
//                 Rows xi = loadRows(a.x + 8 * g + part);
//                 F32 y0 = zero(), y1 = zero(), y2 = zero();
//                 for (uint32_t k = 0; k < a.width[g]; ++k, entry += 8, c += 8) {
//                     Rows xj = gatherRows(a.x, entry);
//                     F32 cij = hn::LoadU(kF32, c);
//                     y0 = hn::MulAdd(cij, hn::Sub(xi.x, xj.x), y0); // and y1, y2
//                 }
//                 storeXyz(a.y + 8 * g + part, y0, y1, y2);
//             }
//     }
//
//     } // namespace HWY_NAMESPACE
//     } // namespace thaw
//     HWY_AFTER_NAMESPACE();
//
//     #if HWY_ONCE
//     namespace thaw {
//     HWY_EXPORT(matvecGroups); // export and dispatch in the same namespace
//     void matvec(const MatvecArgs& a, int begin, int end) { HWY_DYNAMIC_DISPATCH(matvecGroups)(a, begin, end); }
//     } // namespace thaw
//     #endif
//
// Rules. Everything between BEFORE and AFTER is plain functions, no lambdas and nothing of <algorithm> in the inner
// loops: they would be compiled for the baseline. Ordinary headers are included above foreach_target.h. Call
// Tasks::forBlocks outside and the dispatched function per block. Lanes never meet but in sumOfLanes, whose order is
// fixed, so results do not depend on workers. Approximate instructions (rsqrt, rcp) differ between makers of
// processors: use Sqrt and Div.

#if defined(THAW_BASE_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef THAW_BASE_SIMD_H
#undef THAW_BASE_SIMD_H
#else
#define THAW_BASE_SIMD_H
#endif

#include "base/types.h"

// Vectors without a size known to the compiler cannot be kept in a struct; those machines run the 128-bit code.
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#endif
#include "hwy/highway.h"

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace thaw {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using TagF32 = hn::CappedTag<float, 8>;
using TagU32 = hn::RebindToUnsigned<TagF32>;
using TagI32 = hn::RebindToSigned<TagF32>;
using F32 = hn::Vec<TagF32>;
using U32 = hn::Vec<TagU32>;
using Mask = hn::Mask<TagF32>;
[[maybe_unused]] constexpr TagF32 kF32{};
[[maybe_unused]] constexpr TagU32 kU32{};
[[maybe_unused]] constexpr TagI32 kI32{};
constexpr int kLanes = static_cast<int>(hn::MaxLanes(TagF32())); // of a group's 8 rows at once
static_assert(kLanes == 8 || kLanes == 4 || kLanes == 1);

// kLanes rows of Vec4, one vector per component.
struct Rows {
    F32 x, y, z, w;
};

HWY_INLINE F32 zero() { return hn::Zero(kF32); }
HWY_INLINE F32 all(float v) { return hn::Set(kF32, v); }
HWY_INLINE F32 load(const float* p) { return hn::LoadU(kF32, p); }
HWY_INLINE void store(F32 v, float* p) { hn::StoreU(v, kF32, p); }
HWY_INLINE F32 dot3(F32 ax, F32 ay, F32 az, F32 bx, F32 by, F32 bz) {
    return hn::MulAdd(ax, bx, hn::MulAdd(ay, by, hn::Mul(az, bz)));
}

#if HWY_TARGET != HWY_SCALAR
// Four rows (two blocks of four with 8 lanes) to columns and back: the transposition is its own inverse.
HWY_INLINE Rows transpose(F32 r0, F32 r1, F32 r2, F32 r3) {
    const hn::RepartitionToWide<TagU32> wide;
    auto t0 = hn::BitCast(wide, hn::InterleaveLower(kF32, r0, r1));
    auto t1 = hn::BitCast(wide, hn::InterleaveUpper(kF32, r0, r1));
    auto t2 = hn::BitCast(wide, hn::InterleaveLower(kF32, r2, r3));
    auto t3 = hn::BitCast(wide, hn::InterleaveUpper(kF32, r2, r3));
    return {hn::BitCast(kF32, hn::InterleaveLower(wide, t0, t2)), hn::BitCast(kF32, hn::InterleaveUpper(wide, t0, t2)),
            hn::BitCast(kF32, hn::InterleaveLower(wide, t1, t3)), hn::BitCast(kF32, hn::InterleaveUpper(wide, t1, t3))};
}

// Row a in the lower block, row b in the upper one; only a with 4 lanes.
HWY_INLINE F32 twoRows(const float* a, [[maybe_unused]] const float* b) {
#if HWY_MAX_BYTES >= 32
    const hn::CappedTag<float, 4> block;
    return hn::Combine(kF32, hn::Load(block, b), hn::Load(block, a));
#else
    return hn::Load(kF32, a);
#endif
}
#endif

// The rows that kLanes list entries (byte offsets 16 j) name.
HWY_INLINE Rows gatherRows(const Vec4* rows, const uint32_t* entries) {
    const char* base = reinterpret_cast<const char*>(rows);
#if HWY_TARGET == HWY_SCALAR
    const Vec4& r = *reinterpret_cast<const Vec4*>(base + entries[0]);
    return {all(r.x), all(r.y), all(r.z), all(r.w)};
#else
    constexpr int up = kLanes == 8 ? 4 : 0;
    const auto at = [&](int k) HWY_ATTR { return reinterpret_cast<const float*>(base + entries[k]); };
    return transpose(twoRows(at(0), at(up)), twoRows(at(1), at(up + 1)), twoRows(at(2), at(up + 2)),
                     twoRows(at(3), at(up + 3)));
#endif
}

// kLanes consecutive rows.
HWY_INLINE Rows loadRows(const Vec4* rows) {
#if HWY_TARGET == HWY_SCALAR
    return {all(rows->x), all(rows->y), all(rows->z), all(rows->w)};
#else
    constexpr int up = kLanes == 8 ? 4 : 0;
    return transpose(twoRows(&rows[0].x, &rows[up].x), twoRows(&rows[1].x, &rows[up + 1].x),
                     twoRows(&rows[2].x, &rows[up + 2].x), twoRows(&rows[3].x, &rows[up + 3].x));
#endif
}

// To kLanes consecutive rows.
HWY_INLINE void storeRows(Vec4* rows, F32 x, F32 y, F32 z, F32 w) {
#if HWY_TARGET == HWY_SCALAR
    *rows = {hn::GetLane(x), hn::GetLane(y), hn::GetLane(z), hn::GetLane(w)};
#else
    const Rows r = transpose(x, y, z, w);
#if HWY_MAX_BYTES >= 32
    const hn::CappedTag<float, 4> block;
    hn::Store(hn::LowerHalf(block, r.x), block, &rows[0].x);
    hn::Store(hn::LowerHalf(block, r.y), block, &rows[1].x);
    hn::Store(hn::LowerHalf(block, r.z), block, &rows[2].x);
    hn::Store(hn::LowerHalf(block, r.w), block, &rows[3].x);
    hn::Store(hn::UpperHalf(block, r.x), block, &rows[4].x);
    hn::Store(hn::UpperHalf(block, r.y), block, &rows[5].x);
    hn::Store(hn::UpperHalf(block, r.z), block, &rows[6].x);
    hn::Store(hn::UpperHalf(block, r.w), block, &rows[7].x);
#else
    hn::Store(r.x, kF32, &rows[0].x);
    hn::Store(r.y, kF32, &rows[1].x);
    hn::Store(r.z, kF32, &rows[2].x);
    hn::Store(r.w, kF32, &rows[3].x);
#endif
#endif
}

// The same, w stays what it was.
HWY_INLINE void storeXyz(Vec4* rows, F32 x, F32 y, F32 z) { storeRows(rows, x, y, z, loadRows(rows).w); }

// a[j] of the rows that kLanes list entries name. Some 1.6 times the price of gatherRows per number: pack what travels
// together into a Vec4. Not the gather instruction on x86: eight loads are 5 % faster in a density pass, and on
// processors with the fix for gather data sampling many times so.
HWY_INLINE F32 gather(const float* a, const uint32_t* entries) {
#if HWY_ARCH_X86 && HWY_MAX_BYTES >= 32
    const auto at = [&](int k) HWY_ATTR { return a[entries[k] >> 4]; };
    return F32{_mm256_setr_ps(at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7))};
#else
    const auto bytes = hn::ShiftRight<2>(hn::LoadU(kU32, entries));
    return hn::GatherOffset(kF32, a, hn::BitCast(kI32, bytes));
#endif
}

// In lane order; double, so that sums over many rows keep their digits.
HWY_INLINE double sumOfLanes(F32 v) {
    alignas(32) float lane[kLanes];
    hn::Store(v, kF32, lane);
    double s = 0;
    for (int k = 0; k < kLanes; ++k) s += static_cast<double>(lane[k]);
    return s;
}
// A bit for each lane, of lane 0 the lowest.
HWY_INLINE unsigned bitsOf(Mask mask) {
    uint8_t bits[8] = {};
    hn::StoreMaskBits(kF32, mask, bits);
    return bits[0];
}
HWY_INLINE float maxOfLanes(F32 v) { return hn::GetLane(hn::MaxOfLanes(kF32, v)); }

} // namespace HWY_NAMESPACE
} // namespace thaw
HWY_AFTER_NAMESPACE();

#endif // per target
