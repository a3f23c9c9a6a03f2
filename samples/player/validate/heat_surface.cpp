// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// What surfaces lose and take up, and what that melts.
#include "validate/hare.h"
#include "validate/heat_lab.h"
#include "validate/validate.h"

#include <algorithm>
#include <cmath>

namespace thaw::player {
namespace {

constexpr double kStefanBoltzmann = 5.670374419e-8;

double massOf(const Lab& lab) {
    const thawParticleView p = lab.particles();
    double sum = 0;
    for (int i = 0; i < p.count; ++i) sum += static_cast<double>(p.velocities[4 * i + 3]);
    return sum;
}
double meanTemperature(const Lab& lab) {
    const thawParticleView p = lab.particles();
    double sum = 0;
    for (int i = 0; i < p.count; ++i) sum += static_cast<double>(p.temperatures[i]);
    return sum / p.count;
}
thawLedger ledgerOf(const Lab& lab) {
    thawLedger l;
    thawWorld_GetLedger(lab.world(), &l);
    return l;
}

void area(Findings& found) {
    const auto row = [&](const std::string& what, const scene::TriMesh& mesh, float spacing) {
        Lab lab(spacing, 120000, {0, 0, 0}, 1);
        thawWorld_SetAmbient(lab.world(), 0, 0);
        thawMaterialDef m = stays(1000, 1000, 1);
        m.emissivity = 1;
        constexpr float kTemperature = 500;
        lab.body(lab.material(m), mesh, {0, 0, 0}, kTemperature);
        lab.step(1);
        const double radiated = ledgerOf(lab).emitted * 60;
        found.within(what + ": radiated / (sigma T^4), m^2", areaOf(mesh),
                     radiated / (kStefanBoltzmann * std::pow(static_cast<double>(kTemperature), 4)), 0.05);
    };
    for (const float radius : {5.0f, 8.0f, 12.0f})
        row("sphere, radius " + std::to_string(static_cast<int>(radius)) + " spacings",
            scene::makeSphere(radius * 0.002f), 0.002f);
    for (const float edge : {8.0f, 14.0f, 20.0f})
        row("cube, edge " + std::to_string(static_cast<int>(edge)) + " spacings",
            scene::makeBox({edge * 0.002f, edge * 0.002f, edge * 0.002f}), 0.002f);
    for (const float spacing : {0.002f, 0.0015f})
        row("candle with drips, at " + std::to_string(spacing).substr(0, 6) + " m", scene::makeCandle(), spacing);
    for (const float spacing : {0.002f, 0.0015f, 0.0012f})
        row("hare, at " + std::to_string(spacing).substr(0, 6) + " m", makeHare(), spacing);
    for (const float layers : {0.5f, 0.8f, 1.0f, 2.0f})
        row("sheet of " + std::to_string(layers).substr(0, 3) + " layers",
            scene::makeBox({0.06f, layers * 0.002f, 0.06f}), 0.002f);
    for (const float length : {150.0f, 400.0f})
        row("bar of 6 x 6, length " + std::to_string(static_cast<int>(length)) + " spacings",
            scene::makeBox({length * 0.002f, 0.012f, 0.012f}), 0.002f);
    row("torus, tube of radius 5 spacings", scene::makeTorus(0.03f, 0.01f), 0.002f);
}

// A ball that conducts so well that it has one temperature: dT/dt = -k (T^4 - Ta^4), k = eps sigma A / (m c).
// At time scale 1 it has a hundredth of the heat.
void greyBall(Findings& found, double ambient) {
    for (const float scale : {1.0f, 100.0f, 5000.0f}) {
        Lab lab(0.005f, 4000, {0, 0, 0}, scale, 1);
        thawWorld_SetAmbient(lab.world(), static_cast<float>(ambient), 0);
        const double heat = scale == 1 ? 22 : 2200;
        thawMaterialDef m = stays(900, heat, 200);
        m.emissivity = 0.95f;
        constexpr double kStart = 400;
        lab.body(lab.material(m), scene::makeSphere(0.04f), {0, 0, 0}, static_cast<float>(kStart));
        const double k = 0.95 * kStefanBoltzmann * exposedArea(lab) / (massOf(lab) * heat);
        const double nominal = 0.95 * kStefanBoltzmann * 3 / (900 * heat * 0.04);
        const int steps = static_cast<int>(std::lround(36 * heat / 22 * 60 / static_cast<double>(scale)));
        lab.step(steps);
        const double t = steps / 60.0 * static_cast<double>(scale);
        // Runge-Kutta, as the closed form gives t of T.
        const auto theory = [&](double rate) {
            const auto slope = [&](double T) {
                return -rate * (T * T * T * T - ambient * ambient * ambient * ambient);
            };
            double T = kStart;
            constexpr int kParts = 1000;
            for (int n = 0; n < kParts; ++n) {
                const double h = t / kParts, a = slope(T), b = slope(T + 0.5 * h * a), c = slope(T + 0.5 * h * b),
                             d = slope(T + h * c);
                T += h / 6 * (a + 2 * b + 2 * c + d);
            }
            return T;
        };
        const std::string name = "time scale " + std::to_string(static_cast<int>(scale));
        const double T = meanTemperature(lab);
        found.within(name + ": temperature, K", theory(nominal), T, 0.01);
        found.within(name + ": fall by the exposed area found, K", kStart - theory(k), kStart - T, 0.01);
    }
}
void greyToSpace(Findings& found) { greyBall(found, 0); }
void greyToAmbient(Findings& found) { greyBall(found, 293.15); }

// A lump in warm air that melts at one temperature: the plateau takes m L / (h A (Ta - Tm)).
void plateau(Findings& found) {
    for (const float scale : {1.0f, 100.0f, 5000.0f}) {
        Lab lab(0.004f, 4000, {0, 0, 0}, scale, 1);
        constexpr double kAir = 325, kPoint = 320, kTransfer = 5;
        thawWorld_SetAmbient(lab.world(), static_cast<float>(kAir), static_cast<float>(kTransfer));
        // Heats go with the time, so that a step is the same share of it: 1 in 900.
        const double latent = 40 * static_cast<double>(scale), heat = latent / 3;
        const Melting m{900, 100, 100, heat, heat, latent, kPoint};
        lab.body(lab.material(stays(m)), scene::makeSphere(0.03f), {0, 0, 0}, static_cast<float>(kPoint));
        const double expected = massOf(lab) * latent / (kTransfer * exposedArea(lab) * (kAir - kPoint));
        double from = -1, to = -1, last = 0;
        for (int step = 1; to < 0 && step < 4000; ++step) {
            lab.step(1);
            const double now = static_cast<double>(lab.counters().meltedFraction);
            const double h = static_cast<double>(scale) / 60, t = step * h;
            const auto crossed = [&](double level) { return t - h * (now - level) / (now - last); };
            if (from < 0 && now > 0.05) from = crossed(0.05);
            if (to < 0 && now > 0.95) to = crossed(0.95);
            last = now;
        }
        found.within("time scale " + std::to_string(static_cast<int>(scale)) + ": from 5 to 95 % molten, s",
                     0.9 * expected, to - from, 0.01);
    }
}

// Light on the top of a tank of solid, under melt that holds little heat: after the transient the front goes down at
// q / (rho (L + c (Tm - T))).
void irradiatedSlab(Findings& found) {
    constexpr int kWide = 6, kDeep = 30;
    constexpr float kSpacing = 0.004f, kScale = 20;
    constexpr double kPoint = 330, kCold = 300, kDensity = 900, kHeat = 2000, kLatent = 2e5, kDistance = 1,
                     kPower = 2e5;
    Lab lab(kSpacing, 2000, {0, 0, 0}, kScale, 1);
    thawWorld_SetAmbient(lab.world(), static_cast<float>(kCold), 0);
    const float side = kWide * kSpacing, height = kDeep * kSpacing;
    lab.tank({0, 0, 0}, {side, 1, side});
    thawMaterialDef m = stays({kDensity, 1.2, 4, kHeat, 20, kLatent, kPoint});
    m.absorptivity = 1;
    lab.box(lab.material(m), {0, 0, 0}, {side, height, side}, static_cast<float>(kCold));
    thawHeatSourceDef lamp;
    thawInitHeatSourceDef(&lamp);
    lamp.position = {0.5f * side, height + static_cast<float>(kDistance), 0.5f * side};
    lamp.power = static_cast<float>(kPower);
    lab.source(lamp);
    const double flux = kPower / (4 * kPi * kDistance * kDistance);
    const double speed = flux / (kDensity * (kLatent + kHeat * (kPoint - kCold)));
    double from = -1, to = -1, last = 0;
    for (int step = 1; to < 0 && step < 6000; ++step) {
        lab.step(1);
        const double now = static_cast<double>(lab.counters().meltedFraction), h = static_cast<double>(kScale) / 60;
        const auto crossed = [&](double level) { return h * (step - (now - level) / (now - last)); };
        if (from < 0 && now > 0.3) from = crossed(0.3);
        if (to < 0 && now > 0.7) to = crossed(0.7);
        last = now;
    }
    found.within("speed of the front from 30 to 70 %, m/s", speed, 0.4 * static_cast<double>(height) / (to - from),
                 0.05);
}

// Melts under a lamp, runs, the lamp goes out, sets again.
void ledger(Findings& found) {
    for (const float scale : {1.0f, 100.0f, 5000.0f}) {
        Lab lab(0.004f, 4000, {0, -9.81f, 0}, scale, 1);
        thawWorld_SetAmbient(lab.world(), 290, 15);
        lab.floor();
        thawMaterialDef m;
        thawInitMaterialDef(&m, thawMaterial_wax);
        const float share = std::min(scale / 100, 40.0f); // of the heat it needs, so that it is done in a minute
        m.latentHeat *= share, m.specificHeatSolid *= share, m.specificHeatLiquid *= share;
        lab.box(lab.material(m), {-0.02f, 0, -0.02f}, {0.02f, 0.04f, 0.02f}, 315);
        thawHeatSourceDef lamp;
        thawInitHeatSourceDef(&lamp);
        lamp.position = {0.05f, 0.1f, 0}, lamp.power = 2000;
        const thawHeatSourceId id = lab.source(lamp);
        float most = 0;
        lab.step(3600, [&](int frame) {
            most = std::max(most, lab.counters().meltedFraction);
            if (frame != 1200) return;
            lamp.enabled = false;
            thawHeatSource_Set(lab.world(), id, &lamp);
        });
        const thawLedger l = ledgerOf(lab);
        const std::string name = "time scale " + std::to_string(static_cast<int>(scale));
        found.atLeast(name + ": molten at most", 0.3, static_cast<double>(most));
        found.atMost(name + ": molten in the end", 0.5 * static_cast<double>(most),
                     static_cast<double>(lab.counters().meltedFraction));
        found.atMost(name + ": energy that the books do not explain", 1e-5, l.energyError);
        found.atMost(name + ": mass that the books do not explain", 1e-6, l.massError);
    }
}

// Wax hotter than its burning temperature: e^(-rate t) of it is left, with the heat that it has, and the same bits on
// any number of threads. Then in the open, on a floor, beside a lamp.
void burnOff(Findings& found) {
    uint64_t hash[2];
    for (const int threads : {1, 3}) {
        Lab lab(0.002f, 9000, {0, 0, 0}, 1, threads);
        thawWorld_SetAmbient(lab.world(), 600, 0);
        thawMaterialDef m = stays({900, 0.2, 0.2, 2000, 2000, 2e5, 330});
        m.burnTemperature = 550, m.burnRate = 0.5f, m.vapourHeat = 9e4f; // at 600 K it has 1e5
        lab.box(lab.material(m), {0, 0, 0}, {0.04f, 0.04f, 0.04f}, 600);
        const double before = massOf(lab);
        lab.step(60);
        hash[threads > 1] = thawWorld_GetStateHash(lab.world());
        if (threads > 1) continue;
        found.within("left after 1 s at 0.5 / s", std::exp(-0.5), massOf(lab) / before, 0.03);
        const thawLedger l = ledgerOf(lab);
        found.within("heat taken along, J/kg", 2e5 + 2000 * 270.0, l.energyBurnt / l.massBurnt, 1e-5);
        found.atMost("energy that the books do not explain", 1e-5, l.energyError);
        found.atMost("mass that the books do not explain", 1e-6, l.massError);
    }
    found.atMost("threads make a difference", 0, hash[0] != hash[1]);
    Lab lab(0.004f, 2000, {0, -9.81f, 0}, 20);
    lab.floor();
    thawMaterialDef m;
    thawInitMaterialDef(&m, thawMaterial_wax);
    m.burnTemperature = 420, m.burnRate = 1;
    lab.box(lab.material(m), {-0.02f, 0, -0.02f}, {0.02f, 0.04f, 0.02f}, 315);
    thawHeatSourceDef lamp;
    thawInitHeatSourceDef(&lamp);
    lamp.position = {0.05f, 0.06f, 0}, lamp.power = 2000;
    const thawHeatSourceId id = lab.source(lamp);
    lab.step(1200);
    lamp.enabled = false;
    if (thawHeatSource_Set(lab.world(), id, &lamp) != thawResult_ok)
        throw LabError(thawWorld_GetLastError(lab.world()));
    lab.step(2400);
    const thawLedger l = ledgerOf(lab);
    found.atLeast("by a lamp: share of the wax that burns", 0.05, l.massBurnt / l.massAdded);
    found.atMost("by a lamp: energy that the books do not explain", 1e-5, l.energyError);
    found.atMost("by a lamp: mass that the books do not explain", 1e-6, l.massError);
}

} // namespace

CaseList surfaceCases() {
    return {{"area", "what bodies radiate in one step, over sigma T^4: their area", area},
            {"grey-ball", "a ball of 8 spacings and one temperature radiates into nothing for an hour", greyToSpace},
            {"grey-ball-ambient", "the same into 293.15 K", greyToAmbient},
            {"plateau", "a ball melts at one temperature in warm air: m L / (h A (Ta - Tm))", plateau},
            {"irradiated-slab", "light on a slab: the front goes down at q / (rho (L + c dT))", irradiatedSlab},
            {"ledger", "wax melts under a lamp for 20 s, runs, and sets for 40 s: energy and mass", ledger},
            {"burn-off", "what is hotter than burnTemperature goes at burnRate: mass, energy, the same on any threads",
             burnOff}};
}

} // namespace thaw::player
