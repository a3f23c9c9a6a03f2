// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Levels of what has bonds: elastic solids, and what is held beside them.
#include "levels/levels.h"
#include "motion/bonds.h"

#include <algorithm>

namespace thaw {
namespace {

// A row that may only merge is looked at every so many steps, and so many groups merge in one.
constexpr uint32_t kTurns = 16;
constexpr int kMostMerges = 32;

} // namespace

// Elastic solids have bricks of 2 x 2 x 2, or the finest: of half a brick the lattice has no springs along its long
// side within reach.
int Levels::targetOfBonded(const LevelFrame& f, size_t row) const {
    const int level = target(f, row);
    return f.materials[f.particles.material[row]].soft() && level < kHighestLevel ? 0 : level;
}

// Together, so that what lies between them bears what it bore.
void Levels::splitPicked(const LevelFrame& f, bool fully) {
    Particles& p = f.particles;
    if (picked_.empty()) return;
    f.bonds->beforeSplits(p, f.materials, picked_.data(), picked_.size());
    for (size_t place = 0; place < picked_.size(); ++place) {
        const uint32_t row = picked_[place];
        const int to = fully ? 0 : targetOfBonded(f, row);
        const size_t parts = size_t{1} << (p.level[row] - to), begin = static_cast<size_t>(p.count);
        splitRow(f, row, to);
        uint32_t rows[1 << kHighestLevel] = {row};
        for (size_t c = 1; c < parts; ++c) rows[c] = static_cast<uint32_t>(begin + c - 1);
        f.bonds->split(p, f.reference, place, rows, parts);
    }
    f.bonds->settleBonds(p, f.materials);
}

void Levels::bonded(const LevelFrame& f, LevelResult& result) {
    if (!f.bonds || !f.bonds->any()) return;
    Particles& p = f.particles;
    picked_.clear(), groups_.clear();
    const int merged = result.merged;
    const auto step = static_cast<uint32_t>(f.step % kTurns);
    for (int r = 0; r < rows_; ++r) {
        const size_t i = static_cast<size_t>(r);
        if (!p.bondSlot[i] || !p.fine[i] || gone_[i]) continue;
        const int level = p.level[i], wanted = targetOfBonded(f, i);
        if (level > wanted) {
            if (takeRoom((1 << (level - wanted)) - 1, result)) picked_.push(static_cast<uint32_t>(i));
        } else if (level == 0 && wanted == kHighestLevel && (f.finest > 0 || (p.id[i] ^ step) % kTurns == 0) &&
                   result.merged - merged < kMostMerges * ((1 << kHighestLevel) - 1)) {
            result.merged += mergeBonded(f, i);
        }
    }
    mergeGroups(f);
    splitPicked(f, false);
}

// All eight of a brick, when they hang together and are calm. Only the first of them looks for the others. How many
// went.
int Levels::mergeBonded(const LevelFrame& f, size_t i) {
    constexpr size_t kParts = 1 << kHighestLevel;
    Particles& p = f.particles;
    const uint32_t begin = p.fine[i] - 1;
    if (begin % kParts != 0 || f.reference.highestLevel(begin) < kHighestLevel) return 0;
    const auto ready = [&](size_t k) {
        return f.finest == kHighestLevel || levelOf(p.want[k] - kMergeMargin) == kHighestLevel;
    };
    constexpr uint8_t kAlike = kFixed | kAsleep | kRigid | kUnseeded;
    uint32_t rows[kParts] = {};
    size_t found = 0;
    const auto look = [&](uint32_t k) {
        if (p.fine[k] <= begin || p.fine[k] > begin + kParts) return;
        const bool alike = p.level[k] == 0 && !gone_[k] && p.bondSlot[k] && ready(k) &&
                           !((p.flags[k] ^ p.flags[i]) & kAlike) && p.anchor[k] == p.anchor[i] &&
                           p.absorbs[k] == p.absorbs[i] && p.piece[k] == p.piece[i];
        if (alike) rows[p.fine[k] - 1 - begin] = k, ++found;
    };
    look(static_cast<uint32_t>(i));
    forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t k) {
        if (k >= static_cast<uint32_t>(rows_)) return false;
        look(k);
        return true;
    });
    if (found != kParts || !f.bonds->mayUnite(p, f.reference, rows, kParts, f.dt)) return 0;
    for (const uint32_t k : rows) groups_.push(k), gone_[k] = k != rows[0];
    return static_cast<int>(kParts) - 1;
}

void Levels::mergeGroups(const LevelFrame& f) {
    constexpr size_t kParts = 1 << kHighestLevel;
    constexpr double kShare = 1.0 / kParts;
    Particles& p = f.particles;
    const size_t count = groups_.size() / kParts;
    if (count == 0) return;
    f.bonds->beforeMergers(p, f.materials, groups_.data(), count, kParts);
    for (size_t place = 0; place < count; ++place) {
        const uint32_t* rows = groups_.data() + place * kParts;
        const size_t i = rows[0];
        double x[3] = {}, v[3] = {}, mass = 0, heat = 0;
        for (size_t c = 0; c < kParts; ++c) {
            const Vec4 at = p.position[rows[c]], u = p.velocity[rows[c]];
            x[0] += at.x, x[1] += at.y, x[2] += at.z, v[0] += u.x, v[1] += u.y, v[2] += u.z;
            mass += u.w, heat += p.enthalpy[rows[c]];
            p.want[i] = std::min(p.want[i], p.want[rows[c]]);
        }
        const auto mean = [&](const double(&s)[3], double w) {
            return Vec4{static_cast<float>(kShare * s[0]), static_cast<float>(kShare * s[1]),
                        static_cast<float>(kShare * s[2]), static_cast<float>(w)};
        };
        const Vec4 to = mean(x, static_cast<double>(supportOf(f.spacing, kHighestLevel)));
        // Its points stay where they are.
        for (size_t c = 0; c < kParts; ++c)
            f.reference.point[p.fine[i] - 1 + c].setXyz(p.position[rows[c]].xyz() - to.xyz());
        p.position[i] = to, p.velocity[i] = mean(v, mass), p.enthalpy[i] = kShare * heat;
        const Material& m = f.materials[p.material[i]];
        p.temperature[i] = m.temperature(p.enthalpy[i]), p.liquidFraction[i] = m.liquidFraction(p.enthalpy[i]);
        p.level[i] = kHighestLevel, p.rayAge[i] = 0;
        f.bonds->unite(p, f.reference, place, rows, kParts);
    }
    f.bonds->settleBonds(p, f.materials);
}

} // namespace thaw
