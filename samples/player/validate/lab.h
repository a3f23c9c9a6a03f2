// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "mesh.h"
#include "thaw/thaw.h"

#include <functional>
#include <stdexcept>

namespace thaw::player {

inline constexpr double kG = 9.81, kPi = 3.14159265358979323846;

// A refused call: the case cannot be run.
struct LabError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// A world to try things in, through the public header as a host has it. Without heat unless told otherwise
// (thermalTimeScale 0); threads 0: as many as the machine offers a game; steps are 1/60 s with the default budget.
// Throws LabError with the library's message.
class Lab {
public:
    explicit Lab(float spacing, int maxParticles = 20000, thawVec3 gravity = {0, -9.81f, 0}, float timeScale = 0,
                 int threads = 0);
    ~Lab();
    Lab(const Lab&) = delete;
    Lab& operator=(const Lab&) = delete;

    thawMaterialId material(const thawMaterialDef& def);
    // Wax-like numbers with melting between 300 and 310 K: solid when made at 280 K, liquid at 320 K. cohesion and
    // adhesion 0.
    static thawMaterialDef plain(float density, float viscosity);
    static constexpr float kSolid = 280, kLiquid = 320; // K

    // A body of this mesh, moved by `center`; temperature in K.
    thawBodyId body(thawMaterialId material, const scene::TriMesh& mesh, thawVec3 center, float temperature,
                    const std::function<void(thawBodyDef&)>& more = {});
    thawBodyId box(thawMaterialId material, thawVec3 lower, thawVec3 upper, float temperature,
                   const std::function<void(thawBodyDef&)>& more = {});
    thawColliderId floor(float y = 0);
    thawColliderId plane(thawVec3 point, thawVec3 normal);
    // Planes at z = -half and half on which liquids slide freely.
    void channel(float half);
    thawColliderId collider(const thawColliderDef& def);
    thawHeatSourceId source(const thawHeatSourceDef& def);
    // Four planes and a floor around the inside of a box, open above.
    void tank(thawVec3 lower, thawVec3 upper);

    // Steps; calls `each` after every one, when given. Returns the status bits of all steps together.
    uint32_t step(int frames, const std::function<void(int frame)>& each = {});

    thawParticleView particles() const;
    thawCounters counters() const;
    thawSurfaceView surface() const; // by the default definition
    double height() const;           // m, of the topmost particle's centre plus half a spacing
    thawWorld* world() const { return world_; }
    float spacing() const { return spacing_; }
    thawBudget budget; // what step() passes

private:
    void require(thawResult result) const;
    thawWorld* world_ = nullptr;
    float spacing_;
};

// Linear and angular momentum (about the origin) of all particles, kg m/s and kg m^2/s.
struct Momentum {
    double p[3], l[3];
};
Momentum momentumOf(const thawParticleView& particles);
double kineticEnergy(const thawParticleView& particles); // J
double kineticOver(const Lab& lab);                      // the same over g dx m
double lengthOf(const double (&v)[3]);
thawQuat turnTo(thawVec3 from, thawVec3 to); // shortest rotation between two unit vectors

} // namespace thaw::player
