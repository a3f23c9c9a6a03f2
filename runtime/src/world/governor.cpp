// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world/governor.h"

#include "base/math.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace thaw {
namespace {

// Work by quality, the best first: ranges of equal sub-steps and steps within them. What shows least is given up first:
// sub-steps beyond those that depth and walls ask for, iterations beyond convergence, rays, sub-steps that were asked
// for, iterations. Heat comes in every step: one that comes every eighth has eight times the sub-cycles, and it is the
// dearest frame that counts (candle at 2 ms: 1.9 ms of conduction in one frame of eight for 0.2 in each).
struct Knobs {
    float rays, leastSubSteps, subSteps, pressure, viscosity, heatCycles, raysPerSource;
};
struct Range {
    Knobs best, least;
};
constexpr Range kRanges[] = {
    {{1.0f, 8, 16, 12, 40, 1000, 64}, {1.0f, 8, 16, 7, 16, 1000, 64}},
    {{1.0f, 4, 16, 16, 50, 1000, 32}, {1.0f, 4, 16, 7, 16, 1000, 32}},
    {{1.0f, 2, 16, 18, 50, 1000, 16}, {1.0f, 2, 16, 8, 18, 1000, 16}},
    {{1.0f, 1, 16, 20, 40, 1000, 16}, {1.0f, 1, 16, 10, 24, 400, 16}},
    {{0.8f, 1, 12, 9, 20, 300, 14}, {0.25f, 1, 4, 8, 12, 80, 9}},
    {{0.25f, 1, 3, 8, 12, 40, 6}, {0.125f, 1, 2, 4, 12, 20, 4}},
    {{0.125f, 1, 1, 4, 10, 10, 4}, {0.05f, 1, 1, 3, 6, 8, 4}},
};
// Not below: at 2 pressure and 4 viscosity iterations the candle throws drops (19 in 20 s faster than 0.4 m/s
// sideways), at 3 and 6 none. A budget that asks for less is exceeded, and the step says so.
constexpr int kParts = 5, kLowest = kParts * static_cast<int>(sizeof(kRanges) / sizeof(kRanges[0])) - 1;
constexpr float kClimbFill = 0.93f; // of what may be predicted: dead band against going up and down
constexpr int kClimbAfter = 15;     // good frames
// What an exposed particle costs radiation without a ray of its own (it shades others), in rays.
constexpr float kRayShare = 0.25f;

// Of the steps, one in 250 may be late: each that is widens the margin by kWiden, the others narrow it.
constexpr float kWiden = 0.05f, kLateShare = 0.004f, kRelax = 0.0008f, kLeastMargin = 0.85f, kMostMargin = 1.5f;
constexpr float kLateFrom = 0.95f;   // of the budget
constexpr float kInterrupted = 1.7f; // times the prediction

// Levels come after all that: what they save takes half a second to merge, and the beads get coarser. They do when the
// quality of kLeastSeen has not fitted for so many frames on end, and a finer one comes back when twice the particles
// would fit for much longer.
constexpr int kLeastSeen = kLowest - kParts, kCoarserAfter = 10, kFinerAfter = 90, kMergeFrames = 40;

// A frame that waited so long for a worker, or took so many times what it should, may have shared a core with another
// program: when that is more than about one in twelve, for a while. A virtual machine does so now and then by itself.
constexpr float kStall = 0.25f, kSurprise = 1.4f; // ms, 1
constexpr int kStallWeight = 12, kStallsMost = 140, kLeaveOutLeast = 600, kLeaveOutMost = 7200, kCalmFrames = 1200;

thawWork workOf(int quality, const thawWork& least, const thawWork& most) {
    const auto& [a, b] = kRanges[quality / kParts];
    const float t = static_cast<float>(quality % kParts) / (kParts - 1);
    const auto real = [&, &from = a, &to = b](float Knobs::*knob) { return from.*knob + t * (to.*knob - from.*knob); };
    const auto whole = [&](float Knobs::*knob) { return static_cast<int32_t>(std::lround(real(knob))); };
    const auto within = [](auto v, auto low, auto high) { return std::min(std::max(v, low), high); };
    thawWork w{};
    w.subSteps = within(whole(&Knobs::subSteps), least.subSteps, most.subSteps);
    w.pressureIterations = within(whole(&Knobs::pressure), least.pressureIterations, most.pressureIterations);
    w.viscosityIterations = within(whole(&Knobs::viscosity), least.viscosityIterations, most.viscosityIterations);
    w.heatInterval = most.heatInterval;
    w.rayRefresh = within(real(&Knobs::rays), least.rayRefresh, most.rayRefresh);
    w.leastSubSteps = within(whole(&Knobs::leastSubSteps), least.leastSubSteps, most.leastSubSteps);
    w.heatCycles = within(whole(&Knobs::heatCycles), least.heatCycles, most.heatCycles);
    w.raysPerSource = within(whole(&Knobs::raysPerSource), least.raysPerSource, most.raysPerSource);
    w.finestLevel = most.finestLevel, w.coarsestLevel = most.coarsestLevel;
    w.splits = most.splits;
    return w;
}

} // namespace

