// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/field.h"

#include <algorithm>

// The order of particles within a bin shows in the last digits of what vertices take from them. It is that of their
// places, not of their rows, which change from frame to frame: then nothing changes around those that stay.

namespace thaw {
namespace {

constexpr int kPad = 8; // lanes that may be read past the particles

struct Place {
    float x, y, z;
    uint32_t row;
};

// Rows of a lattice that a world has sorted come in this order.
bool before(const Place& a, const Place& b) {
    if (a.z != b.z) return a.z < b.z;
    if (a.y != b.y) return a.y < b.y;
    if (a.x != b.x) return a.x < b.x;
    return a.row < b.row;
}

void sortPlaces(Place* places, int count) {
    constexpr int kFew = 24; // eight on a lattice
    if (count > kFew) {
        std::sort(places, places + count, before);
        return;
    }
    for (int k = 1; k < count; ++k) {
        const Place own = places[k];
        int to = k;
        for (; to > 0 && before(own, places[to - 1]); --to) places[to] = places[to - 1];
        places[to] = own;
    }
}

// Some rows in the order of their places; lent memory for what is more than usual.
template <class Row> void sortByPlace(const Vec4* positions, Row* rows, int count, Array<Vec4>& room) {
    static_assert(sizeof(Place) == sizeof(Vec4) && sizeof(Row) == sizeof(uint32_t));
    constexpr int kMost = 64;
    Place few[kMost];
    Place* places = few;
    if (count > kMost) room.resizeRaw(size_t(count)), places = reinterpret_cast<Place*>(room.data());
    for (int k = 0; k < count; ++k) {
        const Vec4& p = positions[rows[k]];
        places[k] = {p.x, p.y, p.z, uint32_t(rows[k])};
    }
    sortPlaces(places, count);
    for (int k = 0; k < count; ++k) rows[k] = Row(places[k].row);
}

} // namespace

// Large ones are in no bin; they stand at the end.
size_t SurfaceField::placeOf(const Row& row) const {
    return row.home >= 0 ? size_t(row.home) * kBlockBins + row.bin : blocks_.size() * kBlockBins;
}

void SurfaceField::layArrays(size_t count) {
    const size_t stride = count + kPad;
    sortedRows_.resizeRaw(stride), sorted_.resizeRaw(5 * stride);
    float* x = sorted_.data();
    arrays_ = {x, x + stride, x + 2 * stride, x + 3 * stride, x + 4 * stride};
    for (int a = 0; a < 5; ++a) std::fill_n(x + size_t(a) * stride + count, kPad, 0.0f);
    std::fill_n(sortedRows_.data() + count, kPad, 0u);
}

void SurfaceField::sortRows(const SurfaceInput& input) {
    const size_t count = rows_.size();
    layArrays(count);
    binStarts_.assign(blocks_.size() * kBlockBins + 2, 0);
    for (const Row& row : rows_)
        if (row.home >= 0) ++binStarts_[placeOf(row) + 2];
    mostInBin_ = 0;
    for (size_t b = 2; b < binStarts_.size(); ++b) {
        mostInBin_ = std::max(mostInBin_, binStarts_[b]);
        binStarts_[b] += binStarts_[b - 1];
    }
    for (size_t i = 0; i < count; ++i) sortedRows_[binStarts_[placeOf(rows_[i]) + 1]++] = uint32_t(i);
    for (size_t b = 0; b + 1 < binStarts_.size(); ++b)
        if (const int rows = binStarts_[b + 1] - binStarts_[b]; rows > 1)
            sortByPlace(input.positions, sortedRows_.data() + binStarts_[b], rows, places_);
    for (size_t k = 0; k < count; ++k) layOne(input, k);
    lastSorted_.resizeRaw(sorted_.size()), lastSortedRows_.resizeRaw(sortedRows_.size()); // nothing to take later
}

void SurfaceField::layOne(const SurfaceInput& input, size_t place) {
    const size_t stride = rows_.size() + kPad, i = sortedRows_[place];
    const Vec4& p = input.positions[i];
    float* to = sorted_.data() + place;
    to[0] = p.x, to[stride] = p.y, to[2 * stride] = p.z;
    to[3 * stride] = rows_[i].inverse, to[4 * stride] = rows_[i].amplitude;
}

// The same from what the order was the last time: without what is gone, with what is fresh. There are no large ones.
void SurfaceField::mergeRows(const SurfaceInput& input) {
    const size_t count = rows_.size(), bins = blocks_.size() * kBlockBins, last = positions_.size() + kPad;
    binStarts_.swap(lastStarts_), sortedRows_.swap(lastSortedRows_), sorted_.swap(lastSorted_);
    layArrays(count);

    freshStarts_.assign(bins + 2, 0);
    for (int32_t i : freshRows_) ++freshStarts_[placeOf(rows_[i]) + 2];
    for (size_t b = 2; b < bins + 2; ++b) freshStarts_[b] += freshStarts_[b - 1];
    sortedFresh_.resizeRaw(freshRows_.size());
    for (int32_t i : freshRows_) sortedFresh_[freshStarts_[placeOf(rows_[i]) + 1]++] = i;

    float* to = sorted_.data();
    const float* from = lastSorted_.data();
    const size_t stride = count + kPad;
    const bool moved = rowsMoved();
    int32_t place = 0;
    const auto keep = [&](int32_t begin, int32_t end) {
        if (begin == end) return;
        const size_t n = size_t(end - begin);
        for (int a = 0; a < 5; ++a) std::copy_n(from + size_t(a) * last + begin, n, to + size_t(a) * stride + place);
        if (moved)
            for (size_t k = 0; k < n; ++k)
                sortedRows_[size_t(place) + k] = uint32_t(rowsNow_[lastSortedRows_[size_t(begin) + k]]);
        else
            std::copy_n(lastSortedRows_.data() + begin, n, sortedRows_.data() + place);
        place += int32_t(n);
    };
    const auto add = [&](int32_t i) {
        sortedRows_[place] = uint32_t(i);
        layOne(input, size_t(place++));
    };
    const auto placeAt = [&](int32_t k) {
        const size_t at = size_t(k);
        return Place{from[at], from[last + at], from[2 * last + at], uint32_t(rowsNow_[lastSortedRows_[at]])};
    };

    binStarts_.resizeRaw(bins + 2);
    mostInBin_ = 0;
    const size_t lastBins = lastStarts_.size() - 2;
    int32_t kept = 0; // of the last order, up to here all is in its place
    for (size_t b = 0; b < bins; ++b) {
        binStarts_[b] = place;
        const int32_t end = lastStarts_[std::min(b + 1, lastBins)];
        int32_t fresh = freshStarts_[b], k = kept;
        const int32_t freshEnd = freshStarts_[b + 1];
        if (freshEnd - fresh > 1) sortByPlace(input.positions, sortedFresh_.data() + fresh, freshEnd - fresh, places_);
        for (; k < end; ++k) {
            const bool gone = rowsNow_[lastSortedRows_[size_t(k)]] < 0;
            if (!gone && fresh == freshEnd) continue;
            if (!gone) {
                const Place own = placeAt(k);
                const auto goesBefore = [&](int32_t i) {
                    const Vec4& p = input.positions[i];
                    return before({p.x, p.y, p.z, uint32_t(i)}, own);
                };
                if (!goesBefore(sortedFresh_[fresh])) continue;
                keep(kept, k), kept = k;
                while (fresh < freshEnd && goesBefore(sortedFresh_[fresh])) add(sortedFresh_[fresh++]);
            } else {
                keep(kept, k), kept = k + 1;
            }
        }
        keep(kept, end), kept = end;
        while (fresh < freshEnd) add(sortedFresh_[fresh++]);
        mostInBin_ = std::max(mostInBin_, place - binStarts_[b]);
    }
    binStarts_[bins] = binStarts_[bins + 1] = place;
    if (moved) orderTies(input);
}

// Of several in one place the order is that of their rows, and where it has changed what they reach is not what it was.
void SurfaceField::orderTies(const SurfaceInput& input) {
    const float *x = arrays_.x, *y = arrays_.y, *z = arrays_.z;
    const int32_t count = int32_t(rows_.size());
    for (int32_t begin = 0, end; begin < count; begin = end) {
        const auto tied = [&](int32_t k) { return x[k] == x[begin] && y[k] == y[begin] && z[k] == z[begin]; };
        for (end = begin + 1; end < count && tied(end);) ++end;
        if (std::is_sorted(sortedRows_.data() + begin, sortedRows_.data() + end)) continue;
        std::sort(sortedRows_.data() + begin, sortedRows_.data() + end);
        for (int32_t k = begin; k < end; ++k) {
            layOne(input, size_t(k));
            markAround(rows_[sortedRows_[k]]);
        }
    }
}

} // namespace thaw
