// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world/plan.h"

#include <algorithm>
#include <cmath>

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

namespace {

// Least visible first: rays, heat interval, sub-steps, iterations.
struct Quality {
    float rays;
    int heatInterval, subSteps, pressure, viscosity, heatCycles, raysPerSource;
};
constexpr Quality kQualities[] = {
    {1.0f, 1, 16, 64, 200, 1000, 64}, {0.5f, 1, 16, 64, 200, 1000, 16}, {0.25f, 1, 16, 64, 200, 80, 9},
    {0.25f, 2, 4, 8, 40, 40, 9},      {0.25f, 2, 2, 4, 20, 20, 4},      {0.125f, 2, 2, 4, 12, 20, 4},
    {0.125f, 4, 1, 4, 12, 10, 4},     {0.1f, 4, 1, 4, 8, 10, 4},        {0.05f, 8, 1, 3, 6, 8, 4},
};
// Not below: at 2 pressure and 4 viscosity iterations the candle throws drops (19 in 20 s faster than 0.4 m/s
// sideways), at 3 and 6 none. A budget that asks for less is exceeded, and the step says so.
constexpr int kQualityCount = static_cast<int>(sizeof(kQualities) / sizeof(kQualities[0]));
constexpr float kFill = 0.80f;      // of the budget, predicted: leaves room for what no prediction sees
constexpr float kClimbFill = 0.70f; // dead band against going up and down
constexpr int kClimbAfter = 30;     // good frames
// What an exposed particle costs radiation without a ray of its own (it shades others), in rays.
constexpr float kRayShare = 0.25f;

// Levels come after all that: what they save takes half a second to merge, and the beads get coarser. They do when the
// quality of kLeastSeen has not fitted for so many frames on end, and a finer one comes back when twice the particles
// would fit for much longer.
constexpr int kLeastSeen = 6, kCoarserAfter = 10, kFinerAfter = 180, kMergeFrames = 40;

thawWork clip(const Quality& q, const thawWork& limit) {
    return {std::min(q.subSteps, limit.subSteps),
            std::min(q.pressure, limit.pressureIterations),
            std::min(q.viscosity, limit.viscosityIterations),
            std::max(q.heatInterval, limit.heatInterval),
            std::min(q.rays, limit.rayRefresh),
            limit.leastSubSteps,
            std::min(q.heatCycles, limit.heatCycles),
            std::min(q.raysPerSource, limit.raysPerSource),
            limit.finestLevel,
            limit.coarsestLevel,
            limit.splits};
}

} // namespace

float Governor::predict(const Needs& n, const thawWork& w, int subStepsWanted) const {
    const float particles = static_cast<float>(n.particles), movers = static_cast<float>(n.movers);
    const float steps = static_cast<float>(std::clamp(subStepsWanted, 1, w.subSteps));
    float ms = fixed_;
    if (n.listsStale) ms += particles * (perParticle_ * steps + perExposure_);
    if (!n.timeScaleZero && (n.sourceOn || n.unequal || n.awayFromAmbient)) {
        // The peak frame counts, not the mean over the interval: a budget is kept in every frame.
        // Implicitly, it takes no more iterations than that.
        const int passes = heatWanted_ <= w.heatCycles ? heatWanted_ : std::min(30, w.heatCycles);
        ms += particles * perHeat_ * static_cast<float>(passes);
        if (n.sourceOn)
            ms += (static_cast<float>(n.exposed) * kRayShare + rayUse_ * static_cast<float>(mostRays(n, w))) * perRay_;
    }
    if (n.movers > 0) {
        const float its = std::min(static_cast<float>(w.viscosityIterations), viscosityPerSubStep_ * 1.25f + 1);
        ms += movers * steps *
              (perMover_ + perViscosity_ * its + perPressure_ * static_cast<float>(w.pressureIterations));
    }
    return ms;
}

