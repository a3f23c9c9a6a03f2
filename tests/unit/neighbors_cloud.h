// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/kernel.h"
#include "base/memory.h"
#include "base/tasks.h"
#include "neighbors/neighbors.h"
#include "particles/particles.h"

#include <cmath>
#include <cstdint>
#include <vector>

// Particles for tests of the neighbour lists.
struct Cloud {
    struct Point {
        thaw::Vec3 position;
        float support;
        bool fixed = false;
    };

    thaw::Allocator allocator;
    thaw::Particles particles{allocator};
    thaw::Neighbors neighbors{allocator};
    thaw::Tasks tasks;
    thaw::Array<float> volume{allocator}, invDensity{allocator};

    static thawTaskSystem workers(int count) {
        thawTaskSystem s{};
        s.workerCount = count;
        return s;
    }

    explicit Cloud(const std::vector<Point>& points, int workerCount = 1) : tasks(workers(workerCount)) {
        using namespace thaw;
        int n = static_cast<int>(points.size());
        particles.allocate(n);
        particles.count = n;
        particles.pad();
        for (int i = 0; i < n; ++i) {
            size_t k = static_cast<size_t>(i);
            const Point& p = points[k];
            float id = static_cast<float>(i);
            particles.position[k] = {p.position.x, p.position.y, p.position.z, p.support};
            particles.velocity[k] = {id, id + 1, id + 2, id + 3};
            particles.velocityChange[k] = {-id, -id - 1, -id - 2, -id - 3};
            particles.normal[k] = {2 * id, 3 * id, 4 * id, 5 * id};
            particles.enthalpy[k] = 7.5 * i;
            particles.temperature[k] = 11 * id;
            particles.liquidFraction[k] = 13 * id;
            particles.pressure[k] = 17 * id;
            particles.stiffness[k] = 19 * id;
            particles.rayChange[k] = 23 * id;
            particles.id[k] = static_cast<uint32_t>(i);
            particles.body[k] = static_cast<uint16_t>(i * 29);
            particles.material[k] = static_cast<uint8_t>(i * 31);
            particles.level[k] = static_cast<uint8_t>(i * 37);
            particles.flags[k] = static_cast<uint8_t>((p.fixed ? kFixed : 0) | (i % 3 == 0 ? kSurface : 0));
        }
    }

    void sort() { neighbors.sort(particles, tasks); }
    void build() { neighbors.build(particles, tasks); }
    // Volume of the support's spacing cubed, density 1000.
    void weigh() {
        size_t n = static_cast<size_t>(particles.count) + thaw::Particles::kPadding;
        volume.assign(n, 0), invDensity.assign(n, 0);
        for (int i = 0; i < particles.count; ++i) {
            size_t k = static_cast<size_t>(i);
            float d = particles.position[k].w / thaw::kSupport;
            volume[k] = d * d * d;
            invDensity[k] = particles.fixed(i) ? 0 : 1e-3f;
        }
        neighbors.weigh(particles, volume.data(), invDensity.data(), tasks);
    }

    // Neighbours of one row as rows, without the dummies; the entries that are dummies must come last.
    std::vector<int> list(int i) const {
        std::vector<int> rows;
        size_t g = static_cast<size_t>(i) / 8, lane = static_cast<size_t>(i) % 8;
        for (uint32_t k = 0; k < neighbors.width[g]; ++k) {
            uint32_t e = neighbors.entries[neighbors.first[g] + 8 * k + lane];
            rows.push_back(static_cast<int>(e / 16));
        }
        while (!rows.empty() && rows.back() == particles.count) rows.pop_back();
        return rows;
    }
};

struct Random {
    uint32_t state = 12345;
    float operator()() { // [0, 1)
        state = state * 1664525u + 1013904223u;
        return static_cast<float>(state >> 8) * (1.0f / 16777216.0f);
    }
    float operator()(float low, float high) { return low + (high - low) * (*this)(); }
};

inline std::vector<Cloud::Point> lattice(int nx, int ny, int nz, float spacing, float jitter = 0,
                                         float support = thaw::kSupport) {
    std::vector<Cloud::Point> points;
    Random random;
    for (int z = 0; z < nz; ++z)
        for (int y = 0; y < ny; ++y)
            for (int x = 0; x < nx; ++x) {
                auto at = [&](int c) { return spacing * (static_cast<float>(c) + jitter * random(-1, 1)); };
                thaw::Vec3 p{at(x), at(y), at(z)};
                points.push_back({p, support * spacing, false});
            }
    return points;
}
