// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/kernel.h"
#include "base/math.h"
#include "motion/bond_pass.h"
#include "motion/bonds.h"
#include "motion/numbers.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

constexpr float kLongest = 0.9f; // of the support: what is farther apart has lost its bond
constexpr float kFading = 0.15f; // of a bond's weight goes per step when it breaks
constexpr float kWeld = 1.3f;    // spacings: what has flowed bonds with its body again

} // namespace

// Against what has no bond: like a spring of the lattice, which only pushes.
float Bonds::contactStiffness(const Elastic& a, const Elastic& b, float spacing) {
    float modulus = a.modulus + b.modulus;
    if (a.modulus > 0 && b.modulus > 0) modulus = 2 * (a.modulus * b.modulus) / modulus;
    return 0.4f * modulus * spacing * (a.share * b.share);
}

float Bonds::stiffnessOfLayer(const BondFrame& f, uint32_t row) const {
    const Elastic own = elastic(f.materials, f.particles, row);
    return own.modulus * own.share * f.particles.position[row].w / kSupport;
}

void Bonds::lay(const BondFrame& f) {
    const Particles& p = f.particles;
    const Neighbors& nb = f.neighbors;
    mapRows(p);
    stiffness.resizeRaw(nb.entries.size()), rest.resizeRaw(nb.entries.size());
    groupOn.assign(static_cast<size_t>(nb.moverGroups), 0);
    f.tasks.forBlocks(nb.moverGroups, kBlock, [&](int begin, int end, int, int) {
        for (int g = begin; g < end; ++g) {
            const int last = std::min(8 * g + 8, p.moverCount);
            bool on = false;
            for (int r = 8 * g; r < last; ++r) on |= p.bondSlot[static_cast<size_t>(r)] != 0;
            if (!on) continue;
            groupOn[static_cast<size_t>(g)] = 1;
            const size_t first = nb.first[g];
            const uint32_t width = nb.width[g];
            std::fill(stiffness.data() + first, stiffness.data() + first + 8 * width, 0.0f);
            std::fill(rest.data() + first, rest.data() + first + 8 * width, 0.0f);
            for (int r = 8 * g; r < last; ++r) {
                const uint32_t i = static_cast<uint32_t>(r), slot = p.bondSlot[i];
                if (!slot) continue;
                borne_[slot] = {};
                const size_t lane = first + (i & 7);
                const Elastic own = elastic(f.materials, p, i);
                const Bond* b = bondsOf(slot);
                uint32_t k = 0; // entries ascend, and bonds mostly do
                for (int n = 0; n < count_[slot]; ++n) {
                    const uint32_t j = rowOf_[b[n].other];
                    if (k >= width || nb.entries[lane + 8 * k] >> 4 > j) k = 0;
                    while (k < width && nb.entries[lane + 8 * k] >> 4 < j) ++k;
                    if (k >= width || nb.entries[lane + 8 * k] >> 4 != j) continue;
                    stiffness[lane + 8 * k] =
                        mixed(p, i, j) * b[n].weight * pairStiffness(own, elastic(f.materials, p, j));
                    rest[lane + 8 * k] = b[n].rest;
                }
                const Vec4 x = p.position[i];
                for (k = 0; k < width; ++k) {
                    const uint32_t j = nb.entries[lane + 8 * k] >> 4;
                    if (j >= static_cast<uint32_t>(p.count)) break;
                    // Pieces: see SoftContacts.
                    if (rest[lane + 8 * k] > 0 || p.piece[j] || (!p.bondSlot[j] && !(p.flags[j] & kFixed))) continue;
                    const Vec3 d = x.xyz() - p.position[j].xyz();
                    const float spacing = 0.5f * (x.w + p.position[j].w) / kSupport, near = kContact * spacing;
                    const float distance = length(d);
                    const Vec3 apart = p.velocity[i].xyz() - p.velocity[j].xyz();
                    const float closing = dot(d, apart) * f.dt;
                    // Of the same body only what is near already: it bends and turns without meeting itself.
                    if (!(distance < near) && (p.body[i] == p.body[j] || !(distance * (distance - near) < -closing)))
                        continue;
                    Elastic other;
                    if (p.bondSlot[j]) other = elastic(f.materials, p, j);
                    stiffness[lane + 8 * k] = contactStiffness(own, other, spacing), rest[lane + 8 * k] = near;
                }
            }
        }
    });
}

Bonds::Virial Bonds::virial(const Particles& p, const Material* materials, uint32_t row) const {
    const Elastic own = elastic(materials, p, row);
    const uint32_t slot = p.bondSlot[row];
    const Bond* b = bondsOf(slot);
    const Vec4 x = p.position[row];
    Virial s{};
    for (int k = 0; k < count_[slot]; ++k) {
        const uint32_t j = rowOf_[b[k].other];
        const Vec3 d = x.xyz() - p.position[j].xyz();
        const float r = std::max(length(d), 1e-12f);
        // Of a spring across levels each has as much as of the way.
        const float part = p.level[row] == p.level[j] ? 1.0f : kMixed * 2 * x.w / (x.w + p.position[j].w);
        const float stiff = part * b[k].weight * pairStiffness(own, elastic(materials, p, j));
        const float pull = -stiff * std::min(b[k].rest - r, kMostPress * b[k].rest) / r;
        s.all += stiff * r * b[k].rest;
        s.xx += pull * d.x * d.x, s.yy += pull * d.y * d.y, s.zz += pull * d.z * d.z;
        s.xy += pull * d.x * d.y, s.yz += pull * d.y * d.z, s.zx += pull * d.z * d.x;
    }
    return s;
}

