// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/motion.h"

#include "motion/numbers.h"
#include "motion/pairs.h"
#include "motion/rigid_liquid.h"
#include "motion/walls.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

// The fixed particles around a mover as one smooth wall: distance by how much of the support they fill, normal by how
// that changes. Single particles leave hollows through which others sink, layer after layer. fixed: of HeldPass.
Vec4 heldSurface(const Vec4& fixed, float h) {
    const float filled = fixed.w, steep = length(fixed.xyz()) * h;
    if (!(filled > 1e-3f) || !(steep > 0.05f)) return {0, 0, 0, INFINITY};
    const float q = wallDistance(filled);
    const Vec3 n = (-h / steep) * fixed.xyz();
    return {n.x, n.y, n.z, q * h};
}

bool outside(const Box& b, Vec3 p, float margin) {
    return p.x < b.lower.x - margin || p.x > b.upper.x + margin || p.y < b.lower.y - margin ||
           p.y > b.upper.y + margin || p.z < b.lower.z - margin || p.z > b.upper.z + margin;
}

} // namespace

Motion::Motion(Allocator& a)
    : colliderBounds_(a), contact_(a), contactAdhesive_(a), contactCount_(a), contactOf_(a), contactSlope_(a),
      mirror_(a), mirrorChange_(a), wallVelocity_(a), wallPush_(a), heldVelocity_(a), kick_(a), heldKick_(a),
      reportSlot_(a), reports_(a), held_(a), landing_(a), landingOn_(a), wallGradient_(a), trait_(a), ownViscosity_(a),
      point_(a), coefficient_(a), wallDrag_(a), inverse_(a), cross_(a), before_(a), residual_(a), direction_(a),
      image_(a), grip_(a), slide_(a), bodies_(a), bodyRow_(a), bodyOf_(a), block_(a), unslid_(a), target_(a), piece_(a),
      queue_(a), pieceEnd_(a), sums_(a) {}

