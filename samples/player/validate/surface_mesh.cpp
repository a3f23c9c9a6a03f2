// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "report.h"
#include "validate/lab.h"
#include "validate/mesh_of.h"
#include "validate/validate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace thaw::player {
namespace {

double volumeOfMelt(const Lab& lab, float density) {
    const thawParticleView p = lab.particles();
    double mass = 0;
    for (int i = 0; i < p.count; ++i) mass += double(p.velocities[4 * i + 3]);
    return mass / double(density);
}

// Nearest point of a triangle (Ericson, Real-Time Collision Detection, 5.1.5).
double distance2(const Point& p, const Point& a, const Point& b, const Point& c) {
    const Point ab = b - a, ac = c - a, ap = p - a;
    const auto to = [&](double u, double v) {
        const Point d{ap[0] - u * ab[0] - v * ac[0], ap[1] - u * ab[1] - v * ac[1], ap[2] - u * ab[2] - v * ac[2]};
        return dot(d, d);
    };
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return to(0, 0);
    const Point bp = p - b;
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return to(1, 0);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return to(d1 / (d1 - d3), 0);
    const Point cp = p - c;
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return to(0, 1);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return to(0, d2 / (d2 - d6));
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double w = (d4 - d3) / (d4 - d3 + d5 - d6);
        return to(1 - w, w);
    }
    const double s = 1 / (va + vb + vc);
    return to(vb * s, vc * s);
}

// Farthest point of one mesh from the other, with the triangles of the other in cells.
double farthest(const std::vector<Point>& from, const std::vector<Point>& points,
                const std::vector<std::array<uint32_t, 3>>& triangles, double cell) {
    std::map<std::array<int, 3>, std::vector<size_t>> cells;
    const auto key = [&](const Point& x) {
        return std::array<int, 3>{int(std::floor(x[0] / cell)), int(std::floor(x[1] / cell)),
                                  int(std::floor(x[2] / cell))};
    };
    for (size_t t = 0; t < triangles.size(); ++t) {
        Point low = points[triangles[t][0]], high = low;
        for (const uint32_t v : triangles[t])
            for (size_t a = 0; a < 3; ++a)
                low[a] = std::min(low[a], points[v][a]), high[a] = std::max(high[a], points[v][a]);
        const auto from0 = key(low), to = key(high);
        for (int x = from0[0]; x <= to[0]; ++x)
            for (int y = from0[1]; y <= to[1]; ++y)
                for (int z = from0[2]; z <= to[2]; ++z) cells[{x, y, z}].push_back(t);
    }
    double worst = 0;
    for (const Point& x : from) {
        double best = cell * cell; // none is farther than its cell says
        const auto at = key(x);
        for (int dx = -1; dx <= 1; ++dx)
            for (int dy = -1; dy <= 1; ++dy)
                for (int dz = -1; dz <= 1; ++dz) {
                    const auto found = cells.find({at[0] + dx, at[1] + dy, at[2] + dz});
                    if (found == cells.end()) continue;
                    for (const size_t t : found->second)
                        best = std::min(best, distance2(x, points[triangles[t][0]], points[triangles[t][1]],
                                                        points[triangles[t][2]]));
                }
        worst = std::max(worst, best);
    }
    return std::sqrt(worst);
}

constexpr float kSpacing = 0.0025f;

// A solid of plain material, cold, on nothing: nobody steps it.
struct Still {
    Lab lab;
    thawMaterialId material;
    explicit Still(int most = 40000) : lab(kSpacing, most), material(lab.material(Lab::plain(1000, 1))) {}
};

void sphere(Findings& found) {
    Still s;
    s.lab.body(s.material, scene::makeSphere(0.02f), {0, 0, 0}, Lab::kSolid);
    const Mesh m(s.lab.surface());
    found.atMost("ball of 20 mm: mean distance of the surface, spacings", 0.25,
                 m.mean([](const Point& x) { return std::sqrt(dot(x, x)) - 0.02; }) / double(kSpacing));
    found.within("enclosed, cm^3", 1e6 * volumeOfMelt(s.lab, 1000), 1e6 * m.volume(), 0.03);
}

double toBox(const Point& x, const Point& half) {
    Point q;
    for (size_t a = 0; a < 3; ++a) q[a] = std::abs(x[a]) - half[a];
    const double inside = std::min(0.0, std::max({q[0], q[1], q[2]}));
    double out = 0;
    for (const double v : q) out += v > 0 ? v * v : 0;
    return std::sqrt(out) + inside;
}

