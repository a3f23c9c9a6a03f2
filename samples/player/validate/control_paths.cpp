// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "report.h"
#include "validate/lab.h"
#include "validate/validate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace thaw::player {
namespace {

using Point = std::array<double, 3>;

double distanceTo(const std::vector<thawVec3>& line, const Point& x) {
    double best = 1e30;
    for (size_t k = 0; k + 1 < line.size(); ++k) {
        const Point a{line[k].x, line[k].y, line[k].z}, b{line[k + 1].x, line[k + 1].y, line[k + 1].z};
        double square = 0, along = 0, rest = 0;
        for (size_t c = 0; c < 3; ++c) square += (b[c] - a[c]) * (b[c] - a[c]), along += (x[c] - a[c]) * (b[c] - a[c]);
        const double t = std::clamp(along / square, 0.0, 1.0);
        for (size_t c = 0; c < 3; ++c) rest += std::pow(x[c] - a[c] - t * (b[c] - a[c]), 2);
        best = std::min(best, rest);
    }
    return std::sqrt(best);
}

thawPathId addPath(const Lab& lab, const std::vector<thawVec3>& points, const std::function<void(thawPathDef&)>& more) {
    thawPathDef d;
    thawInitPathDef(&d);
    d.points = points.data(), d.pointCount = int32_t(points.size());
    more(d);
    thawPathId id;
    if (thawCreatePath(lab.world(), &d, &id) != thawResult_ok) throw LabError(thawWorld_GetLastError(lab.world()));
    return id;
}

thawPathState stateOf(const Lab& lab, thawPathId id) {
    thawPathState s;
    if (thawPath_GetState(lab.world(), id, &s) != thawResult_ok) throw LabError("path: no state");
    return s;
}

// The sample candle, and an S drawn down its side.
struct Candle {
    static constexpr double kSide = 0.0195; // m, radius
    Lab lab{0.00235f, 32768, {0, -9.81f, 0}, 30};
    std::vector<thawVec3> s;
    std::map<uint32_t, Point> start;

    Candle() {
        thawWorld_SetAmbient(lab.world(), 293.15f, 10);
        thawMaterialDef wax;
        thawInitMaterialDef(&wax, thawMaterial_wax);
        wax.viscosityLiquid = 0.1f, wax.viscositySolid = 500, wax.cohesion = 4;
        const thawMaterialId material = lab.material(wax);
        lab.floor(0);
        lab.body(material, scene::makeCandle(), {0, 0.003f, 0}, 311.15f);
        thawHeatSourceDef flame;
        thawInitHeatSourceDef(&flame);
        flame.position = {0.0022f, 0.1335f, -0.0009f}, flame.power = 700, flame.radius = 0.003f;
        lab.source(flame);
        s.push_back({0.0f, 0.119f, 0.0f});
        for (int k = 0; k <= 40; ++k) {
            const double u = k / 40.0, angle = 0.9 * std::sin(2 * kPi * u), r = kSide;
            s.push_back({float(r * std::sin(angle)), float(0.118 - 0.112 * u), float(r * std::cos(angle))});
        }
        const thawParticleView p = lab.particles();
        for (int i = 0; i < p.count; ++i)
            start[p.ids[i]] = {double(p.positions[4 * i]), double(p.positions[4 * i + 1]),
                               double(p.positions[4 * i + 2])};
    }
    // Seen from its axis: the stream digs itself in.
    static Point onSide(const Point& x) {
        const double k = kSide / std::max(std::hypot(x[0], x[2]), 1e-6);
        return {k * x[0], x[1], k * x[2]};
    }
    // Of the melt that has gone 8 mm and more, and is below the rim: the share within `radius` of the S.
    double share(double radius, double& departed, double& mean) const {
        const thawParticleView p = lab.particles();
        double near = 0;
        departed = mean = 0;
        for (int i = 0; i < p.count; ++i) {
            const Point x{double(p.positions[4 * i]), double(p.positions[4 * i + 1]), double(p.positions[4 * i + 2])};
            const Point& from = start.at(p.ids[i]);
            const double gone = std::hypot(x[0] - from[0], x[1] - from[1], x[2] - from[2]);
            if (gone < 0.008 || x[1] > 0.112 || x[1] < 0.012) continue;
            const double m = double(p.velocities[4 * i + 3]), d = distanceTo(s, onSide(x));
            departed += m, near += d < radius ? m : 0, mean += m * d;
        }
        mean = departed > 0 ? mean / departed : 0;
        return departed > 0 ? near / departed : 0;
    }
};

void sPath(Findings& found) {
    constexpr float kRadius = 0.01f;
    double share[2], departed[2], mean[2];
    for (int with = 0; with <= 1; ++with) {
        Candle c;
        if (with)
            addPath(c.lab, c.s, [](thawPathDef& d) {
                d.radius = kRadius, d.reach = 0.06f, d.strength = 1, d.speed = 0.06f, d.startAbsorptivity = 1;
            });
        c.lab.step(600);
        share[with] = c.share(double(kRadius), departed[with], mean[with]);
    }
    found.atLeast("with the path: share of the departed melt within its radius", 0.9, share[1]);
    found.atMost("without: the same", 0.4, share[0]);
}

// A block of liquid on a plane that leans by 25 degrees toward -x, at its upper end; paths lie on the plane.
struct Slope {
    static constexpr float kSpacing = 0.003f;
    static constexpr double kLean = 25 * kPi / 180;
    Lab lab;

