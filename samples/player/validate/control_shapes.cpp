// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "report.h"
#include "validate/lab.h"
#include "validate/validate.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace thaw::player {
namespace {

using Contour = std::vector<thawVec3>;

thawShapeId addShape(const Lab& lab, const std::vector<Contour>& contours,
                     const std::function<void(thawShapeDef&)>& more = {}) {
    thawShapeDef d;
    thawInitShapeDef(&d);
    std::vector<thawVec3> points;
    std::vector<int32_t> sizes;
    for (const Contour& c : contours)
        points.insert(points.end(), c.begin(), c.end()), sizes.push_back(int32_t(c.size()));
    d.points = points.data(), d.contourSizes = sizes.data(), d.contourCount = int32_t(sizes.size());
    if (more) more(d);
    thawShapeId id;
    if (thawCreateShape(lab.world(), &d, &id) != thawResult_ok) throw LabError(thawWorld_GetLastError(lab.world()));
    return id;
}

thawShapeState stateOf(const Lab& lab, thawShapeId id) {
    thawShapeState s;
    if (thawShape_GetState(lab.world(), id, &s) != thawResult_ok) throw LabError("shape: no state");
    return s;
}

// An ellipse on y = 0.
Contour ellipse(double x, double z, double rx, double rz, int points = 48) {
    Contour c;
    for (int k = 0; k < points; ++k) {
        const double a = 2 * kPi * k / points;
        c.push_back({float(x + rx * std::cos(a)), 0, float(z + rz * std::sin(a))});
    }
    return c;
}

// Outline, two eyes and a mouth, a radius of 45 mm.
std::vector<Contour> smile() {
    std::vector<Contour> face{ellipse(0, 0, 0.045, 0.045), ellipse(-0.016, -0.013, 0.0065, 0.0085, 20),
                              ellipse(0.016, -0.013, 0.0065, 0.0085, 20)};
    Contour mouth;
    for (int side = 0; side < 2; ++side)
        for (int k = 0; k <= 16; ++k) {
            const double a = kPi * (22 + 136 * (side ? 16 - k : k) / 16.0) / 180, r = side ? 0.021 : 0.030;
            mouth.push_back({float(r * std::cos(a)), 0, float(-0.002 + r * std::sin(a))});
        }
    face.push_back(mouth);
    return face;
}

bool insideOdd(const std::vector<Contour>& contours, double x, double z) {
    bool in = false;
    for (const Contour& c : contours)
        for (size_t k = 0; k < c.size(); ++k) {
            const thawVec3 a = c[k], b = c[(k + 1) % c.size()];
            if ((double(a.z) > z) != (double(b.z) > z) &&
                x < double(a.x) + (z - double(a.z)) / (double(b.z) - double(a.z)) * (double(b.x) - double(a.x)))
                in = !in;
        }
    return in;
}

// What is seen of the surface from above against a drawing on y = 0, in pixels of half a millimetre.
struct Footprint {
    double overlap, spill; // intersection over union; share of the footprint that lies outside

    // axes: which of a place are the first of the drawing, across it, and its second.
    Footprint(const Lab& lab, const std::vector<Contour>& drawing, double half = 0.12,
              std::array<int, 3> axes = {0, 1, 2}) {
        constexpr double kPixel = 0.0005;
        const int n = int(2 * half / kPixel);
        std::vector<char> seen(size_t(n) * size_t(n));
        const thawSurfaceView s = lab.surface();
        for (int t = 0; t < s.triangleCount; ++t) {
            double x[3], z[3];
            for (int k = 0; k < 3; ++k) {
                const float* p = s.positions + 3 * s.indices[3 * t + k];
                x[k] = (double(p[axes[0]]) + half) / kPixel, z[k] = (double(p[axes[2]]) + half) / kPixel;
            }
            const auto [x0, x1] = std::minmax({x[0], x[1], x[2]});
            const auto [z0, z1] = std::minmax({z[0], z[1], z[2]});
            for (int j = std::max(0, int(z0)); j <= std::min(n - 1, int(z1)); ++j)
                for (int i = std::max(0, int(x0)); i <= std::min(n - 1, int(x1)); ++i) {
                    double least = 1e9, most = -1e9;
                    for (int k = 0; k < 3; ++k) {
                        const int l = (k + 1) % 3;
                        const double side = (x[l] - x[k]) * (j + 0.5 - z[k]) - (z[l] - z[k]) * (i + 0.5 - x[k]);
                        least = std::min(least, side), most = std::max(most, side);
                    }
                    if (least >= 0 || most <= 0) seen[size_t(j) * size_t(n) + size_t(i)] = 1;
                }
        }
        double both = 0, either = 0, all = 0;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const bool drawn = insideOdd(drawing, (i + 0.5) * kPixel - half, (j + 0.5) * kPixel - half),
                           there = seen[size_t(j) * size_t(n) + size_t(i)];
                both += drawn && there, either += drawn || there, all += there;
            }
        overlap = either > 0 ? both / either : 0, spill = all > 0 ? (all - both) / all : 0;
    }
};

