// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Bonds of particles that split and merge.
#include "base/kernel.h"
#include "motion/bonds.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

constexpr int kRowBlock = 256;
// Strains of new bonds are kept to these: what is torn or crushed is not what a fit tells.
constexpr double kLeastStrain = -0.5, kMostStrain = 1;
// What merges stands within so many spacings of where a coarse one would put it, and moves by less than so much in a
// step against the others: it does not show.
constexpr float kBent = 0.05f, kCalm = 1e-3f;

bool heldForGood(const Particles& p, uint32_t row) { return (p.flags[row] & (kFixed | kAsleep)) == kFixed; }

} // namespace

// The strain that the bonds of a slot have in common.
const SmallStrain& Bonds::strainOf(const Particles& p, uint32_t slot) {
    if (strainStamp_[slot] == stamp_) return strainFit_[slot];
    strainStamp_[slot] = stamp_;
    StrainFit fit;
    const Double3 x = wide(p.position[rowOf_[slot]].xyz());
    for (int k = 0; k < count_[slot]; ++k) {
        const Bond& b = bondsOf(slot)[k];
        const Double3 d = wide(p.position[rowOf_[b.other]].xyz()) - x;
        const double r = length(d);
        if (r > 0 && b.rest > 0) fit.add((1 / r) * d, r / static_cast<double>(b.rest) - 1);
    }
    return strainFit_[slot] = fit.result();
}

// What lies beside what splits or merges gets other bonds there.
void Bonds::watch(const Particles& p, const Material* materials, uint32_t slot) {
    if (watchStamp_[slot] == stamp_) return;
    watchStamp_[slot] = stamp_;
    changed_.push({{rowOf_[slot]}, 1, slot, true, 0, virial(p, materials, rowOf_[slot]), {}});
}

void Bonds::beforeSplits(const Particles& p, const Material* materials, const uint32_t* rows, size_t count) {
    mapRows(p);
    strainFit_.resize(rowOf_.size()), strainStamp_.resize(rowOf_.size()), watchStamp_.resize(rowOf_.size());
    parents_.resizeRaw(count);
    for (size_t place = 0; place < count; ++place) watchStamp_[p.bondSlot[rows[place]]] = stamp_;
    for (size_t place = 0; place < count; ++place) {
        const uint32_t row = rows[place], slot = p.bondSlot[row];
        Parent& out = parents_[place];
        out.strain = strainOf(p, slot), out.velocity = {}, out.virial = virial(p, materials, row);
        const Vec3 x = p.position[row].xyz(), v = p.velocity[row].xyz();
        Symmetric3 span, strained;
        Double3 slope[6];
        for (int k = 0; k < count_[slot]; ++k) {
            const uint32_t other = bondsOf(slot)[k].other, j = rowOf_[other];
            const Double3 d = wide(p.position[j].xyz() - x);
            const double weight = 1 / std::max(dot(d, d), 1e-30);
            const SmallStrain& e = strainOf(p, other);
            watch(p, materials, other);
            out.velocity.addOuter(weight, wide(p.velocity[j].xyz() - v), d);
            addSquare(span, weight, d);
            // What is held has the strain of one side only.
            if (heldForGood(p, j)) continue;
            addSquare(strained, weight, d);
            for (int c = 0; c < 6; ++c) slope[c] += (weight * static_cast<double>(e.e[c] - out.strain.e[c])) * d;
        }
        const Symmetric3 inverse = inverseOfSpan(span, 1e-3), steepness = inverseOfSpan(strained, 1e-3);
        for (int c = 0; c < 6; ++c) {
            const Vec3 g = narrow(steepness * slope[c]);
            out.slope[c][0] = g.x, out.slope[c][1] = g.y, out.slope[c][2] = g.z;
        }
        out.velocity = {inverse * out.velocity.x, inverse * out.velocity.y, inverse * out.velocity.z};
    }
}

