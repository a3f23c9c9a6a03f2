// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/kernel.h"
#include "heat/conduction.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "heat/conduction_simd.cpp"
#include "hwy/foreach_target.h"

#include "base/simd.h"

HWY_BEFORE_NAMESPACE();
namespace thaw {
namespace HWY_NAMESPACE {

void conductionGroups(const ConductionPass& a, int begin, int end) {
    const F32 four = all(4.0f), tiny = all(1e-30f);
    for (int g = begin; g < end; ++g)
        for (int part = 0; part < 8; part += kLanes) {
            const uint32_t* entry = a.entries + a.first[g] + part;
            const float* c = a.gradient + a.first[g] + part;
            const Rows own = loadRows(a.state + 8 * g + part);
            const F32 k4 = hn::Mul(four, own.y);
            F32 flow = zero(), weight = zero();
            for (uint32_t n = 0; n < a.width[g]; ++n, entry += 8, c += 8) {
                const Rows other = gatherRows(a.state, entry);
                // No fused operation before the difference: both sides of a pair must round alike.
                const F32 harmonic = hn::Div(hn::Mul(k4, other.y), hn::Add(hn::Add(own.y, other.y), tiny));
                const F32 w = hn::Mul(load(c), hn::Mul(harmonic, hn::Add(own.z, other.z)));
                flow = hn::Add(flow, hn::Mul(w, hn::Sub(own.x, other.x)));
                weight = hn::Sub(weight, w);
            }
            store(flow, a.flow + 8 * g + part);
            if (a.weight) store(weight, a.weight + 8 * g + part);
        }
}

void factorsOfGroup(const ConductionFactors& a, int g) {
    const F32 twice = all(2.0f), tiny = all(1e-30f);
    for (int part = 0; part < 8; part += kLanes) {
        const uint32_t* entry = a.entries + a.first[g] + part;
        const float* c = a.gradient + a.first[g] + part;
        float* out = a.out + a.first[g] + part;
        const Rows i = loadRows(a.position + 8 * g + part), m = loadRows(a.axis + 8 * g + part);
        for (uint32_t k = 0; k < a.width[g]; ++k, entry += 8, c += 8, out += 8) {
            const Rows j = gatherRows(a.position, entry), n = gatherRows(a.axis, entry);
            const F32 dx = hn::Sub(i.x, j.x), dy = hn::Sub(i.y, j.y), dz = hn::Sub(i.z, j.z);
            const F32 r2 = hn::Max(dot3(dx, dy, dz, dx, dy, dz), tiny);
            const F32 own = dot3(dx, dy, dz, m.x, m.y, m.z), its = dot3(dx, dy, dz, n.x, n.y, n.z);
            // Both sides of a pair round alike.
            const F32 one = hn::Add(hn::Abs(m.w), hn::CopySign(hn::Div(hn::Mul(own, own), r2), m.w));
            const F32 two = hn::Add(hn::Abs(n.w), hn::CopySign(hn::Div(hn::Mul(its, its), r2), n.w));
            const F32 squares = hn::Add(hn::Mul(one, one), hn::Mul(two, two));
            store(hn::Mul(load(c), hn::Mul(hn::Mul(one, two), hn::Sqrt(hn::Div(twice, squares)))), out);
        }
    }
}

} // namespace HWY_NAMESPACE
} // namespace thaw
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace thaw {

HWY_EXPORT(conductionGroups);
HWY_EXPORT(factorsOfGroup);

void conductionPass(const ConductionPass& pass, int beginGroup, int endGroup) {
    HWY_DYNAMIC_DISPATCH(conductionGroups)(pass, beginGroup, endGroup);
}

void conductionFactors(const ConductionFactors& factors, int group) {
    HWY_DYNAMIC_DISPATCH(factorsOfGroup)(factors, group);
}

float conductionMoment() {
    static const float moment = [] {
        double sum = 0;
        for (int i = -3; i <= 3; ++i)
            for (int j = -3; j <= 3; ++j)
                for (int k = -3; k <= 3; ++k) {
                    const double q = std::sqrt(i * i + j * j + k * k) / static_cast<double>(kSupport);
                    if (q >= 1) continue;
                    sum += static_cast<double>(kWendlandGradient) * (1 - q) * (1 - q) * (1 - q) * i * i;
                }
        const double h = static_cast<double>(kSupport);
        return static_cast<float>(sum / (h * h * h * h * h * static_cast<double>(latticeSum())));
    }();
    return moment;
}

} // namespace thaw
#endif
