// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "heat/frame.h"

#include <memory>

namespace thaw {

// Heat of one step. Each call is one stage, any but the last may be left out, in this order. Conduction and the
// exchange with the surroundings change the enthalpies one after the other (each monotone at any dt); what changed is
// booked, so that the ledger is exact. Temperatures and liquid fractions follow in integrate().
class Heat {
public:
    explicit Heat(Allocator& allocator); // throws std::bad_alloc; Embree is started at the first radiation
    ~Heat();

    // In how many equal parts conduction and loss are to alternate over f.dt. hottest: K, of all there is.
    static int parts(const HeatFrame& f, int materialCount, float hottest);
    void radiation(const HeatFrame& f); // casts rays, the unknown and longest unseen first; finds the power absorbed
    void conduction(
        const HeatFrame& f); // between particles, and from walls by contact; sub-cycles, then implicit when dt is long
    void loss(const HeatFrame& f);      // settles each surface particle with what it absorbs, emits, convects
    void integrate(const HeatFrame& f); // absorbs if loss() did not; bounds; temperature, liquid fraction
    const HeatStats& stats() const { return stats_; }
    const float* power() const; // per row, W taken up from the sources, of the last radiation()
    // What lives on beside the particles. forms: of colliders that cast shadows.
    void state(StateIo& io, const ColliderForms& forms, size_t rows, uint64_t surfaceVersion);
    bool names(uint64_t form) const; // its state does, of a collider's mesh

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    HeatStats stats_;
};

} // namespace thaw
