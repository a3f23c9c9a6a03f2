// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/field.h"

#include "surface/field_simd.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

constexpr float kSupport = 2.2f; // h / spacing of the input

// Kernel radius in spacings. On a lattice this one puts the face at 0.498..0.506 spacings above the centres, wherever
// on the face one looks; 1.6 gives 0.488..0.545 (the lattice shows), 2.0 gives 0.488..0.505 and swallows more detail.
constexpr float kReach = 1.8f;
// Least kernel radius in cells: below about 1.2 a node can miss every particle of a full lattice.
constexpr float kReachCells = 1.3f;

// Fill at a particle (its own share included) from which it is not lifted. On a lattice: bulk 0.98, face 0.83, edge
// 0.70, one-particle sheet 0.68, corner 0.58, thread 0.45, pair 0.36, alone 0.27.
constexpr float kFullCompany = 0.83f;
// Most that is made up for: a particle alone. On cells so coarse that the kernel is widened there would be no end to
// it.
constexpr float kMaxMissing = 3.1f;

constexpr int kMaxBlocks = 1 << 17; // 1 GiB of values; the cell grows beyond
constexpr double kCoarsen = 1.26;   // halves the volume of blocks
constexpr int kAxisBits = 21;       // of a key
constexpr int kMaxBins = 8;         // along an axis, for the candidates of a block
constexpr int kPad = 8;             // lanes that may be read past the candidates
constexpr uint64_t kNoKey = ~uint64_t(0);
constexpr float kPi = 3.14159265f;

int64_t floorToInt(double v) { return int64_t(std::floor(v)); }

// How much a particle counts for what it misses. The second factor is fitted to the volume of the mesh, since marching
// cubes cut the corners off what is a few cells thick. Mesh volume over particle volume, mean over positions and
// directions, at cells of 0.25 / 0.5 / 0.75 / 1 spacing (tests/unit/surface_volume.cpp prints them): alone 0.85 / 0.95
// / 1.04 / 1.07, four 0.82 / 0.76 / 0.64 / 0.46, thread 1.15 / 1.13 / 1.08 / 0.97, sheet 1.19 at all.
float lift(float company, float cellPerRadius) {
    float missing = std::clamp(kFullCompany / company, 1.0f, kMaxMissing);
    return missing * (1 + (0.9f * cellPerRadius * cellPerRadius - 0.08f) * (missing - 1));
}

uint64_t hashKey(uint64_t key) {
    key *= 0x9E3779B97F4A7C15u;
    return key ^ (key >> 32);
}

} // namespace

// Particles near a block in cells from its first node, as arrays for the lanes.
struct SurfaceField::Candidates {
    float *x, *y, *z, *inverse, *amplitude; // inverse: 1 / radius^2
    float maxRadius = 0;
    int count = 0;

    static constexpr int kArrays = 5;
    Candidates(float* memory, int stride)
        : x(memory), y(x + stride), z(y + stride), inverse(z + stride), amplitude(inverse + stride) {}
};

float SurfaceField::mobility(float company) {
    constexpr float kNone = 0.45f, kAll = 0.65f;
    return std::clamp((company - kNone) / (kAll - kNone), 0.0f, 1.0f);
}

SurfaceField::SurfaceField(Allocator& allocator)
    : reach_(allocator), blocks_(allocator), members_(allocator), values_(allocator), keys_(allocator),
      sortedKeys_(allocator), tableKeys_(allocator), tableBlocks_(allocator), ranks_(allocator), pairBlocks_(allocator),
      pairParticles_(allocator), scratch_(allocator) {}

