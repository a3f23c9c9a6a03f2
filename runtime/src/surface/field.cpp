// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

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
constexpr int kEnough = int(kFullCompany / kFillUnit);
// Most that is made up for: a particle alone. On cells so coarse that the kernel is widened there would be no end to
// it.
constexpr float kMaxMissing = 3.1f;

constexpr int kMaxBlocks = 1 << 17; // 512 MiB of values; the cell grows beyond
constexpr double kCoarsen = 1.26;   // halves the volume of blocks
constexpr int kAxisBits = 21;       // of a key
constexpr int kPad = 8;             // lanes that may be read past the particles
constexpr uint64_t kNoKey = ~uint64_t(0);
constexpr float kPi = 3.14159265f;
constexpr float kBlockLower[3] = {0, 0, 0};
constexpr float kBlockUpper[3] = {SurfaceField::kSide, SurfaceField::kSide, SurfaceField::kSide}; // cells

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

// Blocks are within +-2^20 of the origin: a cell is at least 2^-22 of the farthest position.
uint64_t keyOf(int64_t x, int64_t y, int64_t z) {
    constexpr int64_t kBias = int64_t(1) << (kAxisBits - 1);
    return uint64_t(z + kBias) << 2 * kAxisBits | uint64_t(y + kBias) << kAxisBits | uint64_t(x + kBias);
}

// Sides that a particle may reach over, as Row::reach has them, to the blocks around.
std::array<uint32_t, 64> reachTable() {
    std::array<uint32_t, 64> table{};
    for (int sides = 0; sides < 64; ++sides)
        for (int n = 0; n < SurfaceField::kNear; ++n) {
            const int d[3] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
            bool may = true;
            for (int a = 0; a < 3; ++a) may &= d[a] == 0 || (sides >> (2 * a + (d[a] > 0)) & 1);
            if (may) table[size_t(sides)] |= 1u << n;
        }
    return table;
}
const std::array<uint32_t, 64> kBlocksOfSides = reachTable();

template <class F> void forBits(uint32_t bits, F&& f) {
    for (; bits != 0; bits &= bits - 1) f(__builtin_ctz(bits));
}

} // namespace

float SurfaceField::mobility(float company) {
    constexpr float kNone = 0.45f, kAll = 0.65f;
    return std::clamp((company - kNone) / (kAll - kNone), 0.0f, 1.0f);
}

SurfaceField::SurfaceField(Allocator& allocator)
    : positions_(allocator), materials_(allocator), bodies_(allocator), rows_(allocator), freshRows_(allocator),
      large_(allocator), blocks_(allocator), freeSlots_(allocator), order_(allocator), changedSlots_(allocator),
      needed_(allocator), tableKeys_(allocator), tableSlots_(allocator), base_(allocator), values_(allocator),
      inside_(allocator), binStarts_(allocator), sortedRows_(allocator), sorted_(allocator), excess_(allocator) {}

void SurfaceField::clear() {
    valid_ = false;
    positions_.clear(), materials_.clear(), bodies_.clear(), rows_.clear(), large_.clear();
    blocks_.clear(), freeSlots_.clear(), order_.clear();
    tableKeys_.assign(std::max<size_t>(tableKeys_.size(), 1024), kNoKey);
    tableSlots_.resizeRaw(tableKeys_.size());
    tableUsed_ = 0, lastSlot_ = -1;
}

