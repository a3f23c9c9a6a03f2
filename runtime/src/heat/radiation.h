// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "heat/frame.h"

#include <memory>

namespace thaw {

// What the sources send to the surface: casts rays, the unknown and longest unseen first, and finds the power absorbed.
class Radiation {
public:
    explicit Radiation(Allocator& allocator); // Embree is started at the first run() that casts rays
    ~Radiation();

    void run(const HeatFrame& f, HeatStats& stats);
    const float* power() const; // per row, W absorbed, of the last run()

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace thaw
