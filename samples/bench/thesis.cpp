// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "args.h"
#include "bench_registry.h"
#include "reference/thesis_motion.h"
#include "report.h"
#include "validate/lab.h"

#include <chrono>
#include <cstdio>
#include <cstring>

// `thaw bench thesis`: the same block of liquid in the same tank by the thesis's solver and by thaw: largest step that
// holds, and wall time for a second of the game at the same number of particles.
namespace {

using thaw::player::Lab;
using Thesis = reference::ThesisMotion<double>;

constexpr double kSpacing = 0.004, kDensity = 1000;
constexpr int kWide = 10, kHigh = 10;

struct Outcome {
    bool holds;
    double compression, seconds; // worst density error at the end; wall time per second of the game
};

double clockSeconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// What holds keeps its particles together: after `seconds` none is faster than after a fall through the block's height,
// and none is above the block by more than two spacings.
Outcome runThesis(double viscosity, double dt, double seconds) {
    Thesis m(kSpacing, 2 * kSpacing);
    for (int z = 0; z < kWide; ++z)
        for (int y = 0; y < kHigh; ++y)
            for (int x = 0; x < kWide; ++x) {
                Thesis::Particle p;
                p.r = {kSpacing * (x + 0.5), kSpacing * (y + 0.5), kSpacing * (z + 0.5)};
                m.particles.push_back(p);
            }
    m.material.viscosity = viscosity;
    // Stiff enough for 3 % compression at the bottom: rho g H = 4 k drho, as (3.8) adds both gradients.
    m.material.gas = 9.81 * kSpacing * kHigh / (4 * 0.03);
    m.setMass();
    m.lower = {kSpacing / 2, kSpacing / 2, kSpacing / 2};
    m.upper = {kSpacing * (kWide - 0.5), 1, kSpacing * (kWide - 0.5)};
    const double height = kSpacing * kHigh, fall = std::sqrt(2 * 9.81 * height);
    const int steps = static_cast<int>(std::lround(seconds / dt));
    const double start = clockSeconds();
    Outcome out{true, 0, 0};
    for (int k = 0; k < steps; ++k) {
        m.step(dt);
        if (k % 64) continue;
        for (const auto& p : m.particles) out.holds &= p.r.y < 2 * height;
        if (!out.holds) return out;
    }
    out.seconds = (clockSeconds() - start) / seconds;
    double mean = 0;
    for (const auto& p : m.particles) {
        out.holds &= p.r.y < height + 2 * kSpacing && length(p.v) < fall;
        mean += std::max(0.0, p.density / kDensity - 1);
    }
    out.compression = mean / static_cast<double>(m.particles.size());
    return out;
}

Outcome runThaw(double viscosity, double dt, double seconds, int threads) {
    const float s = static_cast<float>(kSpacing), wide = s * kWide, high = s * kHigh;
    Lab lab(s, 4000, {0, -9.81f, 0}, 0, threads);
    lab.tank({0, 0, 0}, {wide, 1, wide});
    lab.box(lab.material(Lab::plain(static_cast<float>(kDensity), static_cast<float>(viscosity))), {0, 0, 0},
            {wide, high, wide}, Lab::kLiquid);
    const int steps = static_cast<int>(std::lround(seconds / dt));
    Outcome out{true, 0, 0};
    const double start = clockSeconds();
    for (int k = 0; k < steps; ++k) thawWorld_Step(lab.world(), static_cast<float>(dt), &lab.budget);
    out.seconds = (clockSeconds() - start) / seconds;
    const double fall = std::sqrt(2 * 9.81 * static_cast<double>(high));
    out.holds = static_cast<double>(lab.counters().maxSpeed) < fall && lab.height() < static_cast<double>(high + 2 * s);
    out.compression = static_cast<double>(lab.counters().meanCompression);
    return out;
}

int run(int argc, char** argv) {
    double seconds = 1;
    for (int k = 1; k < argc; ++k) {
        if (!std::strcmp(argv[k], "--seconds") && k + 1 < argc) {
            seconds = std::atof(argv[++k]);
        } else {
            const bool help = !std::strcmp(argv[k], "--help");
            std::fprintf(help ? stdout : stderr,
                         "usage: thesis [--seconds S]\n"
                         "A block of %d particles in a tank, by the thesis's solver as printed (explicit Euler, one\n"
                         "thread, double) and by thaw: the largest step of 1/N s that holds for S seconds of the game\n"
                         "(0.1 to 60, default 1), and the wall time that a second of the game takes with it.\n",
                         kWide * kWide * kHigh);
            return help ? 0 : 2;
        }
    }
    if (!(seconds >= 0.1 && seconds <= 60)) {
        std::fputs("thesis: --seconds is 0.1 to 60\n", stderr);
        return 2;
    }
    std::printf("viscosity_pa_s,solver,threads,largest_step_s,wall_s_per_s,mean_compression,thaw_is_faster\n");
    for (double viscosity : {0.1, 1.0, 10.0, 100.0}) {
        double step = 0;
        Outcome thesis{};
        for (int n : {60, 120, 240, 480, 960, 1920, 3840, 7680, 15360, 30720}) {
            thesis = runThesis(viscosity, 1.0 / n, seconds);
            step = 1.0 / n;
            if (thesis.holds) break;
        }
        std::printf("%g,thesis,1,%s,%.3f,%.4f,\n", viscosity,
                    thesis.holds ? thaw::player::formatted("1/%d", static_cast<int>(std::lround(1 / step))).c_str()
                                 : "none",
                    thesis.seconds, thesis.compression);
        for (int threads : {1, 2}) {
            double largest = 0;
            Outcome frame{};
            for (int n : {10, 15, 20, 30, 60}) {
                const Outcome o = runThaw(viscosity, 1.0 / n, seconds, threads);
                if (o.holds && largest == 0) largest = n;
                if (n == 60) frame = o;
            }
            std::printf("%g,thaw at 1/60,%d,%s,%.4f,%.4f,%.1f\n", viscosity, threads,
                        largest > 0 ? thaw::player::formatted("1/%d", static_cast<int>(largest)).c_str() : "none",
                        frame.seconds, frame.compression, thesis.seconds / frame.seconds);
        }
        std::fflush(stdout);
    }
    return 0;
}

const thaw::player::BenchRegistration kThesis("thesis", "The thesis's explicit solver against thaw", run);

} // namespace
