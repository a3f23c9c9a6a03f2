// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// Contact impulses: projected Gauss-Seidel from what the contacts carried in the step before.
#include "motion/rigid.h"
#include "motion/rigid_numbers.h"

#include <algorithm>

namespace thaw {

Double3 Rigid::approach(const RigidContact& c) const {
    const RigidPiece& a = pieces_[c.a];
    Double3 v = a.asleep ? Double3{} : a.velocity + cross(a.spin, c.armA);
    if (c.other < RigidContact::kHeld) {
        const RigidPiece& b = pieces_[c.other];
        if (!b.asleep) v -= b.velocity + cross(b.spin, c.armB);
    } else {
        v -= c.surface;
    }
    return v;
}

void Rigid::apply(const RigidContact& c, Double3 impulse) {
    RigidPiece& a = pieces_[c.a];
    if (!a.asleep) a.velocity += (1 / a.mass) * impulse, a.spin += a.inverseInertia * cross(c.armA, impulse);
    if (c.other >= RigidContact::kHeld) return;
    RigidPiece& b = pieces_[c.other];
    if (!b.asleep) b.velocity -= (1 / b.mass) * impulse, b.spin -= b.inverseInertia * cross(c.armB, impulse);
}

// Arms and masses, and what the contact carried before.
void Rigid::prepareContacts(double dt) {
    const double scale = loadStep_ > 0 ? dt / loadStep_ : 0;
    for (RigidContact& c : contacts_) {
        c.armA = c.point - pieces_[c.a].center;
        if (c.other < RigidContact::kHeld) c.armB = c.point - pieces_[c.other].center;
        const Double3 e = std::abs(c.normal.x) < 0.7 ? Double3{1, 0, 0} : Double3{0, 1, 0};
        c.t1 = e - dot(e, c.normal) * c.normal;
        c.t1 = (1 / length(c.t1)) * c.t1;
        c.t2 = cross(c.normal, c.t1);
        const auto massAlong = [&](Double3 n) {
            double k = 0;
            const auto add = [&](const RigidPiece& b, Double3 arm) {
                if (b.asleep) return;
                const Double3 q = cross(arm, n);
                k += 1 / b.mass + dot(q, b.inverseInertia * q);
            };
            add(pieces_[c.a], c.armA);
            if (c.other < RigidContact::kHeld) add(pieces_[c.other], c.armB);
            return 1 / k;
        };
        c.massN = massAlong(c.normal), c.mass1 = massAlong(c.t1), c.mass2 = massAlong(c.t2);
        c.push = 0, c.rub = {};
        if (const Load* l = before(c.a, c.other, c.id)) {
            c.push = scale * l->push;
            c.rub = scale * (l->rub - dot(l->rub, c.normal) * c.normal);
        }
    }
}

// Forward and back in turn. Open contacts let through what closes them within the step; those inside each other are
// driven apart when `recover` is set. No restitution.
void Rigid::solve(int sweeps, double dt, bool recover) {
    const size_t n = contacts_.size();
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        double largest = 0, changed = 0;
        for (size_t k = 0; k < n; ++k) {
            RigidContact& c = contacts_[sweep & 1 ? n - 1 - k : k];
            double wanted = -c.gap / dt;
            if (c.gap < 0)
                wanted =
                    recover
                        ? std::min(kRecover * std::max(0.0, -c.gap - kSlop * c.spacing), kRecoverMost * c.spacing) / dt
                        : 0;
            const double push = std::max(0.0, c.push + c.massN * (wanted - dot(c.normal, approach(c))));
            const double more = push - c.push;
            c.push = push;
            largest = std::max(largest, push), changed = std::max(changed, std::abs(more));
            if (more != 0) apply(c, more * c.normal);
            if (push == 0 && c.rub.x == 0 && c.rub.y == 0 && c.rub.z == 0) continue;
            const Double3 v = approach(c);
            Double3 rub = c.rub + (-c.mass1 * dot(c.t1, v)) * c.t1 + (-c.mass2 * dot(c.t2, v)) * c.t2;
            const double size = length(rub), most = static_cast<double>(c.friction) * push;
            if (size > most) rub = (most / size) * rub;
            const Double3 change = rub - c.rub;
            c.rub = rub;
            changed = std::max(changed, length(change));
            apply(c, change);
        }
        if (!recover && changed <= kSolved * largest) return;
    }
}

void Rigid::keepLoads(double dt) {
    loads_.clear();
    for (const RigidContact& c : contacts_)
        if (c.push > 0) loads_.push({c.a, c.other, c.id, c.push, c.rub, c.push * c.normal + c.rub});
    // Between two that sleep nothing was looked for: it is as it was.
    const double scale = loadStep_ > 0 ? dt / loadStep_ : 0;
    const auto rests = [&](uint32_t slot) {
        return slot >= RigidContact::kHeld || (slot < pieces_.size() && pieces_[slot].alive && pieces_[slot].asleep);
    };
    for (const Load& l : loadsBefore_)
        if (rests(l.a) && rests(l.other))
            loads_.push({l.a, l.other, l.id, scale * l.push, scale * l.rub, scale * l.total});
    std::sort(loads_.begin(), loads_.end(), [](const Load& x, const Load& y) {
        if (x.a != y.a) return x.a < y.a;
        return x.other != y.other ? x.other < y.other : x.id < y.id;
    });
    loadStep_ = dt;
}

} // namespace thaw
