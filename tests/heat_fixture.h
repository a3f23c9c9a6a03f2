// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/kernel.h"
#include "heat/heat.h"
#include "neighbors/exposure.h"

#include <cmath>
#include <functional>
#include <vector>

namespace thaw {

// Particles, lists and heat without a world: what the heat tests place is what is there.
struct HeatFixture {
    explicit HeatFixture(float spacing_ = 0.01f, int workers = 1)
        : tasks({workers, nullptr, nullptr, nullptr}), particles(allocator), neighbors(allocator), heat(allocator),
          spacing(spacing_) {}

    Allocator allocator;
    Tasks tasks;
    Particles particles;
    Neighbors neighbors;
    Heat heat;
    float spacing;
    std::vector<Material> materials;
    std::vector<Collider> colliders;
    std::vector<HeatSource> sources;
    std::vector<float> volume, invDensity;
    std::vector<Vec3> pending;
    std::vector<uint8_t> pendingMaterial;
    std::vector<float> pendingTemperature;
    uint64_t colliderVersion = 1;
    float ambient = 293.15f, convection = 0, rayRefresh = 1;
    int cycles = 80;
    int raysPerSource = 16;
    uint64_t surfaceVersion = 0;
    const thawRaySystem* rays = nullptr;
    bool undercools = false;
    int bodyCount = 0;
    HeatStats total;
    int exposed = 0;

