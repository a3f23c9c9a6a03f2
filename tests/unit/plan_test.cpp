// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world/plan.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace thaw;

namespace {

constexpr thawWork kFull{4, 4, 12, 1, 1.0f, 1, 80, 16, 0, 3, 2048};

Needs busy() {
    Needs n;
    n.particles = 10000, n.movers = 3000, n.exposed = 2000;
    n.sourceOn = true, n.sources = 1;
    return n;
}

// A machine with fixed prices per unit; what the governor should find out.
struct Machine {
    double slow = 1;
    int heatCycles = 1; // that heat needs
    float cost(const Needs& n, const thawWork& w, Governor::Cost& c) const {
        c = {};
        c.particles = n.particles, c.movers = n.movers, c.exposed = n.exposed;
        c.subSteps = 1, c.pressureIterations = w.pressureIterations, c.viscosityIterations = w.viscosityIterations;
        c.rays = static_cast<int>(w.rayRefresh * static_cast<float>(n.exposed));
        c.mostRays = c.rays;
        c.heatRan = true, c.heatWanted = heatCycles;
        c.heatPasses = heatCycles <= w.heatCycles ? heatCycles : std::min(30, w.heatCycles);
        auto ms = [&](double ns, double units) { return static_cast<float>(slow * ns * units * 1e-6); };
        c.stageMs[thawStage_neighbors] = ms(60, n.particles);
        c.stageMs[thawStage_exposure] = ms(15, n.particles);
        c.stageMs[thawStage_radiation] = ms(300, c.rays);
        c.stageMs[thawStage_conduction] = ms(30, static_cast<double>(n.particles) * c.heatPasses);
        c.stageMs[thawStage_forces] = ms(60, n.movers);
        c.stageMs[thawStage_viscosity] = ms(20, static_cast<double>(n.movers) * (w.viscosityIterations + 1));
        c.stageMs[thawStage_pressure] = ms(25, static_cast<double>(n.movers) * w.pressureIterations);
        float sum = 0;
        for (float s : c.stageMs) sum += s;
        return sum;
    }
};

float frame(Governor& g, const Machine& m, const Needs& n, float budget, thawWork* chosen = nullptr) {
    float predicted = 0;
    const thawWork w = g.choose(n, budget, kFull, 1, predicted);
    Governor::Cost c;
    const float ms = m.cost(n, w, c);
    g.learn(c);
    if (chosen) *chosen = w;
    return ms;
}

} // namespace

TEST_CASE("plan: stages run only where the scene asks, and say why not") {
    Needs n = busy();
    thawPlan p = makePlan(n, kFull);
    for (int s = 0; s < thawStage_count; ++s) CHECK(p.enabled[s] == (s != thawStage_levels));
    CHECK(p.reason[thawStage_levels] == thawReason_oneLevel);
    n.levels = true;
    CHECK(makePlan(n, kFull).enabled[thawStage_levels]);

    n.movers = 0;
    p = makePlan(n, kFull);
    CHECK_FALSE(p.enabled[thawStage_viscosity]);
    CHECK(p.reason[thawStage_viscosity] == thawReason_nothingMoves);
    CHECK(p.enabled[thawStage_conduction]);

    n.listsStale = false;
    p = makePlan(n, kFull);
    CHECK_FALSE(p.enabled[thawStage_neighbors]);
    CHECK(p.reason[thawStage_neighbors] == thawReason_nothingChanged);

    n.sourceOn = false;
    p = makePlan(n, kFull);
    CHECK(p.reason[thawStage_radiation] == thawReason_noSource);
    CHECK(p.enabled[thawStage_loss]);

    n.unequal = n.awayFromAmbient = false;
    p = makePlan(n, kFull);
    CHECK(p.reason[thawStage_conduction] == thawReason_equilibrium);
    CHECK(p.reason[thawStage_loss] == thawReason_equilibrium);
    CHECK_FALSE(p.enabled[thawStage_phase]);
    CHECK_FALSE(p.enabled[thawStage_stats]);
    CHECK(p.reason[thawStage_levels] == thawReason_nothingChanged);
    thawWork coarser = kFull;
    coarser.finestLevel = 1, n.levels = true;
    CHECK(makePlan(n, coarser).enabled[thawStage_levels]);
    n.holdStale = true;
    p = makePlan(n, kFull);
    CHECK(p.enabled[thawStage_phase]);
    CHECK_FALSE(p.enabled[thawStage_neighbors]);

    n = busy();
    n.heatDue = false;
    p = makePlan(n, kFull);
    CHECK_FALSE(p.enabled[thawStage_radiation]);
    CHECK(p.reason[thawStage_radiation] == thawReason_interval);
    CHECK(p.enabled[thawStage_pressure]);

    n.timeScaleZero = true;
    CHECK(makePlan(n, kFull).reason[thawStage_conduction] == thawReason_timeScaleZero);

    p = makePlan(Needs{}, kFull);
    CHECK(p.reason[thawStage_pressure] == thawReason_noParticles);
    CHECK(p.reason[thawStage_loss] == thawReason_noParticles);
}

