// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "validate/lab.h"
#include "validate/validate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <map>

namespace thaw::player {
namespace {

using Point = std::array<double, 3>;

// By id, since rows are sorted anew every step.
std::map<uint32_t, Point> pointsOf(const Lab& lab) {
    const thawParticleView v = lab.particles();
    std::map<uint32_t, Point> points;
    for (int i = 0; i < v.count; ++i) {
        const float* x = v.positions + 4 * i;
        points[v.ids[i]] = {x[0], x[1], x[2]};
    }
    return points;
}

double farthest(const std::map<uint32_t, Point>& a, const std::map<uint32_t, Point>& b) {
    double most = 0;
    for (const auto& [id, x] : a) {
        const Point& y = b.at(id);
        most = std::max(most, std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]));
    }
    return most;
}

double fastest(const Lab& lab) {
    const thawParticleView v = lab.particles();
    double most = 0;
    for (int i = 0; i < v.count; ++i) {
        const float* u = v.velocities + 4 * i;
        most = std::max(most, static_cast<double>(std::hypot(u[0], u[1], u[2])));
    }
    return most;
}

thawMaterialDef soft(float modulus, float density = 1000, float damping = 10) {
    thawMaterialDef m = Lab::plain(density, 1);
    m.viscositySolid = damping, m.youngModulus = modulus;
    return m;
}

// Mean sinking of the particles that began in the topmost layer, m.
double topSinks(const std::map<uint32_t, Point>& before, const std::map<uint32_t, Point>& after, double spacing) {
    double top = -INFINITY, sum = 0;
    int n = 0;
    for (const auto& [id, x] : before) top = std::max(top, x[1]);
    for (const auto& [id, x] : before)
        if (x[1] > top - 0.5 * spacing) sum += x[1] - after.at(id)[1], ++n;
    return sum / n;
}

// A column stands on a floor that holds its lowest layer: rho g H^2 / (2 E), from that layer's centre to the top's.
void columnSag(Findings& found) {
    for (const float modulus : {1e4f, 1e5f, 1e6f}) {
        Lab lab(0.002f);
        lab.floor();
        lab.box(lab.material(soft(modulus)), {-0.008f, 0, -0.008f}, {0.008f, 0.04f, 0.008f}, Lab::kSolid);
        const auto before = pointsOf(lab);
        lab.step(1200);
        const double rho = 1000, g = 9.81, H = 0.04, dx = 0.002;
        char what[64];
        std::snprintf(what, sizeof what, "sag at E = %g Pa, m", static_cast<double>(modulus));
        found.within(what, rho * g * (H * H - H * dx) / (2 * static_cast<double>(modulus)),
                     topSinks(before, pointsOf(lab), dx), 0.05);
    }
}

// Held at one end by a wall. Euler-Bernoulli and shear of Timoshenko's beam: rho g L^4 A / (8 E I) + rho g L^2 / (2
// kappa G).
void cantilever(Findings& found) {
    Lab lab(0.004f);
    lab.plane({0, 0, 0}, {1, 0, 0});
    const float modulus = 2e5f;
    lab.box(lab.material(soft(modulus)), {0, -0.012f, -0.012f}, {0.08f, 0.012f, 0.012f}, Lab::kSolid);
    const auto before = pointsOf(lab);
    lab.step(1200);
    const auto middle = pointsOf(lab);
    lab.step(2400);
    const auto after = pointsOf(lab);
    double tip = -INFINITY, down = 0, along = 0;
    int n = 0;
    for (const auto& [id, x] : before) tip = std::max(tip, x[0]);
    for (const auto& [id, x] : before)
        if (x[0] > tip - 0.002) down += x[1] - after.at(id)[1], along += after.at(id)[0] - x[0], ++n;
    down /= n, along /= n;
    const double L = 0.08 - 0.002, t = 0.024, E = static_cast<double>(modulus), rg = 9810;
    const double theory = rg * std::pow(L, 4) * 12 / (8 * E * t * t) + rg * L * L / (2 * (5.0 / 6) * (E / 2.5));
    found.within("tip goes down, m", theory, down, 0.4);
    // The tip's way is an arc: a beam bent by the angle a is shorter by some 0.27 L a^2 in its old direction.
    found.within("length, of 0.08 m", 0.08, 0.08 + along + 0.6 * down * down / L, 0.02);
    found.atMost("drift in 40 s, spacings", 0.1, farthest(middle, after) / 0.004);
}

