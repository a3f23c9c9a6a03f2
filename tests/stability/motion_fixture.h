// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/kernel.h"
#include "geometry/colliders.h"
#include "motion/hold.h"
#include "motion/motion.h"
#include "neighbors/neighbors.h"
#include "particles/material.h"
#include "particles/particles.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

// A small world of nothing but motion: particles, walls, one material, no heat. Up is +y.
struct MotionScene {
    static constexpr float kStep = 1.0f / 60;

    thaw::Allocator allocator;
    thaw::Tasks tasks;
    thaw::Particles particles;
    thaw::Neighbors neighbors;
    thaw::Motion motion;
    thaw::Array<float> volume, invDensity;
    std::vector<thaw::Material> materials;
    std::vector<thaw::Collider> colliders;
    thaw::Vec3 gravity{0, -9.81f, 0};
    float spacing;
    int subStepLimit = 4, pressureIterations = 4, viscosityIterations = 12;
    int subSteps = 0, steps = 0;
    long iterations = 0;
    bool started = false; // the first step releases what the scene holds

    static thawTaskSystem workers(int n) {
        thawTaskSystem s{};
        s.workerCount = n;
        return s;
    }
    static thawMaterialDef liquid(float viscosity, float density = 1000) {
        thawMaterialDef d{};
        d.density = density, d.solidus = 300, d.liquidus = 310, d.latentHeat = 1e5f;
        d.specificHeatSolid = d.specificHeatLiquid = 2000;
        d.viscositySolid = 1e5f, d.viscosityLiquid = viscosity;
        return d;
    }

    // Without gravity and walls.
    thaw::BondFrame bondFrame() {
        return {particles, neighbors, volume.data(), materials.data(), nullptr, 0, tasks, kStep, {}};
    }
    MotionScene(float dx, const thawMaterialDef& material, int workerCount = 1, int capacity = 8192)
        : tasks(workers(workerCount)), particles(allocator), neighbors(allocator), motion(allocator), volume(allocator),
          invDensity(allocator), spacing(dx) {
        materials.emplace_back(material);
        particles.allocate(capacity);
    }

    // Even numbers in [-1, 1], the same on every machine.
    float noise() {
        seed_ = seed_ * 1664525u + 1013904223u;
        return static_cast<float>(seed_ >> 8) / 8388608.0f - 1;
    }
    void add(thaw::Vec3 x, bool fixed = false, thaw::Vec3 v = {}, float phi = 1, int material = 0) {
        thaw::Particles& p = particles;
        const size_t i = static_cast<size_t>(p.count++);
        const float mass = materials[static_cast<size_t>(material)].def.density * spacing * spacing * spacing;
        p.position[i] = {x.x, x.y, x.z, thaw::kSupport * spacing};
        p.velocity[i] = {v.x, v.y, v.z, mass};
        p.velocityChange[i] = {};
        p.liquidFraction[i] = phi;
        p.material[i] = static_cast<uint8_t>(material);
        p.flags[i] = fixed ? thaw::kFixed : 0;
        p.id[i] = static_cast<uint32_t>(i);
        p.pad();
    }
    // nx x ny x nz particles from the corner `lower`, jittered by 2 % so that no symmetry helps.
    void block(int nx, int ny, int nz, thaw::Vec3 lower, bool fixed = false, thaw::Vec3 v = {}, float phi = 1) {
        for (int j = 0; j < ny; ++j)
            for (int k = 0; k < nz; ++k)
                for (int i = 0; i < nx; ++i) {
                    const auto at = [&](int n) { return (static_cast<float>(n) + 0.5f + 0.02f * noise()) * spacing; };
                    const float x = at(i), y = at(j), z = at(k);
                    add(lower + thaw::Vec3{x, y, z}, fixed, v, phi);
                }
    }
    void plane(thaw::Vec3 normal, thaw::Vec3 at) {
        thaw::Collider c;
        c.type = thawCollider_plane, c.alive = true, c.transform.position = at;
        // The rotation that takes +y to the normal.
        if (normal.y < -0.999f) {
            c.transform.rotation = {1, 0, 0, 0};
        } else {
            const thaw::Vec3 axis = cross(thaw::Vec3{0, 1, 0}, normal);
            const float w = 1 + normal.y, l = std::sqrt(dot(axis, axis) + w * w);
            c.transform.rotation = {axis.x / l, axis.y / l, axis.z / l, w / l};
        }
        colliders.push_back(c);
    }
    void box(thaw::Vec3 center, thaw::Vec3 half) {
        thaw::Collider c;
        c.type = thawCollider_box, c.alive = true, c.transform.position = center, c.size = half;
        colliders.push_back(c);
    }
    void sphere(thaw::Vec3 center, float radius) {
        thaw::Collider c;
        c.type = thawCollider_sphere, c.alive = true, c.transform.position = center, c.size = {radius, radius, radius};
        colliders.push_back(c);
    }
    // An open tank with its inner corner at the origin.
    void tank(float x, float z) {
        plane({0, 1, 0}, {});
        plane({1, 0, 0}, {}), plane({-1, 0, 0}, {x, 0, 0});
        plane({0, 0, 1}, {}), plane({0, 0, -1}, {0, 0, z});
    }
    // What the phase stage does for a large region that has just turned liquid: it starts stiff and softens, with the
    // pressure of its depth below `top`.
    void startAtRest(float top) {
        for (int i = 0; i < particles.count; ++i) {
            const size_t k = static_cast<size_t>(i);
            const thaw::Material& m = materials[particles.material[k]];
            particles.pressure[k] = m.def.density * length(gravity) * std::max(0.0f, top - particles.position[k].y);
            particles.velocityChange[k].w = thaw::stiffStart(m.viscosity(particles.liquidFraction[k]), m.def.density,
                                                             spacing, particles.pressure[k]);
        }
    }

