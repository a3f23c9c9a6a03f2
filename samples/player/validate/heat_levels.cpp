// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Heat where particles are of several levels.
#include "validate/hare.h"
#include "validate/heat_lab.h"
#include "validate/validate.h"

#include <algorithm>
#include <cmath>

namespace thaw::player {
namespace {

void keepLevels(Lab& lab, int level) { lab.budget.work.finestLevel = lab.budget.work.coarsestLevel = level; }

// Of the mass, the share in particles of that level.
double shareOf(const Lab& lab, int level) {
    const thawCounters c = lab.counters();
    double all = 0;
    for (int l = 0; l < 4; ++l) all += static_cast<double>(c.levels[l]) * (1 << l);
    return static_cast<double>(c.levels[level]) * (1 << level) / all;
}

struct Shape {
    const char* name;
    scene::TriMesh mesh;
};

void area(Findings& found) {
    constexpr float kSpacing = 0.002f;
    const Shape shapes[] = {
        {"sphere", scene::makeSphere(0.024f)}, {"cube", scene::makeBox({0.04f, 0.04f, 0.04f})}, {"hare", makeHare()}};
    for (const Shape& shape : shapes) {
        const double expected = areaOf(shape.mesh);
        for (int level = 0; level < 4; ++level) {
            Lab lab(kSpacing, 60000, {0, 0, 0}, 1);
            lab.body(lab.material(stays(1000, 1000, 1)), shape.mesh, {0, 0, 0}, 500,
                     [&](thawBodyDef& d) { d.coarsestLevel = level; });
            keepLevels(lab, level);
            lab.step(1);
            const std::string name = shape.name + std::string(", level ") + std::to_string(level);
            if (level > 0) found.atLeast(name + ": share of that level", 0.5, shareOf(lab, level));
            found.within(name + ": area, m^2", expected, exposedArea(lab), 0.05);
        }
        // Light from one side until that side is split.
        Lab lab(kSpacing, 60000, {0, 0, 0}, 60);
        thawMaterialDef wax;
        thawInitMaterialDef(&wax, thawMaterial_wax);
        lab.body(lab.material(wax), shape.mesh, {0, 0, 0}, 293.15f, [&](thawBodyDef& d) { d.coarsestLevel = 3; });
        thawHeatSourceDef lamp;
        thawInitHeatSourceDef(&lamp);
        lamp.position = {0.08f, 0.02f, 0}, lamp.power = 60;
        lab.source(lamp);
        for (int k = 0; k < 200 && shareOf(lab, 0) < 0.05; ++k) lab.step(1);
        const std::string name = shape.name + std::string(", lit");
        found.atMost(name + ": melted share", 1e-3, static_cast<double>(lab.counters().meltedFraction));
        found.atLeast(name + ": share of level 0", 0.05, shareOf(lab, 0));
        found.atLeast(name + ": share of level 3", 0.3, shareOf(lab, 3));
        found.within(name + ": area, m^2", expected, exposedArea(lab), 0.05);
    }
}

const char* const kAxes[] = {"x", "y", "z"};

// Two halves of one material, hot and cold, of these levels: the heat that crosses where they meet, and the profile.
void halves(Findings& found, int left, int right, int axis) {
    constexpr double kDensity = 1000, kHeat = 1000, kConductivity = 0.2, kHot = 400, kCold = 300;
    constexpr double kDiffusivity = kConductivity / (kDensity * kHeat);
    constexpr float kScale = 100;
    constexpr int kHalf = 48, kWide = 6;
    const float dx = static_cast<float>(std::sqrt(kDiffusivity * static_cast<double>(kScale) / 60 / 0.5));
    Bar bar(dx, kWide, 4000, kScale, kCold, axis);
    const thawMaterialId material = bar.lab.material(stays(kDensity, kHeat, kConductivity));
    bar.section(material, kHalf, kHot, left), bar.section(material, kHalf, kCold, right);
    keepLevels(bar.lab, std::max(left, right)); // what was filled finer stays so
    const double step = static_cast<double>(dx), before = kHalf * step;
    bar.run(std::pow(12 * step, 2) / kDiffusivity);
    const double deep = 2 * std::sqrt(kDiffusivity * bar.time());
    const thawParticleView p = bar.lab.particles();
    double worst = 0, passed = 0;
    for (int i = 0; i < p.count; ++i) {
        const double x = bar.along(p, i) - before, T = static_cast<double>(p.temperatures[i]);
        worst = std::max(worst, std::abs(T - kCold - (kHot - kCold) * 0.5 * std::erfc(x / deep)) / (kHot - kCold));
        if (x > 0) passed += static_cast<double>(p.velocities[4 * i + 3]) * kHeat * (T - kCold);
    }
    const double section = std::pow(kWide * step, 2);
    const std::string name = "level " + std::to_string(left) + " | " + std::to_string(right) + ", along " + kAxes[axis];
    found.within(name + ": heat passed, J",
                 section * kConductivity * (kHot - kCold) * std::sqrt(bar.time() / (kPi * kDiffusivity)), passed, 0.02);
    found.atMost(name + ": largest error / step of temperature", 0.02, worst);
    thawLedger l;
    thawWorld_GetLedger(bar.lab.world(), &l);
    found.atMost(name + ": energy that the books do not explain", 1e-5, l.energyError);
}

void conduction(Findings& found) {
    for (const int level : {0, 3}) halves(found, level, level, 0);
    for (const int level : {1, 2})
        for (int axis = 0; axis < 3; ++axis) halves(found, level, level, axis);
    halves(found, 3, 0, 0);
    for (const int level : {1, 2})
        for (int axis = 0; axis < 3; ++axis) halves(found, level, 0, axis), halves(found, 3, level, axis);
}

} // namespace

CaseList heatLevelCases() {
    return {{"area-levels", "coarse bodies, and such that light splits on one side, have the area of their mesh", area},
            {"conduction-levels",
             "a hot and a cold half of particles of unlike levels: heat that crosses, temperatures", conduction}};
}

} // namespace thaw::player
