// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// `thaw bench snapshot`: how long saving and going back take, and how large an image is.
#include "bench_registry.h"
#include "run.h"
#include "validate/lab.h"

#include <algorithm>
#include <chrono>
#include <iostream>

namespace thaw::player {
namespace {

double milliseconds(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

struct Case {
    const char* name;
    float temperature, youngModulus;
    int coarsest;
};
// A block of 25 spacings (15,625 particles) in the sun: wax that melts from above, all of it liquid, jelly, and 50
// spacings of coarse wax.
constexpr Case kCases[] = {
    {"melting", 300, 0, 0}, {"liquid", 360, 0, 0}, {"elastic", 300, 2e4f, 0}, {"coarse", 300, 0, 3}};

void measure(const Case& c, int threads, int frames, int rounds) {
    constexpr float kSpacing = 0.002f;
    const float edge = c.coarsest > 0 ? 0.1f : 0.05f;
    Lab lab(kSpacing, 40000, {0, -9.81f, 0}, 20, threads);
    lab.plane({0, 0, 0}, {0, 1, 0});
    thawMaterialDef m;
    thawInitMaterialDef(&m, thawMaterial_wax);
    m.youngModulus = c.youngModulus;
    lab.box(lab.material(m), {0, 0, 0}, {edge, edge, edge}, c.temperature,
            [&](thawBodyDef& d) { d.coarsestLevel = c.coarsest; });
    thawHeatSourceDef sun;
    thawInitHeatSourceDef(&sun);
    sun.type = thawHeatSource_sphere, sun.position = {0.5f * edge, edge + 0.03f, 0.5f * edge}, sun.radius = 0.01f;
    sun.temperature = 1600;
    thawHeatSourceId id;
    if (thawCreateHeatSource(lab.world(), &sun, &id) != thawResult_ok)
        throw RunError(thawWorld_GetLastError(lab.world()));
    lab.step(frames);
    const auto full = [&](thawSnapshotKind kind) { return thawWorld_GetSnapshotSize(lab.world(), kind); };
    std::vector<unsigned char> image(full(thawSnapshot_world));
    double save = 1e9, restore = 1e9;
    for (int n = 0; n < rounds; ++n) {
        save = std::min(save, milliseconds([&] {
                            thawWorld_Save(lab.world(), thawSnapshot_world, image.data(), image.size(), nullptr);
                        }));
        restore = std::min(restore, milliseconds([&] {
                               if (thawWorld_Restore(lab.world(), image.data(), image.size()) != thawResult_ok)
                                   throw RunError(thawWorld_GetLastError(lab.world()));
                           }));
    }
    const thawCounters counters = lab.counters();
    std::cout << formatted("%s,%d,%d,%zu,%.1f,%.3f,%.3f,%zu\n", c.name, counters.particles, counters.moving,
                           image.size(), static_cast<double>(image.size()) / counters.particles, save, restore,
                           full(thawSnapshot_full))
              << std::flush;
}

int run(int argc, char** argv) {
    CLI::App app("Saving a world and going back to it; times are the best of the rounds");
    int threads = defaultThreads(), frames = 60, rounds = 50;
    app.add_option("--threads", threads, "Threads that take part, 1 to 64")->capture_default_str();
    app.add_option("--frames", frames, "Frames before")->capture_default_str();
    app.add_option("--rounds", rounds, "How often it is saved and read")->capture_default_str();
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e);
    }
    std::cout << "case,particles,moving,bytes,bytes_per_particle,save_ms,restore_ms,full_bytes\n";
    for (const Case& c : kCases) measure(c, threads, frames, rounds);
    return kExitOk;
}

const BenchRegistration kSnapshot("snapshot", "Saving a world and going back to it", run);

} // namespace
} // namespace thaw::player
