// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// When what has bonds sleeps, and what wakes it.
#include "base/kernel.h"
#include "motion/bond_pass.h"
#include "motion/bonds.h"
#include "motion/links.h"
#include "motion/rigid.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

// In spacings a step, for so many steps, and with less than this share of its weight unbalanced: then it sleeps. It
// wakes with more than kUnrest unbalanced.
constexpr float kCalm = 3e-4f;
constexpr uint8_t kCalmSteps = 30;
constexpr float kRest = 0.02f, kUnrest = 0.06f;
constexpr float kHits = 1.5f;      // gravity's velocity of a step: what comes faster wakes what it hits
constexpr float kTouched = 1.6f;   // spacings, of what moves and a sleeper: it wakes
constexpr float kStand = 0.5f;     // spacings, of a particle on a wall
constexpr float kAhead = 2;        // steps: what a collider comes to within wakes
constexpr float kLeastGravity = 1; // m/s^2, for that measure where there is none
// What sleeps among its like is looked at every so many steps while it warms.
constexpr uint32_t kLookInterval = 4;
constexpr float kFillRate = 0.1f; // of the way to what its bonds make up, per step: others take over bit by bit

constexpr int kRowBlock = 256;

} // namespace

void Bonds::gather(const BondFrame& f, int begin, int end, WallFinder& walls) const {
    Box around;
    float support = 0;
    for (int i = begin; i < end; ++i) {
        const Vec4 x = f.particles.position[static_cast<size_t>(i)];
        around.grow(x.xyz()), support = std::max(support, x.w);
    }
    walls.gather(f.colliders, colliderBounds_.data(), f.colliderCount, around, kAnchor * support / kSupport);
}

// Force on a solid particle that is not carried by anything, N: springs, weight, pressure of liquid around it.
Vec3 Bonds::imbalance(const BondFrame& f, uint32_t row) const {
    const Particles& p = f.particles;
    const Vec4 x = p.position[row];
    const uint32_t slot = p.bondSlot[row];
    Vec3 force = p.velocity[row].w * f.gravity + borne_[slot];
    const Elastic own = elastic(f.materials, p, row);
    const Bond* b = bondsOf(slot);
    for (int k = 0; k < count_[slot]; ++k) {
        const uint32_t j = rowOf_[b[k].other];
        const Vec3 d = x.xyz() - p.position[j].xyz();
        const float r = std::max(length(d), 1e-12f);
        const float stiff = mixed(p, row, j) * b[k].weight * pairStiffness(own, elastic(f.materials, p, j));
        force += (stiff * std::min(b[k].rest - r, kMostPress * b[k].rest) / r) * d;
    }
    const uint32_t g = row >> 3, lane = row & 7;
    const size_t first = f.neighbors.first[g] + lane;
    for (uint32_t k = 0; k < f.neighbors.width[g]; ++k) {
        const uint32_t j = f.neighbors.entries[first + 8 * k] >> 4;
        if (j >= static_cast<uint32_t>(p.count)) break;
        if (p.piece[j]) continue;
        if (p.bondSlot[j] || (p.flags[j] & kFixed)) {
            const Vec3 d = x.xyz() - p.position[j].xyz();
            const float near = kContact * 0.5f * (x.w + p.position[j].w) / kSupport;
            if (!(dot(d, d) < near * near) || (p.bondSlot[j] && bonded(slot, p.bondSlot[j]))) continue;
            Elastic other;
            if (p.bondSlot[j]) other = elastic(f.materials, p, j);
            const float r = std::max(length(d), 1e-12f);
            force += (contactStiffness(own, other, near / kContact) * std::min(near - r, kMostPress * near) / r) * d;
        } else if (p.pressure[j] > 0) {
            const Vec3 d = x.xyz() - p.position[j].xyz();
            force -= (f.volume[row] * p.pressure[j] * f.neighbors.gradient[first + 8 * k]) * d;
        }
    }
    return force;
}

// What rounding of the positions does to that: a stiff solid far from the origin is never in balance.
float Bonds::rounding(const BondFrame& f, uint32_t row) const {
    constexpr float kRounding = 4 * 0x1p-23f;
    const Vec3 x = f.particles.position[row].xyz();
    return kRounding * stiffnessOfLayer(f, row) * std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)});
}

