// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/origins.h"

#include <algorithm>

namespace thaw {
namespace {

// Attributes come from nearer by than the fill does, 1.4 spacings: that is a vertex's own layer of particles, five or
// six of them.
constexpr float kSharper = (1.8f / 1.4f) * (1.8f / 1.4f);

} // namespace

void OriginFinder::look(int slot, const float lower[3], const float upper[3]) {
    slot_ = slot;
    field_.runsAround(slot, lower, upper, runs_);
    if (field_.largeCount() > 0) {
        runs_.begins[runs_.count] = field_.rowCount() - field_.largeCount();
        runs_.ends[runs_.count++] = field_.rowCount();
    }
    count_ = copyNear(field_.arrays(), field_.rowsOfArrays(), runs_.begins, runs_.ends, runs_.count,
                      field_.boxOf(slot, lower, upper), kSharper, near_, stride_, rows_);
}

// The particle that a point is deepest in the kernel of, or least far outside: of all those that reach the block, which
// is looked at again when they change. Those around the box are not all of them, and which ones they are has to do with
// what was meshed before.
uint32_t OriginFinder::deepest(Vec3 at) const {
    const FillArrays& from = field_.arrays();
    float best = INFINITY;
    uint32_t row = 0;
    field_.forAround(slot_, [&](int k) {
        const Vec3 d = Vec3{from.x[k], from.y[k], from.z[k]} - at;
        const float q = dot(d, d) * from.inverse[k];
        if (q < best && field_.reaches(field_.rowsOfArrays()[k], slot_)) best = q, row = field_.rowsOfArrays()[k];
    });
    return row;
}

int OriginFinder::find(Vec3 at, Origins& out) const {
    int n = weigh(near_, stride_, count_, at.x, at.y, at.z, weights_, which_);
    if (n == 0) {
        std::fill(out.row, out.row + Origins::kMost, deepest(at));
        std::fill(out.share, out.share + Origins::kMost, 0.0f);
        out.share[0] = 1;
        return 1;
    }
    for (; n > Origins::kMost; --n) { // without the least, of equals the last
        int least = 0;
        for (int k = 1; k < n; ++k)
            if (weights_[k] <= weights_[least]) least = k;
        std::copy(weights_ + least + 1, weights_ + n, weights_ + least);
        std::copy(which_ + least + 1, which_ + n, which_ + least);
    }
    float sum = 0;
    for (int k = 0; k < n; ++k) sum += weights_[k];
    for (int k = 0; k < n; ++k) out.row[k] = rows_[which_[k]], out.share[k] = weights_[k] / sum;
    for (int k = n; k < Origins::kMost; ++k) out.row[k] = out.row[0], out.share[k] = 0;
    return n;
}

} // namespace thaw
