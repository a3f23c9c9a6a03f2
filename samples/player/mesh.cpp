// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <stdexcept>

namespace thaw::scene {

namespace {
constexpr double kPi = std::numbers::pi;

double smoothStep(double lower, double upper, double x) {
    const double t = std::clamp((x - lower) / (upper - lower), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

double bump(double x, double width) { return std::exp(-(x * x) / (width * width)); }

double wrapAngle(double a) { return std::remainder(a, 2.0 * kPi); }
} // namespace

thawMesh TriMesh::view() const {
    thawMesh mesh{};
    mesh.vertices = vertices.data();
    mesh.vertexCount = vertexCount();
    mesh.indices = indices.data();
    mesh.triangleCount = triangleCount();
    return mesh;
}

uint32_t TriMesh::addVertex(double x, double y, double z) {
    vertices.insert(vertices.end(), {float(x), float(y), float(z)});
    return uint32_t(vertexCount() - 1);
}

void TriMesh::addTriangle(uint32_t a, uint32_t b, uint32_t c) { indices.insert(indices.end(), {a, b, c}); }

Bounds boundsOf(const TriMesh& mesh) {
    Bounds bounds;
    if (mesh.vertices.empty()) return bounds;
    float lower[3], upper[3];
    for (int k = 0; k < 3; ++k) lower[k] = upper[k] = mesh.vertices[size_t(k)];
    for (size_t i = 0; i < mesh.vertices.size(); ++i) {
        lower[i % 3] = std::min(lower[i % 3], mesh.vertices[i]);
        upper[i % 3] = std::max(upper[i % 3], mesh.vertices[i]);
    }
    bounds.lower = {lower[0], lower[1], lower[2]};
    bounds.upper = {upper[0], upper[1], upper[2]};
    return bounds;
}

double volumeOf(const TriMesh& mesh) {
    if (mesh.vertices.empty()) return 0.0;
    // Relative to the middle of the bounds: a small mesh far from the origin would otherwise cancel badly.
    const Bounds bounds = boundsOf(mesh);
    const double c[3] = {0.5 * (double(bounds.lower.x) + bounds.upper.x),
                         0.5 * (double(bounds.lower.y) + bounds.upper.y),
                         0.5 * (double(bounds.lower.z) + bounds.upper.z)};
    double sum = 0.0;
    for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
        double p[3][3];
        for (size_t k = 0; k < 3; ++k)
            for (size_t a = 0; a < 3; ++a) p[k][a] = mesh.vertices[size_t(mesh.indices[t + k]) * 3 + a] - c[a];
        sum += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) - p[0][1] * (p[1][0] * p[2][2] - p[1][2] * p[2][0]) +
               p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
    }
    return sum / 6.0;
}

thawVec3 rotate(const thawQuat& q, const thawVec3& v) {
    const float tx = 2.0f * (q.y * v.z - q.z * v.y), ty = 2.0f * (q.z * v.x - q.x * v.z),
                tz = 2.0f * (q.x * v.y - q.y * v.x);
    return {v.x + q.w * tx + q.y * tz - q.z * ty, v.y + q.w * ty + q.z * tx - q.x * tz,
            v.z + q.w * tz + q.x * ty - q.y * tx};
}

thawQuat quatFromDegrees(double x, double y, double z) {
    const double half = kPi / 360.0;
    const double cx = std::cos(x * half), sx = std::sin(x * half), cy = std::cos(y * half), sy = std::sin(y * half),
                 cz = std::cos(z * half), sz = std::sin(z * half);
    return {float(sx * cy * cz - cx * sy * sz), float(cx * sy * cz + sx * cy * sz), float(cx * cy * sz - sx * sy * cz),
            float(cx * cy * cz + sx * sy * sz)};
}

TriMesh makeBox(const thawVec3& size) {
    TriMesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.addVertex((i & 1 ? 0.5 : -0.5) * size.x, (i & 2 ? 0.5 : -0.5) * size.y, (i & 4 ? 0.5 : -0.5) * size.z);
    constexpr uint32_t kQuads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& q : kQuads) {
        mesh.addTriangle(q[0], q[1], q[2]);
        mesh.addTriangle(q[0], q[2], q[3]);
    }
    return mesh;
}

