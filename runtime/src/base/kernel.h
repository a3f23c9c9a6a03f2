// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

namespace thaw {

// Wendland C2 in 3D with support h: W(r) = 21/(2 pi h^3) (1-q)^4 (1+4q), q = r/h. Chosen over the cubic spline because
// it does not clump (3-15 % clumped pairs against 0), and its W'/r needs no division: W'(r)/r = -210/(pi h^5) (1-q)^3.
inline constexpr float kSupport = 2.2f;            // support in particle spacings: 32 neighbours, 0.6 % moment bias
inline constexpr float kWendland = 3.34225380493f; // 21 / (2 pi)
inline constexpr float kWendlandGradient = 66.8450760986f; // 210 / pi
// Its shape without the factor: (1-q)^4 (1+4q), 0 from q = 1 on.
inline float wendlandShape(float q) {
    const float u = q < 1 ? 1 - q : 0;
    return u * u * u * u * (1 + 4 * q);
}

// Sum of V W over the infinite cubic lattice at kSupport: every density is divided by it. Tested against the sum
// itself.
float latticeSum();
// Shear moment of the projected pairwise viscosity on that lattice, as a share of nominal (0.7408): mu is divided by
// it.
float shearMoment();
// Sum of V (-W'/r) r^4 / (r^2 + 0.01 h^2) on that lattice, whatever the spacing: how many neighbours there are to tell
// a shear rate from.
float strainMoment();
// Jacobi coefficient 1 / sum |grad C|^2 of an interior particle, for spacing 1 and density 1. Times rho dx^2 for
// others.
float bulkStiffness();

// Half-spaces at signed distance d of a wall, by q = d / h in [-1, 1]: how much of the kernel's support lies
// in the wall.
struct WallTable {
    static constexpr int kSize = 512;
    float fraction[kSize + 1]; // volume share inside the wall, before dividing by latticeSum
    float mirrored[kSize + 1]; // what a wall adds to the density: layers of particles behind it, the first of which
                               // mirrors the one before it (see kWallRest); divided by latticeSum
    float mirroredGradient[kSize + 1]; // -d(mirrored)/dq
    float normal[kSize + 1];           // no-slip viscous weight, normal
    static float lookup(const float* table, float q) {
        float f = (q + 1) * (0.5f * kSize);
        if (f >= kSize) return 0;
        if (f <= 0) return table[0];
        int i = static_cast<int>(f);
        float a = f - static_cast<float>(i);
        return table[i] * (1 - a) + table[i + 1] * a;
    }
};
const WallTable& wallTable();

// Where the first layer of a lattice is without density error, in spacings from the wall. Half a spacing would be
// exact; what has lost its lattice is higher by 1 % then (columns of 75 layers of 1 mPa s / 10 Pa s: 0.297 / 0.3 m with
// 0.5, 0.299 / 0.304 with 0.515).
inline constexpr float kWallRest = 0.507f;

} // namespace thaw