void softAtRest(Findings& found) {
    Lab lab(0.004f);
    lab.floor();
    thawMaterialDef butter;
    thawInitMaterialDef(&butter, thawMaterial_butter);
    butter.youngModulus = 1e5f, butter.solidYieldStress = 3e3f;
    lab.box(lab.material(butter), {-0.05f, 0, -0.03f}, {0.05f, 0.05f, 0.03f}, 278);
    const auto before = pointsOf(lab);
    lab.step(3600);
    const auto after = pointsOf(lab);
    found.atMost("farthest from where it was made, spacings", 0.1, farthest(before, after) / 0.004);
    found.atMost("moving particles at the end", 0, lab.counters().moving);
}

void drop(Findings& found) {
    for (const float modulus : {5e3f, 1e5f}) {
        Lab lab(0.004f);
        lab.floor();
        lab.box(lab.material(soft(modulus)), {-0.016f, 0.1f, -0.016f}, {0.016f, 0.132f, 0.016f}, Lab::kSolid);
        double most = 0, lowest = 1, flight = 0, bottom = 1;
        for (const auto& [id, x] : pointsOf(lab)) bottom = std::min(bottom, x[1]);
        const double tall = lab.height() - bottom + 0.002;
        lab.step(300, [&](int frame) {
            if (frame == 8) {
                const thawParticleView v = lab.particles();
                for (int i = 0; i < v.count; ++i) flight += static_cast<double>(v.positions[4 * i + 1]) / v.count;
            }
            if (frame > 10) lowest = std::min(lowest, lab.height());
            if (frame > 16) most = std::max(most, fastest(lab));
        });
        const auto middle = pointsOf(lab);
        lab.step(300);
        char what[64];
        const auto name = [&](const char* text) {
            std::snprintf(what, sizeof what, "E = %g Pa: %s", static_cast<double>(modulus), text);
            return std::string(what);
        };
        // Free fall from rest at 0.116 m, the first step spent on its bonds.
        found.within(name("height after 8 steps, m"), 0.116 - 0.5 * 9.81 * 7 * 8 / 3600, flight, 0.02);
        found.atMost(name("fastest after it landed, m/s"), 1.4, most);
        found.atLeast(name("height at its flattest, m"), modulus > 1e4f ? 0.024 : 0.012, lowest);
        found.within(name("height at rest, m"), tall, lab.height(),
                     0.02 + 0.5 * 9810 * tall / static_cast<double>(modulus));
        found.atMost(name("creep in 5 s, spacings"), 0.01, farthest(middle, pointsOf(lab)) / 0.004);
    }
}

// Stress that falls as e^(-t / tau) under a load that stays is a strain that grows: in one tau by 5/6 of the elastic
// one, since only the deviatoric part of the stress falls and E = 2.5 G.
// Between a layer above the foot and the top: the foot, which is held, cannot spread, and creeps the less for it over
// about half its width.
void creep(Findings& found) {
    Lab lab(0.004f);
    lab.floor();
    thawMaterialDef m = soft(2e5f);
    m.relaxationTime = 5;
    lab.box(lab.material(m), {-0.016f, 0, -0.016f}, {0.016f, 0.08f, 0.016f}, Lab::kSolid);
    const auto before = pointsOf(lab);
    const double foot = 0.022, dx = 0.004, H = 0.08;
    const auto shortens = [&] {
        const auto now = pointsOf(lab);
        double down = 0;
        int n = 0;
        for (const auto& [id, x] : before)
            if (std::abs(x[1] - foot) < 0.5 * dx) down += x[1] - now.at(id)[1], ++n;
        return topSinks(before, now, dx) - down / n;
    };
    lab.step(300);
    const double first = shortens();
    lab.step(600);
    const double elastic = 9810 * ((H - foot) * (H - foot) - 0.25 * dx * dx) / (2 * 2e5);
    found.within("shortens in 10 s, m", elastic * 10 / 5 / 1.2, shortens() - first, 0.05);
}