TriMesh makeLathe(const std::vector<ProfilePoint>& profile, int segments) {
    TriMesh mesh;
    const size_t rings = profile.size() - 2;
    const uint32_t n = uint32_t(segments);
    const uint32_t bottom = mesh.addVertex(0.0, profile.front().height, 0.0);
    for (size_t r = 0; r < rings; ++r)
        for (uint32_t s = 0; s < n; ++s) {
            const double angle = 2.0 * kPi * s / n;
            mesh.addVertex(profile[r + 1].radius * std::cos(angle), profile[r + 1].height,
                           profile[r + 1].radius * std::sin(angle));
        }
    const uint32_t top = mesh.addVertex(0.0, profile.back().height, 0.0);
    auto ring = [&](size_t r, uint32_t s) { return 1 + uint32_t(r) * n + s % n; };
    for (uint32_t s = 0; s < n; ++s) {
        mesh.addTriangle(bottom, ring(0, s), ring(0, s + 1));
        for (size_t r = 0; r + 1 < rings; ++r) {
            mesh.addTriangle(ring(r, s), ring(r + 1, s), ring(r + 1, s + 1));
            mesh.addTriangle(ring(r, s), ring(r + 1, s + 1), ring(r, s + 1));
        }
        mesh.addTriangle(top, ring(rings - 1, s + 1), ring(rings - 1, s));
    }
    return mesh;
}

TriMesh makeSphere(float radius) {
    constexpr int kRings = 24;
    std::vector<ProfilePoint> profile;
    for (int i = 0; i <= kRings; ++i) {
        const double a = kPi * i / kRings;
        profile.push_back({radius * std::sin(a), -radius * std::cos(a)});
    }
    return makeLathe(profile, 48);
}

TriMesh makeCylinder(float radius, float height) {
    const double h = 0.5 * height;
    return makeLathe({{0.0, -h}, {radius, -h}, {radius, h}, {0.0, h}}, 64);
}

TriMesh makeCone(float radius, float height) {
    const double h = 0.5 * height;
    return makeLathe({{0.0, -h}, {radius, -h}, {0.0, h}}, 64);
}

TriMesh makeTorus(float radius, float tubeRadius) {
    constexpr uint32_t kAround = 64, kTube = 24;
    TriMesh mesh;
    for (uint32_t i = 0; i < kAround; ++i)
        for (uint32_t j = 0; j < kTube; ++j) {
            const double a = 2.0 * kPi * i / kAround, b = 2.0 * kPi * j / kTube;
            const double r = radius + tubeRadius * std::cos(b);
            mesh.addVertex(r * std::cos(a), tubeRadius * std::sin(b), r * std::sin(a));
        }
    auto at = [&](uint32_t i, uint32_t j) { return (i % kAround) * kTube + j % kTube; };
    for (uint32_t i = 0; i < kAround; ++i)
        for (uint32_t j = 0; j < kTube; ++j) {
            mesh.addTriangle(at(i, j), at(i, j + 1), at(i + 1, j + 1));
            mesh.addTriangle(at(i, j), at(i + 1, j + 1), at(i + 1, j));
        }
    return mesh;
}

TriMesh makeCandle() {
    constexpr double kHeight = 0.120, kRadius = 0.017, kRim = 0.0022, kCupDepth = 0.0045;
    constexpr int kSide = 30, kSegments = 40;
    std::vector<ProfilePoint> profile{{0.0, 0.0}, {0.55 * kRadius, 0.0}};
    // Foot with a small round, side, rounded rim, then the cup down to the wick.
    profile.push_back({kRadius - 0.0012, 0.0});
    for (int i = 0; i <= kSide; ++i) {
        const double y = 0.0012 + (kHeight - kRim - 0.0012) * i / kSide;
        profile.push_back({kRadius, y});
    }
    for (int i = 1; i <= 4; ++i) {
        const double a = 0.5 * kPi * i / 4;
        profile.push_back({kRadius - kRim + kRim * std::cos(a), kHeight - kRim + kRim * std::sin(a)});
    }
    constexpr int kCup = 6;
    for (int i = 1; i < kCup; ++i) {
        const double t = double(i) / kCup;
        profile.push_back({(kRadius - kRim) * (1.0 - t), kHeight - kCupDepth * smoothStep(0.0, 0.75, t)});
    }
    profile.push_back({0.0, kHeight - kCupDepth});
    TriMesh mesh = makeLathe(profile, kSegments);

    struct Drip {
        double angle, width, reach, thickness; // rad, rad, m below the rim, m
    };
    constexpr Drip kDrips[] = {
        {0.35, 0.20, 0.062, 0.0021}, {1.45, 0.15, 0.030, 0.0015}, {2.70, 0.24, 0.084, 0.0025},
        {4.05, 0.17, 0.044, 0.0018}, {5.10, 0.22, 0.025, 0.0016},
    };
    for (size_t i = 0; i < mesh.vertexCount(); ++i) {
        float* p = &mesh.vertices[i * 3];
        const double r0 = std::hypot(p[0], p[2]), angle = std::atan2(p[2], p[0]), y0 = p[1];
        const double outer = smoothStep(0.60 * kRadius, 0.97 * kRadius, r0); // the cup stays round
        double r = r0, y = y0;
        // Cast unevenly: a few low waves around and along, thicker toward the foot.
        r *= 1.0 + outer * (0.014 * std::sin(2.0 * angle + 0.7 + 18.0 * y0) +
                            0.010 * std::sin(3.0 * angle - 1.1 - 31.0 * y0) + 0.008 * std::sin(67.0 * y0 + 0.4) +
                            0.030 * (1.0 - smoothStep(0.0, 0.05, y0)));
        for (const Drip& drip : kDrips) {
            const double below = kHeight - y0;
            const double side = bump(wrapAngle(angle - drip.angle - 1.6 * below), drip.width);
            const double along = 1.0 - smoothStep(drip.reach - 0.006, drip.reach, below);
            const double bead = 0.55 * bump(below - drip.reach + 0.006, 0.005); // the drop it ended in
            r += outer * drip.thickness * side * (0.62 * along + bead);
        }
        // The rim has sagged to one side, the cup with it by half.
        const double top = smoothStep(0.75 * kHeight, kHeight, y0);
        y += top * (0.0011 * std::sin(angle + 0.6) + 0.0006 * std::sin(3.0 * angle + 2.0)) *
             smoothStep(0.0, kRadius, r0);
        const double lean = 0.0022 * (y0 / kHeight) * (y0 / kHeight);
        p[0] = float(r * std::cos(angle) + lean);
        p[1] = float(y);
        p[2] = float(r * std::sin(angle) - 0.4 * lean);
    }
    return mesh;
}

