// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/kernel.h"

#include <cmath>

namespace thaw {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSigma = 21 / (2 * kPi);

// Shape of the kernel for support 1.
double shape(double q) {
    if (q >= 1) return 0;
    double a = 1 - q;
    return kSigma * a * a * a * a * (1 + 4 * q);
}
// -W'(q) / q: no division, so q = 0 is nothing special.
double slope(double q) {
    if (q >= 1) return 0;
    double a = 1 - q;
    return 20 * kSigma * a * a * a;
}

struct LatticeConstants {
    float sum, shear, strain, stiffness;

    LatticeConstants() {
        const double h = static_cast<double>(kSupport), h3 = h * h * h;
        const int reach = 3;
        double s = 0, projected = 0, spread = 0, squares = 0;
        for (int i = -reach; i <= reach; ++i)
            for (int j = -reach; j <= reach; ++j)
                for (int k = -reach; k <= reach; ++k) {
                    double r2 = i * i + j * j + k * k, q = std::sqrt(r2) / h;
                    s += shape(q) / h3;
                    if (r2 == 0) continue;
                    double g = slope(q) / (h3 * h * h); // -W'(r) / r
                    // Shear flow v_x = z: force moment of the projected pair viscosity
                    // 10 mu V^2 (-W'/r) / (r^2 + 0.01 h^2) (v_ij . x_ij) x_ij; it should be 2 mu.
                    projected += 10 * g * (i * i) * (k * k) / (r2 + 0.01 * h * h);
                    spread += g * r2 * r2 / (r2 + 0.01 * h * h);
                    squares += g * g * r2;
                }
        sum = static_cast<float>(s);
        shear = static_cast<float>(projected / 2);
        strain = static_cast<float>(spread);
        stiffness = static_cast<float>(s * s / squares);
    }
};

const LatticeConstants& lattice() {
    static const LatticeConstants constants;
    return constants;
}

// The kernel's integral over a plane at distance q, times h, and -d/dq of it.
double planeShare(double q) {
    const double u = 1 - std::fabs(q);
    return u > 0 ? 2 * kPi * kSigma * u * u * u * u * u * (1 - u * (1.5 - u * 4 / 7)) : 0;
}
double planeSlope(double q) { return 2 * kPi * q * shape(std::fabs(q)); }

// Nearer than this, in spacings, the mirrored layer pushes no harder; it would attract from a quarter on.
constexpr double kStraightBelow = 0.3;

// Everything behind the plane z = q counts, q in units of h. First the integral over the disc that a plane cuts out of
// the support, then the sum over the planes from the far end.
struct WallTables : WallTable {
    WallTables() {
        static_assert(kSize % 2 == 0);
        const int rings = 300;
        double area[kSize + 1], along[kSize + 1];
        for (int a = 0; a <= kSize; ++a) {
            double z = -1 + 2.0 * a / kSize, rim = std::sqrt(std::fmax(0.0, 1 - z * z));
            double w = 0, n = 0;
            for (int b = 0; b < rings; ++b) {
                double s = (b + 0.5) / rings * rim, r2 = z * z + s * s, r = std::sqrt(r2);
                double ring = 2 * kPi * s * rim / rings, k = 10 * slope(r) / (r2 + 0.01);
                w += shape(r) * ring;
                n += k * z * z * ring;
            }
            area[a] = w, along[a] = n;
        }
        double f = 0, n = 0;
        fraction[kSize] = normal[kSize] = 0;
        const double dz = 2.0 / kSize;
        for (int a = kSize - 1; a >= 0; --a) {
            f += 0.5 * (area[a] + area[a + 1]) * dz;
            n += 0.5 * (along[a] + along[a + 1]) * dz;
            fraction[a] = static_cast<float>(f);
            normal[a] = static_cast<float>(n);
        }
        // The layer next to the wall is as far behind it as the particle is before it, the next one stands still. A
        // wall that fills its half-space evenly pushes half as hard as another layer: the first layer sank to 0.38
        // spacings and left a gap of 1.1 to 1.2 to the second, and films ran up to 34 % too fast (film-incline).
        const double h = static_cast<double>(kSupport), rest = static_cast<double>(kWallRest);
        const double scale = 1 / (h * lattice().sum), steepest = kStraightBelow / h;
        for (int a = 0; a <= kSize; ++a) {
            const double q = -1 + 2.0 * a / kSize, at = std::fmax(q, steepest);
            const double near = (1 - 2 * rest) / h + 2 * at, next = at + (2 - rest) / h;
            const double slope = scale * (2 * planeSlope(near) + planeSlope(next));
            mirrored[a] =
                static_cast<float>(std::fmin(1.0, scale * (planeShare(near) + planeShare(next)) + slope * (at - q)));
            mirroredGradient[a] = static_cast<float>(slope);
        }
    }
};

} // namespace

float latticeSum() { return lattice().sum; }
float shearMoment() { return lattice().shear; }
float strainMoment() { return lattice().strain; }
float bulkStiffness() { return lattice().stiffness; }

const WallTable& wallTable() {
    static const WallTables tables;
    return tables;
}

} // namespace thaw
