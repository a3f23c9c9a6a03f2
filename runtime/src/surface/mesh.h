// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/types.h"

namespace thaw {

// What a host draws.
struct SurfaceMesh {
    struct Mixture { // the largest share first; shares sum to 255
        uint8_t material[4], share[4];
    };

    explicit SurfaceMesh(Allocator& a)
        : positions(a), normals(a), temperatures(a), liquidFractions(a), materials(a), bodies(a), mixtures(a),
          indices(a) {}
    void clear();
    void copy(const SurfaceMesh& from);

    Array<Vec3> positions, normals;
    Array<float> temperatures, liquidFractions;
    Array<uint8_t> materials;
    Array<uint16_t> bodies;
    Array<Mixture> mixtures;
    Array<uint32_t> indices; // three per triangle, counter-clockwise from outside
};

} // namespace thaw
