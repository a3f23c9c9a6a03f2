// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// Who belongs to which piece, and what a piece weighs.
#include "base/kernel.h"
#include "base/math.h"
#include "motion/rigid.h"

#include <algorithm>
#include <cstring>

namespace thaw {
namespace {

constexpr size_t kMostPieces = 65535; // Particles::piece

double spacingOf(const Vec4& position) { return static_cast<double>(position.w) / kSupport; }

} // namespace

Rigid::Rigid(Allocator& a)
    : pieces_(a), rows_(a), candidates_(a), contacts_(a), loads_(a), loadsBefore_(a), colliderBounds_(a), shares_(a) {}

bool Rigid::moving() const {
    for (const RigidPiece& b : pieces_)
        if (b.alive && !b.asleep) return true;
    return false;
}

float Rigid::fastest() const {
    double most = 0;
    for (const RigidPiece& b : pieces_)
        if (b.alive && !b.asleep) most = std::max(most, b.reach());
    return static_cast<float>(most);
}

int Rigid::awakeRows() const {
    int n = 0;
    for (const RigidPiece& b : pieces_)
        if (b.alive && !b.asleep) n += static_cast<int>(b.rows);
    return n;
}

bool Rigid::lostRows() const {
    for (const RigidPiece& b : pieces_)
        if (b.alive && b.lostRows) return true;
    return false;
}

void Rigid::wakeAll() {
    for (RigidPiece& b : pieces_) b.asleep = false, b.calm = 0;
}

void Rigid::lost(uint16_t piece) {
    wake(piece);
    pieces_[piece - 1u].lostRows = true;
}

// Mass, centre and inertia of its rows. When rows have left, the velocity is that of the new centre.
void Rigid::measure(RigidPiece& b, const Particles& p) {
    const uint32_t* rows = rowsOf(b);
    double mass = 0;
    Double3 sum;
    Box box;
    for (uint32_t k = 0; k < b.rows; ++k) {
        const size_t i = rows[k];
        const Vec3 x = p.position[i].xyz();
        mass += p.velocity[i].w, sum += static_cast<double>(p.velocity[i].w) * wide(x);
        box.grow(x);
    }
    const Double3 center = (1 / mass) * sum;
    if (b.mass > 0) b.velocity = b.velocityAt(center);
    b.center = center, b.mass = mass, b.bounds = box;
    b.inertia = {};
    double far = 0, edge = 0;
    for (uint32_t k = 0; k < b.rows; ++k) {
        const size_t i = rows[k];
        const Double3 d = wide(p.position[i].xyz()) - center;
        const double spacing = spacingOf(p.position[i]);
        b.inertia.addMass(p.velocity[i].w, d, spacing);
        far = std::max(far, dot(d, d)), edge = std::max(edge, spacing);
    }
    b.radius = std::sqrt(far) + 0.5 * edge;
    b.inverseInertia = inverse(b.inertia);
}

void Rigid::gather(const Particles& p) {
    for (RigidPiece& b : pieces_) b.rows = 0;
    for (int r = 0; r < p.count; ++r)
        if (const uint16_t piece = p.piece[static_cast<size_t>(r)]) ++pieces_[piece - 1u].rows;
    uint32_t total = 0;
    alive_ = 0;
    for (RigidPiece& b : pieces_) {
        b.first = total, total += b.rows;
        b.alive &= b.rows > 0;
        alive_ += b.alive;
        b.rows = 0;
    }
    rows_.resizeRaw(total);
    for (int r = 0; r < p.count; ++r)
        if (const uint16_t piece = p.piece[static_cast<size_t>(r)]) {
            RigidPiece& b = pieces_[piece - 1u];
            rows_[b.first + b.rows++] = static_cast<uint32_t>(r);
        }
    for (RigidPiece& b : pieces_)
        if (b.alive && !b.asleep) measure(b, p);
}

uint16_t Rigid::create(Particles& p, const uint32_t* rows, size_t count, uint16_t parent) {
    size_t slot = 0;
    while (slot < pieces_.size() && pieces_[slot].alive) ++slot;
    if (slot >= kMostPieces) return 0;
    if (slot == pieces_.size()) pieces_.push({});
    RigidPiece b;
    b.alive = true, b.fresh = true, b.id = nextId_++;
    double mass = 0;
    Double3 sum, momentum;
    for (size_t k = 0; k < count; ++k) {
        const size_t i = rows[k];
        const double m = p.velocity[i].w;
        mass += m, sum += m * wide(p.position[i].xyz()), momentum += m * wide(p.velocity[i].xyz());
    }
    b.mass = mass, b.center = (1 / mass) * sum, b.rows = static_cast<uint32_t>(count);
    if (parent) {
        const RigidPiece& from = pieces_[parent - 1u];
        b.velocity = from.velocityAt(b.center), b.spin = from.spin, b.fresh = from.fresh;
    } else {
        b.velocity = (1 / mass) * momentum;
        // The particles turn with the piece: their own inertia is moved by the spin that is sought. In so many rounds
        // it is found, also where a rod has no other.
        Symmetric3 own;
        Double3 angular;
        for (size_t k = 0; k < count; ++k) {
            const size_t i = rows[k];
            const double m = p.velocity[i].w;
            const Double3 d = wide(p.position[i].xyz()) - b.center;
            b.inertia.addMass(m, d, spacingOf(p.position[i])), own.addMass(m, {}, spacingOf(p.position[i]));
            angular += m * cross(d, wide(p.velocity[i].xyz()));
        }
        const Symmetric3 inv = inverse(b.inertia);
        for (int round = 0; round < 60; ++round) b.spin = inv * (angular + own * b.spin);
    }
    for (size_t k = 0; k < count; ++k) {
        const size_t i = rows[k];
        p.piece[i] = static_cast<uint16_t>(slot + 1), p.anchor[i] = 0;
        p.flags[i] |= kRigid;
        p.velocityChange[i] = {};
    }
    pieces_[slot] = b;
    ++alive_;
    return static_cast<uint16_t>(slot + 1);
}

void Rigid::join(Particles& p, uint32_t i, uint16_t piece) {
    RigidPiece& b = pieces_[piece - 1u];
    b.asleep = false, b.calm = 0;
    const double m = p.velocity[i].w, mass = b.mass + m;
    const Double3 x = wide(p.position[i].xyz()), u = wide(p.velocity[i].xyz());
    const Double3 center = (1 / mass) * (b.mass * b.center + m * x);
    const Double3 velocity = (1 / mass) * (b.mass * b.velocity + m * u);
    const Double3 angular =
        b.inertia * b.spin + b.mass * cross(b.center - center, b.velocity) + m * cross(x - center, u);
    b.inertia.addMass(b.mass, b.center - center, 0), b.inertia.addMass(m, x - center, spacingOf(p.position[i]));
    b.inverseInertia = inverse(b.inertia);
    b.spin = b.inverseInertia * angular;
    b.mass = mass, b.center = center, b.velocity = velocity;
    p.piece[i] = piece, p.anchor[i] = 0;
    p.velocity[i].setXyz(narrow(b.velocityAt(x)));
}

void Rigid::setVelocities(const MotionFrame& f) {
    Particles& p = f.particles;
    f.tasks.forBlocks(static_cast<int>(rows_.size()), 1024, [&](int begin, int end, int, int) {
        for (int k = begin; k < end; ++k) {
            const size_t i = rows_[static_cast<size_t>(k)];
            const RigidPiece& b = pieces_[p.piece[i] - 1u];
            p.velocity[i].setXyz(b.asleep ? Vec3{} : narrow(b.velocityAt(wide(p.position[i].xyz()))));
        }
    });
}

void Rigid::state(StateIo& io) {
    io(nextId_, loadStep_);
    io.limits.pieces = pieces_.size();
    size_t read = 0;
    if (io.reads()) io.limits.pieces = kMostPieces; // until they are counted
    io.list(pieces_, kMostPieces, [&](RigidPiece& b) {
        ++read;
        io(b.alive);
        if (!b.alive) {
            if (io.restores()) b = {};
            return;
        }
        io(b.asleep, b.fresh, b.lostRows, b.carried, b.bedded, b.calm, b.id, b.center, b.velocity, b.spin);
        io(b.restLoad, b.load, b.drag, b.dragSpin, b.mass, b.radius, b.inertia, b.inverseInertia, b.bounds);
        io.report(b.solved, b.restless, b.drowsy, b.first, b.rows, b.linear, b.angular, b.pushed);
        io.report(b.startVelocity, b.startSpin);
        if (io.restores() && uint64_t{b.first} + b.rows > io.limits.particles) io.fail("a piece of rows there are not");
    });
    if (io.reads()) io.limits.pieces = read;
    // Whose rows they are is found anew before anybody asks (gather).
    io.list(loads_, 1u << 24, [&](Load& l) {
        io.index(l.a, io.limits.pieces);
        io(l.other, l.id, l.push, l.rub, l.total);
        const size_t who = l.other & ~(RigidContact::kWall | RigidContact::kHeld);
        if (io.restores() && who >= (l.other & RigidContact::kWall   ? io.limits.colliders
                                     : l.other & RigidContact::kHeld ? size_t{1}
                                                                     : io.limits.pieces))
            io.fail("a load on nobody");
    });
    if (!io.restores()) return;
    alive_ = 0;
    for (const RigidPiece& b : pieces_) alive_ += b.alive;
}

} // namespace thaw
