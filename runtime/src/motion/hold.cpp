// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/hold.h"

#include "base/kernel.h"
#include "motion/carry.h"
#include "motion/links.h"
#include "motion/numbers.h"
#include "motion/rigid_numbers.h"

#include <algorithm>

namespace thaw {
namespace {

// What sets lies against something: as far as the middle of four of a lattice from them (1.22) and a tenth more, or a
// wall that it stands half a spacing off.
constexpr float kTouch = 1.35f, kWallTouch = 0.8f;
// What has come to rest sets from farther away: as stiff as it is by then, the drag of wall and neighbours stops it
// short.
constexpr float kRestTouch = 1.75f, kRestWallTouch = 1.5f;
// In spacings a step. Nothing sets in flight.
constexpr float kSlow = 0.3f, kRest = 1e-3f;

// What has just set keeps no more room than melt does and takes the rest of what it keeps once it is held in this way:
// at once, its neighbours jump by 0.045 spacings (`thaw validate motion soft-refreeze`), 0.002 so.
constexpr float kRoomFade = 0.81f, kRoomLeast = 0.01f;

constexpr int kRowBlock = 256;

bool nearWall(const WallFinder& walls, Vec3 p, float reach) {
    bool near = false;
    walls.forNear(p, reach, [&](float distance, Vec3, const Collider&) { near |= distance < reach; });
    return near;
}

} // namespace

void Hold::gather(const HoldFrame& f, int begin, int end, WallFinder& walls) const {
    constexpr float kFarthest = std::max(std::max(kWallTouch, kRestWallTouch), kAnchor) / kSupport;
    Box around;
    float support = 0;
    for (int i = begin; i < end; ++i) {
        const Vec4 x = f.particles.position[static_cast<size_t>(i)];
        around.grow(x.xyz()), support = std::max(support, x.w);
    }
    walls.gather(f.colliders, colliderBounds_.data(), f.colliderCount, around, kFarthest * support);
}

// Whether a row that is cold enough sets, where colliders are told apart: it rests on what it touches, whether that
// moves or not. The nearest wall, or else the first held neighbour.
bool Hold::touchesToldApart(const HoldFrame& f, int row, const WallFinder& walls) {
    const Particles& p = f.particles;
    const size_t k = static_cast<size_t>(row);
    const Vec3 x = p.position[k].xyz(), v = p.velocity[k].xyz();
    const float spacing = p.position[k].w / kSupport;
    const auto slow = [&](Vec3 own, float distance, float touch, float restTouch) {
        const float moved = length(v - own) * f.dt;
        return moved <= kSlow * spacing && distance < (moved < kRest * spacing ? restTouch : touch) * spacing;
    };
    if (p.flags[k] & kMoulded) {
        const uint16_t on = f.mouldOn[shapeOf(p.follows[k]) - 1];
        if (slow(on ? f.colliders[on - 1].velocityAt(x) : Vec3{}, 0, kWallTouch, kWallTouch)) {
            anchor_[k] = on;
            return true;
        }
    }
    float nearest = INFINITY;
    bool touches = false;
    walls.forNear(x, kRestWallTouch * spacing, [&](float distance, Vec3, const Collider& c) {
        if (!(distance < nearest) || !slow(c.velocityAt(x), distance, kWallTouch, kRestWallTouch)) return;
        nearest = distance, touches = true;
        anchor_[k] = toldApart(c) ? static_cast<uint16_t>(&c - f.colliders + 1) : uint16_t{0};
    });
    if (!touches)
        forNeighbors(f.neighbors, row, [&](uint32_t j) {
            if (j >= static_cast<uint32_t>(p.count) || !(p.flags[j] & kFixed)) return true;
            const Vec3 d = p.position[j].xyz() - x;
            const float mean = 0.5f * (1 + p.position[j].w / p.position[k].w);
            touches = slow(p.velocity[j].xyz(), length(d) / mean, kTouch, kRestTouch);
            if (touches) anchor_[k] = p.anchor[j], against_[k] = p.piece[j];
            return !touches;
        });
    return touches;
}

// Releases and settings of rows [begin, end) into state_. Reads the flags of others, which nobody changes meanwhile.
HoldResult Hold::decide(const HoldFrame& f, int begin, int end) {
    Particles& p = f.particles;
    HoldResult result;
    WallFinder walls;
    bool gathered = false;
    for (int i = begin; i < end; ++i) {
        const size_t k = static_cast<size_t>(i);
        const Material& m = f.materials[p.material[k]];
        const float phi = p.liquidFraction[k];
        state_[k] = kStay;
        if (p.flags[k] & kFixed) {
            if (phi > m.def.releaseFraction) state_[k] = kRelease, ++result.released;
            if (p.pressure[k] > 0) p.pressure[k] = p.pressure[k] > 1 ? p.pressure[k] * kPressureFade : 0;
            float& fresh = p.velocityChange[k].w;
            if (fresh > 0) fresh = fresh > kRoomLeast ? fresh * kRoomFade : 0;
            continue;
        }
        if (phi >= m.def.setFraction || p.bondSlot[k]) continue;
        const float spacing = p.position[k].w / kSupport;
        against_[k] = 0;
        if (f.toldApart) {
            if (!gathered) gather(f, begin, end, walls), gathered = true;
            if (touchesToldApart(f, i, walls)) state_[k] = kSet, ++result.set;
            continue;
        }
        const Vec3 x = p.position[k].xyz(), v = p.velocity[k].xyz();
        const float moved = length(v) * f.dt;
        const bool slow = moved <= kSlow * spacing;
        if (!slow && !f.rigid.any()) continue;
        const auto rests = [&](float by) { return by < kRest * spacing; };
        if (slow && !gathered) gather(f, begin, end, walls), gathered = true;
        bool touches = slow && ((p.flags[k] & kMoulded) ||
                                nearWall(walls, x, (rests(moved) ? kRestWallTouch : kWallTouch) * spacing));
        // What is elastic bonds with what it lies against (Bonds): only a wall holds it.
        if (!touches && !m.soft()) {
            // What is fixed may be on its way: only what is slow against it sets, on the nearest.
            float nearest = INFINITY;
            forNeighbors(f.neighbors, i, [&](uint32_t j) {
                if (j >= static_cast<uint32_t>(p.count) || !(p.flags[j] & kFixed)) return true;
                const float by = p.piece[j] ? length(v - p.velocity[j].xyz()) * f.dt : moved;
                if (by > kSlow * spacing) return true;
                const float reach = (rests(by) ? kRestTouch : kTouch) * 0.5f * (spacing + p.position[j].w / kSupport);
                const Vec3 d = p.position[j].xyz() - x;
                const float r2 = dot(d, d);
                if (r2 < reach * reach && r2 < nearest) nearest = r2, against_[k] = p.piece[j], touches = true;
                return true;
            });
        }
        if (touches) state_[k] = kSet, ++result.set;
    }
    return result;
}

// Marks in state_ every row that is held: fixed, of no rigid piece, and hanging together with a collider.
void Hold::reach(const HoldFrame& f) {
    const Particles& p = f.particles;
    const auto reached = [&](uint32_t i) {
        // The row before is mostly a neighbour, and at hand.
        if (i > 0 && state_[i - 1] == kReached && linked(p, i - 1, i)) return true;
        bool found = false;
        forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t j) {
            found = j < static_cast<uint32_t>(p.count) && state_[j] == kReached && linked(p, i, j);
            return !found;
        });
        return found;
    };
    // Rows lie in the order of cells, so that most find a reached neighbour after a few looks and need no collider:
    // 0.3 instead of 1.4 ms at 10,000 particles for following all links of all rows from those at a collider.
    queue_.clear();
    for (int begin = 0; begin < p.count; begin += kRowBlock) {
        const int end = std::min(p.count, begin + kRowBlock);
        WallFinder walls;
        bool gathered = false;
        for (int row = begin; row < end; ++row) {
            const uint32_t i = static_cast<uint32_t>(row);
            state_[i] = kStay;
            if (!(p.flags[i] & kFixed) || p.piece[i]) continue;
            bool held = (p.flags[i] & kMoulded) || reached(i);
            if (!held) {
                if (!gathered) gather(f, begin, end, walls), gathered = true;
                held = nearWall(walls, p.position[i].xyz(), kAnchor * p.position[i].w / kSupport);
            }
            if (held)
                state_[i] = kReached;
            else
                queue_.push(i);
        }
    }
    // The rest: what is reached now, and all that follows from it.
    const size_t open = queue_.size();
    for (size_t k = open; k-- > 0;) {
        const uint32_t start = queue_[k];
        if (state_[start] == kReached || !reached(start)) continue;
        state_[start] = kReached;
        queue_.push(start);
        while (queue_.size() > open) {
            const uint32_t i = queue_[queue_.size() - 1];
            queue_.resizeRaw(queue_.size() - 1);
            forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t j) {
                if (j < static_cast<uint32_t>(p.count) && state_[j] != kReached && (p.flags[j] & kFixed) &&
                    !p.piece[j] && linked(p, i, j))
                    state_[j] = kReached, queue_.push(j);
                return true;
            });
        }
    }
}

