// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/tasks.h"
#include "surface/mesh.h"
#include "surface/origins.h"
#include "surface/smooth.h"

namespace thaw {

// Shares of the materials that a vertex is made of: the four with the largest, of equals the one with the lower index.
void mixOf(const Origins& origins, const uint8_t* materials, SurfaceMesh::Mixture& out);

// Mixtures become the mean of themselves and their neighbours, twice: one particle of another material is no blotch
// with an edge of its own, and a particle is as wide as two cells.
class MixtureBlender {
public:
    using Mixture = SurfaceMesh::Mixture;

    explicit MixtureBlender(Allocator& a) : passes_{Array<Mixture>(a), Array<Mixture>(a)} {}

    static constexpr int kPasses = 2; // how far one vertex shows in another's, in edges
    // Of some spans; the others keep theirs.
    void blend(const MeshCorners& mesh, const Array<Mixture>& mixtures, const Array<MeshSpan>& spans, Tasks& tasks);
    // Of the last call, as long as the mixtures that were given.
    const Mixture* mixtures() const { return passes_[kPasses - 1].data(); }

private:
    Array<Mixture> passes_[kPasses];
};

} // namespace thaw