TriMesh makeWaffleCone() {
    constexpr double kHeight = 0.105, kRadius = 0.0275;
    constexpr int kSide = 40;
    std::vector<ProfilePoint> profile{{0.0, 0.0}, {0.0035, 0.0}};
    for (int i = 1; i <= kSide; ++i) {
        const double u = double(i) / kSide;
        // Baked in rings.
        profile.push_back({0.0035 + (kRadius - 0.0035) * u + 0.0005 * std::sin(2 * kPi * 9 * u), kHeight * u});
    }
    for (const ProfilePoint& p : {ProfilePoint{0.0292, 0.1065},
                                  {0.0295, 0.110},
                                  {0.0295, 0.116},
                                  {0.0288, 0.1178},
                                  {0.0275, 0.118},
                                  {0.0262, 0.1172},
                                  {0.0258, 0.115},
                                  {0.0245, 0.1095},
                                  {0.021, 0.108},
                                  {0.012, 0.1075},
                                  {0.0, 0.1075}})
        profile.push_back(p);
    TriMesh mesh = makeLathe(profile, 48);
    // The pattern of the iron, which runs round both ways.
    for (size_t v = 0; v < mesh.vertexCount(); ++v) {
        float* p = &mesh.vertices[3 * v];
        const double r = std::hypot(p[0], p[2]), angle = std::atan2(p[2], p[0]), y = p[1];
        if (r < 0.004 || y < 0.004 || y > 0.104) continue;
        const double wave = std::sin(12 * angle + 420 * y) * std::sin(12 * angle - 420 * y);
        const double scale = 1 + 0.0007 * wave / r;
        p[0] = float(p[0] * scale), p[2] = float(p[2] * scale);
    }
    return mesh;
}

namespace {

TriMesh makeScoop(double radius, thawVec3 center, double turn) {
    constexpr int kRings = 40, kSegments = 56;
    std::vector<ProfilePoint> profile;
    for (int i = 0; i <= kRings; ++i) {
        const double a = kPi * i / kRings;
        profile.push_back({radius * std::sin(a), -radius * std::cos(a)});
    }
    TriMesh mesh = makeLathe(profile, kSegments);
    for (size_t v = 0; v < mesh.vertexCount(); ++v) {
        float* p = &mesh.vertices[3 * v];
        const double up = p[1] / radius, around = std::hypot(p[0], p[2]) / radius;
        const double angle = std::atan2(p[2], p[0]) + turn;
        // Torn by the spoon: waves of several lengths, and a skirt that it pressed out at the foot.
        const double rough = 0.022 * std::sin(3 * angle + 5 * up) + 0.016 * std::sin(7 * angle - 9 * up + 1.3) +
                             0.012 * std::sin(13 * angle + 17 * up + 0.7) + 0.010 * std::sin(31 * up + 2 * angle);
        const double skirt =
            bump(up + 0.55, 0.17) * (0.17 + 0.05 * std::sin(5 * angle + 1.1) + 0.04 * std::sin(9 * angle));
        const double scale = 1 + around * (rough + skirt);
        p[0] = float(p[0] * scale) + center.x;
        p[2] = float(p[2] * scale) + center.z;
        p[1] = float(std::max(p[1] * (1 + 0.5 * rough), -0.72 * radius)) + center.y;
    }
    return mesh;
}

} // namespace

