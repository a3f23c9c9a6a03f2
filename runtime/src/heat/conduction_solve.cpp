// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "heat/conduction_solve.h"

#include "heat/conduction.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

constexpr int kRowBlock = 512;
constexpr int kGroupBlock = kRowBlock / 8;

// Explicit steps are monotone up to dt sum(weights) / (m c) = 1. Super-time-stepping (Runge-Kutta-Legendre or
// -Gegenbauer) is 3-10 times cheaper beyond, and was tried: a hot spot in three dimensions leaves its neighbours colder
// than before it came, with every number of stages.
constexpr double kExplicit = 0.9;
// What 1 / filled still lacks: conductivity along lattice bars of 1, 4, 25 and 225 particles of cross-section and along
// a film is 0.975, 1.000, 1.001, 1.000 and 0.997 of nominal with it, and 0.932, 0.975, 0.991, 0.997 and 0.969 without.
constexpr float kBare = 0.085f;
// Longer steps, by conjugate gradients. An iteration costs what a sub-cycle costs, and steps that take up to 40 cycles
// are as dear one way as the other; but backward Euler in one step is 10 % off where a slab of 31 layers cools within
// 20 steps, and 8 to 25 % where it melts, against 0.1 and 3 %. Newton's method with the latent heat inside (by phase
// sets) was tried: 5 % when it settles, in 25 passes where the cycles are 72, but at four times that it no longer
// settles.
constexpr int kImplicitIterations = 30;
constexpr int kLeastIterations = 8;
constexpr double kImplicitTolerance = 1e-3;

// Below this difference, temperatures count as equal: what is so throughout a body and what it touches, sleeps.
constexpr float kEqualTemperature = 1e-3f; // K
constexpr int kBodyBlock = 4096;           // rows, for which every body has an extent
constexpr int kMostExtents = 1 << 16;      // of all blocks and bodies; beyond, nobody sleeps

double leastHeat(const Material& m) {
    return std::min(static_cast<double>(m.def.specificHeatSolid), static_cast<double>(m.def.specificHeatLiquid));
}

} // namespace

void Conduction::fillState(const HeatFrame& f) {
    const Particles& p = f.particles;
    const int rows = 8 * f.neighbors.groupCount + Particles::kPadding;
    state.resizeRaw(static_cast<size_t>(rows)), flow.resizeRaw(static_cast<size_t>(rows));
    weight.resizeRaw(static_cast<size_t>(rows));
    f.tasks.forBlocks(rows, kRowBlock, [&](int begin, int end, int, int) {
        for (int i = begin; i < end; ++i) {
            const size_t k = static_cast<size_t>(i);
            state[k] = {};
            if (i >= p.count) continue;
            const Material& m = f.materials[p.material[k]];
            // Over ambient, so that what matters keeps its digits in float.
            const bool unseeded = p.flags[k] & kUnseeded;
            state[k].x = static_cast<float>(m.kelvin(p.enthalpy[k], unseeded) - static_cast<double>(f.ambient));
            if (sleepers > 0 && asleep[p.body[k]]) continue; // conducts nothing
            state[k].y = m.conductivity(m.liquidFraction(p.enthalpy[k], unseeded));
            const float share = f.neighbors.volumeFraction[k] / (walls ? walls[k].covered : 1.0f);
            const float filled = std::clamp(share, 0.4f, 1.25f);
            state[k].z = 0.5f / filled * (1 + kBare * (1 - filled));
        }
    });
}