void smileCase(Findings& found) {
    Lab lab(0.0025f, 4000, {0, -9.81f, 0}, 30);
    thawMaterialDef butter;
    thawInitMaterialDef(&butter, thawMaterial_butter);
    butter.viscosityLiquid = 0.1f, butter.cohesion = 4;
    const thawMaterialId m = lab.material(butter);
    thawColliderDef plate;
    thawInitColliderDef(&plate, thawCollider_plane);
    plate.temperature = 390, plate.contactConductance = 2000;
    const thawColliderId pan = lab.collider(plate);
    lab.body(m, scene::makeBox({0.045f, 0.02f, 0.035f}), {0, 0.01f, 0}, 280);
    thawWorld_SetAmbient(lab.world(), 350, 10);
    const std::vector<Contour> face = smile();
    const thawShapeId id = addShape(lab, face);
    lab.step(60 * 20);
    const Footprint now(lab, face);
    found.atLeast("footprint against the drawing, intersection over union", 0.9, now.overlap);
    found.atMost("of the footprint outside of the drawing, share", 0.03, now.spill);
    const thawShapeState s = stateOf(lab, id);
    found.atLeast("set, share of what obeys", 0.99, double(s.set / s.mass));
    thawLedger l;
    thawWorld_GetLedger(lab.world(), &l);
    found.atMost("energy ledger's error, with the heat that it took", 1e-9, l.energyError);
    // The pan is cold, the drawing gone.
    thawCollider_SetHeat(lab.world(), pan, NAN, 0);
    thawWorld_SetAmbient(lab.world(), 280, 10);
    thawDestroyShape(lab.world(), id);
    lab.step(60 * 60);
    found.atLeast("60 s after it was removed: intersection over union", 0.85, Footprint(lab, face).overlap);
}

// Of vertical lines half a millimetre apart, where they are inside a closed mesh.
struct Columns {
    static constexpr double kPixel = 0.0005, kHalf = 0.1;
    static constexpr int kSide = int(2 * kHalf / kPixel);
    std::vector<std::vector<double>> crossings;

    Columns(const float* vertices, const uint32_t* indices, size_t triangles, thawVec3 shift)
        : crossings(size_t(kSide) * kSide) {
        for (size_t t = 0; t < triangles; ++t) {
            double x[3], y[3], z[3];
            for (size_t k = 0; k < 3; ++k) {
                const float* p = vertices + 3 * indices[3 * t + k];
                x[k] = (double(p[0] + shift.x) + kHalf) / kPixel, y[k] = double(p[1] + shift.y);
                z[k] = (double(p[2] + shift.z) + kHalf) / kPixel;
            }
            const double area = (x[1] - x[0]) * (z[2] - z[0]) - (x[2] - x[0]) * (z[1] - z[0]);
            if (area == 0) continue;
            const auto [x0, x1] = std::minmax({x[0], x[1], x[2]});
            const auto [z0, z1] = std::minmax({z[0], z[1], z[2]});
            // Lines a little off the middle, that meet no edge of a regular mesh.
            for (int j = std::max(0, int(z0) - 1); j <= std::min(kSide - 1, int(z1)); ++j)
                for (int i = std::max(0, int(x0) - 1); i <= std::min(kSide - 1, int(x1)); ++i) {
                    const double px = i + 0.50317, pz = j + 0.50731;
                    double w[3];
                    bool in = true;
                    for (size_t k = 0; k < 3; ++k) {
                        const size_t a = (k + 1) % 3, b = (k + 2) % 3;
                        w[k] = ((x[a] - px) * (z[b] - pz) - (x[b] - px) * (z[a] - pz)) / area;
                        in &= w[k] >= 0;
                    }
                    if (in) crossings[size_t(j) * kSide + size_t(i)].push_back(w[0] * y[0] + w[1] * y[1] + w[2] * y[2]);
                }
        }
        for (std::vector<double>& c : crossings) std::sort(c.begin(), c.end());
    }
    static double length(const std::vector<double>& c) {
        double sum = 0;
        for (size_t k = 0; k + 1 < c.size(); k += 2) sum += c[k + 1] - c[k];
        return sum;
    }
    // Intersection over union.
    double overlap(const Columns& o) const {
        double both = 0, either = 0;
        for (size_t k = 0; k < crossings.size(); ++k) {
            const std::vector<double>&a = crossings[k], &b = o.crossings[k];
            double common = 0;
            for (size_t i = 0; i + 1 < a.size(); i += 2)
                for (size_t j = 0; j + 1 < b.size(); j += 2)
                    common += std::max(0.0, std::min(a[i + 1], b[j + 1]) - std::max(a[i], b[j]));
            both += common, either += length(a) + length(b) - common;
        }
        return either > 0 ? both / either : 0;
    }
};