void SurfaceField::build(const SurfaceInput& input, float wantedCell, Tasks& tasks) {
    blocks_.clear();
    if (input.count <= 0) return;

    float farthest = 0;
    for (int i = 0; i < input.count; ++i) {
        const Vec4& p = input.positions[i];
        farthest = std::max({farthest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    }
    // Positions carry 24 bits: a finer cell has nothing to show, and keys would not hold its blocks.
    cell_ = std::max(double(wantedCell), std::ldexp(double(farthest), -(kAxisBits + 1)));
    while (!findBlocks(input)) cell_ *= kCoarsen;
    sortBlocks();

    scratchStride_ = kPad;
    for (const Block& b : blocks_) scratchStride_ = std::max(scratchStride_, b.end - b.begin + kPad);
    scratch_.resizeRaw(size_t(tasks.workerCount()) * 2 * Candidates::kArrays * scratchStride_);
    values_.resizeRaw(blocks_.size() * kChannels * kNodes);

    int count = blockCount();
    tasks.forBlocks(count, 4, [&](int begin, int end, int, int worker) {
        for (int b = begin; b < end; ++b) countCompany(b, input, worker);
    });
    tasks.forBlocks(input.count, 1024, [&](int begin, int end, int, int) {
        for (int i = begin; i < end; ++i)
            reach_[i].amplitude *= lift(reach_[i].company, float(cell_) / reach_[i].radius);
    });
    tasks.forBlocks(count, 4, [&](int begin, int end, int, int) {
        for (int b = begin; b < end; ++b) splat(b, input);
    });
}

// Lists each particle with each block that its kernel touches; false when they are too many.
bool SurfaceField::findBlocks(const SurfaceInput& input) {
    reach_.resizeRaw(input.count);
    double lowest[3] = {INFINITY, INFINITY, INFINITY};
    for (int i = 0; i < input.count; ++i) {
        const Vec4& p = input.positions[i];
        float spacing = p.w / kSupport, radius = std::max(kReach * spacing, kReachCells * float(cell_));
        float ratio = spacing / radius;
        reach_[i] = {radius, 315 / (64 * kPi) * ratio * ratio * ratio, 0};
        lowest[0] = std::min(lowest[0], double(p.x) - radius);
        lowest[1] = std::min(lowest[1], double(p.y) - radius);
        lowest[2] = std::min(lowest[2], double(p.z) - radius);
    }
    double side = cell_ * kSide, perBlock = 1 / side;
    for (int a = 0; a < 3; ++a) origin_[a] = floorToInt(lowest[a] * perBlock) - 1;

    keys_.clear(), pairBlocks_.clear(), pairParticles_.clear();
    tableKeys_.assign(std::max<size_t>(tableKeys_.size(), 1024), kNoKey);
    tableBlocks_.resizeRaw(tableKeys_.size());
    for (int i = 0; i < input.count; ++i) {
        const Vec4& p = input.positions[i];
        double at[3] = {p.x, p.y, p.z}, radius = reach_[i].radius * 1.0001; // the margin covers rounding below
        int64_t lower[3], upper[3];
        for (int a = 0; a < 3; ++a) {
            lower[a] = floorToInt((at[a] - radius) * perBlock);
            upper[a] = floorToInt((at[a] + radius) * perBlock);
        }
        // Along one axis: squared distance to a block's box, which holds its cells and so the first nodes of the next
        // block.
        auto gap = [&](int a, int64_t b) {
            double d = std::max({double(b) * side - at[a], at[a] - double(b + 1) * side, 0.0});
            return d * d;
        };
        for (int64_t z = lower[2]; z <= upper[2]; ++z)
            for (int64_t y = lower[1]; y <= upper[1]; ++y) {
                double gapYz = gap(1, y) + gap(2, z);
                for (int64_t x = lower[0]; x <= upper[0]; ++x) {
                    if (gap(0, x) + gapYz > radius * radius) continue;
                    uint64_t key = uint64_t(z - origin_[2]) << (2 * kAxisBits) | uint64_t(y - origin_[1]) << kAxisBits |
                                   uint64_t(x - origin_[0]);
                    int block = blockOf(key);
                    if (block == kMaxBlocks) return false;
                    pairBlocks_.push(block), pairParticles_.push(i);
                }
            }
    }
    return true;
}

// Block of a key, in order of first sight; new ones are added.
int SurfaceField::blockOf(uint64_t key) {
    size_t mask = tableKeys_.size() - 1, slot = hashKey(key) & mask;
    for (; tableKeys_[slot] != kNoKey; slot = (slot + 1) & mask)
        if (tableKeys_[slot] == key) return tableBlocks_[slot];
    int block = int(keys_.size());
    keys_.push(key);
    tableKeys_[slot] = key, tableBlocks_[slot] = block;
    if (keys_.size() * 2 > tableKeys_.size()) growTable(tableKeys_.size() * 2);
    return block;
}

void SurfaceField::growTable(size_t size) {
    tableKeys_.assign(size, kNoKey);
    tableBlocks_.resizeRaw(size);
    for (size_t b = 0; b < keys_.size(); ++b) {
        size_t slot = hashKey(keys_[b]) & (size - 1);
        while (tableKeys_[slot] != kNoKey) slot = (slot + 1) & (size - 1);
        tableKeys_[slot] = keys_[b], tableBlocks_[slot] = int(b);
    }
}

// Orders blocks by key and their members by particle, so that nothing later depends on the table.
void SurfaceField::sortBlocks() {
    size_t count = keys_.size();
    sortedKeys_.resizeRaw(count), ranks_.resizeRaw(count);
    std::copy(keys_.begin(), keys_.end(), sortedKeys_.begin());
    std::sort(sortedKeys_.begin(), sortedKeys_.end()); // unique
    auto find = [&](uint64_t key) {
        size_t mask = tableKeys_.size() - 1, slot = hashKey(key) & mask;
        for (; tableKeys_[slot] != kNoKey; slot = (slot + 1) & mask)
            if (tableKeys_[slot] == key) return tableBlocks_[slot];
        return -1;
    };
    for (size_t b = 0; b < count; ++b) ranks_[find(sortedKeys_[b])] = int(b);

    constexpr uint64_t kAxisMask = (uint64_t(1) << kAxisBits) - 1;
    blocks_.resizeRaw(count);
    for (size_t b = 0; b < count; ++b) {
        uint64_t key = sortedKeys_[b];
        Block& block = blocks_[b];
        block.x = int32_t(int64_t(key & kAxisMask) + origin_[0]);
        block.y = int32_t(int64_t(key >> kAxisBits & kAxisMask) + origin_[1]);
        block.z = int32_t(int64_t(key >> 2 * kAxisBits) + origin_[2]);
        block.begin = block.end = 0;
        for (int n = 0; n < 8; ++n) {
            uint64_t step = uint64_t(n & 1) | uint64_t(n >> 1 & 1) << kAxisBits | uint64_t(n >> 2) << 2 * kAxisBits;
            int found = find(key + step);
            block.upper[n] = found < 0 ? -1 : ranks_[found];
        }
    }
    for (int32_t& b : pairBlocks_) b = ranks_[b], ++blocks_[b].end;
    int32_t sum = 0;
    for (Block& b : blocks_) {
        int32_t size = b.end;
        b.begin = b.end = sum;
        sum += size;
    }
    members_.resizeRaw(pairBlocks_.size());
    for (size_t k = 0; k < pairBlocks_.size(); ++k) members_[blocks_[pairBlocks_[k]].end++] = pairParticles_[k];
}

void SurfaceField::gather(const Block& block, const SurfaceInput& input, Candidates& out) const {
    double perCell = 1 / cell_, first[3] = {double(block.x) * kSide, double(block.y) * kSide, double(block.z) * kSide};
    out.count = block.end - block.begin;
    out.maxRadius = 0;
    for (int k = 0; k < out.count; ++k) {
        int i = members_[block.begin + k];
        const Vec4& p = input.positions[i];
        float radius = float(reach_[i].radius * perCell);
        out.x[k] = float(p.x * perCell - first[0]);
        out.y[k] = float(p.y * perCell - first[1]);
        out.z[k] = float(p.z * perCell - first[2]);
        out.inverse[k] = 1 / (radius * radius);
        out.amplitude[k] = reach_[i].amplitude;
        out.maxRadius = std::max(out.maxRadius, radius);
    }
}

// Fill at the particles whose centre is in the block.
void SurfaceField::countCompany(int b, const SurfaceInput& input, int worker) {
    const Block& block = blocks_[b];
    float* memory = scratch_.data() + size_t(worker) * 2 * Candidates::kArrays * scratchStride_;
    Candidates all(memory, scratchStride_),
        sorted(memory + size_t(Candidates::kArrays) * scratchStride_, scratchStride_);
    gather(block, input, all);

    // Candidates by bins no narrower than any kernel: all that reaches a particle is in the 27 bins around it, and
    // three bins along x are one run.
    float span = kSide + 2 * all.maxRadius;
    int bins = std::clamp(int(span / all.maxRadius), 1, kMaxBins);
    float perBin = float(bins) / span;
    auto bin = [&](float v) { return std::clamp(int((v + all.maxRadius) * perBin), 0, bins - 1); };
    auto binOf = [&](int k) { return (bin(all.z[k]) * bins + bin(all.y[k])) * bins + bin(all.x[k]); };
    int starts[kMaxBins * kMaxBins * kMaxBins + 2] = {};
    for (int k = 0; k < all.count; ++k) ++starts[binOf(k) + 2];
    for (int c = 2; c < bins * bins * bins + 2; ++c) starts[c] += starts[c - 1];
    for (int k = 0; k < all.count; ++k) {
        int to = starts[binOf(k) + 1]++;
        sorted.x[to] = all.x[k], sorted.y[to] = all.y[k], sorted.z[to] = all.z[k];
        sorted.inverse[to] = all.inverse[k], sorted.amplitude[to] = all.amplitude[k];
    }
    for (int k = all.count; k < all.count + kPad; ++k)
        sorted.x[k] = sorted.y[k] = sorted.z[k] = sorted.inverse[k] = sorted.amplitude[k] = 0;

    FillArrays arrays{sorted.x, sorted.y, sorted.z, sorted.inverse, sorted.amplitude};
    double perBlock = 1 / (cell_ * kSide);
    for (int k = 0; k < all.count; ++k) {
        int i = members_[block.begin + k];
        const Vec4& p = input.positions[i];
        if (floorToInt(p.x * perBlock) != block.x || floorToInt(p.y * perBlock) != block.y ||
            floorToInt(p.z * perBlock) != block.z)
            continue;
        int x = bin(all.x[k]), y = bin(all.y[k]), z = bin(all.z[k]);
        int begins[9], ends[9], runs = 0;
        constexpr int kNearFirst[9] = {4, 1, 3, 5, 7, 0, 2, 6, 8};
        for (int row : kNearFirst) {
            int rowY = y + row % 3 - 1, rowZ = z + row / 3 - 1;
            if (rowY < 0 || rowY >= bins || rowZ < 0 || rowZ >= bins) continue;
            const int* start = starts + (rowZ * bins + rowY) * bins;
            begins[runs] = start[std::max(x - 1, 0)], ends[runs++] = start[std::min(x + 1, bins - 1) + 1];
        }
        float fill = sumRuns(arrays, begins, ends, runs, all.x[k], all.y[k], all.z[k], kFullCompany);
        reach_[i].company = std::min(fill, kFullCompany);
    }
}

// Sums the members, in their order, at the block's nodes.
void SurfaceField::splat(int b, const SurfaceInput& input) {
    const Block& block = blocks_[b];
    float* values = values_.data() + size_t(b) * kChannels * kNodes;
    std::fill(values, values + kChannels * kNodes, 0.0f);
    double perCell = 1 / cell_, first[3] = {double(block.x) * kSide, double(block.y) * kSide, double(block.z) * kSide};
    for (int k = block.begin; k < block.end; ++k) {
        int i = members_[k];
        const Vec4& p = input.positions[i];
        splatSource({float(p.x * perCell - first[0]),
                     float(p.y * perCell - first[1]),
                     float(p.z * perCell - first[2]),
                     float(reach_[i].radius * perCell),
                     reach_[i].amplitude,
                     {input.temperatures[i], input.liquidFractions[i], reach_[i].company}},
                    values);
    }
}

} // namespace thaw
