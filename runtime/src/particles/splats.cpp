// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "particles/splats.h"

#include "base/kernel.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

// Half axes in spacings. A ball of the volume of a particle has 0.62; in something flat it reaches half a spacing out
// of its layer and over the gaps to its neighbours.
constexpr float kRound = 0.62f, kFlat = 0.52f, kAlong = 1.0f;
constexpr int kTogether = 256;

struct Cell {
    int64_t x, y, z;
};
Cell cellOf(Vec3 p, float inverse) {
    const auto one = [&](float v) { return static_cast<int64_t>(std::floor(double(v) * double(inverse))); };
    return {one(p.x), one(p.y), one(p.z)};
}
// 21 bits each, those of neighbours along x one after the other; cells far apart that share a key are told apart by
// distance.
uint64_t keyOf(Cell c) {
    const auto part = [](int64_t v) { return static_cast<uint64_t>(v) & 0x1fffff; };
    return part(c.z) << 42 | part(c.y) << 21 | part(c.x);
}

} // namespace

void SplatShapes::make(const Input& input, Tasks& tasks) {
    const size_t count = size_t(std::max(input.count, 0));
    centers.resizeRaw(count), axes.resizeRaw(count);
    entries_.clear();
    float largest = 0;
    for (size_t i = 0; i < count; ++i) {
        const Vec4& p = input.positions[i];
        const float spacing = p.w / kSupport;
        centers[i] = {p.x, p.y, p.z, kRound * spacing};
        axes[i] = {0, 1, 0, kRound * spacing};
        if (const Vec3 n = input.normals[i].xyz(); !(dot(n, n) > 0.25f)) continue;
        entries_.push({0, uint32_t(i)});
        largest = std::max(largest, p.w);
    }
    if (entries_.empty()) return;
    const float inverse = 1 / largest;
    for (Entry& e : entries_) e.key = keyOf(cellOf(input.positions[e.row].xyz(), inverse));
    std::sort(entries_.begin(), entries_.end(),
              [](const Entry& a, const Entry& b) { return a.key != b.key ? a.key < b.key : a.row < b.row; });
    tasks.forBlocks(int(entries_.size()), kTogether, [&](int begin, int end, int, int) {
        for (int k = begin; k < end; ++k) shape(input, entries_[k].row, inverse);
    });
}

void SplatShapes::shape(const Input& input, uint32_t row, float inverseCell) {
    const Vec4& p = input.positions[row];
    const Vec3 x = p.xyz(), n = input.normals[row].xyz();
    Vec3 mean, turn;
    float weights = 0, others = 0;
    const auto take = [&](uint32_t j) {
        const Vec4& q = input.positions[j];
        const Vec3 d = q.xyz() - x, m = input.normals[j].xyz();
        const float reach = 0.5f * (p.w + q.w), r2 = dot(d, d) / (reach * reach), facing = dot(n, m);
        if (r2 >= 1 || facing <= 0) return;
        const float w = (1 - r2) * (1 - r2) * facing * facing;
        mean += w * d, turn += w * m, weights += w;
        if (j != row) others += w;
    };
    const Cell c = cellOf(x, inverseCell);
    for (int64_t dz = -1; dz <= 1; ++dz)
        for (int64_t dy = -1; dy <= 1; ++dy) {
            const uint64_t first = keyOf({c.x - 1, c.y + dy, c.z + dz}), last = keyOf({c.x + 1, c.y + dy, c.z + dz});
            const auto from = [&](uint64_t key) {
                return std::lower_bound(entries_.begin(), entries_.end(), key,
                                        [](const Entry& e, uint64_t k) { return e.key < k; });
            };
            if (first <= last) {
                for (const Entry* at = from(first); at != entries_.end() && at->key <= last; ++at) take(at->row);
                continue;
            }
            for (int64_t dx = -1; dx <= 1; ++dx) { // where 21 bits end
                const uint64_t key = keyOf({c.x + dx, c.y + dy, c.z + dz});
                for (const Entry* at = from(key); at != entries_.end() && at->key == key; ++at) take(at->row);
            }
        }
    // By itself it stays a ball; half a dozen around it make a surface.
    const float coherence = length(turn) / weights, company = std::clamp(others / 1.5f, 0.0f, 1.0f);
    const float flat = company * std::clamp((coherence - 0.75f) / 0.15f, 0.0f, 1.0f), spacing = p.w / kSupport;
    const Vec3 axis = normalizeOr(turn, n), center = x + (company * dot(mean, axis) / weights) * axis;
    centers[row] = {center.x, center.y, center.z, spacing * (kRound + flat * (kAlong - kRound))};
    axes[row] = {axis.x, axis.y, axis.z, spacing * (kRound + flat * (kFlat - kRound))};
}

} // namespace thaw