float Governor::predict(const Needs& n, const thawWork& w, int subStepsWanted) const {
    const float particles = static_cast<float>(n.particles), movers = static_cast<float>(n.movers);
    const float steps = static_cast<float>(std::clamp(std::max(subStepsWanted, w.leastSubSteps), 1, w.subSteps));
    float ms = fixed_;
    if (n.listsStale) ms += particles * (perParticle_ * (n.movers > 0 ? steps : 1) + perExposure_);
    if (n.holdStale) ms += particles * perRelabel_; // in every eighth step
    if (!n.timeScaleZero && (n.sourceOn || n.unequal || n.awayFromAmbient)) {
        // The peak frame counts, not the mean over the interval: a budget is kept in every frame.
        // Implicitly, it takes no more iterations than that.
        const int wanted = static_cast<int>(std::lround(heatWanted_ * static_cast<float>(w.heatInterval)));
        const int passes = std::max(1, wanted <= w.heatCycles ? wanted : std::min(30, w.heatCycles));
        ms += particles * perHeat_ * static_cast<float>(passes);
        if (n.sourceOn)
            ms += (static_cast<float>(n.exposed) * kRayShare + rayUse_ * static_cast<float>(mostRays(n, w))) * perRay_;
    }
    if (n.movers > 0) {
        const float its = std::min(static_cast<float>(w.viscosityIterations), viscosityPerSubStep_ * 1.25f + 1);
        ms += movers * steps *
              (perMover_ + static_cast<float>(n.control) * perControl_ + perViscosity_ * (its + 1) +
               perPressure_ * static_cast<float>(w.pressureIterations));
    }
    return ms;
}

float Governor::rest(const Needs& n, int subStepsLeft) const {
    const float particles = static_cast<float>(n.particles), movers = static_cast<float>(n.movers);
    const float least = perViscosity_ * (kLeastViscosity + 1) + perPressure_ * kLeastPressure;
    return movers * perMover_ * collisionShare_ + particles * perExposure_ * afterShare_ +
           static_cast<float>(subStepsLeft) *
               (particles * perParticle_ + movers * (perMover_ + static_cast<float>(n.control) * perControl_ + least));
}

void Governor::chooseLevel(const Needs& n, float target, const thawWork& least, const thawWork& most,
                           int subStepsWanted) {
    const thawWork seen = workOf(kLeastSeen, least, most);
    const bool tight = n.full || (n.movers > 0 && predict(n, seen, subStepsWanted) > target);
    Needs finer = n;
    finer.particles += n.movers, finer.movers *= 2, finer.exposed += n.exposed / 2;
    const bool roomy = !tight && predict(finer, seen, subStepsWanted) <= 0.9f * target;
    // Below 0: what was merged just now has not shown yet.
    tight_ = tight ? tight_ + 1 : std::min(tight_, 0);
    roomy_ = roomy ? roomy_ + 1 : 0;
    if (tight_ >= kCoarserAfter && finest_ < 3) ++finest_, tight_ = -kMergeFrames, roomy_ = 0;
    if (roomy_ >= kFinerAfter && finest_ > 0) --finest_, roomy_ = 0;
}

int Governor::chooseWorkers(int workers) {
    if (leftOut_ > 0) {
        if (--leftOut_ == 0) stalls_ = 0, calm_ = 0;
    } else if (stalls_ >= kStallsMost && workers > 1) {
        leftOut_ = leaveOutFor_, leaveOutFor_ = std::min(2 * leaveOutFor_, kLeaveOutMost);
    } else if (++calm_ % kCalmFrames == 0) {
        leaveOutFor_ = std::max(leaveOutFor_ / 2, kLeaveOutLeast);
    }
    return leftOut_ > 0 ? std::max(1, workers - 1) : workers;
}

Governor::Choice Governor::choose(const Needs& needs, float milliseconds, const thawWork& least, const thawWork& most,
                                  int subStepsWanted, int workers) {
    const float target = prices_ == Prices::learnt ? milliseconds / margin_ : milliseconds;
    const auto fits = [&](int quality, float most_) {
        return predict(needs, workOf(quality, least, most), subStepsWanted) <= most_;
    };
    chooseLevel(needs, target, least, most, subStepsWanted);
    int best = 0;
    while (best < kLowest && !fits(best, target)) ++best;
    if (best > quality_) {
        quality_ = best, goodFrames_ = 0;
    } else if (best < quality_) {
        goodFrames_ = fits(quality_ - 1, kClimbFill * target) ? goodFrames_ + 1 : 0;
        if (goodFrames_ >= kClimbAfter) {
            const int step = (quality_ - best + 3) / 4;
            quality_ -= fits(quality_ - step, kClimbFill * target) ? step : 1;
            goodFrames_ = 0;
        }
    } else {
        goodFrames_ = 0;
    }
    Choice c;
    c.work = workOf(quality_, least, most);
    c.work.finestLevel = std::max(most.finestLevel, std::min({finest_, least.finestLevel, most.coarsestLevel}));
    c.predictedMs = predict(needs, c.work, subStepsWanted);
    c.workers = prices_ == Prices::learnt ? chooseWorkers(workers) : workers;
    return c;
}

