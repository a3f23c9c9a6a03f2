// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

// The motion of Chien-Kai Lo's thesis (2010), sections 3.2 and 3.6, as he printed it: explicit Euler, one thread, one
// particle size. It is what thaw is measured against, and is written to be read next to the thesis: numbers in brackets
// are its equations. Kernels: Mueller, Charypar, Gross 2003, which it cites. A grid takes the place of its k-d tree.
//
// (3.10) as printed is no force: it lacks the two volumes that (3.8) and (3.9) have, and with their Laplacian, which is
// positive everywhere, it blows surfaces apart; here it has the volumes and the kernel of its source.
// Two more things cannot be meant, and are options here (default: what is meant):
//   (3.9) has a minus, with which neighbours push each other's velocities apart;
//   (3.14) puts the time step on the wrong side, so that the strain of a step does not depend on its length.
namespace reference {

template <class Real> struct Vector {
    Real x = 0, y = 0, z = 0;
    friend Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Vector operator*(Real s, Vector a) { return {s * a.x, s * a.y, s * a.z}; }
    Vector& operator+=(Vector b) { return *this = *this + b; }
    friend Real dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    friend Real length(Vector a) { return std::sqrt(dot(a, a)); }
};

template <class Real> using Tensor = std::array<Real, 9>; // by rows

template <class Real> struct ThesisMaterial {
    Real restDensity = 1000; // rho_0, kg/m^3
    Real gas = 100;          // k of (3.5), m^2/s^2
    Real viscosity = 1;      // mu, Pa s
    Real tension = 0;        // sigma of (3.10)
    Real edge = 0;           // delta of (3.10)
    Real elastic = 0;        // kappa of (3.18), Pa
    Real yield = 1e30f;      // gamma of (3.17), strain
    Real decay = 0;          // xi of (3.17), 1/s
    bool printedViscositySign = false, printedStrainStep = false;
};

template <class Real> class ThesisMotion {
public:
    using V = Vector<Real>;
    struct Particle {
        V r, v, force;
        Real density = 0, pressure = 0;
        V colour; // n of (3.10), gradient of the colour field
        bool fixed = false;
        Tensor<Real> elastic{}; // strain
    };
    std::vector<Particle> particles;
    ThesisMaterial<Real> material;
    V gravity{0, Real(-9.81), 0};
    V lower{-1, 0, -1}, upper{1, 10, 1}; // the inside of a box

    ThesisMotion(Real spacing, Real support)
        : mass_(0), spacing_(spacing), h_(support), poly6_(315 / (64 * kPi * std::pow(support, Real(9)))),
          spiky_(45 / (kPi * std::pow(support, Real(6)))) {}
    Real mass() const { return mass_; }

    // Gives every particle the mass with which the interior of a lattice has the rest density. Call once, when the
    // particles are there.
    void setMass() {
        Real sum = 0;
        const int n = static_cast<int>(std::ceil(h_ / spacing_));
        for (int x = -n; x <= n; ++x)
            for (int y = -n; y <= n; ++y)
                for (int z = -n; z <= n; ++z)
                    sum += poly6(spacing_ * spacing_ * static_cast<Real>(x * x + y * y + z * z));
        mass_ = material.restDensity / sum;
    }

    void step(Real dt) {
        findNeighbors();
        densities();
        if (material.elastic > 0) strains(dt);
        forces();
        for (Particle& p : particles) {
            if (p.fixed) continue;
            p.v += (dt / mass_) * p.force; // (3.35)
            p.r += dt * p.v;               // (3.36)
            collide(p);
        }
    }

private:
    static constexpr Real kPi = Real(3.14159265358979323846);

    Real poly6(Real r2) const {
        const Real d = h_ * h_ - r2;
        return d > 0 ? poly6_ * d * d * d : 0;
    }
    V spikyGradient(V r) const {
        const Real l = length(r);
        if (!(l > 0) || l >= h_) return {};
        return -spiky_ * (h_ - l) * (h_ - l) / l * r;
    }
    Real poly6Laplacian(Real r2) const {
        const Real d = h_ * h_ - r2;
        return d > 0 ? -6 * poly6_ * d * (3 * h_ * h_ - 7 * r2) : 0;
    }
    Real laplacian(Real l) const { return l < h_ ? spiky_ * (h_ - l) : 0; }

    template <class F> void forPairsOf(size_t i, F&& f) const {
        for (uint32_t k = first_[i]; k < first_[i + 1]; ++k) f(particles[neighbor_[k]]);
    }

    void findNeighbors() {
        // Cells of one support; the grid spans the particles.
        V low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
        for (const Particle& p : particles) {
            low = {std::min(low.x, p.r.x), std::min(low.y, p.r.y), std::min(low.z, p.r.z)};
            high = {std::max(high.x, p.r.x), std::max(high.y, p.r.y), std::max(high.z, p.r.z)};
        }
        const auto cells = [&](Real extent) { return 1 + static_cast<int>(std::min(extent / h_, Real(1000))); };
        const int nx = cells(high.x - low.x), ny = cells(high.y - low.y), nz = cells(high.z - low.z);
        const auto cell = [&](Real x, int n) { return std::clamp(static_cast<int>(x / h_), 0, n - 1); };
        std::vector<uint32_t> start(static_cast<size_t>(nx) * static_cast<size_t>(ny) * static_cast<size_t>(nz) + 1);
        const auto at = [&](int x, int y, int z) { return static_cast<size_t>((z * ny + y) * nx + x); };
        std::vector<size_t> of(particles.size());
        for (size_t i = 0; i < particles.size(); ++i) {
            const V d = particles[i].r - low;
            ++start[1 + (of[i] = at(cell(d.x, nx), cell(d.y, ny), cell(d.z, nz)))];
        }
        for (size_t c = 1; c < start.size(); ++c) start[c] += start[c - 1];
        std::vector<uint32_t> order(particles.size()), next(start.begin(), start.end() - 1);
        for (size_t i = 0; i < particles.size(); ++i) order[next[of[i]]++] = static_cast<uint32_t>(i);

        first_.assign(1, 0), neighbor_.clear();
        for (const Particle& p : particles) {
            const V d = p.r - low;
            const int cx = cell(d.x, nx), cy = cell(d.y, ny), cz = cell(d.z, nz);
            for (int z = std::max(0, cz - 1); z <= std::min(nz - 1, cz + 1); ++z)
                for (int y = std::max(0, cy - 1); y <= std::min(ny - 1, cy + 1); ++y)
                    for (int x = std::max(0, cx - 1); x <= std::min(nx - 1, cx + 1); ++x)
                        for (uint32_t k = start[at(x, y, z)]; k < start[at(x, y, z) + 1]; ++k) {
                            const V e = particles[order[k]].r - p.r;
                            if (&particles[order[k]] != &p && dot(e, e) < h_ * h_) neighbor_.push_back(order[k]);
                        }
            first_.push_back(static_cast<uint32_t>(neighbor_.size()));
        }
    }

    void densities() {
        for (size_t i = 0; i < particles.size(); ++i) {
            Particle& p = particles[i];
            Real rho = mass_ * poly6(0);
            forPairsOf(i, [&](const Particle& q) { rho += mass_ * poly6(dot(p.r - q.r, p.r - q.r)); }); // (3.4)
            p.density = rho;
            p.pressure = material.gas * (rho - material.restDensity); // (3.5)
        }
        if (material.tension == 0) return;
        for (size_t i = 0; i < particles.size(); ++i) {
            Particle& p = particles[i];
            p.colour = {};
            forPairsOf(i, [&](const Particle& q) { p.colour += (mass_ / q.density) * spikyGradient(p.r - q.r); });
        }
    }

    void strains(Real dt) {
        for (size_t i = 0; i < particles.size(); ++i) {
            Particle& p = particles[i];
            Tensor<Real> slope{};
            forPairsOf(i, [&](const Particle& q) { // (3.15)
                const V g = (mass_ / q.density) * spikyGradient(p.r - q.r), d = q.v - p.v;
                const Real a[3] = {d.x, d.y, d.z}, b[3] = {g.x, g.y, g.z};
                for (int r = 0; r < 3; ++r)
                    for (int c = 0; c < 3; ++c) slope[static_cast<size_t>(3 * r + c)] += a[r] * b[c];
            });
            Real trace = 0;
            for (size_t k = 0; k < 9; k += 4) trace += p.elastic[k];
            Tensor<Real> deviation = p.elastic; // (3.16)
            for (size_t k = 0; k < 9; k += 4) deviation[k] -= trace / 3;
            Real norm = 0;
            for (Real d : deviation) norm += d * d;
            norm = std::sqrt(norm);
            const Real flow = norm > material.yield ? material.decay * (norm - material.yield) / norm : 0; // (3.17)
            const Real total = material.printedStrainStep ? Real(1) : dt;                                  // (3.14)
            for (size_t r = 0; r < 3; ++r)
                for (size_t c = 0; c < 3; ++c)
                    p.elastic[3 * r + c] += total * (slope[3 * r + c] + slope[3 * c + r]) / 2 // (3.12), (3.14)
                                            - dt * flow * deviation[3 * r + c];               // (3.13)
        }
    }

    void forces() {
        const Real sign = material.printedViscositySign ? Real(-1) : Real(1);
        for (size_t i = 0; i < particles.size(); ++i) {
            Particle& p = particles[i];
            p.force = mass_ * gravity;
            const Real own = length(p.colour);
            forPairsOf(i, [&](const Particle& q) {
                const V r = p.r - q.r, gradient = spikyGradient(r) + spikyGradient(r); // h_i and h_j are equal
                const Real volumes = mass_ * mass_ / (p.density * q.density), lap = laplacian(length(r));
                p.force += -volumes * (p.pressure + q.pressure) * gradient;             // (3.8)
                p.force += sign * volumes * 2 * material.viscosity * lap * (q.v - p.v); // (3.9)
                if (material.elastic > 0) {                                             // (3.18)
                    const Tensor<Real>& e = p.elastic;
                    const V pull{e[0] * gradient.x + e[1] * gradient.y + e[2] * gradient.z,
                                 e[3] * gradient.x + e[4] * gradient.y + e[5] * gradient.z,
                                 e[6] * gradient.x + e[7] * gradient.y + e[8] * gradient.z};
                    p.force += volumes * material.elastic * pull;
                }
                if (material.tension > 0) { // (3.10)
                    const Real other = length(q.colour);
                    const V n = volumes * spikyGradient(r);
                    if (length(n) >= material.edge && own > 0 && other > 0)
                        p.force += (-material.tension / 2 * volumes * poly6Laplacian(dot(r, r))) *
                                   ((1 / own) * p.colour + (1 / other) * q.colour);
                }
            });
        }
    }

    void collide(Particle& p) const {
        const auto axis = [](Real& x, Real& v, Real low, Real high) {
            if (x < low) x = low, v = std::max(v, Real(0));
            if (x > high) x = high, v = std::min(v, Real(0));
        };
        axis(p.r.x, p.v.x, lower.x, upper.x), axis(p.r.y, p.v.y, lower.y, upper.y),
            axis(p.r.z, p.v.z, lower.z, upper.z);
    }

    Real mass_, spacing_, h_, poly6_, spiky_;
    std::vector<uint32_t> first_{0}, neighbor_;
};

} // namespace reference
