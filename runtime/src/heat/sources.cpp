// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Irradiance of unoccluded sources in closed form. What has a temperature radiates alike from every point into every
// direction (Lambert), so its irradiance is its exitance times the form factor: Lambert's contour integral for the
// rectangle, the sphere clipped by the horizon, the disc's two components (Howell, A Catalog of Radiation Heat Transfer
// Configuration Factors, B-12 and B-13).
#include "heat/sources.h"

#include "base/math.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kStefanBoltzmann = 5.670374419e-8; // W/(m^2 K^4), CODATA 2018
// A drop alone, which faces nowhere: its cross-section is a quarter of its surface.
constexpr double kDropCosine = 0.25;
// A disc that the horizon cuts is taken as a regular polygon of its area: within 0.3 % of the contour.
constexpr int kDiscCorners = 32;
// Directional light comes from so far.
constexpr float kFarAway = 1e5f; // m

struct Double3 {
    double x = 0, y = 0, z = 0;
    Double3() = default;
    explicit Double3(Vec3 a) : x(a.x), y(a.y), z(a.z) {}
    Double3(double a, double b, double c) : x(a), y(b), z(c) {}
};
Double3 operator+(Double3 a, Double3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Double3 operator-(Double3 a, Double3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Double3 operator*(double s, Double3 a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(Double3 a, Double3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Double3 cross(Double3 a, Double3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double length(Double3 a) { return std::sqrt(dot(a, a)); }

double pointFactor(const Emitter& e, const Receiver& r) {
    const Vec3 way = e.center - r.position;
    const float distance = thaw::length(way);
    // A source that touches the surface shines straight on it.
    const float cosine = distance < 1e-3f * e.radius ? 1.0f : thaw::dot(r.normal, (1 / distance) * way);
    const double facing = r.drop() ? kDropCosine : std::max(0.0, static_cast<double>(cosine));
    // Nearer than its own size a particle would take more than the half of all power that its plane can catch.
    const double d2 = std::max({static_cast<double>(distance) * distance, static_cast<double>(e.radius) * e.radius,
                                r.area * 0.5 / kPi, 1e-12});
    return facing / (4 * kPi * d2);
}

double sphereFactor(const Emitter& e, const Receiver& r) {
    const Vec3 way = e.center - r.position;
    const double l = length(Double3(way)), h = l / static_cast<double>(e.radius), h2 = h * h;
    if (h2 <= 1) return 1; // inside of it: from all around
    if (r.drop()) return 0.5 / (h2 * (1 + std::sqrt(1 - 1 / h2)));
    const double c = dot(Double3(r.normal), (1 / l) * Double3(way));
    if (c * h >= 1) return c / h2;
    if (c * h <= -1) return 0;
    const double t = h2 - 1, k = std::max(0.0, 1 - h2 * c * c), s = std::sqrt(std::max(1e-30, 1 - c * c));
    const double cut = (c * detAcos(-c * std::sqrt(t) / s) - std::sqrt(k * t)) / h2;
    return std::clamp((cut + detAngle(std::sqrt(k), std::sqrt(t))) / kPi, 0.0, 1.0);
}

// Contour integral of a convex polygon seen from the origin: its component along n is the form factor of what lies
// above n's horizon throughout.
Double3 contour(const Double3* corners, int count) {
    Double3 sum{0, 0, 0};
    for (int i = 0; i < count; ++i) {
        const Double3 &a = corners[i], &b = corners[(i + 1) % count], c = cross(a, b);
        const double sine = length(c);
        // On the edge itself the contour has no direction to add.
        if (sine > 0) sum = sum + (detAngle(sine, dot(a, b)) / sine) * c;
    }
    return (0.5 / kPi) * sum;
}

// Clips to the upper half space of n; returns how many corners are left, at most count + 1.
int clip(const Double3* corners, int count, Double3 n, Double3* out) {
    int m = 0;
    for (int i = 0; i < count; ++i) {
        const Double3 &a = corners[i], &b = corners[(i + 1) % count];
        const double u = dot(n, a), v = dot(n, b);
        if (u > 0) out[m++] = a;
        if ((u > 0) != (v > 0)) out[m++] = a + (u / (u - v)) * (b - a);
    }
    return m;
}

double polygonFactor(const Double3* corners, int count, const Receiver& r) {
    if (r.drop()) return kDropCosine * length(contour(corners, count));
    Double3 above[kDiscCorners + 2];
    const int n = clip(corners, count, Double3(r.normal), above);
    if (n < 3) return 0;
    return std::abs(dot(Double3(r.normal), contour(above, n)));
}

double rectangleFactor(const Emitter& e, const Receiver& r) {
    const Double3 c(e.center - r.position), u(e.across), v(e.along);
    if (!(dot(Double3(e.axis), c) < 0)) return 0; // behind it
    const Double3 corners[4] = {c + u + v, c - u + v, c - u - v, c + u - v};
    return polygonFactor(corners, 4, r);
}

double discFactor(const Emitter& e, const Receiver& r) {
    const Double3 c(e.center - r.position), axis(e.axis);
    const double height = -dot(axis, c), R = e.radius;
    if (!(height > 0)) return 0;
    const Double3 n(r.normal);
    const double tilt = dot(n, axis), over = dot(n, c), swing = R * std::sqrt(std::max(0.0, 1 - tilt * tilt));
    if (!r.drop() && over + swing <= 0) return 0;
    if (r.drop() || over - swing >= 0) {
        // Two components of one vector: toward the disc's plane, and along it toward the axis.
        const Double3 off = c + height * axis;
        const double a2 = dot(off, off), z = a2 + height * height + R * R,
                     s = std::sqrt(std::max(z * z - 4 * R * R * a2, 1e-60)),
                     down = R * R / s * std::max(0.0, 1 - 2 * a2 / (s + z)),
                     inward = 2 * height * R * R / (s * (s + z));
        const Double3 vector = inward * off - down * axis;
        return std::clamp(r.drop() ? kDropCosine * length(vector) : dot(n, vector), 0.0, 1.0);
    }
    // Equal area: pi R^2 = N/2 Rp^2 sin(2 pi / N).
    static const double kGrow = std::sqrt(2 * kPi / (kDiscCorners * 0.19509032201612825));
    Double3 corners[kDiscCorners];
    for (int k = 0; k < kDiscCorners; ++k) {
        float sine, cosine;
        detTurn(static_cast<float>(k) / kDiscCorners, sine, cosine);
        corners[k] = c + (kGrow * static_cast<double>(cosine)) * Double3(e.across) +
                     (kGrow * static_cast<double>(sine)) * Double3(e.along);
    }
    return polygonFactor(corners, kDiscCorners, r);
}

} // namespace

float strengthOf(const HeatSource& s, float ambient) {
    if (!s.alive || !s.enabled) return 0;
    if (s.type == thawHeatSource_point) return s.power;
    if (s.type == thawHeatSource_directional) return s.irradiance;
    // Net of the ambient radiation that it hides, which loss() takes to come from everywhere.
    const double T = s.temperature, Ta = ambient;
    return static_cast<float>(static_cast<double>(s.emissivity) * kStefanBoltzmann *
                              (T * T * T * T - Ta * Ta * Ta * Ta));
}

Emitter makeEmitter(const HeatSource& s, int index, float ambient) {
    Emitter e{};
    e.type = s.type, e.index = index;
    e.center = s.position, e.radius = s.radius;
    e.strength = strengthOf(s, ambient);
    e.axis = rotate(s.rotation, {0, 1, 0});
    e.across = rotate(s.rotation, {s.radius, 0, 0}), e.along = rotate(s.rotation, {0, 0, s.radius});
    e.extent = s.radius;
    if (s.type == thawHeatSource_rectangle) {
        e.across = rotate(s.rotation, {s.size.x, 0, 0}), e.along = rotate(s.rotation, {0, 0, s.size.z});
        e.extent = length(e.across + e.along);
    }
    if (!e.area()) e.extent = 0;
    return e;
}

float irradiance(const Emitter& e, const Receiver& r) {
    switch (e.type) {
    case thawHeatSource_point:
        return static_cast<float>(static_cast<double>(e.strength) * pointFactor(e, r));
    case thawHeatSource_directional:
        return e.strength * (r.drop() ? static_cast<float>(kDropCosine) : std::max(0.0f, -dot(r.normal, e.axis)));
    case thawHeatSource_sphere:
        return e.strength * static_cast<float>(sphereFactor(e, r));
    case thawHeatSource_rectangle:
        return e.strength * static_cast<float>(rectangleFactor(e, r));
    case thawHeatSource_disc:
        return e.strength * static_cast<float>(discFactor(e, r));
    }
    return 0;
}

Sample sample(const Emitter& e, const Receiver& r, float u, float v) {
    if (e.type == thawHeatSource_directional) return {r.position - kFarAway * e.axis, 1};
    if (e.type == thawHeatSource_point) return {e.center, 1};
    float sine, cosine;
    if (e.type == thawHeatSource_sphere) {
        // Directions of its cone, alike by solid angle; to where they enter it.
        const Vec3 way = e.center - r.position;
        const float l = length(way);
        if (l <= e.radius) return {r.position, 0};
        const float s2 = (e.radius / l) * (e.radius / l);
        const float fall = u * s2 / (1 + std::sqrt(1 - s2)); // 1 - cosine of the angle off the middle
        const float c = 1 - fall, s = std::sqrt(fall * (1 + c));
        const Vec3 middle = (1 / l) * way;
        const Vec3 side =
            normalizeOr(cross(middle, std::abs(middle.x) < 0.6f ? Vec3{1, 0, 0} : Vec3{0, 1, 0}), {0, 0, 1});
        detTurn(v, sine, cosine);
        const Vec3 d = c * middle + (s * cosine) * side + (s * sine) * cross(middle, side);
        const float reach = l * c - std::sqrt(std::max(0.0f, e.radius * e.radius - l * l * s * s));
        return {r.position + reach * d, r.drop() ? 1.0f : std::max(0.0f, dot(r.normal, d))};
    }
    float x = 2 * u - 1, y = 2 * v - 1;
    if (e.type == thawHeatSource_disc) {
        detTurn(v, sine, cosine);
        const float out = std::sqrt(u);
        x = out * cosine, y = out * sine;
    }
    const Vec3 point = e.center + x * e.across + y * e.along, way = point - r.position;
    const double d2 = std::max(1e-30, static_cast<double>(dot(way, way)));
    const double there = -static_cast<double>(dot(e.axis, way)), here = static_cast<double>(dot(r.normal, way));
    const double weight = r.drop() ? there / (d2 * std::sqrt(d2)) : std::max(0.0, here) * there / (d2 * d2);
    return {point, static_cast<float>(std::clamp(weight * static_cast<double>(e.extent) * e.extent, 0.0, 1e30))};
}

Vec3 highest(const Emitter& e, const Receiver& r) {
    if (r.drop() || !e.area()) return e.center;
    if (e.type == thawHeatSource_sphere) return e.center + (0.999f * e.radius) * r.normal;
    const float a = dot(e.across, r.normal), b = dot(e.along, r.normal);
    if (e.type == thawHeatSource_rectangle)
        return e.center + std::copysign(0.999f, a) * e.across + std::copysign(0.999f, b) * e.along;
    const float l = std::sqrt(a * a + b * b);
    return l > 0 ? e.center + (0.999f / l) * (a * e.across + b * e.along) : e.center;
}

} // namespace thaw
