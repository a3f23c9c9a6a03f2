// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/kernel.h"
#include "motion/pairs.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "motion/pairs_simd.cpp"
#include "hwy/foreach_target.h"

#include "base/simd.h"

HWY_BEFORE_NAMESPACE();
namespace thaw {
namespace HWY_NAMESPACE {

// What the pair loops begin with: where the entries of kLanes rows are.
struct Span {
    const uint32_t* entry;
    uint32_t start, width;
    int row;
};
HWY_INLINE Span spanOf(const PairLists& lists, int group, int part) {
    const uint32_t start = lists.first[group] + static_cast<uint32_t>(part);
    return {lists.entries + start, start, lists.width[group], 8 * group + part};
}

template <bool kCohesive, bool kSeries> HWY_INLINE void forceRows(const ForcePass& p, const Span& s, float weight) {
    const Rows xi = loadRows(p.position + s.row), ti = loadRows(p.trait + s.row);
    const F32 half = all(0.5f);
    const F32 scale = hn::Mul(all(-weight), load(p.volume + s.row));
    const F32 oi = kSeries ? load(p.own + s.row) : zero();
    F32 px = zero(), py = zero(), pz = zero(), cx = zero(), cy = zero(), cz = zero();
    F32 dx = zero(), dy = zero(), dz = zero(), dxy = zero(), dxz = zero(), dyz = zero();
    for (uint32_t k = 0; k < s.width; ++k) {
        const Rows xj = gatherRows(p.position, s.entry + 8 * k), tj = gatherRows(p.trait, s.entry + 8 * k);
        const F32 g = load(p.lists.gradient + s.start + 8 * k);
        const F32 x = hn::Sub(xi.x, xj.x), y = hn::Sub(xi.y, xj.y), z = hn::Sub(xi.z, xj.z);
        const F32 r2 = dot3(x, y, z, x, y, z), h = hn::Mul(half, hn::Add(xi.w, xj.w)), h2 = hn::Mul(h, h);
        const Mask fixed = hn::Lt(tj.x, zero());

        const F32 pressure = hn::Mul(hn::Add(ti.w, tj.w), g);
        px = hn::MulAdd(pressure, x, px), py = hn::MulAdd(pressure, y, py), pz = hn::MulAdd(pressure, z, pz);

        // Weiler et al. 2018, projected form; the mean of the two viscosities keeps it symmetric.
        F32 mu = hn::IfThenElse(fixed, hn::Neg(hn::Mul(ti.x, tj.x)), hn::Mul(half, hn::Add(ti.x, tj.x)));
        if (kSeries) {
            const F32 oj = gather(p.own, s.entry + 8 * k), both = hn::Max(hn::Add(oi, oj), all(1e-30f));
            const F32 apart = hn::Sub(oi, oj), less = hn::Div(hn::Mul(apart, apart), both);
            mu = hn::IfThenElse(fixed, mu, hn::NegMulAdd(half, less, mu));
        }
        const F32 c = hn::Div(hn::Mul(hn::Mul(scale, mu), g), hn::MulAdd(all(0.01f), h2, r2));
        store(c, p.coefficient + s.start + 8 * k);
        const F32 alongX = hn::Mul(c, x), alongY = hn::Mul(c, y);
        dx = hn::MulAdd(alongX, x, dx), dy = hn::MulAdd(alongY, y, dy), dz = hn::MulAdd(c, hn::Mul(z, z), dz);
        dxy = hn::MulAdd(alongX, y, dxy), dxz = hn::MulAdd(alongX, z, dxz), dyz = hn::MulAdd(alongY, z, dyz);

        if (kCohesive) {
            // None up to one spacing, none at the support, largest (1) between.
            const F32 r = hn::Sqrt(r2), d = hn::Mul(all(1 / kSupport), h);
            const Mask between = hn::And(hn::Lt(d, r), hn::Lt(r, h));
            const F32 both = hn::Mul(ti.z, tj.z);
            const F32 mass = hn::IfThenElse(fixed, ti.z, hn::Add(both, both));
            const F32 sum = hn::IfThenElse(fixed, all(1), hn::Add(ti.z, tj.z));
            const F32 shape = hn::Mul(hn::Mul(hn::Sub(r, d), hn::Sub(h, r)), all(-0.5f * kCohesionPeak));
            const F32 top = hn::Mul(hn::Mul(shape, mass), hn::Add(ti.y, tj.y));
            const F32 f = hn::IfThenElseZero(between, hn::Div(top, hn::Mul(hn::Mul(h2, r), sum)));
            cx = hn::MulAdd(f, x, cx), cy = hn::MulAdd(f, y, cy), cz = hn::MulAdd(f, z, cz);
        }
    }
    const F32 byDensity = hn::Mul(all(-p.dt), load(p.invDensity + s.row));
    px = hn::Mul(byDensity, px), py = hn::Mul(byDensity, py), pz = hn::Mul(byDensity, pz);
    if (kCohesive) {
        const F32 byMass = hn::IfThenElseZero(hn::Gt(ti.z, zero()), hn::Div(all(p.dt), ti.z));
        px = hn::MulAdd(byMass, cx, px), py = hn::MulAdd(byMass, cy, py), pz = hn::MulAdd(byMass, cz, pz);
    }
    storeRows(p.change + s.row, px, py, pz, zero());
    storeRows(p.diagonal + s.row, dx, dy, dz, zero());
    storeRows(p.cross + s.row, dxy, dxz, dyz, zero());
}

void forceGroups(const ForcePass& p, int begin, int end) {
    const float weight = 10 * latticeSum() * p.dt;
    for (int g = begin; g < end; ++g)
        for (int part = 0; part < 8; part += kLanes) {
            const Span s = spanOf(p.lists, g, part);
            if (p.own)
                p.cohesive ? forceRows<true, true>(p, s, weight) : forceRows<false, true>(p, s, weight);
            else
                p.cohesive ? forceRows<true, false>(p, s, weight) : forceRows<false, false>(p, s, weight);
        }
}

void viscousGroups(const ViscousPass& p, int begin, int end) {
    for (int g = begin; g < end; ++g)
        for (int part = 0; part < 8; part += kLanes) {
            const Span s = spanOf(p.lists, g, part);
            const Rows xi = loadRows(p.position + s.row), vi = loadRows(p.velocity + s.row);
            const F32 mass = loadRows(p.trait + s.row).z;
            F32 ox = hn::Mul(mass, vi.x), oy = hn::Mul(mass, vi.y), oz = hn::Mul(mass, vi.z);
            for (uint32_t k = 0; k < s.width; ++k) {
                const Rows xj = gatherRows(p.position, s.entry + 8 * k), vj = gatherRows(p.velocity, s.entry + 8 * k);
                const F32 x = hn::Sub(xi.x, xj.x), y = hn::Sub(xi.y, xj.y), z = hn::Sub(xi.z, xj.z);
                const F32 along = dot3(hn::Sub(vi.x, vj.x), hn::Sub(vi.y, vj.y), hn::Sub(vi.z, vj.z), x, y, z);
                const F32 f = hn::Mul(load(p.coefficient + s.start + 8 * k), along);
                ox = hn::MulAdd(f, x, ox), oy = hn::MulAdd(f, y, oy), oz = hn::MulAdd(f, z, oz);
            }
            storeRows(p.out + s.row, ox, oy, oz, zero());
        }
}

void strainGroups(const StrainPass& p, int begin, int end) {
    for (int g = begin; g < end; ++g)
        for (int part = 0; part < 8; part += kLanes) {
            const Span s = spanOf(p.lists, g, part);
            const Rows xi = loadRows(p.position + s.row), vi = loadRows(p.velocity + s.row);
            F32 rate = zero(), share = zero();
            for (uint32_t k = 0; k < s.width; ++k) {
                const Rows xj = gatherRows(p.position, s.entry + 8 * k), vj = gatherRows(p.velocity, s.entry + 8 * k);
                const F32 x = hn::Sub(xi.x, xj.x), y = hn::Sub(xi.y, xj.y), z = hn::Sub(xi.z, xj.z);
                const F32 r2 = dot3(x, y, z, x, y, z), h = hn::Add(xi.w, xj.w);
                const F32 along = dot3(hn::Sub(vi.x, vj.x), hn::Sub(vi.y, vj.y), hn::Sub(vi.z, vj.z), x, y, z);
                const F32 least = hn::Mul(all(0.25f * 0.01f), hn::Mul(h, h));
                const F32 w = hn::Div(load(p.lists.gradient + s.start + 8 * k), hn::Add(r2, least));
                rate = hn::NegMulAdd(hn::Mul(w, along), along, rate);
                share = hn::NegMulAdd(hn::Mul(w, r2), r2, share);
            }
            storeRows(p.out + s.row, rate, share, zero(), zero());
        }
}

void jacobiGroups(const JacobiPass& p, int begin, int end) {
    for (int g = begin; g < end; ++g)
        for (int part = 0; part < 8; part += kLanes) {
            const Span s = spanOf(p.lists, g, part);
            const Rows xi = loadRows(p.position + s.row), vi = loadRows(p.velocity + s.row);
            const Rows wall = loadRows(p.wall + s.row);
            F32 sum = dot3(wall.x, wall.y, wall.z, vi.x, vi.y, vi.z);
            for (uint32_t k = 0; k < s.width; ++k) {
                const Rows xj = gatherRows(p.position, s.entry + 8 * k), vj = gatherRows(p.velocity, s.entry + 8 * k);
                const F32 along = dot3(hn::Sub(vi.x, vj.x), hn::Sub(vi.y, vj.y), hn::Sub(vi.z, vj.z),
                                       hn::Sub(xi.x, xj.x), hn::Sub(xi.y, xj.y), hn::Sub(xi.z, xj.z));
                sum = hn::MulAdd(load(p.lists.gradient + s.start + 8 * k), along, sum);
            }
            const F32 fed = hn::Mul(wall.w, hn::IfThenElse(hn::Gt(wall.w, zero()), all(p.feedback), all(1)));
            F32 error = hn::MulAdd(all(p.dt), sum, fed);
            if (p.change) error = hn::Add(error, load(p.change + s.row));
            const F32 old = load(p.pressure + s.row);
            F32 next = hn::MulAdd(hn::Mul(all(p.weight), error), load(p.stiffness + s.row), old);
            next = hn::Max(zero(), next);
            next = hn::IfThenElse(hn::Gt(load(p.invDensity + s.row), zero()), next, old);
            store(next, p.pressure + s.row);
            storeRows(p.point + s.row, xi.x, xi.y, xi.z, hn::Sub(next, old));
        }
}

void pushGroups(const PushPass& p, int begin, int end) {
    for (int g = begin; g < end; ++g)
        for (int part = 0; part < 8; part += kLanes) {
            const Span s = spanOf(p.lists, g, part);
            const Rows xi = loadRows(p.point + s.row), wall = loadRows(p.wall + s.row);
            F32 ox = hn::Mul(xi.w, wall.x), oy = hn::Mul(xi.w, wall.y), oz = hn::Mul(xi.w, wall.z);
            for (uint32_t k = 0; k < s.width; ++k) {
                const Rows xj = gatherRows(p.point, s.entry + 8 * k);
                const F32 f = hn::Mul(hn::Add(xi.w, xj.w), load(p.lists.gradient + s.start + 8 * k));
                ox = hn::MulAdd(f, hn::Sub(xi.x, xj.x), ox), oy = hn::MulAdd(f, hn::Sub(xi.y, xj.y), oy);
                oz = hn::MulAdd(f, hn::Sub(xi.z, xj.z), oz);
            }
            const F32 scale = hn::Mul(all(-p.dt), load(p.invDensity + s.row));
            const Rows v = loadRows(p.velocity + s.row);
            storeRows(p.velocity + s.row, hn::MulAdd(scale, ox, v.x), hn::MulAdd(scale, oy, v.y),
                      hn::MulAdd(scale, oz, v.z), v.w);
        }
}

void heldGroups(const HeldPass& p, int begin, int end) {
    const U32 lastMover = hn::Set(kU32, 16 * static_cast<uint32_t>(p.moverCount - 1));
    const F32 one = all(1), half = all(0.5f);
    for (int g = begin; g < end; ++g)
        for (int part = 0; part < 8; part += kLanes) {
            const Span s = spanOf(p.lists, g, part);
            const Rows xi = loadRows(p.position + s.row);
            F32 ox = zero(), oy = zero(), oz = zero(), filled = zero();
            // Fixed rows come after the movers and entries ascend: from the back, as long as there are any.
            for (uint32_t k = s.width; k-- > 0;) {
                const Mask fixed = hn::RebindMask(kF32, hn::Gt(hn::LoadU(kU32, s.entry + 8 * k), lastMover));
                if (hn::AllFalse(kF32, fixed)) break;
                const Rows xj = gatherRows(p.position, s.entry + 8 * k);
                const F32 x = hn::Sub(xi.x, xj.x), y = hn::Sub(xi.y, xj.y), z = hn::Sub(xi.z, xj.z);
                const F32 r2 = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
                const F32 h = hn::Mul(half, hn::Add(xi.w, xj.w)), q = hn::Div(hn::Sqrt(r2), h);
                const F32 a = hn::Max(zero(), hn::Sub(one, q)), a2 = hn::Mul(a, a);
                const F32 peak =
                    hn::Div(hn::Mul(gather(p.volume, s.entry + 8 * k), all(kWendland)), hn::Mul(hn::Mul(h, h), h));
                const F32 w = hn::Mul(hn::Mul(hn::Mul(peak, a2), a2), hn::Add(one, hn::Mul(all(4), q)));
                filled = hn::Add(filled, hn::IfThenElseZero(fixed, w));
                const F32 c = hn::IfThenElseZero(fixed, load(p.lists.gradient + s.start + 8 * k));
                ox = hn::Add(ox, hn::Mul(c, x)), oy = hn::Add(oy, hn::Mul(c, y)), oz = hn::Add(oz, hn::Mul(c, z));
            }
            storeRows(p.out + s.row, ox, oy, oz, hn::Div(filled, all(latticeSum())));
        }
}

Dots advanceRows(float along, const Vec4* direction, Vec4* image, const Vec4* inverse, const Vec4* cross,
                 Vec4* velocity, Vec4* residual, int begin, int end) {
    const F32 a = all(along);
    F32 rz = zero(), rr = zero();
    for (int k = begin; k < end; k += kLanes) {
        const Rows d = loadRows(direction + k), v = loadRows(velocity + k);
        storeRows(velocity + k, hn::MulAdd(a, d.x, v.x), hn::MulAdd(a, d.y, v.y), hn::MulAdd(a, d.z, v.z), v.w);
        const Rows q = loadRows(image + k), r = loadRows(residual + k);
        const F32 x = hn::NegMulAdd(a, q.x, r.x), y = hn::NegMulAdd(a, q.y, r.y), z = hn::NegMulAdd(a, q.z, r.z);
        storeRows(residual + k, x, y, z, zero());
        const Rows m = loadRows(inverse + k), c = loadRows(cross + k);
        const F32 zx = dot3(m.x, c.x, c.y, x, y, z), zy = dot3(c.x, m.y, c.z, x, y, z),
                  zz = dot3(c.y, c.z, m.z, x, y, z);
        storeRows(image + k, zx, zy, zz, zero());
        rr = hn::Add(rr, dot3(x, y, z, x, y, z)), rz = hn::Add(rz, dot3(x, y, z, zx, zy, zz));
    }
    return {sumOfLanes(rz), sumOfLanes(rr)};
}

void turnRows(float keep, const float* z, float* direction, int begin, int end) {
    for (int k = begin; k < end; k += kLanes)
        store(hn::MulAdd(all(keep), load(direction + k), load(z + k)), direction + k);
}

double innerRows(const float* a, const float* b, int begin, int end) {
    F32 sum = zero();
    for (int k = begin; k < end; k += kLanes) sum = hn::MulAdd(load(a + k), load(b + k), sum);
    return sumOfLanes(sum);
}

void separationGroups(const SeparationPass& p, int begin, int end) {
    // Measured: moving more than 0.3 of that distance at once, or all of the overlap, throws neighbours.
    constexpr float kStep = 0.3f, kRelax = 0.7f;
    for (int g = begin; g < end; ++g)
        for (int part = 0; part < 8; part += kLanes) {
            const Span s = spanOf(p.lists, g, part);
            const Rows xi = loadRows(p.position + s.row);
            const F32 hi = hn::Abs(xi.w);
            const U32 own = hn::Iota(kU32, static_cast<uint32_t>(s.row));
            F32 ox = zero(), oy = zero(), oz = zero();
            for (uint32_t k = 0; k < s.width; ++k) {
                const Rows xj = gatherRows(p.position, s.entry + 8 * k);
                F32 x = hn::Sub(xi.x, xj.x), y = hn::Sub(xi.y, xj.y), z = hn::Sub(xi.z, xj.z);
                const F32 r2 = dot3(x, y, z, x, y, z);
                const Mask held = hn::Lt(xj.w, zero());
                const F32 scale = hn::IfThenElse(held, all(0.5f * kNearHeld / kSupport), all(0.5f * kNear / kSupport));
                const F32 d = hn::Mul(scale, hn::Add(hi, hn::Abs(xj.w)));
                const Mask close = hn::Lt(r2, hn::Mul(d, d));
                if (hn::AllFalse(kF32, close)) continue;
                // Of two in one place the one that comes first goes to the right.
                const F32 least = hn::Mul(all(1e-3f), d);
                const Mask same = hn::Lt(r2, hn::Mul(least, least));
                const U32 other = hn::ShiftRight<4>(hn::LoadU(kU32, s.entry + 8 * k));
                const Mask before = hn::RebindMask(kF32, hn::Lt(own, other));
                x = hn::IfThenElse(same, hn::IfThenElse(before, least, hn::Neg(least)), x);
                y = hn::IfThenZeroElse(same, y), z = hn::IfThenZeroElse(same, z);
                const F32 r = hn::IfThenElse(same, least, hn::Sqrt(r2));
                const F32 share = hn::IfThenElse(held, all(kRelax), all(0.5f * kRelax));
                const F32 step = hn::Mul(share, hn::Min(hn::Sub(d, r), hn::Mul(all(kStep), d)));
                const F32 f = hn::IfThenElseZero(close, hn::Div(step, r));
                ox = hn::MulAdd(f, x, ox), oy = hn::MulAdd(f, y, oy), oz = hn::MulAdd(f, z, oz);
            }
            storeRows(p.out + s.row, ox, oy, oz, zero());
        }
}

} // namespace HWY_NAMESPACE
} // namespace thaw
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace thaw {
HWY_EXPORT(forceGroups);
HWY_EXPORT(viscousGroups);
HWY_EXPORT(strainGroups);
HWY_EXPORT(jacobiGroups);
HWY_EXPORT(pushGroups);
HWY_EXPORT(heldGroups);
HWY_EXPORT(separationGroups);
HWY_EXPORT(advanceRows);
HWY_EXPORT(turnRows);
HWY_EXPORT(innerRows);
void pairForces(const ForcePass& p, int begin, int end) { HWY_DYNAMIC_DISPATCH(forceGroups)(p, begin, end); }
void pairViscosity(const ViscousPass& p, int begin, int end) { HWY_DYNAMIC_DISPATCH(viscousGroups)(p, begin, end); }
void pairStrain(const StrainPass& p, int begin, int end) { HWY_DYNAMIC_DISPATCH(strainGroups)(p, begin, end); }
void pairJacobi(const JacobiPass& p, int begin, int end) { HWY_DYNAMIC_DISPATCH(jacobiGroups)(p, begin, end); }
void pairPush(const PushPass& p, int begin, int end) { HWY_DYNAMIC_DISPATCH(pushGroups)(p, begin, end); }
void pairHeld(const HeldPass& p, int begin, int end) { HWY_DYNAMIC_DISPATCH(heldGroups)(p, begin, end); }
void pairSeparation(const SeparationPass& p, int begin, int end) {
    HWY_DYNAMIC_DISPATCH(separationGroups)(p, begin, end);
}
Dots advance(float along, const Vec4* direction, Vec4* image, const Vec4* inverse, const Vec4* cross, Vec4* velocity,
             Vec4* residual, int begin, int end) {
    return HWY_DYNAMIC_DISPATCH(advanceRows)(along, direction, image, inverse, cross, velocity, residual, begin, end);
}
void turn(float keep, const Vec4* z, Vec4* direction, int begin, int end) {
    HWY_DYNAMIC_DISPATCH(turnRows)(keep, &z->x, &direction->x, 4 * begin, 4 * end);
}
double innerProduct(const Vec4* a, const Vec4* b, int begin, int end) {
    return HWY_DYNAMIC_DISPATCH(innerRows)(&a->x, &b->x, 4 * begin, 4 * end);
}
} // namespace thaw
#endif
