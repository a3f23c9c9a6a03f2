// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "bench/kicks.h"

#include "base/kernel.h"
#include "world/world.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <vector>

namespace thaw {
namespace {

constexpr int kEdge = 10;      // particles
constexpr int kSettle = 300;   // steps before an event
constexpr int kWatched = 30;   // and after it
constexpr uint32_t kTurns = 8; // a row is looked at in steps that equal its id modulo this (levels/liquids.cpp)
constexpr uint32_t kIds = 1u << 20;

struct Row {
    Vec3 place, velocity;
    float support, volume;
};
using Rows = std::map<uint32_t, Row>; // by id

// Ten particles a side of one level in a vessel, at rest.
struct Pool {
    World world;
    thawBudget budget;
    uint32_t steps = 0;
    float spacing; // of the particles

    static thawWorldDef definition(float dx) {
        thawWorldDef d;
        thawInitWorldDef(&d);
        d.particleSpacing = dx, d.maxParticles = 4 * kEdge * kEdge * kEdge, d.thermalTimeScale = 0;
        d.tasks.workerCount = 1;
        return d;
    }
    Pool(float dx, int level, float viscosity) : world(definition(supportOf(dx, level) / kSupport)) {
        spacing = world.def.particleSpacing;
        thawInitBudget(&budget);
        thawMaterialDef m;
        thawInitMaterialDef(&m, thawMaterial_wax);
        m.viscosityLiquid = viscosity, m.cohesion = m.adhesion = 0;
        world.materials.emplace_back(m);
        const float side = spacing * kEdge;
        std::string message;
        thawMeshReport report;
        uint32_t index;
        const float s = std::sqrt(0.5f);
        const thawQuat turns[5] = {{0, 0, 0, 1}, {0, 0, -s, s}, {0, 0, s, s}, {s, 0, 0, s}, {-s, 0, 0, s}};
        const thawVec3 points[5] = {{0, 0, 0}, {0, 0, 0}, {side, 0, 0}, {0, 0, 0}, {0, 0, side}};
        for (int w = 0; w < 5; ++w) {
            thawColliderDef c;
            thawInitColliderDef(&c, thawCollider_plane);
            c.position = points[w], c.rotation = turns[w];
            require(world.addCollider(c, report, message, index), message);
        }
        std::vector<float> vertices;
        for (int k = 0; k < 8; ++k)
            for (int a = 0; a < 3; ++a) vertices.push_back(k >> a & 1 ? side : 0);
        const uint32_t indices[] = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                    2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
        thawBodyDef b;
        thawInitBodyDef(&b);
        b.material.index1 = 1, b.mesh = {vertices.data(), 8, indices, 12}, b.temperature = m.liquidus + 10;
        require(world.addBody(b, report, message, index), message);
        // Filled as the finest of their own spacing, they are of that level in a world that has finer ones.
        world.def.particleSpacing = dx;
        for (int i = 0; i < world.particles.count; ++i)
            world.particles.level[static_cast<size_t>(i)] = static_cast<uint8_t>(level);
        budget.work.finestLevel = level;
        run(kSettle);
    }
    static void require(thawResult r, const std::string& message) {
        if (r == thawResult_ok) return;
        std::fprintf(stderr, "kicks: %s\n", message.c_str());
        std::exit(1);
    }
    void run(int n) {
        for (int k = 0; k < n; ++k) world.step(1.0f / 60, budget), ++steps;
    }
    Rows rows() const {
        Rows out;
        const Particles& p = world.particles;
        for (size_t i = 0; i < static_cast<size_t>(p.count); ++i)
            out[p.id[i]] = {p.position[i].xyz(), p.velocity[i].xyz(), p.position[i].w,
                            p.velocity[i].w / world.materials[p.material[i]].def.density};
        return out;
    }
    // Nothing splits or merges from now on.
    void hold() { budget.work.finestLevel = 0, budget.work.splits = 0; }
    // One step at the end of which those rows, and no others, split (finest 0) or merge (finest 1).
    void event(const std::vector<uint32_t>& chosen, int finest) {
        Particles& p = world.particles;
        const uint32_t turn = steps % kTurns;
        for (size_t i = 0; i < static_cast<size_t>(p.count); ++i) {
            const bool is = std::find(chosen.begin(), chosen.end(), p.id[i]) != chosen.end();
            p.id[i] = kIds + kTurns * p.id[i] + (is ? turn : (turn + 1) % kTurns);
        }
        budget.work.finestLevel = finest, budget.work.splits = static_cast<int>(chosen.size());
        run(1);
        hold();
    }
    // At least two spacings from walls and surface.
    std::vector<uint32_t> interior() const {
        std::vector<uint32_t> ids;
        const float low = 2 * spacing, high = (kEdge - 2) * spacing;
        for (const auto& [id, r] : rows()) {
            const auto in = [&](float v) { return v > low && v < high; };
            if (in(r.place.x) && in(r.place.y) && in(r.place.z)) ids.push_back(id);
        }
        return ids;
    }
};

uint32_t original(uint32_t id) { return (id - kIds) / kTurns; }
bool renamed(uint32_t id) { return id >= kIds; }

// Share of its support that is filled by all rows, 1 in the lattice.
double density(const Rows& rows, const Row& at) {
    double sum = 0;
    for (const auto& [id, r] : rows) {
        const float h = 0.5f * (r.support + at.support), q = length(r.place - at.place) / h;
        if (q >= 1) continue;
        const double u = 1 - static_cast<double>(q);
        sum += static_cast<double>(r.volume) * u * u * u * u * (1 + 4 * static_cast<double>(q)) /
               (static_cast<double>(h) * h * h);
    }
    return sum;
}

struct Peaks {                             // of one event
    double made = 0, beside = 0, near = 0; // m/s: what it made, all others, mean within 2 h by particles
    double madeDensity = 0, besideDensity = 0, nearDensity = 0; // relative; the last: mean of amounts within 2 h
};

// What the event at `place` made of the pool against the same pool without it.
Peaks watch(Pool& pool, const std::vector<Rows>& reference, Vec3 place, uint32_t parent) {
    Peaks out;
    const double full = density(reference[0], reference[0].at(parent));
    for (int f = 0; f <= kWatched; ++f) {
        if (f > 0) pool.run(1);
        const Rows now = pool.rows();
        const Rows& then = reference[static_cast<size_t>(f)];
        double sum = 0, change = 0;
        int n = 0;
        for (const auto& [id, r] : now) {
            const bool made = !renamed(id) || original(id) == parent;
            const Row& old = then.at(renamed(id) ? original(id) : parent);
            const double kick = static_cast<double>(length(r.velocity - old.velocity));
            if (f > 0) (made ? out.made : out.beside) = std::max(made ? out.made : out.beside, kick);
            if (length(old.place - place) > 2 * old.support) continue;
            sum += kick, ++n;
            const double off = (density(now, r) - density(then, old)) / full;
            change += std::abs(off);
            if (f == 0)
                (made ? out.madeDensity : out.besideDensity) =
                    std::max(made ? out.madeDensity : out.besideDensity, off);
        }
        if (f > 0) out.near = std::max(out.near, sum / n);
        out.nearDensity = std::max(out.nearDensity, change / n);
    }
    return out;
}

void benchKicks(float dx, bool merges, float viscosity, int events) {
    const int level = merges ? 0 : 1;
    // The pool without an event.
    Pool quiet(dx, level, viscosity);
    const std::vector<uint32_t> places = quiet.interior();
    quiet.hold();
    std::vector<Rows> reference;
    quiet.run(1), reference.push_back(quiet.rows());
    for (int f = 0; f < kWatched; ++f) quiet.run(1), reference.push_back(quiet.rows());
    Peaks mean, most;
    const auto each = [](Peaks& to, const Peaks& from, auto&& f) {
        for (double Peaks::*m : {&Peaks::made, &Peaks::beside, &Peaks::near, &Peaks::madeDensity, &Peaks::besideDensity,
                                 &Peaks::nearDensity})
            f(to.*m, from.*m);
    };
    for (int k = 0; k < events; ++k) {
        const size_t at = (places.size() * static_cast<size_t>(2 * k + 1)) / static_cast<size_t>(2 * events);
        const uint32_t parent = places[at];
        Pool pool(dx, level, viscosity);
        const int before = pool.world.particles.count;
        pool.event({parent}, merges ? 1 : 0);
        if (pool.world.particles.count != before + (merges ? -1 : 1)) {
            std::fprintf(stderr, "kicks: %d particles became %d in one event\n", before, pool.world.particles.count);
            std::exit(1);
        }
        const Peaks p = watch(pool, reference, reference[0].at(parent).place, parent);
        each(mean, p, [&](double& to, double from) { to += from / events; });
        each(most, p, [](double& to, double from) { to = std::max(to, from); });
    }
    std::printf("%s,%g,%g,%d,%.2f,%.2f,%.2f,%.2f,%.3f,%.2f,%.2f,%.2f\n", merges ? "merge" : "split",
                1e3 * static_cast<double>(dx), static_cast<double>(viscosity), events, 1e3 * mean.made, 1e3 * most.made,
                1e3 * mean.beside, 1e3 * most.beside, 1e3 * mean.near, 100 * mean.madeDensity, 100 * mean.besideDensity,
                100 * mean.nearDensity);
    std::fflush(stdout);
}

// All that the steps want, as many at once as they take: the pool turns into one of the other level.
void benchAll(float dx, bool merges, float viscosity) {
    Pool pool(dx, merges ? 0 : 1, viscosity);
    pool.budget.work.finestLevel = merges ? 1 : 0;
    double fastest = 0, rms = 0, compression = 0;
    int frames = 0, last = 0;
    for (; frames < 1800 && frames - last < 60; ++frames) {
        pool.run(1);
        const thawCounters c = pool.world.counters();
        if (c.splits + c.merges > 0) last = frames;
        double sum = 0, mass = 0;
        for (const auto& [id, r] : pool.rows()) {
            const double v = static_cast<double>(length(r.velocity)), m = static_cast<double>(r.volume);
            fastest = std::max(fastest, v), sum += m * v * v, mass += m;
        }
        rms = std::max(rms, std::sqrt(sum / mass)),
        compression = std::max(compression, static_cast<double>(c.meanCompression));
    }
    std::printf("%s,%g,%g,%d,%d,%.2f,%.2f,%.2f\n", merges ? "merge" : "split", 1e3 * static_cast<double>(dx),
                static_cast<double>(viscosity), pool.world.particles.count, last + 1, 1e3 * rms, 1e3 * fastest,
                100 * compression);
    std::fflush(stdout);
}

} // namespace
} // namespace thaw

