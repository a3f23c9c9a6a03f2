// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "neighbors/neighbors.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

constexpr int kRowBlock = 512; // small, so that 10,000 rows are shared evenly

Vec4 lesser(const Vec4& a, const Vec4& b) {
    return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z, a.w < b.w ? a.w : b.w};
}
Vec4 greater(const Vec4& a, const Vec4& b) {
    return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z, a.w > b.w ? a.w : b.w};
}

// More cells than this are slower to clear and sum than the strangers in folded cells are to test.
int cellLimit(int particles) { return std::max(1 << 14, 4 * particles); }

// The largest support of each class: 2^(1/3) apart. The slack keeps what is rounded differently together.
void classBounds(float least, float most, float* bound) {
    constexpr float kRatio[GridSet::kMost] = {1, 1.25992105f, 1.58740105f, 2};
    const bool apart = most <= 2.0002f * least;
    for (int c = 0; c < GridSet::kMost; ++c) bound[c] = apart ? kRatio[c] * 1.0001f * least : most;
}
int classOf(float support, const float* bound) {
    int c = 0;
    while (c < GridSet::kMost - 1 && support > bound[c]) ++c;
    return c;
}

} // namespace

Neighbors::Neighbors(Allocator& a)
    : entries(a), gradient(a), first(a), width(a), volumeFraction(a), gradientSum(a), cellStart_(a), cellOf_(a),
      keys_(a), order_(a), bounds_(a), soa_(a), packed_(a), blocks_(a), redo_(a), scratch_(a) {}

void Neighbors::layGrid(const Particles& particles, Tasks& tasks) {
    const int n = particles.count;
    bounds_.resizeRaw(static_cast<size_t>(Tasks::blockCount(n, kRowBlock)));
    const Vec4* position = particles.position.data();
    tasks.forBlocks(n, kRowBlock, [&](int begin, int end, int block, int) {
        Vec4 lower = position[begin], upper = lower;
        for (int i = begin + 1; i < end; ++i) lower = lesser(lower, position[i]), upper = greater(upper, position[i]);
        bounds_[static_cast<size_t>(block)] = {lower, upper};
    });
    Vec4 lower = bounds_[0].lower, upper = bounds_[0].upper;
    for (const Bounds& b : bounds_) lower = lesser(lower, b.lower), upper = greater(upper, b.upper);
    minSupport_ = lower.w, maxSupport_ = upper.w;

    classBounds(minSupport_, maxSupport_, bound_);
    Bounds of[GridSet::kMost]; // of each class: its cells need not cover more
    for (Bounds& b : of) b = {{INFINITY, INFINITY, INFINITY, 0}, {-INFINITY, -INFINITY, -INFINITY, 0}};
    if (minSupport_ == maxSupport_) {
        of[0] = {lower, upper};
    } else {
        for (int i = 0; i < n; ++i) {
            Bounds& b = of[classOf(position[i].w, bound_)];
            b = {lesser(b.lower, position[i]), greater(b.upper, position[i])};
        }
    }
    grids_.count = 0, grids_.first[0] = 0;
    for (int c = 0; c < GridSet::kMost; ++c) {
        if (!(of[c].lower.x <= of[c].upper.x)) continue;
        const double low[3] = {of[c].lower.x, of[c].lower.y, of[c].lower.z};
        const double high[3] = {of[c].upper.x, of[c].upper.y, of[c].upper.z};
        slot_[c] = grids_.count;
        CellGrid& grid = grids_.grid[grids_.count];
        grids_.support[grids_.count] = std::min(bound_[c], maxSupport_);
        // A little wider than the support, so that no rounding puts two neighbours two cells apart.
        const double cell = static_cast<double>(grids_.support[grids_.count]) * 1.00001;
        grid.inverseCell = 1 / cell;
        double wanted[3];
        for (int k = 0; k < 3; ++k) {
            grid.origin[k] = low[k];
            wanted[k] = std::floor((high[k] - low[k]) / cell * (1 + 1e-12)) + 2; // at least one to spare
            grid.folded[k] = false;
        }
        while (wanted[0] * wanted[1] * wanted[2] > (cellLimit(n) >> c)) {
            int k = wanted[0] >= wanted[1] && wanted[0] >= wanted[2] ? 0 : wanted[1] >= wanted[2] ? 1 : 2;
            wanted[k] = std::ceil(wanted[k] / 2);
            grid.folded[k] = true;
        }
        for (int k = 0; k < 3; ++k) grid.cells[k] = static_cast<int>(wanted[k]);
        ++grids_.count;
        grids_.first[grids_.count] = grids_.first[grids_.count - 1] + static_cast<uint32_t>(grid.cellCount());
    }
}

