// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "control/shapes.h"

#include "base/kernel.h"
#include "base/math.h"
#include "control/paths.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace thaw {
namespace {

constexpr int kRowBlock = 256;
constexpr uint32_t kTurns = 4;     // what obeys nothing is looked at every so many steps
constexpr float kLost = 1.25f;     // reaches: farther off it obeys no more
constexpr float kRim = 0.5f;       // spacings from the rim to the outermost centres
constexpr float kStray = 0.5f;     // spacings from the rim from which it counts as outside
constexpr float kReturn = 0.04f;   // s to come back to the rim
constexpr float kAround = 6;       // spacings from the rim, farther off the flow leads
constexpr float kLed = 0.1f;       // of the speed: if it does by so much
constexpr float kEdge = 2;         // spacings from its place at the rim, from which what is bare is drawn there
constexpr float kBareRim = 0.65f;  // spacings: there
constexpr float kBare = 0.3f;      // cosine of its normal to the way there
constexpr float kLoose = 60;       // 1/s, drag inside
constexpr float kBelow = 1;        // K below solidus that the cooling goes
constexpr float kComing = 1;       // s over which what comes is averaged
constexpr double kHardly = 0.01;   // of what is there
constexpr size_t kBlockTurns = 16; // steps in which all cells are looked at for colliders

// m that a place is off the surface of a flat region, beyond what the contours themselves are.
float off(const Region& region, Vec3 regional) {
    const Box& b = region.bounds();
    return region.flat() ? std::max(0.0f, std::max(regional.z - b.upper.z, b.lower.z - regional.z)) : 0;
}

bool solid(const Particles& p, size_t i) { return (p.flags[i] & kFixed) || p.bondSlot[i]; }

} // namespace

bool Shapes::any() const {
    for (const Shape& s : shapes)
        if (s.on()) return true;
    return false;
}

bool Shapes::cools() const {
    return std::any_of(shapes.begin(), shapes.end(), [](const Shape& s) { return s.on() && s.setting; });
}

void Shapes::forget(Particles& p, size_t slot) {
    for (int i = 0; i < p.count; ++i) {
        const size_t k = static_cast<size_t>(i);
        if (shapeOf(p.follows[k]) != slot + 1) continue;
        p.follows[k] = 0, p.along[k] = 0;
    }
}

// The one that a row obeys goes on as long as it is not lost; else, of those of the highest priority within their
// reach, the nearest. Inside, a shape goes before a path of its own priority; around, after it.
Shapes::Near Shapes::look(const ControlFrame& f, const std::vector<Path>& paths, size_t i) const {
    const Particles& p = f.particles;
    const Vec3 x = p.position[i].xyz();
    Vec3 outward;
    const uint16_t own = shapeOf(p.follows[i]);
    if (own) {
        const Shape& s = shapes[own - 1u];
        if (!s.on()) return {{}, 0, own};
        const Vec3 at = s.region().into(OwnSpace(s.collider, f.colliders).into(x));
        const float d = s.region().distance(at, outward);
        if (d < kLost * s.reach && off(s.region(), at) < kLost * s.depth &&
            (solid(p, i) || !((s.flow.full() || s.closed()) && d > f.spacing)))
            return {outward, d, own};
    }
    if (solid(p, i)) return {};
    if (!own && p.id[i] % kTurns != f.step % kTurns) return {};
    const uint16_t path = pathOf(p.follows[i]);
    const int pathPriority = path ? paths[path - 1u].priority : 0;
    Near best{{}, INFINITY, 0};
    int priority = 0;
    for (size_t k = 0; k < shapes.size(); ++k) {
        const Shape& s = shapes[k];
        if (!s.on() || !s.flow.open() || s.closed() || k + 1 == own || (best.shape && s.priority < priority) ||
            (path && s.priority < pathPriority))
            continue;
        const Vec3 at = s.region().into(OwnSpace(s.collider, f.colliders).into(x));
        if (off(s.region(), at) > s.depth) continue;
        const float d = s.region().distance(at, outward);
        if (d > s.reach || (path && s.priority == pathPriority && d > 0)) continue;
        if (best.shape && s.priority == priority && d >= best.distance) continue;
        best = {outward, d, static_cast<uint16_t>(k + 1)}, priority = s.priority;
    }
    return best;
}

