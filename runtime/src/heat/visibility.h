// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/types.h"
#include "geometry/colliders.h"

#include <memory>

namespace thaw {

// One straight line from a point of the surface to a source.
struct Ray {
    Vec3 surface;   // on the particle, half a spacing out: where rays against colliders begin
    Vec3 direction; // unit, to the source
    float distance; // m, from surface to source
    Vec3 raised;    // a spacing out, above the particle's own layer: where rays against the melt begin
    float skip;     // m, what the ray enters nearer than this is the neighbourhood and shades nothing
};

// Who sees whom: the host's colliders and the melting bodies themselves, in two Embree scenes. The melt is one sphere
// per exposed particle, kept by refit; the colliders are rebuilt only when they change. Uses the calling thread only:
// Embree's commits run in a private arena of one thread, so the host's own use of TBB is left alone.
class Visibility {
public:
    explicit Visibility(Allocator& allocator); // throws std::bad_alloc when Embree cannot start
    ~Visibility();

    // Takes over the occluders when `version` is not the one of last time.
    void setColliders(const Collider* colliders, int count, uint64_t version);
    // One sphere per exposed particle. ids are distinct; spheres' w is the radius. The order may change from call to
    // call: an id keeps its place in the tree. `most` is how many there may be one day (0: no more than now): while it
    // does not grow, only Embree allocates.
    void setSpheres(const Vec4* spheres, const uint32_t* ids, int count, int most = 0);
    // blocked[k] = the way of ray k is not free, for up to 8 rays. May be called from several threads at once.
    void cast(const Ray* rays, int count, bool* blocked) const;

    // How often the tree of the melt was built anew, and refitted.
    int rebuilds() const { return rebuilds_; }
    int refits() const { return refits_; }

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    int rebuilds_ = 0, refits_ = 0;
};

} // namespace thaw
