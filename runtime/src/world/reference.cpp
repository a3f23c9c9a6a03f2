// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// What a world keeps about the filling of its bodies, and whom it tells.
#include "world/world.h"

#include <algorithm>

namespace thaw {

LevelFrame World::levelFrame(const thawWork& work, float dt) {
    return {particles,
            neighbors_,
            reference_,
            materials.data(),
            tasks,
            def.particleSpacing,
            work.finestLevel,
            work.coarsestLevel,
            work.splits,
            steps_,
            nextId_,
            colliders.data(),
            static_cast<int>(colliders.size()),
            mayBeCoarse() ? coarsestOf_.data() : nullptr,
            motion_.densityErrors(),
            anySoft() ? &bonds_ : nullptr,
            dt};
}

bool World::mayBeCoarse() const {
    return std::any_of(coarsestOf_.begin(), coarsestOf_.end(), [](uint8_t coarsest) { return coarsest > 0; });
}

Vec3 World::refer(size_t slot, const std::vector<Vec3>& points, const Groups& groups, float volume, bool bends) {
    // How bare each point is where all of the body is fine.
    const int n = static_cast<int>(points.size());
    Particles fine(allocator);
    fine.allocate(n);
    fine.count = n;
    Box box;
    for (const Vec3& x : points) box.grow(x);
    const Vec3 center = 0.5f * (box.lower + box.upper);
    for (size_t i = 0; i < points.size(); ++i) {
        const Vec3 x = points[i] - center;
        fine.position[i] = {x.x, x.y, x.z, supportOf(def.particleSpacing, 0)}, fine.flags[i] = kFixed;
        fine.id[i] = static_cast<uint32_t>(i);
    }
    fine.pad();
    Neighbors lists(allocator);
    lists.sort(fine, tasks), lists.build(fine, tasks);
    Array<float> volumes(allocator), none(allocator);
    volumes.assign(points.size() + Particles::kPadding, volume), none.assign(points.size() + Particles::kPadding, 0);
    for (size_t i = points.size(); i < volumes.size(); ++i) volumes[i] = 0;
    lists.weigh(fine, volumes.data(), none.data(), tasks);
    std::vector<uint32_t> rowOf(points.size());
    for (uint32_t r = 0; r < points.size(); ++r) rowOf[fine.id[r]] = r;

    // Whole bricks, so that those of every body begin at a multiple of eight.
    const size_t begin = reference_.point.size(), end = begin + (points.size() + 7) / 8 * 8;
    reference_.point.resize(end), reference_.slope.resize(end);
    for (size_t place = 0; place < points.size(); ++place) {
        const uint32_t r = rowOf[groups.order[place]];
        const Vec3 x = fine.position[r].xyz(), g = lists.gradientSum[r].xyz();
        reference_.point[begin + place] = {x.x, x.y, x.z, lists.volumeFraction[r]};
        reference_.slope[begin + place] = {g.x, g.y, g.z, static_cast<float>(groups.levelOf(place))};
    }
    bodyPoints_[slot] = {static_cast<uint32_t>(begin), static_cast<uint32_t>(end)};
    // An elastic solid needs to know where its points were.
    if (bends || !reference_.home.empty()) {
        const size_t known = reference_.home.size();
        reference_.home.resize(end), reference_.homeSlope.resize(end);
        for (size_t k = known; k < end; ++k)
            reference_.home[k] = reference_.point[k], reference_.homeSlope[k] = reference_.slope[k];
    }
    return center;
}

void World::forget(size_t slot) {
    const PointRange gone = bodyPoints_[slot];
    const uint32_t count = gone.end - gone.begin;
    bodyPoints_[slot] = {};
    if (count == 0) return;
    const size_t kept = reference_.point.size() - count;
    for (size_t k = gone.begin; k < kept; ++k)
        reference_.point[k] = reference_.point[k + count], reference_.slope[k] = reference_.slope[k + count];
    reference_.point.resize(kept), reference_.slope.resize(kept);
    if (!reference_.home.empty()) {
        for (size_t k = gone.begin; k < kept; ++k)
            reference_.home[k] = reference_.home[k + count], reference_.homeSlope[k] = reference_.homeSlope[k + count];
        reference_.home.resize(kept), reference_.homeSlope.resize(kept);
    }
    for (PointRange& r : bodyPoints_)
        if (r.begin >= gone.end) r.begin -= count, r.end -= count;
    for (int i = 0; i < particles.count; ++i)
        if (uint32_t& fine = particles.fine[static_cast<size_t>(i)]; fine > gone.end) fine -= count;
}

} // namespace thaw
