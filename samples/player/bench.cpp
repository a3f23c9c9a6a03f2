// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "bench_control.h"
#include "bench_levels.h"
#include "bench_pictures.h"
#include "bench_registry.h"
#include "bench_surface.h"
#include "busy.h"
#include "run.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>

namespace thaw::player {

namespace {
struct Options {
    std::vector<std::string> scenes;
    int runs = 3;
    std::string budgets, threads = "1", work, out;
    double units = -1;
    int busy = 0;
    double seconds = 0.0;
    bool quiet = false;
};

std::string csvText(std::string text) {
    for (char& c : text)
        if (c == ',' || c == '"') c = ' ';
    return text;
}

// One case: the best of a few runs, as the machine's other work can only make a run slower. State hashes in work mode
// must not differ between runs or thread counts; in milliseconds mode they follow the clock.
int benchScenes(const Options& o) {
    checkRange("--runs", o.runs, 1, 1000);
    const std::vector<double> threadCounts = parseNumbers("--threads", o.threads, 1, 64, "", 1, 64);
    std::vector<double> budgets{0.0};
    if (!o.budgets.empty()) budgets = parseNumbers("--budgets", o.budgets, 0.05, 1e4, "ms", 1, 64);
    if (o.seconds != 0.0) checkRange("--seconds", o.seconds, 0.01, 3600.0, "s");
    std::ofstream file;
    if (!o.out.empty()) {
        file.open(o.out, std::ios::binary);
        if (!file) throw RunError(scene::oneLine(o.out, 400) + ": cannot be written");
    }
    std::ostream& out = o.out.empty() ? std::cout : file;
    checkRange("--busy", o.busy, 0, 64);
    const Busy busy(o.busy);
    out << "scene,particles,threads,budget,seconds,run,p50_ms,p95_ms,p99_ms,max_ms,frames,frames_over,melted,"
           "heat_share,status,hash\n";
    bool differs = false;
    for (const std::string& path : o.scenes) {
        const scene::Scene scene = scene::loadScene(path);
        const scene::SceneMeshes meshes = scene::loadMeshes(scene);
        const double seconds = o.seconds != 0.0 ? o.seconds : double(scene.defaults.seconds);
        for (double budgetMs : budgets) {
            const thawBudget budget = makeBudget(scene, budgetMs, o.work, o.units);
            bool known = false;
            uint64_t hash = 0;
            for (double threads : threadCounts) {
                for (int run = 1; run <= o.runs; ++run) {
                    const scene::SceneWorld built = scene::buildWorld(scene, meshes, int(threads));
                    Report report;
                    report.name = scene::oneLine(scene.name, 80);
                    report.threads = int(threads);
                    report.budget = budget;
                    report.limitMs = budget.milliseconds;
                    const int frames = framesOf(seconds);
                    Progress progress(report.name, frames, o.quiet);
                    for (int f = 1; f <= frames; ++f) {
                        stepOrThrow(built.world.get(), budget, report);
                        progress.frame(f, report);
                    }
                    report.finish(built.world.get());
                    if (budget.mode != thawBudget_milliseconds) {
                        differs = differs || (known && hash != report.hash());
                        hash = report.hash();
                        known = true;
                    }
                    const std::string budgetText =
                        budget.mode == thawBudget_work
                            ? formatted("work %d/%d/%d", budget.work.subSteps, budget.work.pressureIterations,
                                        budget.work.viscosityIterations)
                        : budget.mode == thawBudget_units ? formatted("%g units", double(budget.units))
                                                          : formatted("%g ms", double(budget.milliseconds));
                    out << csvText(report.name)
                        << formatted(",%d,%d,%s,%g,%d,%.3f,%.3f,%.3f,%.3f,%d,%zu,%.5f,%.3f,%u,%s\n",
                                     report.counters().particles, report.threads, budgetText.c_str(), seconds, run,
                                     report.percentile(0.5), report.percentile(0.95), report.percentile(0.99),
                                     report.percentile(1.0), frames, report.framesOver(),
                                     double(report.counters().meltedFraction), report.heatShare(), report.statusUnion(),
                                     hashText(report.hash()).c_str());
                    out.flush();
                }
            }
        }
    }
    if (!out) throw RunError(scene::oneLine(o.out, 400) + ": cannot be written to the end");
    if (differs) std::fputs("thaw: the state hash differs between runs of the same work\n", stderr);
    return differs ? kExitFailed : kExitOk;
}
} // namespace

void addBench(CLI::App& app, int& exitCode) {
    CLI::App* bench = app.add_subcommand("bench", "Measure");
    bench->require_subcommand(1);
    CLI::App* command = bench->add_subcommand("scene", "One CSV line a run: step times beside the state hash");
    auto o = std::make_shared<Options>();
    command->add_option("scenes", o->scenes, "Scene files (JSON)")->required();
    command->add_option("--runs", o->runs, "Runs of each case")->capture_default_str();
    CLI::Option* budgets =
        command->add_option("--budgets", o->budgets, "Budgets in ms, with commas between (default: the scene's)");
    command
        ->add_option(
            "--work", o->work,
            "Fixed work instead: sub-steps,pressure,viscosity iterations[,least sub-steps]; hashes must then agree")
        ->excludes(budgets);
    command->add_option("--work-units", o->units, "Budget by the fixed price list instead; hashes must then agree")
        ->excludes(budgets);
    command->add_option("--threads", o->threads, "Thread counts, with commas between")->capture_default_str();
    command->add_option("--busy", o->busy, "Threads beside it that take a core each")->capture_default_str();
    command->add_option("--seconds", o->seconds, "Time of the game, s (default: what the scene says)");
    command->add_option("--out", o->out, "File for the lines (default: stdout)");
    command->add_flag("--quiet", o->quiet, "No progress on stderr");
    command->callback([=, &exitCode] { exitCode = benchScenes(*o); });

    addBenchLevels(*bench, exitCode);
    addBenchControl(*bench, exitCode);
    addBenchSurface(*bench, exitCode);
    addBenchPictures(*bench, exitCode);
    addBenchBudget(*bench, exitCode);
    std::vector<BenchEntry> entries = benchEntries();
    std::sort(entries.begin(), entries.end(),
              [](const BenchEntry& a, const BenchEntry& b) { return std::string(a.name) < b.name; });
    for (const BenchEntry& entry : entries) {
        CLI::App* extra = bench->add_subcommand(entry.name, entry.help);
        extra->prefix_command();
        extra->callback([=, &exitCode] {
            std::vector<std::string> arguments = extra->remaining();
            arguments.insert(arguments.begin(), entry.name);
            std::vector<char*> pointers;
            for (std::string& a : arguments) pointers.push_back(a.data());
            pointers.push_back(nullptr);
            exitCode = entry.run(int(arguments.size()), pointers.data());
        });
    }
}

} // namespace thaw::player