void Shapes::track(const ControlFrame& f, std::vector<Path>& paths) {
    Particles& p = f.particles;
    near_.resizeRaw(static_cast<size_t>(p.count));
    f.tasks.forBlocks(p.count, kRowBlock, [&](int begin, int end, int, int) {
        for (size_t i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) near_[i] = look(f, paths, i);
    });
    fresh_ = true;
    for (Shape& s : shapes) {
        if (s.alive && s.enabled) s.time += static_cast<double>(f.dt);
        s.mass = s.inside = s.spilled = s.astray = s.set = s.distance = 0, s.taken = 0;
    }
    for (size_t i = 0; i < static_cast<size_t>(p.count); ++i) {
        const uint16_t before = shapeOf(p.follows[i]);
        uint16_t& now = near_[i].shape;
        p.flags[i] = static_cast<uint8_t>(p.flags[i] & ~kMoulded);
        if (!before && !now) continue;
        const double m = p.velocity[i].w;
        if (now && before != now) {
            // No more than there is room for.
            Shape& s = shapes[now - 1u];
            const float volume = p.velocity[i].w / f.materials[p.material[i]].def.density;
            if (s.taken + volume > s.flow.room())
                now = 0;
            else
                s.taken += volume;
        }
        if (before != now) {
            if (before) {
                shapes[before - 1u].lost += m;
            } else if (const uint16_t path = pathOf(p.follows[i])) {
                Path& from = paths[path - 1u];
                from.arrive(m);
            }
            p.follows[i] = now ? static_cast<uint16_t>(now | kShapeBit) : uint16_t{0};
            if (now) shapes[now - 1u].captured += m, shapes[now - 1u].fresh += m;
            p.along[i] = 0;
        }
        if (!now) continue;
        Shape& s = shapes[now - 1u];
        if (!s.on()) continue;
        if (s.since < 0) s.since = s.time;
        const float d = near_[i].distance;
        s.mass += m;
        if (solid(p, i)) s.set += m;
        const bool inside = d <= kStray * p.position[i].w / kSupport;
        if (!inside)
            s.spilled += m, s.distance += m * static_cast<double>(d), s.astray += solid(p, i) ? 0 : m;
        else
            s.inside += m;
        if (s.setting && inside && !s.region().flat()) p.flags[i] |= kMoulded;
    }
    for (size_t k = 0; k < shapes.size(); ++k)
        if (shapes[k].on()) fill(f, k);
}

// A cell that melt cannot be in; of a flat region, on neither side of it.
void Shapes::findWalls(const ControlFrame& f, size_t slot, size_t first, size_t stride) {
    Shape& s = shapes[slot];
    const OwnSpace space(s.collider, f.colliders);
    const float aside = s.region().flat() ? 1.5f * f.spacing : 0;
    Box around;
    for (int corner = 0; corner < 8; ++corner) {
        const Box b = s.flow.bounds();
        around.grow(space.out(s.region().outOf({corner & 1 ? b.upper.x : b.lower.x, corner & 2 ? b.upper.y : b.lower.y,
                                                corner & 4 ? b.upper.z : b.lower.z})));
    }
    around.lower -= Vec3{aside, aside, aside}, around.upper += Vec3{aside, aside, aside};
    walls_.clear();
    for (int c = 0; c < f.colliderCount; ++c)
        if (f.colliders[c].alive && f.colliders[c].bounds().overlaps(around)) walls_.push(&f.colliders[c]);
    const auto walled = [&](Vec3 regional) {
        const Vec3 x = space.out(s.region().outOf(regional));
        Vec3 normal;
        return std::any_of(walls_.begin(), walls_.end(), [&](const Collider* c) { return c->distance(x, normal) < 0; });
    };
    for (size_t k = first; k < s.flow.cells(); k += stride) {
        const Vec3 m = s.flow.middleOf(k), out{0, 0, aside};
        s.flow.block(k, walled(m + out) && (aside == 0 || walled(m - out)));
    }
}

void Shapes::refill(const ControlFrame& f, size_t slot) {
    const Particles& p = f.particles;
    Shape& s = shapes[slot];
    const OwnSpace space(s.collider, f.colliders);
    s.flow.clear();
    Box around = s.region().bounds();
    const float margin = s.reach + s.depth;
    around.lower -= Vec3{margin, margin, margin}, around.upper += Vec3{margin, margin, margin};
    // What a drawing lies on takes none of its room.
    if (s.region().flat()) around.lower.z = s.region().bounds().upper.z, around.upper.z = around.lower.z + s.depth;
    for (size_t i = 0; i < static_cast<size_t>(p.count); ++i) {
        const bool fixed = solid(p, i), obeys = shapeOf(p.follows[i]) == slot + 1;
        if (!fixed && !obeys) continue;
        const Vec3 at = s.region().into(space.into(p.position[i].xyz()));
        const float volume = p.velocity[i].w / f.materials[p.material[i]].def.density;
        if (!fixed)
            s.flow.addLiquid(at, volume);
        else if (obeys)
            s.flow.addSet(at, volume);
        else if (at.x > around.lower.x && at.x < around.upper.x && at.y > around.lower.y && at.y < around.upper.y &&
                 at.z > around.lower.z && at.z < around.upper.z)
            s.flow.addSolid(at, volume);
    }
    const Vec3 down = space.turnInto(normalizeOr(f.gravity, {}));
    s.flow.solve(down, s.thickness, f.spacing);
}