Columns surfaceOf(const Lab& lab) {
    const thawSurfaceView s = lab.surface();
    return {s.positions, s.indices, size_t(s.triangleCount), {}};
}

// A puddle's worth of liquid beside it gathers in a mesh, sets in it and stays when it is gone.
void gather(Findings& found, const char* what, const scene::TriMesh& mesh, thawVec3 middle) {
    Lab lab(0.0025f, 6000);
    const thawMaterialId m = lab.material(Lab::plain(1000, 0.5f));
    lab.floor();
    thawShapeDef d;
    thawInitShapeDef(&d);
    d.mesh = mesh.view(), d.position = middle, d.reach = 0.08f, d.speed = 0.2f;
    thawShapeId id;
    if (thawCreateShape(lab.world(), &d, &id) != thawResult_ok) throw LabError(thawWorld_GetLastError(lab.world()));
    const double side = std::cbrt(double(stateOf(lab, id).size));
    const float s = float(side);
    lab.body(m, scene::makeBox({s, s, s}), {-0.06f, 0.5f * s, 0}, Lab::kLiquid);
    const Columns target(mesh.vertices.data(), mesh.indices.data(), mesh.indices.size() / 3, middle);
    lab.step(60 * 15);
    found.atLeast(formatted("%s: volume, intersection over union", what), 0.85, surfaceOf(lab).overlap(target));
    const thawShapeState state = stateOf(lab, id);
    found.atLeast(formatted("%s: set, share of what obeys", what), 0.99, double(state.set / state.mass));
    thawDestroyShape(lab.world(), id);
    lab.step(60 * 10);
    found.atLeast(formatted("%s: 10 s after it was removed", what), 0.85, surfaceOf(lab).overlap(target));
}

void sphereCase(Findings& found) { gather(found, "sphere of 20 mm", scene::makeSphere(0.02f), {0, 0.02f, 0}); }
void starCase(Findings& found) { gather(found, "star of 2,000 triangles", scene::makeStar(), {0, 0, 0}); }

// Fills a ring and a disc in it, liquid for good.
void restCase(Findings& found) {
    Lab lab(0.0025f, 4000);
    const thawMaterialId m = lab.material(Lab::plain(1000, 0.2f));
    lab.floor();
    lab.body(m, scene::makeCylinder(0.02f, 0.02f), {0, 0.01f, 0}, Lab::kLiquid);
    const std::vector<Contour> ring{ellipse(0, 0, 0.045, 0.035), ellipse(0, 0, 0.03, 0.02), ellipse(0, 0, 0.02, 0.01)};
    const thawShapeId id = addShape(lab, ring, [](thawShapeDef& d) { d.sets = false; });
    lab.step(60 * 15);
    const Footprint p(lab, ring);
    found.atLeast("liquid, held for 15 s: intersection over union", 0.9, p.overlap);
    found.atMost("of the footprint outside of the drawing, share", 0.03, p.spill);
    double worst = 0;
    lab.step(120, [&](int) { worst = std::max(worst, kineticOver(lab)); });
    found.atMost("kinetic energy over g dx m, most in 2 s", 1e-4, worst);
    found.atLeast("covered, share", 0.95, double(stateOf(lab, id).fill));
}

