// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "particles/splats.h"

#include <cmath>
#include <vector>

namespace thaw::test {

/// What the runtime makes of particles that a test made by hand; positions, normals and, if there, levels are read.
class ShapesOf {
public:
    ShapesOf(const thawParticleView& particles, float spacing) : tasks_(oneWorker()), shapes_(allocator_) {
        std::vector<Vec4> positions, normals;
        for (size_t i = 0; i < size_t(particles.count); ++i) {
            const float *p = particles.positions + 4 * i, *n = particles.normals + 4 * i;
            const float level = particles.levels ? float(particles.levels[i]) : 0;
            positions.push_back({p[0], p[1], p[2], 2.2f * spacing * std::exp2(level / 3)});
            normals.push_back({n[0], n[1], n[2], n[3]});
        }
        shapes_.make({particles.count, positions.data(), normals.data()}, tasks_);
    }
    thawSplatView view() const { return {int32_t(shapes_.centers.size()), &shapes_.centers[0].x, &shapes_.axes[0].x}; }

private:
    static thawTaskSystem oneWorker() {
        thawTaskSystem s{};
        s.workerCount = 1;
        return s;
    }
    Allocator allocator_;
    Tasks tasks_;
    SplatShapes shapes_;
};

} // namespace thaw::test