void cube(Findings& found) {
    Still s;
    s.lab.body(s.material, scene::makeBox({0.03f, 0.03f, 0.03f}), {0, 0, 0}, Lab::kSolid);
    const Mesh m(s.lab.surface());
    found.atMost("cube of 30 mm: mean distance of the surface, spacings", 0.25, m.mean([](const Point& x) {
        return toBox(x, {0.015, 0.015, 0.015});
    }) / double(kSpacing));
    found.within("enclosed, cm^3", 1e6 * volumeOfMelt(s.lab, 1000), 1e6 * m.volume(), 0.03);
    // Of its faces, away from the edges.
    double worst = 0;
    for (const Point& x : m.points)
        for (size_t a = 0; a < 3; ++a) {
            const double u = std::abs(x[(a + 1) % 3]), v = std::abs(x[(a + 2) % 3]);
            if (std::max(u, v) < 0.015 - 3 * double(kSpacing) && std::abs(std::abs(x[a]) - 0.015) < double(kSpacing))
                worst = std::max(worst, std::abs(std::abs(x[a]) - 0.015));
        }
    found.atMost("bump of its faces, spacings", 0.1, worst / double(kSpacing));
}

void sheet(Findings& found) {
    Still s;
    const float thick = 2 * kSpacing;
    s.lab.body(s.material, scene::makeBox({0.06f, thick, 0.06f}), {0, 0, 0}, Lab::kSolid);
    const Mesh m(s.lab.surface());
    found.atMost("sheet of two spacings: mean distance of the surface, spacings", 0.25, m.mean([&](const Point& x) {
        return toBox(x, {0.03, 0.5 * double(thick), 0.03});
    }) / double(kSpacing));
    found.within("pieces", 1, m.pieces(), 0);
    found.within("enclosed, cm^3", 1e6 * volumeOfMelt(s.lab, 1000), 1e6 * m.volume(), 0.03);
}

void beads(Findings& found) {
    Still s;
    constexpr int kBeads = 12;
    for (int k = 0; k < kBeads; ++k)
        s.lab.body(s.material, scene::makeBox({kSpacing, kSpacing, kSpacing}), {3 * kSpacing * float(k), 0, 0},
                   Lab::kSolid);
    const Mesh m(s.lab.surface());
    const double radius = std::cbrt(3 / (4 * kPi)) * double(kSpacing);
    found.within("single particles three spacings apart: pieces", kBeads, m.pieces(), 0);
    found.atMost("mean distance from balls of their volume, spacings", 0.25, m.mean([&](const Point& x) {
        const double at = std::clamp(std::round(x[0] / (3 * double(kSpacing))), 0.0, kBeads - 1.0);
        const Point d{x[0] - 3 * double(kSpacing) * at, x[1], x[2]};
        return std::sqrt(dot(d, d)) - radius;
    }) / double(kSpacing));
}

// Half of a coarse block is split: two levels side by side in its flat faces.
void levels(Findings& found) {
    Still s;
    const thawBodyId id = s.lab.body(s.material, scene::makeBox({0.08f, 0.04f, 0.04f}), {0, 0, 0}, Lab::kSolid,
                                     [](thawBodyDef& d) { d.coarsestLevel = 3; });
    const thawBrush brush{{0.04f, 0, 0}, 0.03f, 0};
    if (thawBody_PaintTemperature(s.lab.world(), id, &brush, Lab::kSolid + 1, nullptr) != thawResult_ok)
        throw LabError("not painted");
    const thawCounters c = s.lab.counters();
    found.atLeast("coarse block, painted at one end: fine particles, share", 0.2,
                  double(c.levels[0]) / double(c.particles));
    found.atLeast("coarse ones", 100, c.levels[3]);
    const Mesh m(s.lab.surface());
    double worst = 0;
    for (const Point& x : m.points)
        if (std::abs(x[0]) < 0.03 && std::abs(x[2]) < 0.012) worst = std::max(worst, std::abs(std::abs(x[1]) - 0.02));
    found.atMost("bump in its flat faces, spacings", 0.1, worst / double(kSpacing));
}

