// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "base/types.h"
#include "surface/deposit_simd.h"
#include "surface/field_simd.h"

#include <algorithm>

namespace thaw {

// What the mesher reads. Several spacings may stand side by side.
struct SurfaceInput {
    int count = 0;
    const Vec4* positions = nullptr;     // xyz, w: support radius h = 2.2 * spacing of that particle
    const float* temperatures = nullptr; // K
    const float* liquidFractions = nullptr;
    const uint8_t* materials = nullptr;
    const uint16_t* bodies = nullptr;
    float spacing = 0; // m, of level 0
};

// How much of the space around a node is wax, on 8^3 blocks of nodes wherever a particle reaches. The grid stands still
// in the world: node (i, j, k) is at cell * (i, j, k). What has not changed since the last time is not computed again,
// and has the bits that it would have if it were.
//
//     fill(x) = sum_i a_i V_i W(|x - x_i|),   W = 315 / (64 pi R^3) (1 - r^2/R^2)^3
//
// The sum counts volume, so it is 1 inside and exactly 1/2 on a flat face half a spacing above the outermost centres,
// for any mixture of spacings and whatever the kernel; a distance to the mean particle (Zhu & Bridson 2005) needs
// another radius for a face than for a drop, and bulges in notches. What volume counting loses are drops, threads and
// sheets, thinner than the kernel: a_i >= 1 lifts particles in proportion to the neighbours they miss.
class SurfaceField {
public:
    static constexpr int kSide = 8, kNodes = kSide * kSide * kSide;
    static constexpr float kIso = 0.5f;
    static constexpr int kAxisBits = 21; // a block is within +-2^20 of the origin
    static constexpr int kNear = 27;     // a block and those around it; (dx, dy, dz) is nearAt(dx, dy, dz)
    static constexpr int nearAt(int dx, int dy, int dz) { return (dz + 1) * 9 + (dy + 1) * 3 + dx + 1; }

    struct Block {
        int32_t x, y, z;          // first node / 8
        int32_t near[kNear] = {}; // slot of each, -1 where nothing reaches
        uint32_t reached = 0;     // bits: which of near its particles may reach
        int32_t around = 0;       // particles that may reach into it
        bool alive = false;       // else the slot is free
        bool changed = false;     // by the last update: its values, or the particles around
        bool stirred = false;     // holds particles that are to be brought or taken away
    };

    // Share of smoothing for a vertex with this mean company: none for drops and threads, which would shrink (the idea
    // of Loeschner et al. 2023).
    static float mobility(float company) {
        constexpr float kNone = 0.45f, kAll = 0.65f;
        return std::clamp((company - kNone) / (kAll - kNone), 0.0f, 1.0f);
    }

    explicit SurfaceField(Allocator& allocator);

    enum class Change { nothing, blocks, everything };
    // wantedCell in m. A cell finer than the float grid of the positions, or one that needs too many blocks, is made
    // coarser. Temperatures and liquid fractions are not looked at. After a throw, clear().
    Change update(const SurfaceInput& input, float wantedCell, Tasks& tasks);
    void clear();

    double cell() const { return cell_; }
    int slotCount() const { return int(blocks_.size()); }
    const Block& block(int slot) const { return blocks_[slot]; }
    const Array<int32_t>& order() const { return order_; } // slots of the blocks, by place
    float value(int slot, int node) const {
        const size_t at = size_t(slot) * kNodes + size_t(node);
        return float(base_[at] + lift_[at]) * unit_;
    }
    // Bits of a block's nodes and of those next door, 9 x 9 x 9: bit x of [z][y].
    struct NodeBits {
        uint16_t rows[kSide + 1][kSide + 1];
    };
    // Which are inside.
    void insideBits(int slot, NodeBits& out) const { gatherBits(inside_, slot, out); }
    // Fill at the particle before lifting, up to kFullCompany.
    float company(uint32_t row) const { return rows_[row].company; }

    // Whether a particle changes the block when it comes or goes.
    bool reaches(uint32_t row, int slot) const;

    // Particles in runs, each of some that lie side by side: all that may reach into the box, in cells from the
    // block's first node, whatever order that is - it depends on their places and rows only.
    struct Runs {
        static constexpr int kMost = 9 * 9 * 3 + 1; // and one for the large ones
        int count = 0, begins[kMost], ends[kMost];
    };
    void runsAround(int slot, const float lower[3], const float upper[3], Runs& out) const;
    FillBox boxOf(int slot, const float lower[3], const float upper[3]) const; // in m
    // f(place in the arrays) for all particles of a block and of those around, and for the large ones.
    template <class F> void forAround(int slot, F&& f) const;
    const FillArrays& arrays() const { return arrays_; }
    const uint32_t* rowsOfArrays() const { return sortedRows_.data(); }
    int rowCount() const { return int(rows_.size()); }
    // Of a particle that is still there: its row now, by the row that it had before the last update.
    bool rowsMoved() const { return !moves_.empty(); }
    uint32_t rowNow(uint32_t before) const { return uint32_t(rowsNow_[before]); }
    int largeCount() const { return int(large_.size()); } // particles in no run; they end the arrays

private:
    static constexpr int kBins = 3, kBlockBins = kBins * kBins * kBins; // of a block, along an axis and in all
    struct Row {
        float inverse;   // 1 / R^2
        float amplitude; // V W(0)
        float excess;    // (a - 1) V W(0)
        float lifted;    // of that, what the nodes have
        float company;
        int32_t home;      // slot of the block that its centre is in; -1: reaches farther than a block, is in no bin
        uint8_t bin;       // of that block
        uint8_t reach;     // bits x-, x+, y-, y+, z-, z+: sides of the block that it may reach over
        bool otherCompany; // than the last time
        bool fresh;        // its nodes do not have it yet, or are to lose it
    };
    struct Kernel {
        float inverse, amplitude, reach; // 1 / R^2, V W(0), R in cells
    };
    struct Move {
        int32_t from, to; // a particle's row the last time and now
    };

