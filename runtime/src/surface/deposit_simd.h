// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "surface/field_simd.h"

#include <cstdint>

namespace thaw {

// Fill at nodes is a sum of whole numbers: it does not depend on the order of particles, so that one that moves can be
// taken away and brought again, and threads may take them as they come. The unit leaves the surface of a full lattice
// within 1e-5 spacings of a float's; where so many particles are in one place that sums might not fit, it is wider
// (SurfaceField::unitFor).
constexpr float kDepositUnit = 1.0f / (1 << 18);

constexpr float kFillUnit = 1.0f / 65536; // of fill at particles

// Where a block of 8^3 nodes is, how wide its cells are, and what it counts in.
struct FillBlock {
    double first[3], perCell; // of the first node, in cells; 1 / m
    float perUnit;            // units in a fill of 1
};

// A block and what its particles reach beyond it, so many nodes on each side along y and z and a whole block along x.
// Rows of x, then y, then z; zero where nothing was brought.
struct DepositTile {
    static constexpr int kRow = 24, kBeyond = 8; // nodes before the block's first
    static int sizeOf(int pad) { return (8 + 2 * pad) * (8 + 2 * pad) * kRow + 2 * kRow; }
    static int padFor(float reach) { return 1 + int(reach + 0.5f); } // of the farthest, in cells, up to 8
    int32_t* nodes;
    int pad;
    int lower[2] = {8, 8}, upper[2] = {-8, -8}; // where something was brought, along y and z
};

// Brings amplitude (1 - r^2 inverse)^3 of particles `which`, whose centres are in the block, to the tile.
void deposit(const FillArrays& from, const int* which, const float* amplitudes, int count, const FillBlock& block,
             DepositTile& tile);

// Adds the tile to the nodes of the blocks around, [dz + 1][dy + 1][dx + 1], null where there is none, and empties it.
void addTile(DepositTile& tile, int32_t* const around[27]);

// Brings `count` particles from `first` on, wherever they are, to the nodes of one block.
void depositAcross(const FillArrays& from, int first, const float* amplitudes, int count, const FillBlock& block,
                   int32_t* nodes);

// For each of the particles `which`: the sum of amplitude (1 - r^2 inverse)^3 over runs [begins, ends), each rounded to
// kFillUnit.
void sumAround(const FillArrays& from, const int* begins, const int* ends, int runs, const int* which, int count,
               int* sums);

// Bit x of byte 8 z + y: whether the sum of both at that node is iso or more; lift may be null.
void markInside(const int32_t* base, const int32_t* lift, int32_t iso, uint8_t* bits);

} // namespace thaw
