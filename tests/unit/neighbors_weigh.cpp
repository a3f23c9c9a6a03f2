// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "unit/neighbors_cloud.h"

#include <doctest/doctest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <string>

using namespace thaw;

namespace {

constexpr float kDx = 0.002f;

struct Sums {
    double fraction, x, y, z, square;
};

// The definition, in double, over the list of row i.
Sums reference(const Cloud& c, int i) {
    const double pi = 3.14159265358979323846, s0 = double(latticeSum());
    const Particles& p = c.particles;
    size_t row = static_cast<size_t>(i);
    const Vec4& a = p.position[row];
    Sums s{double(c.volume[row]) * 21 / (2 * pi) / std::pow(double(a.w), 3) / s0, 0, 0, 0, 0};
    for (int j : c.list(i)) {
        size_t k = static_cast<size_t>(j);
        const Vec4& b = p.position[k];
        double dx = double(a.x) - double(b.x), dy = double(a.y) - double(b.y), dz = double(a.z) - double(b.z);
        double r = std::sqrt(dx * dx + dy * dy + dz * dz), h = 0.5 * (double(a.w) + double(b.w)), q = r / h;
        if (q >= 1) continue;
        double w = 21 / (2 * pi) * std::pow(1 - q, 4) * (1 + 4 * q) / (h * h * h);
        double g = -210 / pi * std::pow(1 - q, 3) / std::pow(h, 5) / s0; // W'(r) / r
        double v = double(c.volume[k]);
        s.fraction += v * w / s0;
        s.x += v * g * dx, s.y += v * g * dy, s.z += v * g * dz;
        s.square += v * g * g * r * r * double(c.invDensity[k]);
    }
    return s;
}

std::vector<Cloud::Point> melted(bool levels) {
    std::vector<Cloud::Point> points = lattice(12, 11, 13, kDx, 0.3f);
    for (size_t i = 0; i < points.size(); ++i) {
        if (levels && i % 5 == 0) points[i].support *= i % 2 ? 1.26f : 2;
        points[i].fixed = points[i].position.y < 2.5f * kDx;
    }
    return points;
}

} // namespace

TEST_CASE("neighbors: weigh equals the definition on every instruction set") {
    for (bool levels : {false, true})
        for (int64_t target : hwy::SupportedAndGeneratedTargets()) {
            CAPTURE(levels);
            const std::string name = hwy::TargetName(target);
            CAPTURE(name);
            hwy::SetSupportedTargetsForTest(target);
            Cloud c(melted(levels), 2);
            c.sort(), c.build(), c.weigh();
            const double bulk = 1 / (double(bulkStiffness()) * 1000 * std::pow(double(kDx), 5));
            double worst = 0, worstGradient = 0, worstSquare = 0, dummies = 0;
            for (int i = 0; i < c.particles.count; ++i) {
                size_t k = static_cast<size_t>(i);
                Sums s = reference(c, i);
                const Vec4& g = c.neighbors.gradientSum[k];
                double scale = 1 / double(c.particles.position[k].w); // a one-sided neighbourhood gives about 1 / h
                worst = std::max(worst, std::fabs(double(c.neighbors.volumeFraction[k]) - s.fraction) / s.fraction);
                worstGradient = std::max({worstGradient, std::fabs(double(g.x) - s.x) / scale,
                                          std::fabs(double(g.y) - s.y) / scale, std::fabs(double(g.z) - s.z) / scale});
                const double square = i / 8 < c.neighbors.moverGroups ? s.square : 0;
                worstSquare = std::max(worstSquare, std::fabs(double(g.w) - square) / (square + 0.01 * bulk));
            }
            for (int g = 0; g < c.neighbors.groupCount; ++g)
                for (uint32_t k = 0; k < 8 * c.neighbors.width[static_cast<size_t>(g)]; ++k) {
                    size_t at = c.neighbors.first[static_cast<size_t>(g)] + k;
                    if (c.neighbors.entries[at] == 16u * static_cast<uint32_t>(c.particles.count))
                        dummies += std::fabs(double(c.neighbors.gradient[at]));
                    else
                        CHECK(c.neighbors.gradient[at] <= 0);
                }
            CHECK(worst < 1e-5);
            CHECK(worstGradient < 1e-5);
            CHECK(worstSquare < 1e-5);
            CHECK(dummies == 0);
        }
    hwy::SetSupportedTargetsForTest(0);
}

TEST_CASE("neighbors: the lattice has density 1, no gradient and the bulk stiffness") {
    Cloud c(lattice(11, 11, 11, kDx));
    c.sort(), c.build(), c.weigh();
    int inside = 0;
    for (int i = 0; i < c.particles.count; ++i) {
        size_t k = static_cast<size_t>(i);
        auto deep = [](float v) { return v > 3.5f * kDx && v < 6.5f * kDx; };
        const Vec4& x = c.particles.position[k];
        if (!deep(x.x) || !deep(x.y) || !deep(x.z)) continue;
        ++inside;
        const Vec4& g = c.neighbors.gradientSum[k];
        CHECK(c.neighbors.volumeFraction[k] == doctest::Approx(1).epsilon(1e-4));
        CHECK(length(g.xyz()) * x.w < 1e-4f);
        // sum V |grad W|^2 / rho = 1 / (bulkStiffness rho dx^5)
        CHECK(double(g.w) * 1000 * std::pow(double(kDx), 5) ==
              doctest::Approx(1 / double(bulkStiffness())).epsilon(1e-4).scale(0));
        CHECK(c.list(i).size() == 32);
    }
    CHECK(inside == 27);
}

TEST_CASE("neighbors: the gradient sum points out of the body at its surface") {
    Cloud c(lattice(9, 9, 9, kDx));
    c.sort(), c.build(), c.weigh();
    for (int i = 0; i < c.particles.count; ++i) {
        const Vec4 &x = c.particles.position[static_cast<size_t>(i)],
                   &g = c.neighbors.gradientSum[static_cast<size_t>(i)];
        if (x.y < 7.5f * kDx || std::fabs(x.x - 4 * kDx) > 0.5f * kDx || std::fabs(x.z - 4 * kDx) > 0.5f * kDx)
            continue;
        CHECK(-g.y * kDx > 0.3f); // V grad W sums to -(outward) / about 2 dx
        CHECK(std::fabs(g.x) * kDx < 1e-4f);
    }
}
