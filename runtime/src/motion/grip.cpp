// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/bond_pass.h"
#include "motion/motion.h"
#include "motion/numbers.h"
#include "motion/rigid_liquid.h"
#include "motion/walls.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace thaw {
namespace {

// Where the centre of an elastic particle stands on a wall, in spacings: its body's surface is there.
constexpr float kStand = 0.5f;
// What was pressed against a wall stays so within this many spacings of it, until it would have to be pulled.
constexpr float kStill = 0.1f;
// What a wall that moves has come into by more than this many spacings it drives out.
constexpr float kSunk = 0.05f;
// Pull that releases, and approach that grips, as shares of what gravity does in a step.
constexpr float kPull = 0.01f;
// What friction may be off before the solve does another round for it.
constexpr float kRubTolerance = 0.05f;
constexpr float kAlike = 0.99f; // cosine, of walls of one normal
constexpr float kEdge = 0.1f;   // sine of the angle between two walls that leave only their edge

} // namespace

void Motion::addSprings(const MotionFrame& f, int begin, int end) {
    pairSprings({PairLists(f.neighbors), f.particles.position.data(), trait_.data(), f.bonds->groupOn.data(),
                 f.bonds->stiffness.data(), f.bonds->rest.data(), f.dt, image_.data(), inverse_.data(), cross_.data(),
                 coefficient_.data()},
                begin, end);
}