void Shapes::fill(const ControlFrame& f, size_t slot) {
    Shape& s = shapes[slot];
    s.distance = s.spilled > 0 ? s.distance / s.spilled : 0;
    if (s.setting && s.set == s.mass && s.asleep == s.mass) return;
    s.asleep = s.set == s.mass ? s.mass : -1;
    if (s.walls != f.wallVersion) s.walls = f.wallVersion, s.wallsLeft = kBlockTurns;
    if (s.wallsLeft > 0) --s.wallsLeft, findWalls(f, slot, f.step % kBlockTurns, kBlockTurns);
    refill(f, slot);
    // Without a thickness it takes all that comes, and is full when hardly any more does.
    s.coming += (1 - static_cast<double>(detExp(-f.dt / kComing))) * (s.fresh / static_cast<double>(f.dt) - s.coming);
    s.fresh = 0;
    const bool still =
        s.thickness > 0 || !s.region().flat() || s.coming * static_cast<double>(kComing) < kHardly * s.mass;
    const double strays = (1 - static_cast<double>(s.setFill)) * s.mass;
    if (s.since >= 0 && still && !s.flow.leak() && s.flow.fill() >= s.setFill && s.astray <= strays) {
        if (s.filledAfter < 0) s.filledAfter = s.time - s.since;
        s.setting |= s.sets;
    }
}

double Shapes::cool(const ControlFrame& f) {
    if (!cools()) return 0;
    Particles& p = f.particles;
    double taken = 0;
    for (size_t i = 0; i < static_cast<size_t>(p.count); ++i) {
        const uint16_t slot = near_[i].shape;
        if (!slot) continue;
        const Shape& s = shapes[slot - 1u];
        if (!s.on()) continue;
        // Whatever heats it meanwhile: from what it had after the last step.
        const double H = p.enthalpy[i], before = p.along[i] != 0 ? std::min(H, static_cast<double>(p.along[i])) : H;
        p.along[i] = 0;
        if (!s.setting || near_[i].distance > kStray * p.position[i].w / kSupport) continue;
        const Material& m = f.materials[p.material[i]];
        const double goal = std::max(-static_cast<double>(m.def.specificHeatSolid * kBelow), m.enthalpyFloor());
        if (H <= goal) continue;
        const double rate =
            m.latent + std::max(0.0, before - m.latent) + static_cast<double>(m.def.specificHeatSolid * kBelow);
        const double now = std::max(goal, before - rate * static_cast<double>(f.dt / std::max(s.setTime, f.dt)));
        p.along[i] = static_cast<float>(now);
        p.enthalpy[i] = now;
        if (now < m.latent) p.flags[i] = static_cast<uint8_t>(p.flags[i] & ~kUnseeded);
        p.temperature[i] = m.temperature(now), p.liquidFraction[i] = m.liquidFraction(now);
        taken += static_cast<double>(p.velocity[i].w) * (H - now);
    }
    return taken;
}

bool Shapes::hold() const {
    return std::any_of(shapes.begin(), shapes.end(), [](const Shape& s) { return s.holds(); });
}

bool Shapes::move(const ControlFrame& f) const {
    return std::any_of(shapes.begin(), shapes.end(),
                       [&](const Shape& s) { return s.holds() && s.collider && f.colliders[s.collider - 1].moves; });
}

