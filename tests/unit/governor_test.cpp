// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world/governor.h"

#include "base/safe_points.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace thaw;

namespace {

const thawBudget kBudget = [] {
    thawBudget b;
    thawInitBudget(&b);
    return b;
}();

Needs busy() {
    Needs n;
    n.particles = 10000, n.movers = 3000, n.exposed = 2000;
    n.sourceOn = true, n.sources = 1;
    return n;
}

// A machine with fixed prices per unit; what the governor should find out. noise: of every stage, up to that share.
struct Machine {
    double slow = 1, noise = 0;
    int heatCycles = 1; // that heat needs
    int wanted = 1;     // sub-steps
    uint32_t seed = 1;
    double random() { // 0..1
        seed = seed * 1664525u + 1013904223u;
        return (seed >> 8) * (1.0 / 16777216);
    }
    float cost(const Needs& n, const thawWork& w, Governor::Cost& c) {
        c = {};
        c.particles = n.particles, c.movers = n.movers, c.exposed = n.exposed;
        c.subSteps = std::clamp(std::max(wanted, w.leastSubSteps), 1, w.subSteps);
        c.pressureIterations = c.subSteps * w.pressureIterations;
        c.viscosityIterations = c.subSteps * std::min(30, w.viscosityIterations);
        c.rays = static_cast<int>(w.rayRefresh * static_cast<float>(n.exposed));
        c.mostRays = c.rays;
        c.heatRan = true, c.heatInterval = w.heatInterval, c.heatWanted = heatCycles * w.heatInterval;
        c.heatPasses = heatCycles <= w.heatCycles ? heatCycles : std::min(30, w.heatCycles);
        const double all = slow * (1 + noise * (2 * random() - 1));
        auto ms = [&](double ns, double units) { return static_cast<float>(all * ns * units * 1e-6); };
        c.stageMs[thawStage_neighbors] = ms(60, static_cast<double>(n.particles) * c.subSteps);
        c.stageMs[thawStage_exposure] = ms(15, n.particles);
        c.stageMs[thawStage_radiation] = ms(300, c.rays);
        c.stageMs[thawStage_conduction] = ms(30, static_cast<double>(n.particles) * c.heatPasses);
        c.stageMs[thawStage_forces] = ms(60, static_cast<double>(n.movers) * c.subSteps);
        c.stageMs[thawStage_viscosity] = ms(20, static_cast<double>(n.movers) * (c.viscosityIterations + c.subSteps));
        c.stageMs[thawStage_pressure] = ms(25, static_cast<double>(n.movers) * c.pressureIterations);
        for (float s : c.stageMs) c.stepMs += s;
        return c.stepMs;
    }
};

float frame(Governor& g, Machine& m, const Needs& n, float budget, thawWork* chosen = nullptr) {
    const Governor::Choice choice = g.choose(n, budget, kBudget.least, kBudget.most, m.wanted, 2);
    Governor::Cost c;
    const float ms = m.cost(n, choice.work, c);
    c.predictedMs = choice.predictedMs, c.budgetMs = budget;
    g.learn(c);
    if (chosen) *chosen = choice.work;
    return ms;
}

Governor learning() { return Governor(Governor::Prices::learnt); }

uint64_t hashOf(Governor& g) {
    StateIo io(1);
    g.state(io);
    return io.hash();
}

} // namespace

TEST_CASE("governor: the best quality when there is room") {
    Governor g = learning();
    Machine m;
    thawWork w{};
    for (int i = 0; i < 60; ++i) frame(g, m, busy(), 500, &w);
    CHECK(w.leastSubSteps == kBudget.most.leastSubSteps);
    CHECK(w.raysPerSource == kBudget.most.raysPerSource);
    CHECK(w.rayRefresh == doctest::Approx(1.0f));
    CHECK(w.heatInterval == 1);
    CHECK(w.finestLevel == 0);
}

