// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// Elastic solids against what they touch: rigid pieces that are laid on them, a plate that pushes them.
#include "validate/lab.h"
#include "validate/validate.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace thaw::player {
namespace {

thawMaterialDef soft(float modulus, float density = 1000, float damping = 10) {
    thawMaterialDef m = Lab::plain(density, 1);
    m.viscositySolid = damping, m.youngModulus = modulus;
    return m;
}
void free(thawBodyDef& d) { d.anchored = false; }

// Of the particles of a body: mean position, momentum, kinetic energy and mass.
struct BodyState {
    double x[3] = {}, p[3] = {}, energy = 0, mass = 0;
};
BodyState stateOf(const Lab& lab, thawBodyId body) {
    const thawParticleView v = lab.particles();
    BodyState s;
    for (int i = 0; i < v.count; ++i) {
        if (v.bodies[i] != body.index1 - 1) continue;
        const float *x = v.positions + 4 * i, *u = v.velocities + 4 * i;
        const double m = static_cast<double>(u[3]);
        s.mass += m;
        for (int k = 0; k < 3; ++k) {
            s.x[k] += m * static_cast<double>(x[k]), s.p[k] += m * static_cast<double>(u[k]);
            s.energy += 0.5 * m * static_cast<double>(u[k]) * static_cast<double>(u[k]);
        }
    }
    for (double& x : s.x) x /= s.mass;
    return s;
}

// A plate is laid on a block that sleeps, or comes to it slower than gravity makes in a step: the block gives way as
// one that is awake does, p H / E of it (its foot sticks to the floor, which holds back a part).
void laidOn(Findings& found) {
    for (const float drop : {0.0f, 0.001f}) {
        Lab lab(0.004f);
        lab.floor();
        const thawBodyId block =
            lab.box(lab.material(soft(2e4f)), {-0.024f, 0, -0.024f}, {0.024f, 0.048f, 0.024f}, Lab::kSolid, free);
        lab.step(180);
        char what[96];
        const auto named = [&](const char* text) {
            std::snprintf(what, sizeof what, "from %g mm: %s", 1000 * static_cast<double>(drop), text);
            return what;
        };
        found.atMost(named("moving particles before"), 0, lab.counters().moving);
        const double before = stateOf(lab, block).x[1];
        const float y = 0.048f + drop;
        const thawBodyId plate = lab.box(lab.material(Lab::plain(4000, 1)), {-0.024f, y, -0.024f},
                                         {0.024f, y + 0.016f, 0.024f}, Lab::kSolid, free);
        double most = 0;
        lab.step(300, [&](int) {
            const BodyState s = stateOf(lab, plate);
            most = std::max(most, s.p[1] / s.mass);
        });
        const BodyState now = stateOf(lab, plate);
        const double pressure = now.mass * 9.81 / (0.048 * 0.048);
        // The mean of the block sinks by half of what its top does.
        found.within(named("the block sags, m"), 0.5 * pressure * 0.048 / 2e4, before - stateOf(lab, block).x[1], 0.15);
        found.atMost(named("thrown back, m/s"), 0.05, most);
        found.atMost(named("moving particles at the end"), 0, lab.counters().moving);
    }
}

// Without gravity: a cube comes slowly to a block that sleeps in the air.
void slowHit(Findings& found) {
    Lab lab(0.004f, 20000, {0, 0, 0});
    const thawBodyId block =
        lab.box(lab.material(soft(1e5f)), {-0.024f, 0, -0.024f}, {0.024f, 0.032f, 0.024f}, Lab::kSolid, free);
    lab.step(90);
    found.atMost("moving particles before", 0, lab.counters().moving);
    lab.box(lab.material(Lab::plain(900, 1)), {-0.012f, 0.036f, -0.012f}, {0.012f, 0.060f, 0.012f}, Lab::kSolid,
            [](thawBodyDef& d) {
                d.anchored = false, d.velocity = {0, -0.02f, 0};
            });
    const auto energyOf = [&] {
        const thawParticleView v = lab.particles();
        double sum = 0;
        for (int i = 0; i < v.count; ++i)
            for (int k = 0; k < 3; ++k)
                sum += 0.5 * static_cast<double>(v.velocities[4 * i + 3]) *
                       static_cast<double>(v.velocities[4 * i + k]) * static_cast<double>(v.velocities[4 * i + k]);
        return sum;
    };
    const double before = momentumOf(lab.particles()).p[1], energy = energyOf();
    double most = 0;
    lab.step(60, [&](int) { most = std::max(most, energyOf()); });
    found.within("momentum after, kg m/s", before, momentumOf(lab.particles()).p[1], 0.05);
    found.atLeast("share that the block takes", 0.5, stateOf(lab, block).p[1] / before);
    found.atMost("energy, of before", 1.01, most / energy);
}

// A plate comes along the floor to a block that stands free there, asleep, and goes on for 0.3 m.
void pushed(Findings& found) {
    struct Push {
        float spacing, speed;
        int frames;
    };
    for (const auto& [spacing, speed, frames] : {Push{0.004f, 0.1f, 180}, {0.004f, 0.3f, 60}, {0.002f, 0.3f, 60}}) {
        Lab lab(spacing);
        lab.floor();
        const thawBodyId block =
            lab.box(lab.material(soft(1e5f)), {-0.016f, 0, -0.016f}, {0.016f, 0.032f, 0.016f}, Lab::kSolid, free);
        thawColliderDef d;
        thawInitColliderDef(&d, thawCollider_box);
        d.size = {0.004f, 0.03f, 0.03f}, d.position = {-0.024f, 0.029f, 0};
        const thawColliderId plate = lab.collider(d);
        lab.step(120);
        const double start = stateOf(lab, block).x[0];
        const int asleep = lab.counters().moving;
        float face = d.position.x + d.size.x;
        double deepest = 0;
        for (int n = 0; n < frames; ++n) {
            face += speed / 60;
            thawCollider_SetTransform(lab.world(), plate, {face - d.size.x, d.position.y, 0}, d.rotation);
            lab.step(1);
            const thawParticleView v = lab.particles();
            for (int i = 0; i < v.count; ++i)
                deepest = std::max(deepest, static_cast<double>(face - v.positions[4 * i] + 0.5f * spacing));
        }
        char what[96];
        const auto named = [&](const char* text) {
            std::snprintf(what, sizeof what, "%g mm, %g m/s: %s", 1000 * static_cast<double>(spacing),
                          static_cast<double>(speed), text);
            return what;
        };
        found.atMost(named("moving particles before"), 0, asleep);
        found.atMost(named("the plate goes into it, spacings"), 0.25, deepest / static_cast<double>(spacing));
        const double way = static_cast<double>(speed) * frames / 60 - 0.004;
        found.within(named("its centre goes, m"), way, stateOf(lab, block).x[0] - start, 0.02);
        double lowest = INFINITY, highest = -INFINITY;
        const thawParticleView v = lab.particles();
        for (int i = 0; i < v.count; ++i) {
            lowest = std::min(lowest, static_cast<double>(v.positions[4 * i]));
            highest = std::max(highest, static_cast<double>(v.positions[4 * i]));
        }
        found.within(named("its length at the end, m"), 0.032, highest - lowest + static_cast<double>(spacing), 0.05);
        found.within(named("its height at the end, m"), 0.032, lab.height(), 0.05);
    }
}

} // namespace

CaseList softContactCases() {
    return {
        {"soft-laid-on", "rigid plate of 16 mm on an elastic block that sleeps: sag p H / E", laidOn},
        {"soft-slow-hit", "rigid cube at 0.02 m/s to an elastic block asleep in the air: momentum, energy", slowHit},
        {"soft-pushed", "a plate pushes an elastic cube of 32 mm, asleep, 0.3 m along the floor", pushed}};
}

} // namespace thaw::player
