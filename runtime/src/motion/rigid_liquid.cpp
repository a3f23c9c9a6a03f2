// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/rigid_liquid.h"

#include "base/kernel.h"
#include "motion/pairs.h"
#include "motion/rigid_numbers.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

void hand(RigidPiece& b, Double3 impulse, Double3 at) {
    b.linear += impulse, b.angular += cross(at - b.center, impulse);
}

} // namespace

RigidLiquid::RigidLiquid(Allocator& a) : pairs_(a), near_(a), nearOf_(a), unknowns_(a), group_(a), soft_(a) {}

void RigidLiquid::gather(const MotionFrame& f, const Vec4* trait, const Vec4* moverStart) {
    const Particles& p = f.particles;
    rigid_ = f.rigid;
    pairs_.clear(), near_.clear(), unknowns_.clear(), soft_.clear();
    Array<RigidPiece>& pieces = rigid_->pieces();
    const uint32_t movers = static_cast<uint32_t>(p.moverCount);
    const float weight = 10 * latticeSum() * f.dt;
    for (uint32_t slot = 0; slot < pieces.size(); ++slot) {
        RigidPiece& b = pieces[slot];
        if (!b.alive) continue;
        const size_t firstPair = pairs_.size();
        const uint32_t* rows = rigid_->rowsOf(b);
        for (uint32_t k = 0; k < b.rows; ++k) {
            const uint32_t j = rows[k], g = j >> 3, lane = j & 7;
            const Vec4 xj = p.position[j], tj = trait[j];
            const size_t start = f.neighbors.first[g] + lane;
            for (uint32_t e = 0; e < f.neighbors.width[g]; ++e) {
                const size_t at = start + 8 * static_cast<size_t>(e);
                const uint32_t i = f.neighbors.entries[at] >> 4;
                if (i >= movers) break; // ascending
                // The same numbers as pairForces, from the row's side: V_i g_ij = V_j g_ji.
                const Vec4 xi = p.position[i], ti = trait[i];
                const Vec3 x = xi.xyz() - xj.xyz();
                const float gradient = f.volume[j] * f.neighbors.gradient[at];
                const float r2 = dot(x, x), h = 0.5f * (xi.w + xj.w);
                const float push = -f.dt * gradient;
                const float coefficient = -weight * ti.x * gradient / (0.01f * h * h + r2);
                float impulse = push * (ti.w + tj.w);
                pairs_.push({i, j, slot, x, coefficient, push});
                const float r = std::sqrt(r2), d = h / kSupport;
                if (d < r && r < h) {
                    impulse -= f.dt * 0.5f * kCohesionPeak * (r - d) * (h - r) * ti.z * (ti.y + tj.y) / (h * h * r);
                }
                hand(b, -static_cast<double>(impulse) * wide(x), wide(xj.xyz()));
            }
        }
        if (pairs_.size() == firstPair || b.asleep) continue;
        Unknown u{};
        u.slot = slot, u.firstPair = firstPair, u.endPair = pairs_.size();
        unknowns_.push(u);
    }
    if (pairs_.empty()) return;

    // What a mover lies against. Of several pieces each has its share: melt between two that fly apart would hold on to
    // one of them and to the room: a rod that melts through in flight was off its way by 3 mm/s, 1e-6 so.
    nearOf_.assign(movers, 0);
    for (const Pair& q : pairs_) {
        uint32_t& n = nearOf_[q.mover];
        if (n) continue;
        near_.push({q.mover, {}, {}, {}});
        n = static_cast<uint32_t>(near_.size());
    }
    const PairLists lists(f.neighbors);
    for (Near& n : near_) {
        float all = 0;
        const uint32_t g = n.mover >> 3;
        const size_t start = lists.first[g] + (n.mover & 7);
        for (uint32_t e = 0; e < lists.width[g]; ++e) {
            const size_t at = start + 8 * static_cast<size_t>(e), j = lists.entries[at] >> 4;
            if (j < movers || j >= static_cast<size_t>(p.count)) continue;
            all -= lists.gradient[at];
            for (int k = 0; p.piece[j] && k < Near::kPieces; ++k) {
                if (n.piece[k] && n.piece[k] != p.piece[j]) continue;
                n.piece[k] = p.piece[j], n.share[k] -= lists.gradient[at];
                break;
            }
        }
        for (float& share : n.share) share = all > 0 ? share / all : 0;
    }
    if (f.bonds && f.bonds->any()) {
        soft_.begin(movers);
        for (const Near& n : near_)
            if (p.bondSlot[n.mover]) soft_.add(f, n.mover);
        soft_.decide(f, moverStart, p.velocity.data());
        for (const SoftContacts::Contact& c : soft_.all())
            if (c.state != SoftContacts::Contact::kOpen)
                for (Unknown& u : unknowns_) u.springs |= u.slot == c.slot;
    }
}