// A pool whose middle has merged: the same for a liquid.
void liquidLevels(Findings& found) {
    Lab lab(kSpacing, 40000);
    const thawMaterialId m = lab.material(Lab::plain(1000, 0.5f));
    lab.tank({-0.04f, 0, -0.03f}, {0.04f, 0.1f, 0.03f});
    lab.body(m, scene::makeBox({0.08f, 0.04f, 0.06f}), {0, 0.02f, 0}, Lab::kLiquid,
             [](thawBodyDef& d) { d.coarsestLevel = 2; });
    lab.step(240);
    const thawCounters c = lab.counters();
    found.atLeast("pool with levels after 4 s: coarse particles", 100, c.levels[1] + c.levels[2] + c.levels[3]);
    const Mesh mesh(lab.surface());
    double sum = 0, n = 0, square = 0;
    for (const Point& x : mesh.points)
        if (std::abs(x[0]) < 0.03 && std::abs(x[2]) < 0.02 && x[1] > 0.03) sum += x[1], square += x[1] * x[1], n += 1;
    found.atMost("roughness of its surface, rms, spacings", 0.1,
                 n > 0 ? std::sqrt(std::max(0.0, square / n - sum * sum / n / n)) / double(kSpacing) : 1);
    found.within("enclosed, cm^3", 1e6 * volumeOfMelt(lab, 1000), 1e6 * mesh.volume(), 0.03);
}

// Every tenth frame of a melt.
void melting(Findings& found) {
    Lab lab(0.0025f, 30000, {0, -9.81f, 0}, 30);
    thawMaterialDef wax;
    thawInitMaterialDef(&wax, thawMaterial_wax);
    wax.viscosityLiquid = 0.1f, wax.cohesion = 4;
    const thawMaterialId m = lab.material(wax);
    lab.floor();
    lab.body(m, scene::makeCandle(), {0, 0, 0}, 311.15f);
    thawHeatSourceDef flame;
    thawInitHeatSourceDef(&flame);
    flame.position = {0.0022f, 0.1335f, -0.0009f}, flame.power = 700, flame.radius = 0.003f;
    lab.source(flame);
    int open = 0, tangled = 0;
    double worst = 0;
    lab.step(600, [&](int f) {
        if (f % 10) return;
        const Mesh mesh(lab.surface());
        int o = 0, t = 0;
        mesh.faults(o, t);
        open += o, tangled += t;
        worst = std::max(worst, std::abs(mesh.volume() / volumeOfMelt(lab, wax.density) - 1));
    });
    found.atMost("candle, every 10th frame of 10 s: edges with one triangle", 0, open);
    found.atMost("edges with more than two", 0, tangled);
    found.atMost("enclosed volume against the particles', worst, share", 0.03, worst);
}

void still(Findings& found) {
    Lab lab(kSpacing, 20000);
    const thawMaterialId m = lab.material(Lab::plain(1000, 1));
    lab.floor();
    lab.body(m, scene::makeCandle(), {0, 0, 0}, Lab::kSolid);
    lab.step(1);
    const Mesh before(lab.surface());
    int moved = 0;
    lab.step(60, [&](int) {
        const Mesh now(lab.surface());
        moved += now.points != before.points || now.triangles != before.triangles;
    });
    found.atMost("body at rest, 60 frames: those whose mesh is another", 0, moved);
}

void scanned(Findings& found) {
    Still s;
    const scene::TriMesh candle = scene::makeCandle();
    s.lab.body(s.material, candle, {0, 0, 0}, Lab::kSolid);
    const Mesh m(s.lab.surface());
    std::vector<Point> points;
    std::vector<std::array<uint32_t, 3>> triangles;
    for (size_t v = 0; v < candle.vertices.size(); v += 3)
        points.push_back({double(candle.vertices[v]), double(candle.vertices[v + 1]), double(candle.vertices[v + 2])});
    for (size_t t = 0; t < candle.indices.size(); t += 3)
        triangles.push_back({candle.indices[t], candle.indices[t + 1], candle.indices[t + 2]});
    const double cell = 2 * double(kSpacing);
    found.atMost("candle's mesh, filled and meshed again: farthest of the new from the old, spacings", 0.7,
                 farthest(m.points, points, triangles, cell) / double(kSpacing));
    found.atMost("farthest of the old from the new, spacings", 0.7,
                 farthest(points, m.points, m.triangles, cell) / double(kSpacing));
}

} // namespace

CaseList meshCases() {
    return {{"mesh-sphere", "a ball filled and meshed", sphere},
            {"mesh-cube", "a cube filled and meshed", cube},
            {"mesh-sheet", "a sheet of two layers", sheet},
            {"mesh-beads", "a string of single particles", beads},
            {"mesh-levels", "a solid of two levels side by side", levels},
            {"mesh-pool", "a pool whose middle is coarse", liquidLevels},
            {"mesh-melting", "the sample candle melts: closed, and of its volume", melting},
            {"mesh-still", "what rests has the same mesh", still},
            {"mesh-scanned", "Hausdorff distance of a mesh and what is made of it", scanned}};
}

} // namespace thaw::player
