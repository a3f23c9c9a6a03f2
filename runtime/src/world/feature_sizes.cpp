// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world/world.h"

namespace thaw {

// On rows and lists of its own: those of the world may be of before the last step, and must not be sorted anew by one
// who only looks.
const float* World::featureSizes() {
    const size_t n = static_cast<size_t>(particles.count);
    featureSizes_.assign(n + Particles::kPadding, 0);
    if (n == 0) return featureSizes_.data();
    Particles rows(allocator);
    rows.allocate(particles.count);
    rows.count = particles.count;
    for (size_t k = 0; k < n; ++k) {
        rows.position[k] = particles.position[k], rows.id[k] = static_cast<uint32_t>(k);
        rows.flags[k] = static_cast<uint8_t>((particles.flags[k] & kSurface) | kFixed); // one kind
        rows.feature[k] = {FeatureSize::kFar, FeatureSize::kFar, FeatureSize::kFar, 0};
    }
    rows.pad();
    Neighbors lists(allocator);
    lists.sort(rows, tasks), lists.build(rows, tasks);
    FeatureSize features(allocator);
    features.settle({rows, lists, tasks, def.particleSpacing, rows.count});
    const float unit = def.particleSpacing / FeatureSize::kUnits;
    for (size_t k = 0; k < n; ++k) featureSizes_[rows.id[k]] = unit * static_cast<float>(rows.feature[k].size);
    return featureSizes_.data();
}

} // namespace thaw
