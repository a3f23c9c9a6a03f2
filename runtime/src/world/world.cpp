// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world/world.h"

#include "base/kernel.h"
#include "heat/burn.h"
#include "heat/sources.h"
#include "motion/carry.h"
#include "neighbors/exposure.h"
#include "world/parts.h"

#include <bit>
#include <chrono>

namespace thaw {
namespace {

// Below this difference, temperatures count as equal: no conduction, no loss.
constexpr float kEqualTemperature = 1e-3f; // K
constexpr int kRowBlock = 2048;

using Clock = SafePoints::Clock;
// Of a budget in milliseconds: what nobody counts comes on top of what is still expected.
constexpr float kLateFrom = 0.95f;
constexpr float kLateRays = 0.05f; // of the rays, when a step is late before it is warm
constexpr float kUnitsPerMs = 1000;

// Adds the wall-clock time of its scope to one field of the profile.
struct StageTimer {
    explicit StageTimer(float& field) : field_(field), start_(Clock::now()) {}
    ~StageTimer() { field_ += std::chrono::duration<float, std::milli>(Clock::now() - start_).count(); }
    float& field_;
    Clock::time_point start_;
};

// Solid: it may stand for several.
bool startsCoarse(const Material& m, float temperature) {
    return m.liquidFraction(m.enthalpy(temperature)) < m.def.releaseFraction;
}

uint16_t makeTag(const void* self) {
    // No global counter: two worlds at once differ by address. 16 bits catch a mix-up, not malice.
    uint64_t h = hashCombine(0x7468617721ULL, reinterpret_cast<uintptr_t>(self));
    return static_cast<uint16_t>((h ^ (h >> 16) ^ (h >> 32)) | 1);
}

} // namespace

Transform toTransform(thawVec3 p, thawQuat q, float scale) {
    float l = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return {{p.x, p.y, p.z}, {q.x / l, q.y / l, q.z / l, q.w / l}, scale};
}

bool freeSlot(const std::vector<Slot>& slots, int most, const char* field, const char* what, size_t& slot,
              std::string& message) {
    for (slot = 0; slot < slots.size() && slots[slot].alive; ++slot) {
    }
    if (slot < static_cast<size_t>(most)) return true;
    message = std::string(field) + ": all " + std::to_string(most) + " " + what + " of the world are in use";
    return false;
}

World::World(const thawWorldDef& d)
    : def(d), allocator(d.allocator), tasks(d.tasks), tag(makeTag(this)), particles(allocator), neighbors_(allocator),
      motion_(allocator), rigid_(allocator), rigidLiquid_(allocator), heat_(allocator), hold_(allocator),
      anchors_(allocator), bonds_(allocator), surface_(allocator, d.tasks), splats_(allocator), reference_(allocator),
      levels_(allocator), control_(allocator), volume_(allocator), invDensity_(allocator), featureSizes_(allocator),
      blockTotals_(allocator) {
    particles.allocate(d.maxParticles);
    const size_t n = static_cast<size_t>(d.maxParticles) + Particles::kPadding;
    volume_.resize(n), invDensity_.resize(n);
    blockTotals_.resize(static_cast<size_t>(Tasks::blockCount(d.maxParticles, kRowBlock)));
    materials.reserve(static_cast<size_t>(d.maxMaterials));
}

uint32_t World::step(float dt, const thawBudget& budget) {
    const Clock::time_point start = Clock::now();
    profile = {};
    uint32_t status = thawStep_ok;
    ensureLists();
    if (anchorsFresh_) findAnchors();
    if (toldApart_) startColliders(dt, 0, 1);
    if (const int woken = toldApart_ && anySoft() ? bonds_.wakeBefore(bondFrame(dt)) : 0)
        counters_.moving += woken, counters_.fixed -= woken, listsStale_ = holdStale_ = true;
    Needs now = needs();
    int wanted = subStepsWanted(dt);
    const Governor::Choice choice = chooseWork(governor_, units_, now, budget, wanted);
    thawWork work = choice.work;
    work.surfaceLevel = chooseSurfaceLevel(surfaceLevel_, surfaceUnits_, budget);
    heatTimePending_ += static_cast<double>(dt) * def.thermalTimeScale;
    now.heatDue = heatDue(work);
    plan = makePlan(now, work);
    plan.predictedMs = budget.mode == thawBudget_milliseconds ? choice.predictedMs : 0;
    plan.units = kUnitsPerMs * units_.predict(now, work, wanted);
    plan.workers = choice.workers;
    tasks.useWorkers(choice.workers);
    if (budget.mode == thawBudget_milliseconds)
        safePoints_.watch(start, kLateFrom * budget.milliseconds);
    else
        safePoints_.count(work.lateAfter);
    if (budget.mode == thawBudget_units && plan.units > budget.units) status |= thawStep_overBudget;
    wanted = std::max(wanted, static_cast<int>(work.leastSubSteps));
    const int subSteps = std::clamp(wanted, 1, work.subSteps);
    const auto expectRest = [&](int subStepsLeft) {
        if (budget.mode == thawBudget_milliseconds) safePoints_.expect(governor_.rest(now, subStepsLeft));
    };
    if (wanted > subSteps && now.movers > 0) status |= thawStep_subStepsClipped;
    auto on = [&](thawStage s) { return plan.enabled[s]; };
    auto timed = [&](thawStage s) { return StageTimer(profile.stage[s]); };

    if (on(thawStage_neighbors)) {
        auto t = timed(thawStage_neighbors);
        refreshNeighbors();
    }
    const bool bodiesNew = bodiesNew_;
    if (bodiesNew_) {
        // Before it is held, or falls: what a new body has of velocity is that of the part that is free.
        auto t = timed(thawStage_phase);
        if (hold_.relabel(holdFrame(dt, true)).cutLoose > 0) refreshNeighbors();
        bodiesNew_ = false;
    }
    if (on(thawStage_exposure)) {
        auto t = timed(thawStage_exposure);
        refreshExposure();
    }

    const bool heated = on(thawStage_radiation) || on(thawStage_conduction) || on(thawStage_loss);
    HeatStats heatStats{};
    if (heated) {
        expectRest(subSteps);
        if (on(thawStage_radiation) && safePoints_.late()) work.rayRefresh = std::min(work.rayRefresh, kLateRays);
        HeatFrame frame = heatFrame(heatTimePending_, work);
        if (on(thawStage_radiation)) {
            auto t = timed(thawStage_radiation);
            heat_.radiation(frame);
        }
        const int parts =
            on(thawStage_loss) ? Heat::parts(frame, static_cast<int>(materials.size()), maxTemperature_) : 1;
        frame.dt /= parts, frame.cycles = std::max(1, frame.cycles / parts);
        for (int part = 0; part < parts; ++part) {
            if (on(thawStage_conduction)) {
                auto t = timed(thawStage_conduction);
                heat_.conduction(frame);
            }
            if (on(thawStage_loss)) {
                auto t = timed(thawStage_loss);
                heat_.loss(frame);
            }
        }
        auto t = timed(thawStage_phase);
        heat_.integrate(frame);
        heatStats = heat_.stats();
        absorbed_ += heatStats.absorbed, contact_ += heatStats.contact;
        emitted_ += heatStats.emitted, convected_ += heatStats.convected;
        if (heatStats.raysReduced) status |= thawStep_raysReduced;
    }
    const double heatSeconds = now.heatDue ? heatTimePending_ : 0;
    if (now.heatDue) heatTimePending_ = 0;

    if (on(thawStage_levels)) {
        auto t = timed(thawStage_levels);
        levels_.choose(levelFrame(work, dt), on(thawStage_radiation) ? heat_.power() : nullptr, bodiesNew);
    }

    const bool guided = on(thawStage_control);
    if (guided) {
        auto t = timed(thawStage_control);
        controlHeat_ += control_.track(controlFrame(dt));
        led_ = now.movers > 0;
    }
    MotionStats motionStats{};
    if (on(thawStage_collision) || rigid_.moving() || (rigid_.any() && collidersMove())) {
        const float h = dt / static_cast<float>(subSteps);
        for (int s = 0; s < subSteps; ++s) {
            if (s > 0) {
                auto t = timed(thawStage_neighbors);
                refreshNeighbors();
            }
            if (toldApart_) carryHeld(h, s, subSteps);
            expectRest(subSteps - 1 - s);
            Guide guide;
            if (guided) {
                auto t = timed(thawStage_control);
                guide = control_.guide(controlFrame(h));
            }
            const MotionFrame frame = motionFrame(h, subSteps, work, guide);
            {
                auto t = timed(thawStage_forces);
                motion_.begin(frame);
                motion_.forces(frame);
            }
            {
                auto t = timed(thawStage_viscosity);
                motion_.viscosity(frame);
            }
            {
                auto t = timed(thawStage_pressure);
                motion_.pressure(frame);
            }
            {
                auto t = timed(thawStage_collision);
                motion_.move(frame);
            }
            if (toldApart_) {
                motion_.addImpulses(colliders.data(), static_cast<int>(colliders.size()));
                rigid_.addImpulses(colliders.data());
                arrive();
            }
            const MotionStats& m = motion_.stats();
            motionStats.viscosityIterations += m.viscosityIterations;
            motionStats.pressureIterations += m.pressureIterations;
            for (int a = 0; a < 3; ++a) controlImpulse_[a] += m.guideImpulse[a];
            controlEnergy_ += m.guideEnergy;
            motionStats.iterationsClipped |= m.iterationsClipped, motionStats.velocityClamped |= m.velocityClamped;
            motionStats.maxSpeed = std::max(motionStats.maxSpeed, m.maxSpeed);
            motionStats.maxCompression = m.maxCompression, motionStats.meanCompression = m.meanCompression;
            motionStats.apparentViscosity = m.apparentViscosity;
        }
        listsStale_ = true;
        if (motionStats.iterationsClipped) status |= thawStep_iterationsClipped;
        if (motionStats.velocityClamped) status |= thawStep_velocityClamped;
    } else if (toldApart_) {
        carryHeld(dt, 0, 1);
        arrive();
    }
    if (on(thawStage_phase)) {
        auto t = timed(thawStage_phase);
        holdAndRelease(dt);
    }
    LevelResult levelResult;
    expectRest(0);
    if (on(thawStage_levels)) {
        auto t = timed(thawStage_levels);
        LevelFrame frame = levelFrame(work, dt);
        if (safePoints_.late()) frame.mostSplits = 0; // merging is what makes the next steps cheaper
        levelResult = levels_.apply(frame);
        if (levelResult.split + levelResult.merged > 0) listsStale_ = true;
        if (levelResult.refused) status |= thawStep_splitsClipped;
        levelsChanged_ = levelResult.split + levelResult.merged > 0;
        full_ = levelResult.refused && particles.count + kHighestLevel >= particles.capacity;
    }
    if (on(thawStage_stats)) {
        auto t = timed(thawStage_stats);
        if (heatSeconds > 0) burnOff(heatSeconds);
        measure();
        if (badParticles_ > 0) {
            status |= thawStep_badParticlesRemoved;
            removeParticles(
                [this](size_t k) {
                    return !isFinite(particles.position[k].xyz()) || !isFinite(particles.velocity[k].xyz()) ||
                           !std::isfinite(particles.enthalpy[k]);
                },
                massRemoved_, energyRemoved_);
            measure();
        }
    }
    for (Collider& c : colliders) c.hasTarget = c.moves = false;
    if (neighbors_.clipped) status |= thawStep_neighborsClipped;

    ++steps_;
    time_ += dt;
    counters_.subSteps = on(thawStage_forces) ? subSteps : 0;
    counters_.pressureIterations = motionStats.pressureIterations;
    counters_.viscosityIterations = motionStats.viscosityIterations;
    counters_.rays = heatStats.rays;
    counters_.splits = levelResult.split, counters_.merges = levelResult.merged;
    counters_.maxSpeed = motionStats.maxSpeed;
    counters_.maxCompression = motionStats.maxCompression, counters_.meanCompression = motionStats.meanCompression;
    counters_.apparentViscosity = motionStats.apparentViscosity;

    profile.step = std::chrono::duration<float, std::milli>(Clock::now() - start).count();
    Governor::Cost cost{};
    std::copy(std::begin(profile.stage), std::end(profile.stage), std::begin(cost.stageMs));
    cost.particles = particles.count, cost.movers = now.movers, cost.exposed = exposed_, cost.rays = heatStats.rays;
    cost.mostRays = on(thawStage_radiation) ? mostRays(now, work) : 0;
    cost.subSteps = subSteps, cost.pressureIterations = counters_.pressureIterations;
    cost.viscosityIterations = counters_.viscosityIterations, cost.heatRan = heated;
    cost.heatWanted = heatStats.cyclesWanted, cost.heatPasses = heatStats.passes;
    cost.heatInterval = work.heatInterval, cost.relabelled = stepsSinceRelabel_ == 0 && on(thawStage_phase);
    cost.stepMs = profile.step, cost.budgetMs = budget.milliseconds, cost.stalledMs = tasks.takeStalledMs();
    cost.predictedMs = plan.predictedMs, cost.late = safePoints_.lateAt() > 0;
    governor_.learn(cost), units_.learn(cost);
    if (cost.late) status |= thawStep_late, plan.work.lateAfter = safePoints_.lateAt();
    if (budget.mode == thawBudget_milliseconds && profile.step > budget.milliseconds) status |= thawStep_overBudget;
    return status;
}

Needs World::needs() const {
    Needs n;
    n.particles = particles.count;
    // What was released or set since the last sort counts already.
    n.movers = counters_.moving - rigidRows_;
    n.rigid = rigidRows_;
    n.exposed = exposed_;
    n.listsStale = listsStale_;
    n.holdStale = holdStale_;
    for (const Collider& c : colliders) n.collidersMove |= c.alive && c.hasTarget;
    for (const HeatSource& s : sources) {
        const float strength = strengthOf(s, def.ambientTemperature);
        n.sourceOn |= strength != 0, n.sources += strength != 0 && !hasExtent(s.type);
        n.areaSources += strength != 0 && hasExtent(s.type);
    }
    n.timeScaleZero = def.thermalTimeScale == 0;
    n.control = control_.any(), n.cools = control_.cools(), n.ledBefore = led_;
    n.levels = anyCoarse_ || mayBeCoarse();
    n.levelsChanged = levelsChanged_, n.full = full_;
    n.finestLevel = plan.work.finestLevel, n.coarsestLevel = plan.work.coarsestLevel;
    for (const Material& m : materials)
        n.burns |= !n.timeScaleZero && m.def.burnTemperature > 0 && maxTemperature_ > m.def.burnTemperature;
    n.unequal = maxTemperature_ - minTemperature_ > kEqualTemperature || undercooled_ > 0;
    for (const Collider& c : colliders)
        n.unequal |=
            c.heats() && std::max(c.temperature - minTemperature_, maxTemperature_ - c.temperature) > kEqualTemperature;
    n.awayFromAmbient = maxTemperature_ - def.ambientTemperature > kEqualTemperature ||
                        def.ambientTemperature - minTemperature_ > kEqualTemperature;
    return n;
}

bool World::collidersMove() const {
    for (const Collider& c : colliders)
        if (c.alive && c.moves) return true;
    return false;
}

// Sets the colliders going toward their targets, for one of the equal sub-steps of a step of dt.
void World::startColliders(float dt, int subStep, int subSteps) {
    for (Collider& c : colliders) {
        if (subStep == 0) std::fill(std::begin(c.impulse), std::end(c.impulse), 0.0);
        if (!c.alive || !c.hasTarget) continue;
        const float share = 1 / static_cast<float>(subSteps - subStep);
        c.moveTo(between(c.transform, c.target, share), dt / static_cast<float>(subSteps));
    }
}

void World::carryHeld(float h, int subStep, int subSteps) {
    startColliders(h * static_cast<float>(subSteps), subStep, subSteps);
    heldSpeed_ = beginCarry(particles, colliders.data(), static_cast<int>(colliders.size()),
                            {def.gravity.x, def.gravity.y, def.gravity.z}, h);
}

// The end of a sub-step: colliders and what hangs on them at their new places.
void World::arrive() {
    if (heldSpeed_ > 0) endCarry(particles, reference_, colliders.data(), static_cast<int>(colliders.size()));
    for (Collider& c : colliders) {
        if (!c.alive || !c.moves) continue;
        // What was counted about the old place counts about the new one.
        const double J[3] = {c.impulse[0], c.impulse[1], c.impulse[2]};
        const Vec3 way = c.next.position - c.transform.position;
        const double d[3] = {way.x, way.y, way.z};
        for (int k = 0; k < 3; ++k)
            c.impulse[3 + k] -= d[(k + 1) % 3] * J[(k + 2) % 3] - d[(k + 2) % 3] * J[(k + 1) % 3];
        c.transform = c.next;
        listsStale_ = true; // also where nothing else moves: what a wall covers is no surface
        ++wallVersion_;
        if (c.occluder) ++colliderVersion_;
    }
}

// Who holds what has changed: the next step looks anew.
void World::lookForHold() {
    rigid_.wakeAll();
    listsStale_ = holdStale_ = true;
    stepsSinceRelabel_ = kRelabelInterval;
}

void World::findAnchors() {
    anchorsFresh_ = false;
    if (listsStale_) refreshNeighbors(), listsStale_ = true; // the step's own stage finds the surface anew as well
    anchors_.update(anchorFrame(), true);
}

// Where a collider shall be at the end of the next step.
void World::setColliderTarget(uint32_t index, const Transform& target) {
    Collider& c = colliders[index];
    if (!c.kinematic && !c.report) anchorsFresh_ = true;
    c.kinematic = toldApart_ = true;
    c.hasTarget = true, c.target = target;
}

// A jump: what hung on it stays behind, what it lands on is pushed out.
void World::teleportCollider(uint32_t index, const Transform& to) {
    Collider& c = colliders[index];
    c.transform = to, c.hasTarget = false;
    ++colliderVersion_, ++wallVersion_;
    listsStale_ = holdStale_ = true;
    stepsSinceRelabel_ = kRelabelInterval;
}

bool World::heatDue(const thawWork& work) const { return steps_ % static_cast<uint64_t>(work.heatInterval) == 0; }

int World::subStepsWanted(float dt) const {
    constexpr int kMost = 16; // the range of thawWork::subSteps
    const Vec3 gravity{def.gravity.x, def.gravity.y, def.gravity.z};
    const int wanted = Motion::subStepsWanted(particles, dt, gravity, def.particleSpacing, kMost, colliders.data(),
                                              static_cast<int>(colliders.size()));
    return std::max(wanted, bonds_.subStepsWanted(particles, dt, gravity, def.particleSpacing, kMost));
}

Governor::Choice World::chooseWork(Governor& milliseconds, Governor& units, const Needs& n, const thawBudget& b,
                                   int subStepsWanted) const {
    const int workers = tasks.workerCount();
    if (b.mode == thawBudget_milliseconds)
        return milliseconds.choose(n, b.milliseconds, b.least, b.most, subStepsWanted, workers);
    if (b.mode == thawBudget_units)
        return units.choose(n, b.units / kUnitsPerMs, b.least, b.most, subStepsWanted, workers);
    return {b.work, 0, workers};
}

thawPlan World::previewPlan(const thawBudget& budget) const {
    Needs n = needs();
    const int wanted = subStepsWanted(1.0f / 60);
    Governor milliseconds = governor_, units = units_; // choosing moves their memory; a preview must not
    Governor::Choice c = chooseWork(milliseconds, units, n, budget, wanted);
    SurfaceLevel learnt = surfaceLevel_, fixed = surfaceUnits_;
    c.work.surfaceLevel = chooseSurfaceLevel(learnt, fixed, budget);
    n.heatDue = heatDue(c.work);
    thawPlan p = makePlan(n, c.work);
    p.predictedMs = budget.mode == thawBudget_milliseconds ? c.predictedMs : 0;
    p.units = kUnitsPerMs * units_.predict(n, c.work, wanted);
    p.workers = c.workers;
    return p;
}

void World::refreshNeighbors() {
    ++surfaceVersion_;
    neighbors_.sort(particles, tasks);
    neighbors_.build(particles, tasks);
    fillMassArrays();
    neighbors_.weigh(particles, volume_.data(), invDensity_.data(), tasks);
    listsStale_ = false;
}

void World::refreshExposure() {
    ++surfaceVersion_;
    exposed_ = findExposure(particles, neighbors_, volume_.data(), colliders.data(), static_cast<int>(colliders.size()),
                            anyCoarse_ ? &reference_ : nullptr, tasks);
}

// The pressure of its depth is what a liquid has that walls hold on all sides. Where it is open it has no more than
// that of the way to the surface: a layer of 12 mm and 20 Pa s, 0.26 m down an incline of 30 degrees, burst at 3.4 m/s
// otherwise; theory and now are 0.018.
void World::boundStartPressure(uint16_t body) {
    bool any = false;
    for (int i = 0; i < particles.count && !any; ++i) {
        const size_t k = static_cast<size_t>(i);
        any = particles.body[k] == body && particles.pressure[k] > 0;
    }
    if (!any) return;
    // Surface that looks into a wall is not open.
    const auto facesAir = [&](int i) {
        const size_t k = static_cast<size_t>(i);
        bool open = particles.flags[k] & kSurface;
        for (size_t c = 0; c < colliders.size() && open; ++c) {
            if (!colliders[c].alive) continue;
            Vec3 normal;
            const float near = particles.position[k].w / kSupport;
            if (colliders[c].distance(particles.position[k].xyz(), normal) < near)
                open = dot(normal, particles.normal[k].xyz()) > -0.5f;
        }
        return open;
    };
    std::vector<float> depth(static_cast<size_t>(particles.count), INFINITY);
    std::vector<int> open;
    std::vector<char> isOpen(static_cast<size_t>(particles.count));
    for (int i = 0; i < particles.count; ++i) isOpen[static_cast<size_t>(i)] = facesAir(i);
    // A hole that the filling left in a corner has a few such particles too.
    constexpr int kOpenNeighbors = 4;
    for (int i = 0; i < particles.count; ++i) {
        const size_t k = static_cast<size_t>(i);
        if (!isOpen[k]) continue;
        int around = 0;
        forNeighbors(neighbors_, i, [&](uint32_t j) {
            if (j >= static_cast<uint32_t>(particles.count)) return false;
            around += isOpen[j];
            return true;
        });
        if (around < kOpenNeighbors) continue;
        depth[k] = 0.5f * particles.position[k].w / kSupport, open.push_back(i);
    }
    for (size_t head = 0; head < open.size(); ++head) {
        const size_t i = static_cast<size_t>(open[head]);
        forNeighbors(neighbors_, open[head], [&](uint32_t j) {
            if (j >= static_cast<uint32_t>(particles.count)) return false;
            const float way = depth[i] + length(particles.position[i].xyz() - particles.position[j].xyz());
            if (particles.body[j] == body && way < depth[j]) depth[j] = way, open.push_back(static_cast<int>(j));
            return true;
        });
    }
    const float weight = length(Vec3{def.gravity.x, def.gravity.y, def.gravity.z});
    for (int i = 0; i < particles.count; ++i) {
        const size_t k = static_cast<size_t>(i);
        if (particles.body[k] != body || !(particles.pressure[k] > 0)) continue;
        const float density = materials[particles.material[k]].def.density;
        particles.pressure[k] = std::min(particles.pressure[k], density * weight * depth[k]);
    }
}

void World::fillMassArrays() {
    tasks.forBlocks(particles.count, kRowBlock, [&](int begin, int end, int, int) {
        for (int i = begin; i < end; ++i) {
            const size_t k = static_cast<size_t>(i);
            const float density = materials[particles.material[k]].def.density;
            volume_[k] = particles.velocity[k].w / density;
            invDensity_[k] = particles.fixed(i) ? 0.0f : 1 / density;
        }
    });
    for (int i = particles.count; i < particles.count + Particles::kPadding; ++i)
        volume_[static_cast<size_t>(i)] = invDensity_[static_cast<size_t>(i)] = 0;
}

MotionFrame World::motionFrame(float dt, int subSteps, const thawWork& work, const Guide& guide) {
    return {particles,
            neighbors_,
            volume_.data(),
            invDensity_.data(),
            materials.data(),
            colliders.data(),
            static_cast<int>(colliders.size()),
            tasks,
            dt,
            subSteps,
            {def.gravity.x, def.gravity.y, def.gravity.z},
            def.particleSpacing,
            work.pressureIterations,
            work.viscosityIterations,
            heldSpeed_,
            &bonds_,
            rigid_.any() ? &rigid_ : nullptr,
            rigid_.any() ? &rigidLiquid_ : nullptr,
            reference_.point.empty() ? nullptr : &reference_,
            guide.drag,
            guide.free,
            guide.rim,
            guide.rimVelocity,
            &safePoints_,
            Governor::kLeastViscosity,
            Governor::kLeastPressure};
}

BondFrame World::bondFrame(float dt) {
    return {particles,
            neighbors_,
            volume_.data(),
            materials.data(),
            colliders.data(),
            static_cast<int>(colliders.size()),
            tasks,
            dt,
            {def.gravity.x, def.gravity.y, def.gravity.z},
            rigid_.any() ? &rigid_ : nullptr};
}

bool World::anySoft() const {
    return std::any_of(materials.begin(), materials.end(), [](const Material& m) { return m.soft(); });
}

HeatFrame World::heatFrame(double dt, const thawWork& work) {
    spots_.clear(); // setPath made room
    for (const Path& p : control_.paths())
        if (p.alive && p.enabled && p.startAbsorptivity >= 0) {
            const Vec3 start = OwnSpace(p.collider, colliders.data()).out(p.line->points().front());
            spots_.push_back({start, p.radius, p.startAbsorptivity});
        }
    return {particles,
            neighbors_,
            volume_.data(),
            materials.data(),
            colliders.data(),
            static_cast<int>(colliders.size()),
            colliderVersion_,
            sources.data(),
            static_cast<int>(sources.size()),
            tasks,
            dt,
            def.ambientTemperature,
            def.convection,
            def.particleSpacing,
            work.rayRefresh,
            work.heatCycles,
            work.raysPerSource,
            surfaceVersion_,
            &def.rays,
            std::any_of(materials.begin(), materials.end(), [](const Material& m) { return m.def.undercooling > 0; }),
            static_cast<int>(bodies.size()),
            anyCoarse_ ? &reference_ : nullptr,
            spots_.data(),
            static_cast<int>(spots_.size())};
}

HoldFrame World::holdFrame(float dt, bool relabel) {
    findMoulds();
    return {particles,
            neighbors_,
            materials.data(),
            colliders.data(),
            static_cast<int>(colliders.size()),
            tasks,
            rigid_,
            dt,
            {def.gravity.x, def.gravity.y, def.gravity.z},
            relabel,
            toldApart_,
            mouldOn_.data()};
}

AnchorFrame World::anchorFrame() {
    findMoulds();
    return {particles, neighbors_, colliders.data(), static_cast<int>(colliders.size()),
            tasks,     rigid_,     mouldOn_.data()};
}

void World::holdAndRelease(float dt) {
    ++stepsSinceRelabel_;
    const bool moved = toldApart_ && collidersMove();
    if (moved) holdStale_ = true;
    const bool relabel = holdStale_ && stepsSinceRelabel_ >= kRelabelInterval;
    const HoldResult r = hold_.update(holdFrame(dt, relabel));
    if (relabel) holdStale_ = false, stepsSinceRelabel_ = 0;
    if (r.released > 0) holdStale_ = true;
    if (r.changed()) listsStale_ = true;
    if (anySoft()) {
        const BondResult b = bonds_.update(bondFrame(dt));
        if (b.released + b.woken > 0) holdStale_ = true;
        if (b.changed()) listsStale_ = true;
        if (anyCoarse_) bonds_.deform(bondFrame(dt), reference_);
    }
    if (!toldApart_) return;
    const AnchorFrame frame = anchorFrame();
    if ((relabel || (moved && anchors_.pressed(frame))) && anchors_.update(frame, false) > 0) listsStale_ = true;
}

void World::measure() {
    const int blocks = Tasks::blockCount(particles.count, kRowBlock);
    tasks.forBlocks(particles.count, kRowBlock, [&](int begin, int end, int block, int) {
        Totals t{0, 0, 0, INFINITY, -INFINITY, 0, 0, 0};
        for (int i = begin; i < end; ++i) {
            const size_t k = static_cast<size_t>(i);
            const double mass = particles.velocity[k].w;
            t.mass += mass;
            t.energy += mass * particles.enthalpy[k];
            t.liquid += mass * particles.liquidFraction[k];
            t.minTemperature = std::min(t.minTemperature, particles.temperature[k]);
            t.maxTemperature = std::max(t.maxTemperature, particles.temperature[k]);
            t.surface += (particles.flags[k] & kSurface) != 0;
            t.undercooled +=
                (particles.flags[k] & kUnseeded) && particles.enthalpy[k] < materials[particles.material[k]].latent;
            t.bad += !isFinite(particles.position[k].xyz()) || !isFinite(particles.velocity[k].xyz()) ||
                     !std::isfinite(particles.enthalpy[k]);
        }
        blockTotals_[static_cast<size_t>(block)] = t;
    });
    massNow_ = energyNow_ = liquidMass_ = 0;
    minTemperature_ = INFINITY, maxTemperature_ = -INFINITY;
    badParticles_ = counters_.surface = undercooled_ = 0;
    for (int b = 0; b < blocks; ++b) {
        const Totals& t = blockTotals_[static_cast<size_t>(b)];
        massNow_ += t.mass, energyNow_ += t.energy, liquidMass_ += t.liquid;
        minTemperature_ = std::min(minTemperature_, t.minTemperature);
        maxTemperature_ = std::max(maxTemperature_, t.maxTemperature);
        counters_.surface += t.surface, badParticles_ += t.bad;
        undercooled_ += t.undercooled;
    }
    if (particles.count == 0) minTemperature_ = maxTemperature_ = def.ambientTemperature;
    counters_.moving = 0;
    rigidRows_ = 0;
    std::fill(std::begin(counters_.levels), std::end(counters_.levels), 0);
    for (int i = 0; i < particles.count; ++i) {
        ++counters_.levels[particles.level[static_cast<size_t>(i)]];
        const uint16_t piece = particles.piece[static_cast<size_t>(i)];
        counters_.moving += !particles.fixed(i), rigidRows_ += piece && !rigid_.pieceOf(piece).asleep;
    }
    counters_.moving += rigidRows_;
    counters_.fixed = particles.count - counters_.moving;
    anyCoarse_ = counters_.levels[0] < particles.count;
}

template <class F> int World::removeParticles(F&& remove, double& mass, double& energy) {
    int kept = 0;
    for (int i = 0; i < particles.count; ++i) {
        const size_t k = static_cast<size_t>(i);
        if (remove(k)) {
            const double m = particles.velocity[k].w;
            mass += m;
            if (std::isfinite(particles.enthalpy[k])) energy += m * particles.enthalpy[k];
            continue;
        }
        const size_t to = static_cast<size_t>(kept++);
        if (to != k) particles.copyRow(to, k);
    }
    const int gone = particles.count - kept;
    if (gone == 0) return 0;
    particles.count = kept;
    particles.moverCount = std::min(particles.moverCount, kept);
    particles.pad();
    rigid_.gather(particles);
    lookForHold();
    led_ = true; // who obeys what is another
    return gone;
}

void World::burnOff(double heatSeconds) {
    const auto burns = [](const Material& m) { return m.def.burnTemperature > 0; };
    if (std::none_of(materials.begin(), materials.end(), burns)) return;
    removeParticles(
        [&](size_t k) {
            return turnsToVapour(materials[particles.material[k]], particles.enthalpy[k], particles.id[k], steps_,
                                 heatSeconds);
        },
        massBurnt_, energyBurnt_);
}

thawResult World::addBody(const thawBodyDef& d, thawMeshReport& report, std::string& message, uint32_t& index1) {
    size_t slot;
    if (!freeSlot(bodies, def.maxBodies, "maxBodies", "bodies", slot, message)) return thawResult_capacity;
    CleanMesh mesh;
    const Transform place = toTransform(d.position, d.rotation, d.scale);
    thawResult r = cleanMesh(d.mesh, place, mesh, message);
    report = mesh.report;
    if (r != thawResult_ok) return r;
    std::vector<Vec3> points;
    float volume = 0;
    FillLattice lattice;
    // What is coarse takes fewer rows than it has points.
    const int room = def.maxParticles - particles.count;
    const int most = static_cast<int>(std::min<int64_t>(int64_t{room} << d.coarsestLevel, 1 << 27));
    r = fillMesh(mesh, def.particleSpacing, most, tasks, points, volume, message, &lattice);
    if (r == thawResult_capacity && d.coarsestLevel > 0)
        message += "; counted in the finest, with coarsestLevel " + std::to_string(d.coarsestLevel);
    if (r != thawResult_ok) return r;
    std::vector<uint8_t> materialOf;
    r = assignParts(d, mesh, place, points, tasks, materialOf, message);
    if (r != thawResult_ok) return r;
    const float temperature = std::isnan(d.temperature) ? def.ambientTemperature : d.temperature;
    Groups groups;
    if (d.coarsestLevel > 0) {
        std::vector<uint8_t> kind = materialOf;
        for (uint8_t& k : kind)
            if (!startsCoarse(materials[k], temperature)) k = kAlone;
        groups = groupPoints(points, kind, lattice);
    }
    const auto levelAt = [&](size_t at) {
        if (groups.order.empty()) return 0;
        const int level = std::min(groups.levelOf(at), d.coarsestLevel);
        return level < kHighestLevel && materials[materialOf[groups.order[at]]].soft() ? 0 : level; // see Levels
    };
    size_t rowsNeeded = 0;
    for (size_t at = 0; at < points.size(); at += size_t{1} << levelAt(at)) ++rowsNeeded;
    if (rowsNeeded > static_cast<size_t>(room)) {
        message = "maxParticles: the body needs " + std::to_string(rowsNeeded) + " particles at its coarsestLevel of " +
                  std::to_string(d.coarsestLevel) + ", but only " + std::to_string(room) + " are free";
        return thawResult_capacity;
    }
    if (bodies.size() <= slot) bodies.resize(slot + 1), bodyPoints_.resize(slot + 1), coarsestOf_.resize(slot + 1);
    coarsestOf_[slot] = static_cast<uint8_t>(d.coarsestLevel);
    const bool bends =
        std::any_of(materialOf.begin(), materialOf.end(), [&](uint8_t k) { return materials[k].soft(); });
    const Vec3 middle = d.coarsestLevel > 0 ? refer(slot, points, groups, volume, bends) : Vec3{};

    float meanDensity = materials[d.material.index1 - 1].def.density;
    if (d.partCount > 0) {
        double sum = 0;
        for (const uint8_t material : materialOf) sum += materials[material].def.density;
        meanDensity = static_cast<float>(sum / static_cast<double>(materialOf.size()));
    }
    const bool still = d.velocity.x == 0 && d.velocity.y == 0 && d.velocity.z == 0 && d.angularVelocity.x == 0 &&
                       d.angularVelocity.y == 0 && d.angularVelocity.z == 0;
    bool anySolid = false; // elastic
    const Vec3 gravity{def.gravity.x, def.gravity.y, def.gravity.z};
    float top = INFINITY;
    for (const Vec3& x : points) top = std::min(top, dot(x, gravity));
    const Vec3 velocity{d.velocity.x, d.velocity.y, d.velocity.z};
    const Vec3 spin{d.angularVelocity.x, d.angularVelocity.y, d.angularVelocity.z};
    double sum[3] = {};
    for (const Vec3& x : points) sum[0] += x.x, sum[1] += x.y, sum[2] += x.z;
    const double share = 1 / static_cast<double>(points.size());
    const Vec3 center{static_cast<float>(share * sum[0]), static_cast<float>(share * sum[1]),
                      static_cast<float>(share * sum[2])};
    std::vector<uint32_t> loose; // rows of the piece that a body makes which stands free
    if (!d.anchored) loose.reserve(points.size()), rigid_.reserve();
    for (size_t at = 0, step; at < points.size(); at += step) {
        const size_t point = groups.order.empty() ? at : groups.order[at];
        const int level = levelAt(at);
        step = size_t{1} << level;
        const Vec3 x = level > 0
                           ? middle + reference_.center(bodyPoints_[slot].begin + static_cast<uint32_t>(at), level)
                           : points[point];
        const uint8_t material = materialOf[point];
        const Material& m = materials[material];
        const double H = m.enthalpy(temperature);
        const float phi = m.liquidFraction(H);
        const float mass = volume * m.def.density * static_cast<float>(step);
        // What is liquid from the start carries the pressure of its depth: without it, it falls into itself for a third
        // of a second (in a tank by 4 % at the worst, by 10 % with half of that pressure).
        const bool liquid = phi >= m.def.releaseFraction;
        const bool soft = !liquid && m.soft(), free = liquid || (soft && !(still && d.anchored));
        anySolid |= soft;
        const size_t k = static_cast<size_t>(particles.count++);
        particles.clearRow(k);
        particles.position[k] = {x.x, x.y, x.z, supportOf(def.particleSpacing, level)};
        particles.level[k] = static_cast<uint8_t>(level);
        anyCoarse_ |= level > 0; // before the first look at its area
        if (!groups.order.empty() && startsCoarse(m, temperature)) {
            particles.fine[k] = bodyPoints_[slot].begin + static_cast<uint32_t>(at) + 1;
            particles.want[k] = Levels::kFar;
        }
        const Vec3 v = velocity + cross(spin, x - center); // of what is held, it is taken away when that is known
        particles.velocity[k] = {v.x, v.y, v.z, mass};
        particles.pressure[k] = liquid ? meanDensity * (dot(x, gravity) - top) : 0.0f;
        particles.velocityChange[k] = {
            0, 0, 0,
            liquid ? stiffStart(m.viscosity(phi), m.def.density, def.particleSpacing, particles.pressure[k]) : 0.0f};
        particles.enthalpy[k] = H;
        particles.temperature[k] = m.temperature(H);
        particles.liquidFraction[k] = phi;
        particles.id[k] = nextId_++;
        particles.body[k] = static_cast<uint16_t>(slot);
        particles.material[k] = material;
        particles.flags[k] = free ? 0 : soft ? kFixed | kAsleep : kFixed;
        if (m.def.undercooling > 0 && H >= m.latent) particles.flags[k] |= kUnseeded;
        if (!free && !soft && !d.anchored) loose.push_back(static_cast<uint32_t>(k));
        massAdded_ += mass;
        energyAdded_ += static_cast<double>(mass) * H;
    }
    particles.pad();
    if (!loose.empty())
        if (const uint16_t piece = rigid_.create(particles, loose.data(), loose.size(), 0)) rigid_.lost(piece);
    bodiesNew_ = true;
    bodies[slot].take();
    anchorsFresh_ = toldApart_;
    index1 = static_cast<uint32_t>(slot) + 1;
    holdStale_ = true;
    stepsSinceRelabel_ = kRelabelInterval;
    // Lists now and not in the first step: their memory is taken while the host loads, not while it plays. The body is
    // there whatever becomes of them; without memory the first step tries again and says so.
    listsStale_ = true;
    try {
        refreshNeighbors();
        refreshExposure();
        if (anySolid) bonds_.bondAll(bondFrame(0));
        boundStartPressure(static_cast<uint16_t>(slot));
    } catch (const std::bad_alloc&) {
        listsStale_ = true;
    }
    measure();
    return thawResult_ok;
}

void World::removeBody(uint32_t index) {
    removeParticles([&](size_t k) { return particles.body[k] == index; }, massRemoved_, energyRemoved_);
    bodies[index].alive = false;
    forget(index);
    measure();
}

thawBodyState World::bodyState(uint32_t index) const {
    thawBodyState s{};
    double mass = 0, liquid = 0, heat = 0, cx = 0, cy = 0, cz = 0;
    Box box;
    for (int i = 0; i < particles.count; ++i) {
        const size_t k = static_cast<size_t>(i);
        if (particles.body[k] != index) continue;
        ++s.particles;
        const Vec4& x = particles.position[k];
        const double m = particles.velocity[k].w;
        mass += m, liquid += m * particles.liquidFraction[k], heat += m * particles.temperature[k];
        cx += m * x.x, cy += m * x.y, cz += m * x.z;
        box.grow(x.xyz());
    }
    if (s.particles == 0) return s;
    s.mass = static_cast<float>(mass);
    s.meltedFraction = static_cast<float>(liquid / mass), s.meanTemperature = static_cast<float>(heat / mass);
    s.center = {static_cast<float>(cx / mass), static_cast<float>(cy / mass), static_cast<float>(cz / mass)};
    s.lower = {box.lower.x, box.lower.y, box.lower.z}, s.upper = {box.upper.x, box.upper.y, box.upper.z};
    return s;
}

thawResult World::addCollider(const thawColliderDef& d, thawMeshReport& report, std::string& message,
                              uint32_t& index1) {
    size_t slot;
    if (!freeSlot(colliderSlots, def.maxColliders, "maxColliders", "colliders", slot, message))
        return thawResult_capacity;
    Collider c;
    c.type = d.type;
    c.transform = toTransform(d.position, d.rotation, 1);
    c.size = {d.size.x, d.size.y, d.size.z};
    c.adhesive = d.adhesive, c.occluder = d.occluder, c.alive = true;
    c.slipLength = d.slipLength, c.friction = d.friction, c.report = d.reportImpulse;
    c.temperature = d.temperature, c.conductance = d.contactConductance;
    if (d.type == thawCollider_mesh) {
        const auto made = std::make_shared<ColliderForm>();
        const thawResult r = cleanMesh(d.mesh, {{}, {}, d.scale}, made->mesh, message);
        report = made->mesh.report;
        if (r != thawResult_ok) return r;
        const std::vector<Vec3>& vertices = made->mesh.vertices;
        const std::vector<uint32_t>& indices = made->mesh.indices;
        made->key = hashCombine(checksum(vertices.data(), vertices.size() * sizeof(Vec3)),
                                checksum(indices.data(), indices.size() * sizeof(uint32_t)));
        made->key = hashCombine(made->key, std::bit_cast<uint32_t>(def.particleSpacing));
        // Melt feels a wall within four spacings; beyond that a lower bound of the distance is enough.
        std::shared_ptr<const ColliderForm> known = colliderForms_.find(made->key);
        if (!known) {
            made->grid = makeDistanceGrid(made->mesh, 0.5f * def.particleSpacing, 5 * def.particleSpacing,
                                          size_t{8} << 20, tasks);
            known = made;
            colliderForms_.add(made, saves_);
        }
        c.take(known);
    }
    if (colliders.size() <= slot) colliders.resize(slot + 1), colliderSlots.resize(slot + 1);
    control_.expectColliders(colliders.size());
    colliders[slot] = std::move(c);
    colliderSlots[slot].take();
    index1 = static_cast<uint32_t>(slot) + 1;
    if (d.reportImpulse) toldApart_ = anchorsFresh_ = true;
    ++colliderVersion_, ++wallVersion_;
    lookForHold();
    return thawResult_ok;
}

void World::removeCollider(uint32_t index) {
    colliders[index] = Collider{};
    // Controls on it have no place any more.
    for (size_t k = 0; k < control_.paths().size(); ++k)
        if (control_.paths()[k].alive && control_.paths()[k].collider == index + 1)
            removePath(static_cast<uint32_t>(k));
    for (size_t k = 0; k < control_.shapes().size(); ++k)
        if (control_.shapes()[k].alive && control_.shapes()[k].collider == index + 1)
            removeShape(static_cast<uint32_t>(k));
    // What hung on it hangs on nothing now, and on nobody who comes to its place.
    for (int i = 0; i < particles.count; ++i)
        if (particles.anchor[static_cast<size_t>(i)] == index + 1) particles.anchor[static_cast<size_t>(i)] = 0;
    colliderSlots[index].alive = false;
    pruneForms();
    ++colliderVersion_, ++wallVersion_;
    lookForHold();
}

thawLedger World::ledger() const {
    thawLedger l{};
    l.massAdded = massAdded_, l.massRemoved = massRemoved_, l.massNow = massNow_;
    l.massBurnt = massBurnt_, l.energyBurnt = energyBurnt_;
    l.energyAdded = energyAdded_, l.energyRemoved = energyRemoved_, l.energyNow = energyNow_;
    std::copy(std::begin(controlImpulse_), std::end(controlImpulse_), std::begin(l.controlImpulse));
    l.controlEnergy = controlEnergy_, l.controlHeat = controlHeat_;
    l.painted = painted_, l.redefined = redefined_, l.absorbed = absorbed_, l.contact = contact_, l.emitted = emitted_,
    l.convected = convected_;
    l.massError = massAdded_ > 0 ? std::abs(massNow_ - massAdded_ + massRemoved_ + massBurnt_) / massAdded_ : 0;
    const double expected = energyAdded_ - energyRemoved_ - energyBurnt_ + painted_ + redefined_ + absorbed_ +
                            contact_ - emitted_ - convected_ - controlHeat_;
    const double scale = std::max({std::abs(energyAdded_ - energyRemoved_), std::abs(energyBurnt_), std::abs(painted_),
                                   std::abs(redefined_), std::abs(absorbed_), std::abs(contact_), std::abs(emitted_),
                                   std::abs(convected_), std::abs(controlHeat_)});
    l.energyError = scale > 0 ? std::abs(energyNow_ - expected) / scale : 0;
    return l;
}

thawCounters World::counters() const {
    thawCounters c = counters_;
    c.particles = particles.count, c.capacity = def.maxParticles;
    c.materials = static_cast<int32_t>(materials.size());
    for (const Slot& b : bodies) c.bodies += b.alive;
    for (const Collider& x : colliders) c.colliders += x.alive;
    for (const HeatSource& s : sources) c.heatSources += s.alive;
    for (const Slot& s : pathSlots) c.paths += s.alive;
    for (const Slot& s : shapeSlots) c.shapes += s.alive;
    c.pieces = pieces(nullptr, 0);
    c.neighborsMax = neighbors_.maxNeighbors, c.neighborsMean = neighbors_.meanNeighbors;
    c.meltedFraction = massNow_ > 0 ? static_cast<float>(liquidMass_ / massNow_) : 0;
    c.minTemperature = minTemperature_, c.maxTemperature = maxTemperature_;
    c.steps = steps_, c.time = time_;
    c.memoryBytes = allocator.bytes();
    return c;
}

int World::pieces(thawPieceState* out, int capacity) const {
    int n = 0;
    for (const RigidPiece& b : rigid_.pieces()) {
        if (!b.alive) continue;
        const auto host = [](Double3 v) {
            const Vec3 f = narrow(v);
            return thawVec3{f.x, f.y, f.z};
        };
        if (n++ < capacity)
            out[n - 1] = {b.id,
                          static_cast<int32_t>(b.rows),
                          static_cast<float>(b.mass),
                          host(b.center),
                          host(b.velocity),
                          host(b.spin),
                          b.asleep};
    }
    return n;
}

} // namespace thaw
