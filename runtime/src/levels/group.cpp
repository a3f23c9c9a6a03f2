// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "levels/group.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

// Farthest point from the middle of a group of 2, 4, 8 in spacings: 0.5, 0.71, 0.87 on the lattice. What is more
// strewn would stand for a place where it is not.
constexpr float kFarthest[4] = {0, 0.72f, 1.05f, 1.3f};

struct Grouping {
    const std::vector<Vec3>& points;
    const std::vector<uint8_t>& kind;
    const FillLattice& lattice;
    Groups out;
    std::vector<uint32_t> byLevel[4];

    Vec3 middle(const uint32_t* begin, const uint32_t* end) const {
        double sum[3] = {};
        for (const uint32_t* i = begin; i < end; ++i)
            sum[0] += points[*i].x, sum[1] += points[*i].y, sum[2] += points[*i].z;
        const double n = static_cast<double>(end - begin);
        return {static_cast<float>(sum[0] / n), static_cast<float>(sum[1] / n), static_cast<float>(sum[2] / n)};
    }

    // Takes the most compact 2^level of the points of a brick to the front: the farthest leaves until so many are left.
    bool pick(std::vector<uint32_t>& brick, int level) const {
        const size_t size = size_t{1} << level;
        size_t n = brick.size();
        const auto farthest = [&](float& distance) {
            const Vec3 c = middle(brick.data(), brick.data() + n);
            size_t worst = 0;
            distance = -1;
            for (size_t k = 0; k < n; ++k)
                if (const float d = length(points[brick[k]] - c); d > distance) distance = d, worst = k;
            return worst;
        };
        float distance;
        for (; n > size; --n) {
            const auto worst = brick.begin() + static_cast<std::ptrdiff_t>(farthest(distance));
            std::rotate(worst, worst + 1, brick.begin() + static_cast<std::ptrdiff_t>(n));
        }
        farthest(distance);
        return distance <= kFarthest[level] * lattice.spacing;
    }

    // Halves by the longest extent, and so on: the order of a binary tree.
    void halve(uint32_t* begin, uint32_t* end) const {
        if (end - begin < 2) return;
        Box box;
        for (const uint32_t* i = begin; i < end; ++i) box.grow(points[*i]);
        const Vec3 e = box.upper - box.lower;
        const float slack = 0.05f * lattice.spacing; // a brick of the lattice is halved the same way everywhere
        const int axis = e.z >= e.y - slack && e.z >= e.x - slack ? 2 : e.y >= e.x - slack ? 1 : 0;
        const auto at = [&](uint32_t i) { return axis == 0 ? points[i].x : axis == 1 ? points[i].y : points[i].z; };
        std::sort(begin, end, [&](uint32_t a, uint32_t b) { return at(a) != at(b) ? at(a) < at(b) : a < b; });
        uint32_t* half = begin + (end - begin) / 2;
        halve(begin, half), halve(half, end);
    }

    struct Keyed {
        int64_t key;
        uint32_t point;
    };
    static int64_t keyOf(int64_t kind, const int64_t cell[3]) {
        for (int a = 0; a < 3; ++a) kind = (kind << 18) | ((cell[a] + (int64_t{1} << 17)) & ((int64_t{1} << 18) - 1));
        return kind;
    }
    static void order(std::vector<Keyed>& keyed) {
        std::sort(keyed.begin(), keyed.end(),
                  [](const Keyed& a, const Keyed& b) { return a.key != b.key ? a.key < b.key : a.point < b.point; });
    }
    void take(std::vector<uint32_t>& brick, int level) {
        const auto end = brick.begin() + (std::ptrdiff_t{1} << level);
        halve(brick.data(), brick.data() + (size_t{1} << level));
        byLevel[level].insert(byLevel[level].end(), brick.begin(), end);
        brick.erase(brick.begin(), end);
    }

    // Groups of 8 out of the bricks of two lattice planes a side; takes them out of `open`.
    void takeBricks(std::vector<uint32_t>& open) {
        std::vector<Keyed> keyed;
        keyed.reserve(open.size());
        for (const uint32_t i : open) {
            const Vec3 d = points[i] - lattice.origin;
            const float u[3] = {d.x / lattice.step.x, d.y / lattice.step.y, d.z / lattice.step.z};
            int64_t cell[3];
            for (int a = 0; a < 3; ++a) cell[a] = static_cast<int64_t>(std::floor(u[a] + 0.5f)) >> 1;
            keyed.push_back({keyOf(kind[i], cell), i});
        }
        order(keyed);
        open.clear();
        std::vector<uint32_t> brick;
        for (size_t k = 0; k < keyed.size();) {
            brick.clear();
            const int64_t key = keyed[k].key;
            for (; k < keyed.size() && keyed[k].key == key; ++k) brick.push_back(keyed[k].point);
            if (brick.size() >= 8 && pick(brick, 3)) take(brick, 3);
            open.insert(open.end(), brick.begin(), brick.end());
        }
    }

