// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/types.h"
#include "neighbors/grid.h"

#include <cstddef>
#include <cstdint>

namespace thaw {

// The vector loops of Neighbors, compiled per instruction set. Each works on a range of groups and may run next to
// others.

// The cells of all classes of support that there are (Neighbors::sort).
struct GridSet {
    static constexpr int kMost = 4;
    int count = 1;
    CellGrid grid[kMost];
    float support[kMost] = {};          // the largest of the class
    uint32_t first[kMost + 1] = {0, 1}; // cell of the class; the last one: of all
    uint32_t cellCount() const { return first[count]; }
    uint32_t offset(int kind, int c) const { return static_cast<uint32_t>(kind) * cellCount() + first[c]; }
};

// What one worker needs while it makes lists: the candidates of one cell, and the eight rows of a group before they are
// interleaved.
struct ListScratch {
    static constexpr int kCandidates = 4096; // of a cell that are copied; more are read where they are
    static constexpr int kStretch = 768;     // candidates tested between two looks at the length of the list
    // kMaxNeighbors, another stretch and what whole vectors write past it. A page and 256 bytes, behind a gap:
    // addresses that agree in their last 12 bits make loads wait for stores, so the rows that are written lie, within a
    // page, behind the candidates that are read (54-70 instead of 55-91 ns a row over four runs on a busy machine).
    static constexpr int kRow = 1088;
    alignas(64) float x[kCandidates + 16], y[kCandidates + 16], z[kCandidates + 16], h[kCandidates + 16];
    alignas(64) uint32_t entry[kCandidates + 16];
    alignas(64) uint32_t gap[320];
    alignas(64) uint32_t row[8][kRow];
};

struct ListArgs {
    const GridSet& grids;
    const uint32_t* cellStart; // 2 cellCount + 1: movers, then fixed
    const uint32_t* cellOf;    // per row
    const float *x, *y, *z, *h;
    int count, moverCount;
    float support; // of all, when they have one; else 0
    uint32_t *entries, *first, *width;
};

struct ListBlock {
    uint32_t offset = 0, capacity = 0; // entries, in and out of the array; kSlack of them are not for use
    static constexpr uint32_t kSlack = 64;
    uint32_t needed = 0;    // with the slack
    uint32_t neighbors = 0; // sum over the rows
    uint32_t most = 0;
    bool clipped = false;
    bool fits() const { return needed <= capacity; }
};

// Groups [begin, end) into their block; when it is too small, nothing of it is to be used but `needed`.
void buildLists(const ListArgs& a, ListScratch& scratch, int begin, int end, ListBlock& block);

struct WeighArgs {
    const Vec4* position;
    const Vec4* packed; // xyz, w volume
    const float *volume, *invDensity;
    float support;    // of all, when they have one; else 0
    float minSupport; // > 0
    float inverseLatticeSum;
    const uint32_t *entries, *first, *width;
    float *gradient, *volumeFraction;
    Vec4* gradientSum;
    int moverGroups; // the others get no sum of squares
};

void weighGroups(const WeighArgs& a, int begin, int end);

} // namespace thaw