// Where pieces fly that wake what they hit: faster than what gravity makes of rest in a step. What rolls over onto it
// or settles finds it as it is, as on something rigid.
Box Bonds::hittingPieces(const BondFrame& f) const {
    const Particles& p = f.particles;
    const float least = kHits * std::max(length(f.gravity), kLeastGravity) * f.dt;
    Box box;
    float support = 0;
    for (size_t i = static_cast<size_t>(p.moverCount); i < static_cast<size_t>(p.count); ++i) {
        const Vec3 v = p.velocity[i].xyz();
        if (!p.piece[i] || !(dot(v, v) > least * least)) continue;
        box.grow(p.position[i].xyz()), support = std::max(support, p.position[i].w);
    }
    if (box.empty()) return box;
    const Vec3 margin{support, support, support};
    return {box.lower - margin, box.upper + margin};
}

// Whether a piece that is awake lies against a row, or comes to it in this step.
bool Bonds::touchedByPiece(const BondFrame& f, uint32_t row) const {
    const Particles& p = f.particles;
    const Vec4 x = p.position[row];
    bool touched = false;
    forNeighbors(f.neighbors, static_cast<int>(row), [&](uint32_t j) {
        if (j >= static_cast<uint32_t>(p.count)) return false;
        if (!p.piece[j] || f.rigid->pieceOf(p.piece[j]).asleep) return true;
        const float near = kTouched * 0.5f * (x.w + p.position[j].w) / kSupport;
        touched = length(x.xyz() - p.position[j].xyz()) - f.dt * length(p.velocity[j].xyz()) < near;
        return !touched;
    });
    return touched;
}

// Rows of elastic solids against pieces that sleep, or do not.
template <class F> void Bonds::forTouching(const BondFrame& f, bool asleep, F&& body) const {
    const Particles& p = f.particles;
    Array<RigidPiece>& pieces = f.rigid->pieces();
    const uint32_t movers = static_cast<uint32_t>(p.moverCount), count = static_cast<uint32_t>(p.count);
    for (uint32_t j = movers; j < count; ++j) {
        if (!p.piece[j] || pieces[p.piece[j] - 1u].asleep != asleep) continue;
        forNeighbors(f.neighbors, static_cast<int>(j), [&](uint32_t i) {
            if (i >= count) return false;
            const Vec3 d = p.position[i].xyz() - p.position[j].xyz();
            const float near = kTouched * 0.5f * (p.position[i].w + p.position[j].w) / kSupport;
            if (p.bondSlot[i] && dot(d, d) < near * near) body(i, pieces[p.piece[j] - 1u]);
            return true;
        });
    }
}

void Bonds::wakePieces(const BondFrame& f) {
    forTouching(f, true, [&](uint32_t i, RigidPiece& b) {
        if (state_[i] == kWakes) b.asleep = false, b.calm = 0;
    });
}

// Pieces sleep together with all that touches them, in one step, and what wakes takes them along: what wants to sleep
// under a piece stays awake where something there does not, or pieces would stand on some that sleeps and some that
// gives way.
void Bonds::settlePieces(const BondFrame& f) {
    const Particles& p = f.particles;
    Array<RigidPiece>& pieces = f.rigid->pieces();
    const uint32_t movers = static_cast<uint32_t>(p.moverCount), count = static_cast<uint32_t>(p.count);
    wakePieces(f);
    for (RigidPiece& b : pieces) b.restless = false;
    for (uint32_t j = movers; j < count; ++j)
        if (p.piece[j] && !(length(p.velocity[j].xyz()) * f.dt < kCalm * p.position[j].w / kSupport))
            pieces[p.piece[j] - 1u].restless = true;
    for (bool again = true; again;) {
        again = false;
        forTouching(f, false, [&](uint32_t i, RigidPiece& b) {
            const bool awake = i < movers || state_[i] == kWakes;
            if (awake && state_[i] != kSleeps && !b.restless) b.restless = again = true;
        });
        forTouching(f, false, [&](uint32_t i, RigidPiece& b) {
            if (b.restless && state_[i] == kSleeps) state_[i] = kStay, again = true;
            if (b.restless && (p.flags[i] & kAsleep)) state_[i] = kWakes;
        });
    }
    forTouching(f, false, [&](uint32_t i, RigidPiece& b) {
        if (state_[i] == kSleeps) b.drowsy = true;
    });
    for (size_t s = 0; s < pieces.size(); ++s) {
        if (pieces[s].drowsy) f.rigid->layToRest(static_cast<uint16_t>(s + 1));
        pieces[s].drowsy = false;
    }
}

