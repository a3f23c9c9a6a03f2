// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "bench/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/fma_simd.cpp"
#include "hwy/foreach_target.h"

#include "base/simd.h"

HWY_BEFORE_NAMESPACE();
namespace thaw {
namespace HWY_NAMESPACE {

// Ten chains of 8 lanes: enough to hide a latency of four or five cycles at two a cycle.
float multiplyAdd(int turns) {
    float sum = 0;
    for (int part = 0; part < 8; part += kLanes) {
        const F32 m = all(0.999999f), b = all(1e-7f);
        F32 a0 = m, a1 = b, a2 = m, a3 = b, a4 = m, a5 = b, a6 = m, a7 = b, a8 = m, a9 = b;
        for (int k = 0; k < turns; ++k) {
            a0 = hn::MulAdd(a0, m, b), a1 = hn::MulAdd(a1, m, b), a2 = hn::MulAdd(a2, m, b);
            a3 = hn::MulAdd(a3, m, b), a4 = hn::MulAdd(a4, m, b), a5 = hn::MulAdd(a5, m, b);
            a6 = hn::MulAdd(a6, m, b), a7 = hn::MulAdd(a7, m, b), a8 = hn::MulAdd(a8, m, b);
            a9 = hn::MulAdd(a9, m, b);
        }
        const F32 s = hn::Add(hn::Add(hn::Add(a0, a1), hn::Add(a2, a3)),
                              hn::Add(hn::Add(hn::Add(a4, a5), hn::Add(a6, a7)), hn::Add(a8, a9)));
        sum += static_cast<float>(sumOfLanes(s));
    }
    return sum;
}

const char* targetName() { return hwy::TargetName(HWY_TARGET); }

// y_i = sum_j c_ij ((v_i - v_j) . x_ij) x_ij: what an iteration of the viscosity solve does.
void projectedMatvec(const MatvecArgs& a, int begin, int end) {
    for (int g = begin; g < end; ++g)
        for (int part = 0; part < 8; part += kLanes) {
            const int row = 8 * g + part;
            const uint32_t* entry = a.entries + a.first[g] + part;
            const float* c = a.coefficient + a.first[g] + part;
            const Rows xi = loadRows(a.position + row), vi = loadRows(a.in + row);
            F32 y0 = zero(), y1 = zero(), y2 = zero();
            for (uint32_t k = a.width[g]; k > 0; --k, entry += 8, c += 8) {
                const Rows xj = gatherRows(a.position, entry), vj = gatherRows(a.in, entry);
                const F32 dx = hn::Sub(xi.x, xj.x), dy = hn::Sub(xi.y, xj.y), dz = hn::Sub(xi.z, xj.z);
                const F32 s =
                    hn::Mul(load(c), dot3(hn::Sub(vi.x, vj.x), hn::Sub(vi.y, vj.y), hn::Sub(vi.z, vj.z), dx, dy, dz));
                y0 = hn::MulAdd(s, dx, y0), y1 = hn::MulAdd(s, dy, y1), y2 = hn::MulAdd(s, dz, y2);
            }
            storeRows(a.out + row, y0, y1, y2, zero());
        }
}

} // namespace HWY_NAMESPACE
} // namespace thaw
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace thaw {

HWY_EXPORT(multiplyAdd);
HWY_EXPORT(targetName);
HWY_EXPORT(projectedMatvec);

float benchMultiplyAdd(int turns) { return HWY_DYNAMIC_DISPATCH(multiplyAdd)(turns); }
const char* benchTarget() { return HWY_DYNAMIC_DISPATCH(targetName)(); }
void benchMatvec(const MatvecArgs& a, int begin, int end) { HWY_DYNAMIC_DISPATCH(projectedMatvec)(a, begin, end); }

} // namespace thaw
#endif
