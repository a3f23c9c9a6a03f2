// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// `thaw bench levels`: what coarse particles save and cost.
#include "bench_levels.h"

#include "run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>

namespace thaw::player {

namespace {

struct Options {
    std::vector<std::string> scenes;
    int threads = defaultThreads(), coarsest = 3, frames = 0, runs = 3;
    bool quiet = false;
};

struct Surface {
    std::vector<std::array<float, 3>> vertices;
};

Surface surfaceOf(thawWorld* world) {
    thawSurfaceDef def;
    thawInitSurfaceDef(&def);
    thawSurfaceView v;
    if (thawWorld_ExtractSurface(world, &def, &v) != thawResult_ok)
        throw RunError(std::string("the surface was refused: ") + thawWorld_GetLastError(world));
    Surface s;
    for (int i = 0; i < v.vertexCount; ++i)
        s.vertices.push_back({v.positions[3 * i], v.positions[3 * i + 1], v.positions[3 * i + 2]});
    return s;
}

// Farthest of the vertices of a from those of b, m: an upper bound of the distance to the surface itself.
double farthest(const Surface& a, const Surface& b) {
    std::vector<std::array<float, 3>> sorted = b.vertices;
    std::sort(sorted.begin(), sorted.end());
    double worst = 0;
    for (const auto& p : a.vertices) {
        double nearest = 1e30;
        const auto start = std::lower_bound(sorted.begin(), sorted.end(), p);
        const auto look = [&](const std::array<float, 3>& q) {
            const double x = double(q[0]) - double(p[0]), y = double(q[1]) - double(p[1]),
                         z = double(q[2]) - double(p[2]);
            nearest = std::min(nearest, x * x + y * y + z * z);
            return x * x < nearest;
        };
        for (auto k = start; k != sorted.end() && look(*k);) ++k;
        for (auto k = start; k != sorted.begin() && look(*(k - 1));) --k;
        worst = std::max(worst, nearest);
    }
    return std::sqrt(worst);
}

struct Run {
    std::vector<double> melted, ms;
    std::vector<int> particles;
    thawCounters start{};
    Surface surface;
    bool sound = true;
};

// A scene in work units. shift: m, of the first source; what so small a change makes of the flow is what two right
// answers may differ by.
Run runAt(scene::Scene scene, const scene::SceneMeshes& meshes, const Options& o, int coarsest, float shift,
          const char* name) {
    thawBudget budget = makeBudget(scene, 0, "4,4,12");
    RunOptions levels;
    levels.coarsestLevel = coarsest;
    applyLevels(levels, scene, budget);
    if (!scene.heatSources.empty()) scene.heatSources[0].position.x += shift;
    const scene::SceneWorld built = scene::buildWorld(scene, meshes, o.threads);
    thawWorld* world = built.world.get();
    Run run;
    thawWorld_GetCounters(world, &run.start);
    run.surface = surfaceOf(world);
    Report report;
    report.name = name, report.threads = o.threads, report.budget = budget;
    const int frames = o.frames > 0 ? o.frames : framesOf(double(scene.defaults.seconds));
    Progress progress(report.name, frames, o.quiet);
    for (int f = 1; f <= frames; ++f) {
        stepOrThrow(world, budget, report);
        run.melted.push_back(double(report.counters().meltedFraction));
        run.particles.push_back(report.counters().particles);
        progress.frame(f, report);
    }
    report.finish(world);
    run.ms = {report.percentile(0.5), report.percentile(0.99)};
    run.sound = report.faults().empty();
    return run;
}

// Largest difference of melted mass, as a share of the reference's, once that has melted by 1 %; at the end of each
// second.
double apart(const Run& a, const Run& reference) {
    double worst = 0;
    for (size_t f = 59; f < reference.melted.size(); f += 60)
        if (reference.melted[f] > 0.01) worst = std::max(worst, std::abs(a.melted[f] / reference.melted[f] - 1));
    return worst;
}

double meanOf(const std::vector<int>& v) {
    double sum = 0;
    for (const int n : v) sum += n;
    return v.empty() ? 0 : sum / double(v.size());
}

int benchLevels(const Options& o) {
    checkRange("--coarsest-level", o.coarsest, 1, 3);
    checkRange("--threads", o.threads, 1, 64);
    std::cout << "scene,coarsest,particles_fine,particles_start,times_fewer,surface_dx,particles_mean,melted_end,"
                 "melted_apart,apart_by_chance,p50_ms,p50_ms_fine\n";
    bool sound = true;
    for (const std::string& path : o.scenes) {
        const scene::Scene scene = scene::loadScene(path);
        const scene::SceneMeshes meshes = scene::loadMeshes(scene);
        const Run fine = runAt(scene, meshes, o, 0, 0, "fine");
        const Run coarse = runAt(scene, meshes, o, o.coarsest, 0, "levels");
        const double dx = double(scene.world.particleSpacing);
        // Chaos: the fine run with its source a hundredth of a spacing farther.
        const Run moved = runAt(scene, meshes, o, 0, float(0.01 * dx), "fine, source moved");
        const double surface =
            std::max(farthest(fine.surface, coarse.surface), farthest(coarse.surface, fine.surface)) / dx;
        std::cout << formatted("%s,%d,%d,%d,%.2f,%.3f,%.0f,%.4f,%.4f,%.4f,%.2f,%.2f\n", path.c_str(), o.coarsest,
                               fine.start.particles, coarse.start.particles,
                               double(fine.start.particles) / double(coarse.start.particles), surface,
                               meanOf(coarse.particles), coarse.melted.back(), apart(coarse, fine), apart(moved, fine),
                               coarse.ms[0], fine.ms[0])
                  << std::flush;
        sound &= fine.sound && coarse.sound;
    }
    return sound ? kExitOk : kExitFailed;
}

} // namespace

void addBenchLevels(CLI::App& bench, int& exitCode) {
    auto o = std::make_shared<Options>();
    const auto common = [&](CLI::App* c) {
        c->add_option("scenes", o->scenes, "Scene files (JSON)")->required();
        c->add_option("--coarsest-level", o->coarsest, "Level that solids start with, 1 to 3")->capture_default_str();
        c->add_option("--threads", o->threads, "Threads that take part, 1 to 64")->capture_default_str();
        c->add_option("--frames", o->frames, "Frames of 1/60 s (default: what the scene says; budget: 1800)");
        c->add_flag("--quiet", o->quiet, "No progress on stderr");
    };
    CLI::App* levels = bench.add_subcommand(
        "levels", "One CSV line a scene: particles of mixed levels against the finest everywhere, in work units");
    common(levels);
    levels->callback([=, &exitCode] { exitCode = benchLevels(*o); });
}

} // namespace thaw::player
