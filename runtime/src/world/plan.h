// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "thaw/thaw.h"

#include <cstdint>

namespace thaw {

// What the scene is like before a step: all that the plan depends on besides the work units.
struct Needs {
    int particles = 0, movers = 0, exposed = 0;
    int rigid = 0;                    // particles of pieces that are awake
    bool listsStale = true;           // something moved, changed hold, came or went since the lists were built
    bool holdStale = false;           // pieces may have lost what held them
    bool collidersMove = false;       // in this step
    bool sourceOn = false;            // an enabled source that differs from ambient
    int sources = 0, areaSources = 0; // those: without and with an extent
    bool timeScaleZero = false;
    bool unequal = true;                    // temperatures differ within the melt
    bool awayFromAmbient = true;            // something is warmer or colder than ambient
    bool burns = false;                     // something is hot enough to turn to vapour
    bool heatDue = true;                    // by heatInterval
    bool levels = false;                    // some solid could be coarser or finer than it is
    bool levelsChanged = false;             // the last look at them changed some, or left some for later
    int finestLevel = 0, coarsestLevel = 3; // of the last plan
    bool full = false;                      // the last step had no room for particles that should have split
};

// Stages on and off, with the reason: model only what the scene requires.
thawPlan makePlan(const Needs& needs, const thawWork& work);

// Rays that radiation casts at the most.
int mostRays(const Needs& needs, const thawWork& work);

// Chooses work units for a budget in milliseconds: predicts the cost of a step from what the last ones cost per unit,
// takes the best quality whose prediction fits, drops at once and climbs slowly. Wall-clock enters here only, and what
// comes out is an input of the step. A cousin of the animation budget allocators of game engines, with prediction in
// place of feedback.
class Governor {
public:
    thawWork choose(const Needs& needs, float milliseconds, const thawWork& limit, int subStepsWanted,
                    float& predictedMs);
    struct Cost {
        float stageMs[thawStage_count];
        int particles, movers, exposed, rays, mostRays, subSteps, pressureIterations,
            viscosityIterations;    // iterations summed
        int heatWanted, heatPasses; // explicit sub-cycles of conduction that the step needed; passes that it did
        bool heatRan;
    };
    void learn(const Cost& cost);

private:
    void chooseLevel(const Needs& needs, float milliseconds, const thawWork& limit, int subStepsWanted);
    float predict(const Needs& needs, const thawWork& work, int subStepsWanted) const;
    // Milliseconds per unit, running estimates; start values from a 2-core machine, replaced within a few frames.
    float perParticle_ = 8e-5f;     // lists and sort, per particle and sub-step
    float perExposure_ = 2e-5f;     // exposure, hold and stats, per particle
    float perRay_ = 4e-4f;          // per ray; a quarter of it per exposed particle
    float rayUse_ = 1;              // of the rays that could be, those that were: what rests is not looked at again
    float perHeat_ = 2e-5f;         // conduction, loss, integration, per particle and pass
    float perMover_ = 8e-5f;        // forces, collision, per mover and sub-step
    float perViscosity_ = 2.5e-5f;  // per mover and iteration
    float perPressure_ = 2.5e-5f;   // per mover and iteration
    float fixed_ = 0.05f;           // per step
    float viscosityPerSubStep_ = 8; // iterations that a sub-step really takes
    int heatWanted_ = 1;            // sub-cycles of the last heat
    int quality_ = 0;
    int goodFrames_ = 0;
    int finest_ = 0; // level
    int tight_ = 0;  // frames on end that need a coarser one
    int roomy_ = 0;  // or would hold a finer one
};

} // namespace thaw
