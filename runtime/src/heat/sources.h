// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "heat/frame.h"

namespace thaw {

// A piece of surface that receives: where, which way it faces (unit; zero for a drop, which faces nowhere), and how
// large it is.
struct Receiver {
    Vec3 position, normal;
    float area; // m^2
    bool drop() const { return dot(normal, normal) < 0.25f; }
};

// Looked at with several rays.
inline bool hasExtent(thawHeatSourceType type) {
    return type == thawHeatSource_sphere || type == thawHeatSource_rectangle || type == thawHeatSource_disc;
}

// A source made ready for a step.
struct Emitter {
    thawHeatSourceType type;
    Vec3 center;
    Vec3 axis;          // local +y: the side that a rectangle or disc shines to, the way that directional light goes
    Vec3 across, along; // half edges of a rectangle, or two radii of a disc at right angles
    float radius;       // m
    float strength;     // point W, directional W/m^2, else net exitance in W/m^2; negative cools
    float extent;       // m, nothing of it is farther from the center
    int index;          // of its HeatSource
    bool area() const { return hasExtent(type); }
};

// Net exitance, power or irradiance; 0: it neither heats nor cools.
float strengthOf(const HeatSource& source, float ambient);
Emitter makeEmitter(const HeatSource& source, int index, float ambient);

// W/m^2 that the receiver gets when nothing is in the way; finite, and at most the exitance for sources with a
// temperature.
float irradiance(const Emitter& e, const Receiver& r);

// A point of the source to look at, for u, v in 0..1 (uniform), and how much of the irradiance comes from around it,
// not normalised: 0 when it is below the receiver's horizon or turned away.
struct Sample {
    Vec3 point;
    float weight;
};
Sample sample(const Emitter& e, const Receiver& r, float u, float v);
// The point of an area source that stands highest over the receiver's horizon.
Vec3 highest(const Emitter& e, const Receiver& r);

} // namespace thaw