// The length that a bond between two slots rests at, at the strain that they have. What is held for good shall not pull
// at its like: of what it bears only the force on what moves counts, and so the strain of that.
float Bonds::relaxed(const Particles& p, uint32_t a, uint32_t b) {
    const Double3 d = wide(p.position[rowOf_[a]].xyz() - p.position[rowOf_[b]].xyz());
    const double r = length(d);
    const Double3 n = (1 / r) * d;
    const double first = heldForGood(p, rowOf_[a]) ? 0 : 1, second = heldForGood(p, rowOf_[b]) ? 0 : 1;
    const double strain =
        (first * strainOf(p, a).along(n) + second * strainOf(p, b).along(n)) / std::max(1.0, first + second);
    return static_cast<float>(r / (1 + std::clamp(strain, kLeastStrain, kMostStrain)));
}

// A bond across two slots at the strain that they have; where the filling, or what has become of it, had one.
// Neighbours of the filling stay such however they are bent.
void Bonds::rebond(const Particles& p, const Reference& reference, uint32_t a, uint32_t b, float weight) {
    const uint32_t i = rowOf_[a], j = rowOf_[b];
    if (!(length(p.position[i].xyz() - p.position[j].xyz()) > 0) || bonded(a, b)) return;
    const float rest0 = relaxed(p, a, b);
    float apart = rest0;
    if (p.fine[i] && p.fine[j] && p.body[i] == p.body[j] && !reference.home.empty())
        apart =
            length(reference.homeCenter(p.fine[i] - 1, p.level[i]) - reference.homeCenter(p.fine[j] - 1, p.level[j]));
    if (!(apart < kReach * 0.5f * (p.position[i].w + p.position[j].w) / kSupport)) return;
    connect(a, b, rest0, p.level[i] | p.level[j] ? kMostMixed : kMost, weight);
    newBonds_.push({a, b});
}

// Bonds and what else a slot has, for what comes in its place; first: of no other yet.
void Bonds::keep(uint32_t slot, bool first) {
    if (first)
        kept_.count = 0, kept_.calm = calm_[slot], kept_.pressed = pressed_[slot], kept_.borne = {}, kept_.rubbed = 0;
    kept_.calm = std::min(kept_.calm, calm_[slot]), kept_.pressed = std::max(kept_.pressed, pressed_[slot]);
    kept_.borne += borne_[slot], kept_.rubbed = std::max(kept_.rubbed, rubbed_[slot]);
    for (int k = 0; k < count_[slot]; ++k) {
        const Bond& b = bondsOf(slot)[k];
        Bond* end = kept_.bonds + kept_.count;
        Bond* same = std::find_if(kept_.bonds, end, [&](const Bond& o) { return o.other == b.other; });
        if (same == end) ++kept_.count, *same = b;
        same->weight = std::max(same->weight, b.weight);
    }
}

void Bonds::restore(uint32_t slot, float share) {
    calm_[slot] = kept_.calm, pressed_[slot] = kept_.pressed, rubbed_[slot] = kept_.rubbed;
    borne_[slot] = share * kept_.borne;
}

void Bonds::split(Particles& p, const Reference& reference, size_t place, const uint32_t* rows, size_t count) {
    const Parent& parent = parents_[place];
    const uint32_t slot = p.bondSlot[rows[0]];
    keep(slot, true);
    drop(slot);
    double sum[3] = {};
    for (size_t c = 0; c < count; ++c)
        for (const size_t i = rows[c]; const int a : {0, 1, 2})
            sum[a] += static_cast<double>(a == 0 ? p.position[i].x : a == 1 ? p.position[i].y : p.position[i].z);
    const double n = static_cast<double>(count);
    const Double3 middle{sum[0] / n, sum[1] / n, sum[2] / n};
    for (size_t c = 0; c < count; ++c) {
        const uint32_t i = rows[c], s = take(p, i);
        restore(s, 1 / static_cast<float>(count));
        const Double3 d = wide(p.position[i].xyz()) - middle;
        const Vec3 off = narrow(d);
        if (!p.fixed(static_cast<int>(i))) p.velocity[i].setXyz(p.velocity[i].xyz() + narrow(parent.velocity.apply(d)));
        SmallStrain e = parent.strain;
        for (int k = 0; k < 6; ++k)
            e.e[k] += dot(Vec3{parent.slope[k][0], parent.slope[k][1], parent.slope[k][2]}, off);
        strainFit_[s] = e, strainStamp_[s] = stamp_;
    }
    Changed changed{{}, static_cast<uint32_t>(count), p.bondSlot[rows[0]], false, 0, parent.virial, {}};
    std::copy(rows, rows + count, changed.rows);
    changed_.push(changed);
    for (size_t c = 0; c < count; ++c)
        for (size_t d = 0; d < c; ++d) rebond(p, reference, p.bondSlot[rows[d]], p.bondSlot[rows[c]], 1);
    for (int k = 0; k < kept_.count; ++k)
        for (size_t c = 0; c < count; ++c)
            rebond(p, reference, p.bondSlot[rows[c]], kept_.bonds[k].other, kept_.bonds[k].weight);
}

