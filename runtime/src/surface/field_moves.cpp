// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/field.h"

#include <algorithm>
#include <cstring>
#include <numeric>

// A world sorts its rows: when one particle melts, all that are solid stand one row farther, and when the melt spreads,
// the cells that they are sorted by shift. A particle is known by what it is, wherever its row.

namespace thaw {
namespace {

uint32_t hashOf(const Vec4& p) {
    uint32_t bits[3];
    std::memcpy(bits, &p, sizeof bits);
    uint32_t h = bits[0] * 0x9E3779B1u;
    h = ((h >> 15) ^ h ^ bits[1]) * 0x85EBCA77u;
    h = ((h >> 13) ^ h ^ bits[2]) * 0xC2B2AE3Du;
    return h ^ (h >> 16);
}

} // namespace

// Which rows are not what they were the last time, and where it is that what they were has gone.
void SurfaceField::findFresh(const SurfaceInput& input, int count) {
    constexpr int kTogether = 32; // most are what they were
    const int before = int(positions_.size()), common = std::min(count, before);
    freshRows_.clear(), goneRows_.clear(), moves_.clear();
    const auto same = [&](int begin, int rows) {
        const size_t n = size_t(rows);
        return std::memcmp(&positions_[begin], &input.positions[begin], n * sizeof(Vec4)) == 0 &&
               std::memcmp(&materials_[begin], &input.materials[begin], n) == 0 &&
               std::memcmp(&bodies_[begin], &input.bodies[begin], n * sizeof(uint16_t)) == 0;
    };
    for (int begin = 0; begin < common; begin += kTogether) {
        const int end = std::min(begin + kTogether, common);
        if (same(begin, end - begin)) continue;
        for (int i = begin; i < end; ++i)
            if (!same(i, 1)) freshRows_.push(i), goneRows_.push(i);
    }
    for (int i = common; i < count; ++i) freshRows_.push(i);
    for (int i = common; i < before; ++i) goneRows_.push(i);
    if (freshRows_.empty() && goneRows_.empty()) return;
    rowsNow_.resizeRaw(positions_.size());
    std::iota(rowsNow_.begin(), rowsNow_.end(), 0);
    for (int32_t row : goneRows_) rowsNow_[row] = -1;
    if (!freshRows_.empty() && !goneRows_.empty()) findMoves(input);
}

void SurfaceField::findMoves(const SurfaceInput& input) {
    const auto same = [&](int32_t was, int32_t is) {
        return rowsNow_[was] < 0 && std::memcmp(&positions_[was], &input.positions[is], sizeof(Vec4)) == 0 &&
               materials_[was] == input.materials[is] && bodies_[was] == input.bodies[is];
    };
    const auto match = [&](auto&& find) {
        size_t left = 0;
        for (int32_t is : freshRows_) {
            const int32_t was = find(is);
            if (was < 0) {
                freshRows_[left++] = is;
            } else {
                rowsNow_[was] = is;
                moves_.push({was, is});
            }
        }
        freshRows_.resizeRaw(left);
        left = 0;
        for (int32_t row : goneRows_)
            if (rowsNow_[row] < 0) goneRows_[left++] = row;
        goneRows_.resizeRaw(left);
    };
    // Most stand about as far off as the one before, and need no table.
    constexpr int32_t kSteps[] = {0, 1, -1, 2, -2, 3, -3};
    int32_t off = 0;
    match([&](int32_t is) {
        for (int32_t step : kSteps)
            if (const int32_t was = is + off + step; was >= 0 && was < int32_t(positions_.size()) && same(was, is)) {
                off += step;
                return was;
            }
        return int32_t(-1);
    });
    if (freshRows_.empty() || goneRows_.empty()) return;

    size_t size = 256;
    while (size < 2 * goneRows_.size()) size *= 2;
    const uint32_t mask = uint32_t(size - 1);
    matches_.assign(size, -1);
    for (int32_t row : goneRows_) {
        uint32_t at = hashOf(positions_[row]) & mask;
        while (matches_[at] >= 0) at = (at + 1) & mask;
        matches_[at] = row;
    }
    match([&](int32_t is) {
        for (uint32_t at = hashOf(input.positions[is]) & mask; matches_[at] >= 0; at = (at + 1) & mask)
            if (same(matches_[at], is)) return matches_[at];
        return int32_t(-1);
    });
}

// What is known of particles comes to the rows that they have now.
void SurfaceField::moveRows(int count) {
    movedRows_.resizeRaw(moves_.size());
    for (size_t n = 0; n < moves_.size(); ++n) movedRows_[n] = rows_[moves_[n].from];
    rows_.resizeRaw(count);
    for (size_t n = 0; n < moves_.size(); ++n) rows_[moves_[n].to] = movedRows_[n];
}

} // namespace thaw
