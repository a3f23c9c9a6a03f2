// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "motion/rigid_math.h"

#include <algorithm>

// Fits of what is around a particle of an elastic solid: strain, deformation, gradients. In double, least squares.
namespace thaw {

struct Tensor3 { // by its rows
    Double3 x, y, z;
    Double3 apply(Double3 v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
    Double3 applyBack(Double3 v) const { return v.x * x + v.y * y + v.z * z; }
    void addOuter(double weight, Double3 a, Double3 b) {
        x += (weight * a.x) * b, y += (weight * a.y) * b, z += (weight * a.z) * b;
    }
};

// xx, yy, zz, xy, yz, zx of a strain; along(n): of a line in the direction n, a unit vector.
struct SmallStrain {
    float e[6] = {};
    double along(Double3 n) const {
        return e[0] * n.x * n.x + e[1] * n.y * n.y + e[2] * n.z * n.z +
               2 * (e[3] * n.x * n.y + e[4] * n.y * n.z + e[5] * n.z * n.x);
    }
};

// The strain that lines of known directions and strains have in common.
class StrainFit {
public:
    void add(Double3 n, double strain) {
        const double row[6] = {n.x * n.x, n.y * n.y, n.z * n.z, 2 * n.x * n.y, 2 * n.y * n.z, 2 * n.z * n.x};
        for (int i = 0; i < 6; ++i) {
            right_[i] += strain * row[i];
            for (int j = 0; j <= i; ++j) left_[i][j] += row[i] * row[j];
        }
        ++lines_;
    }
    // What no line tells is none: that of the least size.
    SmallStrain result() const {
        SmallStrain out;
        if (lines_ == 0) return out;
        double a[6][6], b[6];
        for (int i = 0; i < 6; ++i) {
            std::copy(left_[i], left_[i] + 6, a[i]);
            a[i][i] += kLeast * lines_, b[i] = right_[i];
        }
        if (!factorise(a)) return out;
        solve(a, b);
        for (int i = 0; i < 6; ++i) out.e[i] = static_cast<float>(b[i]);
        return out;
    }

private:
    static constexpr double kLeast = 1e-6;
    double left_[6][6] = {}, right_[6] = {};
    int lines_ = 0;
};

// (B + share of its trace)^-1 of a sum of squares: what the samples do not span has no gradient.
inline Symmetric3 inverseOfSpan(Symmetric3 b, double share) {
    const double trace = b.xx + b.yy + b.zz, more = trace > 0 ? share * trace : 1;
    b.xx += more, b.yy += more, b.zz += more;
    return inverse(b);
}
inline void addSquare(Symmetric3& b, double weight, Double3 d) {
    b.xx += weight * d.x * d.x, b.yy += weight * d.y * d.y, b.zz += weight * d.z * d.z;
    b.xy += weight * d.x * d.y, b.xz += weight * d.x * d.z, b.yz += weight * d.y * d.z;
}

// The rotation next to A, also where all samples lie in a plane. False on a line.
inline bool nearestRotation(const Tensor3& a, Tensor3& r) {
    // Eigenvectors of A^T A by Jacobi's rotations.
    double s[3][3], v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const Double3 columns[3] = {{a.x.x, a.y.x, a.z.x}, {a.x.y, a.y.y, a.z.y}, {a.x.z, a.y.z, a.z.z}};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) s[i][j] = dot(columns[i], columns[j]);
    constexpr int kPairs[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    for (int sweep = 0; sweep < 12; ++sweep)
        for (const auto& [p, q] : kPairs) {
            if (s[p][q] * s[p][q] <= 1e-30 * s[p][p] * s[q][q]) continue;
            const double half = (s[q][q] - s[p][p]) / (2 * s[p][q]);
            const double t = (half >= 0 ? 1 : -1) / ((half >= 0 ? half : -half) + std::sqrt(half * half + 1));
            const double c = 1 / std::sqrt(t * t + 1), w = t * c;
            for (int k = 0; k < 3; ++k) {
                const double x = s[k][p], y = s[k][q];
                s[k][p] = c * x - w * y, s[k][q] = w * x + c * y;
            }
            for (int k = 0; k < 3; ++k) {
                const double x = s[p][k], y = s[q][k];
                s[p][k] = c * x - w * y, s[q][k] = w * x + c * y;
            }
            for (auto& row : v) {
                const double x = row[p], y = row[q];
                row[p] = c * x - w * y, row[q] = w * x + c * y;
            }
        }
    int order[3] = {0, 1, 2};
    std::sort(order, order + 3, [&](int i, int j) { return s[i][i] != s[j][j] ? s[i][i] > s[j][j] : i < j; });
    const auto vector = [&](int k) { return Double3{v[0][order[k]], v[1][order[k]], v[2][order[k]]}; };
    const Double3 v1 = vector(0), v2 = vector(1), v3 = cross(v1, v2);
    Double3 u1 = a.apply(v1), u2 = a.apply(v2);
    const double l1 = length(u1);
    if (!(l1 > 0)) return false;
    u1 = (1 / l1) * u1, u2 -= dot(u1, u2) * u1;
    const double l2 = length(u2);
    if (!(l2 > 1e-4 * l1)) return false;
    u2 = (1 / l2) * u2;
    r = {};
    r.addOuter(1, u1, v1), r.addOuter(1, u2, v2), r.addOuter(1, cross(u1, u2), v3);
    return true;
}

} // namespace thaw