// By what is bonded to a row: F, from the places in the filling to those of now, and its rotation.
bool Bonds::deformation(const Particles& p, const Reference& reference, uint32_t row, Tensor3& f,
                        Tensor3& rotation) const {
    const uint32_t slot = p.bondSlot[row];
    const Vec3 x = p.position[row].xyz(), home = reference.homeCenter(p.fine[row] - 1, p.level[row]);
    Tensor3 a;
    Symmetric3 span;
    for (int k = 0; k < count_[slot]; ++k) {
        const uint32_t j = rowOf_[bondsOf(slot)[k].other];
        if (!p.fine[j] || p.body[j] != p.body[row]) continue;
        const Double3 was = wide(reference.homeCenter(p.fine[j] - 1, p.level[j]) - home);
        const double weight = 1 / std::max(dot(was, was), 1e-30);
        a.addOuter(weight, wide(p.position[j].xyz() - x), was);
        addSquare(span, weight, was);
    }
    if (!nearestRotation(a, rotation)) return false;
    // F = R + (A - R B) B^-1: where nothing spans a direction, it turns along.
    const Symmetric3 inverse = inverseOfSpan(span, 1e-3);
    const auto row3 = [&](Double3 r, Double3 of) { return r + inverse * (of - span * r); };
    f = {row3(rotation.x, a.x), row3(rotation.y, a.y), row3(rotation.z, a.z)};
    return true;
}

void Bonds::deform(const BondFrame& f, Reference& reference) {
    if (live_ == 0 || reference.home.empty()) return;
    const Particles& p = f.particles;
    mapRows(p);
    f.tasks.forBlocks(p.count, kRowBlock, [&](int begin, int end, int, int) {
        for (int r = begin; r < end; ++r) {
            const uint32_t i = static_cast<uint32_t>(r), slot = p.bondSlot[i];
            if (!slot || !p.fine[i] || p.fixed(r)) continue;
            bool coarse = p.level[i] > 0;
            for (int k = 0; k < count_[slot] && !coarse; ++k) coarse = p.level[rowOf_[bondsOf(slot)[k].other]] > 0;
            Tensor3 deformation3, rotation;
            if (!coarse || !deformation(p, reference, i, deformation3, rotation)) continue;
            const uint32_t first = p.fine[i] - 1, last = first + (1u << p.level[i]);
            const Vec3 home = reference.homeCenter(first, p.level[i]);
            for (uint32_t k = first; k < last; ++k) {
                reference.point[k].setXyz(home + narrow(deformation3.apply(wide(reference.home[k].xyz() - home))));
                reference.slope[k].setXyz(narrow(rotation.apply(wide(reference.homeSlope[k].xyz()))));
            }
        }
    });
}

