// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/types.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace thaw {

// Cells over the particles' bounding box, as wide as the largest support. A box that would need too many cells is
// folded: along such an axis the cells repeat like a torus. Rows from afar then share a cell and only cost a distance
// test; with at least four cells an axis, the three cells that a search visits are still different ones.
struct CellGrid {
    struct Range {
        uint32_t begin, end; // rows
    };
    static constexpr int kMaxRanges = 18;

    double origin[3] = {0, 0, 0};
    double inverseCell = 0; // 1/m
    int cells[3] = {1, 1, 1};
    bool folded[3] = {false, false, false};

    int cellCount() const { return cells[0] * cells[1] * cells[2]; }

    // Double: 1e4 m from the origin a float is 1 mm, and two neighbours must never be two cells apart.
    int coordinate(int axis, float v) const {
        double t = std::floor((static_cast<double>(v) - origin[axis]) * inverseCell);
        if (folded[axis]) {
            t = std::clamp(t, -4e18, 4e18);
            int64_t m = static_cast<int64_t>(t) % cells[axis];
            return static_cast<int>(m < 0 ? m + cells[axis] : m);
        }
        return static_cast<int>(std::clamp(t, -2.0, static_cast<double>(cells[axis]) + 1)); // outside stays outside
    }

    // The rows of the 27 cells around (x, y, z) in ascending order, not empty; start: of one class, per cell the first
    // row, one more than cells.
    int ranges(const uint32_t* start, int x, int y, int z, Range* out) const {
        int xs[3][2], spans = 0; // runs of cells along x
        if (!folded[0]) {
            xs[0][0] = std::max(x - 1, 0), xs[0][1] = std::min(x + 1, cells[0] - 1);
            spans = xs[0][0] <= xs[0][1] ? 1 : 0;
        } else if (x == 0) {
            xs[0][0] = 0, xs[0][1] = 1, xs[1][0] = xs[1][1] = cells[0] - 1, spans = 2;
        } else if (x == cells[0] - 1) {
            xs[0][0] = 0, xs[0][1] = 0, xs[1][0] = x - 1, xs[1][1] = x, spans = 2;
        } else {
            xs[0][0] = x - 1, xs[0][1] = x + 1, spans = 1;
        }
        int n = 0;
        for (int dz = -1; dz <= 1; ++dz) {
            int cz = wrapped(2, z + dz);
            if (cz < 0) continue;
            for (int dy = -1; dy <= 1; ++dy) {
                int cy = wrapped(1, y + dy);
                if (cy < 0) continue;
                const uint32_t* row =
                    start + (static_cast<size_t>(cz) * static_cast<size_t>(cells[1]) + static_cast<size_t>(cy)) *
                                static_cast<size_t>(cells[0]);
                for (int s = 0; s < spans; ++s) {
                    Range r{row[xs[s][0]], row[xs[s][1] + 1]};
                    if (r.begin == r.end) continue;
                    int k = n++;
                    for (; k > 0 && out[k - 1].begin > r.begin; --k) out[k] = out[k - 1];
                    out[k] = r;
                }
            }
        }
        return n;
    }

private:
    // -1: there is no such cell.
    int wrapped(int axis, int c) const {
        if (c >= 0 && c < cells[axis]) return c;
        if (!folded[axis]) return -1;
        return c < 0 ? c + cells[axis] : c - cells[axis];
    }
};

} // namespace thaw
