// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/field.h"

#include <algorithm>

namespace thaw {

// Brings particles of the blocks that are stirred to the nodes: amplitudesOf(k, push) calls push(amplitude) for each
// amount that the particle k of the arrays is to bring.
template <class F> void SurfaceField::depositStirred(Array<int32_t>& sums, Tasks& tasks, F&& amplitudesOf) {
    const int pad = DepositTile::padFor(reach_);
    const size_t size = size_t(DepositTile::sizeOf(pad));
    tiles_.resize(size * size_t(tasks.workerCount()));

    // Blocks of a line one after the other, lines so far apart that they write to no node of one another together.
    homes_.clear();
    for (int32_t slot : order_)
        if (blocks_[slot].stirred) homes_.push(slot), blocks_[slot].stirred = false;
    const auto work = [&](int32_t home, DepositTile& tile) {
        const Block& block = blocks_[home];
        const FillBlock place{
            {double(block.x) * kSide, double(block.y) * kSide, double(block.z) * kSide}, 1 / cell_, 1 / unit_};
        constexpr int kTogether = 256;
        int which[kTogether + 2], count = 0;
        float amplitudes[kTogether + 2];
        const size_t bins = size_t(home) * kBlockBins;
        for (int k = binStarts_[bins], end = binStarts_[bins + kBlockBins]; k < end; ++k) {
            amplitudesOf(k, [&](float amplitude) { which[count] = k, amplitudes[count++] = amplitude; });
            if (count < kTogether && k + 1 < end) continue;
            deposit(arrays_, which, amplitudes, count, place, tile);
            count = 0;
        }
        int32_t* around[kNear];
        for (int n = 0; n < kNear; ++n)
            around[n] = block.near[n] < 0 ? nullptr : sums.data() + size_t(block.near[n]) * kNodes;
        addTile(tile, around);
    };
    const int apart = 2 * pad <= kSide ? 2 : 3;
    for (int part = 0; part < apart * apart; ++part) {
        lines_.clear();
        for (size_t k = 0; k < homes_.size(); ++k) {
            const Block& b = blocks_[homes_[k]];
            const auto of = [&](int32_t v) { return (v % apart + apart) % apart; };
            if (of(b.y) + apart * of(b.z) != part) continue;
            if (!lines_.empty()) {
                Line& last = lines_[lines_.size() - 1];
                const Block& before = blocks_[homes_[last.begin]];
                if (before.y == b.y && before.z == b.z) {
                    last.end = int32_t(k + 1);
                    continue;
                }
            }
            lines_.push({int32_t(k), int32_t(k + 1)});
        }
        tasks.forBlocks(int(lines_.size()), 1, [&](int begin, int end, int, int worker) {
            DepositTile tile{tiles_.data() + size_t(worker) * size, pad};
            for (int line = begin; line < end; ++line)
                for (int32_t k = lines_[line].begin; k < lines_[line].end; ++k) work(homes_[k], tile);
        });
    }
}

// Of the particles as they were: those that are gone.
void SurfaceField::takeAway(Tasks& tasks) {
    for (int32_t i : goneRows_) rows_[i].fresh = true, markAround(rows_[i]);
    const auto stir = [&](auto&& which) {
        for (int32_t i : goneRows_) blocks_[rows_[i].home].stirred |= which(rows_[i]);
    };
    stir([](const Row&) { return true; });
    depositStirred(base_, tasks, [&](int k, auto&& push) {
        const Row& row = rows_[sortedRows_[k]];
        if (row.fresh) push(-row.amplitude);
    });
    stir([](const Row& row) { return row.lifted != 0; });
    depositStirred(lift_, tasks, [&](int k, auto&& push) {
        const Row& row = rows_[sortedRows_[k]];
        if (row.fresh && row.lifted != 0) push(-row.lifted);
    });
}

// Of the particles as they are: those that are fresh.
void SurfaceField::bring(Tasks& tasks) {
    for (int32_t i : freshRows_)
        if (rows_[i].home >= 0) blocks_[rows_[i].home].stirred = true;
    depositStirred(base_, tasks, [&](int k, auto&& push) {
        Row& row = rows_[sortedRows_[k]];
        if (row.fresh) push(row.amplitude);
        row.fresh = false;
    });
    depositLarge(base_, arrays_.amplitude + (rows_.size() - large_.size()), tasks);
}

// What lifting adds, where it is not what it was.
void SurfaceField::liftRows(bool patch, Tasks& tasks) {
    for (Row& row : rows_) {
        if (row.excess != row.lifted && row.home >= 0) blocks_[row.home].stirred = true;
        // Counts for another amount in all blocks that it reaches.
        if (row.otherCompany && patch) markAround(row);
        row.otherCompany = false;
    }
    depositStirred(lift_, tasks, [&](int k, auto&& push) {
        Row& row = rows_[sortedRows_[k]];
        if (row.excess == row.lifted) return;
        if (row.lifted != 0) push(-row.lifted);
        if (row.excess != 0) push(row.excess);
        row.lifted = row.excess;
    });
    excessOfLarge_.resizeRaw(large_.size());
    for (size_t n = 0; n < large_.size(); ++n)
        excessOfLarge_[n] = rows_[sortedRows_[rows_.size() - large_.size() + n]].excess;
    depositLarge(lift_, excessOfLarge_.data(), tasks);
}

// There are none but after a rebuild.
void SurfaceField::depositLarge(Array<int32_t>& sums, const float* amplitudes, Tasks& tasks) {
    if (large_.empty()) return;
    forChanged(tasks, [&](int slot) {
        const Block& block = blocks_[slot];
        const FillBlock place{
            {double(block.x) * kSide, double(block.y) * kSide, double(block.z) * kSide}, 1 / cell_, 1 / unit_};
        depositAcross(arrays_, int(rows_.size() - large_.size()), amplitudes, int(large_.size()), place,
                      sums.data() + size_t(slot) * kNodes);
    });
}

void SurfaceField::finishBlock(int slot) {
    Block& block = blocks_[slot];
    block.around = int(large_.size());
    for (int32_t other : block.near)
        if (other >= 0) {
            const size_t bins = size_t(other) * kBlockBins;
            block.around += binStarts_[bins + kBlockBins] - binStarts_[bins];
        }
    const size_t first = size_t(slot) * kNodes;
    markInside(base_.data() + first, lift_.data() + first, int32_t(kIso / unit_),
               inside_.data() + size_t(slot) * kSide * kSide);
}

} // namespace thaw