int thawBenchKicks(int argc, char** argv) {
    int events = 12;
    double viscosity = 1;
    for (int k = 1; k < argc; ++k) {
        if (!std::strcmp(argv[k], "--events") && k + 1 < argc) {
            events = std::atoi(argv[++k]);
        } else if (!std::strcmp(argv[k], "--viscosity") && k + 1 < argc) {
            viscosity = std::atof(argv[++k]);
        } else {
            const bool help = !std::strcmp(argv[k], "--help");
            std::fprintf(
                help ? stdout : stderr,
                "usage: kicks [--events N] [--viscosity MU]\n"
                "What one split or merge does to a pool at rest of ten particles a side, N times (default 12)\n"
                "in its inside, MU Pa s (default 1), against the same pool without it, over 30 frames of\n"
                "1/60 s. made: peak of the velocity that the new particles get, mean and largest of the N;\n"
                "beside: the same of all others; near: peak of the mean over all within two supports. Density:\n"
                "what it jumps by at the worst of the new ones and of the others, mean of N, and the peak of\n"
                "the mean amount within two supports. dx is the spacing of level 0; it splits level 1. Then\n"
                "the whole pool at once, as fast as steps do it: speeds and mean compression at the worst.\n");
            return help ? 0 : 2;
        }
    }
    if (events < 1 || events > 100 || !(viscosity >= 0.01 && viscosity <= 1000)) {
        std::fputs("kicks: --events is 1 to 100, --viscosity 0.01 to 1000\n", stderr);
        return 2;
    }
    std::printf("event,dx_mm,viscosity,events,made_mm_s,made_most,beside_mm_s,beside_most,near_mm_s,made_density_%%,"
                "beside_density_%%,near_density_%%\n");
    for (const float dx : {0.002f, 0.004f})
        for (const bool merges : {false, true}) thaw::benchKicks(dx, merges, static_cast<float>(viscosity), events);
    std::printf("all_at_once,dx_mm,viscosity,particles_then,frames,rms_mm_s,fastest_mm_s,compression_%%\n");
    for (const float dx : {0.002f, 0.004f})
        for (const bool merges : {false, true}) thaw::benchAll(dx, merges, static_cast<float>(viscosity));
    return 0;
}