TEST_CASE("governor: keeps the budget and spends it, also on a noisy machine") {
    for (const double noise : {0.0, 0.05, 0.12})
        for (const float budget : {2.4f, 4.0f, 8.0f, 16.0f}) {
            Governor g = learning();
            Machine m;
            m.noise = noise;
            for (int i = 0; i < 300; ++i) frame(g, m, busy(), budget);
            std::vector<float> ms;
            for (int i = 0; i < 3000; ++i) ms.push_back(frame(g, m, busy(), budget));
            std::sort(ms.begin(), ms.end());
            CAPTURE(noise);
            CAPTURE(budget);
            CHECK(ms[2970] <= budget);
            CHECK(ms[1500] >= 0.7f * budget);
        }
}

TEST_CASE("governor: a machine that becomes twice as slow is met within five frames") {
    Governor g = learning();
    Machine m;
    for (int i = 0; i < 120; ++i) frame(g, m, busy(), 6);
    m.slow = 2;
    for (int i = 0; i < 5; ++i) frame(g, m, busy(), 6);
    for (int i = 0; i < 100; ++i) CHECK(frame(g, m, busy(), 6) <= 6);
}

TEST_CASE("governor: climbs back bit by bit and only after many good frames, and then stays") {
    Governor g = learning();
    Machine m;
    m.slow = 4;
    thawWork low{}, now{}, last{};
    for (int i = 0; i < 60; ++i) frame(g, m, busy(), 5, &low);
    last = low;
    m.slow = 1;
    const auto same = [](const thawWork& a, const thawWork& b) {
        return a.viscosityIterations == b.viscosityIterations && a.rayRefresh == b.rayRefresh &&
               a.heatInterval == b.heatInterval && a.pressureIterations == b.pressureIterations &&
               a.leastSubSteps == b.leastSubSteps && a.heatCycles == b.heatCycles;
    };
    int lastChange = -100, changes = 0, late = 0;
    for (int i = 0; i < 3000; ++i) {
        frame(g, m, busy(), 5, &now);
        if (!same(now, last)) {
            if (now.viscosityIterations > last.viscosityIterations) CHECK(i - lastChange >= 15);
            lastChange = i, ++changes, late += i >= 1500;
        }
        last = now;
    }
    CHECK(changes >= 4);
    CHECK(late <= 12); // of 1500 frames
    CHECK(now.viscosityIterations > low.viscosityIterations);
}

TEST_CASE("governor: many sub-cycles of heat are cut to what fits") {
    Governor g = learning();
    Machine m;
    m.heatCycles = 60; // 18 ms of them
    thawWork w{};
    for (int i = 0; i < 120; ++i) frame(g, m, busy(), 30, &w);
    CHECK(w.heatCycles >= 60);
    for (int i = 0; i < 10; ++i) frame(g, m, busy(), 6, &w);
    for (int i = 0; i < 100; ++i) CHECK(frame(g, m, busy(), 6, &w) <= 6);
    CHECK(w.heatCycles < 30);
}

TEST_CASE("governor: coarser particles when nothing else is left, finer ones when there is room for long") {
    Governor g = learning();
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
    CHECK(over <= 9);    // of 1800
    CHECK(changes <= 1); // it stays where it is
    run(3000, 200, changes, over);
    CHECK(w.finestLevel == 0);
    // A world without room for more rows.
    Governor full = learning();
    Needs n = busy();
    n.full = true;
    for (int i = 0; i < 15; ++i) w = full.choose(n, 100, kBudget.least, kBudget.most, 1, 2).work;
    CHECK(w.finestLevel == 1);
    thawWork fine = kBudget.most;
    fine.coarsestLevel = 0;
    for (int i = 0; i < 200; ++i) w = full.choose(n, 100, kBudget.least, fine, 1, 2).work;
    CHECK(w.finestLevel == 0);
    thawWork pinned = kBudget.least;
    pinned.finestLevel = 0;
    CHECK(full.choose(n, 100, pinned, kBudget.most, 1, 2).work.finestLevel == 0);
}

