// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace thaw {
namespace {

constexpr uint64_t kNoKey = ~uint64_t(0);
constexpr int kAxisBits = SurfaceField::kAxisBits;
constexpr int kMaxBlocks = 1 << 17; // 512 MiB of values; the cell grows beyond

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

void SurfaceField::clearTable() {
    tableKeys_.assign(std::max<size_t>(tableKeys_.size(), 1024), kNoKey);
    tableSlots_.resizeRaw(tableKeys_.size());
    tableUsed_ = 0, lastSlot_ = -1;
}

// Slot of a block that may have to be made; -1 when there are too many.
int SurfaceField::slotAt(int64_t x, int64_t y, int64_t z) {
    // The next particle is often in the same block or next door.
    if (lastSlot_ >= 0) {
        const Block& last = blocks_[lastSlot_];
        const int64_t dx = x - last.x + 1, dy = y - last.y + 1, dz = z - last.z + 1;
        if (uint64_t(dx) < 3 && uint64_t(dy) < 3 && uint64_t(dz) < 3)
            if (const int32_t slot = last.near[dz * 9 + dy * 3 + dx]; slot >= 0) return lastSlot_ = slot;
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
    // Slots that are used again hold zeros: all that was brought there has been taken away.
    base_.resize(blocks_.size() * kNodes), lift_.resize(blocks_.size() * kNodes);
    full_.resizeRaw(blocks_.size() * kSide * kSide), inside_.resizeRaw(blocks_.size() * kSide * kSide);
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

bool SurfaceField::reaches(uint32_t row, int slot) const {
    const Row& r = rows_[row];
    if (r.home < 0) return true; // there is no change by blocks then
    const Block &home = blocks_[r.home], &block = blocks_[slot];
    const int dx = block.x - home.x, dy = block.y - home.y, dz = block.z - home.z;
    if (std::max({std::abs(dx), std::abs(dy), std::abs(dz)}) > 1) return false;
    return kBlocksOfSides[r.reach] >> nearAt(dx, dy, dz) & 1;
}

// The blocks that the particle reaches are not what they were.
void SurfaceField::markAround(const Row& row) {
    if (row.home < 0) return;
    forBits(kBlocksOfSides[row.reach], [&](int n) {
        if (const int32_t slot = blocks_[row.home].near[n]; slot >= 0) blocks_[slot].changed = true;
    });
}

void SurfaceField::gatherBits(const Array<uint8_t>& bits, int slot, NodeBits& out) const {
    static constexpr uint8_t kNone[kSide * kSide] = {};
    const Block& block = blocks_[slot];
    for (int yz = 0; yz < 4; ++yz) {
        const auto at = [&](int x) {
            const int32_t other = block.near[nearAt(x, yz & 1, yz >> 1)];
            return other < 0 ? kNone : bits.data() + size_t(other) * kSide * kSide;
        };
        const uint8_t *left = at(0), *right = at(1);
        const int ys = yz & 1 ? 1 : kSide, zs = yz >> 1 ? 1 : kSide;
        for (int z = 0; z < zs; ++z)
            for (int y = 0; y < ys; ++y)
                out.rows[z + (yz >> 1) * kSide][y + (yz & 1) * kSide] =
                    uint16_t(left[z * kSide + y] | (right[z * kSide + y] & 1u) << kSide);
    }
}

} // namespace thaw