// What was let go (queue_) starts with the pressure of what lies loose above it, and stiff. Without that pressure a
// block that melts at once falls into itself by 42 % (mean); what is held above it weighs nothing. The mean, for single
// neighbours carry spikes.
void Hold::pressurize(const HoldFrame& f) {
    Particles& p = f.particles;
    const auto height = [&](uint32_t i) { return -dot(p.position[i].xyz(), f.gravity); };
    std::sort(queue_.data(), queue_.data() + queue_.size(), [&](uint32_t a, uint32_t b) {
        const float x = height(a), y = height(b);
        return x != y ? x > y : a < b;
    });
    for (size_t k = 0; k < queue_.size(); ++k) {
        const uint32_t i = queue_[k];
        const Material& m = f.materials[p.material[i]];
        // A film that runs down what is held weighs on that, not on its own lower end: no more than from the open air
        // to here.
        const Vec3 x = p.position[i].xyz();
        const float half = 0.5f * p.position[i].w / kSupport;
        float sum = 0, open = p.flags[i] & kSurface ? half : INFINITY;
        int above = 0;
        forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t j) {
            if (j >= static_cast<uint32_t>(p.count)) return true;
            if (p.flags[j] & kSurface) open = std::min(open, half + length(p.position[j].xyz() - x));
            const float below = height(j) - height(i);
            if (!(below > 0)) return true;
            ++above;
            if (!(p.flags[j] & kFixed)) sum += p.pressure[j] + m.def.density * below;
            return true;
        });
        const float column = above > 0 ? sum / static_cast<float>(above) : 0.0f;
        const float pressure = std::min(column, m.def.density * length(f.gravity) * open);
        p.pressure[i] = pressure;
        p.velocityChange[i].w =
            stiffStart(m.viscosity(p.liquidFraction[i]), m.def.density, p.position[i].w / kSupport, pressure);
    }
}

