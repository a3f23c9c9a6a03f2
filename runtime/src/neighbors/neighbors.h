// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/tasks.h"
#include "neighbors/grid.h"
#include "neighbors/passes.h"
#include "particles/particles.h"

namespace thaw {

// Neighbour lists of all particles, frozen at the positions of the last build.
//
// SELL-8: a group is 8 consecutive rows, one per SIMD lane. Entry k of lane l of group g is at first[g] + 8 k + l,
// 0 <= k < width[g]. An entry is the byte offset 16 j of neighbour j (so that position, velocity, ... are one aligned
// 16-byte load; a float array is read at offset / 4). Unused entries name the dummy row `count`, with gradient 0. A
// particle is not in its own list. Two particles are neighbours when r < (h_i + h_j) / 2. Entries of a lane are in
// ascending order of j. Rows that are movers come first (Particles); groups [0, moverGroups) cover them, the last one
// may hold fixed rows too.
class Neighbors {
public:
    explicit Neighbors(Allocator& allocator);

    // Sorts the rows: movers first, then by class of support, then by cell, then by the order they had (stable).
    // Permutes every particle field. Classes, when the largest support is at most twice the smallest: one per level
    // (2^(1/3) apart), each with cells of its own width, or fine particles beside coarse ones would test eight times
    // as many candidates. Otherwise all are one class.
    void sort(Particles& particles, Tasks& tasks);
    // Builds the lists from the sorted rows, at the positions of that sort. Grows its own memory when needed.
    void build(const Particles& particles, Tasks& tasks);
    // One pass over all pairs: fills gradient, volumeFraction, gradientSum, stiffnessSum (Wendland C2 at h = (h_i +
    // h_j) / 2, divided by latticeSum()). volume[i] and invDensity[i] (1 / rho for movers, 0 for fixed) come from the
    // caller and are padded like the particle arrays.
    void weigh(const Particles& particles, const float* volume, const float* invDensity, Tasks& tasks);

    int groupCount = 0, moverGroups = 0;
    Array<uint32_t> entries; // see above
    Array<float> gradient;   // per entry: V_j W'(r) / (r s0), <= 0; the gradient of the pair is this times (x_i - x_j)
    Array<uint32_t> first;   // per group; ascending within a block of groups, with gaps between blocks
    Array<uint32_t> width;   // per group
    Array<float> volumeFraction; // per particle: sum of V_j W / s0, itself included; 1 in the interior of the lattice
    Array<Vec4> gradientSum;     // per particle: xyz sum of V_j grad W / s0; w sum of V_j |grad W / s0|^2 invDensity_j,
                                 // 0 for groups without movers: nobody moves by it
    int maxNeighbors = 0;        // of the last build
    float meanNeighbors = 0;
    bool clipped = false; // a row had more neighbours than kMaxNeighbors; the farthest in row order were left out
    static constexpr int kMaxNeighbors = 256;

    // Calls f(j) for every row j whose position may be within `radius` of p (whole cells), in ascending order; the
    // cells are those of the last sort. radius at most the largest support.
    template <class F> void forCandidates(Vec3 p, float radius, F&& f) const {
        forCandidates(0, p, radius, static_cast<F&&>(f));
    }
    // The same for the rows that were fixed at the last sort.
    template <class F> void forFixedCandidates(Vec3 p, float radius, F&& f) const {
        forCandidates(1, p, radius, static_cast<F&&>(f));
    }

private:
    template <class F> void forCandidates(int firstKind, Vec3 p, float radius, F&& f) const;

    struct Bounds {
        Vec4 lower, upper; // w: support
    };
    void layGrid(const Particles& particles, Tasks& tasks);

    GridSet grids_;
    float minSupport_ = 0, maxSupport_ = 0;
    float bound_[GridSet::kMost] = {}; // largest support of each class that could be
    int slot_[GridSet::kMost] = {};    // and where those that are have their grid
    Array<uint32_t> cellStart_;        // by 2 x cell of all classes: movers, then fixed; first row
    Array<uint32_t> cellOf_, keys_;    // per row, class included
    Array<uint32_t> order_;            // per new row, the old one
    Array<Bounds> bounds_;             // per block of rows
    Array<float> soa_;                 // x, y, z, h
    Array<Vec4> packed_;               // xyz, w volume
    Array<ListBlock> blocks_;
    Array<int> redo_;
    Array<ListScratch> scratch_; // per worker
};

template <class F> void Neighbors::forCandidates(int firstKind, Vec3 p, float radius, F&& f) const {
    if (cellStart_.empty()) return;
    const double at[3] = {p.x, p.y, p.z}, way = static_cast<double>(radius);
    const double low[3] = {at[0] - way, at[1] - way, at[2] - way}, high[3] = {at[0] + way, at[1] + way, at[2] + way};
    for (int kind = firstKind; kind < 2; ++kind)
        for (int c = 0; c < grids_.count; ++c) {
            CellGrid::Range ranges[CellGrid::kMaxBoxRanges];
            const int n = grids_.grid[c].boxRanges(cellStart_.data() + grids_.offset(kind, c), low, high, ranges);
            for (int r = 0; r < n; ++r)
                for (uint32_t j = ranges[r].begin; j < ranges[r].end; ++j) f(static_cast<int>(j));
        }
}

// Calls f(j) for the neighbours j of row i in ascending order until it returns false; rows from `count` on are dummies.
template <class F> void forNeighbors(const Neighbors& nb, int i, F&& f) {
    const uint32_t g = static_cast<uint32_t>(i) >> 3, lane = static_cast<uint32_t>(i) & 7;
    const uint32_t* e = nb.entries.data() + nb.first[g] + lane;
    for (uint32_t k = 0; k < nb.width[g]; ++k, e += 8)
        if (!f(*e >> 4)) return;
}

} // namespace thaw
