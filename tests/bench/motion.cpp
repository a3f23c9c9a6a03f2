// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "bench/motion.h"

#include "base/kernel.h"
#include "motion/motion.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace thaw {
namespace {

using Clock = std::chrono::steady_clock;
double nanoseconds(Clock::time_point from) {
    return std::chrono::duration<double, std::nano>(Clock::now() - from).count();
}

double median(std::vector<double> v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
}

// A pool of liquid as it comes to rest, or a cube of elastic solid that is shaken (modulus > 0, Pa), all of it in
// motion for the solver: lists, density pass and each stage of the motion, timed apart in the same frames.
void benchPool(int wanted, int threads, int frames, float viscosity, float modulus) {
    Allocator allocator;
    thawTaskSystem system{};
    system.workerCount = threads;
    Tasks tasks(system);
    Particles p(allocator);
    Neighbors neighbors(allocator);
    Motion motion(allocator);
    Bonds bonds(allocator);
    const bool soft = modulus > 0;
    const float dx = 0.004f;
    const int edge = static_cast<int>(std::lround(std::cbrt(static_cast<double>(wanted))));
    const int high = soft ? edge : 10; // spacings; 10: no sub-steps
    const int side = soft ? edge : static_cast<int>(std::lround(std::sqrt(static_cast<double>(wanted) / high)));
    p.allocate(side * side * high);
    thawMaterialDef def;
    thawInitMaterialDef(&def, thawMaterial_wax);
    def.density = 1000, def.viscosityLiquid = def.viscositySolid = viscosity;
    def.youngModulus = modulus;
    const Material material(def);
    for (int y = 0; y < high; ++y)
        for (int z = 0; z < side; ++z)
            for (int x = 0; x < side; ++x) {
                const size_t k = static_cast<size_t>(p.count++);
                const auto at = [&](int i) { return dx * (static_cast<float>(i) + 0.5f); };
                p.position[k] = {at(x), at(y), at(z), kSupport * dx};
                p.velocity[k] = {0, 0, 0, 1000 * dx * dx * dx};
                p.velocityChange[k] = {0, 0, 0, soft ? 0.0f : 1000.0f};
                p.pressure[k] = soft ? 0 : 9810 * (dx * static_cast<float>(high) - at(y));
                p.liquidFraction[k] = soft ? 0 : 1;
                p.id[k] = static_cast<uint32_t>(k);
            }
    p.moverCount = p.count;
    p.pad();
    const size_t rows = static_cast<size_t>(p.count) + Particles::kPadding;
    Array<float> volume(allocator), invDensity(allocator);
    volume.assign(rows, dx * dx * dx), invDensity.assign(rows, 1e-3f);
    for (size_t i = static_cast<size_t>(p.count); i < rows; ++i) volume[i] = invDensity[i] = 0;

    std::vector<Collider> walls(5);
    const float wide = dx * static_cast<float>(side), s = std::sqrt(0.5f);
    const Quat turns[5] = {{0, 0, 0, 1}, {0, 0, -s, s}, {0, 0, s, s}, {s, 0, 0, s}, {-s, 0, 0, s}};
    const Vec3 points[5] = {{0, 0, 0}, {0, 0, 0}, {wide, 0, 0}, {0, 0, 0}, {0, 0, wide}};
    for (size_t w = 0; w < 5; ++w) walls[w].transform = {points[w], turns[w], 1}, walls[w].alive = true;

    enum { kLists, kDensity, kForces, kViscosity, kPressure, kMove, kPasses };
    std::vector<double> times[kPasses], whole, ratio;
    double iterations = 0;
    for (int f = 0; f < frames + 60; ++f) {
        double t[kPasses];
        auto timed = [&](int pass, auto&& run) {
            const Clock::time_point start = Clock::now();
            run();
            t[pass] = nanoseconds(start) / p.count;
        };
        timed(kLists, [&] { neighbors.sort(p, tasks), neighbors.build(p, tasks); });
        timed(kDensity, [&] { neighbors.weigh(p, volume.data(), invDensity.data(), tasks); });
        const MotionFrame frame{.particles = p,
                                .neighbors = neighbors,
                                .volume = volume.data(),
                                .invDensity = invDensity.data(),
                                .materials = &material,
                                .colliders = walls.data(),
                                .colliderCount = soft ? 1 : static_cast<int>(walls.size()),
                                .tasks = tasks,
                                .dt = 1.0f / 60,
                                .subSteps = 1,
                                .gravity = {soft ? 4 * std::sin(0.3f * static_cast<float>(f)) : 0, -9.81f, 0},
                                .spacing = dx,
                                .pressureIterations = 4,
                                .viscosityIterations = 12,
                                .bonds = soft ? &bonds : nullptr};
        if (soft && f == 0) bonds.bondAll(frame.bondFrame());
        timed(kForces, [&] { motion.begin(frame), motion.forces(frame); });
        timed(kViscosity, [&] { motion.viscosity(frame); });
        timed(kPressure, [&] { motion.pressure(frame); });
        timed(kMove, [&] { motion.move(frame); });
        if (f < 60) continue;
        for (int k = 0; k < kPasses; ++k) times[k].push_back(t[k]);
        whole.push_back(t[kForces] + t[kViscosity] + t[kPressure] + t[kMove]);
        ratio.push_back(whole.back() / t[kDensity]);
        iterations += motion.stats().viscosityIterations;
    }
    std::printf("%s,%d,%d,%g,%.1f", soft ? "elastic" : "liquid", p.count, threads, static_cast<double>(viscosity),
                iterations / frames);
    for (const std::vector<double>& v : times) std::printf(",%.0f", median(v));
    std::printf(",%.0f,%.1f\n", median(whole), median(ratio));
    std::fflush(stdout);
}

} // namespace
} // namespace thaw