void Neighbors::sort(Particles& particles, Tasks& tasks) {
    const int n = particles.count;
    const size_t rows = static_cast<size_t>(n);
    particles.moverCount = 0;
    grids_ = {};
    // Twice for movers and fixed, twice for all the classes, each of which may have half the cells of the one before.
    cellStart_.reserve(4 * static_cast<size_t>(cellLimit(particles.capacity)) + 2);
    if (n == 0) {
        minSupport_ = maxSupport_ = 0;
        cellStart_.assign(3, 0);
        cellOf_.clear();
        particles.pad();
        return;
    }
    layGrid(particles, tasks);

    const size_t cells = static_cast<size_t>(grids_.cellCount());
    keys_.resizeRaw(rows), cellOf_.resizeRaw(rows), order_.resizeRaw(rows);
    const Vec4* position = particles.position.data();
    const uint8_t* flags = particles.flags.data();
    uint32_t* keys = keys_.data();
    const bool several = grids_.count > 1;
    tasks.forBlocks(n, kRowBlock, [&](int begin, int end, int, int) {
        const uint32_t fixedOffset = static_cast<uint32_t>(cells);
        CellGrid g = grids_.grid[0];
        int last = 0;
        for (int i = begin; i < end; ++i) {
            const Vec4 p = position[i];
            if (several)
                if (const int c = slot_[classOf(p.w, bound_)]; c != last) g = grids_.grid[c], last = c;
            int x, y, z;
            if (g.folded[0] || g.folded[1] || g.folded[2]) {
                x = g.coordinate(0, p.x), y = g.coordinate(1, p.y), z = g.coordinate(2, p.z);
            } else { // nothing lies below the origin, so truncation is the floor
                x = static_cast<int>((static_cast<double>(p.x) - g.origin[0]) * g.inverseCell);
                y = static_cast<int>((static_cast<double>(p.y) - g.origin[1]) * g.inverseCell);
                z = static_cast<int>((static_cast<double>(p.z) - g.origin[2]) * g.inverseCell);
            }
            keys[i] = static_cast<uint32_t>((z * g.cells[1] + y) * g.cells[0] + x) + grids_.first[last] +
                      ((flags[i] & kFixed) ? fixedOffset : 0);
        }
    });

    // Counting sort. start[k + 1] counts key k, then is where key k goes next, and at the end where key k + 1 begins.
    cellStart_.assign(2 * cells + 2, 0);
    uint32_t* start = cellStart_.data();
    bool sorted = true;
    uint32_t last = 0;
    for (size_t i = 0; i < rows; ++i) {
        sorted &= keys[i] >= last;
        last = keys[i];
        ++start[last + 1];
    }
    if (sorted) {
        uint32_t sum = 0;
        for (size_t k = 1; k < 2 * cells + 2; ++k) sum += start[k], start[k] = sum;
        cellOf_.swap(keys_);
    } else {
        uint32_t sum = 0;
        for (size_t k = 1; k < 2 * cells + 2; ++k) {
            uint32_t c = start[k];
            start[k] = sum;
            sum += c;
        }
        uint32_t *order = order_.data(), *cellOf = cellOf_.data();
        for (size_t i = 0; i < rows; ++i) {
            uint32_t to = start[keys[i] + 1]++;
            order[to] = static_cast<uint32_t>(i);
            cellOf[to] = keys[i];
        }
        tasks.forBlocks(n, kRowBlock, [&](int begin, int end, int, int) {
            // Most rows keep their neighbours in memory.
            struct Run {
                uint32_t to, from, count;
            };
            Run runs[kRowBlock];
            int runCount = 0;
            for (int i = begin; i < end; ++i) {
                if (i > begin && order[i] == order[i - 1] + 1)
                    ++runs[runCount - 1].count;
                else
                    runs[runCount++] = {static_cast<uint32_t>(i), order[i], 1};
            }
#define X(type, name)                                                                                                  \
    {                                                                                                                  \
        const type* from = particles.name.data();                                                                      \
        type* to = particles.name##Back.data();                                                                        \
        for (int r = 0; r < runCount; ++r) std::copy_n(from + runs[r].from, runs[r].count, to + runs[r].to);           \
    }
            THAW_PARTICLE_FIELDS(X)
#undef X
        });
#define X(type, name) particles.name.swap(particles.name##Back);
        THAW_PARTICLE_FIELDS(X)
#undef X
    }
    particles.moverCount = static_cast<int>(start[cells]);
    particles.pad();
}

} // namespace thaw