void Motion::begin(const MotionFrame& f) {
    stats_ = {};
    Particles& p = f.particles;
    if (f.rigid) f.rigid->begin(f);
    bonded_ = f.bonds && f.bonds->any();
    reporting_ = false;
    if (p.moverCount == 0) return;
    if (bonded_) f.bonds->lay(f.bondFrame());

    const size_t rows = static_cast<size_t>(p.count) + Particles::kPadding;
    const size_t movers = static_cast<size_t>(8 * f.neighbors.moverGroups);
    contact_.resizeRaw(movers * kContacts), contactAdhesive_.resizeRaw(movers * kContacts);
    contactCount_.resizeRaw(movers), held_.resizeRaw(movers), piece_.resizeRaw(movers), queue_.resizeRaw(movers),
        pieceEnd_.resizeRaw(movers), landing_.resizeRaw(movers), landingOn_.resizeRaw(movers),
        wallGradient_.resizeRaw(movers), wallDrag_.resizeRaw(2 * movers);
    inverse_.resizeRaw(movers), cross_.resizeRaw(movers), before_.resizeRaw(movers), residual_.resizeRaw(movers),
        image_.resizeRaw(movers);
    trait_.resizeRaw(rows), point_.resizeRaw(rows), direction_.resizeRaw(rows), target_.resizeRaw(rows);
    coefficient_.resizeRaw(f.neighbors.entries.size());
    sums_.assign(static_cast<size_t>(Tasks::blockCount(f.neighbors.moverGroups, kBlock)), {});

    colliderBounds_.resizeRaw(static_cast<size_t>(f.colliderCount));
    reportSlot_.resizeRaw(static_cast<size_t>(f.colliderCount));
    reporters_ = 0;
    wallsMove_ = thinWalls_ = slippery_ = false;
    for (int c = 0; c < f.colliderCount; ++c) {
        const Collider& o = f.colliders[c];
        reportSlot_[static_cast<size_t>(c)] = o.alive && o.report ? static_cast<int32_t>(reporters_++) : -1;
        if (!o.alive) continue;
        colliderBounds_[static_cast<size_t>(c)] = o.sweptBounds();
        wallsMove_ |= o.moves, slippery_ |= o.slipLength > 0, thinWalls_ |= o.halfThickness() < kThinWall * f.spacing;
    }
    reporting_ = reporters_ > 0, rims_ = f.rim;
    wallsMove_ |= f.rim && f.rimVelocity;
    reports_.assign(sums_.size() * reporters_, {});
    if (kicks()) kick_.assign(movers * kContacts, {});
    if (reporting_) heldKick_.assign(movers, {});
    contactOf_.resizeRaw(movers * kContacts);
    if (kicks() || wallsMove_) contactSlope_.resizeRaw(movers * kContacts);
    if (wallsMove_) wallVelocity_.resizeRaw(movers * kContacts), wallPush_.resizeRaw(movers);
    heldMoves_ = f.heldSpeed > 0;
    if (heldMoves_) heldVelocity_.resizeRaw(movers);
    otherHeld_ = bonded_ || (f.rigid && f.rigid->any());

    // Rows that do not move: what their neighbours read of them. A particle that has just set still carries some
    // pressure, which fades (taken away at once, its neighbours would fall freely for a frame).
    if (bonded_) {
        grip_.assign(movers, {});
        slide_.resizeRaw(movers), bodyRow_.resizeRaw(movers), bodyOf_.resizeRaw(movers), block_.resizeRaw(2 * movers),
            unslid_.resizeRaw(2 * movers);
    }
    findUnlike(f);
    severalMaterials_ = false;
    forMaterials(p, p.moverCount, [&](uint8_t m) { severalMaterials_ |= m != p.material[0]; });
    if (severalMaterials_) ownViscosity_.assign(rows, 0);
    const int still = static_cast<int>(rows) - p.moverCount;
    f.tasks.forBlocks(still, 8 * kBlock, [&](int begin, int end, int, int) {
        for (int r = begin; r < end; ++r) {
            const size_t i = static_cast<size_t>(p.moverCount + r);
            const Vec3 x = p.position[i].xyz();
            const bool real = p.moverCount + r < p.count;
            const bool coheres = real && !p.bondSlot[i];
            const float drag = real && mirrors(f, i) ? kHeldDrag : 1;
            trait_[i] = {-drag, coheres ? f.materials[p.material[i]].def.cohesion * (0.1f * kGravity) : 0.0f,
                         p.velocity[i].w, p.pressure[i]};
            if (!heldMoves_ && !p.piece[i]) p.velocity[i].setXyz({});
            point_[i] = {x.x, x.y, x.z, 0};
            direction_[i] = {};
            target_[i] = {x.x, x.y, x.z, -heldSupport(p.position[i].w, 1 - p.velocityChange[i].w)};
        }
    });

    const float shear = shearMoment(), bulk = bulkStiffness(), fold = pressureFold(f.subSteps) * f.dt;
    const float stepTime = f.dt * static_cast<float>(f.subSteps);
    // Mirrors of unlike liquids are made of the neighbours' distances: all have to be known first.
    if (unlike_)
        f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int block, int) {
            findWalls(f, begin, end, block);
            for (int r = 8 * begin, last = std::min(8 * end, p.moverCount); r < last; ++r)
                mirror_[static_cast<size_t>(r)].unlike = unlikeness(f, static_cast<size_t>(r));
        });
    f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int block, int) {
        const int last = std::min(8 * end, p.moverCount);
        if (!unlike_) findWalls(f, begin, end, block);
        if (heldMoves_)
            for (int r = 8 * begin; r < last; ++r) {
                // As heavy as they weigh in the density: what is near counts most.
                const size_t i = static_cast<size_t>(r);
                const uint32_t g = static_cast<uint32_t>(r) >> 3, lane = static_cast<uint32_t>(r) & 7;
                const size_t first = f.neighbors.first[g] + lane;
                Vec3 sum;
                float weight = 0;
                for (uint32_t k = 0; k < f.neighbors.width[g]; ++k) {
                    const uint32_t j = f.neighbors.entries[first + 8 * k] >> 4;
                    if (j < static_cast<uint32_t>(p.moverCount)) continue;
                    const float w = -f.neighbors.gradient[first + 8 * k];
                    sum += w * p.velocity[j].xyz(), weight += w;
                }
                sum = weight > 0 ? (1 / weight) * sum : Vec3{};
                heldVelocity_[i] = {sum.x, sum.y, sum.z, 0};
            }
        pairHeld({PairLists(f.neighbors), p.position.data(), f.volume, p.moverCount, held_.data()}, begin, end);
        BlockSums& sums = sums_[static_cast<size_t>(block)];
        // Neighbours in memory mostly share material and liquid fraction: the exponential is kept.
        int material = -1;
        float phi = -1, viscosity = 0;
        for (int r = 8 * begin; r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            const Vec3 x = p.position[i].xyz();
            const float h = p.position[i].w, spacing = h / kSupport, density = 1 / f.invDensity[i];

            const int n = contactCount_[i];
            piece_[i] = held_[i].w > 0 || (f.guide && f.guide[i].w > 0) || (n && contact_[i * kContacts].w < h)
                            ? kLeaning
                            : kUnknown;
            const Vec4 fixed = held_[i];
            held_[i] = heldSurface(fixed, h);
            float solid = 0;
            Vec3 gradient;
            if (n) weighWalls(f, i, solid, gradient);
            if (fixed.w > 0) gradient += heldMirror(f, i, fixed.xyz());
            const float error = f.neighbors.volumeFraction[i] + solid - 1;
            float& blend = p.blend[i];
            if (blend != 0) blend = settled(blend, error, f.dt);
            wallGradient_[i] = {gradient.x, gradient.y, gradient.z, error - blend};
            if (!p.bondSlot[i]) sums.a += std::max(error, 0.0f), sums.c = std::max(sums.c, error);

            // dC/dP of this particle's own pressure. Between fixed neighbours it grows without bound and winds the
            // pressure up, which the next warm start turns into 20 m/s (BAKEOFF2 A1): so it is capped, and what was
            // wound up with a larger one is scaled down. Not where compressed: there the pressure is needed.
            const Vec4 own = f.neighbors.gradientSum[i];
            const Vec3 sum = own.xyz() + gradient;
            float stiffness = 1 / (dot(sum, sum) * f.invDensity[i] + f.volume[i] * own.w + 1e-30f);
            stiffness = std::min(stiffness, kStiffnessCap * bulk * density * spacing * spacing);
            float pressure = std::max(p.pressure[i], 0.0f);
            // Springs carry a solid, which has no pressure of its own; what it had when it set fades. (With one, the
            // viscous solve never converges.) Other solids push it by springs too, not as a surface.
            const bool elastic = p.bondSlot[i] != 0;
            if (elastic) {
                stiffness = 0, pressure = pressure > 1 ? pressure * kPressureFade : 0;
                held_[i].w = INFINITY;
            }
            const bool besidePiece = fixed.w > 0 && f.rigid && f.rigid->any();
            if (!elastic && p.stiffness[i] > 0 && error < (besidePiece ? kRescaleBesidePiece : kRescaleBelow))
                pressure *= std::min(1.0f, stiffness / p.stiffness[i]);
            p.pressure[i] = pressure, p.stiffness[i] = stiffness;

            if (p.material[i] != material || p.liquidFraction[i] != phi) {
                material = p.material[i], phi = p.liquidFraction[i];
                viscosity = f.materials[material].viscosity(phi);
            }
            const float wanted = viscosity + p.velocityChange[i].w;
            const float floor = apparentFloor(density, spacing, stepTime, length(p.velocity[i].xyz()));
            const float least = std::max(wanted, floor), folded = shear * fold * pressure;
            const float solved = std::sqrt(least * least + folded * folded);
            if (solved > viscosity && !elastic) sums.d = std::max(sums.d, solved);
            if (severalMaterials_) ownViscosity_[i] = wanted / shear;
            trait_[i] = {solved / shear, elastic ? 0.0f : f.materials[material].def.cohesion * (0.1f * kGravity),
                         p.velocity[i].w, pressure};
            point_[i] = {x.x, x.y, x.z, 0};
        }
        // Rows of the last group that do not move have no part in anything.
        for (int r = last; r < 8 * end; ++r) {
            const size_t i = static_cast<size_t>(r);
            contactCount_[i] = 0, held_[i] = {0, 0, 0, INFINITY}, wallGradient_[i] = {};
        }
    });

    double total = 0, landing = 0;
    for (const BlockSums& s : sums_) {
        total += s.a, landing += s.b;
        stats_.maxCompression = std::max(stats_.maxCompression, s.c);
        stats_.apparentViscosity = std::max(stats_.apparentViscosity, s.d);
    }
    stats_.meanCompression = static_cast<float>(total / p.moverCount);
    if (unlike_) weighMirrors(f);
    if (landing > 0) land(f);
}