    void findFresh(const SurfaceInput& input, int count);
    void findMoves(const SurfaceInput& input);
    void moveRows(int count);
    Kernel kernelOf(float support) const;
    float unitFor(float mostSupport) const;
    bool rebuild(const SurfaceInput& input);
    bool placeRows(const SurfaceInput& input, const int32_t* begin, const int32_t* end);
    int slotAt(int64_t x, int64_t y, int64_t z);
    size_t entryOf(uint64_t key) const;
    void clearTable();
    void growTable(size_t size);
    void dropBlock(int slot);
    bool linkBlocks(const SurfaceInput& input);
    bool reachOfLarge(const SurfaceInput& input);
    void markAround(const Row& row);
    template <class F> void forChanged(Tasks& tasks, F&& f);
    void sortRows(const SurfaceInput& input);
    void mergeRows(const SurfaceInput& input);
    size_t placeOf(const Row& row) const;
    void layArrays(size_t count);
    void layOne(const SurfaceInput& input, size_t place);
    void orderTies(const SurfaceInput& input);
    void countCompany(int slot, const SurfaceInput& input);
    void gatherBits(const Array<uint8_t>& bits, int slot, NodeBits& out) const;
    void markFull(int slot);
    static void setFull(Row& row);
    void countCompanyOfLarge(const SurfaceInput& input);
    void setCompany(Row& row, int sum, Vec3 at, const SurfaceInput& input);
    void takeAway(Tasks& tasks);
    void bring(Tasks& tasks);
    void liftRows(bool patch, Tasks& tasks);
    template <class F> void depositStirred(Array<int32_t>& sums, Tasks& tasks, F&& amplitudesOf);
    void depositLarge(Array<int32_t>& sums, const float* amplitudes, Tasks& tasks);
    void finishBlock(int slot);

    bool valid_ = false;
    double cell_ = 0;
    float asked_ = 0, spacing_ = 0; // the last time
    float reach_ = 0;               // cells, farthest of those that are in bins, ever
    float unit_ = kDepositUnit;     // of base_ and lift_
    int mostInBin_ = 0;

    // The particles of the last time.
    Array<Vec4> positions_;
    Array<uint8_t> materials_;
    Array<uint16_t> bodies_;

    Array<Row> rows_;
    Array<int32_t> freshRows_, goneRows_; // now of what was not there the last time; then of what is not there now
    Array<Move> moves_;                   // what changed its row only
    Array<int32_t> rowsNow_;              // by row of the last time; -1: gone
    Array<Row> movedRows_;
    Array<int32_t> matches_;                   // for finding moves
    Array<int32_t> freshStarts_, sortedFresh_; // as binStarts_ and sortedRows_, of those that are fresh
    Array<int32_t> large_;                     // rows in no bin
    Array<Block> blocks_;
    Array<int32_t> freeSlots_, order_, changedSlots_;
    Array<uint8_t> needed_;
    Array<uint64_t> tableKeys_;
    Array<int32_t> tableSlots_;
    size_t tableUsed_ = 0;
    bool setChanged_ = false;
    int lastSlot_ = -1;
    Array<int32_t> base_, lift_;   // by slot and node, in unit_: fill before lifting, and what that adds
    Array<uint8_t> full_, inside_; // bit x of byte 8 z + y of each slot

    struct Line {
        int32_t begin, end; // of homes_: blocks in a row along x
    };
    Array<int32_t> homes_;
    Array<Line> lines_;
    Array<int32_t> tiles_; // by worker; zeros
    Array<float> excessOfLarge_;

    // Rows by bin, and by place within a bin; large ones last.
    Array<int32_t> binStarts_;
    Array<uint32_t> sortedRows_;
    Array<int32_t> lastStarts_;
    Array<uint32_t> lastSortedRows_;
    Array<float> sorted_, lastSorted_; // the arrays of arrays_, one after the other
    Array<Vec4> places_;               // for sorting what is crowded
    FillArrays arrays_{};
};

template <class F> void SurfaceField::forAround(int slot, F&& f) const {
    for (int32_t other : blocks_[slot].near) {
        if (other < 0) continue;
        const int32_t* starts = binStarts_.data() + size_t(other) * kBlockBins;
        for (int32_t k = starts[0]; k < starts[kBlockBins]; ++k) f(k);
    }
    for (int k = rowCount() - largeCount(); k < rowCount(); ++k) f(k);
}

// f(slot) for all blocks that are marked.
template <class F> void SurfaceField::forChanged(Tasks& tasks, F&& f) {
    changedSlots_.clear();
    for (int32_t slot : order_)
        if (blocks_[slot].changed) changedSlots_.push(slot);
    tasks.forBlocks(int(changedSlots_.size()), 4, [&](int begin, int end, int, int) {
        for (int k = begin; k < end; ++k) f(changedSlots_[k]);
    });
}

} // namespace thaw
