// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "bench_control.h"
#include "report.h"
#include "run.h"

#include <algorithm>
#include <iostream>

namespace thaw::player {
namespace {

struct Options {
    std::vector<std::string> scenes;
    int threads = 1, runs = 3;
    bool quiet = false;
};

// What paths and shapes take of the steps in which they guide something, beside the rest of the same steps: the shares
// of one run differ little where the times do.
int benchControl(const Options& o) {
    checkRange("--runs", o.runs, 1, 1000);
    checkRange("--threads", o.threads, 1, 64);
    std::cout << "scene,particles,run,guided_steps,moving,step_p50_ms,control_p50_ms,control_p99_ms,share,share_p50,"
                 "share_p99\n";
    for (const std::string& path : o.scenes) {
        const scene::Scene scene = scene::loadScene(path);
        const scene::SceneMeshes meshes = scene::loadMeshes(scene);
        const thawBudget budget = makeBudget(scene, 0, "4,8,12");
        for (int run = 1; run <= o.runs; ++run) {
            const scene::SceneWorld built = scene::buildWorld(scene, meshes, o.threads);
            Report report;
            report.name = scene::oneLine(scene.name, 80);
            const int frames = framesOf(double(scene.defaults.seconds));
            Progress progress(report.name, frames, o.quiet);
            std::vector<double> steps, control, shares, moving;
            for (int f = 1; f <= frames; ++f) {
                stepOrThrow(built.world.get(), budget, report);
                progress.frame(f, report);
                thawProfile p;
                thawCounters c;
                thawWorld_GetProfile(built.world.get(), &p);
                thawWorld_GetCounters(built.world.get(), &c);
                if (!(p.stage[thawStage_control] > 0)) continue;
                steps.push_back(double(p.step)), control.push_back(double(p.stage[thawStage_control]));
                shares.push_back(control.back() / steps.back()), moving.push_back(c.moving);
            }
            double all = 0, part = 0;
            for (size_t k = 0; k < steps.size(); ++k) all += steps[k], part += control[k];
            std::cout << formatted("%s,%d,%d,%zu,%.0f,%.3f,%.3f,%.3f,%.4f,%.4f,%.4f\n", path.c_str(),
                                   report.counters().particles, run, steps.size(), percentile(moving, 0.5),
                                   percentile(steps, 0.5), percentile(control, 0.5), percentile(control, 0.99),
                                   all > 0 ? part / all : 0, percentile(shares, 0.5), percentile(shares, 0.99))
                      << std::flush;
        }
    }
    return kExitOk;
}

} // namespace

void addBenchControl(CLI::App& bench, int& exitCode) {
    CLI::App* command = bench.add_subcommand(
        "control", "One CSV line a run: what paths and shapes take of the steps in which they guide something");
    auto o = std::make_shared<Options>();
    command->add_option("scenes", o->scenes, "Scene files (JSON) with paths or shapes")->required();
    command->add_option("--runs", o->runs, "Runs of each scene")->capture_default_str();
    command->add_option("--threads", o->threads, "Threads that take part, 1 to 64")->capture_default_str();
    command->add_flag("--quiet", o->quiet, "No progress on stderr");
    command->callback([=, &exitCode] { exitCode = benchControl(*o); });
}

} // namespace thaw::player
