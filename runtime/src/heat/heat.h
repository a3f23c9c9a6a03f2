// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "geometry/colliders.h"
#include "neighbors/neighbors.h"
#include "particles/material.h"
#include "particles/particles.h"

#include <memory>

namespace thaw {

struct HeatSource {
    Vec3 position;
    float power = 0, radius = 0; // W, m
    bool enabled = false, alive = false;
};

struct HeatFrame {
    Particles& particles;
    const Neighbors& neighbors;
    const float* volume; // per row, m^3, padded
    const Material* materials;
    const Collider* colliders;
    int colliderCount;
    uint64_t colliderVersion; // changes when a collider is made or destroyed
    const HeatSource* sources;
    int sourceCount;
    Tasks& tasks;
    double dt;        // s of heat time: step * thermalTimeScale * heatInterval
    float ambient;    // K
    float convection; // W/(m^2 K)
    float spacing;    // m
    float rayRefresh; // share of the exposed particles whose rays are cast anew
};

struct HeatStats {
    double absorbed = 0, emitted = 0, convected = 0; // J in this step; emitted and convected are losses
    int rays = 0;
    bool raysReduced = false;
};

// Heat of one step. Each call is one stage, any but the last may be left out, in this order. Conduction and the
// exchange with the surroundings change the enthalpies one after the other (each monotone at any dt); what changed is
// booked, so that the ledger is exact. Temperatures and liquid fractions follow in integrate().
class Heat {
public:
    explicit Heat(Allocator& allocator); // throws std::bad_alloc; Embree is started at the first radiation
    ~Heat();

    void radiation(const HeatFrame& f);  // casts rays, the unknown and longest unseen first; finds the power absorbed
    void conduction(const HeatFrame& f); // pairwise antisymmetric; sub-cycles, then implicit when dt is long
    void loss(const HeatFrame& f);       // settles each surface particle with what it absorbs, emits, convects
    void integrate(const HeatFrame& f);  // absorbs if loss() did not; bounds; temperature, liquid fraction
    const HeatStats& stats() const { return stats_; }

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    HeatStats stats_;
};

} // namespace thaw