TEST_CASE("governor: stays between the least and the most of the host, which goes before it") {
    Governor g = learning();
    const thawWork most{2, 5, 7, 2, 0.5f, 1, 10, 16, 0, 3, 2048, 0, 0},
        least{2, 4, 6, 3, 0.3f, 1, 9, 8, 3, 3, 2048, 0, 0};
    thawWork w = g.choose(busy(), 1e9f, least, most, 8, 2).work;
    CHECK(w.subSteps == 2);
    CHECK(w.pressureIterations == 5);
    CHECK(w.viscosityIterations == 7);
    CHECK(w.heatInterval == 2);
    CHECK(w.rayRefresh == doctest::Approx(0.5f));
    w = g.choose(busy(), 0, least, most, 8, 2).work;
    CHECK(w.subSteps == 2);
    CHECK(w.pressureIterations == 4);
    CHECK(w.viscosityIterations == 6);
    CHECK(w.heatInterval == 2); // never spread
    CHECK(w.rayRefresh == doctest::Approx(0.3f));
    CHECK(w.raysPerSource == 8);
    CHECK(g.choose(busy(), 0, most, least, 8, 2).work.pressureIterations == 4);
}

TEST_CASE("governor: with fixed prices it depends on what was stepped and not on the machine") {
    Governor quick(Governor::Prices::fixed), slow(Governor::Prices::fixed);
    Machine a, b;
    b.slow = 7, b.noise = 0.2;
    thawWork w[2], crowded{};
    bool varied = false;
    for (int i = 0; i < 400; ++i) {
        Needs n = busy();
        n.movers = i < 200 ? 3000 : 800;
        frame(quick, a, n, 3, &w[0]), frame(slow, b, n, 3, &w[1]);
        REQUIRE(w[0].pressureIterations == w[1].pressureIterations);
        REQUIRE(w[0].viscosityIterations == w[1].viscosityIterations);
        REQUIRE(w[0].rayRefresh == w[1].rayRefresh);
        REQUIRE(hashOf(quick) == hashOf(slow));
        if (i == 199) crowded = w[0];
        varied |= i == 399 && w[0].pressureIterations > crowded.pressureIterations;
    }
    CHECK(varied);
    const uint64_t before = hashOf(quick);
    frame(quick, a, busy(), 0.1f);
    CHECK(hashOf(quick) != before);
}

TEST_CASE("governor: leaves a worker out for a while when the system keeps taking one away") {
    Governor g = learning();
    const auto workers = [&](float stalled) {
        const Governor::Choice choice = g.choose(busy(), 8, kBudget.least, kBudget.most, 1, 2);
        Governor::Cost c;
        Machine().cost(busy(), choice.work, c);
        c.stalledMs = stalled;
        g.learn(c);
        return choice.workers;
    };
    for (int i = 0; i < 400; ++i) CHECK(workers(i % 20 == 0 ? 2.0f : 0.0f) == 2); // now and then proves nothing
    int without = 0;
    for (int i = 0; i < 200; ++i) without += workers(i % 3 == 0 ? 2.0f : 0.0f) == 1;
    CHECK(without > 90);
    int waited = 0;
    while (waited < 2000 && workers(0) == 1) ++waited;
    CHECK(waited < 700);
    for (int i = 0; i < 60; ++i) workers(i % 2 == 0 ? 2.0f : 0.0f);
    waited = 0;
    while (waited < 2000 && workers(0) == 1) ++waited;
    CHECK(waited > 1000); // longer the second time
    CHECK(waited < 1300);
}

TEST_CASE("safe points: late at the one that is given, and from then on") {
    SafePoints p;
    p.count(3);
    for (int i = 1; i <= 6; ++i) CHECK(p.late() == (i >= 3));
    CHECK(p.lateAt() == 3);
    p.count(0);
    for (int i = 0; i < 100; ++i) CHECK_FALSE(p.late());
    CHECK(p.lateAt() == 0);
    p.watch(SafePoints::Clock::now(), 1e6f);
    CHECK_FALSE(p.late());
    p.expect(2e6f); // what is still to come does not fit
    CHECK(p.late());
    CHECK(p.lateAt() == 2);
    p.expect(0);
    CHECK(p.late());
    CHECK(p.lateAt() == 2);
}
