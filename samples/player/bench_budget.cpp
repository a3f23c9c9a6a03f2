// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// `thaw bench budget`: how well a budget is kept and used. `thaw bench rest`: what a scene costs in which nothing
// happens.
#include "bench_levels.h"
#include "busy.h"
#include "run.h"

#include <algorithm>
#include <cmath>
#include <iostream>

namespace thaw::player {

namespace {

struct Options {
    std::vector<std::string> scenes;
    std::string budgets = "2,4,8";
    int threads = defaultThreads(), coarsest = 3, frames = 1800, busy = 0;
    bool quiet = false;
};

// Every source ten times as strong; where there is none, ten times the heat time.
void heatTenfold(const scene::Scene& scene, const scene::SceneWorld& built) {
    thawWorld* world = built.world.get();
    bool any = false;
    for (size_t k = 0; k < scene.heatSources.size(); ++k) {
        if (!scene.heatSources[k].enabled) continue;
        thawHeatSourceDef def = scene::sourceDef(scene.heatSources[k]);
        def.power *= 10, def.irradiance *= 10, def.temperature *= float(std::pow(10.0, 0.25));
        if (thawHeatSource_Set(world, built.heatSources[k], &def) != thawResult_ok)
            throw RunError(std::string("a source was refused: ") + thawWorld_GetLastError(world));
        any = true;
    }
    if (!any) thawWorld_SetThermalTimeScale(world, 10 * scene.world.thermalTimeScale);
}

// Frames from the jump to the last one that is over, within the next 120; what one frame in 200 is over by without a
// jump does not count as an answer to it.
int framesUntilInside(const std::vector<double>& ms, size_t jump, double budget) {
    int last = 0, over = 0;
    for (size_t f = jump; f < std::min(ms.size(), jump + 120); ++f)
        if (ms[f] > budget) last = int(f - jump) + 1, ++over;
    return over > 1 ? last : 0;
}

int benchBudget(const Options& o) {
    checkRange("--threads", o.threads, 1, 64);
    checkRange("--busy", o.busy, 0, 64);
    checkRange("--frames", o.frames, 60, 1e6);
    const std::vector<double> budgets = parseNumbers("--budgets", o.budgets, 0.05, 1e4, "ms", 1, 64);
    std::cout << "scene,budget_ms,threads,busy,frames,over_percent,p50_over_budget,p99_over_budget,late_percent,"
                 "melted,finest_level_most,particles_start,particles,fewer_workers_percent,plan_changes,"
                 "frames_until_inside_after_10x_heat,status\n";
    bool sound = true;
    const Busy busy(o.busy);
    for (const std::string& path : o.scenes) {
        scene::Scene scene = scene::loadScene(path);
        for (scene::Body& b : scene.bodies) b.coarsestLevel = std::max(b.coarsestLevel, o.coarsest);
        const scene::SceneMeshes meshes = scene::loadMeshes(scene);
        for (const double ms : budgets) {
            const thawBudget budget = makeBudget(scene, ms, "");
            const auto run = [&](int frames, int jump, auto&& each) {
                const scene::SceneWorld built = scene::buildWorld(scene, meshes, o.threads);
                Report report;
                report.name = scene.name, report.threads = o.threads, report.budget = budget;
                report.limitMs = float(ms);
                Progress progress(report.name, frames, o.quiet);
                for (int f = 1; f <= frames; ++f) {
                    if (f == jump) heatTenfold(scene, built);
                    stepOrThrow(built.world.get(), budget, report);
                    each(built.world.get(), report);
                    progress.frame(f, report);
                }
                report.finish(built.world.get());
                sound &= report.faults().empty();
                return report;
            };
            std::vector<double> melting;
            int coarsest = 0, start = 0, fewer = 0, changes = 0, late = 0;
            thawWork last{};
            const Report report = run(o.frames, 0, [&](thawWorld* world, const Report& r) {
                thawPlan plan;
                thawWorld_GetPlan(world, &plan);
                if (r.steps() == 1) start = r.counters().particles, last = plan.work;
                coarsest = std::max(coarsest, plan.work.finestLevel);
                fewer += plan.workers < o.threads, late += (r.lastStatus() & thawStep_late) != 0;
                changes += plan.work.leastSubSteps != last.leastSubSteps ||
                           plan.work.pressureIterations != last.pressureIterations ||
                           plan.work.viscosityIterations != last.viscosityIterations ||
                           plan.work.heatInterval != last.heatInterval || plan.work.rayRefresh != last.rayRefresh;
                last = plan.work;
                if (r.counters().moving > 0) melting.push_back(r.lastMilliseconds());
            });
            std::vector<double> jumped;
            const int jump = 300;
            run(jump + 120, jump, [&](thawWorld*, const Report& r) { jumped.push_back(r.lastMilliseconds()); });
            std::sort(melting.begin(), melting.end());
            const double frames = double(o.frames);
            std::cout << formatted("%s,%g,%d,%d,%d,%.2f,%.2f,%.2f,%.2f,%.4f,%d,%d,%d,%.1f,%d,%d,%u\n", path.c_str(), ms,
                                   o.threads, o.busy, o.frames, 100 * double(report.framesOver()) / frames,
                                   melting.empty() ? 0.0 : melting[melting.size() / 2] / ms,
                                   report.percentile(0.99) / ms, 100 * late / frames,
                                   double(report.counters().meltedFraction), coarsest, start,
                                   report.counters().particles, 100 * fewer / frames, changes,
                                   framesUntilInside(jumped, size_t(jump - 1), ms), report.statusUnion())
                      << std::flush;
        }
    }
    return sound ? kExitOk : kExitFailed;
}

// The scene with no source, no warm wall and one temperature, that of its coldest body, after it came to rest.
int benchRest(const Options& o) {
    checkRange("--threads", o.threads, 1, 64);
    checkRange("--frames", o.frames, 60, 1e6);
    std::cout << "scene,particles,frames,moving,p50_ms,p99_ms,most_ms\n";
    for (const std::string& path : o.scenes) {
        scene::Scene scene = scene::loadScene(path);
        float coldest = scene.world.ambientTemperature;
        for (const scene::Body& b : scene.bodies)
            if (!std::isnan(b.temperature)) coldest = std::min(coldest, b.temperature);
        for (const scene::Body& b : scene.bodies)
            coldest = std::min(coldest, scene.materials[size_t(b.material)].def.solidus - 1);
        scene.heatSources.clear();
        scene.world.ambientTemperature = coldest;
        for (scene::Body& b : scene.bodies) b.temperature = coldest, b.paint.clear();
        for (scene::Collider& c : scene.colliders) c.temperature = NAN;
        const scene::SceneMeshes meshes = scene::loadMeshes(scene);
        const thawBudget budget = makeBudget(scene, 0, "");
        const scene::SceneWorld built = scene::buildWorld(scene, meshes, o.threads);
        Report report, settling;
        const int settle = 600;
        for (int f = 0; f < settle; ++f) stepOrThrow(built.world.get(), budget, settling);
        Progress progress(scene.name, o.frames, o.quiet);
        for (int f = 1; f <= o.frames; ++f) {
            stepOrThrow(built.world.get(), budget, report);
            progress.frame(f, report);
        }
        std::cout << formatted("%s,%d,%d,%d,%.4f,%.4f,%.4f\n", path.c_str(), report.counters().particles, o.frames,
                               report.counters().moving, report.percentile(0.5), report.percentile(0.99),
                               report.percentile(1.0))
                  << std::flush;
    }
    return kExitOk;
}

} // namespace

void addBenchBudget(CLI::App& bench, int& exitCode) {
    auto o = std::make_shared<Options>();
    const auto common = [&](CLI::App* c) {
        c->add_option("scenes", o->scenes, "Scene files (JSON)")->required();
        c->add_option("--threads", o->threads, "Threads that take part, 1 to 64")->capture_default_str();
        c->add_option("--frames", o->frames, "Frames of 1/60 s")->capture_default_str();
        c->add_flag("--quiet", o->quiet, "No progress on stderr");
    };
    CLI::App* budget = bench.add_subcommand("budget", "One CSV line a scene and budget: how well it is kept and used");
    common(budget);
    budget->add_option("--coarsest-level", o->coarsest, "Level that solids start with at least, 0 to 3")
        ->capture_default_str();
    budget->add_option("--busy", o->busy, "Threads beside it that take a core each")->capture_default_str();
    budget->add_option("--budgets", o->budgets, "Budgets in ms, with commas between")->capture_default_str();
    budget->callback([=, &exitCode] { exitCode = benchBudget(*o); });
    CLI::App* rest =
        bench.add_subcommand("rest", "One CSV line a scene: the cost of a step when all is cold and still");
    common(rest);
    rest->callback([=, &exitCode] { exitCode = benchRest(*o); });
}

} // namespace thaw::player
