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

} // namespace

CaseList materialCases() {
    return {
        {"unlike-blob", "ball of halves of 500 and 1000 kg/m^3 drifts freely for 5 s", unlikeBlob},
        {"unlike-layers", "500 and 1000 kg/m^3 side by side: 10 s later the heavy lies under the light", heavierSinks}};
}

} // namespace thaw::player
