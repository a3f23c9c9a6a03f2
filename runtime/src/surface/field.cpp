// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/field.h"

#include "base/kernel.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace thaw {
namespace {

// Kernel radius in spacings. On a lattice this one puts the face at 0.498..0.506 spacings above the centres, wherever
// on the face one looks; 1.6 gives 0.488..0.545 (the lattice shows), 2.0 gives 0.488..0.505 and swallows more detail.
constexpr float kReach = 1.8f;
// Least kernel radius in cells: below about 1.2 a node can miss every particle of a full lattice.
constexpr float kReachCells = 1.3f;

constexpr double kCoarsen = 1.26; // halves the volume of blocks
constexpr float kPi = 3.14159265f;

struct Extremes {
    float farthest, support; // m: largest coordinate and support
};

// Of what is not negative the bits are in the order of the numbers; whole numbers are compared in vectors.
Extremes extremesOf(const Vec4* positions, int count) {
    int32_t most[4] = {};
    for (int i = 0; i < count; ++i) {
        int32_t bits[4];
        std::memcpy(bits, &positions[i], sizeof bits);
        for (int a = 0; a < 4; ++a) {
            bits[a] &= 0x7fffffff;
            most[a] = bits[a] > most[a] ? bits[a] : most[a];
        }
    }
    Extremes found;
    const int32_t all[2] = {std::max({most[0], most[1], most[2]}), most[3]};
    std::memcpy(&found, all, sizeof found);
    return found;
}

} // namespace

SurfaceField::SurfaceField(Allocator& allocator)
    : positions_(allocator), materials_(allocator), bodies_(allocator), rows_(allocator), freshRows_(allocator),
      goneRows_(allocator), moves_(allocator), rowsNow_(allocator), movedRows_(allocator), matches_(allocator),
      freshStarts_(allocator), sortedFresh_(allocator), large_(allocator), blocks_(allocator), freeSlots_(allocator),
      order_(allocator), changedSlots_(allocator), needed_(allocator), tableKeys_(allocator), tableSlots_(allocator),
      base_(allocator), lift_(allocator), full_(allocator), inside_(allocator), homes_(allocator), lines_(allocator),
      tiles_(allocator), excessOfLarge_(allocator), binStarts_(allocator), sortedRows_(allocator),
      lastStarts_(allocator), lastSortedRows_(allocator), sorted_(allocator), lastSorted_(allocator),
      places_(allocator) {}

void SurfaceField::clear() {
    valid_ = false;
    positions_.clear(), materials_.clear(), bodies_.clear(), rows_.clear(), moves_.clear(), large_.clear();
    blocks_.clear(), freeSlots_.clear(), order_.clear();
    base_.clear(), lift_.clear();
    clearTable();
}

SurfaceField::Change SurfaceField::update(const SurfaceInput& input, float wantedCell, Tasks& tasks) {
    const int count = std::max(input.count, 0);
    const bool comparable = valid_ && asked_ == wantedCell && spacing_ == input.spacing;
    if (comparable) {
        findFresh(input, count);
        if (freshRows_.empty() && goneRows_.empty() && moves_.empty()) return Change::nothing;
    }

    const auto [farthest, mostSupport] = extremesOf(input.positions, count);
    // Positions carry 24 bits: a finer cell has nothing to show, and keys would not hold its blocks.
    const double wanted = std::max(double(wantedCell), std::ldexp(double(farthest), -(kAxisBits + 1)));

    // What most has changed of is cheaper to make anew.
    bool patch = comparable && wanted == cell_ && large_.empty() && count > 0 &&
                 2 * int(std::max(freshRows_.size(), goneRows_.size())) < count;
    valid_ = false;
    if (patch) {
        for (Block& b : blocks_) b.changed = false;
        takeAway(tasks);
        moveRows(count);
        patch = placeRows(input, freshRows_.begin(), freshRows_.end()) && linkBlocks(input);
    }
    if (patch) {
        for (int32_t i : freshRows_) markAround(rows_[i]);
    } else {
        cell_ = wanted;
        while (!rebuild(input)) cell_ *= kCoarsen;
    }
    asked_ = wantedCell, spacing_ = input.spacing;
    if (patch)
        mergeRows(input);
    else
        sortRows(input);
    if (const float unit = unitFor(mostSupport); unit != unit_) {
        if (patch) rebuild(input), sortRows(input);
        unit_ = unit, patch = false;
    }
    bring(tasks);
    forChanged(tasks, [&](int slot) { markFull(slot); });
    forChanged(tasks, [&](int slot) { countCompany(slot, input); });
    countCompanyOfLarge(input);
    liftRows(patch, tasks);
    forChanged(tasks, [&](int slot) { finishBlock(slot); });

    positions_.resizeRaw(count), materials_.resizeRaw(count), bodies_.resizeRaw(count);
    if (count > 0) {
        std::memcpy(positions_.data(), input.positions, size_t(count) * sizeof(Vec4));
        std::memcpy(materials_.data(), input.materials, size_t(count));
        std::memcpy(bodies_.data(), input.bodies, size_t(count) * sizeof(uint16_t));
    }
    valid_ = true;
    return patch ? Change::blocks : Change::everything;
}

// Everything from the start with the cell as it is; false when that takes too many blocks.
bool SurfaceField::rebuild(const SurfaceInput& input) {
    clear();
    const int count = std::max(input.count, 0);
    rows_.resizeRaw(count), freshRows_.resizeRaw(count);
    for (int i = 0; i < count; ++i) freshRows_[i] = i;
    reach_ = 0, unit_ = kDepositUnit;
    return placeRows(input, freshRows_.begin(), freshRows_.end()) && linkBlocks(input);
}