void Motion::holdAtWalls(const MotionFrame& f, size_t i) {
    Vec4& velocity = f.particles.velocity[i];
    const float dt = f.dt, spacing = f.particles.position[i].w / kSupport;
    Vec3 v = velocity.xyz();
    for (size_t c = i * kContacts, end = c + contactCount_[i]; c < end; ++c) {
        const Vec4 k = contact_[c];
        const float gap = k.w - kWallStandoff * spacing;
        float need = -gap / dt;
        if (gap < 0) need = std::min(need, kWallRecovery * spacing / dt);
        float into = dot(k.xyz(), v);
        if (wallsMove_) into -= dot(k.xyz(), wallVelocity_[c].xyz());
        if (!(into < need)) continue;
        v += (need - into) * k.xyz();
        kick(c, (need - into) * k.xyz());
    }
    // Melt that lies in a pocket of solid may stay there: it is not driven out, it only gets no deeper.
    const Vec4 held = held_[i];
    if (held.w < INFINITY) {
        const float need = std::min(0.0f, (kHeldStandoff * spacing - held.w) / dt);
        float into = dot(held.xyz(), v);
        RigidLiquid::Near* piece = f.coupling ? f.coupling->near(i) : nullptr;
        if (piece)
            into -= dot(held.xyz(), f.coupling->velocityAt(f, *piece));
        else if (heldMoves_)
            into -= dot(held.xyz(), heldVelocity_[i].xyz());
        if (into < need) {
            v += (need - into) * held.xyz();
            if (piece) piece->impulse -= (velocity.w * (need - into)) * held.xyz();
            if (reporting_) heldKick_[i].setXyz(heldKick_[i].xyz() + (need - into) * held.xyz());
        }
    }
    velocity.setXyz(v);
}

