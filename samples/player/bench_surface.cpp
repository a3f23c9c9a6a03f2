// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "bench_surface.h"
#include "report.h"
#include "run.h"
#include "validate/lab.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>

namespace thaw::player {
namespace {

struct Options {
    int threads = 1, frames = 60;
};

// A block of 16,000 particles on a floor, of which a share is liquid and flows.
enum class What { mesh, start, splats };
struct Case {
    const char* name;
    double liquid;
    bool anew; // all of the mesh, also where nothing has changed
    What what = What::mesh;
};
constexpr Case kCases[] = {{"rest", 0, false},
                           {"rest", 0, true},
                           {"tenth", 0.1, false},
                           {"tenth", 0.1, true},
                           {"melt", 1, false},
                           {"start", 0.1, false, What::start},
                           {"splats", 0.1, false, What::splats}};

int benchSurface(const Options& o) {
    checkRange("--threads", o.threads, 1, 64);
    checkRange("--frames", o.frames, 1, 10000);
    std::cout << "case,anew,particles,moving,threads,vertices,triangles,ms_p50,ms_best,ms_worst\n";
    for (const Case& c : kCases) {
        constexpr float kSpacing = 0.002f;
        Lab lab(kSpacing, 20000, {0, -9.81f, 0}, 0, o.threads);
        const thawMaterialId m = lab.material(Lab::plain(1000, 1));
        lab.floor();
        const float side = 0.05f, height = 0.0512f, held = height * float(1 - c.liquid);
        if (held > 0) lab.box(m, {-0.5f * side, 0, -0.5f * side}, {0.5f * side, held, 0.5f * side}, Lab::kSolid);
        if (c.liquid > 0)
            lab.box(m, {-0.5f * side, held, -0.5f * side}, {0.5f * side, height, 0.5f * side}, Lab::kLiquid);
        thawSurfaceDef d;
        thawInitSurfaceDef(&d);
        thawSurfaceView view;
        std::vector<double> times;
        lab.step(10);
        thawWorld_ExtractSurface(lab.world(), &d, &view); // takes its memory
        const auto timed = [&](auto&& run) {
            const auto start = std::chrono::steady_clock::now();
            if (run() != thawResult_ok) throw RunError(thawWorld_GetLastError(lab.world()));
            times.push_back(
                std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
        };
        for (int f = 0; f < o.frames; ++f) {
            lab.step(1);
            if (c.anew) d.cellSize = std::nextafter(d.cellSize, f % 2 ? 0.0f : 1.0f); // another grid
            thawSplatView splats;
            switch (c.what) {
            case What::mesh:
                timed([&] { return thawWorld_ExtractSurface(lab.world(), &d, &view); });
                break;
            case What::start: // what the caller waits for; the mesh is made beside the next step
                timed([&] { return thawWorld_StartSurface(lab.world(), &d); });
                lab.step(1);
                thawWorld_FinishSurface(lab.world(), &view);
                break;
            case What::splats:
                timed([&] { return thawWorld_GetSplats(lab.world(), &splats); });
                break;
            }
        }
        const thawCounters n = lab.counters();
        std::cout << formatted("%s,%d,%d,%d,%d,%d,%d,%.3f,%.3f,%.3f\n", c.name, c.anew, n.particles, n.moving,
                               o.threads, view.vertexCount, view.triangleCount, percentile(times, 0.5),
                               *std::min_element(times.begin(), times.end()),
                               *std::max_element(times.begin(), times.end()));
    }
    return kExitOk;
}

} // namespace

void addBenchSurface(CLI::App& bench, int& exitCode) {
    CLI::App* command = bench.add_subcommand(
        "surface", "One CSV line a case: extracting the mesh of 16,000 particles, of which none, a "
                   "tenth, all move; what has changed, or anew all of it");
    auto o = std::make_shared<Options>();
    command->add_option("--threads", o->threads, "Threads that take part, 1 to 64")->capture_default_str();
    command->add_option("--frames", o->frames, "Frames of each case")->capture_default_str();
    command->callback([=, &exitCode] { exitCode = benchSurface(*o); });
}

} // namespace thaw::player
