// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "geometry_shapes.h"

#include "geometry/triangle_tree.h"

#include <algorithm>

namespace shapes {

namespace {

double kernel(double r) { // Wendland C2 with support 2.2, not normalised
    double q = r / 2.2;
    return q >= 1 ? 0 : std::pow(1 - q, 4) * (4 * q + 1);
}

} // namespace

Quality measure(const thaw::CleanMesh& mesh, const std::vector<Vec3>& points, float spacing) {
    Quality result;
    result.count = points.size();
    if (points.empty()) return result;
    thaw::TriangleTree tree(mesh.vertices, mesh.indices);
    for (Vec3 p : points) {
        float d = std::sqrt(tree.nearest(p).distance2) / spacing;
        if (tree.winding(p) <= 0.5f) d = -d;
        result.depths.push_back(d);
        result.minDepth = std::min(result.minDepth, double(d));
    }
    auto cell = [&](Vec3 p) {
        float size = 2.2f * spacing;
        return std::array<int, 3>{int(std::floor(p.x / size)), int(std::floor(p.y / size)),
                                  int(std::floor(p.z / size))};
    };
    std::map<std::array<int, 3>, std::vector<uint32_t>> cells;
    for (uint32_t i = 0; i < points.size(); ++i) cells[cell(points[i])].push_back(i);
    auto forNear = [&](Vec3 p, auto&& f) {
        std::array<int, 3> c = cell(p);
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x) {
                    auto it = cells.find({c[0] + x, c[1] + y, c[2] + z});
                    if (it == cells.end()) continue;
                    for (uint32_t j : it->second) f(j, double(thaw::length(points[j] - p)) / spacing);
                }
    };
    double lattice = 0;
    for (int z = -2; z <= 2; ++z)
        for (int y = -2; y <= 2; ++y)
            for (int x = -2; x <= 2; ++x) lattice += kernel(std::sqrt(double(x * x + y * y + z * z)));
    for (uint32_t i = 0; i < points.size(); ++i) {
        double sum = 0;
        forNear(points[i], [&](uint32_t j, double r) {
            sum += kernel(r);
            if (j != i) result.minPair = std::min(result.minPair, r);
        });
        if (result.depths[i] < 2.2f) continue;
        double error = std::abs(sum / lattice - 1);
        ++result.interior, result.meanError += error, result.maxError = std::max(result.maxError, error);
    }
    if (result.interior) result.meanError /= double(result.interior);
    // Surface: corners and a barycentric raster of each triangle, about 0.3 spacings apart, so that small triangles are
    // seen too.
    size_t looked = 0, bare = 0;
    for (size_t t = 0; t < mesh.indices.size(); t += 3) {
        Vec3 a = mesh.vertices[mesh.indices[t]], b = mesh.vertices[mesh.indices[t + 1]],
             c = mesh.vertices[mesh.indices[t + 2]];
        float longest = std::max(thaw::length(b - a), std::max(thaw::length(c - a), thaw::length(c - b)));
        int n = std::clamp(int(std::ceil(longest / (0.3f * spacing))), 1, 1000);
        for (int i = 0; i <= n; ++i)
            for (int j = 0; j <= n - i; ++j) {
                Vec3 p = a + (float(i) / float(n)) * (b - a) + (float(j) / float(n)) * (c - a);
                double nearest = 2.2;
                forNear(p, [&](uint32_t, double r) { nearest = std::min(nearest, r); });
                result.maxGap = std::max(result.maxGap, nearest);
                ++looked, bare += nearest > 1;
            }
    }
    result.gapShare = looked ? double(bare) / double(looked) : 0;
    return result;
}

} // namespace shapes