    // Of what the bricks left: the loneliest first, each with those nearest to it that are open, when they are compact.
    void takeNearest(std::vector<uint32_t>& open, int level) {
        const float cell = 2 * lattice.spacing;
        const auto cellOf = [&](uint32_t i, int64_t at[3]) {
            const Vec3 d = points[i] - lattice.origin;
            at[0] = static_cast<int64_t>(std::floor(d.x / cell)), at[1] = static_cast<int64_t>(std::floor(d.y / cell));
            at[2] = static_cast<int64_t>(std::floor(d.z / cell));
        };
        std::vector<Keyed> keyed;
        keyed.reserve(open.size());
        for (const uint32_t i : open) {
            int64_t at[3];
            cellOf(i, at);
            keyed.push_back({keyOf(kind[i], at), i});
        }
        order(keyed);
        std::vector<uint8_t> taken(points.size(), 0);
        struct Near {
            float distance;
            uint32_t point;
        };
        std::vector<Near> near;
        const auto gather = [&](uint32_t seed) { // the open ones around it, itself first
            near.clear();
            int64_t at[3];
            cellOf(seed, at);
            for (int64_t z = -1; z <= 1; ++z)
                for (int64_t y = -1; y <= 1; ++y)
                    for (int64_t x = -1; x <= 1; ++x) {
                        const int64_t other[3] = {at[0] + x, at[1] + y, at[2] + z}, key = keyOf(kind[seed], other);
                        auto k = std::lower_bound(keyed.begin(), keyed.end(), key,
                                                  [](const Keyed& a, int64_t v) { return a.key < v; });
                        for (; k != keyed.end() && k->key == key; ++k) {
                            const float d = length(points[k->point] - points[seed]);
                            if (!taken[k->point] && d < cell) near.push_back({d, k->point});
                        }
                    }
            std::sort(near.begin(), near.end(), [](const Near& a, const Near& b) {
                return a.distance != b.distance ? a.distance < b.distance : a.point < b.point;
            });
        };
        std::vector<Near> seeds; // distance: how many are near
        for (const uint32_t i : open) gather(i), seeds.push_back({static_cast<float>(near.size()), i});
        std::sort(seeds.begin(), seeds.end(), [](const Near& a, const Near& b) {
            return a.distance != b.distance ? a.distance < b.distance : a.point < b.point;
        });
        std::vector<uint32_t> brick;
        for (const Near& seed : seeds) {
            if (taken[seed.point]) continue;
            gather(seed.point);
            // Some more than are needed: the most compact of them, which may leave the seed out.
            const size_t size = size_t{1} << level;
            if (near.size() < size) continue;
            brick.clear();
            for (size_t k = 0; k < std::min(near.size(), size + size / 2); ++k) brick.push_back(near[k].point);
            if (!pick(brick, level)) continue;
            brick.resize(size);
            for (const uint32_t i : brick) taken[i] = 1;
            take(brick, level);
        }
        std::erase_if(open, [&](uint32_t i) { return taken[i] != 0; });
    }
};

} // namespace

Groups groupPoints(const std::vector<Vec3>& points, const std::vector<uint8_t>& kind, const FillLattice& lattice) {
    Grouping g{points, kind, lattice, {}, {}};
    std::vector<uint32_t> open;
    for (uint32_t i = 0; i < points.size(); ++i)
        if (kind[i] == kAlone)
            g.byLevel[0].push_back(i);
        else
            open.push_back(i);
    g.takeBricks(open);
    for (int level = 3; level > 0; --level) g.takeNearest(open, level);
    g.byLevel[0].insert(g.byLevel[0].end(), open.begin(), open.end());
    for (int level = 3; level >= 0; --level) {
        const std::vector<uint32_t>& from = g.byLevel[level];
        g.out.order.insert(g.out.order.end(), from.begin(), from.end());
        g.out.ends[level] = g.out.order.size();
    }
    return std::move(g.out);
}

} // namespace thaw
