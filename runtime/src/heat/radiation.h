// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "heat/frame.h"

#include <memory>

namespace thaw {

// What the sources send to the surface. The irradiance is found anew in every step where something changed, in closed
// form; which share of a source is in sight is remembered, and looked at again, by rays, where it may have changed
// most.
class Radiation {
public:
    explicit Radiation(Allocator& allocator); // Embree is started at the first run() with something lit
    ~Radiation();

    void run(const HeatFrame& f, HeatStats& stats);
    const float* power() const; // per row, W absorbed, of the last run()
    // What the next run() compares with.
    void state(StateIo& io, const ColliderForms& forms, size_t rows, uint64_t surfaceVersion);
    bool names(uint64_t form) const; // its state does, of a collider's mesh

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace thaw
