// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/bond_pass.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "motion/bonds_simd.cpp"
#include "hwy/foreach_target.h"

#include "base/simd.h"

HWY_BEFORE_NAMESPACE();
namespace thaw {
namespace HWY_NAMESPACE {

void springGroups(const BondPass& p, int begin, int end) {
    for (int g = begin; g < end; ++g) {
        if (!p.groupOn[g]) continue;
        for (int part = 0; part < 8; part += kLanes) {
            const int row = 8 * g + part;
            const size_t start = p.lists.first[g] + static_cast<size_t>(part);
            const uint32_t* entry = p.lists.entries + start;
            const Rows xi = loadRows(p.position + row), old = loadRows(p.change + row);
            const Rows on = loadRows(p.diagonal + row), off = loadRows(p.cross + row);
            const F32 mass = loadRows(p.trait + row).z;
            F32 fx = zero(), fy = zero(), fz = zero(), dx = on.x, dy = on.y, dz = on.z;
            F32 dxy = off.x, dxz = off.y, dyz = off.z;
            for (uint32_t k = 0; k < p.lists.width[g]; ++k) {
                const F32 stiff = load(p.stiffness + start + 8 * k);
                if (hn::AllFalse(kF32, hn::Gt(stiff, zero()))) continue;
                const Rows xj = gatherRows(p.position, entry + 8 * k);
                const F32 x = hn::Sub(xi.x, xj.x), y = hn::Sub(xi.y, xj.y), z = hn::Sub(xi.z, xj.z);
                const F32 r2 = hn::Max(dot3(x, y, z, x, y, z), all(1e-20f)), r = hn::Sqrt(r2);
                const F32 rest = load(p.rest + start + 8 * k);
                const F32 push = hn::Min(hn::Sub(rest, r), hn::Mul(all(kMostPress), rest));
                const F32 f = hn::Mul(stiff, hn::Div(push, r));
                fx = hn::MulAdd(f, x, fx), fy = hn::MulAdd(f, y, fy), fz = hn::MulAdd(f, z, fz);
                const F32 c = hn::Div(hn::Mul(all(p.dt * p.dt), stiff), r2);
                store(hn::Add(load(p.coefficient + start + 8 * k), c), p.coefficient + start + 8 * k);
                dx = hn::MulAdd(c, hn::Mul(x, x), dx), dy = hn::MulAdd(c, hn::Mul(y, y), dy);
                dz = hn::MulAdd(c, hn::Mul(z, z), dz);
                dxy = hn::MulAdd(c, hn::Mul(x, y), dxy), dxz = hn::MulAdd(c, hn::Mul(x, z), dxz);
                dyz = hn::MulAdd(c, hn::Mul(y, z), dyz);
            }
            const F32 s = hn::IfThenElseZero(hn::Gt(mass, zero()), hn::Div(all(p.dt), mass));
            storeRows(p.change + row, hn::MulAdd(s, fx, old.x), hn::MulAdd(s, fy, old.y), hn::MulAdd(s, fz, old.z),
                      zero());
            storeRows(p.diagonal + row, dx, dy, dz, zero());
            storeRows(p.cross + row, dxy, dxz, dyz, zero());
        }
    }
}

} // namespace HWY_NAMESPACE
} // namespace thaw
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace thaw {
HWY_EXPORT(springGroups);
void pairSprings(const BondPass& p, int begin, int end) { HWY_DYNAMIC_DISPATCH(springGroups)(p, begin, end); }
} // namespace thaw
#endif
