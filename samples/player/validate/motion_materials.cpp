// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Unlike liquids beside and inside each other.
#include "validate/lab.h"
#include "validate/validate.h"

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
void heavierSinks(Findings& found) {
    Lab lab(0.004f, 6000);
    lab.tank({-0.04f, 0, -0.02f}, {0.04f, 1, 0.02f});
    const thawMaterialId light = lab.material(Lab::plain(500, 0.5f)), heavy = lab.material(Lab::plain(1000, 0.5f));
    thawBodyPart right{};
    const scene::TriMesh whole = scene::makeBox({0.08f, 0.04f, 0.04f});
    scene::TriMesh half = scene::makeBox({0.04f, 0.08f, 0.08f});
    for (size_t k = 0; k < half.vertices.size(); k += 3) half.vertices[k] += 0.02f;
    right.material = heavy, right.mesh = half.view();
    lab.body(light, whole, {0, 0.02f, 0}, Lab::kLiquid, [&](thawBodyDef& d) { d.parts = &right, d.partCount = 1; });
    lab.step(600);
    const thawParticleView v = lab.particles();
    double height[2] = {}, count[2] = {};
    for (int i = 0; i < v.count; ++i) {
        const size_t m = v.materials[i];
        height[m] += static_cast<double>(v.positions[4 * i + 1]), count[m] += 1;
    }
    // Two layers of 20 mm lie at 30 and 10 mm.
    found.within("mean height of the heavy half, m", 0.01, height[1] / count[1], 0.1);
    found.within("mean height of the light half, m", 0.03, height[0] / count[0], 0.1);
    found.atMost("mean compression", 0.01, static_cast<double>(lab.counters().meanCompression));
}

} // namespace

CaseList materialCases() {
    return {{"unlike-blob", "ball of halves of 500 and 1000 kg/m^3 drifts freely for 5 s", unlikeBlob},
            {"unlike-layers", "500 and 1000 kg/m^3, 0.5 Pa s, side by side: 10 s later the heavy lies under the light",
             heavierSinks}};
}

} // namespace thaw::player
