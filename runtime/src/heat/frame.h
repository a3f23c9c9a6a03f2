// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/tasks.h"
#include "geometry/colliders.h"
#include "neighbors/neighbors.h"
#include "particles/material.h"
#include "particles/particles.h"
#include "particles/reference.h"

namespace thaw {

// See thawHeatSourceDef.
struct HeatSource {
    Vec3 position;
    float power = 0, radius = 0; // W, m
    bool enabled = false, alive = false;
    thawHeatSourceType type = thawHeatSource_point;
    Quat rotation{};
    Vec3 size{};
    float temperature = 0, emissivity = 1, irradiance = 0; // K, 1, W/m^2

    bool operator==(const HeatSource& o) const;
    void state(StateIo& io);
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
    float rayRefresh; // share of the lit particles that may look anew
    int cycles;       // explicit sub-cycles of conduction at most
    int raysPerSource;
    uint64_t surfaceVersion;              // changes with the rows, their places and normals; 0: not known
    const thawRaySystem* rays;            // the host's, or null
    bool undercools = false;              // some material does
    int bodyCount = 0;                    // of which some may be gone; 0: bodies are not told apart
    const Reference* reference = nullptr; // null: no particle is coarse
    // Where the start of a path takes up more or less than its material: fades from the centre as 1 - (d / radius)^2.
    struct Spot {
        Vec3 center;
        float radius, absorptivity;
    };
    const Spot* spots = nullptr;
    int spotCount = 0;

    // Of a row for thermal radiation, 0..1.
    float absorptivityOf(size_t row) const {
        float a = absorptivity(particles.absorbs[row], materials[particles.material[row]].def.absorptivity);
        for (int s = 0; s < spotCount; ++s) {
            const Vec3 d = particles.position[row].xyz() - spots[s].center;
            const float fade = 1 - dot(d, d) / (spots[s].radius * spots[s].radius);
            if (fade > 0) a += fade * (spots[s].absorptivity - a);
        }
        return a;
    }
};

struct HeatStats {
    double absorbed = 0, contact = 0;  // J in this step, from sources and from walls
    double emitted = 0, convected = 0; // J, losses
    int rays = 0;
    int sleeping = 0;                 // rows that conduction left out
    int cyclesWanted = 0, passes = 0; // of conduction over all pairs: explicitly needed, done
    bool raysReduced = false;
};

} // namespace thaw
