// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/types.h"

#include <cstdint>

namespace thaw {

// A ray as it is tried against spheres: only entering one counts, between from and to.
struct SphereRay {
    Vec3 origin, direction; // direction: unit
    float from, to;         // m
};

// Eight spheres, and eight boxes, side by side.
struct SphereLeaf {
    float x[8], y[8], z[8], square[8]; // of the radius
};
struct BoxNode {
    float lower[3][8], upper[3][8];
};

// Who of many spheres is in the way of a ray: eight to a leaf along a Z curve, eight leaves or nodes to a node, built
// anew each time in 50 us for 2,300 spheres. The same answers as trying every sphere. Embree's spheres of the user's
// own, refitted, take four times as long for a ray through a surface that comes and goes (1.0 us against 0.25), and
// built anew 1.4 ms.
class SphereTree {
public:
    explicit SphereTree(Allocator& a) : keys_(a), keysBack_(a), leaves_(a), nodes_(a) {}

    // While there are at most so many, build() does not allocate.
    void reserve(int most);
    void build(const Vec4* spheres, int count); // w is the radius
    // May be called from several threads at once.
    bool blocks(const SphereRay& ray) const;

private:
    struct Key {
        uint32_t along;
        int index;
    };
    void sort(const Vec4* spheres, int count);

    Array<Key> keys_, keysBack_;
    Array<SphereLeaf> leaves_;
    Array<BoxNode> nodes_; // level by level, that over the leaves first
    static constexpr int kMostLevels = 11;
    int first_[kMostLevels + 1] = {}, levels_ = 0;
};

// levels >= 1: where each begins in nodes; the last has one node.
struct SphereTreeView {
    const SphereLeaf* leaves;
    const BoxNode* nodes;
    const int* first;
    int levels;
};
bool sphereTreeBlocks(const SphereTreeView& tree, const SphereRay& ray);

} // namespace thaw
