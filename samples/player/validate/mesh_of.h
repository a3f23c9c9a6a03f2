// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "thaw/thaw.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace thaw::player {

using Point = std::array<double, 3>;

inline Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// A surface as the host gets it, copied.
struct Mesh {
    std::vector<Point> points;
    std::vector<std::array<uint32_t, 3>> triangles;

    explicit Mesh(const thawSurfaceView& s);

    // Edges with one triangle, and with more than two or two that run the same way.
    void faults(int& open, int& tangled) const;
    double volume() const; // enclosed, m^3
    int pieces() const;
    template <class F> double mean(F&& distance) const {
        double sum = 0;
        for (const Point& x : points) sum += std::abs(distance(x));
        return points.empty() ? 0 : sum / double(points.size());
    }
};

} // namespace thaw::player