int Motion::subStepsWanted(const Particles& p, float dt, Vec3 gravity, float spacing, int limit,
                           const Collider* colliders, int colliderCount) {
    if (p.moverCount == 0 || limit <= 1) return 1;
    // Histograms over sub-steps wanted, so that single particles (one drop that lands, one spike of pressure) decide
    // nothing: what lands as a drip needs no sub-steps (measured, 9 % compression at worst).
    constexpr int kMost = 16, kApproachMost = 4;
    int depth[kMost + 1] = {}, approach[kApproachMost + 1] = {};
    Box held;
    for (int r = p.moverCount; r < p.count; ++r) held.grow(p.position[static_cast<size_t>(r)].xyz());
    float low = INFINITY, high = -INFINITY;
    const Vec3 down = normalizeOr(gravity, {});
    bool wallsMove = false;
    for (int c = 0; c < colliderCount; ++c) wallsMove |= colliders[c].alive && colliders[c].moves;
    for (int r = 0; r < p.moverCount; ++r) {
        const size_t i = static_cast<size_t>(r);
        const Vec3 x = p.position[i].xyz(), way = dt * p.velocity[i].xyz();
        const float along = dot(x, down);
        low = std::min(low, along), high = std::max(high, along);
        const float d = p.position[i].w / kSupport, density = p.velocity[i].w / (d * d * d);
        const float g = p.pressure[i] * dt * dt / (density * d * d);
        int k = 1;
        while (k < kMost && g > kDepthPerStep * static_cast<float>(k * k)) ++k;
        ++depth[k];

        // What comes to moving walls and to fixed particles in the step. Walls that stand are no matter of sub-steps:
        // see Motion::land.
        const bool slow = !(dot(way, way) > kApproachPerStep * kApproachPerStep * d * d);
        if (slow && !wallsMove) continue;
        float toward = 0;
        for (int c = 0; wallsMove && c < colliderCount; ++c) {
            if (!colliders[c].alive || !colliders[c].moves) continue;
            const Vec3 relative = way - colliders[c].displacement(x);
            if (slow && !(dot(relative, relative) > kApproachPerStep * kApproachPerStep * d * d)) continue;
            Vec3 normal;
            const float distance = colliders[c].distance(x, normal), into = -dot(normal, relative);
            if (distance - into < d) toward = std::max(toward, into);
        }
        if (!slow && outside(held, x, d) && !outside(held, x + way, d)) toward = std::max(toward, length(way));
        int a = 1;
        while (a < kApproachMost && toward > kApproachPerStep * d * static_cast<float>(a)) ++a;
        ++approach[a];
    }
    const float extent = (high - low + spacing) * length(gravity) * dt * dt / (spacing * spacing);
    int deepest = 1;
    while (deepest < kMost && extent > kDepthPerStep * static_cast<float>(deepest * deepest)) ++deepest;

    const int few = std::max(8, p.moverCount / 100);
    int wanted = 1;
    for (int k = kMost, n = 0; k > 1; --k)
        if ((n += depth[k]) >= few) {
            wanted = std::min(k, deepest);
            break;
        }
    for (int k = kApproachMost, n = 0; k > wanted; --k)
        if ((n += approach[k]) >= 2 * few) {
            wanted = k;
            break;
        }
    return std::min(wanted, limit);
}

} // namespace thaw
