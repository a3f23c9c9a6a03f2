// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/kernel.h"
#include "neighbors/passes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "neighbors/weigh_simd.cpp"
#include "hwy/foreach_target.h"

#include "base/simd.h"

HWY_BEFORE_NAMESPACE();
namespace thaw {
namespace HWY_NAMESPACE {

// With p = 1 - q: W = k / h^3 p^4 (5 - 4 p), W'/r = -k' / h^5 p^3. No division by r, so coincident particles are
// harmless, and dummies (p = 0) contribute nothing.
template <bool kMixed, bool kSquare> void weighRange(const WeighArgs& a, int begin, int end) {
    const float h0 = a.support, s0 = a.inverseLatticeSum;
    const float i3 = kMixed ? 1 : 1 / (h0 * h0 * h0), i5 = kMixed ? 1 : 1 / (h0 * h0 * h0 * h0 * h0);
    const F32 kernel = all(kWendland * i3 * s0), slope = all(-kWendlandGradient * i5 * s0);
    const F32 one = all(1), four = all(4), five = all(5), two = all(2), tiny = all(a.minSupport);
    const F32 inverse0 = all(kMixed ? 0 : 1 / h0);
    for (int g = begin; g < end; ++g)
        for (int part = 0; part < 8; part += kLanes) {
            const int row = 8 * g + part;
            const Rows i = loadRows((kMixed ? a.position : a.packed) + row);
            const uint32_t* entry = a.entries + a.first[g] + part;
            float* out = a.gradient + a.first[g] + part;
            F32 fraction = zero(), x = zero(), y = zero(), z = zero(), square = zero();
            for (uint32_t k = a.width[g]; k > 0; --k, entry += 8, out += 8) {
                const Rows j = gatherRows(kMixed ? a.position : a.packed, entry);
                const F32 dx = hn::Sub(i.x, j.x), dy = hn::Sub(i.y, j.y), dz = hn::Sub(i.z, j.z);
                const F32 r2 = dot3(dx, dy, dz, dx, dy, dz), r = hn::Sqrt(r2);
                const F32 volume = kMixed ? gather(a.volume, entry) : j.w;
                const F32 inverse = kMixed ? hn::Div(two, hn::Max(hn::Add(i.w, j.w), tiny)) : inverse0;
                const F32 p = hn::Max(zero(), hn::NegMulAdd(r, inverse, one));
                const F32 p2 = hn::Mul(p, p);
                F32 w = hn::Mul(hn::Mul(p2, p2), hn::NegMulAdd(four, p, five));
                F32 d = hn::Mul(slope, hn::Mul(p2, p));
                if (kMixed) {
                    const F32 inverse2 = hn::Mul(inverse, inverse), inverse3 = hn::Mul(inverse2, inverse);
                    w = hn::Mul(w, inverse3);
                    d = hn::Mul(d, hn::Mul(inverse2, inverse3));
                }
                const F32 c = hn::Mul(volume, d);
                store(c, out);
                fraction = hn::MulAdd(volume, w, fraction);
                x = hn::MulAdd(c, dx, x);
                y = hn::MulAdd(c, dy, y);
                z = hn::MulAdd(c, dz, z);
                if (kSquare) square = hn::MulAdd(hn::Mul(c, gather(a.invDensity, entry)), hn::Mul(d, r2), square);
            }
            // Its own share: W(0) = k / h^3.
            F32 self = load(a.volume + row);
            if (kMixed) {
                const F32 inverse = hn::Div(one, hn::Max(i.w, tiny));
                self = hn::Mul(self, hn::Mul(inverse, hn::Mul(inverse, inverse)));
            }
            store(hn::Mul(kernel, hn::Add(fraction, self)), a.volumeFraction + row);
            storeRows(a.gradientSum + row, x, y, z, square);
        }
}

void weighAny(const WeighArgs& a, int begin, int end) {
    // The sum of squares, which gathers one more number a pair, is for movers only.
    const int middle = begin > a.moverGroups ? begin : end < a.moverGroups ? end : a.moverGroups;
    if (a.support > 0) {
        weighRange<false, true>(a, begin, middle);
        weighRange<false, false>(a, middle, end);
    } else {
        weighRange<true, true>(a, begin, middle);
        weighRange<true, false>(a, middle, end);
    }
}

} // namespace HWY_NAMESPACE
} // namespace thaw
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace thaw {

HWY_EXPORT(weighAny);

void weighGroups(const WeighArgs& a, int begin, int end) { HWY_DYNAMIC_DISPATCH(weighAny)(a, begin, end); }

} // namespace thaw
#endif