TEST_CASE("governor: full quality when there is room") {
    Governor g;
    thawWork w{};
    for (int i = 0; i < 60; ++i) frame(g, Machine{}, busy(), 20, &w);
    CHECK(w.pressureIterations == kFull.pressureIterations);
    CHECK(w.viscosityIterations == kFull.viscosityIterations);
    CHECK(w.rayRefresh == doctest::Approx(1.0f));
    CHECK(w.heatInterval == 1);
}

TEST_CASE("governor: keeps the budget after it has learnt, and uses it") {
    Governor g;
    Machine m;
    for (int i = 0; i < 120; ++i) frame(g, m, busy(), 2.2f);
    int over = 0;
    float sum = 0;
    for (int i = 0; i < 300; ++i) {
        float ms = frame(g, m, busy(), 2.2f);
        over += ms > 2.2f;
        sum += ms;
    }
    CHECK(over == 0);
    CHECK(sum / 300 > 0.5f * 2.2f);
}

TEST_CASE("governor: a machine that becomes twice as slow is met within five frames") {
    Governor g;
    Machine m;
    for (int i = 0; i < 120; ++i) frame(g, m, busy(), 4);
    m.slow = 2;
    for (int i = 0; i < 5; ++i) frame(g, m, busy(), 4);
    for (int i = 0; i < 100; ++i) CHECK(frame(g, m, busy(), 4) <= 4);
}

TEST_CASE("governor: climbs back one level at a time and only after many good frames") {
    Governor g;
    Machine slow{4}, quick{1};
    thawWork low{}, now{}, last{};
    for (int i = 0; i < 60; ++i) frame(g, slow, busy(), 4, &low);
    CHECK(low.viscosityIterations < kFull.viscosityIterations);
    last = low;
    int changes = 0, lastChange = -100;
    for (int i = 0; i < 1500; ++i) {
        frame(g, quick, busy(), 4, &now);
        bool same = now.viscosityIterations == last.viscosityIterations && now.rayRefresh == last.rayRefresh &&
                    now.heatInterval == last.heatInterval && now.pressureIterations == last.pressureIterations;
        if (!same) {
            CHECK(i - lastChange >= 30);
            lastChange = i, ++changes;
        }
        last = now;
    }
    CHECK(changes >= 2);
    CHECK(now.viscosityIterations > low.viscosityIterations);
}

TEST_CASE("governor: many sub-cycles of heat are cut to what fits") {
    Governor g;
    Machine m;
    m.heatCycles = 60; // 18 ms of them
    thawWork w{};
    for (int i = 0; i < 120; ++i) frame(g, m, busy(), 30, &w);
    CHECK(w.heatCycles >= 60);
    for (int i = 0; i < 10; ++i) frame(g, m, busy(), 5, &w);
    for (int i = 0; i < 100; ++i) CHECK(frame(g, m, busy(), 5, &w) <= 5);
    CHECK(w.heatCycles < 30);
}

TEST_CASE("governor: coarser particles when nothing else is left, finer ones when there is room for long") {
    Governor g;
    Machine m;
    thawWork w{};
    // Movers that follow the level that is asked for, a few in each frame.
    double movers = 30000;
    const auto run = [&](int frames, float budget, int& changes, int& over) {
        int last = w.finestLevel;
        for (int i = 0; i < frames; ++i) {
            Needs n = busy();
            n.movers = static_cast<int>(movers), n.particles = n.movers + 4000, n.exposed = n.movers / 2;
            over += frame(g, m, n, budget, &w) > budget;
            const double wanted = 30000.0 / (1 << w.finestLevel);
            movers += (wanted > movers ? 0.01 : 0.06) * (wanted - movers);
            changes += w.finestLevel != last, last = w.finestLevel;
        }
    };
    int changes = 0, over = 0;
    run(300, 200, changes, over);
    CHECK(w.finestLevel == 0);
    run(200, 8, changes, over); // at level 0 the least of all takes 16 ms
    CHECK(w.finestLevel >= 1);
    changes = over = 0;
    run(1800, 8, changes, over);
    CHECK(over == 0);
    CHECK(changes <= 1); // it stays where it is
    run(3000, 200, changes, over);
    CHECK(w.finestLevel == 0);
    // A world without room for more rows.
    Governor full;
    Needs n = busy();
    n.full = true;
    float predicted;
    for (int i = 0; i < 15; ++i) w = full.choose(n, 100, kFull, 1, predicted);
    CHECK(w.finestLevel == 1);
    thawWork fine = kFull;
    fine.coarsestLevel = 0;
    for (int i = 0; i < 200; ++i) w = full.choose(n, 100, fine, 1, predicted);
    CHECK(w.finestLevel == 0);
}

TEST_CASE("governor: never more than the host's limit") {
    Governor g;
    float predicted;
    thawWork limit{2, 3, 5, 2, 0.5f, 1, 10, 16, 0, 3, 2048};
    thawWork w = g.choose(busy(), 1e4f, limit, 8, predicted);
    CHECK(w.subSteps <= 2);
    CHECK(w.pressureIterations == 3);
    CHECK(w.viscosityIterations == 5);
    CHECK(w.heatInterval == 2);
    CHECK(w.rayRefresh == doctest::Approx(0.5f));
}
