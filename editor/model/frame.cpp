// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "model/frame.h"

namespace thaw::editor {

namespace {
template <class T> void take(std::vector<T>& to, const T* from, size_t count) {
    if (from)
        to.assign(from, from + count);
    else
        to.clear();
}
template <class T> const T* give(const std::vector<T>& v) { return v.empty() ? nullptr : v.data(); }
} // namespace

void MeltMesh::copy(const thawSurfaceView& from) {
    const size_t n = size_t(from.vertexCount);
    take(positions_, from.positions, 3 * n), take(normals_, from.normals, 3 * n);
    take(temperatures_, from.temperatures, n), take(liquid_, from.liquidFractions, n);
    take(materials_, from.materials, n), take(mixtures_, from.mixtures, 8 * n);
    take(bodies_, from.bodies, n);
    take(indices_, from.indices, 3 * size_t(from.triangleCount));
    level_ = from.level;
}

thawSurfaceView MeltMesh::view() const {
    thawSurfaceView out{};
    out.vertexCount = int32_t(positions_.size() / 3), out.triangleCount = int32_t(indices_.size() / 3);
    out.positions = give(positions_), out.normals = give(normals_);
    out.temperatures = give(temperatures_), out.liquidFractions = give(liquid_);
    out.materials = give(materials_), out.mixtures = give(mixtures_), out.bodies = give(bodies_);
    out.indices = give(indices_), out.level = level_;
    return out;
}

void MeltParticles::copy(const thawParticleView& from, const float* featureSizes) {
    const size_t n = size_t(from.count);
    moving_ = from.moving;
    take(positions_, from.positions, 4 * n), take(velocities_, from.velocities, 4 * n);
    take(temperatures_, from.temperatures, n), take(liquid_, from.liquidFractions, n);
    take(normals_, from.normals, 4 * n), take(ids_, from.ids, n), take(bodies_, from.bodies, n);
    take(materials_, from.materials, n), take(flags_, from.flags, n);
    take(absorptivities_, from.absorptivities, n), take(levels_, from.levels, n);
    take(features_, featureSizes, n);
}

void MeltParticles::copySplats(const thawSplatView& from) {
    take(centers_, from.centers, 4 * size_t(from.count)), take(axes_, from.axes, 4 * size_t(from.count));
}

void MeltParticles::clear() {
    copy({}, nullptr);
    copySplats({});
}

thawParticleView MeltParticles::view() const {
    thawParticleView out{};
    out.count = int32_t(temperatures_.size()), out.moving = moving_;
    out.positions = give(positions_), out.velocities = give(velocities_);
    out.temperatures = give(temperatures_), out.liquidFractions = give(liquid_), out.normals = give(normals_);
    out.ids = give(ids_), out.bodies = give(bodies_), out.materials = give(materials_), out.flags = give(flags_);
    out.absorptivities = give(absorptivities_), out.levels = give(levels_);
    return out;
}

thawSplatView MeltParticles::splats() const {
    thawSplatView out{};
    out.count = int32_t(centers_.size() / 4), out.centers = give(centers_), out.axes = give(axes_);
    return out;
}

} // namespace thaw::editor
