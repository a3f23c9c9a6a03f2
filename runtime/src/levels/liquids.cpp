// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// Levels of what flows.
#include "levels/levels.h"

#include <algorithm>

namespace thaw {
namespace {

// A mover is looked at every so many steps, and of all movers this share may split or merge in one: of what lies still,
// and of what moves by more than kCalm spacings in a step of 1/60 s. A pool of 1,000 at rest that merges in pairs, or
// splits again, has 1.0 and 1.1 mm/s rms at 2 mm, 3.0 and 2.2 at 4 mm; with 1 in 100 half as much again, and 1.8
// and 4.6 (4.9 and 11) without kStiff (levels_test.cpp).
constexpr uint32_t kTurns = 8;
constexpr int kShare = 300, kMovingShare = 30, kLeast = 2;
constexpr float kCalm = 0.05f; // 1 / share, and so many in any case
// Halves stand so far from the middle, in spacings of the whole: from 0.35 on they kick least, and the nearer to 0.45
// the less dense they are (6 and 4 %) and the denser is what is beside (2 and 4 %).
constexpr float kOffset = 0.37f;
// Merges with what is nearer than this, in spacings, and no faster against it, in spacings a step of 1/60 s.
constexpr float kNear = 1.3f, kSlow = 0.5f;
// Where it is calm, what an event changed and all around it is so many times as viscous at first, at most by as many
// times density x spacing^2 / step: the end of it is the same, with less of a kick (`thaw bench kicks`).
constexpr float kStiff = 100;
// A half comes no nearer to a wall, in its own spacings. Where it has to, by the square of how much: what lies at the
// wall splits along it. With each half counted alike it split across it, and the wall threw out what came to lie
// behind: 8.9 mm/s at 2 mm and 20.7 at 4 mm instead of 5.8 and 11.4 (levels_test.cpp).
constexpr float kWall = 0.45f;

float wendland(float r, float h) { return wendlandShape(r / h) / (h * h * h); }

} // namespace

// The neighbours of an event: what their density becomes by it is no error at first, and where it is calm they are
// stiff for a while.
void Levels::disturb(const LevelFrame& f, size_t i, bool calm) const {
    Particles& p = f.particles;
    const auto mark = [&](size_t k) {
        if (static_cast<int>(k) >= p.moverCount) return;
        p.blend[k] = kPending + std::clamp(f.errors[k].w, -2.0f, 2.0f);
        if (!calm) return;
        const Material& m = f.materials[p.material[k]];
        const float edge = p.position[k].w / kSupport;
        float& extra = p.velocityChange[k].w;
        extra = std::max(extra, kStiff * std::min(m.viscosity(p.liquidFraction[k]), 60 * m.def.density * edge * edge));
    };
    mark(i);
    forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t j) {
        if (j >= static_cast<uint32_t>(rows_)) return false;
        if (!p.fixed(static_cast<int>(j))) mark(j);
        return true;
    });
}

// In two, along the emptiest of thirteen directions, at a surface mostly out of it: without those a pool of 2 mm that
// splits has a particle of 22 mm/s instead of 9.
void Levels::splitLiquid(const LevelFrame& f, size_t i, bool calm) {
    Particles& p = f.particles;
    const int level = p.level[i] - 1;
    const Vec4 at = p.position[i];
    const Vec3 x = at.xyz();
    const float h = supportOf(f.spacing, level), offset = kOffset * at.w / kSupport;
    const auto filled = [&](Vec3 place) {
        float sum = 0;
        forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t j) {
            if (j >= static_cast<uint32_t>(rows_)) return false;
            const float volume = p.position[j].w * p.position[j].w * p.position[j].w; // up to a factor
            sum += volume * wendland(length(p.position[j].xyz() - place), 0.5f * (h + p.position[j].w));
            return true;
        });
        for (int c = 0; c < f.colliderCount; ++c) {
            Vec3 normal;
            if (!f.colliders[c].alive) continue;
            const float deep = std::max(0.0f, kWall - f.colliders[c].distance(place, normal) * kSupport / h);
            sum += 1e6f * deep * deep;
        }
        return sum;
    };
    Vec3 best{1, 0, 0};
    float least = INFINITY;
    for (int a = 0; a <= 1; ++a)
        for (int b = -1; b <= 1; ++b)
            for (int c = -1; c <= 1; ++c) {
                if (9 * a + 3 * b + c <= 0) continue; // each line once
                const Vec3 e = normalizeOr({static_cast<float>(a), static_cast<float>(b), static_cast<float>(c)}, {});
                const float sum = filled(x + offset * e) + filled(x - offset * e);
                if (sum < least) least = sum, best = e;
            }
    disturb(f, i, calm);
    const size_t to = static_cast<size_t>(p.count++);
    p.velocity[i].w *= 0.5f;
    p.level[i] = static_cast<uint8_t>(level), p.stiffness[i] = 0, p.normal[i] = {}, p.rayAge[i] = 0;
    p.copyRow(to, i);
    p.id[to] = f.nextId++;
    const Vec3 left = x - offset * best, right = x + offset * best;
    p.position[i] = {left.x, left.y, left.z, h}, p.position[to] = {right.x, right.y, right.z, h};
}

