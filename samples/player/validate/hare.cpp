// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "validate/hare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace thaw::player {
namespace {

struct Ellipsoid {
    double x, y, z, a, b, c; // centre and half axes, m
};
constexpr Ellipsoid kParts[] = {
    {0.000, -0.025, 0.000, 0.036, 0.034, 0.028},                                                // body
    {0.026, 0.004, 0.000, 0.019, 0.018, 0.016},                                                 // head
    {0.017, 0.036, 0.010, 0.008, 0.026, 0.007},   {0.017, 0.036, -0.010, 0.008, 0.026, 0.007},  // ears
    {0.026, -0.050, 0.014, 0.014, 0.009, 0.009},  {0.026, -0.050, -0.014, 0.014, 0.009, 0.009}, // paws
    {-0.012, -0.048, 0.022, 0.02, 0.012, 0.01},   {-0.012, -0.048, -0.022, 0.02, 0.012, 0.01},  // hind legs
    {-0.038, -0.036, 0.000, 0.010, 0.010, 0.010},                                               // tail
};
constexpr double kBlend = 0.006; // m, over which two parts run into one

// Below 0 inside; about the distance, m.
double distance(double x, double y, double z) {
    double all = 1;
    for (const Ellipsoid& e : kParts) {
        const double u = (x - e.x) / e.a, v = (y - e.y) / e.b, w = (z - e.z) / e.c;
        const double d = (std::sqrt(u * u + v * v + w * w) - 1) * std::min({e.a, e.b, e.c});
        const double h = std::max(0.0, kBlend - std::abs(all - d)) / kBlend;
        all = std::min(all, d) - 0.25 * kBlend * h * h;
    }
    return all;
}

} // namespace

scene::TriMesh makeHare() {
    constexpr double kCell = 0.0017;
    constexpr int kNx = 64, kNy = 80, kNz = 46;
    const auto at = [](int i, int j, int k) {
        return std::array<double, 3>{(i - kNx / 2 + 0.31) * kCell, (j - kNy / 2 + 0.17) * kCell,
                                     (k - kNz / 2 + 0.41) * kCell};
    };
    const auto index = [](int i, int j, int k) { return (k * (kNy + 1) + j) * (kNx + 1) + i; };
    std::vector<double> value(static_cast<size_t>((kNx + 1) * (kNy + 1) * (kNz + 1)));
    std::vector<std::array<double, 3>> place(value.size());
    for (int k = 0; k <= kNz; ++k)
        for (int j = 0; j <= kNy; ++j)
            for (int i = 0; i <= kNx; ++i) {
                const std::array<double, 3> p = at(i, j, k);
                const size_t n = static_cast<size_t>(index(i, j, k));
                place[n] = p, value[n] = distance(p[0], p[1], p[2]);
            }
    scene::TriMesh mesh;
    std::map<std::pair<int, int>, uint32_t> made;
    const auto crossing = [&](int a, int b) {
        const auto key = std::minmax(a, b);
        const auto [it, fresh] = made.try_emplace({key.first, key.second}, 0u);
        if (fresh) {
            const size_t u = static_cast<size_t>(key.first), v = static_cast<size_t>(key.second);
            const double t = value[u] / (value[u] - value[v]);
            it->second = mesh.addVertex(place[u][0] + t * (place[v][0] - place[u][0]),
                                        place[u][1] + t * (place[v][1] - place[u][1]),
                                        place[u][2] + t * (place[v][2] - place[u][2]));
        }
        return it->second;
    };
    // Counter-clockwise from outside, which is the side of `out`.
    const auto triangle = [&](uint32_t a, uint32_t b, uint32_t c, int out) {
        const auto vertex = [&](uint32_t v, size_t s) { return static_cast<double>(mesh.vertices[3 * v + s]); };
        double u[3], v[3], w[3];
        for (size_t s = 0; s < 3; ++s) {
            u[s] = vertex(b, s) - vertex(a, s), v[s] = vertex(c, s) - vertex(a, s);
            w[s] = place[static_cast<size_t>(out)][s] - vertex(a, s);
        }
        const double turn = (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] +
                            (u[0] * v[1] - u[1] * v[0]) * w[2];
        turn > 0 ? mesh.addTriangle(a, b, c) : mesh.addTriangle(a, c, b);
    };
    // Six tetrahedra around the cube's diagonal 0-7.
    constexpr int kTetrahedra[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                       {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
    for (int k = 0; k < kNz; ++k)
        for (int j = 0; j < kNy; ++j)
            for (int i = 0; i < kNx; ++i)
                for (const auto& corners : kTetrahedra) {
                    int in[4], out[4], ins = 0, outs = 0;
                    for (const int c : corners) {
                        const int n = index(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1));
                        (value[static_cast<size_t>(n)] < 0 ? in[ins++] : out[outs++]) = n;
                    }
                    if (ins == 1)
                        triangle(crossing(in[0], out[0]), crossing(in[0], out[1]), crossing(in[0], out[2]), out[0]);
                    if (ins == 3)
                        triangle(crossing(in[0], out[0]), crossing(in[1], out[0]), crossing(in[2], out[0]), out[0]);
                    if (ins == 2) {
                        const uint32_t a = crossing(in[0], out[0]), b = crossing(in[0], out[1]),
                                       c = crossing(in[1], out[1]), d = crossing(in[1], out[0]);
                        triangle(a, b, c, out[1]), triangle(a, c, d, out[0]);
                    }
                }
    return mesh;
}

} // namespace thaw::player