RigidLiquid::Unknown* RigidLiquid::unknownOf(uint16_t piece) {
    for (Unknown& u : unknowns_)
        if (u.slot + 1 == piece) return &u;
    return nullptr;
}

Vec3 RigidLiquid::velocityAt(const MotionFrame& f, const Near& n) const {
    const Double3 x = wide(f.particles.position[n.mover].xyz());
    Vec3 v;
    for (int k = 0; k < Near::kPieces && n.piece[k]; ++k) {
        const RigidPiece& b = rigid_->pieceOf(n.piece[k]);
        if (!b.asleep) v += n.share[k] * narrow(b.velocityAt(x));
    }
    return v;
}

void RigidLiquid::factorise(const MotionFrame& f, Unknown& u) {
    const RigidPiece& b = rigid_->pieces()[u.slot];
    double(&a)[6][6] = u.factor;
    for (auto& row : a)
        for (double& v : row) v = 0;
    a[0][0] = a[1][1] = a[2][2] = b.mass;
    a[3][3] = b.inertia.xx, a[4][4] = b.inertia.yy, a[5][5] = b.inertia.zz;
    a[4][3] = b.inertia.xy, a[5][3] = b.inertia.xz, a[5][4] = b.inertia.yz;
    for (size_t k = u.firstPair; k < u.endPair; ++k) {
        const Pair& q = pairs_[k];
        const Double3 x = wide(q.x), t = cross(wide(f.particles.position[q.row].xyz()) - b.center, x);
        const double g[6] = {x.x, x.y, x.z, t.x, t.y, t.z};
        for (int r = 0; r < 6; ++r)
            for (int c = 0; c <= r; ++c) a[r][c] += static_cast<double>(q.coefficient) * g[r] * g[c];
    }
    for (const SoftContacts::Contact& c : soft_.all()) {
        if (c.slot != u.slot || c.state == SoftContacts::Contact::kOpen) continue;
        const Double3 arm = wide(f.particles.position[c.row].xyz()) - b.center;
        const Vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        for (int d = 0; d < 6; ++d) {
            const Vec3 way = d < 3 ? unit[d] : narrow(cross(wide(unit[d - 3]), arm));
            const Double3 j = wide(c.drag(f.dt, way)), t = cross(arm, j);
            const double column[6] = {j.x, j.y, j.z, t.x, t.y, t.z};
            for (int r = d; r < 6; ++r) a[r][d] += column[r];
        }
    }
    thaw::factorise(a); // positive, for the piece has mass
}

RigidLiquid::Six RigidLiquid::precondition(const Unknown& u) {
    const Six& r = u.residual;
    double g[6] = {r.linear.x, r.linear.y, r.linear.z, r.angular.x, r.angular.y, r.angular.z};
    solve(u.factor, g);
    return {{g[0], g[1], g[2]}, {g[3], g[4], g[5]}};
}

// Of all pieces: r . (inverse r) and r . r, the angular part as a force at the rim.
Dots RigidLiquid::measure() {
    Dots sum;
    for (Unknown& u : unknowns_) {
        u.z = precondition(u);
        const double radius = rigid_->pieces()[u.slot].radius;
        sum.a += dot6(u.residual, u.z);
        sum.b +=
            dot(u.residual.linear, u.residual.linear) + dot(u.residual.angular, u.residual.angular) / (radius * radius);
    }
    return sum;
}

void RigidLiquid::spread(const MotionFrame& f, const Unknown& u, const Six& v, Vec4* rows) const {
    const RigidPiece& b = rigid_->pieces()[u.slot];
    const uint32_t* r = rigid_->rowsOf(b);
    for (uint32_t k = 0; k < b.rows; ++k)
        rows[r[k]].setXyz(narrow(v.linear + cross(v.angular, wide(f.particles.position[r[k]].xyz()) - b.center)));
}

