// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "validate/lab.h"
#include "validate/validate.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace thaw::player {
namespace {

constexpr double kDt = 1.0 / 60;

void loose(thawBodyDef& d) { d.anchored = false; }

std::vector<thawPieceState> piecesOf(const Lab& lab) {
    std::vector<thawPieceState> all(static_cast<size_t>(thawWorld_GetPieces(lab.world(), nullptr, 0)));
    thawWorld_GetPieces(lab.world(), all.data(), static_cast<int32_t>(all.size()));
    return all;
}

double speedOf(const thawVec3& v) { return std::hypot(double(v.x), double(v.y), double(v.z)); }

// Height and kinetic energy of all particles, J.
double energyOf(const Lab& lab) {
    const thawParticleView p = lab.particles();
    double e = 0;
    for (int i = 0; i < p.count; ++i) {
        const float *x = p.positions + 4 * i, *v = p.velocities + 4 * i;
        e += double(v[3]) * (kG * double(x[1]) + 0.5 * (double(v[0]) * double(v[0]) + double(v[1]) * double(v[1]) +
                                                        double(v[2]) * double(v[2])));
    }
    return e;
}

struct Point {
    double x, y, z;
};
std::map<uint32_t, Point> placesOf(const Lab& lab) {
    const thawParticleView p = lab.particles();
    std::map<uint32_t, Point> out;
    for (int i = 0; i < p.count; ++i)
        out[p.ids[i]] = {double(p.positions[4 * i]), double(p.positions[4 * i + 1]), double(p.positions[4 * i + 2])};
    return out;
}
double farthest(const std::map<uint32_t, Point>& a, const std::map<uint32_t, Point>& b) {
    double most = 0;
    for (const auto& [id, x] : a) {
        const Point& y = b.at(id);
        most = std::max(most, std::hypot(x.x - y.x, x.y - y.y, x.z - y.z));
    }
    return most;
}
// Of distances between particles of one solid: the largest change.
double deformation(const std::map<uint32_t, Point>& a, const std::map<uint32_t, Point>& b) {
    double most = 0;
    const auto far = [](const Point& x, const Point& y) { return std::hypot(x.x - y.x, x.y - y.y, x.z - y.z); };
    const uint32_t first = a.begin()->first, last = a.rbegin()->first,
                   middle = std::next(a.begin(), long(a.size() / 2))->first;
    for (const auto& [id, x] : a)
        for (const uint32_t o : {first, last, middle})
            most = std::max(most, std::abs(far(x, a.at(o)) - far(b.at(id), b.at(o))));
    return most;
}
double lowest(const Lab& lab) {
    const thawParticleView p = lab.particles();
    double y = INFINITY;
    for (int i = 0; i < p.count; ++i) y = std::min(y, double(p.positions[4 * i + 1]));
    return y;
}

thawQuat turned(double x, double z) { // about x, then about z; rad
    const double a = x / 2, b = z / 2;
    return {float(std::sin(a) * std::cos(b)), float(std::sin(a) * std::sin(b)), float(std::cos(a) * std::sin(b)),
            float(std::cos(a) * std::cos(b))};
}

thawMaterialId wood(Lab& lab, float density = 900) { return lab.material(Lab::plain(density, 1)); }

void freeFall(Findings& found) {
    Lab lab(0.004f);
    lab.floor();
    const float side = 0.032f;
    lab.body(wood(lab), scene::makeBox({side, side, side}), {0, 1.5f, 0}, Lab::kSolid, [](thawBodyDef& d) {
        d.angularVelocity = {3, 1, -2};
    });
    const auto before = placesOf(lab);
    double start = 0, most = -INFINITY, fallen = 0, exact = 0, after = 0, deepest = -INFINITY;
    int landed = 0;
    const double top = 1.5;
    lab.step(180, [&](int frame) {
        const thawPieceState s = piecesOf(lab).at(0);
        const double e = energyOf(lab);
        if (frame == 1) start = e;
        most = std::max(most, e - start);
        if (frame == 30) fallen = top - double(s.center.y), exact = 0.5 * kG * (30 * kDt) * (30 * kDt);
        deepest = std::max(deepest, 0.5 - lowest(lab) / 0.004);
        if (!landed && deepest > -0.5) landed = frame;
        if (frame == 180) after = speedOf(s.velocity);
    });
    const double mass = double(piecesOf(lab).at(0).mass);
    found.within("fallen after 0.5 s, m", exact, fallen, 0.001);
    found.atMost("energy gained / energy of the fall", 0.001, most / (mass * kG * top));
    found.within("lands, s", std::sqrt(2 * (top - 0.016) / kG), landed * kDt, 0.05);
    // It hits with a corner and turns at 80 rad/s.
    found.atMost("deepest penetration / spacing", 0.25, deepest);
    found.atMost("speed 3 s after release, m/s", 1e-3, after);
    found.atMost("shape, change / spacing", 1e-3, deformation(before, placesOf(lab)) / 0.004);
    found.atMost("moving particles at the end", 0, lab.counters().moving);
}

void rests(Findings& found) {
    Lab lab(0.004f);
    lab.floor();
    lab.box(wood(lab), {-0.016f, 0, -0.016f}, {0.016f, 0.032f, 0.016f}, Lab::kSolid, loose);
    lab.step(60);
    const auto before = placesOf(lab);
    lab.step(3600);
    found.atMost("creep in 60 s / spacing", 0, farthest(before, placesOf(lab)) / 0.004);
    found.atLeast("asleep", 1, piecesOf(lab).at(0).asleep);
    found.atMost("moving particles", 0, lab.counters().moving);
}

void tiltedDrop(Findings& found) {
    for (float dx : {0.004f, 0.002f}) {
        Lab lab(dx);
        lab.floor();
        const float side = 8 * dx;
        lab.body(wood(lab), scene::makeBox({side, side, side}), {0, 0.1f + 6 * dx, 0}, Lab::kSolid,
                 [](thawBodyDef& d) { d.rotation = turned(0.52, 0.35); });
        double deepest = 0, start = 0, most = -INFINITY;
        lab.step(240, [&](int frame) {
            deepest = std::max(deepest, 0.5 - lowest(lab) / double(dx));
            const double e = energyOf(lab);
            if (frame == 1) start = e;
            most = std::max(most, e - start);
        });
        const std::string at = dx == 0.004f ? ", 4 mm" : ", 2 mm";
        found.atMost("deepest penetration / spacing" + at, 0.1, deepest);
        found.atMost("energy gained / energy of the fall" + at, 0.001,
                     most / (double(piecesOf(lab).at(0).mass) * kG * 0.1));
        found.atMost("speed at the end, m/s" + at, 0, speedOf(piecesOf(lab).at(0).velocity));
    }
}

void stackOfThree(Findings& found) {
    Lab lab(0.004f);
    lab.floor();
    const thawMaterialId m = wood(lab);
    const float side = 0.024f;
    for (int k = 0; k < 3; ++k)
        lab.body(m, scene::makeBox({side, side, side}), {0.0005f * float(k), (float(k) + 0.5f) * side, 0}, Lab::kSolid,
                 [&](thawBodyDef& d) {
                     d.anchored = false;
                     d.rotation = {0, std::sin(0.1f * float(k)), 0, std::cos(0.1f * float(k))};
                 });
    lab.step(1200);
    const auto before = placesOf(lab);
    lab.step(2400);
    found.atMost("creep in the last 40 s / spacing", 0, farthest(before, placesOf(lab)) / 0.004);
    double top = 0;
    int asleep = 0;
    for (const thawPieceState& s : piecesOf(lab)) top = std::max(top, double(s.center.y)), asleep += s.asleep;
    found.within("height of the topmost centre, m", 2.5 * double(side), top, 0.02);
    found.within("asleep", 3, asleep, 0);
}

void onSphereAndPlate(Findings& found) {
    {
        Lab lab(0.004f);
        thawColliderDef d;
        thawInitColliderDef(&d, thawCollider_sphere);
        d.size = {0.1f, 0.1f, 0.1f};
        lab.collider(d);
        lab.body(wood(lab), scene::makeBox({0.032f, 0.016f, 0.032f}), {0.002f, 0.16f, 0.001f}, Lab::kSolid);
        double deepest = 0;
        lab.step(600, [&](int) {
            const thawParticleView p = lab.particles();
            for (int i = 0; i < p.count; ++i) {
                const float* x = p.positions + 4 * i;
                deepest = std::max(deepest, 0.102 - std::hypot(double(x[0]), double(x[1]), double(x[2])));
            }
        });
        const thawPieceState s = piecesOf(lab).at(0);
        found.atMost("on a sphere: deepest / spacing", 0.25, deepest / 0.004);
        found.atMost("on a sphere: speed after 10 s, m/s", 0, speedOf(s.velocity));
        found.within("on a sphere: height, m", 0.108, double(s.center.y), 0.02);
    }
    {
        // 1.5 spacings thick, and 8 spacings a step.
        Lab lab(0.004f);
        thawColliderDef d;
        thawInitColliderDef(&d, thawCollider_box);
        d.size = {0.05f, 0.003f, 0.05f};
        lab.collider(d);
        lab.body(wood(lab), scene::makeBox({0.024f, 0.024f, 0.024f}), {0.01f, 0.3f, 0}, Lab::kSolid,
                 [](thawBodyDef& b) { b.rotation = turned(0.3, 0.2); });
        lab.step(360);
        const thawPieceState s = piecesOf(lab).at(0);
        found.within("on a thin plate: height, m", 0.015, double(s.center.y), 0.05);
        found.atMost("on a thin plate: speed, m/s", 0, speedOf(s.velocity));
    }
}

void pushesAnother(Findings& found) {
    Lab lab(0.004f);
    lab.floor();
    const thawMaterialId m = wood(lab);
    lab.box(m, {-0.012f, 0, -0.012f}, {0.012f, 0.024f, 0.012f}, Lab::kSolid, loose);
    lab.step(90);
    const bool slept = piecesOf(lab).at(0).asleep;
    // The same from the side at 1.5 m/s, then at rest.
    lab.body(m, scene::makeBox({0.024f, 0.024f, 0.024f}), {-0.1f, 0.013f, 0.002f}, Lab::kSolid, [](thawBodyDef& d) {
        d.anchored = false;
        d.velocity = {1.5f, 0, 0};
    });
    double overlap = 0;
    lab.step(300, [&](int) {
        const auto s = piecesOf(lab);
        if (s.size() == 2)
            overlap = std::max(overlap, 0.024 - std::hypot(double(s[0].center.x) - double(s[1].center.x),
                                                           double(s[0].center.z) - double(s[1].center.z)));
    });
    const auto s = piecesOf(lab);
    found.atLeast("asleep before", 1, slept);
    found.atLeast("the one that was hit went, m", 0.01, s.empty() ? 0 : double(s[0].center.x));
    found.atMost("overlap / spacing", 0.5, overlap / 0.004);
    double moving = 0;
    for (const thawPieceState& b : s) moving += speedOf(b.velocity);
    found.atMost("speeds at the end, m/s", 0, moving);
}

// A block that hangs on a neck of another material, which melts at 300 K where the block does at 500.
void neckCut(Findings& found) {
    Lab lab(0.004f, 20000, {0, -9.81f, 0}, 20);
    lab.floor();
    lab.plane({0, 0.232f, 0}, {0, -1, 0});
    thawMaterialDef hard = Lab::plain(900, 1), soft = Lab::plain(900, 0.1f);
    hard.solidus = 500, hard.liquidus = 510;
    soft.latentHeat = 2e4f;
    const thawMaterialId block = lab.material(hard), neck = lab.material(soft);
    lab.box(block, {-0.016f, 0.216f, -0.016f}, {0.016f, 0.232f, 0.016f}, Lab::kSolid);
    lab.box(neck, {-0.004f, 0.184f, -0.004f}, {0.004f, 0.216f, 0.004f}, Lab::kSolid);
    const thawBodyId lower = lab.box(block, {-0.016f, 0.152f, -0.016f}, {0.016f, 0.184f, 0.016f}, Lab::kSolid);
    thawHeatSourceDef s;
    thawInitHeatSourceDef(&s);
    for (float side : {-0.014f, 0.014f}) {
        s.position = {side, 0.206f, 0};
        s.power = 40;
        lab.source(s);
    }
    thawWorld_SetAmbient(lab.world(), 299, 0);
    thawBodyState state;
    thawBody_GetState(lab.world(), lower, &state);
    const int size = state.particles;
    std::map<uint32_t, Point> before;
    int cutAt = 0, most = 0;
    double high = 0, soon = 0, speed = 0, fallen = 0, exact = 0, bent = 0;
    const auto ofLower = [&] {
        const thawParticleView p = lab.particles();
        std::map<uint32_t, Point> out;
        for (int i = 0; i < p.count; ++i)
            if (p.bodies[i] == lower.index1 - 1)
                out[p.ids[i]] = {double(p.positions[4 * i]), double(p.positions[4 * i + 1]),
                                 double(p.positions[4 * i + 2])};
        return out;
    };
    const auto heightOf = [](const std::map<uint32_t, Point>& m) {
        double y = 0;
        for (const auto& [i, x] : m) y += x.y;
        return y / double(m.size());
    };
    lab.step(900, [&](int frame) {
        for (const thawPieceState& q : piecesOf(lab)) most = std::max(most, q.particles);
        if (!cutAt && thawWorld_GetPieces(lab.world(), nullptr, 0) > 0) {
            cutAt = frame, before = ofLower(), high = heightOf(before);
        } else if (cutAt && frame == cutAt + 7) {
            soon = heightOf(ofLower()), speed = double(piecesOf(lab).at(0).velocity.y);
        } else if (cutAt && frame == cutAt + 12) {
            // Velocities are those of half a step before.
            const double t = 5 * kDt;
            fallen = soon - heightOf(ofLower()), exact = -speed * t + 0.5 * kG * t * (t + kDt);
        }
        if (cutAt) bent = std::max(bent, deformation(before, ofLower()));
    });
    found.atLeast("cut off, particles of the lower block", size, most);
    // The melt of the neck holds it back for the first five.
    found.within("fallen in the 8th to 12th frame after the cut, m", exact, fallen, 0.001);
    found.atMost("shape of the lower block, change / spacing", 1e-3, bent / 0.004);
    found.atLeast("fell in all, m", 0.14, high - heightOf(ofLower()));
    const auto pieces = piecesOf(lab);
    double moving = 0;
    for (const thawPieceState& q : pieces) moving += speedOf(q.velocity);
    found.atMost("speed of pieces at the end, m/s", 1e-3, moving);
}

// Draft of a block by the level that the volumes give.
void floats(Findings& found) {
    for (float density : {500.0f, 900.0f}) {
        Lab lab(0.004f, 8000);
        const float side = 0.056f, depth = 0.036f;
        lab.tank({0, 0, 0}, {side, 1, side});
        lab.box(lab.material(Lab::plain(1000, 1)), {0, 0, 0}, {side, depth, side}, Lab::kLiquid);
        const float w = 0.024f, high = 0.016f;
        lab.body(wood(lab, density), scene::makeBox({w, high, w}),
                 {0.5f * side, depth + 0.5f * high + 0.002f, 0.5f * side}, Lab::kSolid);
        lab.step(840);
        const double y = double(piecesOf(lab).at(0).center.y);
        double fastest = 0;
        lab.step(60, [&](int) { fastest = std::max(fastest, speedOf(piecesOf(lab).at(0).velocity)); });
        const double share = double(density) / 1000;
        const double level =
            (double(side) * double(side) * double(depth) + share * double(w) * double(w) * double(high)) /
            (double(side) * double(side));
        const double draft = (level - (y - 0.5 * double(high))) / double(high);
        const std::string at = ", density " + std::to_string(int(density));
        found.atMost("draft off Archimedes, spacings" + at, 0.5, std::abs(draft - share) * double(high) / 0.004);
        found.atMost("speed in the last second, m/s" + at, 5e-3, fastest);
        found.atMost("drift in the last second / spacing" + at, 0.05,
                     std::abs(double(piecesOf(lab).at(0).center.y) - y) / 0.004);
    }
}

void chunkIntoBlob(Findings& found) {
    Lab lab(0.004f, 4000, {0, 0, 0});
    lab.budget.work.viscosityIterations = 12;
    thawMaterialDef m = Lab::plain(1000, 1);
    m.cohesion = 6;
    lab.body(lab.material(m), scene::makeBox({0.032f, 0.032f, 0.032f}), {0, 0, 0}, Lab::kLiquid);
    lab.body(wood(lab), scene::makeBox({0.024f, 0.024f, 0.024f}), {-0.033f, 0.008f, 0}, Lab::kSolid,
             [](thawBodyDef& d) {
                 d.velocity = {0.3f, 0, 0};
                 d.angularVelocity = {0, 0, 5};
             });
    const Momentum before = momentumOf(lab.particles());
    lab.step(60);
    const Momentum after = momentumOf(lab.particles());
    double p[3], l[3];
    for (int k = 0; k < 3; ++k) p[k] = after.p[k] - before.p[k], l[k] = after.l[k] - before.l[k];
    found.atMost("linear momentum, change / whole", 0.01, lengthOf(p) / lengthOf(before.p));
    found.atMost("angular momentum, change / whole", 0.01, lengthOf(l) / lengthOf(before.l));
    found.atMost("speed of the chunk afterwards, m/s", 0.2, speedOf(piecesOf(lab).at(0).velocity));
}

void damPush(Findings& found) {
    Lab lab(0.004f, 8000);
    lab.tank({0, 0, -0.016f}, {0.12f, 1, 0.016f});
    lab.box(lab.material(Lab::plain(1000, 0.5f)), {0, 0, -0.016f}, {0.032f, 0.048f, 0.016f}, Lab::kLiquid);
    lab.box(wood(lab, 1200), {0.048f, 0, -0.008f}, {0.064f, 0.016f, 0.008f}, Lab::kSolid, loose);
    double fastest = 0;
    lab.step(600, [&](int) { fastest = std::max(fastest, double(lab.counters().maxSpeed)); });
    const thawPieceState s = piecesOf(lab).at(0);
    found.atLeast("pushed along, m", 0.008, double(s.center.x) - 0.056);
    found.atMost("fastest liquid, m/s", 1.2, fastest);
    found.atLeast("asleep at the end", 1, s.asleep);
    found.atLeast("lowest particle / spacing", 0.25, lowest(lab) / 0.004);
}

// A rod of three blocks of a hard material, joined by two of one that is liquid: cut twice while it flies and turns.
void splitTwice(Findings& found, float fast, const std::string& at) {
    Lab lab(0.004f, 4000, {0, -9.81f, 0}, 40);
    thawMaterialDef hard = Lab::plain(900, 1), early = Lab::plain(900, 0.1f), late = early;
    hard.solidus = 500, hard.liquidus = 510;
    early.solidus = 295, early.liquidus = 296, late.solidus = 310, late.liquidus = 311;
    early.latentHeat = late.latentHeat = 100;
    const thawMaterialId block = lab.material(hard), first = lab.material(early), second = lab.material(late);
    const scene::TriMesh whole = scene::makeBox({0.1f, 0.016f, 0.016f});
    scene::TriMesh joints[2];
    thawBodyPart parts[2] = {};
    for (int k = 0; k < 2; ++k) {
        joints[k] = scene::makeBox({0.008f, 0.03f, 0.03f});
        for (size_t v = 0; v < joints[k].vertices.size(); v += 3) joints[k].vertices[v] += k ? 0.02f : -0.02f;
        parts[k].material = k ? second : first, parts[k].mesh = joints[k].view();
    }
    lab.body(block, whole, {0, 0, 0}, Lab::kSolid, [&](thawBodyDef& d) {
        d.velocity = {0.2f, 1, 0}, d.angularVelocity = {0, fast * 1, fast * 3};
        d.parts = parts, d.partCount = 2;
    });
    thawWorld_SetAmbient(lab.world(), 400, 2000);
    const Momentum before = momentumOf(lab.particles());
    double worst = 0, turned = 0;
    size_t most = 0;
    Point center{};
    lab.step(90, [&](int frame) {
        most = std::max(most, piecesOf(lab).size());
        const thawParticleView p = lab.particles();
        double mass = 0;
        Point c{};
        for (int i = 0; i < p.count; ++i) {
            const double m = double(p.velocities[4 * i + 3]);
            mass += m, c.x += m * double(p.positions[4 * i]), c.y += m * double(p.positions[4 * i + 1]);
            c.z += m * double(p.positions[4 * i + 2]);
        }
        center = {c.x / mass, c.y / mass, c.z / mass};
        const Momentum now = momentumOf(p);
        worst = std::max(worst, std::abs(now.p[0] / mass - 0.2));
        const double fall = kG * (frame - 0.5) * kDt;
        worst = std::max(worst, std::abs(now.p[1] / mass - (1 - fall)));
        // About the centre of mass, which the weight does not turn.
        const double l[3] = {now.l[0] - (center.y * now.p[2] - center.z * now.p[1]) - before.l[0],
                             now.l[1] - (center.z * now.p[0] - center.x * now.p[2]) - before.l[1],
                             now.l[2] - (center.x * now.p[1] - center.y * now.p[0]) - before.l[2]};
        turned = std::max(turned, lengthOf(l) / lengthOf(before.l));
    });
    found.within("pieces" + at, 3, double(most), 0);
    found.atMost("velocity of all mass off free flight, m/s" + at, 0.001, worst);
    found.atMost("angular momentum, change / whole" + at, 0.03, turned);
}

void splitTwice(Findings& found) {
    splitTwice(found, 1, ", 3 rad/s");
    splitTwice(found, 4, ", 13 rad/s");
    splitTwice(found, 10, ", 32 rad/s");
}

} // namespace

CaseList rigidCases() {
    return {
        {"rigid-free-fall", "a spinning cube falls 1.5 m: free fall, then rest; energy never grows", freeFall},
        {"rigid-rest", "a cube that stands free on the floor, 60 s", rests},
        {"rigid-tilted-drop", "a cube dropped 0.1 m on an edge", tiltedDrop},
        {"rigid-stack", "three cubes on each other, each turned by 0.2 rad, 60 s", stackOfThree},
        {"rigid-curved-and-thin", "chunks dropped on a sphere and, at 2.4 m/s, on a plate of 1.5 spacings",
         onSphereAndPlate},
        {"rigid-push", "a free cube hit by another at 1.5 m/s", pushesAnother},
        {"rigid-neck-cut", "a block whose neck is melted by a source: it falls as one piece", neckCut},
        {"rigid-split-twice", "a rod that turns in flight at 3, 13 and 32 rad/s loses two joints to heat", splitTwice},
        {"rigid-float", "blocks in a tank of 1 Pa s, 14 s", floats},
        {"rigid-momentum", "a spinning chunk at 0.3 m/s into a blob, no gravity, 1 s", chunkIntoBlob},
        {"rigid-dam", "a block standing in the way of a breaking dam", damPush}};
}

} // namespace thaw::player