void Governor::learn(const Cost& c) {
    if (c.mostRays > 0) {
        const float use = std::min(1.0f, static_cast<float>(c.rays) / static_cast<float>(c.mostRays));
        rayUse_ += (use > rayUse_ ? 0.5f : 0.05f) * (use - rayUse_);
    }
    if (c.heatRan) heatWanted_ = static_cast<float>(std::max(1, c.heatWanted)) / static_cast<float>(c.heatInterval);
    if (c.movers > 0 && c.subSteps > 0) {
        const float its = static_cast<float>(c.viscosityIterations) / static_cast<float>(c.subSteps);
        viscosityPerSubStep_ += (its > viscosityPerSubStep_ ? 0.5f : 0.05f) * (its - viscosityPerSubStep_);
    }
    if (prices_ == Prices::learnt) learnPrices(c);
}

void Governor::Price::learn(float ms, double units) {
    if (units < 1 || !std::isfinite(ms)) return;
    // The first of all is dear: memory, threads and trees are new.
    const float got = ms / static_cast<float>(units);
    const float median = last[1] > 0   ? std::max(std::min(last[0], last[1]), std::min(std::max(last[0], last[1]), got))
                         : last[0] > 0 ? std::min(last[0], got)
                                       : std::min(got, now);
    last[1] = last[0], last[0] = got;
    // A machine that became slow is noticed in two frames.
    now += (median > 1.25f * now ? 0.7f : 0.1f) * (median - now);
}

void Governor::learnPrices(const Cost& c) {
    const auto blendShare = [](float& share, float part, float whole) {
        if (whole > 0 && std::isfinite(part / whole)) share += 0.1f * (std::min(1.0f, part / whole) - share);
    };
    const double n = c.particles, m = static_cast<double>(c.movers) * c.subSteps;
    const float* s = c.stageMs;
    if (s[thawStage_neighbors] > 0) {
        perParticle_.learn(s[thawStage_neighbors], n * std::max(1, c.subSteps));
        const float after = s[thawStage_levels] + s[thawStage_stats] + 0.5f * s[thawStage_phase],
                    all = s[thawStage_exposure] + s[thawStage_phase] + s[thawStage_levels] + s[thawStage_stats];
        // What looks for pieces that lost their hold takes as long as all else of it together.
        const float relabel = c.relabelled ? std::max(0.0f, all - perExposure_ * static_cast<float>(n)) : 0;
        if (c.relabelled)
            perRelabel_.learn(relabel, n);
        else
            perExposure_.learn(all, n), blendShare(afterShare_, after, all);
    }
    if (c.rays > 0) perRay_.learn(s[thawStage_radiation], c.rays + kRayShare * static_cast<double>(c.exposed));
    if (c.heatRan) perHeat_.learn(s[thawStage_conduction] + s[thawStage_loss], n * std::max(1, c.heatPasses));
    if (m > 0) {
        perMover_.learn(s[thawStage_forces] + s[thawStage_collision], m);
        if (s[thawStage_control] > 0) perControl_.learn(s[thawStage_control], m);
        blendShare(collisionShare_, s[thawStage_collision], s[thawStage_forces] + s[thawStage_collision]);
        if (c.viscosityIterations > 0)
            perViscosity_.learn(s[thawStage_viscosity],
                                static_cast<double>(c.movers) * (c.viscosityIterations + c.subSteps));
        if (c.pressureIterations > 0)
            perPressure_.learn(s[thawStage_pressure], static_cast<double>(c.movers) * c.pressureIterations);
    }
    const bool stalled = c.stalledMs > kStall || (c.predictedMs > 0 && c.stepMs > kSurprise * c.predictedMs);
    stalls_ = std::clamp(stalled ? stalls_ + kStallWeight : stalls_ - 1, 0, kStallsMost);
    if (!(c.predictedMs > 0)) return;
    // What took far longer than it should was interrupted, and no plan could have known.
    if (!(c.stepMs <= kInterrupted * c.predictedMs)) return;
    const bool late = c.late || !(c.stepMs <= kLateFrom * c.budgetMs);
    margin_ += late ? kWiden : -(kWiden * kLateShare + kRelax * (margin_ - kLeastMargin));
    margin_ = std::clamp(margin_, kLeastMargin, kMostMargin);
}

void Governor::state(StateIo& io) {
    io(rayUse_, viscosityPerSubStep_, heatWanted_);
    io.index(quality_, kLowest + 1);
    io(goodFrames_);
    io.index(finest_, 4);
    io(tight_, roomy_);
}

} // namespace thaw
