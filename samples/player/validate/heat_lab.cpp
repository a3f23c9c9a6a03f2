// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "validate/heat_lab.h"

#include <cmath>

namespace thaw::player {

thawMaterialDef stays(const Melting& m) {
    thawMaterialDef d;
    thawInitMaterialDef(&d, thawMaterial_wax);
    d.density = static_cast<float>(m.density);
    d.specificHeatSolid = static_cast<float>(m.cSolid), d.specificHeatLiquid = static_cast<float>(m.cLiquid);
    d.conductivitySolid = static_cast<float>(m.kSolid), d.conductivityLiquid = static_cast<float>(m.kLiquid);
    d.latentHeat = static_cast<float>(m.latent);
    d.solidus = d.liquidus = static_cast<float>(m.point);
    d.absorptivity = d.emissivity = 0;
    d.cohesion = d.adhesion = 0;
    d.setFraction = d.releaseFraction = 1; // no liquid fraction is above it
    return d;
}

thawMaterialDef stays(double density, double specificHeat, double conductivity) {
    return stays({density, conductivity, conductivity, specificHeat, specificHeat, 0, 1e5});
}

double areaOf(const scene::TriMesh& m) {
    double sum = 0;
    for (size_t t = 0; t + 2 < m.indices.size(); t += 3) {
        double e[2][3];
        for (size_t k = 0; k < 3; ++k)
            for (size_t s = 0; s < 2; ++s)
                e[s][k] = static_cast<double>(m.vertices[3 * m.indices[t + 1 + s] + k]) -
                          static_cast<double>(m.vertices[3 * m.indices[t] + k]);
        double square = 0;
        for (size_t k = 0; k < 3; ++k) {
            const size_t a = (k + 1) % 3, b = (k + 2) % 3;
            const double c = e[0][a] * e[1][b] - e[0][b] * e[1][a];
            square += c * c;
        }
        sum += 0.5 * std::sqrt(square);
    }
    return sum;
}

double exposedArea(const Lab& lab) {
    const thawParticleView p = lab.particles();
    double sum = 0;
    for (int i = 0; i < p.count; ++i) sum += static_cast<double>(p.normals[4 * i + 3]);
    return sum;
}

namespace {

// A vector with `along` on the axis and `across` on the two others.
thawVec3 turned(int axis, float along, float across) {
    return {axis == 0 ? along : across, axis == 1 ? along : across, axis == 2 ? along : across};
}

} // namespace

Bar::Bar(float spacing, int width, int maxParticles, float timeScale, double ambient, int axis)
    : lab(spacing, maxParticles, {0, 0, 0}, timeScale, 1), spacing_(spacing), timeScale_(timeScale), width_(width),
      axis_(axis) {
    thawWorld_SetAmbient(lab.world(), static_cast<float>(ambient), 0);
    const float side = static_cast<float>(width) * spacing;
    for (int a = 0; a < 3; ++a) {
        if (a == axis) continue;
        lab.plane({0, 0, 0}, turned(a, 1, 0)), lab.plane(turned(a, side, 0), turned(a, -1, 0));
    }
}

void Bar::section(const thawMaterialDef& material, int layers, double temperature, int level) {
    section(lab.material(material), layers, temperature, level);
}

void Bar::section(thawMaterialId id, int layers, double temperature, int level) {
    const float side = static_cast<float>(width_) * spacing_;
    // Bodies of a few layers each: what is in contact conducts, whatever it is part of.
    constexpr int kMost = 24;
    while (layers > 0) {
        const int now = layers < kMost + 3 ? layers : kMost, before = lab.counters().particles;
        const float from = static_cast<float>(layers_) * spacing_;
        lab.box(id, turned(axis_, from, 0), turned(axis_, from + static_cast<float>(now) * spacing_, side),
                static_cast<float>(temperature), [&](thawBodyDef& d) { d.coarsestLevel = level; });
        // Whole layers, or the theory is not about it.
        if ((lab.counters().particles - before) << level != now * width_ * width_)
            throw LabError("a bar did not fill evenly");
        layers -= now, layers_ += now;
    }
}

void Bar::hold(float x, float direction, double temperature) {
    thawColliderDef d;
    thawInitColliderDef(&d, thawCollider_plane);
    d.position = turned(axis_, x, 0);
    d.rotation = turnTo({0, 1, 0}, turned(axis_, direction, 0));
    d.temperature = static_cast<float>(temperature);
    lab.collider(d);
}

void Bar::holdBegin(double temperature) { hold(0, 1, temperature); }
void Bar::holdEnd(double temperature) { hold(static_cast<float>(layers_) * spacing_, -1, temperature); }

void Bar::run(double seconds) {
    const int steps = static_cast<int>(std::lround(seconds / stepSeconds()));
    lab.step(steps);
    time_ += steps * stepSeconds();
}

std::vector<double> Bar::means(const float* values) const {
    const thawParticleView p = lab.particles();
    std::vector<double> sum(static_cast<size_t>(layers_)), count(static_cast<size_t>(layers_));
    for (int i = 0; i < p.count; ++i) {
        const int at = static_cast<int>(p.positions[4 * i + axis_] / spacing_);
        const size_t layer = static_cast<size_t>(std::clamp(at, 0, layers_ - 1));
        sum[layer] += static_cast<double>(values[i]), count[layer] += 1;
    }
    for (size_t k = 0; k < sum.size(); ++k) sum[k] /= count[k];
    return sum;
}

std::vector<double> Bar::temperatures() const { return means(lab.particles().temperatures); }

double Bar::molten() const {
    double sum = 0;
    for (const double phi : means(lab.particles().liquidFractions)) sum += phi;
    return sum;
}

} // namespace thaw::player