// Whose body has one temperature, and so have all whose boxes reach into its own. Such rows conduct nothing, in both
// directions alike: the pairs stay antisymmetric, the ledger exact.
void Conduction::findSleepers(const HeatFrame& f) {
    const Particles& p = f.particles;
    sleepers = 0;
    const int blocks = Tasks::blockCount(p.count, kBodyBlock);
    if (f.bodyCount < 2 || static_cast<int64_t>(blocks) * f.bodyCount > kMostExtents) return;
    const size_t bodies = static_cast<size_t>(f.bodyCount);
    extents.assign(static_cast<size_t>(blocks) * bodies, Extent{});
    f.tasks.forBlocks(p.count, kBodyBlock, [&](int begin, int end, int block, int) {
        Extent* const of = &extents[static_cast<size_t>(block) * bodies];
        for (int i = begin; i < end; ++i) {
            const size_t k = static_cast<size_t>(i);
            Extent& e = of[p.body[k]];
            const Vec4 x = p.position[k];
            const Vec3 reach = {0.5f * x.w, 0.5f * x.w, 0.5f * x.w};
            e.box.grow(x.xyz() - reach), e.box.grow(x.xyz() + reach);
            e.low = std::min(e.low, state[k].x), e.high = std::max(e.high, state[k].x);
            if (!walls || walls[k].conductance == 0) continue;
            const float wall = walls[k].temperature - f.ambient;
            e.low = std::min(e.low, wall), e.high = std::max(e.high, wall);
        }
    });
    for (size_t at = bodies; at < extents.size(); ++at) {
        Extent &all = extents[at % bodies], &e = extents[at];
        if (e.low > e.high) continue;
        all.box.grow(e.box.lower), all.box.grow(e.box.upper);
        all.low = std::min(all.low, e.low), all.high = std::max(all.high, e.high);
    }
    asleep.assign(bodies, uint8_t{1});
    bool any = false;
    for (size_t a = 0; a < bodies; ++a) {
        const Extent& x = extents[a];
        for (size_t b = 0; b < bodies && asleep[a]; ++b) {
            const Extent& y = extents[b];
            if (y.low > y.high || (a != b && !x.box.overlaps(y.box))) continue;
            asleep[a] = std::max(x.high, y.high) - std::min(x.low, y.low) <= kEqualTemperature;
        }
        any |= asleep[a] && x.low <= x.high;
    }
    if (!any) return;
    groupAsleep.resizeRaw(static_cast<size_t>(f.neighbors.groupCount));
    for (size_t g = 0; g < groupAsleep.size(); ++g) {
        uint8_t all = 1;
        for (size_t k = 8 * g; k < std::min(8 * g + 8, static_cast<size_t>(p.count)); ++k) {
            const uint8_t sleeps = asleep[p.body[k]];
            if (sleeps) state[k].y = 0, ++sleepers;
            all = all & sleeps;
        }
        groupAsleep[g] = all;
    }
}

void Conduction::pairPass(const HeatFrame& f, bool weights) {
    const Neighbors& n = f.neighbors;
    const ConductionPass pass{n.entries.data(),
                              n.gradient.data(),
                              n.first.data(),
                              n.width.data(),
                              state.data(),
                              flow.data(),
                              weights ? weight.data() : nullptr};
    enum Kind { kPlain, kScaled, kAsleep };
    const auto kindOf = [&](int g) {
        const size_t k = static_cast<size_t>(g);
        return sleepers > 0 && groupAsleep[k] ? kAsleep : bricks && groupScaled[k] ? kScaled : kPlain;
    };
    f.tasks.forBlocks(n.groupCount, kGroupBlock, [&](int begin, int end, int, int) {
        if (sleepers == 0 && !bricks) return conductionPass(pass, begin, end);
        ConductionPass own = pass;
        for (int g = begin; g < end;) {
            const int from = g;
            const Kind kind = kindOf(g);
            while (g < end && kindOf(g) == kind) ++g;
            if (kind == kAsleep) {
                std::fill_n(flow.data() + 8 * from, 8 * (g - from), 0.0f);
                if (weights) std::fill_n(weight.data() + 8 * from, 8 * (g - from), 0.0f);
            } else {
                own.gradient = kind == kScaled ? scaled.data() : pass.gradient;
                conductionPass(own, from, g);
            }
        }
    });
}

// row(i, sums) adds to its block's sums; they are added up in the order of blocks.
template <class F> Conduction::Sums Conduction::sumRows(const HeatFrame& f, F&& row) {
    const int blocks = Tasks::blockCount(f.particles.count, kRowBlock);
    blockSums.resizeRaw(static_cast<size_t>(blocks));
    f.tasks.forBlocks(f.particles.count, kRowBlock, [&](int begin, int end, int block, int) {
        Sums s{0, 0, INFINITY, -INFINITY};
        for (int i = begin; i < end; ++i) row(static_cast<size_t>(i), s);
        blockSums[static_cast<size_t>(block)] = s;
    });
    Sums total{0, 0, INFINITY, -INFINITY};
    for (const Sums& s : blockSums) {
        total.a += s.a, total.b += s.b;
        total.low = std::min(total.low, s.low), total.high = std::max(total.high, s.high);
    }
    return total;
}

