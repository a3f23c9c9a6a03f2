// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "surface/surface.h"

#include <cmath>
#include <map>
#include <utility>
#include <vector>

// Deterministic numbers in [0, 1).
struct Dice {
    uint32_t state = 1;
    float roll() {
        state = state * 1664525u + 1013904223u;
        return float(state >> 8) / 16777216.0f;
    }
    thaw::Vec3 direction() {
        for (;;) {
            thaw::Vec3 v{2 * roll() - 1, 2 * roll() - 1, 2 * roll() - 1};
            if (float l = length(v); l < 1 && l > 0.1f) return (1 / l) * v;
        }
    }
};

// Particles to mesh; all of one spacing unless said.
struct Wax {
    float spacing = 0.002f;
    std::vector<thaw::Vec4> positions;
    std::vector<float> temperatures, liquidFractions;
    std::vector<uint8_t> materials;
    std::vector<uint16_t> bodies;
    double volume = 0;

    void add(thaw::Vec3 p, float ownSpacing, float temperature = 300, float liquid = 0, uint8_t material = 0,
             uint16_t body = 0) {
        positions.push_back({p.x, p.y, p.z, 2.2f * ownSpacing});
        temperatures.push_back(temperature), liquidFractions.push_back(liquid);
        materials.push_back(material), bodies.push_back(body);
        volume += double(ownSpacing) * ownSpacing * ownSpacing;
    }
    void add(thaw::Vec3 p) { add(p, spacing); }

    // Lattice points of a grid shifted by shift spacings where isInside, in spacings.
    template <class F> void fill(int reach, thaw::Vec3 shift, F&& isInside) {
        for (int z = -reach; z <= reach; ++z)
            for (int y = -reach; y <= reach; ++y)
                for (int x = -reach; x <= reach; ++x) {
                    thaw::Vec3 p = thaw::Vec3{float(x), float(y), float(z)} + shift;
                    if (isInside(p)) add(spacing * p);
                }
    }
    // Particles of nx ny nz, turned about y, anywhere within a few cells.
    void scatterBox(int nx, int ny, int nz, Dice& dice) {
        float angle = 6.2831853f * dice.roll(), c = std::cos(angle), s = std::sin(angle);
        thaw::Vec3 at{0.1f * dice.roll(), 0.1f * dice.roll(), 0.1f * dice.roll()};
        for (int z = 0; z < nz; ++z)
            for (int y = 0; y < ny; ++y)
                for (int x = 0; x < nx; ++x)
                    add(at + spacing * thaw::Vec3{c * float(x) - s * float(z), float(y), s * float(x) + c * float(z)});
    }
    thaw::SurfaceInput input() const {
        return {int(positions.size()), positions.data(), temperatures.data(), liquidFractions.data(), materials.data(),
                bodies.data(),         spacing};
    }
};

// A mesher with its own memory and threads.
struct Mesher {
    thaw::Allocator allocator;
    thaw::Tasks tasks;
    thaw::Surface surface;

    explicit Mesher(int workers = 1) : tasks(system(workers)), surface(allocator) {}
    static thawTaskSystem system(int workers) {
        thawTaskSystem s{};
        s.workerCount = workers;
        return s;
    }
    thaw::Surface& operator()(const Wax& wax, float cell = 0.75f, int smoothing = 1) {
        surface.extract(wax.input(), cell, smoothing, tasks);
        return surface;
    }
};

// What holds or not for a mesh as a whole.
struct MeshFacts {
    int badEdges = 0;    // directed edges that do not meet exactly one opposite
    int badVertices = 0; // in no triangle, or in more than one fan
    int components = 0;
    long euler = 0;
    double volume = 0;
};

inline MeshFacts factsOf(const thaw::Surface& s) {
    MeshFacts facts;
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    std::vector<std::map<uint32_t, uint32_t>> fans(s.positions.size());
    std::vector<uint32_t> root(s.positions.size());
    for (uint32_t v = 0; v < root.size(); ++v) root[v] = v;
    auto find = [&](uint32_t v) {
        while (root[v] != v) v = root[v] = root[root[v]];
        return v;
    };
    for (size_t t = 0; t < s.indices.size(); t += 3) {
        uint32_t v[3] = {s.indices[t], s.indices[t + 1], s.indices[t + 2]};
        for (int k = 0; k < 3; ++k) {
            ++edges[{v[k], v[(k + 1) % 3]}];
            fans[v[k]][v[(k + 1) % 3]] = v[(k + 2) % 3];
            root[find(v[k])] = find(v[(k + 1) % 3]);
        }
        double p[3][3];
        for (int k = 0; k < 3; ++k) {
            thaw::Vec3 q = s.positions[v[k]] - s.positions[0];
            p[k][0] = q.x, p[k][1] = q.y, p[k][2] = q.z;
        }
        facts.volume +=
            (p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) + p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
             p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0])) /
            6;
    }
    for (const auto& [edge, count] : edges) {
        auto opposite = edges.find({edge.second, edge.first});
        if (count != 1 || opposite == edges.end()) ++facts.badEdges;
    }
    for (const auto& fan : fans) {
        size_t steps = 0;
        if (!fan.empty()) {
            uint32_t start = fan.begin()->first, at = start;
            do {
                auto next = fan.find(at);
                if (next == fan.end()) break;
                at = next->second, ++steps;
            } while (at != start && steps <= fan.size());
        }
        if (fan.empty() || steps != fan.size()) ++facts.badVertices;
    }
    for (uint32_t v = 0; v < root.size(); ++v) facts.components += find(v) == v;
    facts.euler = long(s.positions.size()) - long(edges.size() / 2) + long(s.indices.size() / 3);
    return facts;
}
