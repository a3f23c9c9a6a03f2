// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Unlike liquids beside and inside each other.
#include "report.h"
#include "validate/lab.h"
#include "validate/validate.h"

#include <algorithm>
#include <cmath>

namespace thaw::player {
namespace {

// A ball of halves of 500 and 1000 kg/m^3 that moves: what holds them together must not push them.
void unlikeBlob(Findings& found) {
    Lab lab(0.004f, 4000, {0, 0, 0});
    thawMaterialDef light = Lab::plain(500, 0.2f), heavy = Lab::plain(1000, 2);
    light.cohesion = heavy.cohesion = 6;
    thawBodyPart core{};
    const scene::TriMesh half = scene::makeBox({0.04f, 0.08f, 0.08f}); // -20..20 mm, moved to one side of the ball
    scene::TriMesh side = half;
    for (size_t k = 0; k < side.vertices.size(); k += 3) side.vertices[k] += 0.02f;
    const thawMaterialId outer = lab.material(light);
    core.material = lab.material(heavy), core.mesh = side.view();
    lab.body(outer, scene::makeSphere(0.02f), {0, 0, 0}, Lab::kLiquid, [&](thawBodyDef& d) {
        d.velocity = {0.1f, 0.05f, 0};
        d.parts = &core, d.partCount = 1;
    });
    const Momentum before = momentumOf(lab.particles());
    lab.step(300);
    const Momentum after = momentumOf(lab.particles());
    double p[3];
    for (int k = 0; k < 3; ++k) p[k] = after.p[k] - before.p[k];
    found.atMost("linear momentum, change / whole", 1e-4, lengthOf(p) / lengthOf(before.p));
}

// Side by side in a tank, the heavier flows under the lighter.
void sink(Findings& found, float viscosity) {
    Lab lab(0.004f, 6000);
    thawColliderDef walls[5];
    thawColliderId wallIds[5];
    const thawVec3 normal[5] = {{0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}},
                   at[5] = {{0, 0, 0}, {-0.04f, 0, 0}, {0.04f, 0, 0}, {0, 0, -0.02f}, {0, 0, 0.02f}};
    for (int k = 0; k < 5; ++k) {
        thawInitColliderDef(&walls[k], thawCollider_plane);
        walls[k].position = at[k], walls[k].rotation = turnTo({0, 1, 0}, normal[k]), walls[k].reportImpulse = true;
        wallIds[k] = lab.collider(walls[k]);
    }
    const thawMaterialId light = lab.material(Lab::plain(500, viscosity)),
                         heavy = lab.material(Lab::plain(1000, viscosity));
    thawBodyPart right{};
    const scene::TriMesh whole = scene::makeBox({0.08f, 0.04f, 0.04f});
    scene::TriMesh half = scene::makeBox({0.04f, 0.08f, 0.08f});
    for (size_t k = 0; k < half.vertices.size(); k += 3) half.vertices[k] += 0.02f;
    right.material = heavy, right.mesh = half.view();
    lab.body(light, whole, {0, 0.02f, 0}, Lab::kLiquid, [&](thawBodyDef& d) { d.parts = &right, d.partCount = 1; });
    // All that acts, about the origin: weight and walls. What the walls report is where it happens.
    const thawParticleView start = lab.particles();
    double mass = 0, given[6] = {}, off = 0;
    for (int i = 0; i < start.count; ++i) mass += static_cast<double>(start.velocities[4 * i + 3]);
    const Momentum before = momentumOf(start);
    lab.step(600, [&](int) {
        for (int k = 0; k < 5; ++k) {
            thawColliderImpulse i;
            thawCollider_GetImpulse(lab.world(), wallIds[k], &i);
            given[0] -= static_cast<double>(i.linear.x), given[1] -= static_cast<double>(i.linear.y);
            given[2] -= static_cast<double>(i.linear.z);
        }
        given[1] -= mass * 9.81 / 60;
        const Momentum now = momentumOf(lab.particles());
        for (int k = 0; k < 3; ++k) off = std::max(off, std::abs(now.p[k] - before.p[k] - given[k]));
    });
    const thawParticleView v = lab.particles();
    double height[2] = {}, count[2] = {}, left = 0;
    for (int i = 0; i < v.count; ++i) {
        const size_t m = v.materials[i];
        const double y = static_cast<double>(v.positions[4 * i + 1]);
        height[m] += y, count[m] += 1, left += m == 0 && y < 0.004;
    }
    // Two layers of 20 mm lie at 30 and 10 mm.
    const std::string name = formatted("%g Pa s: ", static_cast<double>(viscosity));
    found.within(name + "mean height of the heavy half, m", 0.01, height[1] / count[1], 0.1);
    found.within(name + "mean height of the light half, m", 0.03, height[0] / count[0], 0.1);
    found.atMost(name + "light share of the layer on the floor", 0.05, left / 200);
    found.atMost(name + "mean compression", 0.01, static_cast<double>(lab.counters().meanCompression));
    found.atMost(name + "momentum less impulses / weight of 1 s", 1e-3, off / (mass * 9.81));
}

void heavierSinks(Findings& found) {
    for (const float viscosity : {0.05f, 0.5f}) sink(found, viscosity);
}

// A film of two layers, the thicker liquid below, in a channel with walls on which it slides freely. The stress is that
// of the weight above, so that u(y) = G / mu_1 (H s - s^2 / 2) + G / mu_2 (H (y - h) - (y^2 - h^2) / 2), s = min(y, h),
// G = rho g sin b; of gravity turned by 30 degrees.
void layeredFilm(Findings& found) {
    constexpr float kSpacing = 0.004f, kLength = 128 * kSpacing, kHalf = 6 * kSpacing, kThin = 10;
    constexpr double kDown = 9.81 * 0.5, kInto = 9.81 * 0.8660254;
    for (const float ratio : {1.0f, 10.0f, 100.0f, 1000.0f}) {
        Lab lab(kSpacing, 14000, {0, -static_cast<float>(kInto), 0});
        lab.floor();
        lab.channel(kHalf);
        const thawMaterialId below = lab.material(Lab::plain(1000, ratio * kThin)),
                             above = lab.material(Lab::plain(1000, kThin));
        lab.box(below, {0, 0, -kHalf}, {kLength, 4 * kSpacing, kHalf}, Lab::kLiquid);
        lab.box(above, {0, 4 * kSpacing, -kHalf}, {kLength, 8 * kSpacing, kHalf}, Lab::kLiquid);
        // Only now: a liquid body is born with the pressure that it would have at rest, and on a slope it is not.
        thawWorld_SetGravity(lab.world(), {static_cast<float>(kDown), -static_cast<float>(kInto), 0});
        lab.step(75);
        const thawParticleView v = lab.particles();
        const auto inside = [&](int i) {
            return std::abs(v.positions[4 * i] - 0.5f * kLength) < 6 * kSpacing &&
                   std::abs(v.positions[4 * i + 2]) < 4 * kSpacing;
        };
        const double perLayer = 12 * 8, d = static_cast<double>(kSpacing);
        double H = 0, h = 0;
        for (int i = 0; i < v.count; ++i)
            if (inside(i)) H += d / perLayer, h += v.materials[i] == 0 ? d / perLayer : 0;
        const double G = 1000 * kDown, thin = static_cast<double>(kThin), thick = static_cast<double>(ratio) * thin;
        double speed = 0, theory = 0;
        for (int i = 0; i < v.count; ++i) {
            const double y = static_cast<double>(v.positions[4 * i + 1]), s = std::min(y, h);
            if (!inside(i) || v.materials[i] == 0) continue;
            speed += static_cast<double>(v.velocities[4 * i]);
            theory += G / thick * (H * s - 0.5 * s * s);
            if (y > h) theory += G / thin * (H * (y - h) - 0.5 * (y * y - h * h));
        }
        found.within(formatted("%g over %g Pa s: sum of speeds above, m/s", thin, thick), theory, speed, 0.1);
    }
}

} // namespace

CaseList materialCases() {
    return {
        {"unlike-blob", "ball of halves of 500 and 1000 kg/m^3 drifts freely for 5 s", unlikeBlob},
        {"unlike-layers", "500 and 1000 kg/m^3 side by side: 10 s later the heavy lies under the light", heavierSinks},
        {"unlike-viscosities", "film of two layers, the lower one 1 to 1000 times as viscous, on an incline",
         layeredFilm}};
}

} // namespace thaw::player
