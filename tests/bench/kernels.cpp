// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "bench/kernels.h"

#include "base/kernel.h"
#include "base/memory.h"
#include "base/tasks.h"
#include "neighbors/neighbors.h"
#include "particles/particles.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <vector>

using namespace thaw;

namespace {

// Processor time of this thread: what the rest of the machine does is not counted (but its cache misses are).
double seconds() {
#if defined(CLOCK_THREAD_CPUTIME_ID)
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
#else
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
#endif
}

struct Times {
    std::vector<double> all;
    void add(double t) { all.push_back(t); }
    double best() const { return *std::min_element(all.begin(), all.end()); }
    double median() {
        std::sort(all.begin(), all.end());
        return all[all.size() / 2];
    }
};

double fmaRate() { // GFLOP/s, the best of a few short runs
    const int turns = 200000;
    double best = 0;
    for (int k = 0; k < 9; ++k) {
        double t = seconds();
        volatile float keep = benchMultiplyAdd(turns);
        (void)keep;
        t = seconds() - t;
        best = std::max(best, 160e-9 * turns / t);
    }
    return best;
}

// Figures of the cost prototype, ns a particle at 98 GFLOP/s and support 2.0 spacings: counting sort and the copying of
// three 16-byte arrays, list build, density with one coefficient a pair, cached matvec of the projected viscosity.
constexpr double kReferenceRate = 98, kReference[4] = {4.3, 55.3, 27, 20.3};

void benchCase(int wanted, float support, int repeats, double rate) {
    Allocator allocator;
    thawTaskSystem system{};
    system.workerCount = 1;
    Tasks tasks(system);
    Particles particles(allocator);
    Neighbors neighbors(allocator);
    const float dx = 0.002f;
    const int side = static_cast<int>(std::lround(std::cbrt(static_cast<double>(wanted))));
    const int layers = (wanted + side * side - 1) / (side * side);
    particles.allocate(wanted);
    uint32_t state = 9;
    auto random = [&] { // [-1, 1)
        state = state * 1664525u + 1013904223u;
        return static_cast<float>(state >> 8) * (2.0f / 16777216.0f) - 1;
    };
    int n = 0;
    for (int z = 0; z < layers; ++z)
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side && n < wanted; ++x, ++n) {
                size_t k = static_cast<size_t>(n);
                particles.position[k] = {dx * (static_cast<float>(x) + 0.1f * random()),
                                         dx * (static_cast<float>(y) + 0.1f * random()),
                                         dx * (static_cast<float>(z) + 0.1f * random()), support * dx};
                particles.velocity[k] = {random(), random(), random(), 1000 * dx * dx * dx};
                particles.id[k] = static_cast<uint32_t>(n);
            }
    particles.count = n;
    particles.pad();
    Array<float> volume(allocator), invDensity(allocator);
    Array<Vec4> out(allocator);
    const size_t rows = static_cast<size_t>(n) + Particles::kPadding;
    volume.assign(rows, dx * dx * dx), invDensity.assign(rows, 1e-3f), out.resize(rows);
    for (size_t i = static_cast<size_t>(n); i < rows; ++i) volume[i] = invDensity[i] = 0;

    Times sort, build, weigh, matvec;
    for (int k = 0; k < repeats + 2; ++k) {
        for (int i = 0; i < n; ++i) { // as far as a fast melt moves in a frame
            Vec4& x = particles.position[static_cast<size_t>(i)];
            x.x += 0.01f * dx * random(), x.y += 0.01f * dx * random(), x.z += 0.01f * dx * random();
        }
        double t0 = seconds();
        neighbors.sort(particles, tasks);
        double t1 = seconds();
        neighbors.build(particles, tasks);
        double t2 = seconds();
        neighbors.weigh(particles, volume.data(), invDensity.data(), tasks);
        double t3 = seconds();
        MatvecArgs a{particles.position.data(), particles.velocity.data(), out.data(),
                     neighbors.entries.data(),  neighbors.first.data(),    neighbors.width.data(),
                     neighbors.gradient.data()};
        benchMatvec(a, 0, neighbors.groupCount);
        double t4 = seconds();
        if (k < 2) continue; // memory and the instruction set are settled in the first ones
        sort.add(t1 - t0), build.add(t2 - t1), weigh.add(t3 - t2), matvec.add(t4 - t3);
    }
    const char* names[4] = {"sort", "list build", "weigh", "projected matvec"};
    Times* times[4] = {&sort, &build, &weigh, &matvec};
    for (int k = 0; k < 4; ++k) {
        double best = 1e9 * times[k]->best() / n, median = 1e9 * times[k]->median() / n;
        double reference = kReference[k] * kReferenceRate / rate;
        std::printf("%d,%.1f,%.1f,%s,%.1f,%.1f", n, static_cast<double>(support),
                    static_cast<double>(neighbors.meanNeighbors), names[k], best, median);
        if (support == 2)
            std::printf(",%.1f,%.2f\n", reference, best / reference);
        else
            std::printf(",,\n");
    }
    std::fflush(stdout);
}

} // namespace

int thawBenchKernels(int argc, char** argv) {
    int repeats = 15;
    std::vector<int> counts;
    for (int k = 1; k < argc; ++k) {
        if (!std::strcmp(argv[k], "--repeats") && k + 1 < argc) {
            repeats = std::atoi(argv[++k]);
        } else if (!std::strcmp(argv[k], "--particles") && k + 1 < argc) {
            counts.push_back(std::atoi(argv[++k]));
        } else {
            bool help = !std::strcmp(argv[k], "--help");
            std::fprintf(help ? stdout : stderr,
                         "usage: kernels [--particles N]... [--repeats R]\n"
                         "One core, nanoseconds of processor time a particle, best and median of R (default 15).\n"
                         "N: default 5000, 16000 and 50000. The reference is that of the cost prototype, scaled by\n"
                         "this machine's multiply-add rate to the prototype's %g GFLOP/s.\n",
                         kReferenceRate);
            return help ? 0 : 2;
        }
    }
    if (counts.empty()) counts = {5000, 16000, 50000};
    bool bad = repeats < 1 || repeats > 10000;
    for (int n : counts) bad |= n < 8 || n > 4000000;
    if (bad) {
        std::fprintf(stderr, "kernels: --particles is 8 to 4000000, --repeats 1 to 10000\n");
        return 2;
    }
    std::printf("# %s\n", benchTarget());
    std::printf("particles,support_dx,neighbors,pass,best_ns,median_ns,reference_ns,best_to_reference\n");
    for (int n : counts)
        for (float support : {2.0f, 2.2f}) {
            double rate = fmaRate();
            std::printf("# %.1f GFLOP/s\n", rate);
            benchCase(n, support, repeats, rate);
        }
    return 0;
}
