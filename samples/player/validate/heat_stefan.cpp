// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Neumann's solution of Stefan's problem (Carslaw and Jaeger, Conduction of Heat in Solids, 11.2): a half-space at its
// melting point, or colder, whose face is put to a temperature above it.
#include "validate/heat_lab.h"
#include "validate/validate.h"

#include <algorithm>
#include <cmath>

namespace thaw::player {
namespace {

struct Problem {
    const char* name;
    Melting material;  // densities do not matter: time goes with them
    double wall, cold; // K; for one phase the start is the melting point
};
constexpr Problem kProblems[] = {
    {"water", {1000, 2.14, 0.56, 2110, 4218, 333.6e3, 273.15}, 293.15, 263.15},
    {"wax", {880, 0.24, 0.15, 2200, 2400, 190e3, 328.15}, 353.15, 298.15},
    {"dark chocolate", {1250, 0.24, 0.26, 1590, 1670, 46e3, 306.15}, 333.15, 293.15},
    {"butter", {915, 0.17, 0.17, 2100, 2100, 110e3, 307.15}, 333.15, 278.15},
    {"aluminium", {2500, 211, 94, 1080, 1180, 397e3, 933.5}, 1133.5, 733.5},
};

// The root lambda of Ste_l / (e^(l^2) erf l) - Ste_s / (nu e^(nu^2 l^2) erfc(nu l)) = l sqrt(pi): the front is at
// 2 lambda sqrt(a_l t).
double frontFactor(const Melting& m, double wall, double start) {
    const double liquid = m.cLiquid * (wall - m.point) / m.latent, solid = m.cSolid * (m.point - start) / m.latent;
    const double nu = std::sqrt((m.kLiquid / m.cLiquid) / (m.kSolid / m.cSolid));
    double low = 1e-6, high = 5;
    for (int k = 0; k < 200; ++k) {
        const double l = 0.5 * (low + high);
        const double f = liquid / (std::exp(l * l) * std::erf(l)) -
                         solid / (nu * std::exp(nu * nu * l * l) * std::erfc(nu * l)) - l * std::sqrt(kPi);
        (f > 0 ? low : high) = l;
    }
    return 0.5 * (low + high);
}

// Relative errors of the front while it goes from a depth of `from` layers to twice that. A step is `fourier` spacing^2
// / diffusivity.
struct FrontError {
    double worst, rms; // worst with its sign
};
FrontError frontError(const Problem& p, bool twoPhases, float timeScale, double fourier, int from) {
    const Melting& m = p.material;
    const double start = twoPhases ? p.cold : m.point, lambda = frontFactor(m, p.wall, start);
    const double liquid = m.kLiquid / (m.density * m.cLiquid), solid = m.kSolid / (m.density * m.cSolid);
    const double dx = std::sqrt(std::max(liquid, solid) * static_cast<double>(timeScale) / 60 / fourier);
    // The cold side is felt this far beyond the front.
    const double far = twoPhases ? 2.2 / lambda * std::sqrt(solid / liquid) : 1.3;
    const int layers = static_cast<int>(std::ceil(std::max(far, 1.3) * 2 * from));
    Bar bar(static_cast<float>(dx), 3, 9 * (layers + 8) * 2, timeScale, start);
    bar.section(stays(m), layers, start);
    bar.holdBegin(p.wall);
    constexpr int kReadings = 11;
    FrontError e{};
    for (int k = 0; k < kReadings; ++k) {
        const double depth = (1 + k / (kReadings - 1.0)) * from * dx;
        bar.run(std::pow(depth / (2 * lambda), 2) / liquid - bar.time());
        const double now = 2 * lambda * std::sqrt(liquid * bar.time());
        const double error = bar.molten() * dx / now - 1;
        if (std::abs(error) > std::abs(e.worst)) e.worst = error;
        e.rms += error * error / kReadings;
    }
    e.rms = std::sqrt(e.rms);
    return e;
}

void stefan(Findings& found, float timeScale, double fourier) {
    for (const Problem& p : kProblems)
        for (const bool two : {false, true})
            found.within(std::string(p.name) + (two ? ", two phases" : ", one phase") + ": front / theory", 1,
                         1 + frontError(p, two, timeScale, fourier, 6).worst, 0.05);
}
void stefanRealTime(Findings& found) { stefan(found, 1, 0.05); }
void stefan100(Findings& found) { stefan(found, 100, 0.5); }
void stefan5000(Findings& found) { stefan(found, 5000, 10); }

// The same times and depths with half the spacing.
void stefanFiner(Findings& found) {
    for (const Problem& p : kProblems)
        for (const bool two : {false, true}) {
            const double coarse = frontError(p, two, 100, 0.25, 5).rms, fine = frontError(p, two, 100, 1, 10).rms;
            found.atMost(std::string(p.name) + (two ? ", two phases" : ", one phase") + ": rms at half the spacing",
                         coarse, fine);
        }
}

} // namespace

CaseList stefanCases() {
    return {{"stefan-1", "melting from a hot wall, front 6 to 12 layers deep, worst; time scale 1, Fourier number 0.05",
             stefanRealTime},
            {"stefan-100", "the same at time scale 100, steps of Fourier number 0.5", stefan100},
            {"stefan-5000", "the same at time scale 5000, steps of Fourier number 10", stefan5000},
            {"stefan-finer", "the error with 10 to 20 layers instead of 5 to 10 for the same depths", stefanFiner}};
}

} // namespace thaw::player
