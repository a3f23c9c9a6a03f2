// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "base/types.h"

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

// How much of the space around a node is wax, and the wax's properties there, on 8^3 blocks of nodes wherever a
// particle reaches. The grid stands still in the world: node (i, j, k) is at cell * (i, j, k).
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
    enum Channel { kFill, kTemperature, kLiquid, kCompany, kChannels }; // all but kFill are sums weighted by fill

    struct Block {
        int32_t x, y, z;    // first node / 8
        int32_t begin, end; // range of members
        int32_t upper[8];   // block at (+1 if bit 0, +1 if bit 1, +1 if bit 2), -1 where nothing reaches; [0] is itself
    };

    // Share of smoothing for a vertex with this mean company: none for drops and threads, which would shrink (the idea
    // of Loeschner et al. 2023).
    static float mobility(float company);

    explicit SurfaceField(Allocator& allocator);

    // wantedCell in m. A cell finer than the float grid of the positions, or one that needs too many blocks, is made
    // coarser.
    void build(const SurfaceInput& input, float wantedCell, Tasks& tasks);

    double cell() const { return cell_; }
    int blockCount() const { return int(blocks_.size()); }
    const Block& block(int b) const { return blocks_[b]; }
    const int32_t* members(const Block& b) const {
        return members_.data() + b.begin;
    }                                                                    // particles that reach it, ascending
    float radius(int particle) const { return reach_[particle].radius; } // m, of its kernel
    const float* values(int block, Channel channel) const {
        return values_.data() + (size_t(block) * kChannels + channel) * kNodes;
    }

private:
    struct Reach {
        float radius;    // of the kernel, m
        float amplitude; // V W(0), then a V W(0)
        float company;   // fill at the particle before lifting, up to kFullCompany
    };
    struct Candidates;

    bool findBlocks(const SurfaceInput& input);
    int blockOf(uint64_t key);
    void growTable(size_t size);
    void sortBlocks();
    void gather(const Block& block, const SurfaceInput& input, Candidates& out) const;
    void countCompany(int block, const SurfaceInput& input, int worker);
    void splat(int block, const SurfaceInput& input);

    double cell_ = 0;
    int64_t origin_[3] = {}; // block that keys count from
    Array<Reach> reach_;
    Array<Block> blocks_;
    Array<int32_t> members_;
    Array<float> values_;

    Array<uint64_t> keys_, sortedKeys_, tableKeys_;
    Array<int32_t> tableBlocks_, ranks_, pairBlocks_, pairParticles_;
    Array<float> scratch_; // per worker: candidates of a block
    int scratchStride_ = 0;
};

} // namespace thaw