// Contact of elastic solids with walls, inside of the solve (clamped after it they blew up, BAKEOFF 4): what would end
// the step in a wall ends it on the wall, for as long as that takes a push. Along the wall it sticks until that takes
// more than the wall's friction gives for the push, and then slides against that much. residual_ is of the velocities
// of now, with what the walls did left out where a particle is gripped. True when some particle's grip changed.
bool Motion::regrip(const MotionFrame& f) {
    Particles& p = f.particles;
    const float scale = kPull * f.dt * kGravity; // m/s
    f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int block, int) {
        BlockSums& sums = sums_[static_cast<size_t>(block)];
        sums = {};
        for (int r = 8 * begin, last = std::min(8 * end, p.moverCount); r < last; ++r) {
            const size_t i = static_cast<size_t>(r), first = i * kContacts;
            const uint32_t slot = p.bondSlot[i];
            if (!slot || !contactCount_[i]) continue;
            const float spacing = p.position[i].w / kSupport;
            uint8_t& pressed = f.bonds->pressed(slot);
            const int before = static_cast<int>(grip_[i].w) & (kSlides - 1); // a bit for each wall
            const bool slid = slides(i);
            const Vec3 v = p.velocity[i].xyz();
            // What the walls give it is what it lacks. One that would have to pull lets go, the others hold on: or what
            // is lifted off the floor by a plate that comes goes through the plate.
            const Vec3 push = before ? -1.0f / trait_[i].z * residual_[i].xyz() : Vec3{};
            Vec3 on;
            int now = 0;
            const auto forWalls = [&](auto&& body) {
                for (size_t c = first, n = c + contactCount_[i]; c < n; ++c) {
                    const Vec3 normal = contact_[c].xyz(), wall = wallsMove_ ? wallVelocity_[c].xyz() : Vec3{};
                    const float gap = contact_[c].w - kStand * spacing, in = -gap - kSunk * spacing;
                    const float need = gap > 0      ? -gap / f.dt
                                       : wallsMove_ ? std::clamp(in, 0.0f, kWallRecovery * spacing) / f.dt
                                                    : 0;
                    if (!body(1 << (c - first), normal, wall, gap, need)) continue;
                    // With the nearest, and out of the others: one that moves on goes through what another holds.
                    if (!now)
                        on = wall + need * normal;
                    else
                        on += std::max(0.0f, need + dot(normal, wall - on)) * normal;
                    now |= 1 << (c - first);
                }
            };
            forWalls([&](int bit, Vec3 normal, Vec3 wall, float gap, float need) {
                if (before & bit)
                    return !(gap > kStill * spacing && !(dot(normal, grip_[i].xyz() - wall) <= need + scale)) &&
                           !(dot(normal, push) < -scale);
                return dot(normal, v - wall) < need - scale || (!before && pressed && gap < kStill * spacing);
            });
            // What one lets go the others may hold in its way.
            if (now)
                forWalls([&](int bit, Vec3 normal, Vec3 wall, float, float need) {
                    return !(now & bit) && dot(normal, on - wall) < need - scale;
                });
            if (!now) {
                pressed = Bonds::kFree;
                if (!before) continue;
                if (slid) inverse_[i] = unslid_[2 * i], cross_[i] = unslid_[2 * i + 1];
                grip_[i] = {};
                sums.a += 1;
                continue;
            }

            // Two walls leave the way along their edge, three leave none.
            int walls = 0;
            Vec3 normals[kContacts];
            float friction[kContacts];
            for (int k = 0; k < kContacts; ++k) {
                if (!(now & 1 << k)) continue;
                const size_t c = first + static_cast<size_t>(k);
                friction[walls] = f.colliders[contactOf_[c]].friction, normals[walls++] = contact_[c].xyz();
            }
            Slide next{normals[0], false, 0};
            if (walls > 1) {
                const Vec3 edge = cross(normals[0], normals[1]);
                const float size = length(edge);
                if (size > kEdge) next.axis = (1 / size) * edge, next.edge = true;
            }
            const auto freeWay = [&](Vec3 u) {
                const Vec3 along = dot(next.axis, u) * next.axis;
                return next.edge ? along : u - along;
            };
            const Body& body = bodies_[bodyOf_[i] - 1];
            // As far as they rub, in this step; it knows only what the solve before made of it.
            float& rubbed = f.bonds->rubbed(slot);
            if (before) {
                rubbed = 0;
                for (int k = 0; k < walls; ++k)
                    rubbed += friction[k] * body.believed(normals[k]) * std::max(0.0f, dot(normals[k], push)) / f.dt;
            } else if (!pressed) {
                rubbed = 0;
            }
            const float most = rubbed * f.dt, mass = trait_[i].z;
            const Vec3 way = freeWay(v - on);
            const float speed = length(way);
            // What comes to a wall slides: it has not been pushed yet. (Sticking at first it hovered for many steps.)
            bool slips = false;
            if (walls < 3) {
                if (before && !slid) {
                    // What lies flat goes as one.
                    const float lacks =
                        body.flat && !body.held ? body.slip() : length(freeWay(push)) - (1 + kRubTolerance) * most;
                    slips = lacks > scale;
                    next.drag = mass * most / std::max(lacks, scale);
                } else {
                    slips = (before || pressed != Bonds::kSticks) && speed > scale;
                    next.drag = mass * most / std::max(speed, scale);
                }
            }
            pressed = slips ? Bonds::kSlips : Bonds::kSticks;
            if (now == before && slips == slid &&
                (!slips || std::abs(next.drag - slide_[i].drag) < kRubTolerance * (next.drag + mass)))
                continue;
            if (slid) inverse_[i] = unslid_[2 * i], cross_[i] = unslid_[2 * i + 1];
            grip_[i] = {on.x, on.y, on.z, static_cast<float>(now + (slips ? kSlides : 0))};
            if (slips) slide_[i] = next, setSlide(i);
            p.velocity[i].setXyz(heldTo(i, v));
            sums.a += 1;
        }
    });
    double changed = 0;
    for (const BlockSums& s : sums_) changed += s.a;
    return changed > 0;
}

// The inverse of the block of a mover that slides, of the plane or the line that is left free, friction included.
void Motion::setSlide(size_t i) {
    const Slide& slide = slide_[i];
    const Vec3 n = slide.axis;
    const Vec4 a = block_[2 * i], b = block_[2 * i + 1];
    const auto times = [&](Vec3 v) {
        return Vec3{a.x * v.x + b.x * v.y + b.y * v.z, b.x * v.x + a.y * v.y + b.z * v.z,
                    b.y * v.x + b.z * v.y + a.z * v.z} +
               slide.drag * v;
    };
    Vec4 &d = inverse_[i], &c = cross_[i];
    unslid_[2 * i] = d, unslid_[2 * i + 1] = c;
    const auto add = [&](float s, Vec3 u, Vec3 v) {
        d.x += s * u.x * v.x, d.y += s * u.y * v.y, d.z += s * u.z * v.z;
        c.x += s * u.x * v.y, c.y += s * u.x * v.z, c.z += s * u.y * v.z;
    };
    d = c = {};
    if (slide.edge) return add(1 / dot(n, times(n)), n, n);
    const Vec3 t = normalizeOr(std::abs(n.x) < 0.7f ? cross(n, {1, 0, 0}) : cross(n, {0, 1, 0}), {}), u = cross(n, t);
    const float tt = dot(t, times(t)), uu = dot(u, times(u)), tu = dot(t, times(u)), s = 1 / (tt * uu - tu * tu);
    add(s * uu, t, t), add(s * tt, u, u), add(-s * tu, t, u), add(-s * tu, u, t);
}

