// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/tasks.h"
#include "neighbors/neighbors.h"
#include "particles/particles.h"

namespace thaw {

struct FeatureFrame {
    Particles& particles;
    const Neighbors& neighbors; // of the rows as they are
    Tasks& tasks;
    float spacing; // m, of level 0
    int rows;      // the first so many are the volume whose features are meant: the movers, or all
};

// Extended local feature size of particles: ELFS(x) is the least |x - y| + LFS(y) over all y of the surface, LFS(y) how
// far y is from the medial axis (Adams et al. 2007; thesis equation 2.1). The medial axis is made of the particles from
// which no neighbour leads deeper, and all distances go from neighbour to neighbour:
//  - depth: half a spacing in the rows that are surface, else the least of depth and way of a neighbour;
//  - above: the greatest depth of a neighbour, by which others see two neighbours far;
//  - medial: about 0 where nobody that near is deeper by kAscent of the way to it, else the least of medial and way of
//    a neighbour;
//  - size: in surface rows, no more than their medial plus twice their depth (to the surface and back); nowhere more
//    than size and way of a neighbour.
// Particles at walls of colliders are not surface: a pool on a floor is as thick as it is deep. The bisector of an edge
// of 47 degrees or more is no medial axis (kAscent is the sine of half of that): a box has small features only where it
// is thin.
class FeatureSize {
public:
    static constexpr float kUnits = 8; // of Feature in a spacing of level 0
    static constexpr uint8_t kFar = 255;

    explicit FeatureSize(Allocator& allocator) : next_(allocator) {}

    // One pass over the rows of one of `turns` parts, all from the values before it: the same bits in any order.
    // Returns how many changed.
    int relax(const FeatureFrame& f, uint32_t turn, uint32_t turns);
    // Passes over all rows until nothing changes, at most `most`.
    void settle(const FeatureFrame& f, int most = 400);

private:
    Array<Feature> next_;
};

} // namespace thaw
