// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// The state of a world, listed once: what is hashed, saved and brought back. A quantity of every particle belongs into
// THAW_PARTICLE_FIELDS; whatever else lives from step to step into the `state` function of its class, or here. What a
// step does not depend on is io.report(): saved and not hashed. What a step finds anew before it reads it is not here.
#include "particles/columns.h"
#include "world/world.h"

namespace thaw {

StateIo::Limits World::limits() const {
    StateIo::Limits l;
    const auto most = [](int32_t n) { return static_cast<size_t>(n); };
    l.particles = most(def.maxParticles), l.materials = most(def.maxMaterials), l.bodies = most(def.maxBodies);
    l.colliders = most(def.maxColliders), l.sources = most(def.maxHeatSources), l.paths = most(def.maxPaths);
    l.shapes = most(def.maxShapes);
    return l;
}

void World::state(StateIo& io) {
    hostState(io);
    rigid_.state(io);
    rigidLiquid_.state(io);
    bonds_.state(io, particles.capacity);
    reference_.state(io);
    bodyState(io);
    rowState(io);
    control_.state(io, shapeForms_);
    units_.state(io);
    surfaceUnits_.state(io);
    io(steps_, heatTimePending_, nextId_, stepsSinceRelabel_);
    io(listsStale_, led_, toldApart_, anchorsFresh_, holdStale_, bodiesNew_, anyCoarse_, levelsChanged_, full_);
    io(exposed_, undercooled_, rigidRows_, minTemperature_, maxTemperature_);
    io.index(plan.work.finestLevel, 4), io.index(plan.work.coarsestLevel, 4);
    reportState(io);
    // Last: of all that is read, only Embree's trees may still run out of memory.
    heat_.state(io, colliderForms_, listsStale_ ? 0 : static_cast<size_t>(particles.count), surfaceVersion_);
}

// What the host has set.
void World::hostState(StateIo& io) {
    io(def.gravity, def.ambientTemperature, def.convection, def.thermalTimeScale);
    io.staged(materials, stage_.materials, io.limits.materials, [&](Material& m) { m.state(io); });
    if (!io.hashes()) {
        const auto slots = [&](std::vector<Slot>& live, std::vector<Slot>& stage, size_t most) {
            io.staged(live, stage, most, [&](Slot& s) { s.state(io); });
        };
        slots(bodies, stage_.bodies, io.limits.bodies), slots(colliderSlots, stage_.colliderSlots, io.limits.colliders);
        slots(sourceSlots, stage_.sourceSlots, io.limits.sources);
        slots(pathSlots, stage_.pathSlots, io.limits.paths), slots(shapeSlots, stage_.shapeSlots, io.limits.shapes);
    }
    io.staged(colliders, stage_.colliders, io.limits.colliders, [&](Collider& c) { c.state(io, colliderForms_); });
    io.staged(sources, stage_.sources, io.limits.sources, [&](HeatSource& s) { s.state(io); });
    if (io.checks() && io.good()) {
        if (stage_.colliders.size() != stage_.colliderSlots.size() ||
            stage_.sources.size() != stage_.sourceSlots.size())
            return io.fail("slots of another number");
        io.limits.materials = stage_.materials.size(), io.limits.bodies = stage_.bodies.size();
        io.limits.colliders = stage_.colliders.size(), io.limits.paths = stage_.pathSlots.size();
        io.limits.shapes = stage_.shapeSlots.size();
    }
}

// What is known of the bodies beside their rows.
void World::bodyState(StateIo& io) {
    io.list(bodyPoints_, io.limits.bodies, [&](PointRange& r) {
        io(r.begin, r.end);
        if (io.restores() && !(r.begin <= r.end && r.end <= io.limits.points)) io.fail("points that there are not");
    });
    if (io.checks() && io.lastCount() != io.limits.bodies) io.fail("bodies of another number");
    io.block(coarsestOf_, io.limits.bodies);
    if (io.checks() && io.lastCount() != io.limits.bodies) io.fail("bodies of another number");
}

void World::rowState(StateIo& io) {
    if (!io.reads()) {
        io.count(static_cast<size_t>(particles.count), static_cast<size_t>(particles.count));
        io.count(static_cast<size_t>(particles.moverCount), static_cast<size_t>(particles.count));
        // Where no body may be coarse, nobody reads the features.
        return columns(io, particles, mayBeCoarse());
    }
    if (io.checks()) {
        stage_.rows = static_cast<uint32_t>(io.count(0, io.limits.particles));
        stage_.movers = static_cast<uint32_t>(io.count(0, stage_.rows));
        io.limits.rows = stage_.rows;
        readColumns(io, particles, stage_.rows, def.particleSpacing);
        if (io.good()) bonds_.checkSlots(io, particles.bondSlotBack.data(), stage_.rows);
        stage_.rowsEnd = io.at();
        return;
    }
    io.look(stage_.rowsEnd - io.at());
    takeColumns(particles, static_cast<int>(stage_.rows), static_cast<int>(stage_.movers));
}

void World::reportState(StateIo& io) {
    io.report(time_, surfaceVersion_, wallVersion_, colliderVersion_, heldSpeed_);
    io.report(massAdded_, massRemoved_, energyAdded_, energyRemoved_, massBurnt_, energyBurnt_, controlImpulse_);
    io.report(controlEnergy_, controlHeat_, painted_, redefined_, absorbed_, contact_, emitted_, convected_);
    io.report(massNow_, energyNow_, liquidMass_, badParticles_, counters_);
    io.report(neighbors_.maxNeighbors, neighbors_.meanNeighbors, neighbors_.clipped);
    if (io.hashes()) return;
    for (bool& on : plan.enabled) io(on);
    for (thawReason& why : plan.reason) io.index(why, thawReason_noControl + 1);
    io(plan.work, plan.predictedMs, plan.units, plan.workers);
}

uint64_t World::stateHash() const {
    StateIo io(0xcbf29ce484222325ULL);
    io.limits = limits();
    const_cast<World*>(this)->state(io); // which only looks
    return io.hash();
}

} // namespace thaw