// From what the last solve changed.
void RigidLiquid::prime(const MotionFrame& f) {
    for (Unknown& u : unknowns_) {
        RigidPiece& b = rigid_->pieces()[u.slot];
        u.before = {b.velocity, b.spin};
        // As elastic solids do beside it: the springs of now alone are far from what they come to within the step.
        if (u.springs)
            b.velocity = b.startVelocity, b.spin = b.startSpin;
        else
            b.velocity += b.drag, b.spin += b.dragSpin;
        spread(f, u, {b.velocity, b.spin}, f.particles.velocity.data());
    }
}

// Adds `sign` times what the pairs make of these velocities on the piece.
void RigidLiquid::addDrag(const MotionFrame& f, const Unknown& u, const Vec4* velocity, float sign, Six& sum) const {
    const Double3 center = rigid_->pieces()[u.slot].center;
    for (size_t k = u.firstPair; k < u.endPair; ++k) {
        const Pair& q = pairs_[k];
        const float along = sign * dot(velocity[q.row].xyz() - velocity[q.mover].xyz(), q.x);
        const Double3 impulse = static_cast<double>(q.coefficient * along) * wide(q.x);
        sum.linear += impulse;
        sum.angular += cross(wide(f.particles.position[q.row].xyz()) - center, impulse);
    }
    for (const SoftContacts::Contact& c : soft_.all()) {
        if (c.slot != u.slot) continue;
        const Vec3 v = velocity[c.row].xyz() - velocity[c.mover].xyz();
        const Double3 impulse = wide(sign * c.drag(f.dt, v));
        sum.linear += impulse;
        sum.angular += cross(wide(f.particles.position[c.row].xyz()) - center, impulse);
    }
}

// What contacts of elastic solids give a piece beside their drag.
void RigidLiquid::addPush(const MotionFrame& f, const Unknown& u, Six& sum) const {
    const Double3 center = rigid_->pieces()[u.slot].center;
    for (const SoftContacts::Contact& c : soft_.all()) {
        if (c.slot != u.slot) continue;
        const Double3 impulse = wide(c.push(f.dt));
        sum.linear -= impulse;
        sum.angular -= cross(wide(f.particles.position[c.row].xyz()) - center, impulse);
    }
}

// Residual and first direction; the movers' velocities are their start already.
Dots RigidLiquid::start(const MotionFrame& f, Vec4* direction) {
    const Vec4* velocity = f.particles.velocity.data();
    for (Unknown& u : unknowns_) {
        const RigidPiece& b = rigid_->pieces()[u.slot];
        const Six value{b.velocity, b.spin};
        factorise(f, u);
        u.residual = massTimes(b, {u.before.linear - value.linear, u.before.angular - value.angular});
        addDrag(f, u, velocity, -1, u.residual);
        addPush(f, u, u.residual);
    }
    const Dots dots = measure();
    for (Unknown& u : unknowns_) u.direction = u.z, spread(f, u, u.direction, direction);
    return dots;
}

void RigidLiquid::aimBack(const MotionFrame& f, Vec4* direction) {
    for (Unknown& u : unknowns_) {
        const RigidPiece& b = rigid_->pieces()[u.slot];
        u.direction = {b.startVelocity - b.velocity, b.startSpin - b.spin};
        spread(f, u, u.direction, direction);
    }
}

double RigidLiquid::slope() const {
    double sum = 0;
    for (const Unknown& u : unknowns_) sum += dot6(u.direction, u.residual);
    return sum;
}

double RigidLiquid::curvature(const MotionFrame& f, Vec4* direction) {
    double sum = 0;
    for (Unknown& u : unknowns_) {
        const RigidPiece& b = rigid_->pieces()[u.slot];
        u.image = massTimes(b, u.direction);
        addDrag(f, u, direction, 1, u.image);
        sum += dot6(u.direction, u.image);
    }
    return sum;
}

Dots RigidLiquid::advance(double along) {
    for (Unknown& u : unknowns_) {
        RigidPiece& b = rigid_->pieces()[u.slot];
        b.velocity += along * u.direction.linear, b.spin += along * u.direction.angular;
        u.residual.linear -= along * u.image.linear, u.residual.angular -= along * u.image.angular;
    }
    return measure();
}