// All that hangs together by bonds and sleeps wakes with what will be touched: it is pushed on farther in a step than
// waking gets from layer to layer. What hangs on the collider goes with it.
int Bonds::wakeBefore(const BondFrame& f) {
    bool any = false;
    for (int c = 0; c < f.colliderCount; ++c) any |= f.colliders[c].alive && f.colliders[c].moves;
    if (!any || live_ == 0) return 0;
    Particles& p = f.particles;
    mapRows(p);
    std::fill(state_.begin(), state_.begin() + p.count, static_cast<uint8_t>(kStay));
    const uint32_t count = static_cast<uint32_t>(p.count);
    const auto sleeps = [&](uint32_t i) { return (p.flags[i] & kFixed) && (p.flags[i] & kAsleep); };
    queue_.clear();
    for (int c = 0; c < f.colliderCount; ++c) {
        const Collider& o = f.colliders[c];
        if (!o.alive || !o.moves) continue;
        const Box b = o.sweptBounds();
        for (uint32_t i = 0; i < count; ++i) {
            if (!p.bondSlot[i] || !sleeps(i) || state_[i] == kWakes || p.anchor[i] == c + 1) continue;
            const Vec3 x = p.position[i].xyz(), toward = o.velocityAt(x) - p.velocity[i].xyz();
            const float way = kAhead * f.dt * length(toward), spacing = p.position[i].w / kSupport;
            const float reach = kStand * spacing + way;
            if (x.x < b.lower.x - reach || x.x > b.upper.x + reach || x.y < b.lower.y - reach ||
                x.y > b.upper.y + reach || x.z < b.lower.z - reach || x.z > b.upper.z + reach)
                continue;
            Vec3 n;
            const float gap = o.distance(x, n) - kStand * spacing, closing = dot(n, toward) * f.dt;
            if (closing > kCalm * spacing && gap < kAhead * closing) state_[i] = kWakes, queue_.push(i);
        }
    }
    for (size_t head = 0; head < queue_.size(); ++head) {
        const uint32_t slot = p.bondSlot[queue_[head]];
        for (int k = 0; k < count_[slot]; ++k) {
            const uint32_t j = rowOf_[bondsOf(slot)[k].other];
            if (sleeps(j) && state_[j] != kWakes) state_[j] = kWakes, queue_.push(j);
        }
    }
    for (const uint32_t i : queue_) wake(p, i);
    // By their boxes: the lists are of the step before.
    if (f.rigid)
        for (RigidPiece& b : f.rigid->pieces()) {
            if (!b.alive || !b.asleep) continue;
            for (const uint32_t i : queue_) {
                const Vec3 x = p.position[i].xyz();
                const float near = kTouched * p.position[i].w / kSupport;
                if (x.x < b.bounds.lower.x - near || x.x > b.bounds.upper.x + near || x.y < b.bounds.lower.y - near ||
                    x.y > b.bounds.upper.y + near || x.z < b.bounds.lower.z - near || x.z > b.bounds.upper.z + near)
                    continue;
                b.asleep = false, b.calm = 0;
                break;
            }
        }
    return static_cast<int>(queue_.size());
}

void Bonds::wake(Particles& p, uint32_t row) {
    calm_[p.bondSlot[row]] = 1;
    p.flags[row] = static_cast<uint8_t>(p.flags[row] & ~(kFixed | kAsleep));
    p.anchor[row] = 0; // its velocity stays that of what it hung on
    p.velocityChange[row] = {};
}

