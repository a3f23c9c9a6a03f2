// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/field.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

// Fill at a particle (its own share included) from which it is not lifted. On a lattice: bulk 0.98, face 0.83, edge
// 0.70, one-particle sheet 0.68, corner 0.58, thread 0.45, pair 0.36, alone 0.27.
constexpr float kFullCompany = 0.83f;
constexpr int kEnough = int(kFullCompany / kFillUnit);
// Most that is made up for: a particle alone. On cells so coarse that the kernel is widened there would be no end to
// it.
constexpr float kMaxMissing = 3.1f;

// How much a particle counts for what it misses. The second factor is fitted to the volume of the mesh, since marching
// cubes cut the corners off what is a few cells thick. Mesh volume over particle volume, mean over positions and
// directions, at cells of 0.25 / 0.5 / 0.75 / 1 spacing (tests/unit/surface_volume.cpp prints them): alone 0.85 / 0.95
// / 1.04 / 1.07, four 0.82 / 0.76 / 0.64 / 0.46, thread 1.15 / 1.13 / 1.08 / 0.97, sheet 1.19 at all.
float lift(float company, float cellPerRadius) {
    float missing = std::clamp(kFullCompany / company, 1.0f, kMaxMissing);
    return missing * (1 + (0.9f * cellPerRadius * cellPerRadius - 0.08f) * (missing - 1));
}

} // namespace

// Company of the particles whose centre is in the block.
void SurfaceField::countCompany(int slot, const SurfaceInput& input) {
    // Where fill before lifting is enough everywhere around a particle, for which the eight nodes of its cell stand, so
    // is its company, without counting. That goes for all but those at the surface.
    NodeBits nodes;
    gatherBits(full_, slot, nodes);
    uint16_t full[kSide][kSide];
    for (int z = 0; z < kSide; ++z)
        for (int y = 0; y < kSide; ++y) {
            const unsigned all =
                nodes.rows[z][y] & nodes.rows[z][y + 1] & nodes.rows[z + 1][y] & nodes.rows[z + 1][y + 1];
            full[z][y] = uint16_t(all & all >> 1);
        }
    const int32_t* starts = binStarts_.data() + size_t(slot) * kBlockBins;
    const Block& block = blocks_[slot];
    const double perCell = 1 / cell_,
                 first[3] = {double(block.x) * kSide, double(block.y) * kSide, double(block.z) * kSide};
    constexpr int kTogether = 64;
    int which[kTogether], sums[kTogether];
    Runs runs;
    for (int bin = 0; bin < kBlockBins; ++bin)
        for (int k = starts[bin], end = starts[bin + 1]; k < end;) {
            int count = 0;
            Box box;
            for (; k < end && count < kTogether; ++k) {
                const Vec3 at{float(double(arrays_.x[k]) * perCell - first[0]),
                              float(double(arrays_.y[k]) * perCell - first[1]),
                              float(double(arrays_.z[k]) * perCell - first[2])};
                const auto cellOf = [](float v) { return std::min(int(v), kSide - 1); };
                if (full[cellOf(at.z)][cellOf(at.y)] >> cellOf(at.x) & 1)
                    setFull(rows_[sortedRows_[k]]);
                else
                    which[count++] = k, box.grow(at);
            }
            if (count == 0) continue;
            const float lower[3] = {box.lower.x, box.lower.y, box.lower.z},
                        upper[3] = {box.upper.x, box.upper.y, box.upper.z};
            runsAround(slot, lower, upper, runs);
            sumAround(arrays_, runs.begins, runs.ends, runs.count, which, count, sums);
            for (int n = 0; n < count; ++n) {
                const int at = which[n];
                setCompany(rows_[sortedRows_[at]], sums[n], {arrays_.x[at], arrays_.y[at], arrays_.z[at]}, input);
            }
        }
}

void SurfaceField::setFull(Row& row) {
    row.otherCompany = row.company != kFullCompany;
    row.company = kFullCompany, row.excess = 0;
}

void SurfaceField::markFull(int slot) {
    constexpr float kFull = 0.9f; // what the nodes do not see between them is less than the rest
    markInside(base_.data() + size_t(slot) * kNodes, nullptr, int32_t(kFull / unit_),
               full_.data() + size_t(slot) * kSide * kSide);
}

// Of a particle that has so much from those that are not large.
void SurfaceField::setCompany(Row& row, int sum, Vec3 at, const SurfaceInput& input) {
    for (size_t k = 0; k < large_.size() && sum < kEnough; ++k) {
        const Row& other = rows_[large_[k]];
        const Vec3 d = input.positions[large_[k]].xyz() - at;
        const float t = std::max(1 - dot(d, d) * other.inverse, 0.0f);
        sum += int(std::lrint(double(other.amplitude * t * t * t) / double(kFillUnit)));
    }
    if (sum >= kEnough) return setFull(row);
    const float company = float(sum) * kFillUnit;
    row.otherCompany = company != row.company;
    row.company = company;
    row.excess = row.amplitude * (lift(company, float(cell_) * std::sqrt(row.inverse)) - 1);
}

void SurfaceField::countCompanyOfLarge(const SurfaceInput& input) {
    const int begin = 0, end = int(rows_.size() - large_.size());
    for (int k = end; k < int(rows_.size()); ++k) {
        const Vec3 at{arrays_.x[k], arrays_.y[k], arrays_.z[k]};
        int sum = 0;
        sumAround(arrays_, &begin, &end, 1, &k, 1, &sum);
        setCompany(rows_[sortedRows_[k]], sum, at, input);
    }
}

} // namespace thaw
