// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "bench_pictures.h"
#include "pictures.h"
#include "report.h"
#include "run.h"
#include "view/png.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <iostream>

namespace thaw::player {
namespace {

struct Options {
    std::vector<std::string> scenes;
    std::string size = "960x540";
    double at = 3;
    int frames = 5, threads = defaultThreads();
};

// With the surface of a step before it and the packing of the PNG behind it, as `thaw capture` takes them.
int benchPictures(const Options& o) {
    checkRange("--at", o.at, 0, 3600, "s");
    checkRange("--frames", o.frames, 1, 1000);
    checkRange("--threads", o.threads, 1, 64);
    const PictureSize size = parseSize("--size", o.size);
    std::cout << "scene,view,width,height,particles,triangles,ms_first,ms_p50,ms_worst,cpu_ms_p50\n";
    double slowest = 0, busiest = 0;
    for (const std::string& path : o.scenes) {
        const scene::Scene scene = scene::loadScene(path);
        const scene::SceneMeshes meshes = scene::loadMeshes(scene);
        const scene::SceneWorld built = scene::buildWorld(scene, meshes, o.threads);
        const thawBudget budget = makeBudget(scene, 0.0, "4,4,12");
        Report report;
        for (int f = 0; f < int(o.at / kFrameSeconds + 0.5); ++f) stepOrThrow(built.world.get(), budget, report);
        Pictures pictures(scene, meshes, size);
        for (const NamedView& named : kNamedViews) {
            std::vector<double> times, busy; // busy: of all cores together
            for (int f = 0; f <= o.frames; ++f) {
                stepOrThrow(built.world.get(), budget, report);
                const auto start = std::chrono::steady_clock::now();
                const std::clock_t cpuStart = std::clock();
                const view::Image image = pictures.draw(built.world.get(), named.view);
                if (view::packedPng(image, {0, 0, image.width, image.height}, 3).empty())
                    throw RunError("no memory for a PNG");
                times.push_back(
                    std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
                busy.push_back(1000.0 * double(std::clock() - cpuStart) / CLOCKS_PER_SEC);
            }
            const double first = times.front();
            times.erase(times.begin()), busy.erase(busy.begin());
            thawSurfaceDef def;
            thawInitSurfaceDef(&def);
            thawSurfaceView surface;
            if (thawWorld_ExtractSurface(built.world.get(), &def, &surface) != thawResult_ok)
                throw RunError("no surface");
            thawCounters counters;
            thawWorld_GetCounters(built.world.get(), &counters);
            const double middle = percentile(times, 0.5);
            slowest = std::max(slowest, middle), busiest = std::max(busiest, percentile(busy, 0.5));
            std::cout << formatted("%s,%s,%d,%d,%d,%d,%.0f,%.0f,%.0f,%.0f\n",
                                   std::filesystem::path(path).stem().string().c_str(), named.name, size.width,
                                   size.height, counters.particles, surface.triangleCount, first, middle,
                                   *std::max_element(times.begin(), times.end()), percentile(busy, 0.5))
                      << std::flush;
        }
    }
    std::cout << formatted("# slowest medians: %.0f ms, %.0f ms of all cores\n", slowest, busiest);
    return kExitOk;
}

} // namespace

void addBenchPictures(CLI::App& bench, int& exitCode) {
    CLI::App* command = bench.add_subcommand(
        "pictures", "One CSV line a scene and view: what a picture takes, from the surface to the PNG");
    auto o = std::make_shared<Options>();
    command->add_option("scenes", o->scenes, "Scene files (JSON)")->required();
    command->add_option("--at", o->at, "Time of the game before the first picture, s")->capture_default_str();
    command->add_option("--size", o->size, "Pixels of a picture")->capture_default_str();
    command->add_option("--frames", o->frames, "Pictures of each view after its first")->capture_default_str();
    command->add_option("--threads", o->threads, "Threads that step, 1 to 64")->capture_default_str();
    command->callback([=, &exitCode] { exitCode = benchPictures(*o); });
}

} // namespace thaw::player