void yields(Findings& found) {
    for (const float yield : {1000.0f, 60.0f}) {
        Lab lab(0.004f);
        lab.floor();
        thawMaterialDef m = soft(5e4f);
        m.solidYieldStress = yield;
        lab.box(lab.material(m), {-0.016f, 0, -0.016f}, {0.016f, 0.032f, 0.016f}, Lab::kSolid);
        lab.step(900);
        const auto middle = pointsOf(lab);
        lab.step(600);
        char what[64];
        const auto name = [&](const char* text) {
            std::snprintf(what, sizeof what, "yields at %g Pa: %s", static_cast<double>(yield), text);
            return std::string(what);
        };
        // rho g H = 314 Pa.
        if (yield > 314)
            found.within(name("height, m"), 0.032, lab.height(), 0.02);
        else
            found.atMost(name("height, m"), 0.026, lab.height());
        if (yield > 314)
            found.atMost(name("creep from 15 to 25 s, spacings"), 0.1, farthest(middle, pointsOf(lab)) / 0.004);
        const auto late = pointsOf(lab);
        lab.step(300);
        found.atMost(name("creep from 25 to 30 s, spacings"), yield > 314 ? 0 : 0.02,
                     farthest(late, pointsOf(lab)) / 0.004);
        found.atMost(name("moving share after 30 s"), yield > 314 ? 0 : 0.1,
                     static_cast<double>(lab.counters().moving) / lab.counters().particles);
    }
}

// A puddle of melt that comes to rest, then cools until all of it is solid.
void refreeze(Findings& found) {
    for (const bool elastic : {false, true}) {
        Lab lab(0.004f);
        lab.floor();
        thawMaterialDef m = Lab::plain(1000, 2);
        m.cohesion = 6, m.youngModulus = elastic ? 1e5f : 0.0f;
        // Cools as a whole: inside of a crust that sets first, melt still flows.
        m.conductivitySolid = m.conductivityLiquid = 20, m.viscositySolid = 1e3f;
        lab.body(lab.material(m), scene::makeSphere(0.02f), {0, 0.02f, 0}, Lab::kLiquid);
        lab.step(180);
        thawWorld_SetAmbient(lab.world(), 270, 500);
        thawWorld_SetThermalTimeScale(lab.world(), 30);
        // Of what is cold enough to set, from the step on in which it becomes so.
        double jump = 0;
        std::map<uint32_t, Point> last;
        for (int frame = 0; frame < 3600 && lab.counters().meltedFraction > 0; ++frame) {
            lab.step(1);
            const thawParticleView v = lab.particles();
            for (int i = 0; i < v.count; ++i) {
                const float* x = v.positions + 4 * i;
                if (v.liquidFractions[i] >= m.setFraction) continue;
                const auto old = last.find(v.ids[i]);
                if (old != last.end())
                    jump =
                        std::max(jump, std::hypot(x[0] - old->second[0], x[1] - old->second[1], x[2] - old->second[2]));
                last[v.ids[i]] = {x[0], x[1], x[2]};
            }
        }
        jump /= 0.004;
        const auto set = pointsOf(lab);
        lab.step(3600);
        char what[64];
        const auto name = [&](const char* text) {
            std::snprintf(what, sizeof what, "%s: %s", elastic ? "elastic" : "rigid", text);
            return std::string(what);
        };
        found.atMost(name("melted at the end, share"), 0, static_cast<double>(lab.counters().meltedFraction));
        found.atMost(name("largest way in a step while it sets, spacings"), 0.02, jump);
        found.atMost(name("changes in 60 s after, spacings"), 0.05, farthest(set, pointsOf(lab)) / 0.004);
    }
}