    // A plain material: 1000 kg/m^3, 1000 J/(kg K), 1 W/(m K) in both phases, melting far away, black.
    static thawMaterialDef plain() {
        thawMaterialDef d{};
        d.density = 1000, d.solidus = d.liquidus = 5000, d.latentHeat = 1e5f;
        d.specificHeatSolid = d.specificHeatLiquid = 1000, d.conductivitySolid = d.conductivityLiquid = 1;
        d.viscositySolid = 1e3f, d.viscosityLiquid = 1, d.absorptivity = d.emissivity = 1;
        return d;
    }
    int addMaterial(const thawMaterialDef& d) {
        materials.emplace_back(d);
        return static_cast<int>(materials.size()) - 1;
    }
    void add(Vec3 x, float temperature, int material = 0) {
        pending.push_back(x), pendingTemperature.push_back(temperature);
        pendingMaterial.push_back(static_cast<uint8_t>(material));
    }
    // Cells [0, n) of a lattice whose first corner is `corner`; temperature and material by position.
    void addBlock(
        Vec3 corner, int nx, int ny, int nz, const std::function<float(Vec3)>& temperature,
        const std::function<int(Vec3)>& material = [](Vec3) { return 0; }) {
        for (int k = 0; k < nz; ++k)
            for (int j = 0; j < ny; ++j)
                for (int i = 0; i < nx; ++i) {
                    const Vec3 x = corner + spacing * Vec3{static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f,
                                                           static_cast<float>(k) + 0.5f};
                    add(x, temperature(x), material(x));
                }
    }
    // A ball as a mesh fill makes it: shells that follow the surface, the outermost half a spacing below it. The volume
    // of each particle is spacing^3 within half a percent.
    void addBall(Vec3 center, float radius, float temperature) {
        for (float r = radius - 0.5f * spacing; r > 0.2f * spacing; r -= spacing) {
            const double q = static_cast<double>(r) / spacing;
            const int n = std::max(1, static_cast<int>(4 * M_PI * (q * q + 1.0 / 12) + 0.5));
            for (int i = 0; i < n; ++i) {
                const double z = 1 - 2 * (i + 0.5) / n, s = std::sqrt(1 - z * z), a = i * 2.399963229728653 + q;
                add(center + r * Vec3{static_cast<float>(s * std::cos(a)), static_cast<float>(s * std::sin(a)),
                                      static_cast<float>(z)},
                    temperature);
            }
        }
    }
    // Makes rows of what was added; every `moverEvery`-th moves, 0: none.
    void build(int moverEvery = 0) {
        if (materials.empty()) addMaterial(plain());
        const size_t n = pending.size();
        particles.allocate(static_cast<int>(n));
        particles.count = static_cast<int>(n), particles.moverCount = 0;
        for (size_t i = 0; i < n; ++i) {
            const Material& m = materials[pendingMaterial[i]];
            particles.position[i] = {pending[i].x, pending[i].y, pending[i].z, kSupport * spacing};
            particles.velocity[i] = {0, 0, 0, m.def.density * spacing * spacing * spacing};
            particles.enthalpy[i] = m.enthalpy(pendingTemperature[i]);
            particles.temperature[i] = pendingTemperature[i];
            particles.liquidFraction[i] = m.liquidFraction(particles.enthalpy[i]);
            particles.id[i] = static_cast<uint32_t>(i);
            particles.material[i] = pendingMaterial[i];
            particles.flags[i] =
                moverEvery > 0 && i % static_cast<size_t>(moverEvery) == 0 ? uint8_t{0} : uint8_t{kFixed};
            particles.moverCount += !particles.fixed(static_cast<int>(i));
        }
        particles.pad();
        refresh();
    }
    // After particles moved or changed.
    void refresh() {
        neighbors.sort(particles, tasks);
        neighbors.build(particles, tasks);
        const size_t padded = static_cast<size_t>(particles.count + Particles::kPadding);
        volume.assign(padded, 0), invDensity.assign(padded, 0);
        for (size_t i = 0; i < static_cast<size_t>(particles.count); ++i) {
            const float rho = materials[particles.material[i]].def.density;
            volume[i] = particles.velocity[i].w / rho;
            invDensity[i] = particles.fixed(static_cast<int>(i)) ? 0 : 1 / rho;
        }
        neighbors.weigh(particles, volume.data(), invDensity.data(), tasks);
        expose();
    }
    void expose() {
        exposed = findExposure(particles, neighbors, volume.data(), colliders.data(),
                               static_cast<int>(colliders.size()), nullptr, tasks);
    }
    HeatFrame frame(double dt) {
        return {particles,
                neighbors,
                volume.data(),
                materials.data(),
                colliders.data(),
                static_cast<int>(colliders.size()),
                colliderVersion,
                sources.data(),
                static_cast<int>(sources.size()),
                tasks,
                dt,
                ambient,
                convection,
                spacing,
                rayRefresh,
                cycles,
                raysPerSource,
                surfaceVersion,
                rays,
                undercools,
                bodyCount};
    }
    enum Stage { kRadiation = 1, kConduction = 2, kLoss = 4, kAll = 7 };
    void step(double dt, int stages = kAll) {
        const HeatFrame f = frame(dt);
        if (stages & kRadiation) heat.radiation(f);
        if (stages & kConduction) heat.conduction(f);
        if (stages & kLoss) heat.loss(f);
        heat.integrate(f);
        const HeatStats& s = heat.stats();
        total.absorbed += s.absorbed, total.contact += s.contact, total.emitted += s.emitted,
            total.convected += s.convected;
    }
    double energy() const {
        double e = 0;
        for (size_t i = 0; i < static_cast<size_t>(particles.count); ++i)
            e += particles.velocity[i].w * particles.enthalpy[i];
        return e;
    }
    double area() const {
        double a = 0;
        for (size_t i = 0; i < static_cast<size_t>(particles.count); ++i) a += particles.normal[i].w;
        return a;
    }
    double mass() const {
        double m = 0;
        for (size_t i = 0; i < static_cast<size_t>(particles.count); ++i) m += particles.velocity[i].w;
        return m;
    }
    void setTemperature(size_t row, float temperature) {
        const Material& m = materials[particles.material[row]];
        particles.enthalpy[row] = m.enthalpy(temperature), particles.temperature[row] = temperature;
        particles.liquidFraction[row] = m.liquidFraction(particles.enthalpy[row]);
    }
    // Rows of the state that heat changes, by id, so that runs compare bit for bit.
    std::vector<double> enthalpies() const {
        std::vector<double> h(static_cast<size_t>(particles.count));
        for (size_t i = 0; i < h.size(); ++i) h[particles.id[i]] = particles.enthalpy[i];
        return h;
    }
    size_t size() const { return static_cast<size_t>(particles.count); }
};

inline uint32_t scramble(uint32_t& state) {
    state = state * 1664525u + 1013904223u;
    return state >> 8;
}
inline float uniform(uint32_t& state) { return static_cast<float>(scramble(state)) * (1.0f / 16777216.0f); }
inline Vec3 inCube(uint32_t& state) { // [-1, 1]^3
    const float x = uniform(state), y = uniform(state), z = uniform(state);
    return 2 * Vec3{x, y, z} - Vec3{1, 1, 1};
}

// J that each row took up in one step of radiation alone, by id.
inline std::vector<double> absorbed(HeatFixture& f, double dt = 1) {
    std::vector<double> before = f.enthalpies();
    f.step(dt, HeatFixture::kRadiation);
    std::vector<double> after = f.enthalpies(), e(after.size());
    for (size_t i = 0; i < f.size(); ++i) {
        const size_t id = f.particles.id[i];
        e[id] = (after[id] - before[id]) * f.particles.velocity[i].w;
    }
    return e;
}

inline double sum(const std::vector<double>& v) {
    double s = 0;
    for (double x : v) s += x;
    return s;
}

inline Collider box(Vec3 center, Vec3 half, Quat rotation = {}) {
    Collider c;
    c.type = thawCollider_box, c.alive = true, c.transform = {center, rotation, 1}, c.size = half;
    return c;
}

// Series of a slab from 1 whose faces are held at 0: x in thicknesses, fo the Fourier number.
inline double slab(double x, double fo) {
    double u = 0;
    for (int n = 0; n < 60; ++n) {
        const double k = (2 * n + 1) * 3.14159265358979323846;
        u += 4 / k * std::sin(k * x) * std::exp(-k * k * fo);
    }
    return u;
}

} // namespace thaw
