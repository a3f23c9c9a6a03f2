// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world/surface_level.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

constexpr float kCells[] = {1, 1.25992105f, 1.58740105f, 2};
// What a level takes of the one before: between its vertices, 0.63, and its nodes, 0.5 (`thaw bench surface`).
constexpr float kOfFiner = 0.62f;
constexpr float kRoomy = 0.75f;  // of what it may take
constexpr int kFinerAfter = 60;  // meshes
constexpr float kFading = 0.99f; // in a mesh
// Nominal ms: of a quiet machine with 2 cores.
constexpr float kPerBlock = 0.012f, kPerVertex = 3e-4f;

float share(int level) { return std::pow(kOfFiner, float(level)); }

} // namespace

float SurfaceLevel::cells(int level) { return kCells[std::clamp(level, 0, kCoarsest)]; }

int SurfaceLevel::choose(float milliseconds, int finest, int coarsest) {
    coarsest = std::max(coarsest, finest);
    if (!(milliseconds > 0)) return level_ = finest;
    level_ = std::clamp(level_, finest, coarsest);
    int fits = finest;
    while (fits < coarsest && demand_ * share(fits) > milliseconds) ++fits;
    if (fits > level_) {
        level_ = fits, roomy_ = 0;
    } else if (level_ > finest && demand_ * share(level_ - 1) <= kRoomy * milliseconds) {
        if (++roomy_ >= kFinerAfter) --level_, roomy_ = 0;
    } else {
        roomy_ = 0;
    }
    return level_;
}

void SurfaceLevel::learn(const Made& made) {
    // The first of a level is all of it, which says nothing about those that follow.
    const bool first = made.level != lastLevel_;
    lastLevel_ = made.level;
    if (first) return;
    const float ms = prices_ == Prices::learnt ? made.milliseconds
                                               : kPerBlock * float(made.blocks) + kPerVertex * float(made.vertices);
    const float now = ms / share(made.level);
    // Of two: one that was interrupted says nothing.
    demand_ = std::max(kFading * demand_, std::min(now, last_));
    last_ = now;
}

void SurfaceLevel::state(StateIo& io) {
    io.report(demand_, last_);
    if (!io.hashes()) io.index(level_, kCoarsest + 1);
    io.report(lastLevel_, roomy_);
}

} // namespace thaw
