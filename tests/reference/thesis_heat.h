// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <vector>

// The heat of Chien-Kai Lo's thesis (2010), section 3.3, as he printed it, and the SPH diffusion that it takes the
// place of (3.3.1). It is what thaw's heat is measured against, and is written to be read next to the thesis: numbers
// in brackets are its equations. For a cubic lattice whose layers across x have one temperature each, so that a whole
// layer is one number; the neighbours of a particle, all of them, are within the support of two spacings.
namespace reference {

constexpr double kStefanBoltzmann = 5.670374419e-8; // sigma of (3.23), W/(m^2 K^4)

struct ThesisHeatMaterial {
    double density = 900;       // kg/m^3
    double specificHeat = 2200; // C, J/(kg K)
    double conductivity = 0.25; // W/(m K); of plain SPH
    double rate = 0;            // lambda of (3.21): the share of its heat that a particle gives away in a step
    double emissivity = 0.9;    // epsilon of (3.24)
    double adopt = 1;           // delta of (3.20)
};

// Layers of particles, `spacing` apart; those at the two ends that `held` covers keep their temperature.
struct Slab {
    ThesisHeatMaterial material;
    double spacing = 0.01;
    int held = 2;               // layers at each end: the support
    std::vector<double> heat{}; // Q of a particle of each layer, J

    double mass() const { return material.density * spacing * spacing * spacing; }
    double temperature(size_t i) const { return heat[i] / (mass() * material.specificHeat); } // (3.19)
    void setTemperature(size_t i, double T) { heat[i] = T * mass() * material.specificHeat; }
    bool free(size_t i) const {
        const size_t ends = static_cast<size_t>(held);
        return i >= ends && i + ends < heat.size();
    }

    // Calls f(layer, distance) for every neighbour of a particle in layer i.
    template <class F> void forNeighbors(size_t i, F&& f) const {
        for (int x = -2; x <= 2; ++x)
            for (int y = -2; y <= 2; ++y)
                for (int z = -2; z <= 2; ++z) {
                    const int square = x * x + y * y + z * z;
                    const int at = static_cast<int>(i) + x;
                    if (square == 0 || square >= 4 || at < 0 || at >= static_cast<int>(heat.size())) continue;
                    f(static_cast<size_t>(at), spacing * std::sqrt(static_cast<double>(square)));
                }
    }

    // Conduction of the thesis: who is warmer than a neighbour gives away lambda Q, shared out among the colder.
    void stepThesis() {
        std::vector<double> change(heat.size(), 0.0);
        for (size_t i = 0; i < heat.size(); ++i) {
            const double T = temperature(i);
            double sum = 0; // W_sum
            forNeighbors(i, [&](size_t j, double d) {
                if (T > temperature(j)) sum += mass() * (T - temperature(j)) / d; // (3.22)
            });
            if (!(sum > 0)) continue;
            forNeighbors(i, [&](size_t j, double d) {
                if (!(T > temperature(j))) return;
                const double flow = material.rate * heat[i] * mass() * (T - temperature(j)) / (d * sum); // (3.21)
                change[i] -= flow, change[j] += flow;
            });
        }
        apply(change);
    }

    // The diffusion of 3.3.1 by SPH interpolation, (3.3) on differences with the gradient of a kernel over the distance
    // (Cleary and Monaghan 1999): (2 h - r)^2 / r, normalised over the lattice.
    void stepPlain(double dt) {
        const auto weight = [&](double d) { return (2 * spacing - d) * (2 * spacing - d) / d; };
        double moment = 0; // sum of the weights x^2
        for (int x = -2; x <= 2; ++x)
            for (int y = -2; y <= 2; ++y)
                for (int z = -2; z <= 2; ++z) {
                    const int square = x * x + y * y + z * z;
                    if (square > 0 && square < 4)
                        moment += weight(spacing * std::sqrt(static_cast<double>(square))) * x * x * spacing * spacing;
                }
        const double diffusivity = material.conductivity / (material.density * material.specificHeat);
        std::vector<double> change(heat.size(), 0.0);
        for (size_t i = 0; i < heat.size(); ++i)
            forNeighbors(i, [&](size_t j, double d) {
                change[i] += dt * diffusivity * 2 / moment * weight(d) * (heat[j] - heat[i]);
            });
        apply(change);
    }

    // Dissipation from a particle at the surface in dt: with the volume where the area belongs, as printed, W m in
    // place of W.
    double emitted(double T, double air, double dt) const {
        const double volume = spacing * spacing * spacing;
        return material.emissivity * kStefanBoltzmann * volume * (std::pow(T, 4) - std::pow(air, 4)) * dt; // (3.24)
    }
    // What a particle gets from a source at a distance in dt: Q_s is proportional to T_s dt.
    double received(double source, double distance, double cosine, double dt) const {
        return material.adopt * mass() / (distance * distance) * cosine * source * dt; // (3.20)
    }
    double levelMass(int l) const { return std::pow(2.0, l) * mass(); } // (3.25), kg

private:
    void apply(const std::vector<double>& change) {
        for (size_t i = 0; i < heat.size(); ++i)
            if (free(i)) heat[i] += change[i];
    }
};

} // namespace reference
