// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "args.h"
#include "pictures.h"
#include "report.h"

#include <functional>

namespace thaw::player {

// Work of a step of captures: the same pictures on every machine.
inline constexpr const char* kCaptureWork = "4,4,12";

// What run and melt have in common on the command line.
struct RunOptions {
    double seconds = 0.0;  // 0: what the scene says
    double budgetMs = 0.0; // 0: what the scene says
    std::string work;      // "subSteps,pressure,viscosity"; empty: milliseconds
    double units = -1;     // of thawBudget_units; -1: none
    int threads = defaultThreads();
    int fixedLevel = -1, coarsestLevel = -1; // -1: what the scene says
    bool notAdaptive = false;
    std::string out, json, csv, mesh, view = "shaded", size = "960x540";
    int pictures = 0;
    double mostOver = 100.0; // %
    bool quiet = false;

    void addTo(CLI::App& command);
};

// Milliseconds of the options or the scene, or the fixed work or the units of the options. Throws InputError.
thawBudget makeBudget(const scene::Scene& scene, double budgetMs, const std::string& work, double units = -1);
// Levels of the options, into the bodies and the budget. Throws InputError.
void applyLevels(const RunOptions& options, scene::Scene& scene, thawBudget& budget);
// Steps of 1/60 s that make up a time, at least one.
int framesOf(double seconds);
// One timed step; what the caller does afterwards is not counted.
uint32_t timedStep(thawWorld* world, const thawBudget& budget, Report& report);
// The same; throws RunError with the library's message when it is refused.
void stepOrThrow(thawWorld* world, const thawBudget& budget, Report& report);

// Tells on stderr how far a run is: one line that is rewritten on a terminal, else a line for every second of the game.
class Progress {
public:
    Progress(std::string name, int frames, bool quiet);
    ~Progress();
    void frame(int done, const Report& report);

private:
    std::string name_;
    int frames_;
    bool quiet_, terminal_, open_ = false;
};

// Builds, steps, tells, writes. Returns the exit code.
int runScene(scene::Scene scene, const RunOptions& options);

} // namespace thaw::player