// residual_ with the friction of what slides, without what the walls take.
void Motion::leaveGripped(const MotionFrame& f) {
    f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int, int) {
        for (int r = 8 * begin, last = std::min(8 * end, f.particles.moverCount); r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            if (!gripped(i)) continue;
            residual_[i].setXyz(
                slides(i)
                    ? freeOf(i, residual_[i].xyz() - slide_[i].drag * (f.particles.velocity[i].xyz() - grip_[i].xyz()))
                    : Vec3{});
        }
    });
}

// Before anything is gripped.
void Motion::findBodies(const MotionFrame& f) {
    const Particles& p = f.particles;
    const uint32_t movers = static_cast<uint32_t>(p.moverCount), count = static_cast<uint32_t>(p.count);
    bodies_.clear();
    std::fill(bodyOf_.begin(), bodyOf_.end(), 0u);
    size_t size = 0;
    for (uint32_t seed = 0; seed < movers; ++seed) {
        if (bodyOf_[seed] || !p.bondSlot[seed]) continue;
        const uint32_t number = static_cast<uint32_t>(bodies_.size()) + 1;
        Body b{};
        size_t head = size;
        bodyRow_[size++] = seed, bodyOf_[seed] = number;
        for (; head < size; ++head)
            forNeighbors(f.neighbors, static_cast<int>(bodyRow_[head]), [&](uint32_t j) {
                if (j >= count) return false;
                if (j >= movers) {
                    b.held |= !p.piece[j]; // pieces: see SoftContacts
                } else if (p.bondSlot[j] && !bodyOf_[j]) {
                    bodyRow_[size++] = j, bodyOf_[j] = number;
                }
                return true;
            });
        b.end = size;
        bodies_.push(b);
    }
}

float Motion::Body::believed(Vec3 n) const {
    if (held) return 1;
    const double x = n.x, y = n.y, z = n.z, all = pushed[0] * x + pushed[1] * y + pushed[2] * z;
    return all > 0 ? static_cast<float>(std::clamp((taken[0] * x + taken[1] * y + taken[2] * z) / all, 0.0, 1.0)) : 0;
}

float Motion::Body::slip() const {
    const float share = static_cast<float>(1 / mass);
    const Vec3 got{share * static_cast<float>(taken[0]), share * static_cast<float>(taken[1]),
                   share * static_cast<float>(taken[2])};
    const float most = share * static_cast<float>(rubbed) * believed(normal);
    return length(got - dot(got, normal) * normal) - (1 + kRubTolerance) * most;
}

// residual_ with what the walls did left out.
void Motion::weighBodies(const MotionFrame& f) {
    size_t at = 0;
    for (Body& b : bodies_) {
        const auto add = [](double(&to)[3], Vec3 v) { to[0] += v.x, to[1] += v.y, to[2] += v.z; };
        std::fill(std::begin(b.taken), std::end(b.taken), 0), std::fill(std::begin(b.pushed), std::end(b.pushed), 0);
        b.mass = b.rubbed = 0, b.flat = false, b.normal = {};
        bool grips = false, flat = true;
        for (; at < b.end; ++at) {
            const size_t i = bodyRow_[at];
            const Vec3 v = f.particles.velocity[i].xyz();
            b.mass += static_cast<double>(trait_[i].z);
            add(b.taken, trait_[i].z * (v - before_[i].xyz()));
            if (f.coupling)
                if (const SoftContacts::Contact* c = f.coupling->softOf(i))
                    add(b.taken, c->drag(f.dt, v - f.particles.velocity[c->row].xyz()) - c->push(f.dt));
            for (size_t k = 0; k < kContacts; ++k) {
                if (!(static_cast<int>(grip_[i].w) & 1 << k)) continue;
                const size_t c = i * kContacts + k;
                const Vec3 n = contact_[c].xyz();
                const float push = std::max(0.0f, -dot(n, residual_[i].xyz()));
                add(b.pushed, push * n), b.rubbed += static_cast<double>(f.colliders[contactOf_[c]].friction * push);
                if (!grips) b.normal = n;
                flat &= dot(n, b.normal) > kAlike, grips = true;
            }
        }
        b.flat = grips && flat;
    }
}