int thawBenchMotion(int argc, char** argv) {
    int frames = 120;
    std::vector<int> counts;
    for (int k = 1; k < argc; ++k) {
        if (!std::strcmp(argv[k], "--frames") && k + 1 < argc) {
            frames = std::atoi(argv[++k]);
        } else if (!std::strcmp(argv[k], "--particles") && k + 1 < argc) {
            counts.push_back(std::atoi(argv[++k]));
        } else {
            const bool help = !std::strcmp(argv[k], "--help");
            std::fprintf(help ? stdout : stderr,
                         "usage: motion [--particles N]... [--frames F]\n"
                         "Nanoseconds of wall clock a moving particle of each stage of the motion in a pool at rest\n"
                         "and in an elastic cube (1e5 Pa, 10 Pa s, 8000 particles or the first N) that is shaken,\n"
                         "one step of 1/60 s, 4 pressure and at most 12 viscosity iterations, medians of F frames\n"
                         "(default 120) after 60; to_density: the whole motion over the density pass of the same\n"
                         "frame. N: default 4000 and 16000. On 1 and 2 threads.\n");
            return help ? 0 : 2;
        }
    }
    const bool given = !counts.empty();
    if (!given) counts = {4000, 16000};
    bool bad = frames < 1 || frames > 100000;
    for (int n : counts) bad |= n < 160 || n > 4000000;
    if (bad) {
        std::fputs("motion: --particles is 160 to 4000000, --frames 1 to 100000\n", stderr);
        return 2;
    }
    std::printf(
        "case,particles,threads,viscosity_pa_s,cg_iterations,lists_ns,density_ns,forces_ns,viscosity_ns,pressure_ns,"
        "collision_ns,motion_ns,to_density\n");
    for (int n : counts)
        for (float viscosity : {0.1f, 10.0f})
            for (int threads : {1, 2}) thaw::benchPool(n, threads, frames, viscosity, 0);
    for (int threads : {1, 2}) thaw::benchPool(given ? counts[0] : 8000, threads, frames, 10, 1e5f);
    return 0;
}
