// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "base/types.h"
#include "geometry/colliders.h"
#include "motion/rigid.h"
#include "neighbors/neighbors.h"
#include "particles/material.h"
#include "particles/particles.h"

#include <algorithm>

namespace thaw {

// What turns liquid starts stiff and softens by a tenth a step: freed at once, it falls a spacing in its first frame
// and into itself. Two parts, in Pa s:
//  - so many times its own: a stick of butter that melts fast threw 60 drops in its first seconds without, none with
//    100. Only up to kStiffestStart rho dx^2 per step of 1/60 s in all, which stands by itself.
//  - up to kStiffTime s times the pressure of its depth, so that under its own weight nothing strains by more than
//  about
//    2 % a step.
inline constexpr float kStiffStart = 100, kStiffestStart = 300, kStiffTime = 0.28f;
inline float stiffStart(float viscosity, float density, float spacing, float pressure) {
    const float most = kStiffestStart * 60 * density * spacing * spacing;
    return std::max(0.0f, std::min(kStiffStart * viscosity, most) + kStiffTime * pressure - viscosity);
}

struct HoldFrame {
    Particles& particles;
    const Neighbors& neighbors; // of this step
    const Material* materials;
    const Collider* colliders;
    int colliderCount;
    Tasks& tasks;
    Rigid& rigid;
    float dt;                          // s, of the step
    Vec3 gravity;                      // m/s^2
    bool relabel;                      // look for pieces that lost their hold
    bool toldApart = false;            // some collider is told apart (carry.h): what sets has to know on what
    const uint16_t* mouldOn = nullptr; // per shape: what kMoulded rows that follow it hang on, like anchor
};

struct HoldResult {
    int released = 0, set = 0, cutLoose = 0;
    bool changed() const { return released + set + cutLoose > 0; }
};

// Decides what is held: solid wax that hangs together with a collider stands still exactly, everything else moves.
//  - releases fixed particles whose liquid fraction rose above the material's releaseFraction,
//  - sets movers below setFraction that touch a collider or something fixed, or that a shape holds, and are slow
//    against it: they are held, or join the rigid piece that they touch,
//  - when relabel is set, makes rigid pieces of what no path of touching fixed particles joins to a collider, and of
//    the parts of a piece that no longer hang together. A few particles go on as a lump of the material's solid
//    viscosity instead, until they set again.
// Works on flags only; the rows take their new places at the next sort.
class Hold {
public:
    explicit Hold(Allocator& allocator)
        : state_(allocator), anchor_(allocator), queue_(allocator), against_(allocator), colliderBounds_(allocator),
          blocks_(allocator) {}
    HoldResult update(const HoldFrame& f);
    // The last of these alone: for a body that is new.
    HoldResult relabel(const HoldFrame& f);

private:
    enum : uint8_t { kStay, kRelease, kSet, kReached };
    bool touchesToldApart(const HoldFrame& f, int row, const WallFinder& walls);
    void prepare(const HoldFrame& f);
    HoldResult decide(const HoldFrame& f, int begin, int end);
    void reach(const HoldFrame& f);
    void letGo(const HoldFrame& f, size_t row) const;
    void pressurize(const HoldFrame& f);
    int separate(const HoldFrame& f, uint16_t piece);
    void gather(const HoldFrame& f, int begin, int end, WallFinder& walls) const;

    Array<uint8_t> state_;
    Array<uint16_t> anchor_; // per row that sets: what it hangs on then
    Array<uint32_t> queue_;
    Array<uint16_t> against_; // per row that sets: the piece that it joins, or 0
    Array<Box> colliderBounds_;
    Array<HoldResult> blocks_;
};

} // namespace thaw
