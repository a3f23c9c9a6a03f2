// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// Where pieces touch walls, what is held, and each other.
#include "base/kernel.h"
#include "motion/rigid.h"
#include "motion/rigid_numbers.h"
#include "motion/walls.h"

#include <algorithm>

namespace thaw {
namespace {

// Of one solid around a particle of another.
struct Side {
    uint16_t piece;
    double filled = 0;
    Double3 slope;
};
constexpr int kSides = 4;

bool overlaps(const Box& a, const Box& b, float margin) {
    return a.lower.x < b.upper.x + margin && b.lower.x < a.upper.x + margin && a.lower.y < b.upper.y + margin &&
           b.lower.y < a.upper.y + margin && a.lower.z < b.upper.z + margin && b.lower.z < a.upper.z + margin;
}
bool inside(const Box& b, Vec3 x, float margin) {
    return x.x > b.lower.x - margin && x.x < b.upper.x + margin && x.y > b.lower.y - margin &&
           x.y < b.upper.y + margin && x.z > b.lower.z - margin && x.z < b.upper.z + margin;
}

bool earlier(const RigidContact& a, const RigidContact& b) {
    if (a.a != b.a) return a.a < b.a;
    return a.other != b.other ? a.other < b.other : a.id < b.id;
}

} // namespace

double Rigid::margin(const RigidPiece& b, const MotionFrame& f) const {
    const double dt = f.dt, g = length(f.gravity);
    return b.reach() * dt + g * dt * dt + kContactMargin * static_cast<double>(f.spacing);
}

const Rigid::Load* Rigid::before(uint32_t a, uint32_t other, uint32_t id) const {
    const Load* end = loadsBefore_.data() + loadsBefore_.size();
    const Load* l =
        std::lower_bound(loadsBefore_.data(), end, Load{a, other, id, 0, {}, {}}, [](const Load& x, const Load& y) {
            if (x.a != y.a) return x.a < y.a;
            return x.other != y.other ? x.other < y.other : x.id < y.id;
        });
    return l != end && l->a == a && l->other == other && l->id == id ? l : nullptr;
}

// Spheres of half a spacing against the signed distance of the colliders. A plane is a plane however far; of anything
// else the nearest point's normal holds nearby only, and what comes from farther stops short of it (followWalls).
void Rigid::findWalls(const MotionFrame& f, uint32_t slot) {
    const RigidPiece& b = pieces_[slot];
    const Particles& p = f.particles;
    const double far = margin(b, f), spacing = f.spacing;
    WallFinder walls;
    float walled = 0; // m, that colliders go
    for (int c = 0; c < f.colliderCount; ++c)
        if (f.colliders[c].alive && f.colliders[c].moves)
            walled = std::max(walled, f.colliders[c].reachOfMotion(narrow(b.center), static_cast<float>(b.radius)));
    const float reach = static_cast<float>(far + spacing) + walled;
    walls.gather(f.colliders, colliderBounds_.data(), f.colliderCount, b.bounds, reach);
    if (walls.empty()) return;
    const uint32_t* rows = rowsOf(b);
    const auto touch = [&](Vec3 x, double edge, uint32_t id) {
        const double radius = 0.5 * edge;
        walls.forNear(x, reach, [&](float distance, Vec3 n, const Collider& c) {
            const double gap = static_cast<double>(distance) - radius;
            const bool plane = c.type == thawCollider_plane;
            const Vec3 way = c.moves ? c.displacement(x) : Vec3{};
            const double near = far + static_cast<double>(length(way));
            if (!(gap < (plane ? near : std::min(near, kCurvedMargin * spacing)))) return;
            RigidContact q;
            q.a = slot, q.other = RigidContact::kWall | static_cast<uint32_t>(&c - f.colliders), q.id = id;
            q.normal = wide(n), q.point = wide(x) - radius * q.normal, q.gap = gap, q.spacing = edge;
            q.friction = c.friction, q.surface = wide(c.velocityAt(x));
            candidates_.push(q);
        });
    };
    for (uint32_t k = 0; k < b.rows; ++k) {
        const size_t i = rows[k];
        const Vec3 x = p.position[i].xyz();
        if (!f.reference || p.level[i] == 0 || !p.fine[i]) {
            touch(x, static_cast<double>(p.position[i].w) / kSupport, p.id[i]);
            continue;
        }
        // A coarse one has its points' corners; told apart by their place in the reference, behind all ids.
        bool near = false;
        walls.forNear(x, reach + p.position[i].w, [&](float, Vec3, const Collider&) { near = true; });
        if (near)
            f.reference->forPoints(p, i, [&](Vec3 at, uint32_t point) { touch(at, spacing, 0x80000000u + point); });
    }
}

// Particles of one solid against the volume fraction of another: its distance from how much of the support it fills,
// its normal from how that changes. Both ways: of one only, a stack fell.
void Rigid::findSolids(const MotionFrame& f) {
    const Particles& p = f.particles;
    const float support = kSupport * f.spacing;
    Box held, awakeBox;
    for (int r = p.moverCount; r < p.count; ++r) {
        const size_t i = static_cast<size_t>(r);
        if (!p.piece[i]) held.grow(p.position[i].xyz());
    }
    // Only what lies near a piece that is awake, and of such a piece only what lies near something else.
    bool alone = true;
    for (uint32_t s = 0; s < pieces_.size(); ++s) {
        if (!awake(s)) continue;
        const RigidPiece& b = pieces_[s];
        awakeBox.grow(b.bounds.lower), awakeBox.grow(b.bounds.upper);
        alone &= !overlaps(b.bounds, held, support);
        for (uint32_t o = 0; o < pieces_.size() && alone; ++o)
            alone &= o == s || !pieces_[o].alive || !overlaps(b.bounds, pieces_[o].bounds, support);
    }
    if (alone) return;
    const float norm = latticeSum();
    for (int r = p.moverCount; r < p.count; ++r) {
        const size_t i = static_cast<size_t>(r);
        const Vec4 xi = p.position[i];
        if (!inside(awakeBox, xi.xyz(), support)) continue;
        const uint16_t own = p.piece[i];
        const bool ownAwake = own && awake(own - 1u);
        Side sides[kSides];
        int n = 0;
        const uint32_t g = static_cast<uint32_t>(r) >> 3, lane = static_cast<uint32_t>(r) & 7;
        const size_t start = f.neighbors.first[g] + lane;
        for (uint32_t k = 0; k < f.neighbors.width[g]; ++k) {
            const size_t e = start + 8 * static_cast<size_t>(k), j = f.neighbors.entries[e] >> 4;
            if (j < static_cast<size_t>(p.moverCount) || j >= static_cast<size_t>(p.count) || p.piece[j] == own)
                continue;
            const uint16_t piece = p.piece[j];
            if (!ownAwake && !(piece && awake(piece - 1u))) continue;
            int s = 0;
            while (s < n && sides[s].piece != piece) ++s;
            if (s == n) {
                if (n == kSides) continue;
                sides[n++] = {piece, 0, {}};
            }
            const Vec3 d = xi.xyz() - p.position[j].xyz();
            const float h = 0.5f * (xi.w + p.position[j].w), q = length(d) / h, u = std::max(0.0f, 1 - q);
            sides[s].filled += static_cast<double>(f.volume[j] * kWendland * u * u * u * u * (1 + 4 * q)) /
                               static_cast<double>(h * h * h * norm);
            sides[s].slope += static_cast<double>(f.neighbors.gradient[e]) * wide(d);
        }
        for (int s = 0; s < n; ++s) {
            const Side& side = sides[s];
            const double steep = length(side.slope);
            if (!(side.filled > kLeastFilled) || !(steep * static_cast<double>(xi.w) > kLeastFilled)) continue;
            const double edge = static_cast<double>(xi.w) / kSupport;
            const double gap = static_cast<double>(wallDistance(static_cast<float>(side.filled)) * xi.w) - 0.5 * edge;
            const Double3 outward = (-1 / steep) * side.slope; // from the side toward this particle
            RigidContact q;
            q.id = p.id[i], q.gap = gap, q.friction = kFriction, q.spacing = edge;
            q.point = wide(xi.xyz()) - (0.5 * edge) * outward;
            // The lower slot comes first, and what is held last.
            const bool first = own && (!side.piece || own < side.piece);
            const uint16_t a = first ? own : side.piece, other = first ? side.piece : own;
            q.a = a - 1u, q.other = other ? other - 1u : RigidContact::kHeld;
            q.normal = first ? outward : -1.0 * outward;
            double far = margin(pieces_[q.a], f);
            if (other) far += pieces_[q.other].reach() * static_cast<double>(f.dt);
            if (gap < far) candidates_.push(q);
        }
    }
}

// Of each face (same two bodies, much the same normal) the deepest point and those farthest out in eight directions, of
// all and of what touches; with all of them 40 sweeps are not enough. What carried something before is preferred: when
// the set flickers, the warm start is lost and stacks slide.
void Rigid::reduceContacts() {
    constexpr double kFace = 0.8; // cosine
    // Metres of gap against metres of reach: of what may touch, and of what does. With the first alone a plate on a
    // sphere stands on its deepest point and on edges that hang in the air: it rocked at 4 rad/s for ever.
    constexpr double kDepthWeight[] = {3, 100};
    constexpr double kKeep = 1; // spacings
    constexpr double kTurn = 0.70710678118654752;
    contacts_.clear();
    std::sort(candidates_.begin(), candidates_.end(), earlier);
    for (RigidContact& c : candidates_) {
        const Load* l = before(c.a, c.other, c.id);
        c.loaded = l && l->push > 0;
    }
    for (size_t begin = 0, end; begin < candidates_.size(); begin = end) {
        end = begin + 1;
        while (end < candidates_.size() && candidates_[end].a == candidates_[begin].a &&
               candidates_[end].other == candidates_[begin].other)
            ++end;
        // `spacing` < 0 marks what has its face already.
        for (size_t lead = begin; lead < end; ++lead) {
            if (candidates_[lead].spacing < 0) continue;
            const Double3 n = candidates_[lead].normal, center = pieces_[candidates_[lead].a].center;
            const Double3 e = std::abs(n.x) < 0.7 ? Double3{1, 0, 0} : Double3{0, 1, 0};
            Double3 t1 = cross(n, e);
            t1 = (1 / length(t1)) * t1;
            const Double3 t2 = cross(n, t1);
            const size_t first = contacts_.size();
            for (size_t k = lead; k < end; ++k) {
                RigidContact& c = candidates_[k];
                if (c.spacing < 0 || dot(c.normal, n) <= kFace) continue;
                contacts_.push(c);
                c.spacing = -c.spacing;
            }
            const size_t count = contacts_.size() - first;
            RigidContact* face = contacts_.data() + first;
            if (count <= kFacePoints) continue;
            size_t deepest = 0;
            const auto depth = [&](size_t k) { return face[k].gap - (face[k].loaded ? 0.1 * face[k].spacing : 0); };
            for (size_t k = 1; k < count; ++k)
                if (depth(k) < depth(deepest)) deepest = k;
            size_t pick[kFacePoints] = {deepest}, picked = 1; // ascending
            // A tenth of a radian off, so that the sides of a cube do not tie.
            double cx = 0.99500416527802577, cy = 0.099833416646828152;
            for (int s = 0; s < 8; ++s) {
                const Double3 way = cx * t1 + cy * t2;
                for (const double depthWeight : kDepthWeight) {
                    size_t best = 0;
                    double most = -INFINITY;
                    for (size_t k = 0; k < count; ++k) {
                        const double score = dot(way, face[k].point - center) -
                                             depthWeight * (face[k].gap - face[deepest].gap) +
                                             (face[k].loaded ? kKeep * face[k].spacing : 0);
                        if (score > most) most = score, best = k;
                    }
                    if (std::find(pick, pick + picked, best) != pick + picked) continue;
                    size_t at = picked++;
                    for (; at > 0 && pick[at - 1] > best; --at) pick[at] = pick[at - 1];
                    pick[at] = best;
                }
                const double x = kTurn * (cx - cy);
                cy = kTurn * (cx + cy), cx = x;
            }
            for (size_t k = 0; k < picked; ++k) face[k] = face[pick[k]];
            contacts_.resizeRaw(first + picked);
        }
    }
}

void Rigid::findContacts(const MotionFrame& f) {
    candidates_.clear();
    for (uint32_t s = 0; s < pieces_.size(); ++s)
        if (awake(s)) findWalls(f, s);
    findSolids(f);
    reduceContacts();
}

} // namespace thaw
