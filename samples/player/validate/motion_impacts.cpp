// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "validate/lab.h"
#include "validate/validate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace thaw::player {
namespace {

struct Compression {
    double worst = 0; // of the mean, over all frames
    double calm = 0;  // s from the first frame looked at until the mean stays below 1 %
    double end = 0;
};

Compression follow(Lab& lab, int frames) {
    Compression c;
    lab.step(frames, [&](int frame) {
        const double mean = static_cast<double>(lab.counters().meanCompression);
        c.worst = std::max(c.worst, mean), c.end = mean;
        if (mean > 0.01) c.calm = frame / 60.0;
    });
    return c;
}

// A cube of 48 mm comes down on a floor at 1.4 m/s. It flies a second without gravity first, so that nothing is left
// of how it came into the world.
void drop(Findings& found, float spacing, float viscosity) {
    constexpr float kEdge = 0.048f, kSpeed = 1.4f;
    Lab lab(spacing, 16000, {0, 0, 0});
    lab.floor();
    const float flown = kSpeed * 1.0f + 0.012f;
    lab.box(lab.material(Lab::plain(1000, viscosity)), {0, flown, 0}, {kEdge, flown + kEdge, kEdge}, Lab::kLiquid,
            [](thawBodyDef& d) {
                d.velocity = {0, -kSpeed, 0};
            });
    lab.step(60);
    thawWorld_SetGravity(lab.world(), {0, -9.81f, 0});
    const Compression c = follow(lab, 120);
    char what[64];
    std::snprintf(what, sizeof what, "%g mm, %g Pa s: worst mean compression", static_cast<double>(spacing) * 1e3,
                  static_cast<double>(viscosity));
    found.atMost(what, 0.1, c.worst);
    std::snprintf(what, sizeof what, "%g mm, %g Pa s: s until below 1 %%", static_cast<double>(spacing) * 1e3,
                  static_cast<double>(viscosity));
    found.atMost(what, 1, c.calm);
}

void dropCoarse(Findings& found) {
    for (const float viscosity : {0.02f, 0.1f, 1.0f, 10.0f}) drop(found, 0.004f, viscosity);
}
void dropFine(Findings& found) {
    for (const float viscosity : {0.02f, 0.1f, 1.0f, 10.0f}) drop(found, 0.002f, viscosity);
}

// A block that is liquid from the start: in a tank that it fills, and free on the floor.
void birth(Findings& found) {
    for (const float viscosity : {0.02f, 0.3f, 10.0f})
        for (const bool walls : {true, false}) {
            Lab lab(0.004f, 4000);
            constexpr float kEdge = 0.048f;
            if (walls)
                lab.tank({0, 0, 0}, {kEdge, 1, kEdge});
            else
                lab.floor();
            lab.box(lab.material(Lab::plain(1000, viscosity)), {0, 0, 0}, {kEdge, kEdge, kEdge}, Lab::kLiquid);
            const Compression c = follow(lab, 240);
            char what[64];
            std::snprintf(what, sizeof what, "%s, %g Pa s: worst mean compression", walls ? "tank" : "free",
                          static_cast<double>(viscosity));
            found.atMost(what, 0.05, c.worst);
        }
}

// A solid block just short of letting go, of a substance that conducts well, in hot air: all of it melts in a few
// frames.
void melting(Findings& found) {
    for (const float viscosity : {0.02f, 0.3f, 10.0f})
        for (const bool walls : {true, false}) {
            Lab lab(0.004f, 4000, {0, -9.81f, 0}, 1);
            constexpr float kEdge = 0.048f;
            if (walls)
                lab.tank({0, 0, 0}, {kEdge, 1, kEdge});
            else
                lab.floor();
            thawMaterialDef m = Lab::plain(1000, viscosity);
            m.solidus = 300, m.liquidus = 301, m.latentHeat = 0;
            m.specificHeatSolid = m.specificHeatLiquid = 1000;
            m.conductivitySolid = m.conductivityLiquid = 1e4f;
            const float warm = 300 + 0.98f * m.releaseFraction;
            lab.box(lab.material(m), {0, 0, 0}, {kEdge, kEdge, kEdge}, warm);
            thawWorld_SetAmbient(lab.world(), 400, 1e4f);
            int first = 0, last = 0;
            Compression c;
            lab.step(240, [&](int frame) {
                const thawCounters k = lab.counters();
                c.worst = std::max(c.worst, static_cast<double>(k.meanCompression));
                if (k.moving > 0 && first == 0) first = frame;
                if (k.fixed > 0) last = frame;
            });
            char what[64];
            std::snprintf(what, sizeof what, "%s, %g Pa s: frames until all is loose", walls ? "tank" : "free",
                          static_cast<double>(viscosity));
            found.atMost(what, 10, first > 0 ? last - first + 1 : 1e3);
            std::snprintf(what, sizeof what, "%s, %g Pa s: worst mean compression", walls ? "tank" : "free",
                          static_cast<double>(viscosity));
            found.atMost(what, 0.05, c.worst);
        }
}

} // namespace

CaseList impactCases() {
    return {{"drop-block-4mm", "48 mm cube, 1.4 m/s, 4 mm", dropCoarse},
            {"drop-block-2mm", "48 mm cube, 1.4 m/s, 2 mm", dropFine},
            {"born-liquid", "48 mm cube, liquid from the start", birth},
            {"melts-at-once", "48 mm cube that melts within a few frames", melting}};
}

} // namespace thaw::player
