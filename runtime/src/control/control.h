// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "control/paths.h"
#include "control/shapes.h"

namespace thaw {

// All that guides the melt of a world.
class Control {
public:
    explicit Control(Allocator& allocator)
        : paths_(allocator), shapes_(allocator), guide_(allocator), free_(allocator), rim_(allocator),
          rimVelocity_(allocator) {}

    std::vector<Path>& paths() { return paths_.paths; }
    const std::vector<Path>& paths() const { return paths_.paths; }
    std::vector<Shape>& shapes() { return shapes_.shapes; }
    const std::vector<Shape>& shapes() const { return shapes_.shapes; }
    bool any() const { return paths_.any() || shapes_.any(); }
    bool cools() const { return shapes_.cools(); }

    // Once a step: who obeys what. Returns the heat that shapes took, J.
    double track(const ControlFrame& f);
    // How the movers are guided, as MotionFrame has it. Valid until the rows are sorted.
    Guide guide(const ControlFrame& f);
    void forgetPath(Particles& particles, size_t slot) { paths_.forget(particles, slot); }
    // Looks which cells of a shape lie in colliders: once when it is new, a share of them in each step after.
    void findWalls(const ControlFrame& f, size_t shape) { shapes_.findWalls(f, shape, 0, 1); }
    void expectColliders(size_t count) { shapes_.expectColliders(count); }
    // How much room a shape has that is new, or another.
    void refill(const ControlFrame& f, size_t shape) { shapes_.refill(f, shape); }
    void forgetShape(Particles& particles, size_t slot) { shapes_.forget(particles, slot); }
    void state(StateIo& io, const ShapeForms& forms) { paths_.state(io), shapes_.state(io, forms); }

private:
    Paths paths_;
    Shapes shapes_;
    Array<Vec4> guide_, free_, rim_, rimVelocity_;
};

} // namespace thaw
