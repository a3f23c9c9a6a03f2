// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "neighbors/neighbors.h"
#include "neighbors/passes.h"

#ifndef THAW_LISTS_ONCE
#define THAW_LISTS_ONCE
namespace thaw {
namespace {

// Per mask, the lanes whose bit is set, first to last; the rest is lane 0.
struct Compress {
    alignas(64) uint32_t order[256][8];
    constexpr Compress() : order{} {
        for (unsigned mask = 0; mask < 256; ++mask)
            for (unsigned lane = 0, n = 0; lane < 8; ++lane)
                if (mask >> lane & 1) order[mask][n++] = lane;
    }
};
[[maybe_unused]] constexpr Compress kCompress;

} // namespace
} // namespace thaw
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "neighbors/lists_simd.cpp"
#include "hwy/foreach_target.h"

#include "base/simd.h"

HWY_BEFORE_NAMESPACE();
namespace thaw {
namespace HWY_NAMESPACE {

// Where the candidates of a row come from: one copied cell, or the ranges themselves when they are too many.
struct Candidates {
    CellGrid::Range ranges[2 * (CellGrid::kMaxRanges + (GridSet::kMost - 1) * CellGrid::kMaxBoxRanges)];
    int rangeCount = 0;
    int count = 0; // copied; -1: not copied
    int shift = 0; // row + shift: place in the copy
};

// Copies what lies around a cell into scratch: 6.5 ns a row and every test reads from L1 in one stream. Of the cell's
// own class that is in the 27 cells; of the others, in all that its box and the pairs' supports touch. Where the grid
// is folded a cell has no box: there it is done for every row on its own. Returns whether it holds for the whole cell.
template <bool kMixed> bool collect(const ListArgs& a, int self, ListScratch& s, Candidates& c) {
    const uint32_t cells = a.grids.cellCount(), key = a.cellOf[self];
    uint32_t cell = key < cells ? key : key - cells;
    int own = 0;
    while (cell >= a.grids.first[own + 1]) ++own;
    cell -= a.grids.first[own];
    const CellGrid& grid = a.grids.grid[own];
    const int at[3] = {static_cast<int>(cell) % grid.cells[0], static_cast<int>(cell) / grid.cells[0] % grid.cells[1],
                       static_cast<int>(cell) / grid.cells[0] / grid.cells[1]};
    const bool whole = a.grids.count == 1 || !(grid.folded[0] || grid.folded[1] || grid.folded[2]);
    double low[3], high[3];
    if (a.grids.count > 1) {
        const double p[3] = {a.x[self], a.y[self], a.z[self]};
        if (whole)
            grid.boxOf(at, low, high);
        else
            for (int k = 0; k < 3; ++k) low[k] = high[k] = p[k];
    }
    c.rangeCount = 0;
    const int firstKind = a.moverCount > 0 ? 0 : 1, lastKind = a.moverCount < a.count ? 1 : 0;
    for (int kind = firstKind; kind <= lastKind; ++kind)
        for (int other = 0; other < a.grids.count; ++other) {
            const uint32_t* start = a.cellStart + a.grids.offset(kind, other);
            if (other == own) {
                c.rangeCount += grid.ranges(start, at, c.ranges + c.rangeCount);
                continue;
            }
            const double way = 0.5 * (static_cast<double>(a.grids.support[own]) + a.grids.support[other]);
            const double from[3] = {low[0] - way, low[1] - way, low[2] - way};
            const double to[3] = {high[0] + way, high[1] + way, high[2] + way};
            c.rangeCount += a.grids.grid[other].boxRanges(start, from, to, c.ranges + c.rangeCount);
        }
    const uint32_t mine = a.cellStart[key];

    int n = 0;
    for (int r = 0; r < c.rangeCount; ++r) n += static_cast<int>(c.ranges[r].end - c.ranges[r].begin);
    c.count = -1;
    if (n > ListScratch::kCandidates) return whole;
    c.count = n;
    n = 0;
    const U32 step = hn::Set(kU32, 16 * kLanes);
    const U32 lane = hn::ShiftLeft<4>(hn::Iota(kU32, 0));
    for (int r = 0; r < c.rangeCount; ++r) {
        const uint32_t begin = c.ranges[r].begin, end = c.ranges[r].end;
        if (mine >= begin && mine < end) c.shift = n - static_cast<int>(begin);
        U32 entry = hn::Add(hn::Set(kU32, 16 * begin), lane);
        for (uint32_t j = begin; j < end; j += kLanes) {
            const uint32_t to = static_cast<uint32_t>(n) + j - begin;
            store(load(a.x + j), s.x + to);
            store(load(a.y + j), s.y + to);
            store(load(a.z + j), s.z + to);
            if (kMixed) store(load(a.h + j), s.h + to);
            hn::StoreU(entry, kU32, s.entry + to);
            entry = hn::Add(entry, step);
        }
        n += static_cast<int>(end - begin);
    }
    store(all(Particles::kFar), s.x + n);
    store(zero(), s.y + n), store(zero(), s.z + n), store(zero(), s.h + n);
    return whole;
}

struct Self {
    F32 x, y, z, h;
};

template <bool kMixed>
HWY_INLINE Mask near(const Self& i, const float* x, const float* y, const float* z, const float* h, F32 limit) {
    const F32 dx = hn::Sub(i.x, load(x)), dy = hn::Sub(i.y, load(y)), dz = hn::Sub(i.z, load(z));
    if (kMixed) {
        const F32 sum = hn::Mul(all(0.5f), hn::Add(i.h, load(h)));
        limit = hn::Mul(sum, sum);
    }
    return hn::Lt(dot3(dx, dy, dz, dx, dy, dz), limit);
}

// Appends the entries that the mask names and returns how many. Highway's own CompressStore is an instruction that
// takes Zen 4 over a hundred cycles with AVX-512, and with AVX2 gcc copies its table to the stack at every call (500
// instead of 50 ns a row).
HWY_INLINE size_t append(U32 entry, Mask m, uint32_t* out) {
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET <= HWY_AVX3
    hn::StoreU(hn::Compress(entry, hn::RebindMask(kU32, m)), kU32, out);
    return hn::CountTrue(kF32, m);
#else
    uint8_t bits[8] = {};
    hn::StoreMaskBits(kF32, m, bits);
    const uint32_t* order = kCompress.order[bits[0]];
    hn::StoreU(hn::TableLookupLanes(entry, hn::IndicesFromVec(kU32, hn::Load(kU32, order))), kU32, out);
    return hn::CountTrue(kF32, m);
#endif
}

// Writes the neighbours of one row to out, ascending, and returns how many; stops soon after kMaxNeighbors.
template <bool kMixed>
HWY_INLINE int scanCopied(ListScratch& s, int count, int self, const Self& i, F32 limit, uint32_t* out) {
    const float kept = s.x[self];
    s.x[self] = Particles::kFar;
    uint32_t* end = out;
    for (int from = 0; from < count && end - out <= Neighbors::kMaxNeighbors; from += ListScratch::kStretch) {
        const size_t to = static_cast<size_t>(std::min(count, from + ListScratch::kStretch));
        for (size_t k = static_cast<size_t>(from); k < to; k += kLanes) {
            const Mask m = near<kMixed>(i, s.x + k, s.y + k, s.z + k, s.h + k, limit);
            end += append(hn::LoadU(kU32, s.entry + k), m, end);
        }
    }
    s.x[self] = kept;
    return static_cast<int>(end - out);
}

// The same for cells with more candidates than are copied; stops when there are more.
template <bool kMixed>
int scanInPlace(const ListArgs& a, const Candidates& c, int self, const Self& i, F32 limit, uint32_t* out) {
    int n = 0;
    const auto me = hn::Set(kI32, 16 * self);
    for (int r = 0; r < c.rangeCount; ++r)
        for (uint32_t j = c.ranges[r].begin; j < c.ranges[r].end && n <= Neighbors::kMaxNeighbors; j += kLanes) {
            const auto entry = hn::ShiftLeft<4>(hn::Iota(kI32, static_cast<int>(j)));
            Mask m = near<kMixed>(i, a.x + j, a.y + j, a.z + j, a.h + j, limit);
            m = hn::And(m, hn::FirstN(kF32, c.ranges[r].end - j));
            m = hn::And(m, hn::RebindMask(kF32, hn::Ne(entry, me)));
            n += static_cast<int>(append(hn::BitCast(kU32, entry), m, out + n));
        }
    return n;
}

// Eight lists of `count` entries to one of eight lanes; writes whole multiples of 8 entries a lane.
HWY_INLINE void interleave(const uint32_t (*row)[ListScratch::kRow], int count, uint32_t* out) {
#if HWY_TARGET == HWY_SCALAR
    for (int k = 0; k < count; ++k)
        for (int l = 0; l < 8; ++l) out[8 * k + l] = row[l][k];
#elif HWY_MAX_BYTES >= 32
    const hn::RepartitionToWide<TagU32> wide;
    for (int k = 0; k < count; k += 8, out += 64) {
        const auto pairLow = [&](int l) HWY_ATTR {
            return hn::BitCast(wide,
                               hn::InterleaveLower(kU32, hn::Load(kU32, row[l] + k), hn::Load(kU32, row[l + 1] + k)));
        };
        const auto pairHigh = [&](int l) HWY_ATTR {
            return hn::BitCast(wide,
                               hn::InterleaveUpper(kU32, hn::Load(kU32, row[l] + k), hn::Load(kU32, row[l + 1] + k)));
        };
        const auto t0 = pairLow(0), t1 = pairHigh(0), t2 = pairLow(2), t3 = pairHigh(2);
        const auto t4 = pairLow(4), t5 = pairHigh(4), t6 = pairLow(6), t7 = pairHigh(6);
        const U32 u0 = hn::BitCast(kU32, hn::InterleaveLower(wide, t0, t2));
        const U32 u1 = hn::BitCast(kU32, hn::InterleaveUpper(wide, t0, t2));
        const U32 u2 = hn::BitCast(kU32, hn::InterleaveLower(wide, t1, t3));
        const U32 u3 = hn::BitCast(kU32, hn::InterleaveUpper(wide, t1, t3));
        const U32 u4 = hn::BitCast(kU32, hn::InterleaveLower(wide, t4, t6));
        const U32 u5 = hn::BitCast(kU32, hn::InterleaveUpper(wide, t4, t6));
        const U32 u6 = hn::BitCast(kU32, hn::InterleaveLower(wide, t5, t7));
        const U32 u7 = hn::BitCast(kU32, hn::InterleaveUpper(wide, t5, t7));
        hn::StoreU(hn::ConcatLowerLower(kU32, u4, u0), kU32, out);
        hn::StoreU(hn::ConcatLowerLower(kU32, u5, u1), kU32, out + 8);
        hn::StoreU(hn::ConcatLowerLower(kU32, u6, u2), kU32, out + 16);
        hn::StoreU(hn::ConcatLowerLower(kU32, u7, u3), kU32, out + 24);
        hn::StoreU(hn::ConcatUpperUpper(kU32, u4, u0), kU32, out + 32);
        hn::StoreU(hn::ConcatUpperUpper(kU32, u5, u1), kU32, out + 40);
        hn::StoreU(hn::ConcatUpperUpper(kU32, u6, u2), kU32, out + 48);
        hn::StoreU(hn::ConcatUpperUpper(kU32, u7, u3), kU32, out + 56);
    }
#else
    const auto at = [&](int l, int k) HWY_ATTR { return hn::BitCast(kF32, hn::Load(kU32, row[l] + k)); };
    for (int k = 0; k < count; k += 4, out += 32)
        for (int l = 0; l < 8; l += 4) {
            const Rows t = transpose(at(l, k), at(l + 1, k), at(l + 2, k), at(l + 3, k));
            hn::StoreU(hn::BitCast(kU32, t.x), kU32, out + l);
            hn::StoreU(hn::BitCast(kU32, t.y), kU32, out + 8 + l);
            hn::StoreU(hn::BitCast(kU32, t.z), kU32, out + 16 + l);
            hn::StoreU(hn::BitCast(kU32, t.w), kU32, out + 24 + l);
        }
#endif
}

template <bool kMixed> void buildBlock(const ListArgs& a, ListScratch& s, int begin, int end, ListBlock& block) {
    const U32 dummy = hn::Set(kU32, 16 * static_cast<uint32_t>(a.count));
    const F32 limit = all(a.support * a.support);
    Candidates c;
    uint32_t key = ~0u;
    ListBlock done = block;
    done.needed = ListBlock::kSlack, done.neighbors = 0, done.most = 0, done.clipped = false;
    for (int g = begin; g < end; ++g) {
        int n[8], most = 0;
        for (int l = 0; l < 8; ++l) {
            const int i = 8 * g + l;
            n[l] = 0;
            if (i >= a.count) continue;
            if (a.cellOf[i] != key) key = collect<kMixed>(a, i, s, c) ? a.cellOf[i] : ~0u;
            const Self self{all(a.x[i]), all(a.y[i]), all(a.z[i]), all(a.h[i])};
            n[l] = c.count >= 0 ? scanCopied<kMixed>(s, c.count, i + c.shift, self, limit, s.row[l])
                                : scanInPlace<kMixed>(a, c, i, self, limit, s.row[l]);
            if (n[l] > Neighbors::kMaxNeighbors) n[l] = Neighbors::kMaxNeighbors, done.clipped = true;
            if (n[l] > most) most = n[l];
            done.neighbors += static_cast<uint32_t>(n[l]);
        }
        const uint32_t at = done.needed - ListBlock::kSlack;
        done.needed += 8 * static_cast<uint32_t>(most);
        if (static_cast<uint32_t>(most) > done.most) done.most = static_cast<uint32_t>(most);
        a.first[g] = block.offset + at;
        a.width[g] = static_cast<uint32_t>(most);
        if (!done.fits()) continue;
        for (int l = 0; l < 8; ++l)
            for (int k = n[l]; k < most; k += kLanes) hn::StoreU(dummy, kU32, s.row[l] + k);
        interleave(s.row, most, a.entries + block.offset + at);
    }
    block = done;
}

void buildListsAny(const ListArgs& a, ListScratch& s, int begin, int end, ListBlock& block) {
    if (a.support > 0)
        buildBlock<false>(a, s, begin, end, block);
    else
        buildBlock<true>(a, s, begin, end, block);
}

} // namespace HWY_NAMESPACE
} // namespace thaw
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace thaw {

HWY_EXPORT(buildListsAny);

void buildLists(const ListArgs& a, ListScratch& scratch, int begin, int end, ListBlock& block) {
    HWY_DYNAMIC_DISPATCH(buildListsAny)(a, scratch, begin, end, block);
}

} // namespace thaw
#endif