void RigidLiquid::turn(const MotionFrame& f, double keep, Vec4* direction) {
    for (Unknown& u : unknowns_) {
        u.direction = {u.z.linear + keep * u.direction.linear, u.z.angular + keep * u.direction.angular};
        spread(f, u, u.direction, direction);
    }
}

// The iterations keep these to themselves: what springs of contact pull at is where the rows go.
void RigidLiquid::show(const MotionFrame& f) {
    for (const Unknown& u : unknowns_) {
        const RigidPiece& b = rigid_->pieces()[u.slot];
        spread(f, u, {b.velocity, b.spin}, f.particles.velocity.data());
    }
}

bool RigidLiquid::decideSoft(const MotionFrame& f) {
    return soft_.any() && soft_.decide(f, f.particles.velocity.data(), f.particles.velocity.data());
}

// What the solve changed is an impulse; what sleeps gets its pairs', by the velocities that came out.
void RigidLiquid::finish(const MotionFrame& f, bool sound) {
    const Particles& p = f.particles;
    Array<RigidPiece>& pieces = rigid_->pieces();
    for (RigidPiece& b : pieces) b.solved = false;
    for (Unknown& u : unknowns_) {
        RigidPiece& b = pieces[u.slot];
        if (!sound) b.velocity = u.before.linear, b.spin = u.before.angular;
        b.solved = true;
        // Springs of contact push in steps of their own: no start for the next solve.
        const Six change{b.velocity - u.before.linear, b.spin - u.before.angular};
        b.drag = u.springs ? Double3{} : change.linear, b.dragSpin = u.springs ? Double3{} : change.angular;
        const Six impulse = massTimes(b, change);
        b.linear += impulse.linear, b.angular += impulse.angular;
    }
    for (RigidPiece& b : pieces)
        if (!b.solved) b.drag = b.dragSpin = {};
    if (!sound) return;
    for (const Pair& q : pairs_) {
        RigidPiece& b = pieces[q.slot];
        if (b.solved) continue;
        const float along = dot(p.velocity[q.mover].xyz() - p.velocity[q.row].xyz(), q.x);
        hand(b, static_cast<double>(q.coefficient * along) * wide(q.x), wide(p.position[q.row].xyz()));
    }
    const Vec4* velocity = p.velocity.data();
    for (const SoftContacts::Contact& c : soft_.all()) {
        if (c.state == SoftContacts::Contact::kOpen) continue;
        RigidPiece& b = pieces[c.slot];
        const Vec3 v = velocity[c.mover].xyz() - velocity[c.row].xyz();
        const Double3 impulse = wide(c.drag(f.dt, v) - c.push(f.dt));
        b.bedded = true, b.pushed += impulse;
        if (!b.solved) hand(b, impulse, wide(p.position[c.row].xyz()));
    }
    if (soft_.any()) soft_.keep(f, velocity);
}

void RigidLiquid::press(const MotionFrame& f, const Vec4* point) {
    for (const Pair& q : pairs_) {
        const float change = point[q.mover].w;
        if (change != 0)
            hand(rigid_->pieces()[q.slot], -static_cast<double>(q.push * change) * wide(q.x),
                 wide(f.particles.position[q.row].xyz()));
    }
}

void RigidLiquid::pushSwept(const MotionFrame& f) {
    for (Near& n : near_) {
        if (n.impulse.x == 0 && n.impulse.y == 0 && n.impulse.z == 0) continue;
        for (int k = 0; k < Near::kPieces && n.piece[k]; ++k) {
            RigidPiece& b = rigid_->pieces()[n.piece[k] - 1u];
            if (!b.asleep) b.push(wide(n.share[k] * n.impulse), wide(f.particles.position[n.mover].xyz()));
        }
        n.impulse = {};
    }
}

void RigidLiquid::settle(const MotionFrame& f) {
    for (Near& n : near_) {
        if (n.impulse.x == 0 && n.impulse.y == 0 && n.impulse.z == 0) continue;
        for (int k = 0; k < Near::kPieces && n.piece[k]; ++k)
            hand(rigid_->pieces()[n.piece[k] - 1u], wide(n.share[k] * n.impulse),
                 wide(f.particles.position[n.mover].xyz()));
        n.impulse = {};
    }
    rigid_->settle(f);
}

} // namespace thaw
