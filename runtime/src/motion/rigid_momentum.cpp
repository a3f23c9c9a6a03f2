// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/rigid_liquid.h"

namespace thaw {

// What floats together with rigid pieces, and leans on no wall and nothing held, gets back what the capped solve lost
// of its momentum, as one rigid motion of melt and pieces. Without it, a chunk that ran into a stiff blob gained three
// times the momentum that both had, within a second.
void Motion::returnShared(const MotionFrame& f) {
    if (wallsMove_ || reporting_ || heldMoves_) return; // returnMomentum corrects what touches too
    Particles& p = f.particles;
    const uint32_t movers = static_cast<uint32_t>(p.moverCount), count = static_cast<uint32_t>(p.count);
    Array<uint32_t>& group = f.coupling->group(); // movers; from moverCount on unknowns
    Array<RigidLiquid::Unknown>& unknowns = f.coupling->unknowns();
    for (uint32_t seed = 0; seed < unknowns.size(); ++seed) {
        if (unknowns[seed].visited) continue;
        bool leaning = false;
        group.clear();
        group.push(movers + seed), unknowns[seed].visited = true;
        const auto visit = [&](uint32_t row, bool rigid) {
            forNeighbors(f.neighbors, static_cast<int>(row), [&](uint32_t j) {
                if (j >= count) return false;
                if (j < movers) {
                    if (piece_[j] != kShared) piece_[j] = kShared, group.push(j);
                    return true;
                }
                if (rigid) return false; // contacts keep momentum by themselves
                RigidLiquid::Unknown* u = f.coupling->unknownOf(p.piece[j]);
                if (u && !u->visited)
                    u->visited = true, group.push(movers + static_cast<uint32_t>(u - unknowns.data()));
                leaning |= !u;
                return !leaning;
            });
        };
        for (size_t head = 0; head < group.size(); ++head) {
            const uint32_t node = group[head];
            if (node < movers) {
                leaning |= contactCount_[node] && contact_[node * kContacts].w < p.position[node].w;
                visit(node, false);
                continue;
            }
            const RigidPiece& b = f.rigid->pieces()[unknowns[node - movers].slot];
            for (uint32_t k = 0; k < b.rows; ++k) visit(f.rigid->rowsOf(b)[k], true);
        }
        for (const uint32_t node : group)
            if (node < movers) piece_[node] = kLeaning; // returnMomentum leaves it alone
        if (leaning) continue;

        double mass = 0;
        Double3 center;
        for (const uint32_t node : group) {
            const RigidPiece* b = node < movers ? nullptr : &f.rigid->pieces()[unknowns[node - movers].slot];
            const double m = b ? b->mass : static_cast<double>(trait_[node].z);
            mass += m, center += m * (b ? b->center : wide(p.position[node].xyz()));
        }
        center = (1 / mass) * center;
        Double3 lost, turned;
        Symmetric3 inertia;
        for (const uint32_t node : group) {
            if (node < movers) {
                const double m = trait_[node].z;
                const Double3 d = wide(p.position[node].xyz()) - center,
                              r = m * (wide(before_[node].xyz()) - wide(p.velocity[node].xyz()));
                lost += r, turned += cross(d, r), inertia.addMass(m, d, 0);
                continue;
            }
            const RigidLiquid::Unknown& u = unknowns[node - movers];
            const RigidPiece& b = f.rigid->pieces()[u.slot];
            const Double3 d = b.center - center, r = b.mass * (u.before.linear - b.velocity);
            lost += r, turned += cross(d, r) + b.inertia * (u.before.angular - b.spin);
            Symmetric3 own = b.inertia;
            own.addMass(b.mass, d, 0);
            inertia.xx += own.xx, inertia.yy += own.yy, inertia.zz += own.zz;
            inertia.xy += own.xy, inertia.xz += own.xz, inertia.yz += own.yz;
        }
        const Double3 drift = (1 / mass) * lost, spin = inverse(inertia) * turned;
        for (const uint32_t node : group) {
            if (node < movers) {
                const Double3 d = wide(p.position[node].xyz()) - center;
                p.velocity[node].setXyz(narrow(wide(p.velocity[node].xyz()) + drift + cross(spin, d)));
                continue;
            }
            RigidPiece& b = f.rigid->pieces()[unknowns[node - movers].slot];
            b.velocity += drift + cross(spin, b.center - center), b.spin += spin;
        }
    }
}

} // namespace thaw