Bonds::Stress Bonds::stress(const BondFrame& f, uint32_t row) const {
    const Elastic own = elastic(f.materials, f.particles, row);
    const Virial s = virial(f, row);
    const float mean = (s.xx + s.yy + s.zz) / 3, a = s.xx - mean, c = s.yy - mean, e = s.zz - mean;
    const float deviator = a * a + c * c + e * e + 2 * (s.xy * s.xy + s.yz * s.yz + s.zx * s.zx);
    const float half = 0.5f / f.volume[row], modulus = 2 * own.modulus * own.share * own.share;
    // 3 K = 2 E. (The mean over the bonds is another one at the surface, which then creeps by a quarter less.)
    return {half * std::sqrt(1.5f * deviator), modulus > 0 ? half * mean / modulus : 0,
            s.all > 0 ? 3 * mean / s.all : 0};
}

// Perfect plasticity (von Mises) and Maxwell creep: the share of the deviatoric stress that goes in this step goes from
// the deviatoric strain of each bond, its strain less the mean of those around, into its rest length. thesis 3.16, 3.17
void Bonds::relax(const BondFrame& f) {
    Particles& p = f.particles;
    const auto flows = [&](uint32_t i) {
        const thawMaterialDef& d = f.materials[p.material[i]].def;
        return d.solidYieldStress > 0 || d.relaxationTime > 0 || d.breakStrain > 0;
    };
    bool any = false;
    bool used[256] = {};
    for (int i = 0; i < p.moverCount; ++i) {
        const size_t k = static_cast<size_t>(i);
        if (!p.bondSlot[k] || used[p.material[k]]) continue;
        used[p.material[k]] = true, any |= flows(static_cast<uint32_t>(i));
    }
    if (!any) return;

    f.tasks.forBlocks(p.count, 8 * kBlock, [&](int begin, int end, int, int) {
        for (int r = begin; r < end; ++r) {
            const uint32_t i = static_cast<uint32_t>(r), slot = p.bondSlot[i];
            strain_[i] = {0, 0};
            if (!slot || r >= p.moverCount || !flows(i)) continue;
            const thawMaterialDef& def = f.materials[p.material[i]].def;
            const Stress now = stress(f, i);
            float stays = 1, mean = now.meanStrain;
            const float share = elastic(f.materials, p, i).share, yield = def.solidYieldStress * share * share;
            // What flows far keeps its pressure bond by bond: with the mean of its volume, which is another one at the
            // surface and among new bonds, a slumped block fell into itself for ever (21 of 33 ml left after 28 s).
            if (def.solidYieldStress > 0 && now.mises > yield) stays = yield / now.mises, mean = now.bondMean;
            if (def.relaxationTime > 0) stays *= detExp(-f.dt / def.relaxationTime);
            strain_[i] = {mean, 1 - stays};
        }
    });

    // Both ends of a bond come to the same numbers, each for itself.
    f.tasks.forBlocks(p.count, 8 * kBlock, [&](int begin, int end, int, int) {
        for (int r = begin; r < end; ++r) {
            const uint32_t i = static_cast<uint32_t>(r), slot = p.bondSlot[i];
            if (!slot) continue;
            const bool moves = r < p.moverCount;
            if (!moves && !beside(f, i)) continue;
            Bond* b = bondsOf(slot);
            const Vec4 x = p.position[i];
            int kept = 0;
            for (int k = 0; k < count_[slot]; ++k) {
                Bond bond = b[k];
                const uint32_t j = rowOf_[bond.other];
                if (moves || j < static_cast<uint32_t>(p.moverCount)) {
                    const float r2 = length(x.xyz() - p.position[j].xyz()), e = r2 / bond.rest - 1;
                    const float flow = 0.5f * (strain_[i].release * (e - strain_[i].mean) +
                                               strain_[j].release * (e - strain_[j].mean));
                    bond.rest *= 1 + std::clamp(flow, -0.2f, 0.2f);
                    const float most = std::max(f.materials[p.material[i]].def.breakStrain,
                                                f.materials[p.material[j]].def.breakStrain);
                    if (bond.weight < 1 || (most > 0 && e > most) || r2 > kLongest * 0.5f * (x.w + p.position[j].w))
                        bond.weight -= kFading, touched_[slot] = 1;
                    if (!(bond.weight > 0)) continue;
                }
                b[kept++] = bond;
            }
            count_[slot] = static_cast<uint8_t>(kept);
        }
    });
    weld(f);
}

// What has flowed far has new neighbours: they bond as they are, without force.
void Bonds::weld(const BondFrame& f) {
    Particles& p = f.particles;
    for (int r = 0; r < p.moverCount; ++r) {
        const uint32_t i = static_cast<uint32_t>(r), slot = p.bondSlot[i];
        if (!slot) continue;
        if (strain_[i].release > 0)
            forNeighbors(f.neighbors, r, [&](uint32_t j) {
                if (j >= static_cast<uint32_t>(p.count)) return false;
                if (!p.bondSlot[j] || p.body[i] != p.body[j] || p.material[i] != p.material[j]) return true;
                const float near = kWeld * 0.5f * (p.position[i].w + p.position[j].w) / kSupport;
                const Vec3 d = p.position[i].xyz() - p.position[j].xyz();
                const float r2 = dot(d, d);
                if (r2 < near * near && r2 > 0 && !bonded(slot, p.bondSlot[j]))
                    connect(slot, p.bondSlot[j], std::sqrt(r2));
                return true;
            });
    }
    for (uint32_t i = 0; i < static_cast<uint32_t>(p.count); ++i)
        if (const uint32_t slot = p.bondSlot[i]; slot && touched_[slot]) refill(p, f.volume[i], slot);
}

} // namespace thaw
