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
            const double u = k / 40.0, angle = 0.9 * std::sin(2 * kPi * u), r = 0.0195;
            s.push_back({float(r * std::sin(angle)), float(0.118 - 0.112 * u), float(r * std::cos(angle))});
        }
        const thawParticleView p = lab.particles();
        for (int i = 0; i < p.count; ++i)
            start[p.ids[i]] = {double(p.positions[4 * i]), double(p.positions[4 * i + 1]),
                               double(p.positions[4 * i + 2])};
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
            const double m = double(p.velocities[4 * i + 3]), d = distanceTo(s, x);
            departed += m, near += d < radius ? m : 0, mean += m * d;
        }
        mean = departed > 0 ? mean / departed : 0;
        return departed > 0 ? near / departed : 0;
    }
};

void sPath(Findings& found) {
    constexpr float kRadius = 0.006f;
    double share[2], departed[2], mean[2];
    for (int with = 0; with <= 1; ++with) {
        Candle c;
        thawPathId id{};
        if (with)
            id = addPath(c.lab, c.s, [](thawPathDef& d) {
                d.radius = kRadius, d.reach = 0.06f, d.strength = 0.95f, d.speed = 0.06f, d.startAbsorptivity = 1;
            });
        c.lab.step(600);
        share[with] = c.share(double(kRadius), departed[with], mean[with]);
        if (with) {
            const thawPathState s = stateOf(c.lab, id);
            std::fprintf(stderr, "captured %g arrived %g spilled %g mass %g dist %g front %g speed %g\n",
                         double(s.captured), double(s.arrived), double(s.spilled), double(s.mass),
                         double(s.meanDistance), double(s.front), double(s.speed));
        }
        for (double r : {0.004, 0.006, 0.008, 0.010, 0.012, 0.016, 0.02}) {
            double a, b;
            std::fprintf(stderr, " %g:%.2f", r * 1e3, c.share(r, a, b));
        }
        std::fprintf(stderr, "with %d: share %g departed %g mean %g\n", with, share[with], departed[with], mean[with]);
    }
    found.atLeast("with the path: share of the departed melt within its radius", 0.9, share[1]);
    found.atMost("without: the same", 0.4, share[0]);
}

} // namespace

CaseList pathCases() {
    return {{"s-path", "candle, 10 s: an S-shaped path down its side, radius 6 mm, strength 0.9", sPath}};
}

} // namespace thaw::player