// Largest rate 1/s at which a particle approaches its neighbours.
double Conduction::fastest(const HeatFrame& f) {
    const Particles& p = f.particles;
    const float moment = conductionMoment();
    const Sums s = sumRows(f, [&](size_t k, Sums& sums) {
        const double mc = p.velocity[k].w * leastHeat(f.materials[p.material[k]]);
        if (!(mc > 0)) return;
        const double wall = walls ? static_cast<double>(walls[k].conductance) : 0.0;
        sums.high = std::max(sums.high, static_cast<float>((f.volume[k] * weight[k] / moment + wall) / mc));
    });
    return std::max(0.0f, s.high);
}

double Conduction::explicitStep(const HeatFrame& f, double dt) {
    Particles& p = f.particles;
    const double scale = dt / conductionMoment();
    // A pair's two halves are equal up to the rounding of V_i (V_j g); what is left over is taken back where it arose.
    const Sums s = sumRows(f, [&](size_t k, Sums& sums) {
        const double e = static_cast<double>(f.volume[k]) * flow[k];
        sums.a += e, sums.b += std::abs(e);
    });
    const double back = s.b > 0 ? s.a / s.b : 0;
    return sumRows(f,
                   [&](size_t k, Sums& sums) {
                       if (!(p.velocity[k].w > 0)) return;
                       const double e = static_cast<double>(f.volume[k]) * flow[k];
                       if (e != 0) p.enthalpy[k] += scale * (e - back * std::abs(e)) / p.velocity[k].w;
                       if (!walls || walls[k].conductance == 0) return;
                       const double in = dt * fromWall(f, k, static_cast<double>(state[k].x));
                       p.enthalpy[k] += in / p.velocity[k].w, sums.a += in;
                   })
        .a;
}

// W, at a temperature over ambient.
double Conduction::fromWall(const HeatFrame& f, size_t k, double kelvin) const {
    const double wall = static_cast<double>(walls[k].temperature) - static_cast<double>(f.ambient);
    return static_cast<double>(walls[k].conductance) * (wall - kelvin);
}

