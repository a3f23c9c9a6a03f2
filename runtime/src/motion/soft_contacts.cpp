// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/soft_contacts.h"

#include "base/kernel.h"
#include "base/math.h"
#include "motion/bonds.h"
#include "motion/rigid_numbers.h"
#include "motion/walls.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace thaw {
namespace {

// Shear over Young's modulus at Poisson's ratio 1/4.
constexpr float kShear = 0.4f;
// What friction may be off before the solve does another round for it.
constexpr float kRubTolerance = 0.05f;

struct Side {
    uint16_t piece;
    uint32_t row;
    float filled, nearest;
    Vec3 slope;
};

} // namespace

SoftContacts::SoftContacts(Allocator& a) : contacts_(a), of_(a), kept_(a) {}

Vec3 SoftContacts::Contact::drag(float dt, Vec3 v) const {
    if (state == kOpen) return {};
    const float into = dot(normal, v);
    Vec3 sum = (across * into) * normal;
    if (state == kSticks) sum += along * (v - into * normal);
    return (dt * dt) * sum;
}

Vec3 SoftContacts::Contact::push(float dt) const {
    if (state == kOpen) return {};
    const float size = length(slid);
    const Vec3 rubs = state == kSticks ? along * slid : size > 0 ? (rub / size) * slid : Vec3{};
    return dt * ((-across * gap) * normal - rubs);
}

const SoftContacts::Kept* SoftContacts::before(uint32_t id, uint32_t piece) const {
    const Kept* end = kept_.data() + kept_.size();
    const Kept* k = std::lower_bound(kept_.data(), end, id, [](const Kept& x, uint32_t i) { return x.id < i; });
    return k != end && k->id == id && k->piece == piece ? k : nullptr;
}

// Against the piece that fills most of its support.
void SoftContacts::add(const MotionFrame& f, uint32_t mover) {
    constexpr int kSides = 4;
    const Particles& p = f.particles;
    const Vec4 x = p.position[mover];
    const uint32_t g = mover >> 3, movers = static_cast<uint32_t>(p.moverCount), count = static_cast<uint32_t>(p.count);
    const size_t start = f.neighbors.first[g] + (mover & 7);
    const float norm = latticeSum();
    Side sides[kSides];
    int n = 0;
    for (uint32_t k = f.neighbors.width[g]; k-- > 0;) {
        const size_t entry = start + 8 * static_cast<size_t>(k);
        const uint32_t j = f.neighbors.entries[entry] >> 4;
        if (j < movers) break; // ascending
        if (j >= count || !p.piece[j]) continue;
        int s = 0;
        while (s < n && sides[s].piece != p.piece[j]) ++s;
        if (s == n) {
            if (n == kSides) continue;
            sides[n++] = {p.piece[j], j, 0, INFINITY, {}};
        }
        const Vec3 d = x.xyz() - p.position[j].xyz();
        const float h = 0.5f * (x.w + p.position[j].w), r = length(d), u = std::max(0.0f, 1 - r / h);
        Side& side = sides[s];
        side.filled += f.volume[j] * kWendland * u * u * u * u * (1 + 4 * r / h) / (h * h * h * norm);
        side.slope += f.neighbors.gradient[entry] * d;
        if (r < side.nearest) side.nearest = r, side.row = j;
    }
    int most = 0;
    for (int s = 1; s < n; ++s)
        if (sides[s].filled > sides[most].filled) most = s;
    if (n == 0 || !(sides[most].filled > static_cast<float>(kLeastFilled))) return;
    const Side& side = sides[most];
    const float steep = length(side.slope);
    if (!(steep * x.w > static_cast<float>(kLeastFilled))) return;
    Contact c{};
    c.mover = mover, c.row = side.row, c.slot = side.piece - 1u;
    c.normal = (-1 / steep) * side.slope;
    c.gap = wallDistance(side.filled) * x.w - 0.5f * x.w / kSupport;
    c.across = f.bonds->stiffnessOfLayer(f.bondFrame(), mover), c.along = kShear * c.across;
    if (!(c.across > 0)) return;
    if (const Kept* k = before(p.id[mover], f.rigid->pieces()[c.slot].id)) {
        c.state = k->state, c.rub = k->rub;
        c.slid = k->slid - dot(k->slid, c.normal) * c.normal; // it turns along
    }
    contacts_.push(c);
    of_[mover] = static_cast<uint32_t>(contacts_.size());
}

bool SoftContacts::decide(const MotionFrame& f, const Vec4* movers, const Vec4* rows) {
    bool changed = false;
    for (Contact& c : contacts_) {
        const Vec3 v = movers[c.mover].xyz() - rows[c.row].xyz();
        const float into = dot(c.normal, v), push = -c.across * (c.gap + f.dt * into);
        if (!(push > 0)) {
            changed |= c.state != Contact::kOpen;
            c.state = Contact::kOpen, c.slid = {}, c.rub = 0;
            continue;
        }
        const float most = kFriction * push;
        if (c.state == Contact::kOpen) {
            c.state = Contact::kSticks, c.slid = {}, c.rub = 0, changed = true;
        } else if (c.state == Contact::kSticks) {
            const Vec3 to = c.slid + f.dt * (v - into * c.normal);
            const float force = c.along * length(to);
            if (!(force > (1 + kRubTolerance) * most)) continue;
            c.state = Contact::kSlips, c.rub = most, c.slid = (most / force) * to, changed = true;
        } else {
            if (dot(v, c.slid) < 0) // it sticks where it has come to
                c.state = Contact::kSticks, changed = true;
            else if (std::abs(c.rub - most) > kRubTolerance * most)
                c.rub = most, changed = true;
        }
    }
    return changed;
}

void SoftContacts::keep(const MotionFrame& f, const Vec4* velocity) {
    const Particles& p = f.particles;
    kept_.clear();
    for (const Contact& c : contacts_) {
        if (c.state == Contact::kOpen) continue;
        const Vec3 v = velocity[c.mover].xyz() - velocity[c.row].xyz();
        const float into = dot(c.normal, v), push = std::max(0.0f, -c.across * (c.gap + f.dt * into));
        const Vec3 along = f.dt * (v - into * c.normal);
        f.bonds->bear(p.bondSlot[c.mover], (1 / f.dt) * (c.push(f.dt) - c.drag(f.dt, v)));
        Vec3 slid = c.slid + along;
        const float most = kFriction * push / c.along, size = length(slid);
        if (size > most) slid = (most / size) * slid;
        kept_.push({p.id[c.mover], f.rigid->pieces()[c.slot].id, c.state, slid, c.rub});
    }
    std::sort(kept_.begin(), kept_.end(), [](const Kept& a, const Kept& b) { return a.id < b.id; });
}

void SoftContacts::state(StateIo& io) {
    io.list(kept_, io.limits.particles * 4, [&](Kept& k) {
        io(k.id, k.piece);
        io.index(k.state, Contact::kSlips + 1);
        io(k.slid, k.rub);
    });
}

} // namespace thaw