// What slides on walls of one normal and hangs on nothing else moves along them as one: its own stiffness keeps that
// out of reach of the iterations. What walls do not hold at all does so wherever it goes, until it meets one. residual_
// as they see it. True when something moved.
bool Motion::moveAsOne(const MotionFrame& f) {
    const float into = 2 * kPull * f.dt * kGravity;
    size_t at = 0;
    bool any = false;
    for (const Body& b : bodies_) {
        const size_t first = at;
        at = b.end;
        if (b.held) continue;
        Vec3 n;
        bool grips = false, free = true;
        double mass = 0, lacks[3] = {};
        for (size_t k = first; k < b.end && free; ++k) {
            const uint32_t i = bodyRow_[k];
            mass += static_cast<double>(trait_[i].z);
            lacks[0] += residual_[i].x, lacks[1] += residual_[i].y, lacks[2] += residual_[i].z;
            if (f.coupling && f.coupling->softOf(i)) free = false;
            if (!gripped(i)) continue;
            if (!grips) n = slide_[i].axis;
            free = free && slides(i) && !slide_[i].edge && dot(slide_[i].axis, n) > kAlike;
            grips = true, mass += static_cast<double>(slide_[i].drag);
        }
        if (!free) continue;
        Vec3 change{static_cast<float>(lacks[0] / mass), static_cast<float>(lacks[1] / mass),
                    static_cast<float>(lacks[2] / mass)};
        float share = grips ? 0.0f : 1.0f; // of it along n
        for (size_t k = first; k < b.end && !grips; ++k) {
            const size_t i = bodyRow_[k];
            for (size_t c = i * kContacts, end = c + contactCount_[i]; c < end; ++c) {
                const Vec3 wall = wallsMove_ ? wallVelocity_[c].xyz() : Vec3{}, normal = contact_[c].xyz();
                const float closing = -dot(normal, change);
                if (!(closing > 0)) continue;
                const float gap = std::max(0.0f, contact_[c].w - kStand * f.particles.position[i].w / kSupport);
                const float room = gap / f.dt + into + dot(normal, f.particles.velocity[i].xyz() - wall);
                if (room < share * closing) share = std::max(0.0f, room / closing), n = normal;
            }
        }
        change -= (1 - share) * dot(n, change) * n;
        for (size_t k = first; k < b.end; ++k) {
            Vec4& v = f.particles.velocity[bodyRow_[k]];
            v.setXyz(v.xyz() + change);
        }
        any = true;
    }
    return any;
}

// What walls gave to what they grip; residual_ as regrip reads it, 0 there afterwards.
void Motion::reportGrip(const MotionFrame& f) {
    f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int, int) {
        for (int r = 8 * begin, last = std::min(8 * end, f.particles.moverCount); r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            if (!(grip_[i].w > 0)) continue;
            // Each what it pushes, the nearest of those that grip the rest.
            Vec3 push = -1.0f / trait_[i].z * residual_[i].xyz();
            size_t nearest = kContacts;
            for (size_t k = kContacts; k-- > 0;) {
                if (!(static_cast<int>(grip_[i].w) & 1 << k)) continue;
                if (nearest < kContacts) {
                    const Vec3 n = contact_[i * kContacts + nearest].xyz(), part = std::max(0.0f, dot(n, push)) * n;
                    kick(i * kContacts + nearest, part), push -= part;
                }
                nearest = k;
            }
            kick(i * kContacts + nearest, push);
            residual_[i] = {};
        }
    });
}

} // namespace thaw
