// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "mesh_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thaw::scene {

namespace {

// Half axes a, b, c along x, y, z, then turned: leaning back (about z) and to the side (about x). `twin`: there is
// another one at -z.
struct Ellipsoid {
    double x, y, z, a, b, c; // m
    double back, side;       // degrees
    bool twin;
    double blend; // m, over which it runs into what is there before it
};
constexpr Ellipsoid kParts[] = {
    {-0.010, 0.034, 0.000, 0.0330, 0.0330, 0.0270, 20, 0, false, 0.001},   // rump
    {0.010, 0.045, 0.000, 0.0190, 0.0290, 0.0205, -10, 0, false, 0.016},   // chest
    {0.021, 0.083, 0.000, 0.0215, 0.0190, 0.0180, -12, 0, false, 0.010},   // head
    {0.036, 0.0765, 0.006, 0.0095, 0.0080, 0.0085, 0, 0, true, 0.007},     // cheeks
    {0.0455, 0.0805, 0.000, 0.0035, 0.0030, 0.0040, 0, 0, false, 0.002},   // nose
    {0.0330, 0.0900, 0.0130, 0.0052, 0.0050, 0.0044, 0, 0, true, 0.001},   // eyes
    {0.0065, 0.1200, 0.0125, 0.0070, 0.0320, 0.0105, 14, 9, true, 0.006},  // ears
    {-0.014, 0.026, 0.0210, 0.0230, 0.0220, 0.0110, 25, 0, true, 0.004},   // thighs
    {0.010, 0.0065, 0.0215, 0.0230, 0.0075, 0.0088, 0, 0, true, 0.004},    // hind feet
    {0.0245, 0.0300, 0.0095, 0.0075, 0.0230, 0.0072, -8, -4, true, 0.004}, // forelegs
    {0.0310, 0.0060, 0.0100, 0.0105, 0.0068, 0.0074, 0, 0, true, 0.005},   // forepaws
    {-0.043, 0.024, 0.000, 0.0115, 0.0115, 0.0115, 0, 0, false, 0.003},    // tail
};

double distance(const Ellipsoid& e, double x, double y, double z) {
    const double kDegree = std::numbers::pi / 180;
    const double cb = std::cos(e.back * kDegree), sb = std::sin(e.back * kDegree);
    const double cs = std::cos(e.side * kDegree), ss = std::sin(e.side * kDegree);
    const double px = x - e.x, py = y - e.y, pz = z - e.z;
    const double qx = cb * px + sb * py, qy0 = -sb * px + cb * py;
    const double qy = cs * qy0 + ss * pz, qz = -ss * qy0 + cs * pz;
    const double u = qx / e.a, v = qy / e.b, w = qz / e.c;
    const double k0 = std::sqrt(u * u + v * v + w * w);
    const double k1 = std::sqrt(u * u / (e.a * e.a) + v * v / (e.b * e.b) + w * w / (e.c * e.c));
    return k1 > 0 ? k0 * (k0 - 1) / k1 : -std::min({e.a, e.b, e.c});
}

double bunny(double x, double y, double z) {
    double all = 1;
    for (const Ellipsoid& e : kParts) {
        all = blendedMin(all, distance(e, x, y, z), e.blend);
        if (e.twin) all = blendedMin(all, distance(e, x, y, -z), e.blend);
    }
    // The shell of an ear is hollow toward the front.
    const Ellipsoid hollow{0.0150, 0.1180, 0.0125, 0.0080, 0.0240, 0.0065, 14, 9, true, 0.003};
    for (const double side : {z, -z}) all = -blendedMin(-all, distance(hollow, x, y, side), hollow.blend);
    // It has been poured into a mould that was open below.
    return std::max(all, -y);
}

} // namespace

TriMesh makeBunny() {
    constexpr double kCell = 0.003;
    // Off the planes z = 0 and y = 0, where corners of the lattice would lie in the surface.
    return meshOfField({-0.0611, -0.0045, -15.6 * kCell, kCell, 40, 56, 31}, bunny);
}

} // namespace thaw::scene