// A lamp melts one side of an elastic block, whose melt runs down over it.
void melting(Findings& found) {
    for (const float spacing : {0.002f, 0.004f})
        for (const float viscosity : {0.05f, 0.2f, 1.0f}) {
            Lab lab(spacing, 20000, {0, -9.81f, 0}, 20);
            lab.floor();
            thawMaterialDef m = Lab::plain(1000, viscosity);
            m.viscositySolid = 1e3f, m.cohesion = 6, m.adhesion = 0.5f, m.youngModulus = 1e5f;
            const float a = 6 * spacing, h = 14 * spacing;
            lab.box(lab.material(m), {-a, 0, -a}, {a, h, a}, 298);
            thawHeatSourceDef source;
            thawInitHeatSourceDef(&source);
            source.position = {2.5f * a, 0.8f * h, 0};
            source.power = 60 * (spacing / 0.002f) * (spacing / 0.002f) * (spacing / 0.002f);
            lab.source(source);
            double most = 0;
            lab.step(1200, [&](int) { most = std::max(most, fastest(lab)); });
            char what[64];
            const double fall = std::sqrt(2 * 9.81 * static_cast<double>(h));
            std::snprintf(what, sizeof what, "%g mm, %g Pa s: fastest / free fall", 1000 * static_cast<double>(spacing),
                          static_cast<double>(viscosity));
            found.atMost(what, 2, most / fall);
            std::snprintf(what, sizeof what, "%g mm, %g Pa s: melted share", 1000 * static_cast<double>(spacing),
                          static_cast<double>(viscosity));
            found.atLeast(what, 0.1, static_cast<double>(lab.counters().meltedFraction));
        }
}

void stack(Findings& found) {
    Lab lab(0.004f);
    lab.floor();
    const thawMaterialId m = lab.material(soft(1e5f));
    lab.box(m, {-0.02f, 0, -0.02f}, {0.02f, 0.032f, 0.02f}, Lab::kSolid);
    lab.box(m, {-0.014f, 0.05f, -0.014f}, {0.014f, 0.078f, 0.014f}, Lab::kSolid);
    double most = 0;
    lab.step(600, [&](int frame) {
        if (frame > 60) most = std::max(most, fastest(lab));
    });
    const auto middle = pointsOf(lab);
    lab.step(600);
    found.within("height, m", 0.06, lab.height(), 0.05);
    found.atMost("fastest after 1 s, m/s", 0.1, most);
    found.atMost("creep in 10 s, spacings", 0.02, farthest(middle, pointsOf(lab)) / 0.004);
    found.atMost("moving particles at the end", 0, lab.counters().moving);
}

// A rigid cube falls 50 mm on an elastic block that stands free, awake (made a moment ago) or asleep.
struct Landing {
    float spacing;
    bool asleep;
};
void landOnSoft(Findings& found, std::initializer_list<Landing> variants) {
    for (const auto& [spacing, asleep] : variants) {
        Lab lab(spacing);
        lab.floor();
        lab.box(lab.material(soft(1e5f)), {-0.024f, 0, -0.024f}, {0.024f, 0.032f, 0.024f}, Lab::kSolid,
                [](thawBodyDef& d) { d.anchored = false; });
        lab.step(asleep ? 120 : 1);
        if (asleep) found.atMost("moving particles before it falls", 0, lab.counters().moving);
        const thawBodyId cube =
            lab.box(lab.material(Lab::plain(900, 1)), {-0.012f, 0.082f, -0.012f}, {0.012f, 0.106f, 0.012f}, Lab::kSolid,
                    [](thawBodyDef& d) { d.anchored = false; });
        const auto middleOf = [&] {
            const thawParticleView v = lab.particles();
            double y = 0;
            int n = 0;
            for (int i = 0; i < v.count; ++i)
                if (v.bodies[i] == cube.index1 - 1) y += static_cast<double>(v.positions[4 * i + 1]), ++n;
            return y / n;
        };
        const int pieceRows = lab.counters().moving;
        double lowest = 1, most = 0;
        int woken = 0;
        lab.step(300, [&](int) {
            lowest = std::min(lowest, middleOf()), most = std::max(most, fastest(lab));
            woken = std::max(woken, lab.counters().moving - pieceRows);
        });
        const auto middle = pointsOf(lab);
        lab.step(300);
        const double inSpacings = static_cast<double>(spacing);
        if (asleep) found.atLeast("particles of the block that it wakes", 30, woken);
        found.atMost("fastest, of free fall", 1.2, most / std::sqrt(2 * 9.81 * 0.05));
        found.atLeast("deepest, spacings", -1, (lowest - 0.044) / inSpacings);
        found.within("centre of the cube at rest, m", 0.044, middleOf(), 0.02);
        found.atMost("goes from 5 to 10 s, spacings", 0.05, farthest(middle, pointsOf(lab)) / inSpacings);
        found.atMost("moving particles at the end", 0, lab.counters().moving);
    }
}

