// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "heat/contact.h"
#include "heat/frame.h"

namespace thaw {

// Conduction between particles, and with the walls that they touch, over one step: explicit sub-cycles, or implicit
// when the step is long.
class Conduction {
public:
    explicit Conduction(Allocator& a)
        : state(a), flow(a), weight(a), direction(a), residual(a), solution(a), heat(a), exchange(a), inverse(a),
          blockSums(a), extents(a), asleep(a), groupAsleep(a), axis(a), scaled(a), groupScaled(a) {}

    // walls: per row, or null. Returns what came in from them, J.
    double run(const HeatFrame& f, const WallContact* walls);
    int cyclesWanted() const { return wanted; } // of the last run, explicitly
    int passes() const { return done; }         // over all pairs
    int sleeping() const { return sleepers; }   // rows that the last run left out

private:
    struct Sums {
        double a, b;
        float low, high;
    };
    void pairPass(const HeatFrame& f, bool weights);
    void fillState(const HeatFrame& f);
    void scalePairs(const HeatFrame& f); // of bricks: see ConductionFactors
    double fastest(const HeatFrame& f);
    double explicitStep(const HeatFrame& f, double dt);
    double implicitStep(const HeatFrame& f);
    double fromWall(const HeatFrame& f, size_t k, double kelvin) const;
    template <class F> Sums sumRows(const HeatFrame& f, F&& row);

    // Of a body, and the walls that it touches.
    struct Extent {
        Box box;
        float low = INFINITY, high = -INFINITY; // K over ambient
    };
    void findSleepers(const HeatFrame& f);

    int wanted = 0, done = 0, sleepers = 0;
    const WallContact* walls = nullptr;                                  // of this step
    Array<Vec4> state;                                                   // see ConductionPass
    Array<float> flow, weight;                                           // of the pair pass
    Array<float> direction, residual, solution, heat, exchange, inverse; // of the conjugate gradients
    Array<Sums> blockSums;
    Array<Extent> extents;              // per block and body; the first bodies' of them all
    Array<uint8_t> asleep, groupAsleep; // per body; per group: its rows are all of such bodies
    bool bricks = false;                // some row is one
    Array<Vec4> axis;                   // see ConductionFactors
    Array<float> scaled;                // like the gradient of the lists, of the groups that need it
    Array<uint8_t> groupScaled;         // per group: it does
};

} // namespace thaw
