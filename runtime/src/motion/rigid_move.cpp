// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// The motion of pieces: gravity, contacts, positions, and when they rest.
#include "base/kernel.h"
#include "motion/rigid.h"
#include "motion/rigid_numbers.h"

#include <algorithm>

namespace thaw {
namespace {

Double3 gravityOf(const MotionFrame& f) { return wide(f.gravity); }

bool meets(const Box& a, const Box& b, float margin) {
    return a.lower.x < b.upper.x + margin && b.lower.x < a.upper.x + margin && a.lower.y < b.upper.y + margin &&
           b.lower.y < a.upper.y + margin && a.lower.z < b.upper.z + margin && b.lower.z < a.upper.z + margin;
}
Box swept(const Box& b, float by) { return {b.lower - Vec3{by, by, by}, b.upper + Vec3{by, by, by}}; }

} // namespace

// From the velocities of the start: gravity, half of it in the first free step, and what the liquid did.
void Rigid::kick(const MotionFrame& f) {
    const double dt = f.dt;
    for (RigidPiece& b : pieces_) {
        if (!b.alive || b.asleep) continue;
        b.velocity = b.startVelocity + (b.fresh ? 0.5 * dt : dt) * gravityOf(f) + (1 / b.mass) * b.linear;
        b.spin = b.startSpin + b.inverseInertia * b.angular;
    }
}

// What is about to be hit is awake when it is: a sleeper holds against whatever comes.
bool Rigid::wakeHit(double dt) {
    bool woken = false;
    for (const RigidContact& c : contacts_) {
        if (c.other >= RigidContact::kHeld) continue;
        RigidPiece &a = pieces_[c.a], &b = pieces_[c.other];
        if (a.asleep == b.asleep) continue;
        const auto before = [&](const RigidPiece& q) {
            return q.startVelocity + cross(q.startSpin, c.point - q.center);
        };
        if (dot(c.normal, before(a) - before(b)) > -std::max(0.0, c.gap) / dt - kCalmSpeed) continue;
        (a.asleep ? a : b).asleep = false;
        woken = true;
    }
    return woken;
}

void Rigid::begin(const MotionFrame& f) {
    gather(f.particles);
    if (!any()) return;
    colliderBounds_.resizeRaw(static_cast<size_t>(f.colliderCount));
    for (int c = 0; c < f.colliderCount; ++c) {
        if (!f.colliders[c].alive) continue;
        colliderBounds_[static_cast<size_t>(c)] = f.colliders[c].sweptBounds();
        if (f.colliders[c].moves) wakeNear(f.colliders[c], f.spacing);
    }
    for (RigidPiece& b : pieces_)
        b.startVelocity = b.velocity, b.startSpin = b.spin, b.linear = b.angular = b.pushed = {}, b.bedded = false;
    loadsBefore_.swap(loads_);
    kick(f);
    findContacts(f);
    if (wakeHit(f.dt)) kick(f), findContacts(f);
    prepareContacts(f.dt);
    for (const RigidContact& c : contacts_) apply(c, c.push * c.normal + c.rub);
    solve(kSweepsBetween, f.dt, false);
    setVelocities(f);
}

// What lies in the way of a collider, or on it.
void Rigid::wakeNear(const Collider& collider, float spacing) {
    for (RigidPiece& b : pieces_) {
        if (!b.alive || !b.asleep) continue;
        const Vec3 center = narrow(b.center);
        const float radius = static_cast<float>(b.radius) + spacing;
        Vec3 normal;
        if (collider.distance(center, normal) - radius > collider.reachOfMotion(center, radius)) continue;
        b.asleep = false, b.calm = 0;
    }
}

void Rigid::addImpulses(Collider* colliders) const {
    for (const RigidContact& c : contacts_) {
        if (!(c.other & RigidContact::kWall)) continue;
        Collider& on = colliders[c.other & ~RigidContact::kWall];
        if (!on.report) continue;
        const Double3 j = -1.0 * (c.push * c.normal + c.rub);
        const Double3 t = cross(c.point - wide(on.transform.position), j);
        const double six[6] = {j.x, j.y, j.z, t.x, t.y, t.z};
        for (int k = 0; k < 6; ++k) on.impulse[k] += six[k];
    }
}

void Rigid::settle(const MotionFrame& f) {
    kick(f);
    for (const RigidContact& c : contacts_) apply(c, c.push * c.normal + c.rub);
    solve(kSweepsBetween, f.dt, false);
    setVelocities(f);
}

void Rigid::decide(const MotionFrame& f) {
    if (!any()) return;
    const double dt = f.dt;
    kick(f);
    for (const RigidContact& c : contacts_) apply(c, c.push * c.normal + c.rub);
    solve(kSweeps, dt, true);

    const uint32_t slots = static_cast<uint32_t>(pieces_.size());
    shares_.assign(slots, 1);
    for (uint32_t s = 0; s < slots; ++s)
        if (awake(s)) followWalls(f, s), followTurn(f, s);
    for (uint32_t s = 0; s < slots; ++s)
        if (awake(s)) followSolids(f, s);
    setVelocities(f);
}

void Rigid::advance(const MotionFrame& f) {
    if (!any()) return;
    const double dt = f.dt;
    const uint32_t slots = static_cast<uint32_t>(pieces_.size());
    for (uint32_t s = 0; s < slots; ++s)
        if (awake(s)) integrate(f, s);
    solve(kSweepsAfter, dt, false);
    for (uint32_t s = 0; s < slots; ++s) {
        // What stopped short did so without the gravity of the time that it lost: or it gained energy.
        RigidPiece& b = pieces_[s];
        if (awake(s) && shares_[s] < 1 && !b.carried) b.velocity -= ((1 - shares_[s]) * dt) * gravityOf(f);
        b.fresh = false;
    }
    keepLoads(dt);
    rest(f);
    setVelocities(f);
}

// How far a fast piece goes before it comes close to a wall: no two steps may lie on either side of a thin one. Planes
// have no other side, and what is near already is a contact.
void Rigid::followWalls(const MotionFrame& f, uint32_t slot) {
    const RigidPiece& b = pieces_[slot];
    const Particles& p = f.particles;
    const double dt = f.dt, spacing = f.spacing;
    float walled = 0; // m, that colliders go
    for (int c = 0; c < f.colliderCount; ++c)
        if (f.colliders[c].alive && f.colliders[c].moves)
            walled = std::max(walled, f.colliders[c].reachOfMotion(narrow(b.center), static_cast<float>(b.radius)));
    if (b.reach() * dt + static_cast<double>(walled) <= kFollowFrom * spacing) return;
    WallFinder walls;
    const float way = static_cast<float>(b.reach() * dt + 2 * spacing) + walled;
    walls.gather(f.colliders, colliderBounds_.data(), f.colliderCount, b.bounds, way);
    if (walls.empty()) return;
    double& share = shares_[slot];
    const uint32_t* rows = rowsOf(b);
    for (uint32_t k = 0; k < b.rows; ++k) {
        const size_t i = rows[k];
        const Vec3 x = p.position[i].xyz();
        const Double3 own = b.velocityAt(wide(x));
        const double radius = 0.5 * static_cast<double>(p.position[i].w) / kSupport;
        walls.forNear(x, way, [&](float distance, Vec3, const Collider& c) {
            double room = static_cast<double>(distance) - radius, time = 0;
            const Double3 v = own - wide(c.velocityAt(x)); // as the wall sees it
            const double speed = length(v);
            if (c.type == thawCollider_plane || room < kCurvedMargin * spacing || !(speed * dt > kFollowFrom * spacing))
                return;
            for (int n = 0; n < 64; ++n) {
                time += std::max(room - kStopShort * spacing, 0.05 * spacing) / speed;
                if (time >= share * dt) return;
                Vec3 normal;
                room = static_cast<double>(c.distance(narrow(wide(x) + time * v), normal)) - radius;
                if (room <= 1.01 * kStopShort * spacing) break;
            }
            share = time / dt;
        });
    }
}

// The same toward other solids, in the frame of the other, whose rows are where the lists know them.
void Rigid::followSolids(const MotionFrame& f, uint32_t slot) {
    // Of centres, in spacings: nearer at the start it is a contact, and so near it stops.
    constexpr double kNear = 1.8, kStop = 1.6;
    const Particles& p = f.particles;
    const RigidPiece& b = pieces_[slot];
    const double dt = f.dt, spacing = f.spacing;
    const float support = kSupport * f.spacing;
    const uint32_t* rows = rowsOf(b);
    const auto follow = [&](uint16_t other, const Box& bounds, const RigidPiece* o) {
        const float way = static_cast<float>((b.reach() + (o ? o->reach() : 0)) * dt);
        if (way <= kFollowSolidFrom * f.spacing || !meets(swept(b.bounds, way), bounds, support)) return;
        double share = 1;
        for (uint32_t k = 0; k < b.rows; ++k) {
            const Double3 x = wide(p.position[rows[k]].xyz());
            const Double3 v = b.velocityAt(x) - (o ? o->velocityAt(x) : Double3{});
            const double speed = length(v);
            if (!(speed * dt > kFollowSolidFrom * spacing)) continue;
            Box path;
            path.grow(narrow(x)), path.grow(narrow(x + dt * v));
            if (!meets(path, bounds, support)) continue;
            double time = 0;
            for (int n = 0; n < 256; ++n) {
                const Vec3 at = narrow(x + time * v);
                double nearest = support;
                f.neighbors.forFixedCandidates(at, support, [&](int j) {
                    const size_t i = static_cast<size_t>(j);
                    if (p.piece[i] != other) return;
                    // What is coarse reaches farther.
                    const float wider = 0.5f * (p.position[i].w + p.position[rows[k]].w) / support;
                    nearest = std::min(nearest, static_cast<double>(length(p.position[i].xyz() - at) / wider));
                });
                if (n == 0 && nearest < kNear * spacing) break;
                if (nearest <= 1.01 * kStop * spacing) {
                    share = std::min(share, time / dt);
                    break;
                }
                time += (nearest - kStop * spacing) / speed;
                if (time >= share * dt) break;
            }
        }
        shares_[slot] = std::min(shares_[slot], share);
        if (o) shares_[other - 1u] = std::min(shares_[other - 1u], share);
    };
    Box held;
    for (int r = p.moverCount; r < p.count; ++r)
        if (!p.piece[static_cast<size_t>(r)]) held.grow(p.position[static_cast<size_t>(r)].xyz());
    if (!held.empty()) follow(0, held, nullptr);
    for (uint32_t s = 0; s < pieces_.size(); ++s)
        if (s != slot && pieces_[s].alive)
            follow(static_cast<uint16_t>(s + 1), swept(pieces_[s].bounds, static_cast<float>(pieces_[s].reach() * dt)),
                   &pieces_[s]);
}

// Positions; the spin after it keeps the angular momentum, and never adds energy.
void Rigid::integrate(const MotionFrame& f, uint32_t slot) {
    RigidPiece& b = pieces_[slot];
    Particles& p = f.particles;
    const double time = shares_[slot] * static_cast<double>(f.dt);
    const Double3 to = b.center + time * b.velocity;
    const bool turns = b.spin.x != 0 || b.spin.y != 0 || b.spin.z != 0;
    const Rotation3 turn = b.turnIn(time);
    const uint32_t* rows = rowsOf(b);
    for (uint32_t k = 0; k < b.rows; ++k) {
        Vec4& x = p.position[rows[k]];
        const Double3 d = wide(x.xyz()) - b.center;
        x.setXyz(narrow(to + (turns ? turn.apply(d) : d)));
    }
    const Double3 angular = b.inertia * b.spin;
    const double energy = dot(b.spin, angular);
    b.center = to;
    if (!turns) return;
    if (f.reference)
        for (uint32_t k = 0; k < b.rows; ++k)
            f.reference->turn(p, rows[k], [&](Vec3 v) { return narrow(turn.apply(wide(v))); });
    b.inertia = {};
    for (uint32_t k = 0; k < b.rows; ++k) {
        const size_t i = rows[k];
        b.inertia.addMass(p.velocity[i].w, wide(p.position[i].xyz()) - to,
                          static_cast<double>(p.position[i].w) / kSupport);
    }
    b.inverseInertia = inverse(b.inertia);
    b.spin = b.inverseInertia * angular;
    const double now = dot(b.spin, angular);
    if (now > energy) b.spin = std::sqrt(energy / now) * b.spin;
}

void Rigid::rest(const MotionFrame& f) {
    const double dt = f.dt;
    for (RigidPiece& b : pieces_) b.load = (1 / dt) * (b.linear - b.pushed), b.carried = false;
    for (const Load& l : loads_) {
        pieces_[l.a].carried = true;
        if (l.other >= RigidContact::kHeld) continue;
        pieces_[l.other].carried = true;
        pieces_[l.a].load += (1 / dt) * l.total, pieces_[l.other].load -= (1 / dt) * l.total;
    }
    const double weight = std::max(1.0, static_cast<double>(length(f.gravity)));
    for (RigidPiece& b : pieces_) {
        if (!b.alive) continue;
        if (b.asleep) {
            if (length(b.load - b.restLoad) > kWakeShare * b.mass * weight) b.asleep = false, b.calm = 0;
            continue;
        }
        if (b.bedded) continue; // Bonds says when
        b.calm = b.reach() < kCalmSpeed && b.carried ? static_cast<uint16_t>(b.calm + 1) : uint16_t{0};
        if (b.calm >= kCalmSteps) layToRest(static_cast<uint16_t>(&b - pieces_.data() + 1));
    }
}

void Rigid::layToRest(uint16_t piece) {
    RigidPiece& b = pieces_[piece - 1u];
    b.asleep = true, b.calm = 0;
    b.velocity = b.spin = b.drag = b.dragSpin = {};
    b.restLoad = b.load;
}

} // namespace thaw
