// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "mesh.h"

#include <cmath>
#include <numbers>

namespace thaw::scene {

TriMesh makePan() {
    constexpr double kFloor = 0.112, kRim = 0.132, kHeight = 0.034, kWall = 0.0035;
    std::vector<ProfilePoint> profile{{0.0, -kWall}, {kFloor - 0.004, -kWall}};
    for (int i = 0; i <= 10; ++i) { // outside, up
        const double t = i / 10.0;
        profile.push_back({kFloor + kWall + (kRim - kFloor) * t, -kWall + 0.002 + (kHeight + kWall - 0.002) * t * t});
    }
    profile.push_back({kRim + 0.5 * kWall, kHeight + 0.0012});
    for (int i = 10; i >= 0; --i) { // inside, down
        const double t = i / 10.0;
        profile.push_back({kFloor + (kRim - kFloor) * t, kHeight * t * t});
    }
    profile.push_back({0.05, 0.0}), profile.push_back({0.0, 0.0});
    TriMesh pan = makeLathe(profile, 96);
    // A handle: a bar with round ends, flat, that leaves the rim and rises.
    constexpr double kLength = 0.17, kRadius = 0.0095;
    std::vector<ProfilePoint> bar;
    for (int i = 0; i <= 6; ++i) {
        const double a = 0.5 * std::numbers::pi * i / 6;
        bar.push_back({kRadius * std::sin(a), kRadius * (1 - std::cos(a))});
    }
    for (int i = 6; i >= 0; --i) {
        const double a = 0.5 * std::numbers::pi * i / 6;
        bar.push_back({1.25 * kRadius * std::sin(a), kLength - kRadius * (1 - std::cos(a))});
    }
    const TriMesh handle = makeLathe(bar, 24);
    const uint32_t first = uint32_t(pan.vertexCount());
    for (size_t v = 0; v < handle.vertices.size(); v += 3) {
        const double across = double(handle.vertices[v]), along = double(handle.vertices[v + 1]),
                     up = double(handle.vertices[v + 2]);
        // (across, along, up) is right-handed in the order z, x, y.
        pan.addVertex(kRim + 0.0005 + along, kHeight - 0.008 + 0.55 * up + 0.16 * along, across);
    }
    for (const uint32_t i : handle.indices) pan.indices.push_back(first + i);
    return pan;
}

} // namespace thaw::scene
