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

// A region in which something that shades moved, came or went.
struct Stir {
    Box box;      // of the old and the new place
    float amount; // m, how far; infinite when a collider came or went
    bool melt;    // rays do not see what of it is nearer than their skip
};

// Who sees whom: the host's colliders, in an Embree scene, and the melting bodies themselves, one sphere per exposed
// particle. Meshes of colliders are instances, so that one that moves only gets a new transform (3 us, where building
// its tree anew takes 9 ms for three of 20,000 triangles). Uses the calling thread only: Embree's commits run in a
// private arena of one thread, so the host's own use of TBB is left alone.
class Visibility {
public:
    explicit Visibility(Allocator& allocator); // throws std::bad_alloc when Embree cannot start
    ~Visibility();

    // Takes over the occluders when `version` is not the one of last time. What changed is in stirs().
    void setColliders(const Collider* colliders, int count, uint64_t version);
    // One sphere per exposed particle. ids are distinct; spheres' w is the radius. The order may change from call to
    // call. `most` is how many there may be one day (0: no more than now): while it does not grow, nothing is
    // allocated. moved: per sphere, m, its radius when it is new; may be null. What changed is in stirs().
    void setSpheres(const Vec4* spheres, const uint32_t* ids, int count, int most = 0, float* moved = nullptr);
    // What shades now and did not, or no more, since the calls before. Forgotten by clearStirs().
    const Array<Stir>& stirs() const;
    void clearStirs();
    // Brings the trees up to what was set. To be called before cast().
    void commit();
    // blocked[k] = the way of ray k is not free, for up to 8 rays. May be called from several threads at once.
    void cast(const Ray* rays, int count, bool* blocked) const;

    // How often the tree of the melt was built; and that of the colliders, and moved within.
    int meltBuilds() const { return meltBuilds_; }
    int colliderBuilds() const { return colliderBuilds_; }
    int colliderMoves() const { return colliderMoves_; }
    // The places that the next call compares with. When an image is only checked nothing is touched.
    void state(StateIo& io, const ColliderForms& forms);
    bool names(uint64_t form) const; // of a collider's mesh

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    int meltBuilds_ = 0, colliderBuilds_ = 0, colliderMoves_ = 0;
};

} // namespace thaw
