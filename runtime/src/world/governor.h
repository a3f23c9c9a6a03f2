// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/state_io.h"
#include "thaw/thaw.h"
#include "world/plan.h"

#include <cstdint>

namespace thaw {

// Chooses the work of a step for a budget, before the step: predicts what it will cost from prices per unit of work,
// and takes the best quality that fits. It drops at once and climbs slowly, after many good frames. What it chooses is
// an input of the step. A cousin of the animation budget allocators of game engines, with prediction in place of
// feedback.
//
// With learnt prices the budget is in milliseconds: prices follow what the stages took, and a margin follows how often
// a step was late all the same. With fixed prices it is in work units (1000 a nominal millisecond), no clock is looked
// at, and the choice depends on nothing but what was stepped.
class Governor {
public:
    enum class Prices { learnt, fixed };
    explicit Governor(Prices prices) : prices_(prices) {}

    struct Choice {
        thawWork work{};
        float predictedMs = 0;
        int workers = 0; // threads that should take part
    };
    // least, most: bounds of each knob; most goes before least.
    Choice choose(const Needs& needs, float milliseconds, const thawWork& least, const thawWork& most,
                  int subStepsWanted, int workers);
    // ms, by the prices of now.
    float predict(const Needs& needs, const thawWork& work, int subStepsWanted) const;
    // ms that a step still takes after the iterations of a sub-step, when the sub-steps that follow do the least.
    float rest(const Needs& needs, int subStepsLeft) const;

    struct Cost { // of a step
        float stageMs[thawStage_count];
        float stepMs, budgetMs,
            stalledMs;     // stalledMs: of stepMs, what the caller waited for workers that the system did not run
        float predictedMs; // of the choice; 0: it was none of this governor's
        int particles, movers, exposed, rays, mostRays, subSteps, pressureIterations,
            viscosityIterations;    // iterations summed
        int heatWanted, heatPasses; // explicit sub-cycles of conduction that the step needed; passes that it did
        int heatInterval;
        bool heatRan, late, relabelled;
    };
    void learn(const Cost& cost);
    void state(StateIo& io); // of fixed prices: all that it remembers

    // Iterations that a sub-step does however late it is.
    static constexpr int kLeastViscosity = 3, kLeastPressure = 2;

private:
    void chooseLevel(const Needs& needs, float target, const thawWork& least, const thawWork& most, int subStepsWanted);
    int chooseWorkers(int workers);
    void learnPrices(const Cost& cost);

    Prices prices_;
    // Milliseconds per unit, which follow the median of the last three: one frame that was interrupted says nothing.
    struct Price {
        float now;
        float last[2] = {0, 0};
        Price(float start) : now(start) {}
        void learn(float ms, double units);
        operator float() const { return now; }
    };
    // Start values from a quiet machine with 2 cores: the price list of work units.
    Price perParticle_ = 5e-5f;  // lists and sort, per particle and sub-step
    Price perExposure_ = 2e-5f;  // exposure, hold, levels and stats, per particle
    Price perRelabel_ = 2e-5f;   // looking for pieces that lost their hold, per particle
    Price perRay_ = 4e-4f;       // per ray; a quarter of it per exposed particle
    Price perHeat_ = 1.5e-5f;    // conduction, loss, integration, per particle and pass
    Price perMover_ = 6e-5f;     // forces, collision, per mover and sub-step
    Price perViscosity_ = 1e-5f; // per mover and iteration
    Price perPressure_ = 1e-5f;  // per mover and iteration
    Price perControl_ = 2e-5f;   // who follows what, per mover and sub-step
    float fixed_ = 0.05f;        // per step
    // Shares of the above that come after the iterations: collision of perMover_; levels and stats of perExposure_.
    float collisionShare_ = 0.5f, afterShare_ = 0.5f;

    float rayUse_ = 1;              // of the rays that could be, those that were: what rests is not looked at again
    float viscosityPerSubStep_ = 8; // iterations that a sub-step really takes
    float heatWanted_ = 1;          // sub-cycles of the last heat, over its interval
    float margin_ = 1.02f;          // of the budget over what may be predicted
    int quality_ = 0;               // 0 is the best
    int goodFrames_ = 0;
    int finest_ = 0; // level
    int tight_ = 0;  // frames on end that need a coarser one
    int roomy_ = 0;  // or would hold a finer one
    // Workers that the system takes away for a slice at a time cost more than they bring.
    int stalls_ = 0;        // recent ones count for more
    int leaveOutFor_ = 600; // frames, longer every time
    int leftOut_ = 0;       // frames that one is still left out
    int calm_ = 0;          // frames since
};

} // namespace thaw
