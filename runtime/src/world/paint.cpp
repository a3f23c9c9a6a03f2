// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world/world.h"

namespace thaw {
namespace {

// How much of the brush arrives at x: 1 inside, fading to 0 over the outer share of its radius.
float strength(const thawBrush& b, Vec3 x) {
    const float off = length(x - Vec3{b.center.x, b.center.y, b.center.z}) / b.radius;
    if (!(off <= 1)) return 0;
    return off <= 1 - b.falloff ? 1.0f : (1 - off) / b.falloff;
}

// Calls f(row, share) for the rows of a body under the brush; returns how many.
template <class F> int forPainted(const Particles& p, uint32_t body, const thawBrush& brush, F&& f) {
    int painted = 0;
    for (size_t k = 0; k < static_cast<size_t>(p.count); ++k) {
        const float share = p.body[k] == body ? strength(brush, p.position[k].xyz()) : 0.0f;
        if (share > 0) ++painted, f(k, share);
    }
    return painted;
}

} // namespace

// Coarse particles would be painted whole. Those for whose parts there is no room are.
void World::splitUnder(uint32_t body, const thawBrush& brush) {
    if (!anyCoarse_) return;
    ensureLists();
    std::vector<uint32_t> touched;
    for (int i = 0; i < particles.count; ++i) {
        const size_t k = static_cast<size_t>(i);
        if (particles.body[k] != body || particles.level[k] == 0 || !particles.fine[k]) continue;
        bool near = false;
        reference_.forPoints(particles, k, [&](Vec3 x, uint32_t) { near |= strength(brush, x) > 0; });
        if (near) touched.push_back(static_cast<uint32_t>(i));
    }
    if (!levels_.splitFully(levelFrame(plan.work, 0), touched.data(), touched.size())) return;
    listsStale_ = levelsChanged_ = true;
    measure();
}

int World::paintTemperature(uint32_t body, const thawBrush& brush, float temperature) {
    splitUnder(body, brush);
    const int painted = forPainted(particles, body, brush, [&](size_t k, float share) {
        const Material& m = materials[particles.material[k]];
        const float was = particles.temperature[k],
                    kelvin = share < 1 ? was + share * (temperature - was) : temperature;
        const double H = m.enthalpy(kelvin);
        painted_ += static_cast<double>(particles.velocity[k].w) * (H - particles.enthalpy[k]);
        particles.enthalpy[k] = H;
        particles.temperature[k] = m.temperature(H), particles.liquidFraction[k] = m.liquidFraction(H);
        const bool unseeded = m.def.undercooling > 0 && H >= m.latent;
        particles.flags[k] = static_cast<uint8_t>((particles.flags[k] & ~kUnseeded) | (unseeded ? kUnseeded : 0));
    });
    // The next step looks who lets go, sets and burns.
    if (painted > 0) listsStale_ = holdStale_ = true, measure();
    return painted;
}

int World::paintAbsorptivity(uint32_t body, const thawBrush& brush, float value) {
    splitUnder(body, brush);
    const int painted = forPainted(particles, body, brush, [&](size_t k, float share) {
        const float was = absorptivity(particles.absorbs[k], materials[particles.material[k]].def.absorptivity);
        particles.absorbs[k] = paintedAbsorptivity(share < 1 ? was + share * (value - was) : value);
    });
    if (painted > 0) ++surfaceVersion_; // what was absorbed in the last step is not what it is now
    return painted;
}

} // namespace thaw
