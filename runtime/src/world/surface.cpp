// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world/world.h"

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

SurfaceMaker::Wanted World::surfaceWanted(const thawSurfaceDef& d) const {
    return {def.particleSpacing, d.cellSize * SurfaceLevel::cells(plan.work.surfaceLevel), d.smoothing};
}

void World::learnSurface(int level) {
    const Surface& made = surface_.surface();
    const int64_t blocks = made.meshedBlocks() - meshedBlocks_;
    meshedBlocks_ += blocks;
    const SurfaceLevel::Made facts{level, surface_.milliseconds(), blocks,
                                   blocks > 0 ? static_cast<int64_t>(made.positions.size()) : 0};
    surfaceLevel_.learn(facts), surfaceUnits_.learn(facts);
}

void World::extractSurface(const thawSurfaceDef& d, thawSurfaceView& out) {
    const SurfaceMesh& mesh = surface_.extract(surfaceInput(), surfaceWanted(d), tasks);
    learnSurface(plan.work.surfaceLevel);
    show(mesh, plan.work.surfaceLevel, out);
}

void World::startSurface(const thawSurfaceDef& d) {
    if (const SurfaceInput now = surfaceInput(); !anyCoarse_) surface_.rows.copy(now);
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
