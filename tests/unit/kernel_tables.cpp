// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/kernel.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

using namespace thaw;

namespace {

constexpr double kPi = 3.14159265358979323846;

double w(double q) { return q < 1 ? 21 / (2 * kPi) * std::pow(1 - q, 4) * (1 + 4 * q) : 0; }
double dw(double q) { return q < 1 ? -210 / kPi * q * std::pow(1 - q, 3) : 0; }

} // namespace

TEST_CASE("kernel: the constants are those of Wendland C2") {
    CHECK(double(kWendland) == doctest::Approx(21 / (2 * kPi)).epsilon(1e-7));
    CHECK(double(kWendlandGradient) == doctest::Approx(210 / kPi).epsilon(1e-7));
    double mass = 0;
    for (int k = 0; k < 100000; ++k) {
        double q = (k + 0.5) / 100000;
        mass += 4 * kPi * q * q * w(q) / 100000;
    }
    CHECK(mass == doctest::Approx(1).epsilon(1e-6));
    CHECK((w(0.5001) - w(0.4999)) / 0.0002 == doctest::Approx(dw(0.5)).epsilon(1e-5));
}

TEST_CASE("kernel: lattice constants equal the sums") {
    const double h = double(kSupport);
    double s = 0, shear = 0, square = 0;
    for (int i = -4; i <= 4; ++i)
        for (int j = -4; j <= 4; ++j)
            for (int k = -4; k <= 4; ++k) {
                double r = std::sqrt(double(i * i + j * j + k * k));
                s += w(r / h) / std::pow(h, 3);
                if (r == 0) continue;
                double slope = dw(r / h) / std::pow(h, 4);
                // Stress of v_x = z for unit viscosity, from 10 (v.x) x / (r^2 + 0.01 h^2) per pair, halved.
                shear += 5 * -slope / r * (double(i) * k) * (double(i) * k) / (r * r + 0.01 * h * h);
                square += slope * slope;
            }
    CHECK(double(latticeSum()) == doctest::Approx(s).epsilon(1e-6));
    CHECK(double(shearMoment()) == doctest::Approx(shear).epsilon(1e-6));
    CHECK(double(bulkStiffness()) == doctest::Approx(s * s / square).epsilon(1e-6));
    CHECK(latticeSum() == doctest::Approx(1.02455).epsilon(1e-4));
    CHECK(shearMoment() == doctest::Approx(0.7408).epsilon(1e-4));
}

TEST_CASE("kernel: wall fraction is the kernel's share of a half space") {
    const WallTable& t = wallTable();
    CHECK(WallTable::lookup(t.fraction, -1) == doctest::Approx(1).epsilon(1e-4));
    CHECK(WallTable::lookup(t.fraction, -3) == WallTable::lookup(t.fraction, -1));
    CHECK(WallTable::lookup(t.fraction, 0) == doctest::Approx(0.5).epsilon(1e-4));
    CHECK(WallTable::lookup(t.fraction, 1) == 0);
    CHECK(WallTable::lookup(t.fraction, 7) == 0);
    for (double q : {-0.8, -0.35, 0.1, 0.4, 0.75}) {
        CAPTURE(q);
        // Caps of spheres: a shell of radius r has the share (1 - q / r) / 2 behind the plane.
        double share = 0;
        const int n = 20000;
        for (int k = 0; k < n; ++k) {
            double r = (k + 0.5) / n, behind = std::min(1.0, std::max(0.0, 0.5 * (1 - q / r)));
            share += 4 * kPi * r * r * w(r) * behind / n;
        }
        float qf = static_cast<float>(q);
        CHECK(double(WallTable::lookup(t.fraction, qf)) == doctest::Approx(share).epsilon(2e-4).scale(0.01));
        CHECK(WallTable::lookup(t.fraction, qf) + WallTable::lookup(t.fraction, -qf) ==
              doctest::Approx(1).epsilon(1e-4));
    }
}

TEST_CASE("kernel: at a wall the first layer of a lattice is without density error, and pushed as by another layer") {
    const WallTable& t = wallTable();
    const double h = double(kSupport);
    // A layer's share at distance d, averaged over where it lies, and what it pushes with.
    const auto layer = [&](double d) {
        double share = 0;
        const int n = 20000;
        for (int k = 0; k < n && d < h; ++k) {
            double r = d + (h - d) * (k + 0.5) / n;
            share += 2 * kPi * r * w(r / h) / (h * h * h) * (h - d) / n;
        }
        return share / double(latticeSum());
    };
    const auto at = [&](const float* table, double spacings) {
        return double(WallTable::lookup(table, static_cast<float>(spacings / h)));
    };
    const double rest = double(kWallRest);
    CHECK(at(t.mirrored, rest) == doctest::Approx(layer(1) + layer(2)).epsilon(2e-3).scale(0));
    for (double d : {0.35, 0.45, 0.6, 0.8}) {
        CAPTURE(d);
        const double near = 1 + 2 * (d - rest), next = d + 2 - rest, e = 1e-3;
        CHECK(at(t.mirrored, d) == doctest::Approx(layer(near) + layer(next)).epsilon(2e-3).scale(0.01));
        const double push = h * (2 * (layer(near - e) - layer(near + e)) + layer(next - e) - layer(next + e)) / (2 * e);
        CHECK(at(t.mirroredGradient, d) == doctest::Approx(push).epsilon(5e-3).scale(0.05));
    }
    for (float q = -1; q < 1; q += 0.02f) {
        CHECK(WallTable::lookup(t.mirrored, q) >= WallTable::lookup(t.mirrored, q + 0.02f));
        CHECK(WallTable::lookup(t.mirrored, q) <= 1);
        CHECK(WallTable::lookup(t.mirroredGradient, q) >= 0);
    }
    CHECK(WallTable::lookup(t.mirrored, -1) == 1);
}

TEST_CASE("kernel: the no-slip weight along the normal equals the volume integral") {
    const WallTable& t = wallTable();
    for (double q : {0.1, 0.136, 0.3, 0.6}) {
        CAPTURE(q);
        double normal = 0;
        const int nz = 600, ns = 600;
        for (int a = 0; a < nz; ++a) {
            double z = q + (1 - q) * (a + 0.5) / nz, rim = std::sqrt(1 - z * z);
            for (int b = 0; b < ns; ++b) {
                double s = rim * (b + 0.5) / ns, r = std::sqrt(z * z + s * s);
                double k = 10 * -dw(r) / (r * (r * r + 0.01)) * 2 * kPi * s * (rim / ns) * ((1 - q) / nz);
                normal += k * z * z;
            }
        }
        float qf = static_cast<float>(q);
        CHECK(double(WallTable::lookup(t.normal, qf)) == doctest::Approx(normal).epsilon(2e-3).scale(0));
    }
}