SurfaceField::Change SurfaceField::update(const SurfaceInput& input, float wantedCell, Tasks& tasks) {
    const int count = std::max(input.count, 0), before = int(positions_.size()), common = std::min(count, before);
    const bool comparable = valid_ && asked_ == wantedCell && spacing_ == input.spacing;
    freshRows_.clear();
    if (comparable) {
        for (int i = 0; i < common; ++i)
            if (std::memcmp(&positions_[i], &input.positions[i], sizeof(Vec4)) != 0 ||
                materials_[i] != input.materials[i] || bodies_[i] != input.bodies[i])
                freshRows_.push(i);
        if (freshRows_.empty() && count == before) return Change::nothing;
    }

    float farthest = 0;
    for (int i = 0; i < count; ++i) {
        const Vec4& p = input.positions[i];
        farthest = std::max({farthest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    }
    // Positions carry 24 bits: a finer cell has nothing to show, and keys would not hold its blocks.
    const double wanted = std::max(double(wantedCell), std::ldexp(double(farthest), -(kAxisBits + 1)));

    // What most has changed of is cheaper to make anew.
    bool patch = comparable && wanted == cell_ && large_.empty() && count > 0 &&
                 2 * (int(freshRows_.size()) + std::abs(count - before)) < count;
    valid_ = false;
    if (patch) {
        for (Block& b : blocks_) b.changed = false;
        for (int32_t i : freshRows_) markAround(rows_[i]);
        for (int i = count; i < before; ++i) markAround(rows_[i]);
        for (int i = before; i < count; ++i) freshRows_.push(i);
        rows_.resizeRaw(count);
        patch = placeRows(input, freshRows_.begin(), freshRows_.end()) && linkBlocks(input);
    }
    if (patch) {
        for (int32_t i : freshRows_) markAround(rows_[i]);
    } else {
        cell_ = wanted;
        while (!rebuild(input)) cell_ *= kCoarsen;
    }
    asked_ = wantedCell, spacing_ = input.spacing;
    sortRows(input);
    forChanged(tasks, [&](int slot) { splatBlock(slot); });
    forChanged(tasks, [&](int slot) { countCompany(slot, input); });
    countCompanyOfLarge(input);
    // Whose company has changed counts for another amount in all blocks that it reaches.
    for (Row& row : rows_) {
        if (row.otherCompany && patch) markAround(row);
        row.otherCompany = false;
    }
    for (int k = 0; k < count; ++k) {
        const Row& row = rows_[sortedRows_[k]];
        excess_[k] = row.lifted - row.amplitude;
    }
    forChanged(tasks, [&](int slot) { liftBlock(slot); });

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
    reach_ = 0;
    return placeRows(input, freshRows_.begin(), freshRows_.end()) && linkBlocks(input);
}

// Where these rows are; false when there are too many blocks, or when one is large and was not foreseen.
bool SurfaceField::placeRows(const SurfaceInput& input, const int32_t* begin, const int32_t* end) {
    const double perBlock = 1 / (cell_ * kSide);
    const bool foreseen = order_.empty();
    for (const int32_t* i = begin; i != end; ++i) {
        const Vec4& p = input.positions[*i];
        Row& row = rows_[*i];
        const float spacing = p.w / kSupport, radius = std::max(kReach * spacing, kReachCells * float(cell_));
        const float ratio = spacing / radius;
        row = {};
        row.inverse = 1 / (radius * radius);
        row.amplitude = row.lifted = 315 / (64 * kPi) * ratio * ratio * ratio;
        row.company = -1;
        const double reach = double(radius) / cell_ * 1.0001; // the margin covers rounding
        if (reach > kSide) {
            if (!foreseen) return false;
            row.home = -1;
            large_.push(*i);
            continue;
        }
        reach_ = std::max(reach_, float(reach));
        const double at[3] = {p.x * perBlock, p.y * perBlock, p.z * perBlock};
        int64_t block[3];
        int bin[3];
        for (int a = 0; a < 3; ++a) {
            const double first = std::floor(at[a]), local = (at[a] - first) * kSide;
            block[a] = int64_t(first);
            bin[a] = std::min(int(local * (double(kBins) / kSide)), kBins - 1);
            row.reach |= uint8_t((local - reach <= 0) << 2 * a | (local + reach >= kSide) << (2 * a + 1));
        }
        row.bin = uint8_t((bin[2] * kBins + bin[1]) * kBins + bin[0]);
        row.home = slotAt(block[0], block[1], block[2]);
        if (row.home < 0) return false;
    }
    return true;
}

// Slot of a block that may have to be made; -1 when there are too many.
int SurfaceField::slotAt(int64_t x, int64_t y, int64_t z) {
    // The next particle is often in the same block.
    if (lastSlot_ >= 0) {
        const Block& last = blocks_[lastSlot_];
        if (last.x == x && last.y == y && last.z == z) return lastSlot_;
    }
    const uint64_t key = keyOf(x, y, z);
    const size_t found = entryOf(key);
    if (tableKeys_[found] == key) return lastSlot_ = tableSlots_[found];
    if (tableUsed_ == size_t(kMaxBlocks)) return -1;

    int slot = int(blocks_.size());
    if (freeSlots_.empty()) {
        blocks_.push({});
    } else {
        slot = freeSlots_[freeSlots_.size() - 1];
        freeSlots_.resizeRaw(freeSlots_.size() - 1);
    }
    Block& made = blocks_[slot];
    made = {};
    made.x = int32_t(x), made.y = int32_t(y), made.z = int32_t(z);
    made.alive = made.changed = true;
    setChanged_ = true;
    tableKeys_[found] = key, tableSlots_[found] = slot;
    if (++tableUsed_ * 2 > tableKeys_.size()) growTable(tableKeys_.size() * 2);
    for (int n = 0; n < kNear; ++n) {
        const uint64_t key2 = keyOf(x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1);
        const size_t entry = entryOf(key2);
        made.near[n] = tableKeys_[entry] == key2 ? tableSlots_[entry] : -1;
        if (made.near[n] >= 0) blocks_[made.near[n]].near[kNear - 1 - n] = slot;
    }
    return lastSlot_ = slot;
}

// Where a key is in the table, or would come.
size_t SurfaceField::entryOf(uint64_t key) const {
    const size_t mask = tableKeys_.size() - 1;
    size_t entry = hashKey(key) & mask;
    while (tableKeys_[entry] != kNoKey && tableKeys_[entry] != key) entry = (entry + 1) & mask;
    return entry;
}

void SurfaceField::growTable(size_t size) {
    tableKeys_.assign(size, kNoKey);
    tableSlots_.resizeRaw(size);
    for (size_t slot = 0; slot < blocks_.size(); ++slot) {
        const Block& b = blocks_[slot];
        if (!b.alive) continue;
        const uint64_t key = keyOf(b.x, b.y, b.z);
        const size_t entry = entryOf(key);
        tableKeys_[entry] = key, tableSlots_[entry] = int32_t(slot);
    }
}

void SurfaceField::dropBlock(int slot) {
    Block& block = blocks_[slot];
    for (int n = 0; n < kNear; ++n)
        if (block.near[n] >= 0) blocks_[block.near[n]].near[kNear - 1 - n] = -1;
    // Closes the gap in the table (Knuth, The Art of Computer Programming 3, algorithm 6.4 R).
    const size_t mask = tableKeys_.size() - 1;
    size_t gap = entryOf(keyOf(block.x, block.y, block.z));
    for (size_t next = (gap + 1) & mask; tableKeys_[next] != kNoKey; next = (next + 1) & mask)
        if (((next - (hashKey(tableKeys_[next]) & mask)) & mask) >= ((next - gap) & mask)) {
            tableKeys_[gap] = tableKeys_[next], tableSlots_[gap] = tableSlots_[next];
            gap = next;
        }
    tableKeys_[gap] = kNoKey;
    --tableUsed_;
    block = {};
    freeSlots_.push(slot);
    setChanged_ = true;
    if (lastSlot_ == slot) lastSlot_ = -1;
}

// Makes the blocks that particles reach from others and drops those that none reaches any more; false when there are
// too many.
bool SurfaceField::linkBlocks(const SurfaceInput& input) {
    for (Block& b : blocks_) b.reached = 0;
    for (const Row& row : rows_)
        if (row.home >= 0) blocks_[row.home].reached |= kBlocksOfSides[row.reach];
    const int homes = int(blocks_.size());
    for (int slot = 0; slot < homes; ++slot) {
        uint32_t missing = 0;
        forBits(blocks_[slot].reached, [&](int n) { missing |= uint32_t(blocks_[slot].near[n] < 0) << n; });
        bool fits = true;
        forBits(missing, [&](int n) {
            const Block b = blocks_[slot];
            fits &= b.near[n] >= 0 || slotAt(b.x + n % 3 - 1, b.y + n / 3 % 3 - 1, b.z + n / 9 - 1) >= 0;
        });
        if (!fits) return false;
    }
    if (!reachOfLarge(input)) return false;
    needed_.assign(blocks_.size(), 0);
    for (size_t slot = 0; slot < blocks_.size(); ++slot)
        forBits(blocks_[slot].reached, [&](int n) { needed_[blocks_[slot].near[n]] = 1; });
    for (size_t slot = 0; slot < blocks_.size(); ++slot)
        if (blocks_[slot].alive && !needed_[slot]) dropBlock(int(slot));

    if (setChanged_) {
        order_.clear();
        for (size_t slot = 0; slot < blocks_.size(); ++slot)
            if (blocks_[slot].alive) order_.push(int32_t(slot));
        std::sort(order_.begin(), order_.end(), [&](int32_t a, int32_t b) {
            const Block &p = blocks_[a], &q = blocks_[b];
            return keyOf(p.x, p.y, p.z) < keyOf(q.x, q.y, q.z);
        });
        setChanged_ = false;
    }
    base_.resizeRaw(blocks_.size() * kNodes), values_.resizeRaw(blocks_.size() * kNodes);
    inside_.resizeRaw(blocks_.size() * kSide * kSide);
    return true;
}

// Blocks that particles reach over more than one other; false when there are too many.
bool SurfaceField::reachOfLarge(const SurfaceInput& input) {
    const double side = cell_ * kSide, perBlock = 1 / side;
    for (int32_t i : large_) {
        const Vec4& p = input.positions[i];
        const double at[3] = {p.x, p.y, p.z}, radius = 1.0001 / std::sqrt(double(rows_[i].inverse));
        int64_t lower[3], upper[3];
        double blocks = 1;
        for (int a = 0; a < 3; ++a) {
            lower[a] = int64_t(std::floor((at[a] - radius) * perBlock));
            upper[a] = int64_t(std::floor((at[a] + radius) * perBlock));
            blocks *= double(upper[a] - lower[a] + 1);
        }
        if (blocks > 4.0 * kMaxBlocks) return false; // more than half of them are in its ball
        // Along one axis: squared distance to a block's box, which holds its cells and so the first nodes of the next
        // block.
        auto gap = [&](int a, int64_t b) {
            double d = std::max({double(b) * side - at[a], at[a] - double(b + 1) * side, 0.0});
            return d * d;
        };
        for (int64_t z = lower[2]; z <= upper[2]; ++z)
            for (int64_t y = lower[1]; y <= upper[1]; ++y)
                for (int64_t x = lower[0]; x <= upper[0]; ++x) {
                    if (gap(0, x) + gap(1, y) + gap(2, z) > radius * radius) continue;
                    const int slot = slotAt(x, y, z);
                    if (slot < 0) return false;
                    blocks_[slot].reached |= 1u << nearAt(0, 0, 0);
                }
    }
    return true;
}

// The blocks that the particle reaches are not what they were.
void SurfaceField::markAround(const Row& row) {
    if (row.home < 0) return;
    forBits(kBlocksOfSides[row.reach], [&](int n) {
        if (const int32_t slot = blocks_[row.home].near[n]; slot >= 0) blocks_[slot].changed = true;
    });
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

void SurfaceField::sortRows(const SurfaceInput& input) {
    const size_t count = rows_.size(), stride = count + kPad;
    binStarts_.assign(blocks_.size() * kBlockBins + 2, 0);
    for (const Row& row : rows_)
        if (row.home >= 0) ++binStarts_[size_t(row.home) * kBlockBins + row.bin + 2];
    for (size_t b = 2; b < binStarts_.size(); ++b) binStarts_[b] += binStarts_[b - 1];
    sortedRows_.resizeRaw(stride), excess_.resizeRaw(count);
    sorted_.resizeRaw(5 * stride);
    float *x = sorted_.data(), *y = x + stride, *z = y + stride, *inverse = z + stride, *amplitude = inverse + stride;
    arrays_ = {x, y, z, inverse, amplitude};
    for (size_t i = 0; i < count; ++i) {
        const Row& row = rows_[i];
        // Large ones are in no bin; they stand at the end.
        const size_t bin = row.home >= 0 ? size_t(row.home) * kBlockBins + row.bin : blocks_.size() * kBlockBins;
        const int32_t to = binStarts_[bin + 1]++;
        sortedRows_[to] = uint32_t(i);
        const Vec4& p = input.positions[i];
        x[to] = p.x, y[to] = p.y, z[to] = p.z, inverse[to] = row.inverse, amplitude[to] = row.amplitude;
    }
    for (float* a : {x, y, z, inverse, amplitude}) std::fill(a + count, a + stride, 0.0f);
    std::fill(sortedRows_.data() + count, sortedRows_.data() + stride, 0u);
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
    for (int z = first[2]; z <= last[2]; ++z) {
        const int dz = z < 0 ? -1 : z < kBins ? 0 : 1;
        for (int y = first[1]; y <= last[1]; ++y) {
            const int dy = y < 0 ? -1 : y < kBins ? 0 : 1;
            for (int dx = -1; dx <= 1; ++dx) {
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

// Whether fill before lifting is enough everywhere around a particle, for which the eight nodes of its cell stand: then
// so is its company, without counting. That goes for all but those at the surface.
bool SurfaceField::isFullAround(int slot, int k) const {
    constexpr float kFull = 0.9f; // what the nodes do not see between them is less than the rest
    const Block& block = blocks_[slot];
    const double perCell = 1 / cell_;
    const int x = int(double(arrays_.x[k]) * perCell - double(block.x) * kSide),
              y = int(double(arrays_.y[k]) * perCell - double(block.y) * kSide),
              z = int(double(arrays_.z[k]) * perCell - double(block.z) * kSide);
    for (int dz = 0; dz < 2; ++dz)
        for (int dy = 0; dy < 2; ++dy)
            for (int dx = 0; dx < 2; ++dx) {
                const int nx = x + dx, ny = y + dy, nz = z + dz;
                const int32_t other = block.near[nearAt(nx >= kSide, ny >= kSide, nz >= kSide)];
                if (other < 0) return false;
                const size_t node = size_t(((nz % kSide) * kSide + ny % kSide) * kSide + nx % kSide);
                if (base_[size_t(other) * kNodes + node] < kFull) return false;
            }
    return true;
}

// Company of the particles whose centre is in the block.
void SurfaceField::countCompany(int slot, const SurfaceInput& input) {
    const int32_t* starts = binStarts_.data() + size_t(slot) * kBlockBins;
    const Block& block = blocks_[slot];
    const float first[3] = {float(double(block.x) * kSide * cell_), float(double(block.y) * kSide * cell_),
                            float(double(block.z) * kSide * cell_)},
                perCell = float(1 / cell_);
    constexpr int kTogether = 64;
    int which[kTogether], sums[kTogether];
    Runs runs;
    for (int bin = 0; bin < kBlockBins; ++bin)
        for (int k = starts[bin], end = starts[bin + 1]; k < end;) {
            int count = 0;
            Box box;
            for (; k < end && count < kTogether; ++k) {
                const Vec3 at{arrays_.x[k], arrays_.y[k], arrays_.z[k]};
                if (isFullAround(slot, k))
                    setCompany(rows_[sortedRows_[k]], kEnough, at, input);
                else
                    which[count++] = k, box.grow(at);
            }
            if (count == 0) continue;
            const float low[3] = {box.lower.x, box.lower.y, box.lower.z},
                        up[3] = {box.upper.x, box.upper.y, box.upper.z};
            float lower[3], upper[3];
            for (int a = 0; a < 3; ++a)
                lower[a] = (low[a] - first[a]) * perCell, upper[a] = (up[a] - first[a]) * perCell;
            runsAround(slot, lower, upper, runs);
            sumAround(arrays_, runs.begins, runs.ends, runs.count, boxOf(slot, lower, upper), which, count, sums);
            for (int n = 0; n < count; ++n) {
                const int at = which[n];
                setCompany(rows_[sortedRows_[at]], sums[n], {arrays_.x[at], arrays_.y[at], arrays_.z[at]}, input);
            }
        }
}

// Of a particle that has so much from those that are not large.
void SurfaceField::setCompany(Row& row, int sum, Vec3 at, const SurfaceInput& input) {
    for (size_t k = 0; k < large_.size() && sum < kEnough; ++k) {
        const Row& other = rows_[large_[k]];
        const Vec3 d = input.positions[large_[k]].xyz() - at;
        const float t = std::max(1 - dot(d, d) * other.inverse, 0.0f);
        sum += int(std::lrint(double(other.amplitude * t * t * t) / double(kFillUnit)));
    }
    const float company = sum < kEnough ? float(sum) * kFillUnit : kFullCompany;
    row.otherCompany = company != row.company;
    row.company = company;
    row.lifted = row.amplitude * lift(company, float(cell_) * std::sqrt(row.inverse));
}

void SurfaceField::countCompanyOfLarge(const SurfaceInput& input) {
    const int begin = 0, end = int(rows_.size() - large_.size());
    for (int k = end; k < int(rows_.size()); ++k) {
        const Vec3 at{arrays_.x[k], arrays_.y[k], arrays_.z[k]};
        int sum = 0;
        sumAround(arrays_, &begin, &end, 1, {{at.x, at.y, at.z}, {}}, &k, 1, &sum);
        setCompany(rows_[sortedRows_[k]], sum, at, input);
    }
}

void SurfaceField::splat(int slot, const float* amplitudes, const Runs& runs, float* values) const {
    const Block& block = blocks_[slot];
    const FillBlock place{{double(block.x) * kSide, double(block.y) * kSide, double(block.z) * kSide}, 1 / cell_};
    splatRuns(arrays_, amplitudes, runs.begins, runs.ends, runs.count, place, values);
    if (!large_.empty()) {
        const int begin = int(rows_.size() - large_.size()), end = int(rows_.size());
        splatRuns(arrays_, amplitudes, &begin, &end, 1, place, values);
    }
}

// Fill before lifting.
void SurfaceField::splatBlock(int slot) {
    Runs runs;
    runsAround(slot, kBlockLower, kBlockUpper, runs);
    blocks_[slot].around = int(large_.size());
    for (int r = 0; r < runs.count; ++r) blocks_[slot].around += runs.ends[r] - runs.begins[r];
    float* base = base_.data() + size_t(slot) * kNodes;
    std::fill(base, base + kNodes, 0.0f);
    splat(slot, arrays_.amplitude, runs, base);
}

// And what lifting adds.
void SurfaceField::liftBlock(int slot) {
    Runs runs;
    runsAround(slot, kBlockLower, kBlockUpper, runs);
    float* values = values_.data() + size_t(slot) * kNodes;
    std::copy_n(base_.data() + size_t(slot) * kNodes, kNodes, values);
    splat(slot, excess_.data(), runs, values);
    markInside(values, kIso, inside_.data() + size_t(slot) * kSide * kSide);
}

} // namespace thaw