bool Bonds::mayUnite(const Particles& p, const Reference& reference, const uint32_t* rows, size_t count,
                     float dt) const {
    if (reference.home.empty()) return false;
    Vec3 x, v, home;
    const float share = 1 / static_cast<float>(count);
    for (size_t c = 0; c < count; ++c) {
        const uint32_t slot = p.bondSlot[rows[c]];
        for (int k = 0; k < count_[slot]; ++k)
            if (bondsOf(slot)[k].weight < 1) return false;
        x += share * p.position[rows[c]].xyz(), v += share * p.velocity[rows[c]].xyz();
        home += share * reference.home[p.fine[rows[c]] - 1].xyz();
    }
    Tensor3 a;
    Symmetric3 span;
    for (size_t c = 0; c < count; ++c) {
        const Double3 was = wide(reference.home[p.fine[rows[c]] - 1].xyz() - home);
        a.addOuter(1, wide(p.position[rows[c]].xyz() - x), was), addSquare(span, 1, was);
    }
    const Symmetric3 inverse = inverseOfSpan(span, 1e-6);
    const Tensor3 gradient{inverse * a.x, inverse * a.y, inverse * a.z};
    const float spacing = p.position[rows[0]].w / kSupport;
    for (size_t c = 0; c < count; ++c) {
        const Vec3 to = narrow(gradient.apply(wide(reference.home[p.fine[rows[c]] - 1].xyz() - home)));
        if (length(p.position[rows[c]].xyz() - x - to) > kBent * spacing ||
            length(p.velocity[rows[c]].xyz() - v) * dt > kCalm * spacing)
            return false;
    }
    return true;
}

void Bonds::beforeMergers(const Particles& p, const Material* materials, const uint32_t* rows, size_t count,
                          size_t size) {
    mapRows(p);
    strainFit_.resize(rowOf_.size()), strainStamp_.resize(rowOf_.size()), watchStamp_.resize(rowOf_.size());
    for (size_t k = 0; k < count * size; ++k) watchStamp_[p.bondSlot[rows[k]]] = stamp_;
    parents_.resizeRaw(count);
    for (size_t place = 0; place < count; ++place) {
        Parent& out = parents_[place];
        out.strain = {}, out.virial = {};
        for (size_t c = 0; c < size; ++c) {
            const uint32_t row = rows[place * size + c], slot = p.bondSlot[row];
            out.virial.add(1, virial(p, materials, row));
            // Of one that stands for all: the mean of theirs, each by all of its bonds.
            const SmallStrain& e = strainOf(p, slot);
            for (int k = 0; k < 6; ++k) out.strain.e[k] += e.e[k] / static_cast<float>(size);
            for (int k = 0; k < count_[slot]; ++k) {
                strainOf(p, bondsOf(slot)[k].other);
                watch(p, materials, bondsOf(slot)[k].other);
            }
        }
    }
}

void Bonds::unite(Particles& p, const Reference& reference, size_t place, const uint32_t* rows, size_t size) {
    for (size_t c = 0; c < size; ++c) keep(p.bondSlot[rows[c]], c == 0);
    for (size_t c = 0; c < size; ++c) drop(p.bondSlot[rows[c]]);
    int kept = 0;
    for (int k = 0; k < kept_.count; ++k)
        if (calm_[kept_.bonds[k].other] != 0) kept_.bonds[kept++] = kept_.bonds[k]; // the others were their own
    kept_.count = kept;
    for (size_t c = 0; c < size; ++c) p.bondSlot[rows[c]] = 0;
    const uint32_t slot = take(p, rows[0]);
    restore(slot, 1);
    strainFit_[slot] = parents_[place].strain, strainStamp_[slot] = stamp_;
    changed_.push({{rows[0]}, 1, slot, false, 0, parents_[place].virial, {}});
    for (int k = 0; k < kept_.count; ++k) rebond(p, reference, slot, kept_.bonds[k].other, kept_.bonds[k].weight);
}

