// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "reference/thesis_motion.h"

#include <doctest/doctest.h>

using reference::ThesisMotion;
using reference::Vector;

namespace {

template <class Real> ThesisMotion<Real> block(int nx, int ny, int nz, Real spacing = Real(0.01)) {
    ThesisMotion<Real> m(spacing, 2 * spacing);
    for (int z = 0; z < nz; ++z)
        for (int y = 0; y < ny; ++y)
            for (int x = 0; x < nx; ++x) {
                typename ThesisMotion<Real>::Particle p;
                p.r = {spacing * static_cast<Real>(x), spacing * static_cast<Real>(y), spacing * static_cast<Real>(z)};
                m.particles.push_back(p);
            }
    m.setMass();
    m.lower = {-100, -100, -100}, m.upper = {100, 100, 100};
    m.gravity = {};
    m.material.gas = 0, m.material.viscosity = 0;
    return m;
}

template <class Real> Vector<Real> momentum(const ThesisMotion<Real>& m) {
    Vector<Real> sum;
    for (const auto& p : m.particles) sum += m.mass() * p.v;
    return sum;
}

template <class M> auto& middle(M& m, int nx, int ny, int nz) {
    return m.particles[static_cast<size_t>((nz / 2 * ny + ny / 2) * nx + nx / 2)];
}

} // namespace

TEST_CASE_TEMPLATE("thesis 3.4: the interior of a lattice has the rest density", Real, float, double) {
    auto m = block<Real>(7, 7, 7);
    m.step(Real(1e-6));
    CHECK(middle(m, 7, 7, 7).density == doctest::Approx(1000).epsilon(1e-3));
    CHECK(m.particles.front().density < 700); // a corner lacks neighbours
}

TEST_CASE("thesis 3.35, 3.36: explicit Euler falls half a step too far") {
    auto m = block<double>(1, 1, 1);
    m.gravity = {0, -10, 0};
    for (int k = 0; k < 100; ++k) m.step(0.01);
    CHECK(m.particles[0].v.y == doctest::Approx(-10));
    CHECK(m.particles[0].r.y == doctest::Approx(-5.05)); // g t^2 / 2 + g t dt / 2
}

TEST_CASE("thesis 3.8, 3.9: pressure and viscosity keep momentum") {
    auto m = block<double>(5, 5, 5);
    m.material.gas = 50, m.material.viscosity = 2;
    uint32_t state = 1;
    for (auto& p : m.particles)
        for (double* v : {&p.v.x, &p.v.y, &p.v.z})
            state = state * 1664525u + 1013904223u, *v = static_cast<double>(state >> 8) / 16777216.0 - 0.5;
    const auto before = momentum(m);
    const auto first = m.particles[0].v;
    for (int k = 0; k < 10; ++k) m.step(1e-4);
    CHECK(length(momentum(m) - before) < 1e-12 * length(before) + 1e-15);
    CHECK(length(m.particles[0].v - first) > 1e-3);
}

TEST_CASE("thesis 3.9: with its printed sign neighbours drive each other apart") {
    const auto spread = [](bool printed) {
        auto m = block<double>(2, 1, 1);
        m.material.viscosity = 1, m.material.printedViscositySign = printed;
        m.particles[0].v = {0, 1, 0};
        m.step(1e-4);
        return length(m.particles[0].v - m.particles[1].v);
    };
    CHECK(spread(false) < 1);
    CHECK(spread(true) > 1);
}

TEST_CASE("thesis 3.14: with its printed step the strain of a shear counts steps, not time") {
    const auto strain = [](bool printed, int steps) {
        auto m = block<double>(7, 7, 7);
        m.material.elastic = 1e-9, m.material.printedStrainStep = printed;
        for (auto& p : m.particles) p.v = {2 * p.r.y, 0, 0}; // shear rate 2 / s
        for (int k = 0; k < steps; ++k) m.step(1e-3 / steps);
        return middle(m, 7, 7, 7).elastic[1];
    };
    // Half the shear rate times the time, as the spiky kernel at two spacings sees it.
    CHECK(strain(false, 1) == doctest::Approx(1e-3).epsilon(0.2));
    CHECK(strain(false, 10) == doctest::Approx(strain(false, 1)).epsilon(0.01));
    CHECK(strain(true, 10) == doctest::Approx(10 * strain(true, 1)).epsilon(0.01));
}

TEST_CASE("thesis 3.17: strain beyond the yield threshold flows away, below it stays") {
    auto m = block<double>(1, 1, 1);
    m.material.elastic = 1, m.material.yield = 0.1, m.material.decay = 10;
    const auto after = [&](double shear) {
        m.particles[0].elastic = {0, shear, 0, shear, 0, 0, 0, 0, 0};
        m.step(1e-3);
        return m.particles[0].elastic[1];
    };
    CHECK(after(0.05) == 0.05);
    const double norm = std::sqrt(2.0) * 0.2;
    CHECK(after(0.2) == doctest::Approx(0.2 - 1e-3 * 10 * (norm - 0.1) / norm * 0.2));
}

TEST_CASE("thesis 3.18: the elastic force of one strained particle makes momentum from nothing") {
    auto m = block<double>(3, 3, 3);
    m.material.elastic = 1e4;
    m.particles[0].elastic = {0.1, 0, 0, 0, 0, 0, 0, 0, 0};
    m.step(1e-5);
    CHECK(length(momentum(m)) > 1e-3 * m.mass());
}

TEST_CASE("thesis 3.10: surface tension pulls a corner inward") {
    auto m = block<double>(4, 4, 4);
    m.material.tension = 0.07;
    m.step(1e-5);
    const auto& corner = m.particles.front();
    CHECK(corner.v.x > 0);
    CHECK(corner.v.y > 0);
    CHECK(corner.v.z > 0);
}

TEST_CASE_TEMPLATE("thesis solver: a column holds at 1/2000 s and bursts at 1/60 s", Real, float, double) {
    const auto fastest = [](Real dt) {
        auto m = block<Real>(5, 10, 5);
        m.lower = {0, 0, 0}, m.upper = {Real(0.04), 10, Real(0.04)};
        m.gravity = {0, Real(-9.81), 0};
        m.material.gas = 5, m.material.viscosity = 10;
        Real most = 0;
        for (Real t = 0; t < 1; t += dt) m.step(dt);
        for (const auto& p : m.particles) most = std::max(most, length(p.v));
        return most;
    };
    CHECK(fastest(Real(1) / 1000) < Real(0.3));
    CHECK_FALSE(fastest(Real(1) / 60) < 1);
}