// Where these rows are; false when there are too many blocks, or when one is large and was not foreseen.
bool SurfaceField::placeRows(const SurfaceInput& input, const int32_t* begin, const int32_t* end) {
    const double perBlock = 1 / (cell_ * kSide);
    const bool foreseen = order_.empty();
    // Of particles one after the other most are of one size, and in one block or next door.
    float support = -1;
    Kernel kernel{};
    for (const int32_t* i = begin; i != end; ++i) {
        const Vec4& p = input.positions[*i];
        if (p.w != support) {
            support = p.w;
            kernel = kernelOf(p.w);
            if (kernel.reach <= kSide) reach_ = std::max(reach_, kernel.reach);
        }
        Row& row = rows_[*i];
        row = {};
        row.inverse = kernel.inverse, row.amplitude = kernel.amplitude;
        row.company = -1, row.fresh = true;
        if (kernel.reach > kSide) {
            if (!foreseen) return false;
            row.home = -1;
            large_.push(*i);
            continue;
        }
        const double at[3] = {p.x * perBlock, p.y * perBlock, p.z * perBlock};
        int64_t block[3];
        int bin[3];
        for (int a = 0; a < 3; ++a) {
            block[a] = int64_t(at[a]);
            block[a] -= double(block[a]) > at[a];
            const float local = float((at[a] - double(block[a])) * kSide);
            bin[a] = std::min(int(local * (float(kBins) / kSide)), kBins - 1);
            row.reach |= uint8_t((local - kernel.reach <= 0) << 2 * a | (local + kernel.reach >= kSide) << (2 * a + 1));
        }
        row.bin = uint8_t((bin[2] * kBins + bin[1]) * kBins + bin[0]);
        const bool isLast = lastSlot_ >= 0 && blocks_[lastSlot_].x == block[0] && blocks_[lastSlot_].y == block[1] &&
                            blocks_[lastSlot_].z == block[2];
        row.home = isLast ? lastSlot_ : slotAt(block[0], block[1], block[2]);
        if (row.home < 0) return false;
    }
    return true;
}

SurfaceField::Kernel SurfaceField::kernelOf(float support) const {
    const float spacing = support / kSupport, radius = std::max(kReach * spacing, kReachCells * float(cell_));
    const float ratio = spacing / radius;
    return {1 / (radius * radius), 315 / (64 * kPi) * ratio * ratio * ratio,
            float(double(radius) / cell_ * 1.0001)}; // the margin covers rounding
}

// The finest that sums surely fit in: of all bins that a kernel can touch, each as full as the fullest. Half of the
// numbers are left to what lifting adds, which crowded particles have none of.
float SurfaceField::unitFor(float mostSupport) const {
    constexpr double kMost = double(1 << 30);
    const Kernel kernel = kernelOf(mostSupport);
    const double across = std::floor(2.0 * kernel.reach * kBins / kSide) + 2;
    const double fill =
        kernel.amplitude * (large_.empty() ? across * across * across * mostInBin_ : double(rows_.size()));
    float unit = kDepositUnit;
    while (fill > kMost * double(unit)) unit *= 2;
    return unit;
}

void SurfaceField::runsAround(int slot, const float lower[3], const float upper[3], Runs& out) const {
    constexpr float kPerCell = float(kBins) / kSide;
    int first[3], last[3];
    for (int a = 0; a < 3; ++a) {
        first[a] = std::max(int(std::floor((lower[a] - reach_) * kPerCell)), -kBins);
        last[a] = std::min(int(std::floor((upper[a] + reach_) * kPerCell)), 2 * kBins - 1);
    }
    out.count = 0;
    const Block& block = blocks_[slot];
    const int dxFirst = first[0] < 0       ? -1
                        : first[0] < kBins ? 0
                                           : 1,
              dxLast = last[0] < 0       ? -1
                       : last[0] < kBins ? 0
                                         : 1;
    for (int z = first[2]; z <= last[2]; ++z) {
        const int dz = z < 0 ? -1 : z < kBins ? 0 : 1;
        for (int y = first[1]; y <= last[1]; ++y) {
            const int dy = y < 0 ? -1 : y < kBins ? 0 : 1;
            for (int dx = dxFirst; dx <= dxLast; ++dx) {
                const int from = std::max(first[0], dx * kBins), to = std::min(last[0], dx * kBins + kBins - 1);
                const int32_t other = block.near[nearAt(dx, dy, dz)];
                if (from > to || other < 0) continue;
                const int32_t* starts = binStarts_.data() + size_t(other) * kBlockBins +
                                        ((z - dz * kBins) * kBins + y - dy * kBins) * kBins - dx * kBins;
                if (starts[from] == starts[to + 1]) continue;
                out.begins[out.count] = starts[from], out.ends[out.count++] = starts[to + 1];
            }
        }
    }
}

FillBox SurfaceField::boxOf(int slot, const float lower[3], const float upper[3]) const {
    const Block& block = blocks_[slot];
    const double first[3] = {double(block.x) * kSide, double(block.y) * kSide, double(block.z) * kSide};
    FillBox box;
    for (int a = 0; a < 3; ++a) {
        box.center[a] = float((first[a] + 0.5 * double(lower[a] + upper[a])) * cell_);
        // The margin is for what is on the box's sides.
        box.half[a] = float(0.5 * double(upper[a] - lower[a]) * cell_ * 1.001);
    }
    return box;
}

} // namespace thaw