// Everything that a blob in free space has of momentum, a shape gave.
void ledgerCase(Findings& found) {
    Lab lab(0.003f, 4000, {0, 0, 0});
    const thawMaterialId m = lab.material(Lab::plain(1000, 0.5f));
    lab.body(m, scene::makeSphere(0.015f), {-0.05f, 0.01f, 0}, Lab::kLiquid);
    const scene::TriMesh ball = scene::makeSphere(0.018f);
    thawShapeDef d;
    thawInitShapeDef(&d);
    d.mesh = ball.view(), d.reach = 0.1f, d.speed = 0.2f, d.sets = false;
    thawShapeId id;
    if (thawCreateShape(lab.world(), &d, &id) != thawResult_ok) throw LabError(thawWorld_GetLastError(lab.world()));
    double most = 0, off = 0;
    lab.step(120, [&](int) {
        const Momentum now = momentumOf(lab.particles());
        thawLedger l;
        thawWorld_GetLedger(lab.world(), &l);
        double apart[3];
        for (int a = 0; a < 3; ++a) apart[a] = now.p[a] - l.controlImpulse[a];
        most = std::max(most, lengthOf(now.p)), off = std::max(off, lengthOf(apart));
    });
    found.atLeast("blob in free space drawn into a ball: most momentum it had, g m/s", 0.1, 1e3 * most);
    found.atMost("of that not in the ledger at any time, share", 1e-4, off / most);
    found.atLeast("of it in the ball after 2 s, share", 0.95,
                  double(stateOf(lab, id).inside) / (1000 * 4 / 3.0 * kPi * std::pow(0.015, 3)));
}

// Drawn on a wall: liquid that would run down it stays in a disc with a hole.
void wallCase(Findings& found) {
    Lab lab(0.0025f, 4000);
    thawMaterialDef wax = Lab::plain(900, 0.5f);
    wax.adhesion = 1, wax.cohesion = 4;
    const thawMaterialId m = lab.material(wax);
    lab.plane({0, 0, 0}, {0, 0, 1});
    lab.floor(-0.1f);
    std::vector<Contour> disc{ellipse(0, 0, 0.035, 0.035), ellipse(0, 0, 0.012, 0.012, 32)}, drawn = disc;
    for (Contour& c : drawn)
        for (thawVec3& x : c) x = {x.x, x.z, 0};
    lab.body(m, scene::makeBox({0.04f, 0.03f, 0.012f}), {0, 0.015f, 0.006f}, Lab::kLiquid);
    const thawShapeId id = addShape(lab, drawn);
    lab.step(60 * 12);
    const Footprint p(lab, disc, 0.12, {0, 2, 1});
    found.atLeast("on a wall: intersection over union", 0.9, p.overlap);
    found.atMost("of the footprint outside of the drawing, share", 0.03, p.spill);
    found.atLeast("set, share", 0.99, double(stateOf(lab, id).set / stateOf(lab, id).mass));
    thawDestroyShape(lab.world(), id);
    lab.step(60 * 10);
    found.atLeast("10 s after it was removed: intersection over union", 0.85,
                  Footprint(lab, disc, 0.12, {0, 2, 1}).overlap);
}

// Three discs apart from each other, the liquid on the middle one.
void islandsCase(Findings& found) {
    Lab lab(0.0025f, 4000);
    const thawMaterialId m = lab.material(Lab::plain(1000, 0.2f));
    lab.floor();
    lab.body(m, scene::makeCylinder(0.018f, 0.022f), {0, 0.011f, 0}, Lab::kLiquid);
    const std::vector<Contour> discs{ellipse(-0.05, 0, 0.018, 0.018), ellipse(0, 0, 0.018, 0.018),
                                     ellipse(0.05, 0, 0.018, 0.018)};
    addShape(lab, discs);
    lab.step(60 * 15);
    const Footprint p(lab, discs);
    found.atLeast("three islands: intersection over union", 0.9, p.overlap);
    found.atMost("of the footprint outside of the drawing, share", 0.03, p.spill);
    const thawParticleView v = lab.particles();
    double in[3] = {}, all = 0;
    for (int i = 0; i < v.count; ++i) {
        const double x = double(v.positions[4 * i]), mass = double(v.velocities[4 * i + 3]);
        in[x < -0.025 ? 0 : x > 0.025 ? 2 : 1] += mass, all += mass;
    }
    for (int k = 0; k < 3; ++k) found.within(formatted("share of island %d", k + 1), 1 / 3.0, in[k] / all, 0.2);
}