// Backward Euler by conjugate gradients with the heat capacity of the cheaper phase, which keeps enthalpies in bounds
// when a particle melts on the way. A solve that stops at its cap may leave the range of the temperatures it began
// with: it is clipped, and what the clipping made or lost is given back in proportion to the room left, which exists.
double Conduction::implicitStep(const HeatFrame& f) {
    Particles& p = f.particles;
    const size_t rows = state.size();
    direction.assign(rows, 0.0f), residual.assign(rows, 0.0f), solution.assign(rows, 0.0f);
    heat.assign(rows, 0.0f), exchange.assign(rows, 0.0f), inverse.assign(rows, 0.0f);
    const double dt = f.dt / conductionMoment();
    // Rows without neighbours keep zeros everywhere and take no part.
    const auto active = [&](size_t k) { return inverse[k] > 0; };
    const Sums start = sumRows(f, [&](size_t k, Sums& s) {
        const double wall = walls ? static_cast<double>(walls[k].conductance) : 0.0;
        if (!(weight[k] > 0 || wall > 0) || !(p.velocity[k].w > 0)) return;
        const double capacity = p.velocity[k].w * leastHeat(f.materials[p.material[k]]);
        heat[k] = static_cast<float>(capacity + f.dt * wall), exchange[k] = static_cast<float>(dt * f.volume[k]);
        inverse[k] = static_cast<float>(1 / (capacity + f.dt * wall + dt * f.volume[k] * weight[k]));
        solution[k] = state[k].x;
        s.low = std::min(s.low, state[k].x), s.high = std::max(s.high, state[k].x);
        residual[k] = exchange[k] * flow[k];
        if (wall > 0) {
            const float kelvin = walls[k].temperature - f.ambient;
            s.low = std::min(s.low, kelvin), s.high = std::max(s.high, kelvin);
            residual[k] += static_cast<float>(f.dt * fromWall(f, k, static_cast<double>(state[k].x)));
        }
        direction[k] = residual[k] * inverse[k];
        s.a += static_cast<double>(residual[k]) * direction[k];
    });
    double rz = start.a;
    const int mostIterations = std::min(kImplicitIterations, std::max(kLeastIterations, f.cycles));
    for (size_t k = 0; k < static_cast<size_t>(p.count); ++k) state[k].x = direction[k];
    for (int iteration = 0; iteration < mostIterations && rz > kImplicitTolerance * kImplicitTolerance * start.a;
         ++iteration) {
        pairPass(f, false), ++done;
        const double pAp = sumRows(f, [&](size_t k, Sums& s) {
                               flow[k] = heat[k] * direction[k] - exchange[k] * flow[k];
                               s.a += static_cast<double>(direction[k]) * flow[k];
                           }).a;
        if (!(pAp > 0)) break;
        const float alpha = static_cast<float>(rz / pAp);
        const double next = sumRows(f, [&](size_t k, Sums& s) {
                                solution[k] += alpha * direction[k];
                                residual[k] -= alpha * flow[k];
                                s.a += static_cast<double>(residual[k]) * (residual[k] * inverse[k]);
                            }).a;
        const float beta = static_cast<float>(next / rz);
        rz = next;
        f.tasks.forBlocks(p.count, kRowBlock, [&](int begin, int end, int, int) {
            for (int i = begin; i < end; ++i) {
                const size_t k = static_cast<size_t>(i);
                state[k].x = direction[k] = residual[k] * inverse[k] + beta * direction[k];
            }
        });
    }
    const auto capacity = [&](size_t k) { return p.velocity[k].w * leastHeat(f.materials[p.material[k]]); };
    const auto kelvin = [&](size_t k) {
        const Material& m = f.materials[p.material[k]];
        return m.kelvin(p.enthalpy[k], p.flags[k] & kUnseeded) - static_cast<double>(f.ambient);
    };
    const double low = start.low, high = start.high;
    const auto clipped = [&](size_t k) { return std::clamp(static_cast<double>(solution[k]), low, high); };
    const Sums moved = sumRows(f, [&](size_t k, Sums& s) {
        if (!active(k)) return;
        s.a += capacity(k) * (clipped(k) - kelvin(k));
        if (walls && walls[k].conductance > 0) s.b += f.dt * fromWall(f, k, clipped(k));
    });
    const double made = moved.a - moved.b;
    const auto room = [&](size_t k) { return capacity(k) * (made > 0 ? clipped(k) - low : high - clipped(k)); };
    const double rooms = sumRows(f, [&](size_t k, Sums& s) {
                             if (active(k)) s.a += room(k);
                         }).a;
    // All alike to the last digit of float: nothing to conduct.
    if (!(rooms >= std::abs(made)) || rooms == 0) return 0;
    const double back = made / rooms;
    f.tasks.forBlocks(p.count, kRowBlock, [&](int begin, int end, int, int) {
        for (int i = begin; i < end; ++i) {
            const size_t k = static_cast<size_t>(i);
            if (!active(k)) continue;
            const double e = capacity(k) * (clipped(k) - kelvin(k)) - back * room(k);
            p.enthalpy[k] += e / p.velocity[k].w;
        }
    });
    return moved.b;
}

double Conduction::run(const HeatFrame& f, const WallContact* wallContacts) {
    wanted = done = 0;
    if (f.particles.count == 0 || !(f.dt > 0)) return 0;
    walls = wallContacts;
    done = 1, sleepers = 0;
    fillState(f);
    findSleepers(f);
    scalePairs(f);
    pairPass(f, true);
    const double needed = std::ceil(f.dt * fastest(f) / kExplicit);
    wanted = static_cast<int>(std::clamp(needed, 1.0, 1e6));
    if (wanted > f.cycles) return implicitStep(f);
    const int cycles = done = wanted;
    double in = 0;
    for (int c = 0; c < cycles; ++c) {
        if (c > 0) fillState(f), pairPass(f, false);
        in += explicitStep(f, f.dt / cycles);
    }
    return in;
}

} // namespace thaw
