// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// Rigid pieces on one another, inside liquid, and on walls that are no planes.
#include "validate/lab.h"
#include "validate/validate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace thaw::player {
namespace {

std::vector<thawPieceState> piecesOf(const Lab& lab) {
    std::vector<thawPieceState> all(static_cast<size_t>(thawWorld_GetPieces(lab.world(), nullptr, 0)));
    thawWorld_GetPieces(lab.world(), all.data(), static_cast<int32_t>(all.size()));
    std::sort(all.begin(), all.end(), [](const thawPieceState& a, const thawPieceState& b) { return a.id < b.id; });
    return all;
}

double lengthOf(const thawVec3& v) { return std::hypot(double(v.x), double(v.y), double(v.z)); }

// m/s, of the fastest point of a piece at most, for its largest distance from the centre.
double fastestOf(const thawPieceState& s, double radius) {
    return lengthOf(s.velocity) + radius * lengthOf(s.angularVelocity);
}

// Potential and kinetic energy of all particles, J.
double energyOf(const Lab& lab) {
    const thawParticleView p = lab.particles();
    double e = 0;
    for (int i = 0; i < p.count; ++i) {
        const float *x = p.positions + 4 * i, *v = p.velocities + 4 * i;
        const double speed = std::hypot(double(v[0]), double(v[1]), double(v[2]));
        e += double(v[3]) * (kG * double(x[1]) + 0.5 * speed * speed);
    }
    return e;
}

// The nearest that particles of different rigid bodies are to each other, m.
double nearestOf(const Lab& lab) {
    const thawParticleView p = lab.particles();
    double least = 1;
    for (int i = 0; i < p.count; ++i)
        for (int j = 0; j < i; ++j) {
            if (p.bodies[i] == p.bodies[j] || !(p.flags[i] & p.flags[j] & thawParticle_rigid)) continue;
            const float *x = p.positions + 4 * i, *y = p.positions + 4 * j;
            const double a = double(x[0]) - double(y[0]), b = double(x[1]) - double(y[1]),
                         c = double(x[2]) - double(y[2]);
            least = std::min(least, a * a + b * b + c * c);
        }
    return std::sqrt(least);
}

double distanceOf(const thawVec3& a, const thawVec3& b) { return lengthOf({a.x - b.x, a.y - b.y, a.z - b.z}); }

double lowestOf(const Lab& lab) {
    const thawParticleView p = lab.particles();
    double y = INFINITY;
    for (int i = 0; i < p.count; ++i) y = std::min(y, double(p.positions[4 * i + 1]));
    return y;
}

void loose(thawBodyDef& d) { d.anchored = false; }

thawMaterialId wood(Lab& lab, float density = 900) { return lab.material(Lab::plain(density, 1)); }

thawQuat turned(double x, double z) { // about x, then about z; rad
    const double a = x / 2, b = z / 2;
    return {float(std::sin(a) * std::cos(b)), float(std::sin(a) * std::sin(b)), float(std::cos(a) * std::sin(b)),
            float(std::cos(a) * std::cos(b))};
}

// One on the other at the bottom of a pool.
void pairInPool(Findings& found) {
    for (const float density : {1200.0f, 2000.0f}) {
        Lab lab(0.004f, 12000);
        const float side = 0.064f, depth = 0.06f, low = 0.024f, top = 0.02f, in = 0.016f, out = side - in;
        lab.tank({0, 0, 0}, {side, 1, side});
        const thawMaterialId m = wood(lab, density), water = lab.material(Lab::plain(1000, 1));
        lab.box(m, {in, 0, in}, {out, low, out}, Lab::kSolid, loose);
        lab.box(m, {in, low, in}, {out, low + top, out}, Lab::kSolid, loose);
        lab.box(water, {0, 0, 0}, {in, depth, side}, Lab::kLiquid);
        lab.box(water, {out, 0, 0}, {side, depth, side}, Lab::kLiquid);
        lab.box(water, {in, 0, 0}, {out, depth, in}, Lab::kLiquid);
        lab.box(water, {in, 0, out}, {out, depth, side}, Lab::kLiquid);
        lab.box(water, {in, low + top, in}, {out, depth, out}, Lab::kLiquid);
        double fast = 0, liquid = 0;
        std::vector<thawPieceState> before;
        lab.step(1200, [&](int frame) {
            const auto s = piecesOf(lab);
            if (frame == 600) before = s;
            if (frame > 600)
                for (const thawPieceState& b : s) fast = std::max(fast, fastestOf(b, 0.02));
            if (frame > 600) liquid = std::max(liquid, double(lab.counters().maxSpeed));
        });
        const auto s = piecesOf(lab);
        const std::string at = ", density " + std::to_string(int(density));
        found.atMost("fastest from 10 to 20 s, m/s" + at, 1e-3, fast);
        double way = 0;
        for (size_t k = 0; k < s.size(); ++k) way = std::max(way, distanceOf(s[k].center, before[k].center));
        found.atMost("drift from 10 to 20 s / spacing" + at, 0.05, way / 0.004);
        found.within("height of the upper one, m" + at, double(low) + 0.5 * double(top), double(s.back().center.y),
                     0.03);
        found.atMost("fastest liquid, m/s" + at, 0.01, liquid);
    }
}

// Dropped into a pool, one after the other: they sink, meet, and lie there.
void pairSinks(Findings& found) {
    for (const float density : {1200.0f, 2000.0f}) {
        Lab lab(0.004f, 12000);
        const float side = 0.08f, depth = 0.048f, c = 0.5f * side;
        lab.tank({0, 0, 0}, {side, 1, side});
        const thawMaterialId m = wood(lab, density);
        lab.box(lab.material(Lab::plain(1000, 1)), {0, 0, 0}, {side, depth, side}, Lab::kLiquid);
        lab.body(m, scene::makeBox({0.024f, 0.016f, 0.024f}), {c, depth + 0.01f, c}, Lab::kSolid);
        lab.body(m, scene::makeBox({0.024f, 0.016f, 0.024f}), {c + 0.006f, depth + 0.04f, c + 0.002f}, Lab::kSolid);
        double fast = 0, liquid = 0, late = 0;
        lab.step(1500, [&](int frame) {
            const auto s = piecesOf(lab);
            liquid = std::max(liquid, double(lab.counters().maxSpeed));
            if (frame <= 1200) return;
            for (const thawPieceState& b : s) fast = std::max(fast, fastestOf(b, 0.02));
            late = std::max(late, double(lab.counters().maxSpeed));
        });
        const std::string at = ", density " + std::to_string(int(density));
        found.atMost("fastest piece from 20 to 25 s, m/s" + at, 1e-3, fast);
        found.atMost("fastest liquid at any time, m/s" + at, 1, liquid);
        found.atMost("fastest liquid from 20 to 25 s, m/s" + at, 0.05, late);
        found.atLeast("nearest particles of the two / spacing" + at, 0.5, nearestOf(lab) / 0.004);
    }
}

// A block of liquid falls on a chunk that stands free.
void pour(Findings& found) {
    for (const float dx : {0.004f, 0.002f})
        for (const float viscosity : {0.1f, 1.0f, 10.0f}) {
            Lab lab(dx, 8000);
            const float a = 16 * dx;
            lab.tank({-a, 0, -a}, {a, 1, a});
            lab.box(wood(lab), {-3 * dx, 0, -3 * dx}, {3 * dx, 6 * dx, 3 * dx}, Lab::kSolid, loose);
            lab.step(60);
            const thawVec3 at = piecesOf(lab).at(0).center;
            const float fall = 30 * dx;
            lab.box(lab.material(Lab::plain(1000, viscosity)), {-4 * dx, 6 * dx + fall, -4 * dx},
                    {4 * dx, 14 * dx + fall, 4 * dx}, Lab::kLiquid);
            double fast = 0, liquid = 0;
            lab.step(600, [&](int frame) {
                liquid = std::max(liquid, double(lab.counters().maxSpeed));
                if (frame > 540) fast = std::max(fast, fastestOf(piecesOf(lab).at(0), 6 * double(dx)));
            });
            const thawPieceState s = piecesOf(lab).at(0);
            char what[96];
            const auto name = [&](const char* text) {
                std::snprintf(what, sizeof what, "%s, %g mm, %g Pa s", text, 1000 * double(dx), double(viscosity));
                return std::string(what);
            };
            found.atMost(name("goes, spacings"), 0.5, distanceOf(s.center, at) / double(dx));
            found.atMost(name("fastest liquid / free fall"), 1.2, liquid / std::sqrt(2 * kG * double(fall + 6 * dx)));
            found.atMost(name("chunk in the last second, m/s"), 1e-3, fast);
        }
}

// A cube falls on one that stands free: so far, so far off its middle, so much turned.
void onFree(Findings& found) {
    struct Drop {
        const char* name;
        float height, aside, side, tilt; // m, rad
    };
    for (const Drop& d : {Drop{"flat", 0.1f, 0, 0.024f, 0}, Drop{"turned", 0.3f, 0.006f, 0.024f, 0.3f},
                          Drop{"large", 0.1f, 0.01f, 0.032f, 0.5f}, Drop{"small", 0.5f, 0, 0.016f, 0.4f}}) {
        Lab lab(0.004f);
        lab.floor();
        const float base = 0.032f;
        const thawMaterialId m = wood(lab);
        lab.body(m, scene::makeBox({base, base, base}), {0, 0.5f * base, 0}, Lab::kSolid, loose);
        lab.body(m, scene::makeBox({d.side, d.side, d.side}), {d.aside, base + d.height + d.side, 0.001f}, Lab::kSolid,
                 [&](thawBodyDef& b) { b.rotation = turned(double(d.tilt), 0.5 * double(d.tilt)); });
        const double size = 0.004;
        double start = 0, gained = -INFINITY, nearest = 1, lowest = 1;
        int awake = 0;
        lab.step(600, [&](int frame) {
            const double e = energyOf(lab);
            if (frame == 1) start = e;
            gained = std::max(gained, e - start);
            nearest = std::min(nearest, nearestOf(lab)), lowest = std::min(lowest, lowestOf(lab));
            for (const thawPieceState& b : piecesOf(lab))
                if (!b.asleep) awake = frame;
        });
        const std::string name = std::string(d.name) + ": ";
        const double fall = double(piecesOf(lab).at(1).mass) * kG * double(d.height);
        found.atMost(name + "energy gained / energy of the fall", 0.001, gained / fall);
        found.atLeast(name + "nearest particles of the two / spacing", 0.5, nearest / size);
        found.atLeast(name + "lowest particle / spacing", 0.25, lowest / size);
        found.atMost(name + "both asleep after, s", 3, awake / 60.0);
    }
}

// A bowl of triangles, and a wall of 1.5 spacings that stands on the floor.
void bowlAndEdge(Findings& found) {
    {
        Lab lab(0.004f);
        // A hollow of radius 60 mm in a block that goes down to -80 mm.
        const double R = 0.06, floor = -0.08;
        std::vector<scene::ProfilePoint> profile{{0, floor}, {R + 0.02, floor}, {R + 0.02, 0}};
        for (int k = 0; k <= 48; ++k) {
            const double a = 1.5707963 * k / 48;
            profile.push_back({R * std::cos(a), -R * std::sin(a)});
        }
        const scene::TriMesh bowl = scene::makeLathe(profile, 96);
        thawColliderDef d;
        thawInitColliderDef(&d, thawCollider_mesh);
        d.mesh = bowl.view();
        lab.collider(d);
        lab.body(wood(lab), scene::makeBox({0.032f, 0.016f, 0.024f}), {0.02f, 0.03f, 0.004f}, Lab::kSolid,
                 [](thawBodyDef& b) { b.rotation = turned(0.2, 0.5); });
        double out = 0;
        lab.step(900, [&](int) {
            const thawParticleView p = lab.particles();
            for (int i = 0; i < p.count; ++i) {
                const float* x = p.positions + 4 * i;
                if (x[1] < 0) out = std::max(out, double(std::hypot(x[0], x[1], x[2])) + 0.002 - R);
            }
        });
        const thawPieceState s = piecesOf(lab).at(0);
        found.atMost("in a bowl: deepest / spacing", 0.25, out / 0.004);
        found.atMost("in a bowl: speed after 15 s, m/s", 1e-3, fastestOf(s, 0.02));
        // It slides where the slope is steeper than its friction, 0.5.
        found.atMost("in a bowl: slope under it", 0.5,
                     std::hypot(double(s.center.x), double(s.center.z)) / -double(s.center.y));
    }
    for (const float aside : {0.0f, 0.006f}) {
        Lab lab(0.004f);
        lab.floor();
        thawColliderDef d;
        thawInitColliderDef(&d, thawCollider_box);
        d.size = {0.003f, 0.04f, 0.05f};
        d.position = {0, 0.04f, 0};
        lab.collider(d);
        lab.body(wood(lab), scene::makeBox({0.024f, 0.024f, 0.024f}), {aside, 0.25f, 0}, Lab::kSolid,
                 [&](thawBodyDef& b) { b.rotation = turned(0.1, double(aside) * 30); });
        double deepest = 0;
        lab.step(600, [&](int) {
            const thawParticleView p = lab.particles();
            for (int i = 0; i < p.count; ++i) {
                const float* x = p.positions + 4 * i;
                const double a = std::abs(x[0]) - 0.003f, b = std::abs(x[1] - 0.04f) - 0.04f;
                deepest = std::max(deepest, -std::max({a, b, -double(x[1])}));
            }
        });
        const thawPieceState s = piecesOf(lab).at(0);
        const std::string name = aside > 0 ? "beside the middle of an edge: " : "on an edge: ";
        // Centres never get inside of the wall.
        found.atMost(name + "centres inside of it, spacings", 0, deepest / 0.004);
        found.atMost(name + "speed after 10 s, m/s", 1e-3, fastestOf(s, 0.02));
        if (aside > 0) found.within(name + "height, m", 0.012, double(s.center.y), 0.1);
    }
}

} // namespace

CaseList pieceCases() {
    return {{"rigid-pair-in-pool", "two blocks, one on the other, at the bottom of a pool of 1 Pa s, 20 s", pairInPool},
            {"rigid-pair-sinks", "two blocks dropped into a pool of 1 Pa s sink, meet and rest, 25 s", pairSinks},
            {"rigid-pour", "a block of liquid falls on a free chunk", pour},
            {"rigid-on-free", "a cube falls on one that stands free", onFree},
            {"rigid-bowl-and-edge", "a block dropped into a bowl, and a cube on the edge of a wall of 1.5 spacings",
             bowlAndEdge}};
}

} // namespace thaw::player
