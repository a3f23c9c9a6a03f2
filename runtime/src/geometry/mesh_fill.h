// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/state_io.h"
#include "base/tasks.h"
#include "base/types.h"
#include "thaw/thaw.h"

#include <string>
#include <vector>

namespace thaw {

// A triangle mesh after welding and checking; double-checked orientation. Offline code: std containers are fine.
struct CleanMesh {
    std::vector<Vec3> vertices;    // world units, transform applied
    std::vector<uint32_t> indices; // three per triangle, outward
    Box bounds;
    thawMeshReport report{};
    bool watertight = false; // every edge is balanced: the winding number is whole everywhere
};

// Welds, drops degenerate triangles, orients outward. `to` maps the mesh into the world. On failure returns badMesh or
// invalidArgument and `message` names what is wrong (vertex number, value, open edges, volume).
thawResult cleanMesh(const thawMesh& mesh, const Transform& to, CleanMesh& out, std::string& message);

// Signed distance of a mesh on a regular grid, negative inside, trilinear between nodes. The sign comes from the
// generalised winding number (Jacobson et al. 2013; tree-accelerated after Barill et al. 2018), so small holes do not
// matter.
struct DistanceGrid {
    Vec3 origin;    // of node (0,0,0)
    float cell = 0; // m
    int nx = 0, ny = 0, nz = 0;
    std::vector<float> values; // nx*ny*nz, x fastest; exact at the nodes
    // Distance in m and unit gradient at p. Outside the grid: the distance to the surface point estimated from where
    // the grid's box is met. Infinity and +y when p is not finite or the grid is empty.
    float sample(Vec3 p, Vec3& gradient) const;
    float sample(Vec3 p) const;
    void state(StateIo& io);
};
// Grid that covers the bounds grown by `margin`. cell is enlarged when it would need more than maxNodes nodes.
DistanceGrid makeDistanceGrid(const CleanMesh& mesh, float cell, float margin, size_t maxNodes, Tasks& tasks);

// The cubic lattice that a filling started from: its planes lie at origin + k step.
struct FillLattice {
    Vec3 origin, step; // m
    float spacing = 0; // m
};

// Positions that fill the inside at `spacing`, about volume / spacing^3 of them: a cubic lattice inside, the outer four
// layers relaxed so that the outermost lies spacing/2 below the surface (0.3 at least, less only where the part is
// thinner than that) and no two are closer than 0.75 spacing. Surface points have a particle within about one spacing.
// Parts thinner than a spacing get a line or a layer, which may take more particles than their volume asks for. Each
// particle's volume is mesh volume / count (returned). Deterministic at any number of workers. On success `message` is
// empty, or says how much of the surface belongs to parts that are too thin for any particle. Refuses (badMesh) when
// nothing fits, naming volume and spacing; (capacity) when more than maxParticles are needed, naming both, or when the
// mesh is so large that looking through its box would take more than 2^27 bricks.
thawResult fillMesh(const CleanMesh& mesh, float spacing, int maxParticles, Tasks& tasks, std::vector<Vec3>& out,
                    float& particleVolume, std::string& message, FillLattice* lattice = nullptr);

} // namespace thaw
