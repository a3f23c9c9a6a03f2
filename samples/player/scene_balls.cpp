// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "scene_stage.h"

#include <algorithm>
#include <cmath>

namespace thaw::scene {

ParticleBalls::ParticleBalls(const Scene& scene, bool cut) : spacing_(scene.world.particleSpacing), cut_(cut) {
    for (const Material& material : scene.materials) absorptivity_.push_back(material.def.absorptivity);
}

void ParticleBalls::show(const thawParticleView& all, const float* sizes, PictureView mode, const view::Camera& camera,
                         view::Scene& scene) {
    if (middle_.empty()) {
        middle_.assign(3, 0);
        for (int i = 0; i < all.count; ++i)
            for (size_t a = 0; a < 3; ++a)
                middle_[a] += double(all.positions[4 * size_t(i) + a]) / std::max(all.count, 1);
    }
    // Upright, so that what runs down a side is cut along its way.
    const double way[2] = {double(camera.target.x - camera.eye.x), double(camera.target.z - camera.eye.z)};
    positions_.clear(), velocities_.clear(), temperatures_.clear(), values_.clear(), levels_.clear();
    scene.levelCounts = {};
    for (int i = 0; i < all.count; ++i) {
        const float *x = all.positions + 4 * size_t(i), *v = all.velocities + 4 * size_t(i);
        ++scene.levelCounts[all.levels[i]];
        if (cut_ && way[0] * (double(x[0]) - middle_[0]) + way[1] * (double(x[2]) - middle_[2]) < 0) continue;
        const float across = spacing_ * std::exp2(float(all.levels[i]) / 3);
        positions_.insert(positions_.end(), {x[0], x[1], x[2], 0.5f * across});
        velocities_.insert(velocities_.end(), v, v + 4);
        temperatures_.push_back(all.temperatures[i]), levels_.push_back(all.levels[i]);
        if (mode == PictureView::elfs) values_.push_back(1000 * sizes[i]);
        if (mode == PictureView::exposure) values_.push_back(all.normals[4 * size_t(i) + 3] / (across * across));
        if (mode == PictureView::absorptivity)
            values_.push_back(all.absorptivities[i] ? float(all.absorptivities[i] - 1) / 254
                                                    : absorptivity_[all.materials[i]]);
    }
    // One scale for all pictures, in whole spacings.
    if (sizes && !(featureHigh_ > 0) && all.count > 0)
        featureHigh_ = 1000 * spacing_ * std::ceil(*std::max_element(sizes, sizes + all.count) / spacing_);

    view_ = {};
    view_.count = int32_t(levels_.size());
    view_.positions = positions_.data(), view_.velocities = velocities_.data();
    view_.temperatures = temperatures_.data(), view_.levels = levels_.data();
    scene.particles = &view_;
    scene.particleValues = {};
    scene.particleValues.values = values_.data();
    switch (mode) {
    case PictureView::level:
        scene.particleColor = view::ParticleColor::level;
        break;
    case PictureView::velocity:
        scene.particleColor = view::ParticleColor::speed;
        break;
    case PictureView::elfs:
        scene.particleColor = view::ParticleColor::values;
        scene.particleValues = {values_.data(), "ELFS", "mm", 0, featureHigh_, true};
        break;
    case PictureView::exposure:
        // In squares of its spacing, which is what it has in something flat; about 3 by itself.
        scene.particleColor = view::ParticleColor::values;
        scene.particleValues = {values_.data(), "exposed", "x flat", 0, 3, false};
        break;
    case PictureView::absorptivity:
        scene.particleColor = view::ParticleColor::values;
        scene.particleValues = {values_.data(), "absorbed", "share", 0, 1, false};
        break;
    default:
        scene.particleColor = view::ParticleColor::temperature;
        break;
    }
}

} // namespace thaw::scene
