// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "validate/mesh_of.h"

#include <algorithm>
#include <numeric>

namespace thaw::player {

Mesh::Mesh(const thawSurfaceView& s) {
    for (int v = 0; v < s.vertexCount; ++v)
        points.push_back({double(s.positions[3 * v]), double(s.positions[3 * v + 1]), double(s.positions[3 * v + 2])});
    for (int t = 0; t < s.triangleCount; ++t)
        triangles.push_back({s.indices[3 * t], s.indices[3 * t + 1], s.indices[3 * t + 2]});
}

void Mesh::faults(int& open, int& tangled) const {
    // Each edge as its lower vertex, its higher one, and which way it runs; those of one edge come together.
    std::vector<std::array<uint32_t, 3>> edges;
    edges.reserve(3 * triangles.size());
    for (const auto& t : triangles)
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = t[k], b = t[(k + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), a < b ? 0u : 1u});
        }
    std::sort(edges.begin(), edges.end());
    open = tangled = 0;
    for (size_t i = 0, end; i < edges.size(); i = end) {
        int uses[2] = {};
        for (end = i; end < edges.size() && edges[end][0] == edges[i][0] && edges[end][1] == edges[i][1]; ++end)
            ++uses[edges[end][2]];
        open += uses[0] + uses[1] == 1, tangled += uses[0] > 1 || uses[1] > 1;
    }
}

double Mesh::volume() const {
    double sum = 0;
    for (const auto& t : triangles) sum += dot(points[t[0]], cross(points[t[1]], points[t[2]])) / 6;
    return sum;
}

int Mesh::pieces() const {
    std::vector<uint32_t> parent(points.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const auto& t : triangles) parent[root(t[0])] = root(t[1]), parent[root(t[1])] = root(t[2]);
    int count = 0;
    for (uint32_t v = 0; v < parent.size(); ++v) count += parent[v] == v;
    return count;
}

} // namespace thaw::player
