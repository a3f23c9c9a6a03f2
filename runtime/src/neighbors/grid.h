// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/types.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace thaw {

// Cells over the particles' bounding box, as wide as the largest support of their class (Neighbors). A box that would
// need too many cells is folded: along such an axis the cells repeat like a torus. Rows from afar then share a cell and
// only cost a distance test; with at least four cells an axis, the three cells that a search visits are still different
// ones.
struct CellGrid {
    struct Range {
        uint32_t begin, end; // rows
    };
    static constexpr int kMaxRanges = 18;
    // Of a box as wide as a cell of twice the width and as far beyond as two such supports reach: 7 x 7 rows of cells,
    // each folded once.
    static constexpr int kMaxBoxRanges = 98;

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

    // Of a grid that is not folded: the cell's box, a little larger than what is in it.
    void boxOf(const int cell[3], double* low, double* high) const {
        for (int a = 0; a < 3; ++a) {
            low[a] = origin[a] + (cell[a] - 1e-6) / inverseCell;
            high[a] = origin[a] + (cell[a] + 1 + 1e-6) / inverseCell;
        }
    }

    // The rows of a cell and the 26 around it, ranges that are not empty, in ascending order; start: of one class, per
    // cell the first row, one more than cells.
    int ranges(const uint32_t* start, const int cell[3], Range* out) const {
        int xs[2][2], spans = 0; // runs of cells along x
        const int left = cell[0] - 1, right = cell[0] + 1;
        if (!folded[0]) {
            xs[0][0] = std::max(left, 0), xs[0][1] = std::min(right, cells[0] - 1);
            spans = xs[0][0] <= xs[0][1] ? 1 : 0;
        } else if (left < 0) {
            xs[0][0] = 0, xs[0][1] = right, xs[1][0] = xs[1][1] = cells[0] - 1, spans = 2;
        } else if (right == cells[0]) {
            xs[0][0] = xs[0][1] = 0, xs[1][0] = left, xs[1][1] = cells[0] - 1, spans = 2;
        } else {
            xs[0][0] = left, xs[0][1] = right, spans = 1;
        }
        int n = 0;
        for (int dz = -1; dz <= 1; ++dz) {
            const int cz = wrapped(2, cell[2] + dz);
            if (cz < 0) continue;
            for (int dy = -1; dy <= 1; ++dy) {
                const int cy = wrapped(1, cell[1] + dy);
                if (cy < 0) continue;
                for (int s = 0; s < spans; ++s) n = insert(start, cz, cy, xs[s][0], xs[s][1], out, n);
            }
        }
        return n;
    }

    // The same for the cells that a box touches; at most kMaxBoxRanges for one no wider than said there.
    int boxRanges(const uint32_t* start, const double low[3], const double high[3], Range* out) const {
        int from[3], count[3];
        for (int a = 0; a < 3; ++a) {
            double first = std::floor((low[a] - origin[a]) * inverseCell);
            double last = std::floor((high[a] - origin[a]) * inverseCell);
            if (!folded[a]) {
                first = std::max(first, 0.0), last = std::min(last, static_cast<double>(cells[a] - 1));
                if (!(first <= last)) return 0;
                from[a] = static_cast<int>(first), count[a] = static_cast<int>(last - first) + 1;
            } else if (!(last - first + 1 < cells[a])) {
                from[a] = 0, count[a] = cells[a];
            } else {
                const int64_t m = static_cast<int64_t>(std::clamp(first, -4e18, 4e18)) % cells[a];
                from[a] = static_cast<int>(m < 0 ? m + cells[a] : m), count[a] = static_cast<int>(last - first) + 1;
            }
        }
        const int right = from[0] + count[0] - 1;
        int n = 0;
        for (int z = 0, cz = from[2]; z < count[2]; ++z, cz = cz + 1 == cells[2] ? 0 : cz + 1)
            for (int y = 0, cy = from[1]; y < count[1]; ++y, cy = cy + 1 == cells[1] ? 0 : cy + 1) {
                if (right >= cells[0]) n = insert(start, cz, cy, 0, right - cells[0], out, n);
                n = insert(start, cz, cy, from[0], std::min(right, cells[0] - 1), out, n);
            }
        return n;
    }

private:
    // Adds the rows of a run of cells along x to n ranges in ascending order; returns how many there are now.
    int insert(const uint32_t* start, int z, int y, int left, int right, Range* out, int n) const {
        const uint32_t* row =
            start + (static_cast<size_t>(z) * static_cast<size_t>(cells[1]) + static_cast<size_t>(y)) *
                        static_cast<size_t>(cells[0]);
        const Range rows{row[left], row[right + 1]};
        if (rows.begin == rows.end) return n;
        int k = n;
        for (; k > 0 && out[k - 1].begin > rows.begin; --k) out[k] = out[k - 1];
        out[k] = rows;
        return n + 1;
    }
    // -1: there is no such cell.
    int wrapped(int axis, int c) const {
        if (c >= 0 && c < cells[axis]) return c;
        if (!folded[axis]) return -1;
        return c < 0 ? c + cells[axis] : c - cells[axis];
    }
};

} // namespace thaw
