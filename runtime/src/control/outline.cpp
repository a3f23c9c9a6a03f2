// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "control/outline.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

struct Edge {
    Flat a, b;
    float distance2(float x, float y) const {
        const float dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
        const float t = square > 0 ? std::clamp(((x - a.x) * dx + (y - a.y) * dy) / square, 0.0f, 1.0f) : 0;
        const float ex = x - a.x - t * dx, ey = y - a.y - t * dy;
        return ex * ex + ey * ey;
    }
};

} // namespace

float outlineDistance(const std::vector<Flat>& points, const int32_t* sizes, int contours, float cell, float margin,
                      size_t maxNodes, DistanceGrid& grid) {
    Box box;
    std::vector<Edge> edges;
    edges.reserve(points.size());
    for (int c = 0, first = 0; c < contours; first += sizes[c++])
        for (int k = 0; k < sizes[c]; ++k) {
            const Flat a = points[static_cast<size_t>(first + k)],
                       b = points[static_cast<size_t>(first + (k + 1) % sizes[c])];
            edges.push_back({a, b}), box.grow({a.x, a.y, 0});
        }
    const float width = box.upper.x - box.lower.x + 2 * margin, height = box.upper.y - box.lower.y + 2 * margin;
    cell = std::max(cell, std::sqrt(width * height / static_cast<float>(maxNodes)));
    cell = std::max(cell, std::max(width, height) / 8192); // of what is very long and thin
    grid = {};
    grid.cell = cell, grid.origin = {box.lower.x - margin, box.lower.y - margin, 0};
    grid.nx = static_cast<int>(std::ceil(width / cell)) + 1, grid.ny = static_cast<int>(std::ceil(height / cell)) + 1;
    grid.nz = 2;
    const int nx = grid.nx, ny = grid.ny;
    const size_t layer = static_cast<size_t>(nx) * static_cast<size_t>(ny);
    const auto placeX = [&](int i) { return grid.origin.x + static_cast<float>(i) * cell; };
    const auto placeY = [&](int j) { return grid.origin.y + static_cast<float>(j) * cell; };
    const auto node = [&](int i, int j) {
        return static_cast<size_t>(j) * static_cast<size_t>(nx) + static_cast<size_t>(i);
    };

    // Nearest edges: those that pass by a node, then from node to node.
    constexpr uint32_t kNone = 0xffffffffu;
    std::vector<uint32_t> nearest(layer, kNone);
    std::vector<float> square(layer, INFINITY);
    const auto offer = [&](int i, int j, uint32_t e) {
        if (e == kNone || i < 0 || j < 0 || i >= nx || j >= ny || nearest[node(i, j)] == e) return false;
        const float d = edges[e].distance2(placeX(i), placeY(j));
        if (!(d < square[node(i, j)])) return false;
        square[node(i, j)] = d, nearest[node(i, j)] = e;
        return true;
    };
    for (uint32_t e = 0; e < edges.size(); ++e) {
        const Edge& s = edges[e];
        const float way = std::hypot(s.b.x - s.a.x, s.b.y - s.a.y);
        const int steps = static_cast<int>(std::ceil(2 * way / cell)) + 1;
        for (int k = 0; k <= steps; ++k) {
            const float t = static_cast<float>(k) / static_cast<float>(steps);
            const int i = static_cast<int>((s.a.x + t * (s.b.x - s.a.x) - grid.origin.x) / cell),
                      j = static_cast<int>((s.a.y + t * (s.b.y - s.a.y) - grid.origin.y) / cell);
            for (int c = 0; c < 4; ++c) offer(i + (c & 1), j + (c >> 1), e);
        }
    }
    bool changed = true;
    for (int round = 0; changed && round < 8; ++round) {
        changed = false;
        const auto visit = [&](int i, int j, int step) {
            // The four neighbours that this sweep has seen.
            for (const auto& [di, dj] : {std::pair{-1, 0}, {-1, -1}, {0, -1}, {1, -1}})
                if (const int x = i + step * di, y = j + step * dj; x >= 0 && x < nx && y >= 0 && y < ny)
                    changed |= offer(i, j, nearest[node(x, y)]);
        };
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i) visit(i, j, 1);
        for (int j = ny - 1; j >= 0; --j)
            for (int i = nx - 1; i >= 0; --i) visit(i, j, -1);
    }

    // Inside: to the right of an odd number of edges.
    std::vector<std::vector<float>> crossings(static_cast<size_t>(ny));
    for (const Edge& s : edges) {
        const float low = std::min(s.a.y, s.b.y), high = std::max(s.a.y, s.b.y);
        int j = std::max(0, static_cast<int>((low - grid.origin.y) / cell) - 1);
        for (; j < ny && placeY(j) < high; ++j)
            if (placeY(j) >= low)
                crossings[static_cast<size_t>(j)].push_back(s.a.x +
                                                            (placeY(j) - s.a.y) / (s.b.y - s.a.y) * (s.b.x - s.a.x));
    }
    grid.values.resize(2 * layer);
    double inside = 0;
    for (int j = 0; j < ny; ++j) {
        std::vector<float>& at = crossings[static_cast<size_t>(j)];
        std::sort(at.begin(), at.end());
        for (size_t k = 0; k + 1 < at.size(); k += 2) inside += static_cast<double>(at[k + 1]) - at[k];
        size_t passed = 0;
        for (int i = 0; i < nx; ++i) {
            while (passed < at.size() && at[passed] <= placeX(i)) ++passed;
            const float d = std::sqrt(square[node(i, j)]);
            grid.values[node(i, j)] = grid.values[layer + node(i, j)] = passed % 2 ? -d : d;
        }
    }
    return static_cast<float>(inside * static_cast<double>(cell));
}

} // namespace thaw
