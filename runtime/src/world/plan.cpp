// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world/plan.h"

#include <initializer_list>

namespace thaw {

thawPlan makePlan(const Needs& n, const thawWork& work) {
    thawPlan plan{};
    plan.work = work;
    auto set = [&](thawStage stage, bool on, thawReason why) {
        plan.enabled[stage] = on;
        plan.reason[stage] = on ? thawReason_needed : why;
    };
    const bool any = n.particles > 0;
    set(thawStage_inputs, true, thawReason_needed);
    set(thawStage_neighbors, any && n.listsStale, any ? thawReason_nothingChanged : thawReason_noParticles);
    set(thawStage_exposure, any && n.listsStale, any ? thawReason_nothingChanged : thawReason_noParticles);

    // Heat: the first reason that holds, in the order a person would ask.
    auto heat = [&](thawStage stage, bool wanted, thawReason why) {
        thawReason first = !any              ? thawReason_noParticles
                           : n.timeScaleZero ? thawReason_timeScaleZero
                           : !wanted         ? why
                                             : thawReason_interval;
        set(stage, any && !n.timeScaleZero && wanted && n.heatDue, first);
    };
    heat(thawStage_radiation, n.sourceOn && n.exposed > 0,
         n.sourceOn ? thawReason_nothingExposed : thawReason_noSource);
    heat(thawStage_conduction, n.unequal, thawReason_equilibrium);
    heat(thawStage_loss, n.awayFromAmbient && n.exposed > 0,
         n.awayFromAmbient ? thawReason_nothingExposed : thawReason_equilibrium);
    const bool heated =
        plan.enabled[thawStage_radiation] || plan.enabled[thawStage_conduction] || plan.enabled[thawStage_loss];
    const bool moved = n.listsStale || n.holdStale || n.collidersMove || n.movers + n.rigid > 0;
    set(thawStage_phase, any && (heated || moved), any ? thawReason_nothingChanged : thawReason_noParticles);

    set(thawStage_control, n.control && (n.ledBefore || (any && (n.movers > 0 || (n.cools && heated)))),
        !any         ? thawReason_noParticles
        : !n.control ? thawReason_noControl
                     : thawReason_nothingMoves);
    for (thawStage s : {thawStage_forces, thawStage_viscosity, thawStage_pressure})
        set(s, n.movers > 0, any ? thawReason_nothingMoves : thawReason_noParticles);
    set(thawStage_collision, n.movers + n.rigid > 0, any ? thawReason_nothingMoves : thawReason_noParticles);
    const bool otherLevels = n.finestLevel != work.finestLevel || n.coarsestLevel != work.coarsestLevel;
    const bool mayChange = n.levels || work.finestLevel > 0;
    const bool levels = mayChange && (heated || moved || n.levelsChanged || otherLevels);
    set(thawStage_levels, any && levels,
        !any        ? thawReason_noParticles
        : mayChange ? thawReason_nothingChanged
                    : thawReason_oneLevel);
    set(thawStage_stats, any && (heated || moved || levels || (n.burns && n.heatDue)),
        any ? thawReason_nothingChanged : thawReason_noParticles);
    return plan;
}

int mostRays(const Needs& n, const thawWork& work) {
    const float each = static_cast<float>(n.sources + n.areaSources * work.raysPerSource);
    return static_cast<int>(static_cast<float>(n.exposed) * work.rayRefresh * each);
}

} // namespace thaw
