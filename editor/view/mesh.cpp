// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "view/mesh.h"

#include <algorithm>

namespace thaw::view {

namespace {

constexpr float kPi = 3.14159265f;

uint32_t push(TriangleMesh& mesh, Vec3 p, Vec3 n) {
    mesh.positions.insert(mesh.positions.end(), {p.x, p.y, p.z});
    mesh.normals.insert(mesh.normals.end(), {n.x, n.y, n.z});
    return static_cast<uint32_t>(mesh.positions.size() / 3 - 1);
}

// Rings of `segments` + 1 vertices about +y, from the bottom up, joined by quads.
void joinRings(TriangleMesh& mesh, uint32_t first, int rings, int segments) {
    for (int j = 0; j + 1 < rings; ++j)
        for (int i = 0; i < segments; ++i) {
            const uint32_t a = first + static_cast<uint32_t>(j * (segments + 1) + i);
            const uint32_t b = a + static_cast<uint32_t>(segments + 1);
            mesh.indices.insert(mesh.indices.end(), {a, b, a + 1, a + 1, b, b + 1});
        }
}

} // namespace

Bounds TriangleMesh::bounds() const {
    Bounds b;
    for (size_t i = 0; i + 2 < positions.size(); i += 3) b.add(Vec3{positions[i], positions[i + 1], positions[i + 2]});
    return b;
}

TriangleMesh makeBox(Vec3 h) {
    TriangleMesh mesh;
    // Faces are cut into 6 x 6: the shadow map of a flame bends straight edges between vertices.
    constexpr int kCuts = 6;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = -1; side <= 1; side += 2) {
            const auto make = [&](float u, float v) {
                float c[3];
                c[axis] = static_cast<float>(side);
                c[(axis + 1) % 3] = u;
                c[(axis + 2) % 3] = v;
                return Vec3{c[0] * h.x, c[1] * h.y, c[2] * h.z};
            };
            float n[3] = {0, 0, 0};
            n[axis] = static_cast<float>(side);
            const uint32_t first = static_cast<uint32_t>(mesh.positions.size() / 3);
            for (int j = 0; j <= kCuts; ++j)
                for (int i = 0; i <= kCuts; ++i)
                    push(mesh, make(2.0f * i / kCuts - 1, 2.0f * j / kCuts - 1), {n[0], n[1], n[2]});
            for (uint32_t j = 0; j < kCuts; ++j)
                for (uint32_t i = 0; i < kCuts; ++i) {
                    const uint32_t a = first + j * (kCuts + 1) + i, b = a + kCuts + 1;
                    if (side > 0)
                        mesh.indices.insert(mesh.indices.end(), {a, a + 1, b, b, a + 1, b + 1});
                    else
                        mesh.indices.insert(mesh.indices.end(), {a, b, a + 1, a + 1, b, b + 1});
                }
        }
    return mesh;
}

TriangleMesh makeSphere(float radius, int segments) {
    TriangleMesh mesh;
    segments = std::clamp(segments, 8, 512);
    const int rings = segments / 2 + 1;
    for (int j = 0; j < rings; ++j)
        for (int i = 0; i <= segments; ++i) {
            const float b = kPi * j / (rings - 1) - kPi / 2, a = 2 * kPi * i / segments;
            const Vec3 n{std::cos(b) * std::cos(a), std::sin(b), std::cos(b) * std::sin(a)};
            push(mesh, n * radius, n);
        }
    joinRings(mesh, 0, rings, segments);
    return mesh;
}

TriangleMesh makePlane(float halfSize) {
    TriangleMesh mesh;
    const Vec3 up{0, 1, 0};
    push(mesh, {-halfSize, 0, -halfSize}, up);
    push(mesh, {-halfSize, 0, halfSize}, up);
    push(mesh, {halfSize, 0, halfSize}, up);
    push(mesh, {halfSize, 0, -halfSize}, up);
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

TriangleMesh makeCylinder(float radius, float height, int segments) {
    TriangleMesh mesh;
    segments = std::clamp(segments, 6, 512);
    constexpr int kWall = 8, kCap = 6;
    const float cap = std::min(radius, height);
    int rings = 0;
    const auto ring = [&](float y, float r, float ny) {
        const float nr = std::sqrt(std::max(0.0f, 1 - ny * ny));
        for (int i = 0; i <= segments; ++i) {
            const float a = 2 * kPi * i / segments, c = std::cos(a), s = std::sin(a);
            push(mesh, {r * c, y, r * s}, {nr * c, ny, nr * s});
        }
        ++rings;
    };
    ring(0, 0, -1);
    ring(0, radius, -1);
    for (int j = 0; j <= kWall; ++j) ring((height - cap) * j / kWall, radius, 0);
    for (int j = 1; j <= kCap; ++j) {
        const float b = kPi / 2 * j / kCap;
        ring(height - cap + cap * std::sin(b), radius * std::cos(b), std::sin(b));
    }
    joinRings(mesh, 0, rings, segments);
    return mesh;
}

TriangleMesh makeMesh(const thawMesh& source) {
    TriangleMesh mesh;
    mesh.positions.assign(source.vertices, source.vertices + source.vertexCount * 3);
    mesh.normals.assign(source.vertexCount * 3, 0);
    for (size_t t = 0; t < source.triangleCount; ++t) {
        const uint32_t* corner = source.indices + t * 3;
        if (std::max({corner[0], corner[1], corner[2]}) >= source.vertexCount) continue;
        mesh.indices.insert(mesh.indices.end(), corner, corner + 3);
        const auto at = [&](int k) {
            const float* p = source.vertices + size_t(corner[k]) * 3;
            return Vec3{p[0], p[1], p[2]};
        };
        const Vec3 n = cross(at(1) - at(0), at(2) - at(0));
        for (int k = 0; k < 3; ++k) {
            float* out = mesh.normals.data() + size_t(corner[k]) * 3;
            out[0] += n.x, out[1] += n.y, out[2] += n.z;
        }
    }
    for (size_t i = 0; i < mesh.normals.size(); i += 3) {
        const Vec3 n = normalize({mesh.normals[i], mesh.normals[i + 1], mesh.normals[i + 2]});
        mesh.normals[i] = n.x, mesh.normals[i + 1] = n.y, mesh.normals[i + 2] = n.z;
    }
    return mesh;
}

} // namespace thaw::view
