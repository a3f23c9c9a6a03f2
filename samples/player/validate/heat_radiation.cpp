// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// What heat sources give to a surface, against integrals over the sources that this file takes for itself, and who
// stands in the way.
#include "validate/hare.h"
#include "validate/heat_lab.h"
#include "validate/validate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>

namespace thaw::player {
namespace {

constexpr double kSigma = 5.670374419e-8; // W/(m^2 K^4)
constexpr double kAmbient = 300;          // K
constexpr float kSpacing = 0.005f;
constexpr float kTimeScale = 60; // a second of heat a step

using V = std::array<double, 3>;
V operator+(V a, V b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
V operator-(V a, V b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
V operator*(double s, V a) { return {s * a[0], s * a[1], s * a[2]}; }
double dot(V a, V b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
V vectorOf(const float* x) { return {double(x[0]), double(x[1]), double(x[2])}; }
thawVec3 narrow(V a) { return {float(a[0]), float(a[1]), float(a[2])}; }

double exitance(double kelvin) { return kSigma * (std::pow(kelvin, 4) - std::pow(kAmbient, 4)); }

// A patch of a Lambert source: what it gives to a surface at x that faces n, W/m^2, of its exitance.
double patch(V at, V normal, double area, V x, V n) {
    const V way = at - x;
    const double d2 = dot(way, way), here = dot(n, way), there = -dot(normal, way);
    return here > 0 && there > 0 ? here * there * area / (kPi * d2 * d2) : 0;
}
using Irradiance = std::function<double(V x, V n)>; // W/m^2

constexpr int kPatches = 120;                                       // along each direction of a source
Irradiance ofRectangle(V center, V axis, V u, V v, double kelvin) { // half edges
    return [=](V x, V n) {
        const double area = 4 * std::sqrt(dot(u, u) * dot(v, v)) / (kPatches * kPatches);
        double sum = 0;
        for (int i = 0; i < kPatches; ++i)
            for (int j = 0; j < kPatches; ++j)
                sum += patch(center + ((2 * i + 1.0) / kPatches - 1) * u + ((2 * j + 1.0) / kPatches - 1) * v, axis,
                             area, x, n);
        return exitance(kelvin) * sum;
    };
}
Irradiance ofDisc(V center, V axis, V u, V v, double kelvin) { // two radii
    return [=](V x, V n) {
        double sum = 0;
        for (int i = 0; i < kPatches; ++i) // rings of one area
            for (int j = 0; j < kPatches; ++j) {
                const double r = std::sqrt((i + 0.5) / kPatches), a = 2 * kPi * (j + 0.5) / kPatches;
                sum += patch(center + (r * std::cos(a)) * u + (r * std::sin(a)) * v, axis,
                             kPi * dot(u, u) / (kPatches * kPatches), x, n);
            }
        return exitance(kelvin) * sum;
    };
}
Irradiance ofSphere(V center, double radius, double kelvin) {
    return [=](V x, V n) {
        double sum = 0;
        for (int i = 0; i < kPatches; ++i)
            for (int j = 0; j < kPatches; ++j) {
                const double z = (2 * i + 1.0) / kPatches - 1, a = 2 * kPi * (j + 0.5) / kPatches,
                             s = std::sqrt(1 - z * z);
                const V out{s * std::cos(a), z, s * std::sin(a)};
                sum += patch(center + radius * out, out, 4 * kPi * radius * radius / (kPatches * kPatches), x, n);
            }
        return exitance(kelvin) * sum;
    };
}

// A black block of 0.1 x 0.02 x 0.1 m around the origin that neither conducts nor loses heat, its top at y = 0.01.
struct Plate {
    Plate() : lab(kSpacing, 4000, {0, 0, 0}, kTimeScale, 1) {
        thawWorld_SetAmbient(lab.world(), float(kAmbient), 0);
        thawMaterialDef d = stays(1000, 1000, 0);
        d.absorptivity = 1;
        lab.box(lab.material(d), {-0.05f, -0.01f, -0.05f}, {0.05f, 0.01f, 0.05f}, float(kAmbient));
    }
    thawHeatSourceId source(thawHeatSourceType type, const std::function<void(thawHeatSourceDef&)>& more) {
        thawHeatSourceDef d;
        thawInitHeatSourceDef(&d);
        d.type = type;
        more(d);
        return lab.source(d);
    }
    void wall(thawVec3 center, thawVec3 half) {
        thawColliderDef d;
        thawInitColliderDef(&d, thawCollider_box);
        d.position = center, d.size = half;
        lab.collider(d);
    }
    double absorbed() const {
        thawLedger l;
        thawWorld_GetLedger(lab.world(), &l);
        return l.absorbed;
    }
    // What particles took up in one step, J, where `of` holds; by id. Energies are temperatures: c is 1000 J/(kg K).
    struct Taken {
        V x;
        double joule;
    };
    std::vector<Taken> step(const std::function<bool(V)>& of) {
        std::map<uint32_t, double> before;
        thawParticleView p = lab.particles();
        for (int i = 0; i < p.count; ++i) before[p.ids[i]] = double(p.temperatures[i]);
        lab.step(1);
        p = lab.particles();
        std::vector<Taken> out;
        for (int i = 0; i < p.count; ++i) {
            const V x = vectorOf(p.positions + 4 * i);
            if (of(x))
                out.push_back(
                    {x, (double(p.temperatures[i]) - before[p.ids[i]]) * 1000 * double(p.velocities[4 * i + 3])});
        }
        return out;
    }
    Lab lab;
};

// The top, two spacings from its edges, and what of it the source really gives; and the underside. A second of heat.
void compare(Findings& found, Plate& plate, const std::string& name, const Irradiance& theory) {
    const double edge = 0.05 - 2.01 * double(kSpacing), area = double(kSpacing) * double(kSpacing);
    double expected = 0, got = 0, worst = 0, under = 0;
    int n = 0;
    for (const Plate::Taken& t : plate.step([](V) { return true; })) {
        if (t.x[1] < 0.01 - 0.9 * double(kSpacing)) {
            if (std::abs(t.x[0]) < edge && std::abs(t.x[2]) < edge) under += std::abs(t.joule);
            continue;
        }
        if (std::abs(t.x[0]) > edge || std::abs(t.x[2]) > edge) continue;
        const double e = theory({t.x[0], 0.01, t.x[2]}, {0, 1, 0});
        expected += e, got += t.joule / area, ++n;
        worst = std::max(worst, std::abs(t.joule / area - e) / std::abs(e));
    }
    found.within(name + ": mean irradiance, W/m^2", expected / n, got / n, 0.03);
    found.atMost(name + ": largest error of a particle", 0.03, worst);
    found.atMost(name + ": on the underside, J", 0, under);
}

// The side at x = 0.05, away from its edges: the source stands beside it and its own plane cuts it.
void compareSide(Findings& found, Plate& plate, const std::string& name, const Irradiance& theory) {
    const double edge = 0.05 - 2.01 * double(kSpacing), area = double(kSpacing) * double(kSpacing);
    double expected = 0, got = 0;
    int n = 0;
    for (const Plate::Taken& t : plate.step([&](V x) {
             return x[0] > 0.05 - 0.9 * double(kSpacing) && std::abs(x[2]) < edge &&
                    std::abs(x[1]) < 0.01 - double(kSpacing);
         }))
        expected += theory({0.05, t.x[1], t.x[2]}, {1, 0, 0}), got += t.joule / area, ++n;
    found.within(name + ", cut by the horizon: mean, W/m^2", expected / n, got / n, 0.03);
}

const thawQuat kDown{1, 0, 0, 0};

void point(Findings& found) {
    Plate plate;
    const V at{0.03, 0.15, -0.02};
    plate.source(thawHeatSource_point, [&](thawHeatSourceDef& d) { d.position = narrow(at), d.power = 60; });
    compare(found, plate, "60 W", [&](V x, V n) {
        const V way = at - x;
        const double d = std::sqrt(dot(way, way));
        return 60 * std::max(0.0, dot(n, way)) / (4 * kPi * d * d * d);
    });
}

void directional(Findings& found) {
    Plate plate;
    // 60 degrees from the vertical.
    plate.source(thawHeatSource_directional, [](thawHeatSourceDef& d) {
        d.rotation = turnTo({0, 1, 0}, {0.866025404f, -0.5f, 0}), d.irradiance = 900;
    });
    compare(found, plate, "900 W/m^2 at 60 degrees", [](V, V) { return 450.0; });
}

void sphere(Findings& found) {
    const auto flame = [](Plate& plate, V at) {
        plate.source(thawHeatSource_sphere,
                     [&](thawHeatSourceDef& d) { d.position = narrow(at), d.radius = 0.06f, d.temperature = 1100; });
    };
    Plate over, beside;
    flame(over, {0.02, 0.11, 0.01}), compare(found, over, "0.06 m at 1100 K", ofSphere({0.02, 0.11, 0.01}, 0.06, 1100));
    flame(beside, {0.07, 0.12, 0}),
        compareSide(found, beside, "0.06 m at 1100 K", ofSphere({0.07, 0.12, 0}, 0.06, 1100));
}

void rectangle(Findings& found) {
    const auto heater = [](Plate& plate, V at) {
        plate.source(thawHeatSource_rectangle, [&](thawHeatSourceDef& d) {
            d.position = narrow(at), d.rotation = kDown, d.size = {0.08f, 0, 0.05f}, d.temperature = 1000;
        });
    };
    const auto theory = [](V at) { return ofRectangle(at, {0, -1, 0}, {0.08, 0, 0}, {0, 0, 0.05}, 1000); };
    Plate over, beside;
    heater(over, {0.03, 0.07, 0}), compare(found, over, "0.16 x 0.1 m at 1000 K", theory({0.03, 0.07, 0}));
    heater(beside, {0.06, 0.07, 0}), compareSide(found, beside, "0.16 x 0.1 m at 1000 K", theory({0.06, 0.07, 0}));
}

void disc(Findings& found) {
    const auto plateOf = [](Plate& plate, V at) {
        plate.source(thawHeatSource_disc, [&](thawHeatSourceDef& d) {
            d.position = narrow(at), d.rotation = kDown, d.radius = 0.07f, d.temperature = 1000;
        });
    };
    const auto theory = [](V at) { return ofDisc(at, {0, -1, 0}, {0.07, 0, 0}, {0, 0, 0.07}, 1000); };
    Plate over, beside;
    plateOf(over, {0.03, 0.07, 0}), compare(found, over, "0.07 m at 1000 K", theory({0.03, 0.07, 0}));
    plateOf(beside, {0.06, 0.07, 0}), compareSide(found, beside, "0.07 m at 1000 K", theory({0.06, 0.07, 0}));
}

void cold(Findings& found) {
    Plate plate;
    plate.source(thawHeatSource_disc, [](thawHeatSourceDef& d) {
        d.position = {0, 0.07f, 0}, d.rotation = kDown, d.radius = 0.07f, d.temperature = 77;
    });
    compare(found, plate, "0.07 m at 77 K, cools", ofDisc({0, 0.07, 0}, {0, -1, 0}, {0.07, 0, 0}, {0, 0, 0.07}, 77));
}

// Screens hard by the source that hide its half, a quarter and all of it.
void cover(Findings& found) {
    constexpr float kHeight = 0.2f, kRadius = 0.06f;
    struct Kind {
        thawHeatSourceType type;
        const char* name;
        float screen; // m, height of the screen
    };
    for (const Kind& k : {Kind{thawHeatSource_sphere, "sphere", kHeight - kRadius - 0.001f},
                          Kind{thawHeatSource_rectangle, "rectangle", kHeight - 0.001f},
                          Kind{thawHeatSource_disc, "disc", kHeight - 0.001f}}) {
        const auto run = [&](float from, float sideways) {
            Plate plate;
            plate.source(k.type, [&](thawHeatSourceDef& d) {
                d.position = {0, kHeight, 0}, d.rotation = kDown, d.radius = kRadius, d.size = {kRadius, 0, kRadius};
                d.temperature = 1200;
            });
            if (from < 1) plate.wall({from + 1, k.screen, 0}, {1, 0.0002f, 1});
            if (sideways < 1) plate.wall({0, k.screen - 0.0004f, sideways + 1}, {1, 0.0002f, 1});
            plate.lab.step(1);
            return plate.absorbed();
        };
        const double open = run(1, 1);
        const std::string name = k.name;
        found.within(name + ": half of it hidden, share", 0.5, run(0, 1) / open, 0.03);
        found.within(name + ": three quarters hidden, share", 0.25, run(0, 0) / open, 0.03);
        found.atMost(name + ": all of it hidden, J", 0, run(-0.5f, 1));
    }
}

// Height of a body over the plane that light falls through, along the light: what is lower is in the dark.
struct DepthMap {
    static constexpr double kCell = 0.0005; // m
    static constexpr int kSize = 600;
    std::vector<double> height = std::vector<double>(size_t(kSize) * kSize, -1e9);
    V to, u, v; // the light's origin, and two directions at right angles
    int cell(double x) const { return std::clamp(int(std::floor(x / kCell)) + kSize / 2, 0, kSize - 1); }
    double& at(V x) { return height[size_t(cell(dot(u, x))) * kSize + size_t(cell(dot(v, x)))]; }
    void add(const scene::TriMesh& mesh) {
        for (size_t t = 0; t < mesh.triangleCount(); ++t) {
            const auto corner = [&](size_t k) { return vectorOf(mesh.vertices.data() + 3 * mesh.indices[3 * t + k]); };
            const V a = corner(0), b = corner(1) - a, c = corner(2) - a;
            const int n = 1 + int(2 * std::sqrt(std::max(dot(b, b), dot(c, c))) / kCell);
            for (int i = 0; i <= n; ++i)
                for (int j = 0; i + j <= n; ++j) {
                    const V x = a + (double(i) / n) * b + (double(j) / n) * c;
                    at(x) = std::max(at(x), dot(to, x));
                }
        }
    }
    // Does nothing within `reach` of the way to the light stand higher than that over it?
    bool open(V x, double reach) {
        const int r = int(reach / kCell);
        for (int i = -r; i <= r; ++i)
            for (int j = -r; j <= r; ++j)
                if (at(x + (i * kCell) * u + (j * kCell) * v) > dot(to, x) + 2 * reach) return false;
        return true;
    }
    // Is everything within `reach` of the way to the light covered by what stands higher than that?
    bool dark(V x, double reach) {
        const int r = int(reach / kCell);
        for (int i = -r; i <= r; ++i)
            for (int j = -r; j <= r; ++j)
                if (at(x + (i * kCell) * u + (j * kCell) * v) < dot(to, x) + 2 * reach) return false;
        return true;
    }
};

void darkSide(Findings& found, const char* name, const scene::TriMesh& mesh, V light) {
    const double l = std::sqrt(dot(light, light));
    DepthMap map;
    map.to = (1 / l) * light;
    map.u = {map.to[2], 0, -map.to[0]};
    map.u = (1 / std::sqrt(dot(map.u, map.u))) * map.u;
    map.v = {map.to[1] * map.u[2] - map.to[2] * map.u[1], map.to[2] * map.u[0] - map.to[0] * map.u[2],
             map.to[0] * map.u[1] - map.to[1] * map.u[0]};
    map.add(mesh);
    constexpr float kFine = 0.0025f;
    Lab lab(kFine, 40000, {0, 0, 0}, kTimeScale, 1);
    thawWorld_SetAmbient(lab.world(), float(kAmbient), 0);
    thawMaterialDef d = stays(1000, 1000, 0);
    d.absorptivity = 1;
    lab.body(lab.material(d), mesh, {0, 0, 0}, float(kAmbient));
    thawHeatSourceDef sun;
    thawInitHeatSourceDef(&sun);
    sun.type = thawHeatSource_directional, sun.irradiance = 1000;
    sun.rotation = turnTo({0, 1, 0}, narrow(-1 * map.to));
    lab.source(sun);
    lab.step(1);
    const thawParticleView p = lab.particles();
    double dark = 0, lit = 0, caught = 0;
    int away = 0, shaded = 0;
    for (int i = 0; i < p.count; ++i) {
        if (!(p.flags[i] & thawParticle_surface)) continue;
        const V x = vectorOf(p.positions + 4 * i), n = vectorOf(p.normals + 4 * i);
        const double joule = (double(p.temperatures[i]) - kAmbient) * 1000 * double(p.velocities[4 * i + 3]);
        const bool turned = dot(n, map.to) < -0.05,
                   hidden = !turned && dot(n, map.to) > 0.2 && map.dark(x, double(kFine));
        if (turned || hidden) dark += joule;
        away += turned, shaded += hidden;
        // Surely lit: nothing higher within a spacing and a half of its way.
        if (dot(n, map.to) > 0.2 && map.open(x, 1.5 * double(kFine)))
            lit += joule, caught += 1000 * dot(n, map.to) * double(p.normals[4 * i + 3]);
    }
    const std::string of = name;
    found.atMost(of + ": what the dark side took up, J", 0, dark);
    found.atLeast(of + ": particles that face away", 500, away);
    found.atLeast(of + ": that face the light, shaded by the body", 40, shaded);
    found.within(of + ": what the lit side took up, J", caught, lit, 0.03);
}

void darkSides(Findings& found) {
    darkSide(found, "torus", scene::makeTorus(0.05f, 0.015f), {0.9, 0.25, 0.3});
    darkSide(found, "hare", makeHare(), {0.6, 0.7, -0.4});
    // The Stanford scan, where the package glmark2-data put it.
    const char* file = "/usr/share/glmark2/models/bunny.obj";
    if (!std::filesystem::exists(file)) return;
    scene::TriMesh bunny = scene::importMesh(file);
    const scene::Bounds b = scene::boundsOf(bunny);
    const float scale = 0.1f / (b.upper.x - b.lower.x);
    for (size_t k = 0; k < bunny.vertices.size(); ++k) {
        const float center[3] = {0.5f * (b.lower.x + b.upper.x), 0.5f * (b.lower.y + b.upper.y),
                                 0.5f * (b.lower.z + b.upper.z)};
        bunny.vertices[k] = scale * (bunny.vertices[k] - center[k % 3]);
    }
    darkSide(found, "bunny", bunny, {0.8, 0.5, -0.3});
}

} // namespace

CaseList radiationCases() {
    return {{"radiation-point", "plate under a lamp: inverse square times cosine", point},
            {"radiation-directional", "plate in slanting light", directional},
            {"radiation-sphere", "plate under and beside a hot ball: integral over its surface", sphere},
            {"radiation-rectangle", "plate under and beside a heater: integral over its surface", rectangle},
            {"radiation-disc", "plate under and beside a hot disc: integral over its surface", disc},
            {"radiation-cold", "plate under a disc colder than ambient: loses what it no longer gets", cold},
            {"radiation-cover", "screens that hide a half, three quarters and all of a source", cover},
            {"radiation-dark", "bodies in sunlight: nothing where they shade themselves", darkSides}};
}

} // namespace thaw::player
