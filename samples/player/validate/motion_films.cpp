// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "report.h"
#include "validate/layer.h"
#include "validate/validate.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace thaw::player {
namespace {

void inclineFilm(Findings& found) {
    struct Case {
        float spacing;
        int layers;
        float viscosity;
        double degrees;
    };
    for (const Case c : {Case{0.002f, 3, 3, 30}, Case{0.002f, 6, 5, 30}, Case{0.004f, 4, 10, 60},
                         Case{0.004f, 6, 20, 30}, Case{0.004f, 8, 40, 90}}) {
        thawMaterialDef m = Lab::plain(1000, c.viscosity);
        m.adhesion = c.degrees > 80 ? 0.5f : 0;
        const double slope = c.degrees * kPi / 180;
        // Until what is left of the stiffness that it is born with is below 1 %.
        Layer film(m, c.spacing, c.layers, slope, 128, 12, true);
        film.lab.step(75);
        double speed = 0, theory = 0;
        constexpr int kFrames = 20;
        film.lab.step(kFrames, [&](int) {
            const Layer::Middle now = film.middle(0.5 * film.length);
            speed += now.surface / kFrames;
            theory += 1000 * kG * std::sin(slope) * now.thickness * now.thickness /
                      (2 * static_cast<double>(c.viscosity)) / kFrames;
        });
        found.within(formatted("%g mm, %d layers, %g Pa s, %g deg: m/s", static_cast<double>(c.spacing) * 1e3, c.layers,
                               static_cast<double>(c.viscosity), c.degrees),
                     theory, speed, 0.10);
    }
}

// Sphericity pi^(1/3) (6 V)^(2/3) / A of the extracted surface: 1 for a sphere, 0.806 for a cube.
double sphericity(const Lab& lab) {
    const thawSurfaceView s = lab.surface();
    double volume = 0, area = 0;
    for (int t = 0; t < s.triangleCount; ++t) {
        double v[3][3];
        for (int k = 0; k < 3; ++k)
            for (int a = 0; a < 3; ++a)
                v[k][a] = static_cast<double>(s.positions[3 * s.indices[3 * t + k] + static_cast<uint32_t>(a)]);
        double e[3], f[3], n[3];
        for (int a = 0; a < 3; ++a) e[a] = v[1][a] - v[0][a], f[a] = v[2][a] - v[0][a];
        for (int a = 0; a < 3; ++a) n[a] = e[(a + 1) % 3] * f[(a + 2) % 3] - e[(a + 2) % 3] * f[(a + 1) % 3];
        area += 0.5 * lengthOf(n);
        for (int a = 0; a < 3; ++a) volume += v[0][a] * n[a] / 6;
    }
    return std::cbrt(kPi) * std::pow(6 * volume, 2.0 / 3) / area;
}

void roundDrop(Findings& found) {
    struct Case {
        float spacing, viscosity, seconds;
    };
    for (const Case c : {Case{0.002f, 0.1f, 4}, Case{0.002f, 1, 10}, Case{0.004f, 0.1f, 4}, Case{0.004f, 1, 10}}) {
        Lab lab(c.spacing, 4000, {0, 0, 0});
        thawMaterialDef m = Lab::plain(1000, c.viscosity);
        m.cohesion = 6;
        const float half = 6 * c.spacing;
        lab.box(lab.material(m), {-half, -half, -half}, {half, half, half}, Lab::kLiquid, [](thawBodyDef& d) {
            d.velocity = {0.05f, 0.02f, 0};
        });
        const Momentum before = momentumOf(lab.particles());
        const double start = sphericity(lab);
        lab.step(static_cast<int>(60 * c.seconds));
        const double end = sphericity(lab);
        const Momentum after = momentumOf(lab.particles());
        double p[3];
        for (int k = 0; k < 3; ++k) p[k] = after.p[k] - before.p[k];
        const std::string name =
            formatted("%g mm, %g Pa s: ", static_cast<double>(c.spacing) * 1e3, static_cast<double>(c.viscosity));
        found.atMost(name + "sphericity at the start", 0.90, start);
        found.atLeast(name + "sphericity", 0.95, end);
        found.atMost(name + "linear momentum, change / whole", 1e-5, lengthOf(p) / lengthOf(before.p));
    }
}

void yieldFilm(Findings& found) {
    struct Case {
        float spacing;
        int layers;
        thawFlow flow;
        float viscosity, yieldStress;
        double degrees;
    };
    for (const Case c : {Case{0.003f, 6, thawFlow_bingham, 2, 60, 30}, Case{0.003f, 6, thawFlow_casson, 0.25f, 60, 30},
                         Case{0.0015f, 7, thawFlow_bingham, 8.7f, 36, 30}}) {
        thawMaterialDef m = Lab::plain(1000, c.viscosity);
        m.yieldStress = c.yieldStress, m.flow = c.flow;
        m.adhesion = c.degrees > 80 ? 0.5f : 0;
        const double slope = c.degrees * kPi / 180;
        Layer film(m, c.spacing, c.layers, slope, 44, 20, false);
        const double theory = static_cast<double>(c.yieldStress) / (1000 * kG * std::sin(slope)),
                     at = 12 * film.spacing;
        film.lab.step(c.viscosity > 5 ? 960 : 720);
        const Layer::Middle end = film.middle(at);
        const std::string name = formatted("%s %g Pa, %g deg: ", c.flow == thawFlow_casson ? "Casson" : "Bingham",
                                           static_cast<double>(c.yieldStress), c.degrees);
        found.within(name + "thickness, m", theory, end.thickness, 0.15);
        found.atMost(name + "speed at the end, m/s", 1e-3, std::abs(end.mean));
    }
}

// Turns a closed loop of (radius, height) points, counter-clockwise in that plane, about the y axis.
scene::TriMesh ring(const std::vector<scene::ProfilePoint>& loop) {
    constexpr int kSegments = 64;
    scene::TriMesh mesh;
    const int n = static_cast<int>(loop.size());
    for (int k = 0; k < kSegments; ++k) {
        const double angle = 2 * kPi * k / kSegments;
        for (const scene::ProfilePoint& q : loop)
            mesh.addVertex(q.radius * std::cos(angle), q.height, q.radius * std::sin(angle));
    }
    for (int k = 0; k < kSegments; ++k)
        for (int i = 0; i < n; ++i) {
            const auto at = [&](int s, int q) { return static_cast<uint32_t>((k + s) % kSegments * n + (i + q) % n); };
            mesh.addTriangle(at(0, 0), at(0, 1), at(1, 1)), mesh.addTriangle(at(0, 0), at(1, 1), at(1, 0));
        }
    return mesh;
}

// Share of the particles that hang together, nearer than 1.6 spacings, with none that is within 1.3 of the wall.
double detached(const Lab& lab, const std::function<double(const float*)>& distance) {
    const thawParticleView p = lab.particles();
    std::vector<int> open, reached(static_cast<size_t>(p.count), 0);
    const float link = 1.6f * lab.spacing();
    for (int i = 0; i < p.count; ++i)
        if (distance(p.positions + 4 * i) < 1.3 * static_cast<double>(lab.spacing()))
            open.push_back(i), reached[static_cast<size_t>(i)] = 1;
    size_t on = open.size();
    while (!open.empty()) {
        const float* x = p.positions + 4 * open.back();
        open.pop_back();
        for (int j = 0; j < p.count; ++j) {
            const float* y = p.positions + 4 * j;
            const float a = x[0] - y[0], b = x[1] - y[1], c = x[2] - y[2];
            if (reached[static_cast<size_t>(j)] || a * a + b * b + c * c > link * link) continue;
            reached[static_cast<size_t>(j)] = 1, open.push_back(j), ++on;
        }
    }
    return 1 - static_cast<double>(on) / p.count;
}

void clingingFilm(Findings& found) {
    enum Shape { kWall, kCylinder, kSphere };
    const char* names[] = {"wall", "cylinder", "sphere"};
    for (const Shape shape : {kWall, kCylinder, kSphere})
        for (const float dx : {0.002f, 0.004f}) {
            double worst = 0, ratio = 0;
            for (const float mu : {0.05f, 0.3f, 1.0f, 10.0f})
                for (const int layers : {2, 3}) {
                    Lab lab(dx, 4000);
                    const float foot = shape == kSphere ? -10 * dx : -16 * dx;
                    lab.floor(foot);
                    const double d = static_cast<double>(dx), R = 10 * d, H = layers * d;
                    thawMaterialDef m = Lab::plain(1000, mu);
                    m.cohesion = 6, m.adhesion = 0.5f;
                    const thawMaterialId id = lab.material(m);
                    std::function<double(const float*)> distance;
                    if (shape == kWall) {
                        lab.plane({0, 0, 0}, {1, 0, 0});
                        lab.box(id, {0, 0, -8 * dx}, {static_cast<float>(H), 24 * dx, 8 * dx}, Lab::kLiquid);
                        distance = [](const float* x) { return static_cast<double>(x[0]); };
                    } else if (shape == kCylinder) {
                        thawColliderDef c;
                        thawInitColliderDef(&c, thawCollider_mesh);
                        const scene::TriMesh post = scene::makeCylinder(static_cast<float>(R), 200 * dx);
                        c.mesh = post.view();
                        c.position = {0, -75 * dx, 0};
                        lab.collider(c);
                        lab.body(id, ring({{R, 0}, {R + H, 0}, {R + H, 12 * d}, {R, 12 * d}}), {0, 0, 0}, Lab::kLiquid);
                        distance = [=](const float* x) {
                            return std::hypot(static_cast<double>(x[0]), static_cast<double>(x[2])) - R;
                        };
                    } else {
                        thawColliderDef c;
                        thawInitColliderDef(&c, thawCollider_sphere);
                        c.size = {10 * dx, 0, 0};
                        lab.collider(c);
                        std::vector<scene::ProfilePoint> loop;
                        for (int k = 0; k <= 12; ++k) {
                            const double a = kPi / 2 * (0.15 + 0.85 * k / 12);
                            loop.push_back({R * std::sin(a), R * std::cos(a)});
                        }
                        for (int k = 12; k >= 0; --k) {
                            const double a = kPi / 2 * (0.15 + 0.85 * k / 12);
                            loop.push_back({(R + H) * std::sin(a), (R + H) * std::cos(a)});
                        }
                        lab.body(id, ring(loop), {0, 0, 0}, Lab::kLiquid);
                        distance = [=](const float* x) {
                            return std::hypot(static_cast<double>(x[0]), static_cast<double>(x[1]),
                                              static_cast<double>(x[2])) -
                                   R;
                        };
                    }
                    const auto nearest = [=](const float* x) {
                        return std::min(distance(x), static_cast<double>(x[1] - foot));
                    };
                    // Where the film gathers it is thicker, and may be faster by that.
                    double fastest = 0, off = 0, thick = H, film = 0;
                    const double fall = std::sqrt(2 * kG * (shape == kCylinder ? 28 : shape == kWall ? 40 : 22) * d);
                    lab.step(240, [&](int f) {
                        // The lattice settles on the wall within the first tenth of a second.
                        if (f > 6) fastest = std::max(fastest, static_cast<double>(lab.counters().maxSpeed));
                        const thawParticleView p = lab.particles();
                        for (int i = 0; i < p.count; ++i) {
                            const double away = distance(p.positions + 4 * i);
                            if (static_cast<double>(p.positions[4 * i + 1] - foot) > 5 * d && away < 6 * d)
                                thick = std::max(thick, away + 0.5 * d);
                        }
                        if (f % 30 == 0) off = std::max(off, detached(lab, nearest));
                    });
                    film = 1000 * kG * thick * thick / (2 * static_cast<double>(mu));
                    worst = std::max(worst, off), ratio = std::max(ratio, fastest / std::min(film, fall));
                }
            const std::string name =
                formatted("%s, %g mm, 0.05 to 10 Pa s: ", names[shape], 1e3 * static_cast<double>(dx));
            found.atMost(name + "detached", 0.01, worst);
            found.atMost(name + "fastest / theory", 2, ratio);
        }
}

void meltAndSet(Findings& found) {
    for (const float dx : {0.002f, 0.004f}) {
        int molten = 0, set = 0, inTheEnd = 0;
        for (const float mu : {0.05f, 0.3f, 1.0f, 10.0f}) {
            Lab lab(dx, 4000, {0, -9.81f, 0}, 60);
            thawMaterialDef m = Lab::plain(1000, mu);
            m.cohesion = 6, m.adhesion = 0.5f;
            lab.floor();
            const float w = 5 * dx, height = 20 * dx;
            lab.box(lab.material(m), {-w, 0, -w}, {w, height, w}, 295);
            thawHeatSourceDef lamp;
            thawInitHeatSourceDef(&lamp);
            lamp.position = {0.5f * w, height + 5 * dx, 0.3f * w};
            lamp.power = 20 * dx / 0.002f * dx / 0.002f * dx / 0.002f;
            const thawHeatSourceId source = lab.source(lamp);
            std::vector<char> ran;
            double fastest = 0;
            const auto watch = [&](int) {
                fastest = std::max(fastest, static_cast<double>(lab.counters().maxSpeed));
                const thawParticleView p = lab.particles();
                for (int i = 0; i < p.moving; ++i) {
                    if (p.ids[i] >= ran.size()) ran.resize(p.ids[i] + 1);
                    ran[p.ids[i]] = 1;
                }
            };
            // How many of what is still there have been liquid, or are held again after that.
            const auto count = [&](bool held) {
                const thawParticleView p = lab.particles();
                int n = 0;
                for (int i = 0; i < p.count; ++i)
                    n += p.ids[i] < ran.size() && ran[p.ids[i]] && (!held || (p.flags[i] & thawParticle_fixed));
                return n;
            };
            lab.step(1200, watch);
            const int here = count(false);
            const double fall = std::sqrt(2 * kG * static_cast<double>(height));
            const std::string name =
                formatted("%g mm, %g Pa s: ", 1e3 * static_cast<double>(dx), static_cast<double>(mu));
            found.atLeast(name + "share that melted", 0.1, static_cast<double>(here) / lab.particles().count);
            molten += here, set += count(true);
            // Without the lamp for a time by which heat goes five spacings far, whatever they are.
            thawDestroyHeatSource(lab.world(), source);
            lab.step(dx > 0.003f ? 2400 : 600, watch);
            inTheEnd += count(true);
            found.atMost(name + "fastest / free fall", 2, fastest / fall);
        }
        // At 4 mm the lamp is eight times as strong and the way into the solid twice as long: what runs is hot, and how
        // much of it sets depends on how thin the particles let it run.
        const std::string name = formatted("%g mm: share that set again", 1e3 * static_cast<double>(dx));
        if (dx < 0.003f) found.atLeast(name + " under the lamp", 0.02, static_cast<double>(set) / std::max(1, molten));
        found.atLeast(name + " after it", 0.1, static_cast<double>(inTheEnd) / std::max(1, molten));
    }
}

} // namespace

CaseList filmCases() {
    return {
        {"film-incline", "creeping film on an incline, middle of a long layer: surface speed rho g sin b H^2 / (2 mu)",
         inclineFilm},
        {"round-drop", "cube of liquid of 12 spacings without gravity: sphericity of the surface, momentum", roundDrop},
        {"film-yield", "film with a yield stress on an incline drains to tau_y / (rho g sin b) and stops", yieldFilm},
        {"film-clings", "films of 2 and 3 spacings run down a wall, a post and a ball for 4 s", clingingFilm},
        {"melt-and-set", "block melts under a lamp for 20 s, runs down itself and sets", meltAndSet}};
}

} // namespace thaw::player
