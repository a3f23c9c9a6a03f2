// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "levels/levels.h"

#include "motion/bonds.h"

#include <algorithm>

namespace thaw {
namespace {

constexpr int kRowBlock = 512;
// A row is looked at every so many steps: one that may have to split, and one that may only merge.
constexpr uint32_t kTurns = 4, kFineTurns = 16;
// Units of Particles::want in a spacing.
constexpr float kUnits = 8;
// From here on, in spacings from where it must be the finest, a particle may be of level 1, 2, 3.
constexpr float kBand[kHighestLevel] = {2, 3.25f, 4.75f};
// Largest difference of temperature over a particle, as a share of what it lacks to the solidus. The candle's melted
// mass over 6 s is within what moving its flame by 0.01 mm changes (1.2 %) with 0.15, 0.3 and 0.4, 2.5 % off with 1.
constexpr float kResolve = 0.3f;
// What lacks little to the solidus lacks this share of its latent heat, in kelvin: ice at -0.5 degrees is not refined
// for differences of 0.1 K, which move its front by nothing.
constexpr float kLatentShare = 0.02f;
constexpr int kMostMerges = 128; // in a step

// The share of a support that is filled below which a liquid that is no surface is at a wall, and fine: with coarse
// particles there a pool of 28 layers never came to rest (0.33 m/s, density error 0.24), and a dam of 10 Pa s was 12 %
// late (`thaw validate motion levels`).
constexpr float kInside = 0.91f;
// Of its feature size, what counts as a liquid's distance from where it must be fine: in the middle of a slab that is
// its depth, at the surface of one half of that.
constexpr float kOfFeature = 0.5f;

} // namespace

int Levels::levelOf(int want) {
    int level = 0;
    while (level < kHighestLevel && static_cast<float>(want) >= kBand[level] * kUnits) ++level;
    return level;
}

uint8_t Levels::wantOfSolid(const LevelFrame& f, int row, const float* flux) const {
    const Particles& p = f.particles;
    const size_t i = static_cast<size_t>(row);
    const Material& m = f.materials[p.material[i]];
    const Vec4 x = p.position[i];
    const float T = p.temperature[i];
    if (!(T < m.def.solidus)) return 0;
    const float lacks = m.def.solidus - T + kLatentShare * static_cast<float>(m.latent) / m.def.specificHeatSolid;
    float steepest = 0, nearest = static_cast<float>(kFar); // K/m, units
    forNeighbors(f.neighbors, row, [&](uint32_t j) {
        if (j >= static_cast<uint32_t>(p.count)) return false;
        const float d = length(p.position[j].xyz() - x.xyz());
        steepest = std::max(steepest, std::abs(p.temperature[j] - T) / std::max(d, 0.1f * f.spacing));
        const float from = p.fine[j] && p.body[j] == p.body[i] ? static_cast<float>(p.want[j]) : 0.0f;
        nearest = std::min(nearest, from + d * (kUnits / f.spacing));
        return true;
    });
    if (flux && p.normal[i].w > 0) {
        const float k = m.conductivity(0);
        if (k > 0) steepest = std::max(steepest, std::abs(flux[i]) / (p.normal[i].w * k));
    }
    // From the coarsest down to the level whose edge is short enough.
    int level = kHighestLevel;
    while (level > 0 && steepest * supportOf(f.spacing, level) > kSupport * kResolve * lacks) --level;
    if (level < kHighestLevel) nearest = std::min(nearest, level > 0 ? kBand[level - 1] * kUnits : 0);
    return static_cast<uint8_t>(nearest);
}

uint8_t Levels::wantOfLiquid(const LevelFrame& f, int row) const {
    const Particles& p = f.particles;
    const size_t i = static_cast<size_t>(row);
    const int coarsest = f.coarsestOf ? f.coarsestOf[p.body[i]] : 0;
    const bool open = p.flags[i] & kSurface;
    if (coarsest == 0 || (!open && f.neighbors.volumeFraction[i] < kInside)) return 0;
    float nearest = kOfFeature * static_cast<float>(p.feature[i].size);
    if (coarsest < kHighestLevel) nearest = std::min(nearest, kBand[coarsest] * kUnits - 1);
    forNeighbors(f.neighbors, row, [&](uint32_t j) {
        if (j >= static_cast<uint32_t>(p.count)) return false;
        const float d = length(p.position[j].xyz() - p.position[i].xyz());
        const bool alike =
            !p.fixed(static_cast<int>(j)) && !p.bondSlot[j] && p.body[j] == p.body[i] && p.material[j] == p.material[i];
        nearest = std::min(nearest, (alike ? static_cast<float>(p.want[j]) : 0.0f) + d * (kUnits / f.spacing));
        return true;
    });
    return static_cast<uint8_t>(nearest);
}

void Levels::choose(const LevelFrame& f, const float* flux, bool all) {
    Particles& p = f.particles;
    if (f.coarsestOf)
        features_.relax({p, f.neighbors, f.tasks, f.spacing, p.moverCount}, static_cast<uint32_t>(f.step % kTurns),
                        kTurns);
    next_.resizeRaw(static_cast<size_t>(p.count));
    const auto step = static_cast<uint32_t>(f.step % kFineTurns);
    f.tasks.forBlocks(p.count, kRowBlock, [&](int begin, int end, int, int) {
        for (int r = begin; r < end; ++r) {
            const size_t i = static_cast<size_t>(r);
            const bool solid = p.fixed(r) || p.bondSlot[i];
            if (solid && !p.fine[i])
                next_[i] = 0;
            else if (!all && (p.id[i] ^ step) % (p.level[i] > 0 || !solid ? kTurns : kFineTurns) != 0)
                next_[i] = p.want[i];
            else
                next_[i] = solid ? wantOfSolid(f, r, flux) : wantOfLiquid(f, r);
        }
    });
    std::copy(next_.begin(), next_.end(), p.want.begin());
}

int Levels::target(const LevelFrame& f, size_t row, int margin) const {
    return std::clamp(levelOf(f.particles.want[row] - margin), f.finest, std::max(f.finest, f.coarsest));
}

void Levels::splitRow(const LevelFrame& f, size_t i, int to) {
    Particles& p = f.particles;
    const int level = p.level[i], parts = 1 << (level - to);
    const uint32_t begin = p.fine[i] - 1;
    const Vec3 shift = p.position[i].xyz() - f.reference.center(begin, level);
    for (int part = parts - 1; part >= 0; --part) {
        const size_t k = part == 0 ? i : static_cast<size_t>(p.count++);
        if (part > 0) {
            p.copyRow(k, i);
            p.id[k] = f.nextId++;
        }
        const uint32_t first = begin + (static_cast<uint32_t>(part) << to);
        p.fine[k] = first + 1, p.level[k] = static_cast<uint8_t>(to);
        const Vec3 x = f.reference.center(first, to) + shift;
        p.position[k] = {x.x, x.y, x.z, supportOf(f.spacing, to)};
        p.velocity[k].w /= static_cast<float>(parts); // a power of two: exact
        p.normal[k] = {}, p.rayAge[k] = 0;
    }
}

bool Levels::splitFully(const LevelFrame& f, const uint32_t* rows, size_t count) {
    Particles& p = f.particles;
    picked_.clear();
    int room = p.capacity - p.count;
    bool any = false;
    for (size_t k = 0; k < count; ++k) {
        const uint32_t i = rows[k];
        const int more = (1 << p.level[i]) - 1;
        if (p.level[i] == 0 || !p.fine[i] || more > room) continue;
        room -= more, any = true;
        p.want[i] = 0; // and do not merge before the next look
        if (f.bonds && p.bondSlot[i])
            picked_.push(i);
        else
            splitRow(f, i, 0);
    }
    splitPicked(f, true);
    if (any) p.pad();
    return any;
}

LevelResult Levels::apply(const LevelFrame& f) {
    Particles& p = f.particles;
    LevelResult result;
    rows_ = p.count, room_ = std::min(f.mostSplits, p.capacity - p.count);
    gone_.resizeRaw(static_cast<size_t>(rows_));
    std::fill(gone_.begin(), gone_.end(), uint8_t{0});
    solids(f, result);
    bonded(f, result);
    liquids(f, result);
    if (result.merged > 0) {
        size_t kept = 0;
        const size_t all = static_cast<size_t>(p.count);
        for (size_t k = 0; k < all; ++k) {
            if (k < gone_.size() && gone_[k]) continue;
            if (kept != k) p.copyRow(kept, k);
            ++kept;
        }
        p.count = static_cast<int>(kept);
    }
    if (result.split + result.merged > 0) p.pad();
    return result;
}

bool Levels::takeRoom(int more, LevelResult& result) {
    if (more > room_) {
        result.refused = true;
        return false;
    }
    room_ -= more, result.split += more;
    return true;
}

void Levels::solids(const LevelFrame& f, LevelResult& result) {
    Particles& p = f.particles;
    const auto step = static_cast<uint32_t>(f.step % kFineTurns);
    for (int r = 0; r < rows_; ++r) {
        const size_t i = static_cast<size_t>(r);
        if (!p.fine[i] || gone_[i] || !p.fixed(r) || p.bondSlot[i]) continue;
        // What is fine has to be looked at anew before it merges.
        if (p.level[i] == 0 && f.finest == 0 && (p.id[i] ^ step) % kFineTurns != 0) continue;
        const int level = p.level[i], wanted = target(f, i);
        if (level > wanted) {
            if (takeRoom((1 << (level - wanted)) - 1, result)) splitRow(f, i, wanted);
        } else if (result.merged < kMostMerges && mergeSolid(f, i)) {
            ++result.merged;
        }
    }
}

// With its sibling in the reference, when both stand where that says. Only the first of a pair looks for the other.
bool Levels::mergeSolid(const LevelFrame& f, size_t i) {
    Particles& p = f.particles;
    const int level = p.level[i];
    const uint32_t begin = p.fine[i] - 1, sibling = begin + (1u << level);
    if (level >= std::max(f.finest, f.coarsest) || level >= f.reference.highestLevel(begin) || (begin >> level & 1))
        return false;
    const auto ready = [&](size_t k, int margin) { return std::max(levelOf(p.want[k] - margin), f.finest) > level; };
    if (!ready(i, kMergeMargin)) return false;
    size_t j = i;
    forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t k) {
        if (k >= static_cast<uint32_t>(rows_)) return false;
        if (p.fine[k] != sibling + 1) return true;
        j = k;
        return false;
    });
    if (j == i || gone_[j] || p.level[j] != level || !p.fixed(static_cast<int>(j)) || !ready(j, 0) ||
        p.piece[j] != p.piece[i] || p.anchor[j] != p.anchor[i] || p.absorbs[j] != p.absorbs[i] || p.bondSlot[j])
        return false;
    const Vec3 apart = f.reference.center(sibling, level) - f.reference.center(begin, level);
    const Vec3 xi = p.position[i].xyz(), xj = p.position[j].xyz();
    if (length(xj - xi - apart) > 0.05f * f.spacing) return false;
    const Material& m = f.materials[p.material[i]];
    gone_[j] = 1;
    const Vec3 x = 0.5f * (xi + xj);
    p.position[i] = {x.x, x.y, x.z, supportOf(f.spacing, level + 1)};
    const Vec4 vi = p.velocity[i], vj = p.velocity[j];
    p.velocity[i] = {0.5f * (vi.x + vj.x), 0.5f * (vi.y + vj.y), 0.5f * (vi.z + vj.z), vi.w + vj.w};
    p.enthalpy[i] = 0.5 * (p.enthalpy[i] + p.enthalpy[j]);
    p.temperature[i] = m.temperature(p.enthalpy[i]), p.liquidFraction[i] = m.liquidFraction(p.enthalpy[i]);
    p.level[i] = static_cast<uint8_t>(level + 1);
    p.want[i] = std::min(p.want[i], p.want[j]);
    p.rayAge[i] = 0;
    return true;
}

} // namespace thaw
