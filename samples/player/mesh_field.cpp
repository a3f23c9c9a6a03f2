// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "mesh_field.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace thaw::scene {

double blendedMin(double a, double b, double blend) {
    const double h = std::max(0.0, blend - std::abs(a - b)) / blend;
    return std::min(a, b) - 0.25 * blend * h * h;
}

TriMesh meshOfField(const FieldLattice& l, const std::function<double(double x, double y, double z)>& field) {
    const int across[3] = {1, l.nx + 1, (l.nx + 1) * (l.ny + 1)};
    const auto index = [&](int i, int j, int k) { return size_t(k * across[2] + j * across[1] + i); };
    std::vector<double> value(index(l.nx, l.ny, l.nz) + 1);
    for (int k = 0; k <= l.nz; ++k)
        for (int j = 0; j <= l.ny; ++j)
            for (int i = 0; i <= l.nx; ++i)
                value[index(i, j, k)] = field(l.x + i * l.cell, l.y + j * l.cell, l.z + k * l.cell);
    TriMesh mesh;
    // A vertex in each cube that the surface crosses, in the middle of where it crosses its edges.
    std::vector<uint32_t> made(value.size(), UINT32_MAX);
    for (int k = 0; k < l.nz; ++k)
        for (int j = 0; j < l.ny; ++j)
            for (int i = 0; i < l.nx; ++i) {
                double sum[3] = {};
                int count = 0;
                for (int axis = 0; axis < 3; ++axis)
                    for (int side = 0; side < 4; ++side) {
                        int c[3] = {};
                        c[(axis + 1) % 3] = side & 1, c[(axis + 2) % 3] = side >> 1;
                        const size_t a = index(i + c[0], j + c[1], k + c[2]), b = a + size_t(across[axis]);
                        if ((value[a] < 0) == (value[b] < 0)) continue;
                        const double t = value[a] / (value[a] - value[b]);
                        for (int s = 0; s < 3; ++s) sum[s] += c[s] + (s == axis ? t : 0);
                        ++count;
                    }
                if (count)
                    made[index(i, j, k)] =
                        mesh.addVertex(l.x + (i + sum[0] / count) * l.cell, l.y + (j + sum[1] / count) * l.cell,
                                       l.z + (k + sum[2] / count) * l.cell);
            }
    // A square around each edge that it crosses, counter-clockwise from outside.
    for (int k = 1; k < l.nz; ++k)
        for (int j = 1; j < l.ny; ++j)
            for (int i = 1; i < l.nx; ++i)
                for (int axis = 0; axis < 3; ++axis) {
                    const size_t a = index(i, j, k), b = a + size_t(across[axis]);
                    const bool in = value[a] < 0;
                    if (in == (value[b] < 0)) continue;
                    const size_t u = size_t(across[(axis + 1) % 3]), v = size_t(across[(axis + 2) % 3]);
                    uint32_t q[4] = {made[a - u - v], made[a - v], made[a], made[a - u]};
                    if (!in) std::swap(q[1], q[3]);
                    mesh.addTriangle(q[0], q[1], q[2]), mesh.addTriangle(q[0], q[2], q[3]);
                }
    return mesh;
}

} // namespace thaw::scene
