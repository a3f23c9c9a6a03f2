// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// Coulomb friction of elastic solids on colliders.
#include "validate/lab.h"
#include "validate/validate.h"

#include <algorithm>
#include <cmath>

namespace thaw::player {
namespace {

thawMaterialDef soft(float modulus) {
    thawMaterialDef m = Lab::plain(1000, 1);
    m.viscositySolid = 10, m.youngModulus = modulus;
    return m;
}

// Mean place and velocity of all particles along a unit vector.
struct Along {
    double x = 0, v = 0;
};
Along along(const Lab& lab, double ax, double ay) {
    const thawParticleView p = lab.particles();
    Along a;
    for (int i = 0; i < p.count; ++i) {
        a.x += ax * static_cast<double>(p.positions[4 * i]) + ay * static_cast<double>(p.positions[4 * i + 1]);
        a.v += ax * static_cast<double>(p.velocities[4 * i]) + ay * static_cast<double>(p.velocities[4 * i + 1]);
    }
    a.x /= p.count, a.v /= p.count;
    return a;
}

// A block of 32 x 16 x 32 mm on a plane that falls off by so much along +x.
struct Slope {
    double c, s;
    Lab lab;
    Slope(float spacing, double degrees, float friction, float modulus, float speed)
        : c(std::cos(degrees * M_PI / 180)), s(std::sin(degrees * M_PI / 180)), lab(spacing) {
        thawColliderDef d;
        thawInitColliderDef(&d, thawCollider_plane);
        d.friction = friction;
        const thawVec3 normal{static_cast<float>(s), static_cast<float>(c), 0};
        d.rotation = turnTo({0, 1, 0}, normal);
        lab.collider(d);
        lab.body(lab.material(soft(modulus)), scene::makeBox({0.032f, 0.016f, 0.032f}),
                 {0.008f * normal.x, 0.008f * normal.y, 0}, Lab::kSolid, [&](thawBodyDef& b) {
                     b.anchored = false, b.rotation = d.rotation;
                     b.velocity = {speed * static_cast<float>(c), -speed * static_cast<float>(s), 0};
                 });
    }
    Along now() const { return along(lab, c, -s); }
};

// What slides on a floor stops after v^2 / (2 mu g), and sleeps there.
void stops(Findings& found) {
    struct Slip {
        float spacing, friction, modulus, speed;
    };
    for (const Slip& t : {Slip{0.004f, 0.3f, 1e5f, 0.7f},
                          {0.004f, 0.5f, 2e4f, 1.0f},
                          {0.002f, 0.3f, 1e5f, 0.8f},
                          {0.004f, 0.1f, 1e5f, 0.3f}}) {
        Slope slope(t.spacing, 0, t.friction, t.modulus, t.speed);
        char what[128];
        const auto named = [&](const char* text) {
            std::snprintf(what, sizeof what, "%g mm, mu %g, %g Pa, %g m/s: %s", 1000 * static_cast<double>(t.spacing),
                          static_cast<double>(t.friction), static_cast<double>(t.modulus), static_cast<double>(t.speed),
                          text);
            return what;
        };
        slope.lab.step(6); // it comes down on the floor
        const Along start = slope.now();
        slope.lab.step(114);
        const double end = slope.now().x;
        found.within(named("speed after 6 steps"),
                     static_cast<double>(t.speed) - static_cast<double>(t.friction) * 0.1 * kG, start.v, 0.25);
        found.within(named("way from there, m"), start.v * start.v / (2 * static_cast<double>(t.friction) * kG),
                     end - start.x, 0.15);
        slope.lab.step(120);
        found.atMost(named("goes on in 2 s, m"), 0, std::abs(slope.now().x - end));
        found.atMost(named("moving particles"), 0, slope.lab.counters().moving);
    }
}

// Steeper than atan(mu) it slides with g (sin b - mu cos b), else it stands.
void inclines(Findings& found) {
    struct Tilt {
        float spacing, friction, modulus;
        double degrees;
    };
    for (const Tilt& t : {Tilt{0.004f, 0.3f, 1e5f, 13},
                          {0.004f, 0.3f, 1e5f, 25},
                          {0.004f, 0.6f, 2e4f, 27},
                          {0.002f, 0.3f, 1e5f, 13},
                          {0.002f, 0.3f, 1e5f, 25},
                          {0.004f, 0, 1e5f, 10}}) {
        Slope slope(t.spacing, t.degrees, t.friction, t.modulus, 0);
        char what[128];
        const auto named = [&](const char* text) {
            std::snprintf(what, sizeof what, "%g mm, mu %g, %g Pa, %g degrees: %s",
                          1000 * static_cast<double>(t.spacing), static_cast<double>(t.friction),
                          static_cast<double>(t.modulus), t.degrees, text);
            return what;
        };
        const double fall = kG * (slope.s - static_cast<double>(t.friction) * slope.c);
        if (fall > 0) {
            slope.lab.step(12);
            const Along first = slope.now();
            slope.lab.step(30);
            found.within(named("gets faster by, m/s^2"), fall, 2 * (slope.now().v - first.v), 0.1);
            continue;
        }
        const double start = slope.now().x;
        slope.lab.step(120);
        const double end = slope.now().x;
        // It comes down on the plane without friction at first.
        found.atMost(named("goes until it is at rest, m"), 0.01, std::abs(end - start));
        found.atMost(named("moving particles"), 0, slope.lab.counters().moving);
        slope.lab.step(300);
        found.atMost(named("drifts in 5 s, m"), 0, std::abs(slope.now().x - end));
    }
}

} // namespace

CaseList softFrictionCases() {
    return {{"soft-stops", "elastic block slides on a floor: v^2 / (2 mu g)", stops},
            {"soft-incline", "elastic block on a plane below and above atan(mu)", inclines}};
}

} // namespace thaw::player
