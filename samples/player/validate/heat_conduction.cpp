// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Conduction against the series and similarity solutions of Carslaw and Jaeger.
#include "validate/heat_lab.h"
#include "validate/validate.h"

#include <algorithm>
#include <cmath>

namespace thaw::player {
namespace {

// What a time scale of 1, 100 and 5000 is good for: heat of a step in units of spacing^2 / diffusivity. The largest is
// seventy times what an explicit step could take.
struct Scale {
    float factor;
    double fourier;
};
constexpr Scale kScales[] = {{1, 0.05}, {100, 0.5}, {5000, 10}};
// The spacing with which a step of 1/60 s is that many Fourier numbers.
float spacingFor(const Scale& s, double diffusivity) {
    return static_cast<float>(std::sqrt(diffusivity * static_cast<double>(s.factor) / 60 / s.fourier));
}

// Slab of unit temperature whose faces are put to 0: u(x / l, Fo) and its mean.
double slabSeries(double x, double fo) {
    double u = 0;
    for (int n = 0; n < 60; ++n) {
        const double k = (2 * n + 1) * kPi;
        u += 4 / k * std::sin(k * x) * std::exp(-k * k * fo);
    }
    return u;
}
double slabMean(double fo) {
    double u = 0;
    for (int n = 0; n < 60; ++n) {
        const double k = (2 * n + 1) * kPi;
        u += 8 / (k * k) * std::exp(-k * k * fo);
    }
    return u;
}

void slab(Findings& found, const Scale& s) {
    constexpr int kLayers = 31; // odd: the centre is a layer
    constexpr double kDensity = 900, kHeat = 2200, kConductivity = 0.25;
    constexpr double kDiffusivity = kConductivity / (kDensity * kHeat), kFaces = 300, kStart = 400;
    const float dx = spacingFor(s, kDiffusivity);
    Bar bar(dx, 5, 2000, s.factor, 0.5 * (kFaces + kStart));
    bar.section(stays(kDensity, kHeat, kConductivity), kLayers, kStart);
    bar.holdBegin(kFaces), bar.holdEnd(kFaces);
    const double length = kLayers * static_cast<double>(dx);
    for (const double fo : {0.05, 0.1, 0.2}) {
        bar.run(fo * length * length / kDiffusivity - bar.time());
        const double now = kDiffusivity * bar.time() / (length * length); // in whole steps
        const std::vector<double> T = bar.temperatures();
        const auto u = [&](size_t layer) { return (T[layer] - kFaces) / (kStart - kFaces); };
        double mean = 0;
        for (int k = 0; k < kLayers; ++k) mean += u(static_cast<size_t>(k)) / kLayers;
        const std::string at = "Fo " + std::to_string(fo).substr(0, 4);
        found.within("centre, " + at, slabSeries(0.5, now), u(kLayers / 2), 0.015);
        found.within("mean, " + at, slabMean(now), mean, 0.015);
    }
}

void slabRealTime(Findings& found) { slab(found, kScales[0]); }
void slab100(Findings& found) { slab(found, kScales[1]); }
void slab5000(Findings& found) { slab(found, kScales[2]); }

// Heat capacities so that the conductive side is no more than three times as deep.
void halfSpaces(Findings& found) {
    constexpr double kDensity = 1000, kHeat = 1000, kConductivity = 0.2, kHot = 400, kCold = 300;
    for (const double ratio : {1.0, 10.0, 100.0, 1000.0}) {
        const double deeper = std::min(3.0, std::sqrt(ratio)); // sqrt of the ratio of diffusivities
        const double heat = kHeat * ratio / (deeper * deeper);
        const double a1 = kConductivity / (kDensity * kHeat), a2 = a1 * deeper * deeper;
        const float dx = spacingFor(kScales[1], a2);
        constexpr int kCover = 24; // layers of the slow side, warmed 12 deep
        const int fast = static_cast<int>(kCover * deeper);
        Bar bar(dx, 5, 4000, kScales[1].factor, kCold);
        bar.section(stays(kDensity, kHeat, kConductivity), kCover, kHot);
        bar.section(stays(kDensity * ratio > 3e4 ? 3e4 : kDensity,
                          kDensity * ratio > 3e4 ? heat * kDensity / 3e4 : heat, kConductivity * ratio),
                    fast, kCold);
        const double e1 = std::sqrt(kConductivity * kDensity * kHeat),
                     e2 = std::sqrt(kConductivity * ratio * kDensity * heat);
        const double contact = (e1 * kHot + e2 * kCold) / (e1 + e2);
        bar.run(std::pow(6 * static_cast<double>(dx), 2) / a1);
        const double t = bar.time();
        const std::vector<double> T = bar.temperatures();
        double worst = 0, passed = 0;
        for (int k = 0; k < bar.layers(); ++k) {
            const double x = (k - kCover + 0.5) * static_cast<double>(dx);
            const double exact = x < 0 ? kHot + (contact - kHot) * std::erfc(-x / (2 * std::sqrt(a1 * t)))
                                       : kCold + (contact - kCold) * std::erfc(x / (2 * std::sqrt(a2 * t)));
            worst = std::max(worst, std::abs(T[static_cast<size_t>(k)] - exact) / (kHot - kCold));
            if (x < 0) passed += (kHot - T[static_cast<size_t>(k)]) * static_cast<double>(dx) * kDensity * kHeat;
        }
        const std::string name = "ratio " + std::to_string(static_cast<int>(ratio));
        const double k1 = kConductivity, k2 = k1 * ratio, near = T[kCover - 1], far = T[kCover];
        found.within(name + ": temperature of the contact, K over cold", contact - kCold + 100,
                     (k1 * near + k2 * far) / (k1 + k2) - kCold + 100, 0.02);
        found.atMost(name + ": largest error / step of temperature", 0.02, worst);
        found.within(name + ": heat passed, J/m^2", 2 * e1 * (kHot - contact) * std::sqrt(t / kPi), passed, 0.02);
    }
}

} // namespace

CaseList conductionCases() {
    return {{"slab-1",
             "31 layers between two walls that hold the faces; time scale 1, steps of Fourier number 0.05 (series)",
             slabRealTime},
            {"slab-100", "the same at time scale 100, steps of Fourier number 0.5", slab100},
            {"slab-5000", "the same at time scale 5000, steps of Fourier number 10", slab5000},
            {"half-spaces", "hot against cold, conductivity ratio 1 to 1000: temperature between the effusivities",
             halfSpaces}};
}

} // namespace thaw::player