// Row i moves from now on. What rested on it or beside it looks again.
void Hold::letGo(const HoldFrame& f, size_t i) const {
    Particles& p = f.particles;
    if (p.piece[i]) f.rigid.lost(p.piece[i]);
    p.flags[i] = static_cast<uint8_t>(p.flags[i] & ~(kFixed | kAsleep | kRigid));
    p.piece[i] = 0;
    p.anchor[i] = 0; // its velocity stays that of what it hung on
    p.velocityChange[i] = {};
    p.stiffness[i] = 0;
    // What has bonds moves with what is around it: nothing is bare by that.
    const bool bonds = p.bondSlot[i], referred = p.fine[i] && !bonds;
    if (!bonds) p.fine[i] = 0;
    if (!f.rigid.any() && !referred) return;
    forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t j) {
        if (j >= static_cast<uint32_t>(p.count)) return false;
        if (p.piece[j]) f.rigid.wake(p.piece[j]);
        // What it covered may be bare from now on, whatever the reference says.
        if (!bonds && p.level[j] == 0) p.fine[j] = 0;
        return true;
    });
}

// The rows of a piece, or those that are not held (piece 0), by what hangs together: the largest part of a piece stays
// that piece, the others become pieces of their own, and a few particles a lump.
int Hold::separate(const HoldFrame& f, uint16_t piece) {
    Particles& p = f.particles;
    int cut = 0;
    const uint32_t n = static_cast<uint32_t>(p.count);
    // What is elastic moves by its bonds.
    const auto soft = [&](uint32_t i) { return f.materials[p.material[i]].soft(); };
    const auto open = [&](uint32_t i) {
        return (p.flags[i] & kFixed) && p.piece[i] == piece && state_[i] != kReached && !soft(i);
    };
    for (uint32_t i = 0; i < n && !piece; ++i)
        if ((p.flags[i] & kFixed) && !p.piece[i] && state_[i] != kReached && soft(i)) letGo(f, i), ++cut;
    // The largest first part stays; parts come one after the other in queue_.
    const auto flood = [&](uint32_t seed) {
        queue_.clear();
        queue_.push(seed), state_[seed] = kReached;
        for (size_t head = 0; head < queue_.size(); ++head) {
            const uint32_t i = queue_[head];
            forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t j) {
                if (j < n && open(j) && linked(p, i, j)) state_[j] = kReached, queue_.push(j);
                return true;
            });
        }
    };
    size_t most = 0;
    uint32_t keeper = n;
    if (piece) {
        for (uint32_t i = 0; i < n; ++i)
            if (open(i)) {
                flood(i);
                if (queue_.size() > most) most = queue_.size(), keeper = i;
            }
        if (most < kLeastPiece) keeper = n;
        for (uint32_t i = 0; i < n; ++i)
            if (p.piece[i] == piece) state_[i] = kStay;
        if (keeper < n) flood(keeper);
    }
    for (uint32_t seed = 0; seed < n; ++seed) {
        if (!open(seed)) continue;
        flood(seed);
        cut += static_cast<int>(queue_.size());
        if (queue_.size() < kLeastPiece || !f.rigid.create(p, queue_.data(), queue_.size(), piece))
            for (const uint32_t i : queue_) letGo(f, i);
    }
    if (piece) f.rigid.intact(piece);
    return cut;
}

