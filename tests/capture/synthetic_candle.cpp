// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "synthetic_candle.h"

#include <algorithm>
#include <cmath>

namespace thaw::test {

using view::Vec3;

namespace {

constexpr float kPi = 3.14159265f, kRadius = 0.022f, kHeight = 0.09f, kPoolDepth = 0.0035f;

struct Drip {
    float angle, end, width, bulge; // rad, m above the table, m, m
};
constexpr Drip kDrips[] = {
    {0.35f, 0.046f, 0.0030f, 0.0026f}, {0.75f, 0.062f, 0.0022f, 0.0017f}, {1.25f, 0.020f, 0.0036f, 0.0031f},
    {2.10f, 0.055f, 0.0026f, 0.0020f}, {2.75f, 0.004f, 0.0038f, 0.0034f}, {3.70f, 0.040f, 0.0030f, 0.0024f},
    {4.55f, 0.066f, 0.0024f, 0.0018f}, {5.30f, 0.012f, 0.0034f, 0.0030f}, {5.85f, 0.034f, 0.0026f, 0.0024f}};

float smooth(float a, float b, float x) {
    const float t = std::clamp((x - a) / (b - a), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

// Height that the drips stand proud of the wall.
float drips(float angle, float y) {
    float sum = 0;
    for (const Drip& d : kDrips) {
        float da = angle - d.angle;
        da -= 2 * kPi * std::round(da / (2 * kPi));
        // It meanders a little and has a round head at its lower end.
        const float x = (da + 0.05f * std::sin(y * 180 + d.angle * 7)) * kRadius;
        const float head = std::exp(-std::pow((y - d.end - d.width) / (1.5f * d.width), 2.0f));
        const float width = d.width * (0.62f + 0.55f * head);
        const float along = smooth(d.end - 0.6f * d.width, d.end + 0.5f * d.width, y);
        const float across = x * x / (width * width);
        sum += d.bulge * along * (0.45f + 0.75f * head) * std::exp(-across);
    }
    return sum;
}

// A line from the axis under the candle over the wall and the rim to the middle of the pool. s in 0..1.
Vec3 point(float angle, float s) {
    const float c = std::cos(angle), n = std::sin(angle);
    float r = 0, y = 0;
    // The rim stands lower where melt ran over.
    const float over = std::min(1.0f, drips(angle, kHeight - 0.003f) / 0.0012f);
    const float rim = kHeight - 0.0012f * over + 0.0007f * std::sin(2 * angle + 1);
    const float top = rim - 0.002f, thick = 0.0019f;
    const auto wall = [&](float height) {
        return kRadius * (1 + 0.012f * std::sin(2 * angle + 40 * height)) + drips(angle, height);
    };
    if (s < 0.10f) {
        const float t = s / 0.10f;
        r = t * kRadius * (1.24f + 0.10f * std::sin(3 * angle + 0.5f) + 0.06f * std::sin(5 * angle));
    } else if (s < 0.74f) {
        const float t = (s - 0.10f) / 0.64f;
        y = t * top;
        const float puddle = std::pow(std::max(0.0f, 1 - y / 0.007f), 2.2f);
        const float lobes = 0.24f + 0.10f * std::sin(3 * angle + 0.5f) + 0.06f * std::sin(5 * angle);
        r = wall(y) + kRadius * puddle * lobes;
    } else {
        // Rim: a half circle; then the pool with its meniscus.
        const float t = (s - 0.74f) / 0.26f;
        if (t < 0.3f) {
            const float b = kPi * t / 0.3f;
            const float inner = kRadius - 2 * thick, outer = wall(top);
            r = inner + (outer - inner) * 0.5f * (1 + std::cos(b));
            y = top + thick * std::sin(b);
        } else {
            const float u = (t - 0.3f) / 0.7f;
            r = (kRadius - 2 * thick) * (1 - u);
            y = top - kPoolDepth * smooth(0, 0.22f, u) + 0.0012f * over * smooth(0, 0.3f, u);
            y += 0.0012f * smooth(0.90f, 1, u); // melt climbs the wick
        }
    }
    return {r * c, y, r * n};
}

} // namespace

SyntheticCandle::SyntheticCandle(int around, int along) {
    for (int j = 0; j <= along; ++j)
        for (int i = 0; i < around; ++i) {
            const float angle = 2 * kPi * i / around, s = static_cast<float>(j) / along;
            const Vec3 p = point(angle, s);
            positions.insert(positions.end(), {p.x, p.y, p.z});
            const float toFlame = std::sqrt(p.x * p.x + p.z * p.z + std::pow(kHeight + 0.012f - p.y, 2.0f));
            const float kelvin = 296 + 74 * std::exp(-std::max(0.0f, toFlame - 0.014f) / 0.016f);
            temperatures.push_back(kelvin);
            liquidFractions.push_back(smooth(322, 336, kelvin));
            materials.push_back(0);
        }
    for (int j = 0; j < along; ++j)
        for (int i = 0; i < around; ++i) {
            const auto at = [&](int row, int column) { return static_cast<uint32_t>(row * around + column % around); };
            const uint32_t a = at(j, i), b = at(j, i + 1), c = at(j + 1, i), d = at(j + 1, i + 1);
            indices.insert(indices.end(), {a, c, b, b, c, d});
        }
    const view::TriangleMesh mesh =
        view::makeMesh({positions.data(), positions.size() / 3, indices.data(), indices.size() / 3});
    normals = mesh.normals;
}

thawSurfaceView SyntheticCandle::view() const {
    thawSurfaceView v{};
    v.vertexCount = static_cast<int32_t>(positions.size() / 3);
    v.triangleCount = static_cast<int32_t>(indices.size() / 3);
    v.positions = positions.data();
    v.normals = normals.data();
    v.temperatures = temperatures.data();
    v.liquidFractions = liquidFractions.data();
    v.materials = materials.data();
    v.indices = indices.data();
    return v;
}

view::Scene SyntheticCandle::scene() const {
    view::Scene scene;
    scene.surface = view();
    scene.materials = {view::materialLook(thawMaterial_wax)};
    view::MeshInstance wick;
    wick.mesh = std::make_shared<view::TriangleMesh>(view::makeCylinder(0.0009f, 0.011f));
    wick.position = {0, kHeight - 0.0065f, 0};
    wick.color = {0.008f, 0.006f, 0.005f};
    wick.roughness = 0.9f;
    scene.meshes.push_back(wick);
    view::Glow flame;
    flame.position = {0, kHeight + 0.012f, 0};
    flame.power = 60;
    flame.radius = 0.004f;
    scene.glows.push_back(flame);
    return scene;
}

view::Camera SyntheticCandle::camera(float aspect) {
    view::Bounds bounds;
    bounds.add(Vec3{-0.03f, 0, -0.03f});
    bounds.add(Vec3{0.03f, 0.125f, 0.03f});
    view::Orbit orbit;
    orbit.elevation = 0.22f;
    return view::frame(bounds, orbit, aspect);
}

SyntheticParticles::SyntheticParticles() {
    const int across = int(kRadius / kSpacing) + 1, up = int(kHeight / kSpacing);
    for (int j = 0; j < up; ++j)
        for (int k = -across; k <= across; ++k)
            for (int i = -across; i <= across; ++i) {
                const Vec3 p{float(i) * kSpacing, (float(j) + 0.5f) * kSpacing, float(k) * kSpacing};
                const float r = std::sqrt(p.x * p.x + p.z * p.z), inward = kRadius - r;
                if (inward < 0) continue;
                const bool wall = inward < kSpacing, top = j == up - 1;
                Vec3 n{wall && r > 0 ? p.x / r : 0, top ? 1.0f : 0.0f, wall && r > 0 ? p.z / r : 0};
                if (wall || top) n = view::normalize(n);
                const uint8_t level = inward > 0.012f && j > 2 && j < up - 4 ? 3 : 0;
                positions.insert(positions.end(), {p.x, p.y, p.z, 0.5f * kSpacing * std::exp2(float(level) / 3)});
                const float heat = smooth(0.6f * kHeight, kHeight, p.y);
                velocities.insert(velocities.end(), {0, -0.1f * heat * heat, 0, 1});
                normals.insert(normals.end(), {n.x, n.y, n.z, (float(wall) + float(top)) * kSpacing * kSpacing});
                temperatures.push_back(296 + 50 * heat);
                liquidFractions.push_back(smooth(322, 336, temperatures.back()));
                sizes.push_back(1000 * (inward + kSpacing));
                materials.push_back(0), levels.push_back(level);
            }
}

thawParticleView SyntheticParticles::view() const {
    thawParticleView v{};
    v.count = int32_t(temperatures.size());
    v.positions = positions.data(), v.velocities = velocities.data(), v.normals = normals.data();
    v.temperatures = temperatures.data(), v.liquidFractions = liquidFractions.data();
    v.materials = materials.data(), v.levels = levels.data();
    return v;
}

} // namespace thaw::test