    // A place on the plane: m down it and to the side.
    static thawVec3 at(double down, double side) {
        return {float(-down * std::cos(kLean)), float(-down * std::sin(kLean)), float(side)};
    }
    static Point along(const Point& x) { // m down, out of the plane, to the side
        return {-x[0] * std::cos(kLean) - x[1] * std::sin(kLean), -x[0] * std::sin(kLean) + x[1] * std::cos(kLean),
                x[2]};
    }
    explicit Slope(float viscosity, double width = 0.03, double length = 0.06, double height = 0.012, float gravity = 1)
        : lab(kSpacing, 30000, {0, -9.81f * gravity, 0}) {
        const thawMaterialId m = lab.material(Lab::plain(1000, viscosity));
        lab.plane({0, 0, 0}, {-float(std::sin(kLean)), float(std::cos(kLean)), 0});
        lab.body(m, scene::makeBox({float(length), float(height), float(width)}),
                 {float(0.5 * height * -std::sin(kLean)), float(0.5 * height * std::cos(kLean)), 0}, Lab::kLiquid,
                 [](thawBodyDef& d) {
                     d.rotation = {0, 0, float(std::sin(0.5 * kLean)), float(std::cos(0.5 * kLean))};
                 });
    }
    template <class F> void each(F&& f) const { // f(place down, out, side; mass)
        const thawParticleView p = lab.particles();
        for (int i = 0; i < p.count; ++i)
            f(along({double(p.positions[4 * i]), double(p.positions[4 * i + 1]), double(p.positions[4 * i + 2])}),
              double(p.velocities[4 * i + 3]));
    }
};

void arrival(Findings& found) {
    for (const float seconds : {2.0f, 4.0f, 8.0f}) {
        Slope s(2);
        const thawPathId id = addPath(
            s.lab, {Slope::at(0, 0), Slope::at(0.1, 0.02), Slope::at(0.2, -0.02), Slope::at(0.3, 0)},
            [&](thawPathDef& d) { d.radius = 0.02f, d.reach = 0.06f, d.strength = 0.9f, d.arrivalTime = seconds; });
        s.lab.step(int(60 * seconds * 1.5f));
        found.within(formatted("asked %g s: arrived after, s", double(seconds)), double(seconds),
                     double(stateOf(s.lab, id).arrivalTime), 0.10);
    }
}

void strength(Findings& found) {
    double last = 0;
    for (const float strength : {0.1f, 0.5f, 1.0f}) {
        Slope s(2);
        const std::vector<thawVec3> line{Slope::at(0, 0), Slope::at(0.06, 0.03), Slope::at(0.15, 0.06),
                                         Slope::at(0.3, 0.06)};
        addPath(s.lab, line,
                [&](thawPathDef& d) { d.radius = 0.012f, d.reach = 0.1f, d.strength = strength, d.speed = 0.08f; });
        double sum = 0, mass = 0;
        s.lab.step(150);
        s.each([&](const Point& x, double m) {
            if (x[0] < 0.06 || x[0] > 0.3) return;
            const thawVec3 on = Slope::at(x[0], x[2]);
            sum += m * distanceTo(line, {double(on.x), double(on.y), double(on.z)}), mass += m;
        });
        const double mean = mass > 0 ? 1e3 * sum / mass : 1e3;
        if (last == 0)
            found.atLeast(formatted("strength %g: mean distance, mm", double(strength)), 0, mean);
        else
            found.atMost(formatted("strength %g: mean distance, mm (the one before)", double(strength)), last, mean);
        last = mean;
    }
}

void fork(Findings& found) {
    for (const float share : {0.5f, 0.7f}) {
        Slope s(2);
        thawPathId id[2];
        for (int k = 0; k < 2; ++k) {
            const double side = k == 0 ? -1 : 1;
            id[k] = addPath(
                s.lab,
                {Slope::at(0, 0), Slope::at(0.09, 0), Slope::at(0.15, 0.05 * side), Slope::at(0.26, 0.06 * side)},
                [&](thawPathDef& d) {
                    d.radius = 0.015f, d.reach = 0.06f, d.strength = 0.9f, d.speed = 0.08f;
                    d.share = k == 0 ? share : 1 - share;
                });
        }
        s.lab.step(360);
        double left = 0, right = 0;
        for (int k = 0; k < 2; ++k) {
            const thawPathState state = stateOf(s.lab, id[k]);
            (k == 0 ? left : right) = double(state.arrived);
        }
        // What is past the fork is counted where it is, and what went off the ends.
        s.each([&](const Point& x, double m) {
            if (x[0] > 0.15) (x[2] < 0 ? left : right) += m;
        });
        found.within(formatted("asked %g : %g: share on the left", double(share), double(1 - share)), double(share),
                     left / (left + right), 0.05 / double(share));
    }
}

void bend(Findings& found) {
    Slope s(1);
    // Down, and back up by 30 degrees after a turn of 120.
    const double turn = 120 * kPi / 180, out = 0.12;
    const std::vector<thawVec3> line{Slope::at(0, 0), Slope::at(0.1, 0),
                                     Slope::at(0.1 + out * std::cos(turn), out * std::sin(turn))};
    constexpr double kRadius = 0.015;
    addPath(s.lab, line, [&](thawPathDef& d) {
        d.radius = float(kRadius), d.reach = 0.06f, d.strength = 0.98f, d.speed = 0.1f, d.smooth = false;
    });
    double worst = 0;
    s.lab.step(180, [&](int) {
        double thrown = 0, all = 0;
        s.each([&](const Point& x, double m) {
            all += m;
            const thawVec3 on = Slope::at(x[0], x[2]);
            // Around the bend; the block is wider than the path at first, and what is off its end is free.
            if (x[2] > 0.08) return;
            thrown += x[0] > 0.07 && distanceTo(line, {double(on.x), double(on.y), double(on.z)}) > 2 * kRadius ? m : 0;
        });
        worst = std::max(worst, thrown / all);
    });
    found.atMost("bend of 120 degrees, 0.1 m/s: mass thrown beyond two radii, share", 0.02, worst);
}

void width(Findings& found) {
    Slope s(2, 0.036, 0.24, 0.012);
    addPath(s.lab, {Slope::at(0, 0), Slope::at(0.5, 0)},
            [&](thawPathDef& d) { d.radius = 0.015f, d.reach = 0.06f, d.strength = 0.95f, d.speed = 0.08f; });
    double gate[3] = {}, count[3] = {};
    // From when its head has passed the last gate until its end comes to the first.
    s.lab.step(165, [&](int f) {
        if (f < 120) return;
        for (int g = 0; g < 3; ++g) {
            double mass = 0, square = 0, mean = 0;
            s.each([&](const Point& x, double m) {
                if (std::abs(x[0] - (0.14 + 0.05 * g)) < 0.01) mass += m, mean += m * x[2], square += m * x[2] * x[2];
            });
            if (mass > 0) gate[g] += std::sqrt(12 * (square / mass - mean * mean / mass / mass)), count[g] += 1;
        }
    });
    for (int g = 1; g < 3; ++g)
        found.within(formatted("stream's width 140 and %d mm down, mm", 140 + 50 * g), 1e3 * gate[0] / count[0],
                     1e3 * gate[g] / count[g], 0.20);
}

// How much the stream is drawn together into beads: the component of that wavelength of its mass along it over the
// mean.
void beads(Findings& found) {
    constexpr double kWave = 0.06;
    for (const bool with : {false, true}) {
        Slope s(2, 0.03, 0.24, 0.012);
        addPath(s.lab, {Slope::at(0, 0), Slope::at(0.6, 0)}, [&](thawPathDef& d) {
            d.radius = 0.015f, d.reach = 0.06f, d.strength = 0.9f, d.speed = 0.08f,
            d.beadSpacing = with ? float(kWave) : 0;
        });
        s.lab.step(150);
        double re = 0, im = 0, mass = 0;
        s.each([&](const Point& x, double m) {
            if (x[0] < 0.12 || x[0] > 0.12 + 3 * kWave) return;
            re += m * std::cos(2 * kPi * x[0] / kWave), im += m * std::sin(2 * kPi * x[0] / kWave), mass += m;
        });
        const double wave = 2 * std::hypot(re, im) / mass;
        if (with)
            found.atLeast("beads 60 mm apart: mass along the path, wave of that length over the mean", 0.6, wave);
        else
            found.atMost("without: the same", 0.2, wave);
    }
}

void ledger(Findings& found) {
    // In free space: all momentum that the blob has, a path gave.
    Lab lab(0.003f, 20000, {0, 0, 0});
    const thawMaterialId m = lab.material(Lab::plain(1000, 1));
    lab.body(m, scene::makeSphere(0.015f), {0, 0, 0}, Lab::kLiquid);
    addPath(lab, {{0, 0, 0}, {0.1f, 0.02f, 0}, {0.2f, 0, 0.05f}},
            [](thawPathDef& d) { d.radius = 0.02f, d.reach = 0.04f, d.strength = 0.8f, d.speed = 0.1f; });
    lab.step(60);
    const Momentum now = momentumOf(lab.particles());
    thawLedger l;
    thawWorld_GetLedger(lab.world(), &l);
    double off = 0, got = 0;
    for (int a = 0; a < 3; ++a) off += std::pow(now.p[a] - l.controlImpulse[a], 2), got += std::pow(now.p[a], 2);
    found.atLeast("blob in free space: momentum it got, g m/s", 0.1, 1e3 * std::sqrt(got));
    found.atMost("of that not in the ledger, share", 1e-3, std::sqrt(off / got));

    // Moved as a whole it loses nothing by its viscosity.
    Lab straight(0.003f, 20000, {0, 0, 0});
    straight.body(straight.material(Lab::plain(1000, 1)), scene::makeSphere(0.015f), {0, 0, 0}, Lab::kLiquid);
    addPath(straight, {{-1, 0, 0}, {1, 0, 0}},
            [](thawPathDef& d) { d.radius = 0.1f, d.reach = 0.2f, d.strength = 0.3f, d.speed = 0.1f; });
    straight.step(60);
    const double kinetic = kineticEnergy(straight.particles());
    thawWorld_GetLedger(straight.world(), &l);
    found.atLeast("the same along a straight line: kinetic energy it got, mJ", 0.01, 1e3 * kinetic);
    found.within("of that in the ledger, mJ", 1e3 * kinetic, 1e3 * l.controlEnergy, 1e-3);
}

void rest(Findings& found) {
    Slope s(5, 0.04, 0.04, 0.012, 1);
    // A path without speed that ends in a wall's corner: what is there stays.
    s.lab.plane(Slope::at(0.05, 0), {float(std::cos(Slope::kLean)), float(std::sin(Slope::kLean)), 0});
    addPath(s.lab, {Slope::at(-0.02, 0), Slope::at(0.1, 0)},
            [](thawPathDef& d) { d.radius = 0.02f, d.reach = 0.06f, d.strength = 1, d.speed = 0; });
    double sum = 0;
    s.lab.step(1800, [&](int f) {
        if (f < 1200) return;
        sum += kineticOver(s.lab) / 600;
    });
    found.atMost("lock at rest, from 20 to 30 s: kinetic energy over g dx m, mean", 1e-4, sum);
}

} // namespace

CaseList pathCases() {
    return {{"path-candle", "candle, 10 s: an S-shaped path down its side, radius 10 mm, a lock", sPath},
            {"path-arrival", "liquid on a slope of 25 degrees: a path of 0.3 m with an arrival time", arrival},
            {"path-strength", "the same, to the side: mean distance from the path falls with its strength", strength},
            {"path-fork", "two paths that part after 9 cm, with shares", fork},
            {"path-bend", "a bend of 120 degrees", bend},
            {"path-width", "width of a stream (of a rectangle of its variance) along a straight path", width},
            {"path-beads", "a stream that is drawn together into beads", beads},
            {"path-ledger", "momentum of a blob in free space against the ledger", ledger},
            {"path-rest", "a pool in a corner under a lock", rest}};
}

} // namespace thaw::player
