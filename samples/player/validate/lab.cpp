// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "validate/lab.h"

#include "args.h"

#include <algorithm>
#include <cmath>

namespace thaw::player {

Lab::Lab(float spacing, int maxParticles, thawVec3 gravity, float timeScale, int threads) : spacing_(spacing) {
    thawInitBudget(&budget);
    thawWorldDef def;
    thawInitWorldDef(&def);
    def.particleSpacing = spacing;
    def.maxParticles = maxParticles;
    def.gravity = gravity;
    def.thermalTimeScale = timeScale;
    def.tasks.workerCount = threads > 0 ? threads : defaultThreads();
    char message[256];
    if (thawCreateWorld(&def, &world_, message, sizeof message) != thawResult_ok) throw LabError(message);
}

Lab::~Lab() { thawDestroyWorld(world_); }

void Lab::require(thawResult result) const {
    if (result != thawResult_ok) throw LabError(thawWorld_GetLastError(world_));
}

thawMaterialDef Lab::plain(float density, float viscosity) {
    thawMaterialDef m;
    thawInitMaterialDef(&m, thawMaterial_wax);
    m.density = density;
    m.solidus = 300, m.liquidus = 310;
    m.viscosityLiquid = viscosity;
    m.cohesion = m.adhesion = 0;
    return m;
}

thawMaterialId Lab::material(const thawMaterialDef& def) {
    thawMaterialId id;
    require(thawCreateMaterial(world_, &def, &id));
    return id;
}

thawBodyId Lab::body(thawMaterialId material, const scene::TriMesh& mesh, thawVec3 center, float temperature,
                     const std::function<void(thawBodyDef&)>& more) {
    thawBodyDef d;
    thawInitBodyDef(&d);
    d.material = material;
    d.mesh = mesh.view();
    d.position = center;
    d.temperature = temperature;
    if (more) more(d);
    thawBodyId id;
    require(thawCreateBody(world_, &d, &id, nullptr));
    return id;
}

thawBodyId Lab::box(thawMaterialId material, thawVec3 lower, thawVec3 upper, float temperature,
                    const std::function<void(thawBodyDef&)>& more) {
    const scene::TriMesh mesh = scene::makeBox({upper.x - lower.x, upper.y - lower.y, upper.z - lower.z});
    return body(material, mesh, {0.5f * (lower.x + upper.x), 0.5f * (lower.y + upper.y), 0.5f * (lower.z + upper.z)},
                temperature, more);
}

thawColliderId Lab::collider(const thawColliderDef& def) {
    thawColliderId id;
    require(thawCreateCollider(world_, &def, &id, nullptr));
    return id;
}

thawColliderId Lab::plane(thawVec3 point, thawVec3 normal) {
    thawColliderDef d;
    thawInitColliderDef(&d, thawCollider_plane);
    d.position = point;
    d.rotation = turnTo({0, 1, 0}, normal);
    return collider(d);
}

void Lab::channel(float half) {
    for (float side = -1; side < 2; side += 2) {
        thawColliderDef d;
        thawInitColliderDef(&d, thawCollider_plane);
        d.position = {0, 0, side * half};
        d.rotation = turnTo({0, 1, 0}, {0, 0, -side});
        d.slipLength = 1e4f;
        collider(d);
    }
}

thawHeatSourceId Lab::source(const thawHeatSourceDef& def) {
    thawHeatSourceId id;
    require(thawCreateHeatSource(world_, &def, &id));
    return id;
}

thawColliderId Lab::floor(float y) { return plane({0, y, 0}, {0, 1, 0}); }

void Lab::tank(thawVec3 lower, thawVec3 upper) {
    floor(lower.y);
    plane({lower.x, 0, 0}, {1, 0, 0}), plane({upper.x, 0, 0}, {-1, 0, 0});
    plane({0, 0, lower.z}, {0, 0, 1}), plane({0, 0, upper.z}, {0, 0, -1});
}

uint32_t Lab::step(int frames, const std::function<void(int)>& each) {
    uint32_t bits = 0;
    for (int f = 1; f <= frames; ++f) {
        const uint32_t now = thawWorld_Step(world_, 1.0f / 60, &budget);
        if (now & thawStep_refused) throw LabError(thawWorld_GetLastError(world_));
        bits |= now;
        if (each) each(f);
    }
    return bits;
}

thawParticleView Lab::particles() const {
    thawParticleView v;
    thawWorld_GetParticles(world_, &v);
    return v;
}

thawCounters Lab::counters() const {
    thawCounters c;
    thawWorld_GetCounters(world_, &c);
    return c;
}

thawSurfaceView Lab::surface() const {
    thawSurfaceDef def;
    thawInitSurfaceDef(&def);
    thawSurfaceView view;
    require(thawWorld_ExtractSurface(world_, &def, &view));
    return view;
}

double Lab::height() const {
    const thawParticleView p = particles();
    double top = -INFINITY;
    for (int i = 0; i < p.count; ++i) top = std::max(top, static_cast<double>(p.positions[4 * i + 1]));
    return top + 0.5 * static_cast<double>(spacing_);
}

Momentum momentumOf(const thawParticleView& v) {
    Momentum m{};
    for (int i = 0; i < v.count; ++i) {
        const float *x = v.positions + 4 * i, *u = v.velocities + 4 * i;
        const double mass = static_cast<double>(u[3]), px = mass * static_cast<double>(u[0]),
                     py = mass * static_cast<double>(u[1]), pz = mass * static_cast<double>(u[2]);
        m.p[0] += px, m.p[1] += py, m.p[2] += pz;
        m.l[0] += static_cast<double>(x[1]) * pz - static_cast<double>(x[2]) * py;
        m.l[1] += static_cast<double>(x[2]) * px - static_cast<double>(x[0]) * pz;
        m.l[2] += static_cast<double>(x[0]) * py - static_cast<double>(x[1]) * px;
    }
    return m;
}

double kineticEnergy(const thawParticleView& p) {
    double sum = 0;
    for (int i = 0; i < p.count; ++i) {
        const float* v = p.velocities + 4 * i;
        sum += 0.5 * double(v[3]) * (double(v[0]) * v[0] + double(v[1]) * v[1] + double(v[2]) * v[2]);
    }
    return sum;
}

double kineticOver(const Lab& lab) {
    const thawParticleView p = lab.particles();
    double mass = 0;
    for (int i = 0; i < p.count; ++i) mass += double(p.velocities[4 * i + 3]);
    return kineticEnergy(p) / (kG * double(lab.spacing()) * mass);
}

double lengthOf(const double (&v)[3]) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

thawQuat turnTo(thawVec3 a, thawVec3 b) {
    const float w = 1 + a.x * b.x + a.y * b.y + a.z * b.z;
    if (w < 1e-6f) return {1, 0, 0, 0}; // opposite: half a turn about x, for the axes in use here
    const thawQuat q{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x, w};
    const float s = 1 / std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return {s * q.x, s * q.y, s * q.z, s * q.w};
}

} // namespace thaw::player
