// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "validate/lab.h"
#include "validate/validate.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace thaw::player {
namespace {

constexpr float kMillimetre = 1e-3f;

// A tank of 8 x 8 spacings filled 0.3 m high, at rest; what is read after the first two seconds.
void column(Findings& found, float viscosity, float seconds, double meanLimit, double maxLimit, bool height) {
    Lab lab(4 * kMillimetre, 6000);
    const float side = 8 * lab.spacing();
    lab.tank({0, 0, 0}, {side, 1, side});
    lab.box(lab.material(Lab::plain(1000, viscosity)), {0, 0, 0}, {side, 0.3f, side}, Lab::kLiquid);
    double mean = 0, most = 0, low = INFINITY, high = -INFINITY;
    lab.step(static_cast<int>(60 * seconds), [&](int frame) {
        const thawCounters c = lab.counters();
        if (frame <= 120) return;
        mean = std::max(mean, static_cast<double>(c.meanCompression));
        most = std::max(most, static_cast<double>(c.maxCompression));
        low = std::min(low, lab.height()), high = std::max(high, lab.height());
    });
    found.atMost("density error, mean", meanLimit, mean);
    found.atMost("density error, largest", maxLimit, most);
    if (!height) return;
    found.within("height, lowest, m", 0.3, low, 0.01);
    found.within("height, highest, m", 0.3, high, 0.01);
}

void waterColumn(Findings& found) { column(found, 1e-3f, 20, 0.01, 0.03, true); }
void honeyColumn(Findings& found) { column(found, 10, 20, 0.01, 0.03, true); }
void thinColumn(Findings& found) { column(found, 0.1f, 20, 0.01, 0.05, false); }
void stiffColumn(Findings& found) { column(found, 1e6f, 5, 0.01, 0.03, true); }

// Radius within which 99 % of the particles lie, plus half a spacing.
double spread(const Lab& lab) {
    const thawParticleView p = lab.particles();
    std::vector<double> r;
    double x = 0, z = 0;
    for (int i = 0; i < p.count; ++i)
        x += static_cast<double>(p.positions[4 * i]), z += static_cast<double>(p.positions[4 * i + 2]);
    for (int i = 0; i < p.count; ++i)
        r.push_back(std::hypot(static_cast<double>(p.positions[4 * i]) - x / p.count,
                               static_cast<double>(p.positions[4 * i + 2]) - z / p.count));
    const size_t n = r.size() * 99 / 100;
    std::nth_element(r.begin(), r.begin() + static_cast<std::ptrdiff_t>(n), r.end());
    return r[n] + 0.5 * static_cast<double>(lab.spacing());
}

// Huppert (1982): a constant volume on a floor without slip, inertia and surface tension nothing.
void puddle(Findings& found) {
    constexpr double kViscosity = 100, kDensity = 1000, kGravity = 9.81, kRadius = 0.03, kHeight = 0.02;
    Lab lab(2 * kMillimetre, 12000);
    lab.floor();
    scene::TriMesh mesh = scene::makeCylinder(static_cast<float>(kRadius), static_cast<float>(kHeight));
    lab.body(lab.material(Lab::plain(static_cast<float>(kDensity), static_cast<float>(kViscosity))), mesh,
             {0, 0.5f * static_cast<float>(kHeight), 0}, Lab::kLiquid);
    const thawParticleView p = lab.particles();
    double mass = 0;
    for (int i = 0; i < p.count; ++i) mass += static_cast<double>(p.velocities[4 * i + 3]);
    const double V = mass / kDensity, nu = kViscosity / kDensity;
    const auto theory = [&](double t) {
        return 0.894 * std::pow(kGravity * V * V * V / (3 * nu), 0.125) * std::pow(t, 0.125);
    };
    lab.step(600, [&](int frame) {
        for (const int at : {60, 120, 300, 600})
            if (frame == at)
                found.within("radius after " + std::to_string(at / 60) + " s, m", theory(frame / 60.0), spread(lab),
                             0.1);
    });
}

void spinningBlob(Findings& found) {
    Lab lab(0.004f, 4000, {0, 0, 0});
    thawMaterialDef m = Lab::plain(1000, 1);
    m.cohesion = 6;
    lab.body(lab.material(m), scene::makeSphere(0.02f), {0, 0, 0}, Lab::kLiquid, [](thawBodyDef& d) {
        d.velocity = {0.1f, 0.05f, 0};
        d.angularVelocity = {0, 0, 3};
    });
    const Momentum before = momentumOf(lab.particles());
    lab.step(600);
    const Momentum after = momentumOf(lab.particles());
    double p[3], l[3];
    for (int k = 0; k < 3; ++k) p[k] = after.p[k] - before.p[k], l[k] = after.l[k] - before.l[k];
    found.atMost("linear momentum, change / whole", 1e-5, lengthOf(p) / lengthOf(before.p));
    found.atMost("angular momentum, change / whole", 1e-2, lengthOf(l) / lengthOf(before.l));
}

// Places of all particles, by id, after `seconds` of a cylinder that slumps on a floor.
std::vector<double> slump(const thawWork& work, double seconds) {
    Lab lab(4 * kMillimetre, 2000);
    lab.budget.work = work;
    lab.floor();
    lab.body(lab.material(Lab::plain(1000, 20)), scene::makeCylinder(0.02f, 0.04f), {0, 0.02f, 0}, Lab::kLiquid);
    lab.step(static_cast<int>(std::lround(60 * seconds)));
    const thawParticleView p = lab.particles();
    std::vector<size_t> order(static_cast<size_t>(p.count));
    std::iota(order.begin(), order.end(), size_t{0});
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return p.ids[a] < p.ids[b]; });
    std::vector<double> at;
    for (const size_t i : order)
        for (size_t k = 0; k < 3; ++k) at.push_back(static_cast<double>(p.positions[4 * i + k]));
    return at;
}