// With the nearest of its level and kind.
bool Levels::mergeLiquid(const LevelFrame& f, size_t i, bool calm) {
    Particles& p = f.particles;
    const int level = p.level[i];
    const Vec3 x = p.position[i].xyz();
    const float spacing = p.position[i].w / kSupport;
    size_t best = i;
    float nearest = kNear * spacing;
    forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t j) {
        if (j >= static_cast<uint32_t>(rows_)) return false;
        if (p.fixed(static_cast<int>(j)) || gone_[j] || p.level[j] != level || p.body[j] != p.body[i] ||
            p.material[j] != p.material[i] || p.bondSlot[j] || ((p.flags[j] ^ p.flags[i]) & kUnseeded) ||
            p.absorbs[j] != p.absorbs[i] || p.follows[j] != p.follows[i] || target(f, j) <= level)
            return true;
        const float d = length(p.position[j].xyz() - x);
        const float speed = length(p.velocity[j].xyz() - p.velocity[i].xyz());
        if (d < nearest && speed < kSlow * 60 * spacing) nearest = d, best = j;
        return true;
    });
    if (best == i) return false;
    const size_t j = best;
    disturb(f, i, calm), disturb(f, j, calm);
    const float mi = p.velocity[i].w, mj = p.velocity[j].w, share = mj / (mi + mj);
    const auto mean = [&](auto& a) { a[i] += share * (a[j] - a[i]); };
    const auto meanOfVectors = [&](Array<Vec4>& a) { a[i].setXyz(a[i].xyz() + share * (a[j].xyz() - a[i].xyz())); };
    meanOfVectors(p.position), meanOfVectors(p.velocity), meanOfVectors(p.velocityChange);
    p.velocityChange[i].w = std::max(p.velocityChange[i].w, p.velocityChange[j].w);
    mean(p.pressure), mean(p.blend);
    p.velocity[i].w = mi + mj, p.position[i].w = supportOf(f.spacing, level + 1);
    const double wide = static_cast<double>(mj) / (static_cast<double>(mi) + mj);
    p.enthalpy[i] += wide * (p.enthalpy[j] - p.enthalpy[i]);
    const Material& m = f.materials[p.material[i]];
    const bool unseeded = p.flags[i] & kUnseeded;
    p.temperature[i] = std::max(0.0f, static_cast<float>(m.kelvin(p.enthalpy[i], unseeded)));
    p.liquidFraction[i] = m.liquidFraction(p.enthalpy[i], unseeded);
    p.level[i] = static_cast<uint8_t>(level + 1), p.stiffness[i] = 0, p.normal[i] = {}, p.rayAge[i] = 0;
    gone_[j] = 1;
    return true;
}

void Levels::liquids(const LevelFrame& f, LevelResult& result) {
    Particles& p = f.particles;
    int calm = std::max(kLeast, p.moverCount / kShare), moving = std::max(kLeast, p.moverCount / kMovingShare);
    const uint32_t turn = static_cast<uint32_t>(f.step % kTurns);
    for (int r = 0; r < std::min(rows_, p.moverCount) && calm + moving > 0; ++r) {
        const size_t i = static_cast<size_t>(r);
        const bool still = length(p.velocity[i].xyz()) * kSupport <= kCalm * 60 * p.position[i].w;
        int& most = still ? calm : moving;
        if (most == 0) continue;
        if (p.id[i] % kTurns != turn || p.fixed(r) || gone_[i] || p.bondSlot[i]) continue;
        const int level = p.level[i], wanted = target(f, i);
        if (level > wanted) {
            if (!takeRoom(1, result)) continue;
            splitLiquid(f, i, still);
            --most;
        } else if (level < target(f, i, kMergeMargin) && mergeLiquid(f, i, still)) {
            ++result.merged, --most;
        }
    }
}

} // namespace thaw
