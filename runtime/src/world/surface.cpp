// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/kernel.h"
#include "world/world.h"

#include <algorithm>

namespace thaw {
namespace {

void show(const SurfaceMesh& mesh, int level, thawSurfaceView& out) {
    out = {static_cast<int32_t>(mesh.positions.size()),
           static_cast<int32_t>(mesh.indices.size() / 3),
           mesh.positions.empty() ? nullptr : &mesh.positions[0].x,
           mesh.normals.empty() ? nullptr : &mesh.normals[0].x,
           mesh.temperatures.data(),
           mesh.liquidFractions.data(),
           mesh.materials.data(),
           mesh.bodies.data(),
           mesh.mixtures.empty() ? nullptr : mesh.mixtures[0].material,
           mesh.indices.data(),
           level};
}

} // namespace

// The particles, or the finest points in place of those that are coarse, which then are in the maker's rows.
SurfaceInput World::surfaceInput() {
    if (!anyCoarse_)
        return {particles.count,
                particles.position.data(),
                particles.temperature.data(),
                particles.liquidFraction.data(),
                particles.material.data(),
                particles.body.data(),
                def.particleSpacing};
    SurfaceMaker::Rows& rows = surface_.rows;
    rows.clear();
    const auto add = [&](size_t k, Vec3 x, float support) {
        rows.positions.push({x.x, x.y, x.z, support}), rows.temperatures.push(particles.temperature[k]);
        rows.liquidFractions.push(particles.liquidFraction[k]);
        rows.materials.push(particles.material[k]), rows.bodies.push(particles.body[k]);
    };
    const float finest = supportOf(def.particleSpacing, 0);
    for (size_t k = 0; k < static_cast<size_t>(particles.count); ++k) {
        if (particles.level[k] > 0 && particles.fine[k])
            reference_.forPoints(particles, k, [&](Vec3 x, uint32_t) { add(k, x, finest); });
        else
            add(k, particles.position[k].xyz(), particles.position[k].w);
    }
    return rows.input(def.particleSpacing);
}

// To the density a wall is filled up to its face (motion/walls.h), so no liquid lacks what is between it and its first
// layer, wherever that stands: drawn together by cohesion at 0.6 to 0.65 spacings, not at half of one. The mesh knows
// of no walls. So what stands off by too little for another layer is shown at half a spacing, and what is beyond so far
// off that nothing jumps. The film of butter in its pan lacks 8.1 % of its volume with this, 9.9 % without
// (`thaw validate surface scenes`).
void World::meetWalls(SurfaceInput& input) {
    constexpr float kFirst = 0.5f, kSecond = 0.75f, kFar = 1; // spacings off the wall
    constexpr int kRows = 128;
    if (std::none_of(colliders.begin(), colliders.end(), [](const Collider& c) { return c.alive; })) return;
    Array<Vec4>& shown = surface_.rows.positions;
    if (input.positions != shown.data()) {
        shown.resizeRaw(static_cast<size_t>(input.count));
        std::copy_n(input.positions, input.count, shown.data());
    }
    tasks.forBlocks(input.count, kRows, [&](int begin, int end, int, int) {
        Box around;
        float reach = 0;
        for (int i = begin; i < end; ++i) {
            const Vec4& x = shown[static_cast<size_t>(i)];
            around.grow(x.xyz()), reach = std::max(reach, kFar * x.w / kSupport);
        }
        WallFinder walls;
        walls.gather(colliders.data(), nullptr, static_cast<int>(colliders.size()), around, reach);
        if (walls.empty()) return;
        for (int i = begin; i < end; ++i) {
            Vec4& x = shown[static_cast<size_t>(i)];
            const float spacing = x.w / kSupport;
            Vec3 nearer;
            walls.forNear(x.xyz(), kFar * spacing, [&](float distance, Vec3 normal, const Collider&) {
                const float off = distance / spacing;
                if (!(off > kFirst && off < kFar)) return;
                const float to = kFirst + std::max(off - kSecond, 0.0f) * ((kFar - kFirst) / (kFar - kSecond));
                nearer += ((to - off) * spacing) * normal;
            });
            x.setXyz(x.xyz() + nearer);
        }
    });
    input.positions = shown.data();
}

SurfaceMaker::Wanted World::surfaceWanted(const thawSurfaceDef& d) const {
    return {def.particleSpacing, d.cellSize * SurfaceLevel::cells(plan.work.surfaceLevel), d.smoothing};
}

void World::learnSurface(int level) {
    const Surface& made = surface_.surface();
    const int64_t blocks = surface_.meshedBlocks();
    const SurfaceLevel::Made facts{level, surface_.milliseconds(), blocks,
                                   blocks > 0 ? static_cast<int64_t>(made.positions.size()) : 0};
    surfaceLevel_.learn(facts), surfaceUnits_.learn(facts);
}

void World::extractSurface(const thawSurfaceDef& d, thawSurfaceView& out) {
    SurfaceInput input = surfaceInput();
    meetWalls(input);
    const SurfaceMesh& mesh = surface_.extract(input, surfaceWanted(d), tasks);
    learnSurface(plan.work.surfaceLevel);
    show(mesh, plan.work.surfaceLevel, out);
}

void World::startSurface(const thawSurfaceDef& d) {
    SurfaceInput input = surfaceInput();
    if (!anyCoarse_) surface_.rows.copy(input), input = surface_.rows.input(def.particleSpacing);
    meetWalls(input);
    surface_.begin(surfaceWanted(d));
    startedLevel_ = plan.work.surfaceLevel;
}

void World::finishSurface(thawSurfaceView& out) {
    const SurfaceMesh& mesh = surface_.finish();
    learnSurface(startedLevel_);
    show(mesh, startedLevel_, out);
}

thawSplatView World::splats() {
    splats_.make({particles.count, particles.position.data(), particles.normal.data()}, tasks);
    if (particles.count == 0) return {};
    return {particles.count, &splats_.centers[0].x, &splats_.axes[0].x};
}

int World::chooseSurfaceLevel(SurfaceLevel& learnt, SurfaceLevel& units, const thawBudget& b) const {
    if (b.mode == thawBudget_work) return b.work.surfaceLevel;
    SurfaceLevel& level = b.mode == thawBudget_milliseconds ? learnt : units;
    return level.choose(b.surfaceMilliseconds, b.most.surfaceLevel, b.least.surfaceLevel);
}

} // namespace thaw