void Governor::chooseLevel(const Needs& n, float milliseconds, const thawWork& limit, int subStepsWanted) {
    const thawWork seen = clip(kQualities[kLeastSeen], limit);
    const bool tight = n.full || (n.movers > 0 && predict(n, seen, subStepsWanted) > kFill * milliseconds);
    Needs finer = n;
    finer.particles += n.movers, finer.movers *= 2, finer.exposed += n.exposed / 2;
    const bool roomy = !tight && predict(finer, seen, subStepsWanted) <= kClimbFill * milliseconds;
    // Below 0: what was merged just now has not shown yet.
    tight_ = tight ? tight_ + 1 : std::min(tight_, 0);
    roomy_ = roomy ? roomy_ + 1 : 0;
    if (tight_ >= kCoarserAfter && finest_ < 3) ++finest_, tight_ = -kMergeFrames, roomy_ = 0;
    if (roomy_ >= kFinerAfter && finest_ > 0) --finest_, roomy_ = 0;
    finest_ = std::max(finest_, 0);
}

thawWork Governor::choose(const Needs& needs, float milliseconds, const thawWork& limit, int subStepsWanted,
                          float& predictedMs) {
    chooseLevel(needs, milliseconds, limit, subStepsWanted);
    int best = kQualityCount - 1;
    for (int q = 0; q < kQualityCount; ++q)
        if (predict(needs, clip(kQualities[q], limit), subStepsWanted) <= kFill * milliseconds) {
            best = q;
            break;
        }
    if (best > quality_) {
        quality_ = best, goodFrames_ = 0;
    } else if (best < quality_) {
        const bool roomy =
            predict(needs, clip(kQualities[quality_ - 1], limit), subStepsWanted) <= kClimbFill * milliseconds;
        goodFrames_ = roomy ? goodFrames_ + 1 : 0;
        if (goodFrames_ >= kClimbAfter) --quality_, goodFrames_ = 0;
    } else {
        goodFrames_ = 0;
    }
    thawWork work = clip(kQualities[quality_], limit);
    work.finestLevel = std::max(limit.finestLevel, std::min(finest_, limit.coarsestLevel));
    predictedMs = predict(needs, work, subStepsWanted);
    return work;
}

void Governor::learn(const Cost& c) {
    // Fast up, slow down: a machine that became slow is noticed in two frames, one quick frame proves little. One frame
    // that was interrupted proves as little, so no frame more than doubles what is expected.
    auto blend = [](float& estimate, float ms, double units) {
        if (units < 1 || !std::isfinite(ms)) return;
        const float now = std::min(ms / static_cast<float>(units), 2 * estimate);
        estimate += (now > estimate ? 0.5f : 0.08f) * (now - estimate);
    };
    const double n = c.particles, m = static_cast<double>(c.movers) * c.subSteps;
    const float* s = c.stageMs;
    if (s[thawStage_neighbors] > 0) {
        blend(perParticle_, s[thawStage_neighbors], n * c.subSteps);
        blend(perExposure_, s[thawStage_exposure] + s[thawStage_phase] + s[thawStage_stats], n);
    }
    if (c.rays > 0) blend(perRay_, s[thawStage_radiation], c.rays + kRayShare * static_cast<double>(c.exposed));
    if (c.mostRays > 0) {
        const float use = std::min(1.0f, static_cast<float>(c.rays) / static_cast<float>(c.mostRays));
        rayUse_ += (use > rayUse_ ? 0.5f : 0.05f) * (use - rayUse_);
    }
    if (c.heatRan) {
        blend(perHeat_, s[thawStage_conduction] + s[thawStage_loss], n * std::max(1, c.heatPasses));
        heatWanted_ = std::max(1, c.heatWanted);
    }
    if (m > 0) {
        blend(perMover_, s[thawStage_forces] + s[thawStage_collision], m);
        if (c.viscosityIterations > 0)
            blend(perViscosity_, s[thawStage_viscosity],
                  static_cast<double>(c.movers) * (c.viscosityIterations + c.subSteps));
        if (c.pressureIterations > 0)
            blend(perPressure_, s[thawStage_pressure], static_cast<double>(c.movers) * c.pressureIterations);
        const float its = static_cast<float>(c.viscosityIterations) / static_cast<float>(c.subSteps);
        viscosityPerSubStep_ += (its > viscosityPerSubStep_ ? 0.5f : 0.05f) * (its - viscosityPerSubStep_);
    }
}

} // namespace thaw