// Sleep and waking of rows that have bonds.
void Bonds::settle(const BondFrame& f, BondResult& result) {
    Particles& p = f.particles;
    const float weight = std::max(length(f.gravity), kLeastGravity);
    // All of them first: what follows reads those of neighbours in other blocks.
    f.tasks.forBlocks(p.count, kRowBlock, [&](int begin, int end, int, int) {
        for (int r = begin; r < end; ++r)
            if (const uint32_t slot = p.bondSlot[static_cast<size_t>(r)])
                fill_[slot] += kFillRate * (fillGoal_[slot] - fill_[slot]);
    });
    const Box pieces = hittingPieces(f);
    const auto nearPieces = [&](Vec3 x) {
        return x.x > pieces.lower.x && x.x < pieces.upper.x && x.y > pieces.lower.y && x.y < pieces.upper.y &&
               x.z > pieces.lower.z && x.z < pieces.upper.z;
    };
    f.tasks.forBlocks(p.count, kRowBlock, [&](int begin, int end, int, int) {
        WallFinder walls;
        bool gathered = false;
        const auto unbalanced = [&](uint32_t i) {
            Vec3 force = imbalance(f, i);
            if (!gathered) gather(f, begin, end, walls), gathered = true;
            const float near = kAnchor * p.position[i].w / kSupport;
            walls.forNear(p.position[i].xyz(), near, [&](float d, Vec3 n, const Collider&) {
                if (d < near && dot(n, force) < 0) force = {};
            });
            return std::max(0.0f, length(force) - rounding(f, i)) / (p.velocity[i].w * weight);
        };
        for (int r = begin; r < end; ++r) {
            const uint32_t i = static_cast<uint32_t>(r), slot = p.bondSlot[i];
            state_[i] = kStay;
            if (!slot) continue;
            const Material& m = f.materials[p.material[i]];
            if ((p.flags[i] & kFixed) && (p.flags[i] & kAsleep)) {
                if (calm_[slot] == kNewborn) {
                    bool near = false;
                    if (!gathered) gather(f, begin, end, walls), gathered = true;
                    const float reach = kAnchor * p.position[i].w / kSupport;
                    walls.forNear(p.position[i].xyz(), reach,
                                  [&](float d, Vec3, const Collider&) { near |= d < reach; });
                    state_[i] = near ? kAnchors : kWakes;
                    continue;
                }
                // On what turns, gravity comes from elsewhere.
                const int on = p.anchor[i] - 1;
                const bool carried = on >= 0 && on < f.colliderCount && f.colliders[on].moves;
                const bool due = (slot + steps_) % kLookInterval == 0 &&
                                 (carried || p.liquidFraction[i] > 0 ||
                                  std::abs(fill_[slot] - fillGoal_[slot]) > 1e-3f * fill_[slot]);
                if ((due || beside(f, i)) && unbalanced(i) > kUnrest) state_[i] = kWakes;
                if (nearPieces(p.position[i].xyz()) || (f.rigid && touchedByPiece(f, i))) state_[i] = kWakes;
            } else if (!(p.flags[i] & kFixed)) {
                const float spacing = p.position[i].w / kSupport;
                if (calm_[slot] == kNewborn) calm_[slot] = 1;
                // What creeps is never at rest as long as it is under stress.
                if (!m.soft() || m.def.relaxationTime > 0 || !(length(p.velocity[i].xyz()) * f.dt < kCalm * spacing)) {
                    calm_[slot] = 1;
                } else if (calm_[slot] <= kCalmSteps) {
                    ++calm_[slot];
                } else if (unbalanced(i) < kRest) {
                    state_[i] = kSleeps;
                }
            }
        }
    });
    if (f.rigid) settlePieces(f);
    for (size_t i = 0; i < static_cast<size_t>(p.count); ++i) {
        if (state_[i] == kStay) continue;
        const uint32_t slot = p.bondSlot[i];
        calm_[slot] = 1;
        if (state_[i] == kSleeps) {
            p.flags[i] |= kFixed | kAsleep, ++result.slept;
            p.velocity[i].setXyz({});
        } else if (state_[i] == kWakes) {
            wake(p, static_cast<uint32_t>(i)), ++result.woken;
        } else {
            p.flags[i] = static_cast<uint8_t>(p.flags[i] & ~kAsleep);
        }
        p.velocityChange[i] = {};
    }
}

} // namespace thaw
