// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// A material that becomes another one while there is matter of it.
#include "world/world.h"

#include <cstring>

namespace thaw {
namespace {

constexpr double kHottest = 1e5; // K, as in Heat

bool same(const thawMaterialDef& a, const thawMaterialDef& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

bool sameCurve(const thawMaterialDef& a, const thawMaterialDef& b) {
    return a.solidus == b.solidus && a.liquidus == b.liquidus && a.latentHeat == b.latentHeat &&
           a.specificHeatSolid == b.specificHeatSolid && a.specificHeatLiquid == b.specificHeatLiquid;
}

// Of what has this one in the curve of `was`, the enthalpy at the same temperature, J/kg.
double converted(const Material& was, const Material& now, double H, bool unseeded) {
    const double T = std::max(0.0, was.kelvin(H, unseeded));
    // Without a range, the temperature does not say how much of it is liquid.
    const bool melting = !unseeded && now.def.solidus == now.def.liquidus && T == static_cast<double>(now.def.solidus);
    const double to = melting ? was.liquidFraction(H) * now.latent : now.enthalpy(T, unseeded);
    return std::clamp(to, now.enthalpyFloor(), now.enthalpy(kHottest));
}

} // namespace

thawResult World::setMaterial(uint32_t index, const thawMaterialDef& d, std::string& message) {
    const Material was = materials[index], now(d);
    if (same(stepped(was.def), stepped(d))) {
        materials[index] = now;
        return thawResult_ok;
    }
    if (!was.soft() && now.soft()) {
        if (const thawResult r = makeRoomForBonds(index, message); r != thawResult_ok) return r;
    }
    materials[index] = now;

    const bool curve = !sameCurve(was.def, d);
    const double heavier = static_cast<double>(d.density) / was.def.density;
    for (size_t k = 0; k < static_cast<size_t>(particles.count); ++k) {
        if (particles.material[k] != index) continue;
        const double H = particles.enthalpy[k], mass = particles.velocity[k].w;
        if (d.density != was.def.density) {
            const float become = static_cast<float>(heavier * mass);
            const double more = static_cast<double>(become) - mass;
            (more > 0 ? massAdded_ : massRemoved_) += std::abs(more);
            (more > 0 ? energyAdded_ : energyRemoved_) += std::abs(more) * H;
            particles.velocity[k].w = become;
            particles.pressure[k] = static_cast<float>(heavier * particles.pressure[k]);
        }
        bool unseeded = particles.flags[k] & kUnseeded;
        if (curve) {
            const double become = converted(was, now, H, unseeded);
            redefined_ += static_cast<double>(particles.velocity[k].w) * (become - H);
            particles.enthalpy[k] = become;
        }
        // What does not undercool any more goes as if a solid had touched it.
        unseeded = d.undercooling > 0 && (unseeded || particles.enthalpy[k] >= now.latent);
        particles.flags[k] = static_cast<uint8_t>((particles.flags[k] & ~kUnseeded) | (unseeded ? int{kUnseeded} : 0));
        particles.temperature[k] = std::max(0.0f, static_cast<float>(now.kelvin(particles.enthalpy[k], unseeded)));
        particles.liquidFraction[k] = now.liquidFraction(particles.enthalpy[k], unseeded);
    }
    if (was.soft() && !now.soft()) harden(index);
    if (!was.soft() && now.soft()) soften(index);
    if (was.soft() && now.soft()) bonds_.wakeAll(particles, index);
    rigid_.gather(particles);
    ++surfaceVersion_; // what was absorbed in the last step is not what it is now
    lookForHold();
    measure();
    return thawResult_ok;
}

// Solid particles of half a brick have no bonds within reach: they split first. Nothing is changed when there is no
// room.
thawResult World::makeRoomForBonds(uint32_t index, std::string& message) {
    std::vector<uint32_t> split;
    int rows = 0;
    for (size_t k = 0; k < static_cast<size_t>(particles.count); ++k) {
        const int level = particles.level[k];
        if (particles.material[k] != index || !particles.fine[k] || level == 0 || level == kHighestLevel) continue;
        split.push_back(static_cast<uint32_t>(k)), rows += (1 << level) - 1;
    }
    if (const int room = def.maxParticles - particles.count; rows > room) {
        message = "youngModulus: to be elastic it needs " + std::to_string(rows) +
                  " particles more, but of maxParticles only " + std::to_string(room) + " are free";
        return thawResult_capacity;
    }
    bonds_.reserve(particles.capacity); // may fail, as the lists may: before anything is another
    refreshNeighbors();
    if (reference_.home.empty() && !reference_.point.empty()) {
        reference_.home.reserve(reference_.point.size()), reference_.homeSlope.reserve(reference_.point.size());
        for (size_t k = 0; k < reference_.point.size(); ++k)
            reference_.home.push(reference_.point[k]), reference_.homeSlope.push(reference_.slope[k]);
    }
    // The sort may have moved them.
    split.clear();
    for (size_t k = 0; k < static_cast<size_t>(particles.count); ++k)
        if (particles.material[k] == index && particles.fine[k] && particles.level[k] > 0 &&
            particles.level[k] < kHighestLevel)
            split.push_back(static_cast<uint32_t>(k));
    if (!split.empty()) levels_.splitFully(levelFrame(plan.work, 0), split.data(), split.size());
    return thawResult_ok;
}

// What was rigid is elastic: as in a new body.
void World::soften(uint32_t index) {
    const Material& m = materials[index];
    for (size_t k = 0; k < static_cast<size_t>(particles.count); ++k) {
        if (particles.material[k] != index || !(particles.flags[k] & kFixed) ||
            !(particles.liquidFraction[k] < m.def.releaseFraction))
            continue;
        const uint16_t piece = particles.piece[k];
        if (piece) rigid_.lost(piece);
        particles.piece[k] = 0;
        const int kept = particles.flags[k] & ~(kFixed | kRigid | kAsleep);
        particles.flags[k] = static_cast<uint8_t>(piece ? kept : kept | kFixed | kAsleep);
    }
    refreshNeighbors();
    bonds_.bondAll(bondFrame(0));
    anchorsFresh_ |= toldApart_;
}

// What was elastic is rigid in the form that it has now: held, or a piece that goes on as it moved.
void World::harden(uint32_t index) {
    for (size_t k = 0; k < static_cast<size_t>(particles.count); ++k) {
        if (particles.material[k] != index || !particles.bondSlot[k]) continue;
        particles.flags[k] = static_cast<uint8_t>((particles.flags[k] & ~kAsleep) | kFixed);
        particles.velocityChange[k] = {}, particles.stiffness[k] = 0;
    }
    bonds_.harden(particles, materials.data());
    bodiesNew_ = true;
}

void World::setColliderSurface(uint32_t index, bool adhesive, bool occluder, float slipLength, float friction) {
    Collider& c = colliders[index];
    const bool grips = c.adhesive == adhesive && c.slipLength == slipLength && c.friction == friction;
    if (c.occluder != occluder) ++colliderVersion_;
    c.adhesive = adhesive, c.occluder = occluder, c.slipLength = slipLength, c.friction = friction;
    if (grips) return;
    rigid_.wakeAll();
    if (bonds_.wakeAll(particles) > 0) listsStale_ = true, measure();
}

} // namespace thaw
