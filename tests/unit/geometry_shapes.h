// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "geometry/mesh_fill.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

// Meshes with known answers, and the measures of a filling.
namespace shapes {

using thaw::Vec3;

struct Mesh {
    std::vector<float> vertices;
    std::vector<uint32_t> indices;

    uint32_t vertex(Vec3 p) {
        vertices.insert(vertices.end(), {p.x, p.y, p.z});
        return uint32_t(vertices.size() / 3 - 1);
    }
    void triangle(uint32_t a, uint32_t b, uint32_t c) { indices.insert(indices.end(), {a, b, c}); }
    void quad(uint32_t a, uint32_t b, uint32_t c, uint32_t d) { triangle(a, b, c), triangle(a, c, d); }
    void append(const Mesh& o, Vec3 at = {}, bool inward = false) {
        uint32_t first = uint32_t(vertices.size() / 3);
        for (size_t i = 0; i < o.vertices.size(); i += 3)
            vertex({o.vertices[i] + at.x, o.vertices[i + 1] + at.y, o.vertices[i + 2] + at.z});
        for (size_t i = 0; i < o.indices.size(); i += 3)
            triangle(first + o.indices[i], first + o.indices[i + (inward ? 2 : 1)],
                     first + o.indices[i + (inward ? 1 : 2)]);
    }
    thawMesh view() const { return {vertices.data(), vertices.size() / 3, indices.data(), indices.size() / 3}; }
};

inline Mesh tetrahedron() {
    Mesh m;
    m.vertex({0, 0, 0}), m.vertex({1, 0, 0}), m.vertex({0, 1, 0}), m.vertex({0, 0, 1});
    m.triangle(0, 2, 1), m.triangle(0, 1, 3), m.triangle(0, 3, 2), m.triangle(1, 2, 3);
    return m;
}

// Two triangles per face, around the origin.
inline Mesh box(Vec3 size) {
    Mesh m;
    for (uint32_t i = 0; i < 8; ++i)
        m.vertex({(i & 1 ? 0.5f : -0.5f) * size.x, (i & 2 ? 0.5f : -0.5f) * size.y, (i & 4 ? 0.5f : -0.5f) * size.z});
    m.quad(0, 2, 3, 1), m.quad(4, 5, 7, 6), m.quad(0, 1, 5, 4), m.quad(2, 6, 7, 3), m.quad(0, 4, 6, 2),
        m.quad(1, 3, 7, 5);
    return m;
}

inline Mesh icosphere(float radius, int levels) {
    Mesh m;
    std::vector<Vec3> v;
    float t = (1 + std::sqrt(5.0f)) / 2;
    for (Vec3 p : {Vec3{-1, t, 0},
                   {1, t, 0},
                   {-1, -t, 0},
                   {1, -t, 0},
                   {0, -1, t},
                   {0, 1, t},
                   {0, -1, -t},
                   {0, 1, -t},
                   {t, 0, -1},
                   {t, 0, 1},
                   {-t, 0, -1},
                   {-t, 0, 1}})
        v.push_back(p);
    std::vector<uint32_t> f = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                               4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                               6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
    for (int l = 0; l < levels; ++l) {
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> middle;
        auto mid = [&](uint32_t a, uint32_t b) {
            auto key = std::make_pair(std::min(a, b), std::max(a, b));
            auto it = middle.find(key);
            if (it != middle.end()) return it->second;
            v.push_back(0.5f * (thaw::normalizeOr(v[a], {}) + thaw::normalizeOr(v[b], {})));
            return middle[key] = uint32_t(v.size() - 1);
        };
        std::vector<uint32_t> g;
        for (size_t i = 0; i < f.size(); i += 3) {
            uint32_t a = f[i], b = f[i + 1], c = f[i + 2], ab = mid(a, b), bc = mid(b, c), ca = mid(c, a);
            g.insert(g.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
        }
        f = g;
    }
    for (Vec3 p : v) m.vertex(radius * thaw::normalizeOr(p, {}));
    m.indices = f;
    return m;
}

inline Mesh torus(float ring, float tube, int n, int k) {
    Mesh m;
    constexpr float kTurn = 6.2831853f;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < k; ++j) {
            float a = kTurn * float(i) / float(n), b = kTurn * float(j) / float(k), r = ring + tube * std::cos(b);
            m.vertex({r * std::cos(a), tube * std::sin(b), r * std::sin(a)});
        }
    auto at = [&](int i, int j) { return uint32_t(i % n * k + j % k); };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < k; ++j) m.quad(at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
    return m;
}

// Closed, along y, with flat ends.
inline Mesh cylinder(float radius, float height, int n) {
    Mesh m;
    for (int i = 0; i < n; ++i) {
        float a = 6.2831853f * float(i) / float(n);
        m.vertex({radius * std::cos(a), -0.5f * height, radius * std::sin(a)});
        m.vertex({radius * std::cos(a), 0.5f * height, radius * std::sin(a)});
    }
    uint32_t low = m.vertex({0, -0.5f * height, 0}), high = m.vertex({0, 0.5f * height, 0}), k = uint32_t(n);
    for (uint32_t i = 0; i < k; ++i) {
        uint32_t j = (i + 1) % k;
        m.quad(2 * i, 2 * i + 1, 2 * j + 1, 2 * j), m.triangle(low, 2 * i, 2 * j),
            m.triangle(high, 2 * j + 1, 2 * i + 1);
    }
    return m;
}

// Positions and triangles of a Wavefront file; false when it is not there.
inline bool readObj(const char* path, Mesh& m) {
    std::FILE* file = std::fopen(path, "r");
    if (!file) return false;
    char line[512];
    while (std::fgets(line, sizeof line, file)) {
        float x, y, z;
        if (std::sscanf(line, "v %f %f %f", &x, &y, &z) == 3) {
            m.vertex({x, y, z});
        } else if (line[0] == 'f' && line[1] == ' ') {
            std::vector<uint32_t> face;
            for (char* p = line + 1; *p;) {
                char* end = nullptr;
                long i = std::strtol(p, &end, 10);
                if (end == p) break;
                face.push_back(uint32_t(i - 1));
                p = end;
                while (*p && *p != ' ') ++p; // the other indices of this corner
            }
            for (size_t k = 2; k < face.size(); ++k) m.triangle(face[0], face[k - 1], face[k]);
        }
    }
    std::fclose(file);
    return true;
}

inline constexpr const char* kBunny = "/usr/share/glmark2/models/bunny.obj";

// How good a filling is; lengths in spacings.
struct Quality {
    size_t count = 0;
    double minDepth = INFINITY; // exact distance to the mesh, negative outside
    double minPair = INFINITY;
    double maxGap = 0;                  // farthest surface point from its nearest particle
    double gapShare = 0;                // share of surface points farther than 1 from any particle
    double meanError = 0, maxError = 0; // of the density, deeper than 2.2
    size_t interior = 0;
    std::vector<float> depths; // of each particle
};

Quality measure(const thaw::CleanMesh& mesh, const std::vector<Vec3>& points, float spacing);

} // namespace shapes