    void weigh() {
        neighbors.sort(particles, tasks);
        neighbors.build(particles, tasks);
        const size_t rows = static_cast<size_t>(particles.count + thaw::Particles::kPadding);
        volume.resizeRaw(rows), invDensity.resizeRaw(rows);
        for (size_t i = 0; i < rows; ++i) {
            const bool real = static_cast<int>(i) < particles.count;
            const float density = materials[particles.material[i]].def.density;
            volume[i] = real ? particles.velocity[i].w / density : 0;
            invDensity[i] = real && !(particles.flags[i] & thaw::kFixed) ? 1 / density : 0;
        }
        neighbors.weigh(particles, volume.data(), invDensity.data(), tasks);
    }
    thaw::MotionFrame frame(float dt, int k) {
        return {particles,
                neighbors,
                volume.data(),
                invDensity.data(),
                materials.data(),
                colliders.data(),
                static_cast<int>(colliders.size()),
                tasks,
                dt,
                k,
                gravity,
                spacing,
                pressureIterations,
                viscosityIterations};
    }
    void step(int forced = 0) {
        if (!started) weigh(), started = true;
        const int k = forced ? forced : thaw::Motion::subStepsWanted(particles, kStep, gravity, spacing, subStepLimit);
        for (int s = 0; s < k; ++s) {
            weigh();
            const thaw::MotionFrame f = frame(kStep / static_cast<float>(k), k);
            motion.begin(f), motion.forces(f), motion.viscosity(f), motion.pressure(f), motion.move(f);
            iterations += motion.stats().viscosityIterations;
        }
        subSteps += k, ++steps;
    }
    void run(float seconds, const std::function<void()>& each = {}) {
        for (int n = static_cast<int>(seconds / kStep + 0.5f); n > 0; --n) {
            step();
            if (each) each();
        }
    }

    template <class F> void forMovers(F&& f) const {
        for (int i = 0; i < particles.count; ++i)
            if (!particles.fixed(i)) f(static_cast<size_t>(i));
    }
    thaw::Vec3 positionOf(size_t i) const { return particles.position[i].xyz(); }
    thaw::Vec3 velocityOf(size_t i) const { return particles.velocity[i].xyz(); }
    double rmsSpeed() const {
        double sum = 0;
        int n = 0;
        forMovers([&](size_t i) { sum += static_cast<double>(dot(velocityOf(i), velocityOf(i))), ++n; });
        return std::sqrt(sum / std::max(1, n));
    }
    double fastest() const {
        double most = 0;
        forMovers([&](size_t i) { most = std::max(most, static_cast<double>(length(velocityOf(i)))); });
        return most;
    }
    // Mean of a coordinate of the movers.
    double mean(float thaw::Vec4::*axis) const {
        double sum = 0;
        int n = 0;
        forMovers([&](size_t i) { sum += static_cast<double>(particles.position[i].*axis), ++n; });
        return sum / std::max(1, n);
    }
    void momentum(double (&out)[3]) const {
        out[0] = out[1] = out[2] = 0;
        forMovers([&](size_t i) {
            const thaw::Vec4 v = particles.velocity[i];
            out[0] += static_cast<double>(v.w) * v.x, out[1] += static_cast<double>(v.w) * v.y;
            out[2] += static_cast<double>(v.w) * v.z;
        });
    }
    // Density error of now: the stats of a step are those of its start.
    void compression(double& meanError, double& maxError) {
        weigh();
        motion.begin(frame(kStep, 1));
        meanError = static_cast<double>(motion.stats().meanCompression);
        maxError = static_cast<double>(motion.stats().maxCompression);
    }
    bool finite() const {
        for (int i = 0; i < particles.count; ++i)
            if (!isFinite(positionOf(static_cast<size_t>(i))) || !isFinite(velocityOf(static_cast<size_t>(i))))
                return false;
        return true;
    }
    // Share of the movers that hang together (nearer than 1.6 spacings) with nothing that touches a collider (nearer
    // than 1.3) or a fixed particle.
    double detached() const {
        const int n = particles.count;
        std::vector<int> parent(static_cast<size_t>(n));
        for (int i = 0; i < n; ++i) parent[static_cast<size_t>(i)] = i;
        const auto root = [&](int i) {
            while (parent[static_cast<size_t>(i)] != i) i = parent[static_cast<size_t>(i)];
            return i;
        };
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < i; ++j) {
                const thaw::Vec3 d = positionOf(static_cast<size_t>(i)) - positionOf(static_cast<size_t>(j));
                if (dot(d, d) < 2.56f * spacing * spacing) parent[static_cast<size_t>(root(i))] = root(j);
            }
        std::vector<char> held(static_cast<size_t>(n), 0);
        for (int i = 0; i < n; ++i) {
            bool touches = particles.fixed(i);
            for (const thaw::Collider& c : colliders) {
                thaw::Vec3 normal;
                touches |= c.distance(positionOf(static_cast<size_t>(i)), normal) < 1.3f * spacing;
            }
            if (touches) held[static_cast<size_t>(root(i))] = 1;
        }
        int movers = 0, off = 0;
        for (int i = 0; i < n; ++i)
            if (!particles.fixed(i)) ++movers, off += !held[static_cast<size_t>(root(i))];
        return movers ? static_cast<double>(off) / movers : 0;
    }

private:
    uint32_t seed_ = 1;
};