void strengthCase(Findings& found) {
    double last = 1;
    for (const float strength : {0.1f, 0.5f, 1.0f}) {
        Lab lab(0.0025f, 4000);
        const thawMaterialId m = lab.material(Lab::plain(1000, 0.5f));
        lab.plane({0, 0, 0}, {0.17f, 0.985f, 0}); // leans by 10 degrees
        lab.body(m, scene::makeBox({0.04f, 0.016f, 0.04f}), {0, 0.008f, 0}, Lab::kLiquid);
        const std::vector<Contour> disc{ellipse(0, 0, 0.035, 0.035)};
        addShape(lab, disc, [&](thawShapeDef& d) { d.strength = strength, d.sets = false; });
        lab.step(240);
        const double spill = Footprint(lab, disc, 0.3).spill;
        found.atMost(formatted("strength %g: of the footprint outside, share (the one before)", double(strength)), last,
                     spill);
        last = spill;
    }
    found.atMost("strength 1: of the footprint outside, share", 0.03, last);
}

// A path brings the melt into a shape; a thickness says when that has enough.
void pathCase(Findings& found) {
    Lab lab(0.0025f, 4000);
    const thawMaterialId m = lab.material(Lab::plain(1000, 0.5f));
    lab.floor();
    lab.body(m, scene::makeBox({0.03f, 0.012f, 0.03f}), {-0.1f, 0.006f, 0}, Lab::kLiquid);
    thawPathDef d;
    thawInitPathDef(&d);
    const thawVec3 line[2] = {{-0.11f, 0.003f, 0}, {0.02f, 0.003f, 0}};
    d.points = line, d.pointCount = 2, d.radius = 0.012f, d.reach = 0.05f, d.speed = 0.08f, d.strength = 0.95f;
    thawPathId path;
    if (thawCreatePath(lab.world(), &d, &path) != thawResult_ok) throw LabError(thawWorld_GetLastError(lab.world()));
    const std::vector<Contour> disc{ellipse(0, 0, 0.026, 0.026)};
    constexpr float kThick = 0.005f;
    const thawShapeId id = addShape(lab, disc, [](thawShapeDef& s) { s.thickness = kThick, s.reach = 0.02f; });
    lab.step(60 * 12);
    const thawShapeState s = stateOf(lab, id);
    thawPathState p;
    thawPath_GetState(lab.world(), path, &p);
    found.atLeast("a path leads into a disc: what came there of what it led, share", 0.9,
                  double(s.captured / p.captured));
    found.within("in the disc, g (its area times its thickness)", 1e3 * 1000 * double(s.size * kThick),
                 1e3 * double(s.inside), 0.1);
    found.atLeast("set of that, share", 0.95, double(s.set / s.inside));
}

} // namespace

CaseList shapeCases() {
    return {{"shape-smile", "a pat of butter on a hot plate fills a smiling face (outline, two eyes, a mouth) and sets",
             smileCase},
            {"shape-sphere", "liquid beside it gathers in a sphere that stands on the floor, and sets", sphereCase},
            {"shape-star", "the same in an upright star of five arms", starCase},
            {"shape-rest", "liquid fills a ring around a disc and is held there", restCase},
            {"shape-ledger", "momentum of a blob in free space against the ledger", ledgerCase},
            {"shape-wall", "a disc with a hole on a vertical wall", wallCase},
            {"shape-islands", "three discs, liquid on the middle one", islandsCase},
            {"shape-strength", "a disc on a plane that leans by 10 degrees: less is outside the stronger it is",
             strengthCase},
            {"shape-path", "a path that ends in a disc of a given thickness", pathCase}};
}

} // namespace thaw::player
