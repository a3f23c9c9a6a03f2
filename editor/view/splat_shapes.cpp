// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "view/splat_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace thaw::view {

namespace {

// Half axes in spacings. A ball of the volume of a particle has 0.62; in something flat it reaches half a spacing out
// of its layer and over the gaps to its neighbours.
constexpr float kRound = 0.62f, kFlat = 0.52f, kAlong = 1.0f;
constexpr float kReach = 2.2f; // spacings, to neighbours on the surface

// Particles of the surface by cells of the search radius.
class Cells {
public:
    Cells(const thawParticleView& p, const std::vector<uint32_t>& rows, float cell) : inverse_(1 / cell) {
        for (const uint32_t row : rows) entries_.push_back({key(cellOf(p.positions + 4 * size_t(row))), row});
        std::sort(entries_.begin(), entries_.end(),
                  [](const Entry& a, const Entry& b) { return a.key != b.key ? a.key < b.key : a.row < b.row; });
    }
    template <class F> void around(const float* x, F&& f) const {
        const Cell c = cellOf(x);
        for (int64_t dz = -1; dz <= 1; ++dz)
            for (int64_t dy = -1; dy <= 1; ++dy)
                for (int64_t dx = -1; dx <= 1; ++dx) {
                    const uint64_t wanted = key({c.x + dx, c.y + dy, c.z + dz});
                    auto at = std::lower_bound(entries_.begin(), entries_.end(), wanted,
                                               [](const Entry& e, uint64_t k) { return e.key < k; });
                    for (; at != entries_.end() && at->key == wanted; ++at) f(at->row);
                }
    }

private:
    struct Cell {
        int64_t x, y, z;
    };
    struct Entry {
        uint64_t key;
        uint32_t row;
    };
    Cell cellOf(const float* x) const {
        const auto one = [&](float v) { return static_cast<int64_t>(std::floor(double(v) * double(inverse_))); };
        return {one(x[0]), one(x[1]), one(x[2])};
    }
    // 21 bits each; cells far apart that share a key are told apart by distance.
    static uint64_t key(Cell c) {
        const auto part = [](int64_t v) { return static_cast<uint64_t>(v) & 0x1fffff; };
        return part(c.x) << 42 | part(c.y) << 21 | part(c.z);
    }
    float inverse_;
    std::vector<Entry> entries_;
};

} // namespace

void makeSplatShapes(const thawParticleView& p, float spacing, std::vector<SplatShape>& out) {
    out.clear();
    const auto at = [](const float* v, size_t i) { return Vec3{v[4 * i], v[4 * i + 1], v[4 * i + 2]}; };
    const auto across = [&](size_t i) {
        return spacing * std::exp2(p.levels ? static_cast<float>(p.levels[i]) / 3 : 0.0f);
    };
    std::vector<uint32_t> rows;
    float largest = spacing;
    for (size_t i = 0; i < static_cast<size_t>(p.count); ++i) {
        const float s = across(i);
        out.push_back({at(p.positions, i), {0, 1, 0}, kRound * s, kRound * s});
        if (!p.normals || !(length(at(p.normals, i)) > 0.5f)) continue;
        rows.push_back(static_cast<uint32_t>(i));
        largest = std::max(largest, s);
    }
    const Cells cells(p, rows, kReach * largest);
    for (const uint32_t row : rows) {
        const Vec3 x = at(p.positions, row), n = at(p.normals, row);
        Vec3 mean{0, 0, 0}, turn{0, 0, 0};
        float weights = 0, others = 0;
        cells.around(p.positions + 4 * size_t(row), [&](uint32_t j) {
            const Vec3 d = at(p.positions, j) - x;
            const float reach = kReach * 0.5f * (across(row) + across(j)), r2 = dot(d, d) / (reach * reach);
            const Vec3 m = at(p.normals, j);
            const float facing = dot(n, m);
            if (r2 >= 1 || facing <= 0) return;
            const float w = (1 - r2) * (1 - r2) * facing * facing;
            mean = mean + d * w, turn = turn + m * w, weights += w;
            if (j != row) others += w;
        });
        // By itself it stays a ball; half a dozen around it make a surface.
        const float coherence = length(turn) / weights, company = std::clamp(others / 1.5f, 0.0f, 1.0f);
        const float flat = company * std::clamp((coherence - 0.75f) / 0.15f, 0.0f, 1.0f);
        const Vec3 axis = normalize(turn, n);
        SplatShape& shape = out[row];
        shape.center = x + axis * (company * dot(mean, axis) / weights);
        shape.axis = axis;
        shape.along = across(row) * (kRound + flat * (kAlong - kRound));
        shape.out = across(row) * (kRound + flat * (kFlat - kRound));
    }
}

} // namespace thaw::view
