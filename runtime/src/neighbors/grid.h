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

    // A cell and how many to its left and right, per axis, each 0 or 1.
    struct Reach {
        int cell[3], left[3] = {1, 1, 1}, right[3] = {1, 1, 1};
    };
    // The cells that hold all within `radius` of p, at most a cell's width.
    Reach reach(Vec3 p, float radius) const {
        const float at[3] = {p.x, p.y, p.z};
        Reach r;
        for (int a = 0; a < 3; ++a) {
            r.cell[a] = coordinate(a, at[a]);
            r.left[a] = coordinate(a, at[a] - radius) != r.cell[a];
            r.right[a] = coordinate(a, at[a] + radius) != r.cell[a];
        }
        return r;
    }

    // The rows of the cells of `r`, not empty, in ascending order; start: of one class, per cell the first row, one
    // more than cells.
    int ranges(const uint32_t* start, const Reach& r, Range* out) const {
        int xs[2][2], spans = 0; // runs of cells along x
        const int left = r.cell[0] - r.left[0], right = r.cell[0] + r.right[0];
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
        for (int dz = -r.left[2]; dz <= r.right[2]; ++dz) {
            int cz = wrapped(2, r.cell[2] + dz);
            if (cz < 0) continue;
            for (int dy = -r.left[1]; dy <= r.right[1]; ++dy) {
                int cy = wrapped(1, r.cell[1] + dy);
                if (cy < 0) continue;
                const uint32_t* row =
                    start + (static_cast<size_t>(cz) * static_cast<size_t>(cells[1]) + static_cast<size_t>(cy)) *
                                static_cast<size_t>(cells[0]);
                for (int s = 0; s < spans; ++s) {
                    const Range rows{row[xs[s][0]], row[xs[s][1] + 1]};
                    if (rows.begin == rows.end) continue;
                    int k = n++;
                    for (; k > 0 && out[k - 1].begin > rows.begin; --k) out[k] = out[k - 1];
                    out[k] = rows;
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