void Shapes::aim(const ControlFrame& f, size_t i, const Guide& guide) const {
    const Particles& p = f.particles;
    const Shape& s = shapes[shapeOf(p.follows[i]) - 1u];
    if (!s.on()) return;
    const OwnSpace space(s.collider, f.colliders);
    const Vec3 x = p.position[i].xyz(), moving = space.velocityAt(x);
    const Vec3 at = s.region().into(space.into(x));
    Vec3 outward = fresh_ ? near_[i].outward : Vec3{};
    const float d = fresh_ ? near_[i].distance : s.region().distance(at, outward);
    const float spacing = p.position[i].w / kSupport;
    Vec3 v = s.flow.velocity(at);
    float speed = length(v);
    // From an island that has too much to others.
    const bool between = d > 0 && s.flow.leak(), leaks = s.flow.leaks(at) && (between || dot(v, outward) > 0);
    if (d > kAround * spacing || between)
        v = speed > (between ? 0 : kLed * s.speed) ? (s.speed / speed) * v : -s.speed * outward;
    else if (speed > s.speed)
        v = (s.speed / speed) * v;
    if (s.holds() && !leaks && d < kStray * spacing && -d < p.position[i].w) {
        const Vec3 inward = -space.turn(s.region().direction(outward));
        guide.rim[i] = {inward.x, inward.y, inward.z, -d};
        if (guide.rimVelocity) guide.rimVelocity[i] = {moving.x, moving.y, moving.z, 0};
    }
    if (!leaks && !between && d < kAround * spacing && !(s.holds() && d < kStray * spacing)) {
        // At the rim, outward no faster than there is room.
        const float most = -std::clamp((d + kRim * spacing) / kReturn, -s.speed, s.speed);
        const float out = dot(v, outward);
        if (out > most) v += (most - out) * outward;
    }
    // What is bare at the edge reaches out for the rim: else a layer ends a spacing before it.
    const float toRim = -d - kBareRim * spacing;
    if (toRim > 0 && toRim < kEdge * spacing && p.normal[i].w > 0 && !leaks) {
        const float bare = dot(p.normal[i].xyz(), space.turn(s.region().direction(outward)));
        const float want = bare > kBare ? std::min(s.speed, toRim / kReturn) : 0, out = dot(v, outward);
        if (want > out) v += (want - out) * outward, speed = length(v);
    }
    Vec3 target = moving + space.turn(s.region().direction(v));
    float drag = dragOf(s.strength, f.dt);
    // Where nothing is missing it is as loose as a liquid, else the rim could not press it back into its place.
    if (d < (s.holds() ? kStray * spacing : 0))
        drag = std::min(drag, kLoose * f.dt + drag * std::min(1.0f, speed / s.speed));
    const float far = std::max(d / s.reach, off(s.region(), at) / s.depth);
    const float fade = std::clamp((kLost - far) / (kLost - 1), 0.0f, 1.0f);
    Vec3 carried = f.gravity;
    if (s.region().flat()) {
        // Across the surface it is free, but does not fall off.
        const Vec3 n = space.turn(s.region().normal());
        const float fall = dot(f.gravity, n);
        if (fall <= 0) carried -= fall * n, guide.free[i] = {n.x, n.y, n.z, 0};
    }
    target -= (s.strength * f.dt / drag) * carried;
    guide.drag[i] = {target.x, target.y, target.z, drag * fade};
}

void Shapes::guide(const ControlFrame& f, const Guide& guide) {
    const Particles& p = f.particles;
    f.tasks.forBlocks(p.moverCount, kRowBlock, [&](int begin, int end, int, int) {
        for (size_t i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i)
            if (shapeOf(p.follows[i]) && !p.bondSlot[i]) aim(f, i, guide);
    });
    fresh_ = false;
}

void ShapeForm::state(StateIo& io) {
    io(key);
    region.state(io), flow.formState(io);
    if (io.restores() && region.bounds().empty()) io.fail("a form without extent");
}

void Shapes::state(StateIo& io, const ShapeForms& forms) {
    const bool checks = io.checks();
    io.staged(shapes, stage_, io.limits.shapes, [&](Shape& s) {
        io(s.alive);
        if (!s.alive) {
            if (io.restores()) s = {};
            return;
        }
        uint64_t key = s.made ? s.made->key : 0;
        io(s.enabled, s.sets, s.setting, s.form, key);
        io.index(s.collider, io.limits.colliders + 1);
        io(s.reach, s.depth, s.thickness, s.strength, s.speed, s.setFill, s.setTime, s.priority);
        io(s.captured, s.lost, s.time, s.since, s.filledAfter, s.coming, s.fresh, s.asleep);
        io.report(s.walls); // as far as it is another one than the world's, it is in wallsLeft
        io(s.wallsLeft);
        io.report(s.mass, s.inside, s.spilled, s.set, s.distance, s.astray);
        if (checks) {
            const auto made = forms.find(key);
            if (!made) return io.fail("the form of a shape is neither in this world any more nor in the image");
            if (s.made != made || s.flow.cells() != made->flow.cells()) s.flow = made->flow;
            s.made = made;
        }
        s.flow.state(io);
    });
}

} // namespace thaw
