// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/shelf.h"
#include "control/fill_flow.h"
#include "control/frame.h"
#include "control/region.h"

#include <vector>

namespace thaw {

struct Path;

// What a shape shall be filled in, and the cells of its flow as they were made.
struct ShapeForm {
    uint64_t key = 0;
    Region region;
    FillFlow flow;
    void state(StateIo& io);
};
using ShapeForms = Shelf<ShapeForm>;

// A shape that melt fills: thawShapeDef made ready, and what it knows of the melt.
struct Shape {
    bool alive = false, enabled = true, sets = true;
    std::shared_ptr<const ShapeForm> made;
    const Region& region() const { return made->region; }
    uint64_t form = 0; // of what the host made it from
    FillFlow flow;
    uint32_t collider = 0; // index + 1 of the one it moves with; 0: it stands still
    float reach = 0, depth = 0, thickness = 0, strength = 0, speed = 0, setFill = 1, setTime = 1;
    int priority = 0;

    double captured = 0, lost = 0;                                   // kg, ever
    double mass = 0, inside = 0, spilled = 0, set = 0, distance = 0; // kg now; m, mean of what is outside
    double astray = 0;                                               // kg of what is outside, that may still come
    double time = 0, since = -1, filledAfter = -1; // s that it has been on, of the first capture and until it was full
    uint64_t walls = 0;                            // version of the colliders that the flow's cells were looked at with
    uint32_t wallsLeft = 0;                        // shares of the cells that are still to be looked at
    double asleep = -1;                            // kg that obey it, if all had set when it was last filled
    float taken = 0;                               // m^3 that came to obey in this step
    double fresh = 0, coming = 0;                  // kg that came to obey since the last step; kg/s, mean of that
    bool setting = false;                          // it has been full: what is inside is cooled

    bool on() const { return alive && enabled && strength > 0; }
    bool closed() const { return setting && (thickness > 0 || !region().flat()); } // what is outside stays there
    bool holds() const { return on() && strength == 1; }
};

// Shapes that melt fills and sets in (thesis 3.5.2). All that comes within reach obeys: a potential flow brings it to
// where it is missing (FillFlow), at the rim it is held or brought back, and of its weight along the surface the shape
// carries what its strength is. Once it is full, what is inside is cooled until it sets.
class Shapes {
public:
    explicit Shapes(Allocator& allocator) : near_(allocator), walls_(allocator) {}

    std::vector<Shape> shapes; // by slot
    bool any() const;          // some are alive and on
    bool cools() const;        // some take heat from what is in them

    // Once a step: who obeys which, and what is missing where. What a shape takes from a path has arrived there.
    void track(const ControlFrame& f, std::vector<Path>& paths);
    // Writes how the movers that obey a shape are guided.
    void guide(const ControlFrame& f, const Guide& guide);
    bool hold() const;                      // some have a rim that holds what is in them
    bool move(const ControlFrame& f) const; // some move with their collider
    // Takes heat from what has filled a shape. Returns how much, J.
    double cool(const ControlFrame& f);
    // Makes room for so many colliders, so that looking for walls in a step takes none.
    void expectColliders(size_t count) { walls_.reserve(count); }
    // Which of a shape's cells lie in colliders: every `stride`th from `first` on.
    void findWalls(const ControlFrame& f, size_t slot, size_t first, size_t stride);
    // What there is in one, and how much room is left.
    void refill(const ControlFrame& f, size_t slot);
    // Nobody obeys this one any more.
    void forget(Particles& particles, size_t slot);
    void state(StateIo& io, const ShapeForms& forms);

private:
    struct Near {
        Vec3 outward;   // regional, of the rim
        float distance; // m, to the rim; > 0 outside
        uint16_t shape; // slot + 1 of the one that it obeys, 0: none
    };
    Near look(const ControlFrame& f, const std::vector<Path>& paths, size_t row) const;
    void fill(const ControlFrame& f, size_t slot);
    void aim(const ControlFrame& f, size_t row, const Guide& guide) const;

    std::vector<Shape> stage_;     // of an image that is read
    Array<Near> near_;             // per row
    bool fresh_ = false;           // they are of the rows and places of now
    Array<const Collider*> walls_; // near the shape in hand
};

} // namespace thaw
