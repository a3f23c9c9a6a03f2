// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "surface/field.h"

namespace thaw {

// The particles that a vertex takes its attributes from, with their shares; unused ones are a copy of the first with
// no share.
struct Origins {
    static constexpr int kMost = 8;
    uint32_t row[kMost];
    float share[kMost]; // sum to 1
};

// Finds the origins of vertices in one box after the other.
class OriginFinder {
public:
    static constexpr int kFloats = 5, kInts = 2; // for each particle around; and room for seven more
    OriginFinder(const SurfaceField& field, float* floats, uint32_t* ints, int stride)
        : field_(field), near_(floats), weights_(floats + 4 * stride), rows_(ints), which_(ints + stride),
          stride_(stride) {}

    // All particles that reach into the box, in cells from the block's first node.
    void look(int slot, const float lower[3], const float upper[3]);
    // Of a point in that box, m, where there is some fill; returns how many there are.
    int find(Vec3 at, Origins& out) const;

private:
    uint32_t deepest(Vec3 at) const;

    const SurfaceField& field_;
    SurfaceField::Runs runs_;
    int slot_ = 0;
    float *near_, *weights_; // x, y, z, 1 / R^2 one after the other
    uint32_t *rows_, *which_;
    int stride_, count_ = 0;
};

} // namespace thaw
