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
    bool control = false;                   // some path or shape is on
    bool cools = false;                     // some shape does
    bool ledBefore = false;                 // something moved when control last ran: it has to see that it stopped
    bool levels = false;                    // some solid could be coarser or finer than it is
    bool levelsChanged = false;             // the last look at them changed some, or left some for later
    int finestLevel = 0, coarsestLevel = 3; // of the last plan
    bool full = false;                      // the last step had no room for particles that should have split
};

// Stages on and off, with the reason: model only what the scene requires.
thawPlan makePlan(const Needs& needs, const thawWork& work);

// Rays that radiation casts at the most.
int mostRays(const Needs& needs, const thawWork& work);

} // namespace thaw
