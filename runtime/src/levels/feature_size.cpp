// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "levels/feature_size.h"

#include "base/kernel.h"

#include <algorithm>
#include <atomic>

namespace thaw {
namespace {

constexpr int kRowBlock = 512;
// How much deeper than the way to it a neighbour is that leads away from the surface. In a slab, a ball, and a liquid
// at rest the best neighbour gains 0.8 to 1 of the way off the medial axis, up to 0.3 on it; along the diagonal of a
// cube's corner 0.58.
constexpr float kAscent = 0.4f;

// The same for the neighbours' neighbours, up to four spacings away, in spacings: where rows are strewn, one may have
// no way up though it is far from the axis.
constexpr float kRise = 1.75f;
// A surface row has at least this share of such rows around it: on a plane it is a half. The holes in a liquid's inside
// that pass for surface are alone, and each would make a thin place of a thick one.
constexpr float kCompany = 0.2f;
// And a row among so many is one of a film, though it may have too many neighbours to be told as bare; in the middle of
// three layers it is 0.6.
constexpr float kFilm = 0.67f;

// Rows lie on the medial axis or up to half a spacing beside it: what is taken for their distance, in spacings.
constexpr float kOffAxis = 0.25f;

struct Nearest {
    float depth, medial, size;
    bool ascends = false, deeper = false;
    int rows = 0, surface = 0;
    uint8_t above = 0, farther = 0; // greatest depth of neighbours, and of theirs
};

} // namespace

int FeatureSize::relax(const FeatureFrame& f, uint32_t turn, uint32_t turns) {
    Particles& p = f.particles;
    next_.resizeRaw(static_cast<size_t>(f.rows));
    std::atomic<int> changed{0};
    const float unit = f.spacing / kUnits, perMeter = kUnits / f.spacing;
    const auto store = [](float v) { return static_cast<uint8_t>(std::min(v + 0.5f, static_cast<float>(kFar))); };
    f.tasks.forBlocks(f.rows, kRowBlock, [&](int begin, int end, int, int) {
        int different = 0;
        for (int r = begin; r < end; ++r) {
            const size_t i = static_cast<size_t>(r);
            const Feature old = p.feature[i];
            next_[i] = old;
            if (turns > 1 && (p.id[i] ^ turn) % turns != 0) continue;
            const Vec4 x = p.position[i];
            Nearest n{kFar, kFar, kFar};
            forNeighbors(f.neighbors, r, [&](uint32_t j) {
                if (j >= static_cast<uint32_t>(f.rows)) return false;
                const Feature other = p.feature[j];
                const float way = length(p.position[j].xyz() - x.xyz()) * perMeter;
                n.depth = std::min(n.depth, static_cast<float>(other.depth) + way);
                n.medial = std::min(n.medial, static_cast<float>(other.medial) + way);
                n.size = std::min(n.size, static_cast<float>(other.size) + way);
                n.above = std::max(n.above, other.depth), n.farther = std::max(n.farther, other.above);
                const float gain = static_cast<float>(other.depth) - static_cast<float>(old.depth);
                n.ascends |= gain > kAscent * way, n.deeper |= gain > 0;
                ++n.rows, n.surface += (p.flags[j] & kSurface) != 0;
                return true;
            });
            const float company = (p.flags[i] & kSurface) ? kCompany : kFilm;
            const bool bare = static_cast<float>(n.surface) >= company * static_cast<float>(n.rows) &&
                              (n.rows > 0 || (p.flags[i] & kSurface));
            // The layer behind a stair's step is surface as well, and what is behind that not deep: a surface row is
            // where it is thin only if all around it are surface.
            const bool leads =
                n.ascends || static_cast<float>(n.farther) > static_cast<float>(old.depth) + kRise * kUnits;
            if (!(bare ? n.deeper : leads)) n.medial = bare ? 0 : kOffAxis * kUnits;
            if (bare) {
                n.depth = 0.5f * x.w / (kSupport * unit);
                n.size = std::min(n.size, n.medial + 2 * n.depth);
            }
            next_[i] = {store(n.depth), store(n.medial), store(n.size), n.above};
            different += !(next_[i] == old);
        }
        changed.fetch_add(different, std::memory_order_relaxed);
    });
    std::copy(next_.begin(), next_.end(), p.feature.begin());
    return changed.load();
}

void FeatureSize::settle(const FeatureFrame& f, int most) {
    for (int pass = 0; pass < most; ++pass)
        if (relax(f, 0, 1) == 0) return;
}

} // namespace thaw
