// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/kernel.h"
#include "neighbors/neighbors.h"

namespace thaw {
namespace {

constexpr int kGroupBlock = 32; // 256 rows: some 20 cells, 15-20 us
constexpr int kRowBlock = 512;
constexpr uint32_t kFirstGuess = 48; // entries per row before the first build; the lattice has 32

} // namespace

void Neighbors::build(const Particles& particles, Tasks& tasks) {
    const int n = particles.count;
    groupCount = (n + 7) / 8;
    moverGroups = (particles.moverCount + 7) / 8;
    maxNeighbors = 0, meanNeighbors = 0, clipped = false;
    first.resizeRaw(static_cast<size_t>(groupCount));
    width.resizeRaw(static_cast<size_t>(groupCount));
    if (n == 0) return;

    const size_t stride = (static_cast<size_t>(n) + Particles::kPadding + 15) / 16 * 16;
    soa_.resizeRaw(4 * stride);
    scratch_.resizeRaw(static_cast<size_t>(tasks.workerCount()));
    float *x = soa_.data(), *y = x + stride, *z = y + stride, *h = z + stride;
    const Vec4* position = particles.position.data();
    tasks.forBlocks(n + Particles::kPadding, kRowBlock, [&](int begin, int end, int, int) {
        for (int i = begin; i < end; ++i)
            x[i] = position[i].x, y[i] = position[i].y, z[i] = position[i].z, h[i] = position[i].w;
    });

    // Every block writes into its own part of the array, as large as what it needed last time and an eighth. Those that
    // need more are done again behind the others.
    const int blockCount = Tasks::blockCount(groupCount, kGroupBlock);
    const size_t known = blocks_.size();
    blocks_.resizeRaw(static_cast<size_t>(blockCount));
    for (size_t b = known; b < blocks_.size(); ++b) {
        blocks_[b] = ListBlock{};
        blocks_[b].needed = kGroupBlock * 8 * kFirstGuess;
    }
    size_t total = 0;
    const auto layOut = [&] {
        total = 0;
        for (ListBlock& b : blocks_) {
            b.offset = static_cast<uint32_t>(total);
            b.capacity = b.needed + (b.needed / 64 + 1) * 8 + ListBlock::kSlack;
            total += b.capacity;
        }
    };
    layOut();
    entries.resizeRaw(total);

    ListArgs args{grids_, cellStart_.data(), cellOf_.data(), x,      y, z, h, n, particles.moverCount,
                  0,      nullptr,           nullptr,        nullptr};
    args.support = minSupport_ == maxSupport_ ? maxSupport_ : 0;
    args.entries = entries.data(), args.first = first.data(), args.width = width.data();
    const auto make = [&](int block, int worker) {
        const int begin = block * kGroupBlock, end = std::min(groupCount, begin + kGroupBlock);
        buildLists(args, scratch_[static_cast<size_t>(worker)], begin, end, blocks_[static_cast<size_t>(block)]);
    };
    tasks.forBlocks(blockCount, 1, [&](int, int, int block, int worker) { make(block, worker); });

    redo_.clear();
    for (int b = 0; b < blockCount; ++b) {
        ListBlock& block = blocks_[static_cast<size_t>(b)];
        if (block.fits()) continue;
        redo_.push(b);
        block.offset = static_cast<uint32_t>(total), block.capacity = block.needed;
        total += block.capacity;
    }
    if (!redo_.empty()) {
        entries.resizeRaw(total);
        args.entries = entries.data();
        tasks.forBlocks(static_cast<int>(redo_.size()), 1,
                        [&](int, int, int k, int worker) { make(redo_[static_cast<size_t>(k)], worker); });
    }

    uint64_t sum = 0;
    size_t next = 0;
    for (const ListBlock& b : blocks_) {
        sum += b.neighbors;
        maxNeighbors = std::max(maxNeighbors, static_cast<int>(b.most));
        clipped |= b.clipped;
        next += b.needed + (b.needed / 64 + 1) * 8 + ListBlock::kSlack;
    }
    meanNeighbors = static_cast<float>(static_cast<double>(sum) / n);
    if (next > entries.size()) entries.resizeRaw(next); // now, so that the same again allocates nothing
    gradient.resizeRaw(entries.size());
}

void Neighbors::weigh(const Particles& particles, const float* volume, const float* invDensity, Tasks& tasks) {
    const int n = particles.count;
    const size_t rows = static_cast<size_t>(n) + Particles::kPadding;
    volumeFraction.resizeRaw(rows), gradientSum.resizeRaw(rows);
    for (size_t i = static_cast<size_t>(n); i < rows; ++i) volumeFraction[i] = 0, gradientSum[i] = {};
    if (n == 0) return;

    const bool uniform = minSupport_ == maxSupport_;
    if (uniform) {
        packed_.resizeRaw(rows);
        const Vec4* position = particles.position.data();
        tasks.forBlocks(static_cast<int>(rows), kRowBlock, [&](int begin, int end, int, int) {
            Vec4* packed = packed_.data();
            for (int i = begin; i < end; ++i) packed[i] = {position[i].x, position[i].y, position[i].z, volume[i]};
        });
    }
    WeighArgs args{};
    args.position = particles.position.data(), args.packed = packed_.data();
    args.volume = volume, args.invDensity = invDensity;
    args.support = uniform ? maxSupport_ : 0, args.minSupport = minSupport_;
    args.inverseLatticeSum = 1 / latticeSum();
    args.entries = entries.data(), args.first = first.data(), args.width = width.data();
    args.gradient = gradient.data(), args.volumeFraction = volumeFraction.data();
    args.gradientSum = gradientSum.data(), args.moverGroups = moverGroups;
    tasks.forBlocks(groupCount, kGroupBlock, [&](int begin, int end, int, int) { weighGroups(args, begin, end); });
}

} // namespace thaw
