// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world/plan.h"

#include <doctest/doctest.h>

using namespace thaw;

namespace {

constexpr thawWork kFull{4, 4, 12, 1, 1.0f, 1, 80, 16, 0, 3, 2048, 0, 0};

Needs busy() {
    Needs n;
    n.particles = 10000, n.movers = 3000, n.exposed = 2000;
    n.sourceOn = true, n.sources = 1;
    return n;
}

} // namespace

TEST_CASE("plan: stages run only where the scene asks, and say why not") {
    Needs n = busy();
    thawPlan p = makePlan(n, kFull);
    for (int s = 0; s < thawStage_count; ++s) CHECK(p.enabled[s] == (s != thawStage_levels && s != thawStage_control));
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