// More sub-steps come nearer to what very many give; more iterations to what very many give with the same sub-steps.
void convergence(Findings& found) {
    constexpr double kSeconds = 0.25;
    const auto error = [&](const std::vector<double>& reference, const thawWork& work) {
        const std::vector<double> x = slump(work, kSeconds);
        double sum = 0;
        for (size_t k = 0; k < x.size(); ++k) sum += (x[k] - reference[k]) * (x[k] - reference[k]);
        return std::sqrt(3 * sum / static_cast<double>(x.size())) / static_cast<double>(4 * kMillimetre);
    };
    const std::vector<double> manySteps = slump({16, 32, 200, 1, 1, 16, 80, 16, 0, 3, 2048, 0, 0}, kSeconds);
    double last = 1;
    for (const int steps : {1, 2, 4}) {
        const double now = error(manySteps, {steps, 8, 100, 1, 1, steps, 80, 16, 0, 3, 2048, 0, 0});
        found.atMost(std::to_string(steps) + " sub-steps: off the reference, spacings", last, now);
        last = now;
    }
    const std::vector<double> manyIterations = slump({1, 8, 200, 1, 1, 1, 80, 16, 0, 3, 2048, 0, 0}, kSeconds);
    last = 1;
    for (const int iterations : {3, 6, 12, 24}) {
        const double now = error(manyIterations, {1, 8, iterations, 1, 1, 1, 80, 16, 0, 3, 2048, 0, 0});
        found.atMost(std::to_string(iterations) + " viscosity iterations: off very many, spacings", last, now);
        last = now;
    }
}

} // namespace

CaseList liquidCases() {
    return {{"column-water", "0.3 m of 1 mPa s at 4 mm, 20 s at rest", waterColumn},
            {"column-honey", "0.3 m of 10 Pa s at 4 mm, 20 s at rest", honeyColumn},
            {"column-thin", "0.3 m of 0.1 Pa s at 4 mm, 20 s at rest", thinColumn},
            {"column-stiff", "0.3 m of 1e6 Pa s at 4 mm, 5 s at rest", stiffColumn},
            {"puddle", "constant volume of 100 Pa s on a floor, 1 to 10 s (Huppert 1982)", puddle},
            {"spinning-blob", "sphere of 1 Pa s, r 20 mm at 4 mm, drifts and spins freely for 10 s", spinningBlob},
            {"convergence", "a cylinder of 20 Pa s slumps for 0.25 s; reference: 16 sub-steps, 32 and 200 iterations",
             convergence}};
}

} // namespace thaw::player
