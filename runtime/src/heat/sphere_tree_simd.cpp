// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "heat/sphere_tree.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "heat/sphere_tree_simd.cpp"
#include "hwy/foreach_target.h"

#include "base/simd.h"

HWY_BEFORE_NAMESPACE();
namespace thaw {
namespace HWY_NAMESPACE {

// No fused operations: the same answers on every machine.
HWY_INLINE F32 dotPlain(F32 ax, F32 ay, F32 az, F32 bx, F32 by, F32 bz) {
    return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
}

struct LaneRay {
    F32 origin[3], direction[3], inverse[3], from, to;
};

// Bit k: the ray passes box k.
HWY_INLINE uint32_t passedBoxes(const BoxNode& n, const LaneRay& r) {
    uint32_t bits = 0;
    for (int part = 0; part < 8; part += kLanes) {
        F32 enter = r.from, leave = r.to;
        for (int a = 0; a < 3; ++a) {
            const F32 u = hn::Mul(hn::Sub(load(n.lower[a] + part), r.origin[a]), r.inverse[a]);
            const F32 v = hn::Mul(hn::Sub(load(n.upper[a] + part), r.origin[a]), r.inverse[a]);
            enter = hn::Max(enter, hn::Min(u, v)), leave = hn::Min(leave, hn::Max(u, v));
        }
        bits |= bitsOf(hn::Le(enter, leave)) << part;
    }
    return bits;
}

HWY_INLINE bool enters(const SphereLeaf& s, const LaneRay& r) {
    uint32_t bits = 0;
    for (int part = 0; part < 8; part += kLanes) {
        const F32 x = hn::Sub(r.origin[0], load(s.x + part)), y = hn::Sub(r.origin[1], load(s.y + part)),
                  z = hn::Sub(r.origin[2], load(s.z + part));
        const F32 b = dotPlain(x, y, z, r.direction[0], r.direction[1], r.direction[2]);
        const F32 disc = hn::Sub(hn::Mul(b, b), hn::Sub(dotPlain(x, y, z, x, y, z), load(s.square + part)));
        const F32 t = hn::Sub(hn::Neg(b), hn::Sqrt(hn::Max(disc, zero())));
        bits |= bitsOf(hn::And(hn::Ge(disc, zero()), hn::And(hn::Gt(t, r.from), hn::Lt(t, r.to))));
    }
    return bits != 0;
}

bool treeBlocks(const SphereTreeView& tree, const SphereRay& ray) {
    const float o[3] = {ray.origin.x, ray.origin.y, ray.origin.z},
                d[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
    LaneRay r;
    for (int a = 0; a < 3; ++a) {
        r.origin[a] = all(o[a]), r.direction[a] = all(d[a]);
        const bool turned = d[a] > 1e-30f || d[a] < -1e-30f;
        r.inverse[a] = all(turned ? 1 / d[a] : 1e30f);
    }
    r.from = all(ray.from), r.to = all(ray.to);
    // Per level what is left of one node.
    int node[16];
    uint32_t left[16];
    int level = tree.levels - 1;
    node[level] = 0, left[level] = passedBoxes(tree.nodes[tree.first[level]], r);
    while (level < tree.levels) {
        if (left[level] == 0) {
            ++level;
            continue;
        }
        uint32_t k = 0;
        while (!(left[level] >> k & 1u)) ++k;
        left[level] &= left[level] - 1;
        const int child = 8 * node[level] + static_cast<int>(k);
        if (level == 0) {
            if (enters(tree.leaves[child], r)) return true;
            continue;
        }
        --level;
        node[level] = child, left[level] = passedBoxes(tree.nodes[tree.first[level] + child], r);
    }
    return false;
}

} // namespace HWY_NAMESPACE
} // namespace thaw
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace thaw {

HWY_EXPORT(treeBlocks);

bool sphereTreeBlocks(const SphereTreeView& tree, const SphereRay& ray) {
    return HWY_DYNAMIC_DISPATCH(treeBlocks)(tree, ray);
}

} // namespace thaw
#endif
