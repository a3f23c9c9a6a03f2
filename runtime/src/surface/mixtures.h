// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/tasks.h"
#include "surface/mesh.h"
#include "surface/origins.h"
#include "surface/smooth_simd.h"

namespace thaw {

// Shares of the materials that a vertex is made of: the four with the largest, of equals the one with the lower index.
void mixOf(const Origins& origins, const uint8_t* materials, SurfaceMesh::Mixture& out);

// Mixtures become the mean of themselves and their neighbours, passes times: one particle of another material is no
// blotch with an edge of its own.
void blendMixtures(const MeshCorners& mesh, Array<SurfaceMesh::Mixture>& mixtures, Array<SurfaceMesh::Mixture>& scratch,
                   int passes, Tasks& tasks);

} // namespace thaw
