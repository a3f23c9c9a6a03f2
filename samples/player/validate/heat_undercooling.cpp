// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Melt that stays liquid below its melting point until something makes it set.
#include "validate/heat_lab.h"
#include "validate/validate.h"

#include <algorithm>
#include <cmath>

namespace thaw::player {
namespace {

constexpr double kPoint = 330, kUndercooling = 25, kHeat = 2000, kLatent = 2e5;

thawMaterialDef melt(double undercooling) {
    thawMaterialDef m = stays({900, 0.24, 0.2, kHeat, kHeat, kLatent, kPoint});
    m.undercooling = static_cast<float>(undercooling);
    return m;
}

// The change of the energy that the books do not show, over the heat of melting.
double unbooked(const thawLedger& before, const thawLedger& after) {
    const double moved = (after.absorbed - before.absorbed) + (after.contact - before.contact) -
                         (after.emitted - before.emitted) - (after.convected - before.convected);
    return std::abs(after.energyNow - before.energyNow - moved) / (kLatent * after.massNow);
}

thawLedger ledgerOf(const Lab& lab) {
    thawLedger l;
    thawWorld_GetLedger(lab.world(), &l);
    return l;
}

// A drop that is one particle, in cold air: nothing in it is colder than the rest.
void drop(Findings& found) {
    Lab lab(0.002f, 100, {0, 0, 0}, 1);
    thawWorld_SetAmbient(lab.world(), 290, 2000);
    lab.box(lab.material(melt(kUndercooling)), {0, 0, 0}, {0.002f, 0.002f, 0.002f}, 340);
    float coldest = 1e9f, solidest = 1, before = 0, jumped = 0;
    double error = 1;
    bool held = true; // liquid as long as it cools
    for (int step = 0; step < 600 && jumped == 0; ++step) {
        const thawLedger was = ledgerOf(lab);
        lab.step(1);
        const float now = lab.counters().minTemperature;
        if (step > 0 && now > before) {
            jumped = now, error = unbooked(was, ledgerOf(lab)), solidest = lab.counters().meltedFraction;
        } else {
            coldest = std::min(coldest, now), held &= lab.counters().meltedFraction == 1;
        }
        before = now;
    }
    found.within("coldest as a liquid, K", kPoint - kUndercooling, static_cast<double>(coldest), 0.002);
    found.atLeast("liquid until then", 1, held);
    found.within("when it sets, K", kPoint, static_cast<double>(jumped), 1e-6);
    found.within("solid then: its undercooling over latent heat", kUndercooling * kHeat / kLatent,
                 1 - static_cast<double>(solidest), 0.03);
    found.atMost("energy in that step, over the heat of melting", 1e-6, error);
}

// A bar of melt, undercooled as a whole, touches solid: it warms to the melting point from that end to the other.
void seeded(Findings& found) {
    constexpr int kLayers = 30;
    constexpr float kSpacing = 0.004f;
    Bar bar(kSpacing, 4, 2000, 1, 315);
    thawWorld_SetAmbient(bar.lab.world(), 315, 5000); // cools by its ends alone, the rest are walls
    const thawMaterialId material = bar.lab.material(melt(kUndercooling));
    bar.section(material, kLayers, 331);
    for (int step = 0; step < 6000 && bar.temperatures()[kLayers / 2] > 329.5; ++step) bar.run(bar.stepSeconds());
    found.atLeast("liquid below its melting point", 1, static_cast<double>(bar.lab.counters().meltedFraction));
    bar.section(material, 3, 320);
    const double solid = 3.0 / (kLayers + 3);
    const thawLedger touched = ledgerOf(bar.lab);
    bar.run(60 * bar.stepSeconds());
    const thawLedger after = ledgerOf(bar.lab);
    const std::vector<double> T = bar.temperatures();
    double coldest = 1e9;
    for (int k = 0; k < kLayers - 3; ++k) coldest = std::min(coldest, T[static_cast<size_t>(k)]);
    found.atLeast("share that has begun to set, past what touches it", solid,
                  1 - static_cast<double>(bar.lab.counters().meltedFraction));
    found.within("coldest a second later, three layers from the seed, K", kPoint, coldest, 1e-3);
    found.atMost("energy that the books do not explain, over the heat of melting", 1e-6, unbooked(touched, after));
}

// Melt that touches its own solid from the start sets as without undercooling, to the last bit.
void front(Findings& found) {
    double molten[2];
    for (const bool undercools : {false, true}) {
        Bar bar(0.004f, 4, 2000, 100, 330);
        const thawMaterialId material = bar.lab.material(melt(undercools ? kUndercooling : 0));
        bar.section(material, 6, 320);
        bar.section(material, 12, 330.5);
        bar.holdBegin(300);
        bar.run(3000);
        molten[undercools] = bar.molten();
    }
    found.atMost("layers still molten", 11, molten[0]);
    found.atMost("undercooling makes a difference", 0, molten[1] != molten[0]);
}

} // namespace

CaseList undercoolingCases() {
    return {
        {"undercooled-drop", "a drop cools to solidus - undercooling as a liquid, sets, and warms: no energy is made",
         drop},
        {"undercooled-seed", "a bar of melt colder than its melting point touches solid and warms all along", seeded},
        {"undercooled-front", "where melt has touched its solid all along it sets as without", front}};
}

} // namespace thaw::player