// The springs of a lattice at a strain bear another stress than those of a lattice of half its spacing, at the surface
// by a fifth. Strains, and with them the lengths at rest, that leave each row's parts what it bore: a few rounds, each
// as if a row's bonds were its own. A block of 4 x 8 x 4 sheared by 10 % changes its mean stress in a split by 12.6 %
// without, by 4.5, 1.8, 0.8, 0.4 after 1 to 4, and brick by brick by 27, 11, 5, 2.5, 1.4.
void Bonds::settleBonds(const Particles& p, const Material* materials) {
    constexpr int kRounds = 4;
    for (uint32_t s = 1; s < rowOf_.size(); ++s) {
        if (calm_[s] == 0 || !touched_[s]) continue;
        const uint32_t row = rowOf_[s];
        refill(p, p.velocity[row].w / materials[p.material[row]].def.density, s);
        fill_[s] = fillGoal_[s];
    }
    const auto setRest = [&](uint32_t own, uint32_t other, float length) {
        for (int k = 0; k < count_[own]; ++k)
            if (bondsOf(own)[k].other == other) bondsOf(own)[k].rest = length;
    };
    // Whose slots are whose: those of what changed, and of what lies beside it.
    ownerOf_.assign(rowOf_.size(), 0);
    for (uint32_t k = 0; k < changed_.size(); ++k) {
        const Changed& c = changed_[k];
        if (heldForGood(p, c.rows[0]) || p.bondSlot[c.rows[0]] != c.slot) continue;
        for (uint32_t part = 0; part < c.count; ++part) ownerOf_[p.bondSlot[c.rows[part]]] = k + 1;
    }
    const auto owner = [&](uint32_t slot) { return ownerOf_[slot] ? &changed_[ownerOf_[slot] - 1] : nullptr; };
    // Calls f(changed, beside it) for new bonds across.
    const auto forAcross = [&](auto&& f) {
        for (const NewBond& b : newBonds_) {
            Changed *x = owner(b.a), *y = owner(b.b);
            if (x && y && x->beside != y->beside && bonded(b.a, b.b)) x->beside ? f(*y, *x) : f(*x, *y);
        }
    };
    forAcross([](Changed&, Changed& beside) { beside.across += 1; });
    for (int round = 0; round < kRounds; ++round) {
        for (Changed& c : changed_) {
            c.lacks = {};
            if (owner(p.bondSlot[c.rows[0]]) != &c) continue;
            c.lacks = c.virial;
            for (uint32_t k = 0; k < c.count; ++k) c.lacks.add(-1, virial(p, materials, c.rows[k]));
        }
        // What lies beside has few new bonds; what it lacks it gets from those on the other side of them.
        forAcross([](Changed& c, Changed& beside) { c.lacks.add(1 / beside.across, beside.lacks); });
        for (const Changed& c : changed_) {
            if (c.beside || owner(p.bondSlot[c.rows[0]]) != &c) continue;
            float modulus = 0; // times volume, J
            for (uint32_t k = 0; k < c.count; ++k) {
                const uint32_t i = c.rows[k];
                const Elastic e = elastic(materials, p, i);
                modulus += p.velocity[i].w / materials[p.material[i]].def.density * e.modulus * e.share * e.share;
            }
            if (!(modulus > 0)) continue;
            // Inverse of Hooke's law at Poisson's ratio 1/4, of half the virial: (1 + nu) / E and nu / E.
            const Virial& l = c.lacks;
            const float by = 0.5f / modulus, trace = 0.25f * (l.xx + l.yy + l.zz);
            const float more[6] = {by * (1.25f * l.xx - trace), by * (1.25f * l.yy - trace),
                                   by * (1.25f * l.zz - trace), by * 1.25f * l.xy,
                                   by * 1.25f * l.yz,           by * 1.25f * l.zx};
            for (uint32_t k = 0; k < c.count; ++k)
                for (int e = 0; e < 6; ++e) strainFit_[p.bondSlot[c.rows[k]]].e[e] += more[e];
        }
        for (const NewBond& b : newBonds_) {
            if (!bonded(b.a, b.b)) continue; // its other end has split in turn
            const float at = relaxed(p, b.a, b.b);
            setRest(b.a, b.b, at), setRest(b.b, b.a, at);
        }
    }
    changed_.clear(), newBonds_.clear();
    ++stamp_;
}

} // namespace thaw