void Hold::prepare(const HoldFrame& f) {
    const size_t n = static_cast<size_t>(f.particles.count);
    state_.resizeRaw(n), against_.resizeRaw(n);
    if (f.toldApart) anchor_.resizeRaw(n);
    queue_.reserve(2 * static_cast<size_t>(f.particles.capacity)); // now, so that looking later allocates nothing
    colliderBounds_.resizeRaw(static_cast<size_t>(f.colliderCount));
    for (int c = 0; c < f.colliderCount; ++c)
        if (f.colliders[c].alive) colliderBounds_[static_cast<size_t>(c)] = f.colliders[c].bounds();
}

HoldResult Hold::relabel(const HoldFrame& f) {
    prepare(f);
    HoldResult result;
    Particles& p = f.particles;
    std::fill(state_.begin(), state_.end(), uint8_t{kStay});
    reach(f);
    for (size_t i = 0; i < static_cast<size_t>(p.count); ++i)
        if (state_[i] == kReached && !p.anchor[i]) p.velocity[i].setXyz({});
    result.cutLoose = separate(f, 0);
    const size_t pieces = f.rigid.pieces().size();
    for (size_t s = 0; s < pieces; ++s)
        if (f.rigid.pieces()[s].alive && f.rigid.pieces()[s].lostRows)
            result.cutLoose += separate(f, static_cast<uint16_t>(s + 1));
    return result;
}

HoldResult Hold::update(const HoldFrame& f) {
    Particles& p = f.particles;
    const size_t n = static_cast<size_t>(p.count);
    prepare(f);
    blocks_.assign(static_cast<size_t>(Tasks::blockCount(p.count, kRowBlock)), {});
    f.tasks.forBlocks(p.count, kRowBlock, [&](int begin, int end, int block, int) {
        blocks_[static_cast<size_t>(block)] = decide(f, begin, end);
    });
    HoldResult result;
    for (const HoldResult& r : blocks_) result.released += r.released, result.set += r.set;

    queue_.clear();
    for (size_t i = 0; i < n && result.changed(); ++i) {
        if (state_[i] == kRelease) {
            letGo(f, i), queue_.push(static_cast<uint32_t>(i));
        } else if (state_[i] == kSet) {
            p.velocityChange[i] = {0, 0, 0, 1};
            if (against_[i]) {
                p.flags[i] |= kFixed | kRigid;
                f.rigid.join(p, static_cast<uint32_t>(i), against_[i]);
            } else {
                p.flags[i] |= kFixed;
                if (f.toldApart)
                    p.anchor[i] = anchor_[i]; // what it loses of its velocity goes there with the next step
                else
                    p.velocity[i].setXyz({});
            }
        }
    }
    if (queue_.size() > 0) pressurize(f);
    if (f.relabel) result.cutLoose = relabel(f).cutLoose;
    return result;
}

} // namespace thaw
