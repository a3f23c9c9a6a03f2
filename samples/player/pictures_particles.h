// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "pictures.h"

#include "view/renderer.h"

#include <vector>

namespace thaw::player {

// Whether a view draws particles in place of the surface.
bool isOfParticles(PictureView view);

// The particles of a world as balls of half their spacing.
class ParticleBalls {
public:
    ParticleBalls() = default;
    // cut: only those behind the middle of what there is at first.
    ParticleBalls(const scene::Scene& scene, bool cut);
    // Puts them into a scene to be drawn, which reads them until the next call. Throws RunError.
    void show(thawWorld* world, PictureView mode, const view::Camera& camera, view::Scene& scene);

private:
    float spacing_ = 0, featureHigh_ = 0;
    bool cut_ = false;
    std::vector<double> middle_;      // x y z, of the first picture
    std::vector<float> absorptivity_; // of each material
    std::vector<float> positions_, velocities_, temperatures_, values_;
    std::vector<uint8_t> levels_;
    thawParticleView view_{};
};

} // namespace thaw::player