void underPiece(Findings& found) { landOnSoft(found, {{0.004f, false}, {0.004f, true}, {0.002f, true}}); }
void onAwake(Findings& found) { landOnSoft(found, {{0.002f, false}}); }

// A rigid cube flies at an elastic block, both free.
void hitByPiece(Findings& found) {
    for (const float spacing : {0.004f, 0.002f}) {
        Lab lab(spacing, 20000, {0, 0, 0});
        const thawBodyId block = lab.box(lab.material(soft(1e5f)), {-0.024f, 0, -0.024f}, {0.024f, 0.032f, 0.024f},
                                         Lab::kSolid, [](thawBodyDef& d) { d.anchored = false; });
        lab.box(lab.material(Lab::plain(900, 1)), {-0.012f, 0.042f, -0.012f}, {0.012f, 0.066f, 0.012f}, Lab::kSolid,
                [](thawBodyDef& d) {
                    d.anchored = false, d.velocity = {0, -0.5f, 0};
                });
        const double before = momentumOf(lab.particles()).p[1];
        double most = 0;
        lab.step(20, [&](int) { most = std::max(most, fastest(lab)); });
        found.within("momentum after, kg m/s", before, momentumOf(lab.particles()).p[1], 0.05);
        found.atMost("fastest, of before", 1.2, most / 0.5);
        const thawParticleView v = lab.particles();
        double taken = 0;
        for (int i = 0; i < v.count; ++i)
            if (v.bodies[i] == block.index1 - 1)
                taken += static_cast<double>(v.velocities[4 * i + 1]) * static_cast<double>(v.velocities[4 * i + 3]);
        // Stuck together both would go at m / (m + M): the block takes 0.86 of it then, more where it is thrown back.
        found.atLeast("share that the block takes", 0.5, taken / before);
    }
}

} // namespace

CaseList softCases() {
    return {{"soft-column-sag", "elastic column of 40 mm at 2 mm stands 20 s; sag rho g H^2 / (2 E)", columnSag},
            {"soft-cantilever", "elastic beam 80 x 24 x 24 mm held at a wall 60 s; Timoshenko's beam", cantilever},
            {"soft-rest", "elastic butter block 100 x 50 x 60 mm, unheated 60 s", softAtRest},
            {"soft-drop", "elastic cube of 32 mm dropped 0.1 m on a floor comes to rest", drop},
            {"soft-creep", "Maxwell column of 80 mm, relaxation time 5 s: creep under its weight", creep},
            {"soft-yield", "elastic cube of 32 mm: stands below its yield stress, flows above and rests", yields},
            {"soft-refreeze", "puddle of 34 ml sets, as a rigid and as an elastic solid", refreeze},
            {"soft-melting", "elastic block melts at one side for 20 s, 2 and 4 mm", melting},
            {"soft-under-piece", "rigid cube of 24 mm falls 50 mm on an elastic block, 4 and 2 mm", underPiece},
            {"soft-hit-by-piece", "rigid cube of 24 mm flies at an elastic block, both free: momentum", hitByPiece},
            {"piece-on-awake", "the same cube on a block of 2 mm that is awake", onAwake},
            {"soft-stack", "elastic block falls on another and rests", stack}};
}

} // namespace thaw::player
