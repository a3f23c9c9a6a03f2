// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "heat/frame.h"

namespace thaw {

// Conduction between particles over one step: explicit sub-cycles, or implicit when the step is long.
class Conduction {
public:
    explicit Conduction(Allocator& a)
        : state(a), flow(a), weight(a), direction(a), residual(a), solution(a), heat(a), exchange(a), inverse(a),
          blockSums(a) {}

    void run(const HeatFrame& f);

private:
    struct Sums {
        double a, b;
        float low, high;
    };
    void pairPass(const HeatFrame& f, bool weights);
    void fillState(const HeatFrame& f);
    double fastest(const HeatFrame& f);
    void explicitStep(const HeatFrame& f, double dt);
    void implicitStep(const HeatFrame& f);
    template <class F> Sums sumRows(const HeatFrame& f, F&& row);

    Array<Vec4> state;                                                   // see ConductionPass
    Array<float> flow, weight;                                           // of the pair pass
    Array<float> direction, residual, solution, heat, exchange, inverse; // of the conjugate gradients
    Array<Sums> blockSums;
};

} // namespace thaw
