// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// `thaw bench splits`: elastic solids of coarse particles that split under load, against those that stay coarse and
// those that are fine from the start.
#include "bench_registry.h"
#include "run.h"
#include "validate/lab.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

namespace thaw::player {
namespace {

constexpr float kSpacing = 0.002f;

struct Load {
    const char* name;
    float modulus;
    thawVec3 gravity, lower, upper; // what it hangs on or stands on is at y = 0, or x = 0 for the beam
    thawVec3 wall;                  // its normal
};
// A column of 10 x 10 x 24 spacings that stands, one that is pulled up by three times its weight, a block with its
// weight across, and a beam.
constexpr Load kLoads[] = {
    {"stands", 2e4f, {0, -9.81f, 0}, {-0.01f, 0, -0.01f}, {0.01f, 0.048f, 0.01f}, {0, 1, 0}},
    {"stands, stiff", 2e5f, {0, -9.81f, 0}, {-0.01f, 0, -0.01f}, {0.01f, 0.048f, 0.01f}, {0, 1, 0}},
    {"hangs", 2e4f, {0, 29.4f, 0}, {-0.01f, 0, -0.01f}, {0.01f, 0.048f, 0.01f}, {0, 1, 0}},
    {"sheared", 2e4f, {9.81f, 0, 0}, {-0.02f, 0, -0.02f}, {0.02f, 0.024f, 0.02f}, {0, 1, 0}},
    {"beam", 2e5f, {0, -9.81f, 0}, {0, -0.012f, -0.012f}, {0.08f, 0.012f, 0.012f}, {1, 0, 0}},
};

struct Column {
    Lab lab;
    thawBodyId body{};
    thawVec3 began{};

    Column(const Load& l, int coarsest, int threads) : lab(kSpacing, 20000, l.gravity, 0, threads) {
        lab.plane({0, 0, 0}, l.wall);
        thawMaterialDef m = Lab::plain(1000, 1);
        m.viscositySolid = 10, m.youngModulus = l.modulus;
        m.relaxationTime = 1e9f; // does not creep, but never sleeps

        body = lab.box(lab.material(m), l.lower, l.upper, Lab::kSolid,
                       [&](thawBodyDef& d) { d.coarsestLevel = coarsest; });
        began = center();
    }
    thawVec3 center() const {
        thawBodyState s;
        thawBody_GetState(lab.world(), body, &s);
        return s.center;
    }
    // Way of the centre of mass since the body was made, m.
    double way() const {
        const thawVec3 c = center();
        return std::hypot(double(c.x - began.x), double(c.y - began.y), double(c.z - began.z));
    }
    // m/s, by mass.
    double rms() const {
        const thawParticleView v = lab.particles();
        double sum = 0, mass = 0;
        for (int i = 0; i < v.count; ++i) {
            const float* u = v.velocities + 4 * i;
            sum += double(u[3]) *
                   (double(u[0]) * double(u[0]) + double(u[1]) * double(u[1]) + double(u[2]) * double(u[2]));
            mass += double(u[3]);
        }
        return std::sqrt(sum / mass);
    }
    void paint(thawVec3 at, float radius, float absorptivity) {
        thawBrush brush{};
        brush.center = at, brush.radius = radius;
        int painted = 0;
        if (thawBody_PaintAbsorptivity(lab.world(), body, &brush, absorptivity, &painted) != thawResult_ok)
            throw RunError(thawWorld_GetLastError(lab.world()));
    }
    // What a brush touches splits, and where its parts are painted in different ways they do not merge again. Without
    // heat nothing else comes of that.
    void split(thawVec3 at, float radius) {
        paint(at, radius, 0.5f);
        const thawParticleView v = lab.particles();
        std::vector<thawVec3> every;
        for (int i = 0; i < v.count; ++i)
            if (v.levels[i] == 0 && v.ids[i] % 2 == 0)
                every.push_back({v.positions[4 * i], v.positions[4 * i + 1], v.positions[4 * i + 2]});
        for (const thawVec3& x : every) paint(x, 0.01f * kSpacing, 0.6f);
    }
};

int run(int argc, char** argv) {
    CLI::App app("Elastic solids that split under load");
    int threads = defaultThreads(), frames = 600;
    app.add_option("--threads", threads, "Threads that take part, 1 to 64")->capture_default_str();
    app.add_option("--frames", frames, "Frames before the split, and after it")->capture_default_str();
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e);
    }
    std::cout << "load,split,particles,particles_after,way_fine_mm,way_coarse_mm,way_after_mm,kick_mm_s,moving_end\n";
    for (const Load& l : kLoads) {
        Column fine(l, 0, threads);
        fine.lab.step(frames);
        const thawVec3 middle{0.5f * (l.lower.x + l.upper.x), 0.5f * (l.lower.y + l.upper.y), 0};
        const thawVec3 end{l.wall.x > 0 ? l.upper.x : 0, l.wall.x > 0 ? 0 : l.upper.y, 0};
        const float half = 0.5f * (l.wall.x > 0 ? l.upper.x - l.lower.x : l.upper.y - l.lower.y);
        const struct {
            const char* name;
            thawVec3 at;
            float radius;
            bool first; // before it bears anything
        } parts[] = {{"all", middle, 1, false},
                     {"far half", end, half, false},
                     {"a few", middle, kSpacing, false},
                     {"far half, at first", end, half, true}};
        for (const auto& part : parts) {
            Column c(l, 3, threads);
            const int before = c.lab.counters().particles;
            if (part.first) c.split(part.at, part.radius);
            c.lab.step(frames);
            const double coarse = c.way();
            double kick = 0;
            if (!part.first) {
                c.split(part.at, part.radius);
                c.lab.step(60, [&](int) { kick = std::max(kick, c.rms()); });
                c.lab.step(frames);
            }
            std::cout << formatted("%s,%s,%d,%d,%.4f,%.4f,%.4f,%.3f,%d\n", l.name, part.name, before,
                                   c.lab.counters().particles, 1e3 * fine.way(), 1e3 * coarse, 1e3 * c.way(),
                                   1e3 * kick, c.lab.counters().moving)
                      << std::flush;
        }
    }
    return kExitOk;
}

const BenchRegistration kSplits("splits", "Elastic solids whose coarse particles split under load", run);

} // namespace
} // namespace thaw::player
