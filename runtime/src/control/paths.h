// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "control/frame.h"
#include "control/path_line.h"

#include <memory>
#include <vector>

namespace thaw {

// A path that melt follows: thawPathDef made ready, and what it knows of the melt.
struct Path {
    bool alive = false, enabled = true;
    std::shared_ptr<const PathLine> line;
    uint32_t collider = 0; // index + 1 of the one it moves with; 0: it stands still
    float radius = 0, reach = 0, strength = 0, speed = 0, arrivalTime = 0, share = 1, beadSpacing = 0,
          startAbsorptivity = NAN;
    int priority = 0;

    double captured = 0, arrived = 0, spilled = 0; // kg, ever
    double mass = 0, distance = 0;                 // kg that follows it now; mean of it, m
    float front = 0;                               // m along it, of the foremost twentieth
    float asked = 0;                               // m/s, of the speed that it has now
    float boost = 0;                               // m/s, asked for above what was set, as the melt lags
    float bias = 0;                                // radii, at forks: for what got less than its share
    double phase = 0;                              // m that beads have come along it since it was made
    double since = -1, arrival = -1;               // s of its own time of the first capture and arrival; < 0: not yet
    double time = 0;                               // s that it has been on

    bool on() const { return alive && enabled && strength > 0; }
    void arrive(double kilograms);
    // m/s along it toward the middle of the bead that a place along it is in.
    float toBead(float along) const;
};

// Paths on which the flow is guided (thesis 3.5.1). What comes within reach of one follows it until it is at its end
// or a quarter farther away, and is driven toward the speed of the path and to the stream's core as by a drag. A
// deterministic eighth of what follows are control particles: they find what their surroundings lack of the path's
// velocity, on the mean of their neighbours, and all around them get that much, so that what is finer than a support
// stays (Thuerey, Keiser, Pauly, Ruede 2006).
class Paths {
public:
    explicit Paths(Allocator& allocator) : own_(allocator), mean_(allocator), hops_(allocator), distance_(allocator) {}

    std::vector<Path> paths; // by slot
    bool any() const;        // some are alive and on

    // Once a step: who follows what and where it is, and the controllers of speed and shares.
    void track(const ControlFrame& f);
    // Writes the drag (see Guide) of the movers that follow a path.
    void guide(const ControlFrame& f, Vec4* guide);
    // Nobody follows this one any more.
    void forget(Particles& particles, size_t slot);
    void state(StateIo& io);

private:
    struct Aim {
        Vec3 target, mean;
        float weight = 0;
    };
    bool capture(const ControlFrame& f, size_t row, Vec3 x);
    Aim aim(const ControlFrame& f, size_t row) const;
    void countHops(const ControlFrame& f);
    void steer(const ControlFrame& f);

    void pathState(StateIo& io, Path& p);

    std::vector<Path> stage_; // of an image that is read
    Array<Vec4> own_, mean_;  // of control particles; own_.w < 0: it is none
    Array<uint8_t> hops_;
    Array<float> distance_; // per mover, m from what it follows
};

} // namespace thaw
