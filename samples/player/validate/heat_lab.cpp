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

Bar::Bar(float spacing, int width, int maxParticles, float timeScale, double ambient)
    : lab(spacing, maxParticles, {0, 0, 0}, timeScale, 1), spacing_(spacing), timeScale_(timeScale), width_(width) {
    thawWorld_SetAmbient(lab.world(), static_cast<float>(ambient), 0);
    const float side = static_cast<float>(width) * spacing;
    lab.floor();
    lab.plane({0, side, 0}, {0, -1, 0});
    lab.plane({0, 0, 0}, {0, 0, 1}), lab.plane({0, 0, side}, {0, 0, -1});
}

void Bar::section(const thawMaterialDef& material, int layers, double temperature) {
    section(lab.material(material), layers, temperature);
}

void Bar::section(thawMaterialId id, int layers, double temperature) {
    const float side = static_cast<float>(width_) * spacing_;
    // Bodies of a few layers each: what is in contact conducts, whatever it is part of.
    constexpr int kMost = 24;
    while (layers > 0) {
        const int now = layers < kMost + 3 ? layers : kMost, before = lab.counters().particles;
        const float from = static_cast<float>(layers_) * spacing_;
        lab.box(id, {from, 0, 0}, {from + static_cast<float>(now) * spacing_, side, side},
                static_cast<float>(temperature));
        // Whole layers, or the theory is not about it.
        if (lab.counters().particles - before != now * width_ * width_) throw LabError("a bar did not fill evenly");
        layers -= now, layers_ += now;
    }
}

void Bar::hold(float x, float direction, double temperature) {
    thawColliderDef d;
    thawInitColliderDef(&d, thawCollider_plane);
    d.position = {x, 0, 0};
    d.rotation = turnTo({0, 1, 0}, {direction, 0, 0});
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
        const int at = static_cast<int>(p.positions[4 * i] / spacing_);
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
