// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "base/types.h"

#include <cstdint>

namespace thaw {

// Particles as ellipsoids of revolution, for hosts that draw them as splats: balls inside and where one is alone, flat
// where there is a surface (the use of anisotropic kernels, Yu & Turk 2013, from normals that are there already in
// place of a decomposition of covariances). Those of a surface are moved along their normals toward what their
// neighbours that look the same way say, so that beads at outlines go and drips and sheets keep their thickness.
class SplatShapes {
public:
    explicit SplatShapes(Allocator& allocator) : centers(allocator), axes(allocator), entries_(allocator) {}

    struct Input {
        int count;
        const Vec4* positions; // w: support radius h
        const Vec4* normals;   // unit, zero inside
    };
    void make(const Input& input, Tasks& tasks);

    Array<Vec4> centers; // w: half axis along the surface, m
    Array<Vec4> axes;    // unit, out of the surface; w: half axis along it, m

private:
    struct Entry {
        uint64_t key; // of its cell
        uint32_t row;
    };
    void shape(const Input& input, uint32_t row, float inverseCell);

    Array<Entry> entries_; // those of the surface, by cell
};

} // namespace thaw