TriMesh makeLowerScoop() { return makeScoop(0.027, {0.0f, 0.135f, 0.0f}, 0.0); }
TriMesh makeUpperScoop() { return makeScoop(0.024, {0.002f, 0.168f, 0.0f}, 2.1); }

TriMesh makeScoops() {
    TriMesh mesh = makeLowerScoop();
    const TriMesh upper = makeUpperScoop();
    const uint32_t first = uint32_t(mesh.vertexCount());
    mesh.vertices.insert(mesh.vertices.end(), upper.vertices.begin(), upper.vertices.end());
    for (const uint32_t i : upper.indices) mesh.indices.push_back(first + i);
    return mesh;
}

TriMesh makeStar() {
    constexpr int kRound = 40, kRings = 25;
    constexpr double kTip = 0.036, kNotch = 0.016, kHalf = 0.014;
    const double foot = kTip * std::cos(kPi / 5);
    TriMesh mesh;
    const auto put = [&](double x, double y, double z) {
        for (const double v : {x, y + foot, z}) mesh.vertices.push_back(float(v));
    };
    put(0, 0, kHalf);
    for (int r = 1; r <= kRings; ++r)
        for (int k = 0; k < kRound; ++k) {
            const double theta = kPi * r / (kRings + 1), turn = 2 * kPi * k / kRound;
            const double arm = 2 * std::abs(std::remainder(5 * turn / (2 * kPi), 1)); // 0 at a tip, 1 in a notch
            const double radius = (kTip + (kNotch - kTip) * arm) * std::sin(theta);
            put(radius * std::sin(turn), radius * std::cos(turn), kHalf * std::cos(theta));
        }
    put(0, 0, -kHalf);
    const uint32_t last = uint32_t(mesh.vertices.size() / 3 - 1);
    const auto at = [](int ring, int k) { return uint32_t(1 + ring * kRound + k % kRound); };
    const auto face = [&](uint32_t a, uint32_t b, uint32_t c) {
        for (const uint32_t i : {a, b, c}) mesh.indices.push_back(i);
    };
    for (int k = 0; k < kRound; ++k) {
        face(0, at(0, k + 1), at(0, k)), face(last, at(kRings - 1, k), at(kRings - 1, k + 1));
        for (int r = 0; r + 1 < kRings; ++r)
            face(at(r, k), at(r, k + 1), at(r + 1, k + 1)), face(at(r, k), at(r + 1, k + 1), at(r + 1, k));
    }
    return mesh;
}

TriMesh makeSaucer() {
    std::vector<ProfilePoint> profile{{0.0, 0.0}, {0.020, 0.0}, {0.030, 0.0}, {0.0335, 0.0012}};
    // Underside rises to the lip, the lip is round, the inside comes back down to a flat well.
    for (int i = 1; i <= 6; ++i) {
        const double t = i / 6.0;
        profile.push_back({0.0335 + 0.0200 * t, 0.0012 + 0.0078 * t * t});
    }
    for (int i = 1; i <= 5; ++i) {
        const double a = -0.35 * kPi + 1.05 * kPi * i / 5.0;
        profile.push_back({0.0537 + 0.0013 * std::cos(a), 0.0100 + 0.0013 * std::sin(a)});
    }
    for (int i = 1; i <= 6; ++i) {
        const double t = 1.0 - i / 6.0;
        profile.push_back({0.0325 + 0.0198 * t, 0.0032 + 0.0074 * t * t});
    }
    profile.push_back({0.026, 0.0030});
    profile.push_back({0.013, 0.0030});
    profile.push_back({0.0, 0.0030});
    return makeLathe(profile, 72);
}

void writeObj(const std::string& path, const TriMesh& mesh, const std::string& comment) {
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "wb"), &std::fclose);
    if (!file) throw std::runtime_error("cannot be written");
    std::fprintf(file.get(), "# %s\n", comment.c_str());
    for (size_t i = 0; i < mesh.vertexCount(); ++i)
        std::fprintf(file.get(), "v %.6f %.6f %.6f\n", mesh.vertices[i * 3], mesh.vertices[i * 3 + 1],
                     mesh.vertices[i * 3 + 2]);
    for (size_t t = 0; t < mesh.triangleCount(); ++t)
        std::fprintf(file.get(), "f %u %u %u\n", mesh.indices[t * 3] + 1, mesh.indices[t * 3 + 1] + 1,
                     mesh.indices[t * 3 + 2] + 1);
    if (std::ferror(file.get()) || std::fflush(file.get()) != 0) throw std::runtime_error("cannot be written");
}

} // namespace thaw::scene
