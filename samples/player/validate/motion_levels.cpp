// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// What flows of coarse particles beside the same of the finest ones.
#include "validate/lab.h"
#include "validate/validate.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace thaw::player {
namespace {

constexpr float kSpacing = 0.002f;

struct Deep {
    Lab lab;
    // A block of liquid between two walls on which it slides, `along` x `high` x `across` spacings.
    Deep(int coarsest, float viscosity, int along, int high, int across, bool tank)
        : lab(kSpacing, along * high * across + 1000) {
        const float half = 0.5f * static_cast<float>(across) * kSpacing, length = static_cast<float>(along) * kSpacing;
        lab.floor();
        lab.channel(half);
        lab.plane({0, 0, 0}, {1, 0, 0});
        if (tank) lab.plane({length, 0, 0}, {-1, 0, 0});
        lab.box(lab.material(Lab::plain(1000, viscosity)), {0, 0, -half},
                {length, static_cast<float>(high) * kSpacing, half}, Lab::kLiquid,
                [&](thawBodyDef& d) { d.coarsestLevel = coarsest; });
    }
    // By mass, m: how far the first 98 % of it reach, and the mean height times two.
    double front() const {
        const thawParticleView p = lab.particles();
        std::vector<std::pair<double, double>> at;
        double all = 0, sum = 0;
        for (int i = 0; i < p.count; ++i) {
            at.push_back({static_cast<double>(p.positions[4 * i]), static_cast<double>(p.velocities[4 * i + 3])});
            all += at.back().second;
        }
        std::sort(at.begin(), at.end());
        for (const auto& [x, m] : at)
            if ((sum += m) >= 0.98 * all) return x;
        return 0;
    }
    double height() const {
        const thawParticleView p = lab.particles();
        double all = 0, sum = 0;
        for (int i = 0; i < p.count; ++i) {
            const double m = static_cast<double>(p.velocities[4 * i + 3]);
            all += m, sum += m * static_cast<double>(p.positions[4 * i + 1]);
        }
        return 2 * sum / all;
    }
    double fastest() const {
        const thawParticleView p = lab.particles();
        double most = 0;
        for (int i = 0; i < p.count; ++i) {
            const float* v = p.velocities + 4 * i;
            most = std::max(most, std::sqrt(static_cast<double>(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])));
        }
        return most;
    }
    double fewer() const { // than the mass makes of the finest
        const thawCounters c = lab.counters();
        double finest = 0;
        for (int l = 0; l < 4; ++l) finest += static_cast<double>(c.levels[l]) * (1 << l);
        return finest / c.particles;
    }
};

// A pool that may be coarse up to its surface: it rests as high, as still and as dense.
void pool(Findings& found) {
    Deep coarse(3, 1, 24, 28, 24, true);
    double fastest = 0, density = 0;
    coarse.lab.step(900, [&](int frame) {
        if (frame <= 840) return;
        fastest = std::max(fastest, coarse.fastest());
        density = std::max(density, static_cast<double>(coarse.lab.counters().meanCompression));
    });
    found.atLeast("times fewer particles after 15 s", 1.5, coarse.fewer());
    found.within("twice the mean height, m", 28 * static_cast<double>(kSpacing), coarse.height(), 0.01);
    found.atMost("fastest in the last second, m/s", 0.02, fastest);
    found.atMost("density error, mean", 0.01, density);
}

// A dam that breaks on a floor without slip.
void dam(Findings& found) {
    Deep fine(0, 10, 40, 40, 12, false), coarse(3, 10, 40, 40, 12, false);
    double most = 0;
    for (int second = 1; second <= 4; ++second) {
        fine.lab.step(60), coarse.lab.step(60);
        most = std::max(most, coarse.fewer());
        const std::string when = " after " + std::to_string(second) + " s, m";
        found.within("front against fine" + when, fine.front(), coarse.front(), 0.02);
        found.within("mean height against fine" + when, fine.height(), coarse.height(), 0.02);
    }
    found.atLeast("times fewer particles at the most", 1.25, most);
}

} // namespace

CaseList levelCases() {
    return {{"levels-pool", "a pool of 28 layers at rest, coarse particles up to its surface", pool},
            {"levels-dam", "a dam of 40 x 40 spacings of 10 Pa s breaks, coarse against fine particles", dam}};
}

} // namespace thaw::player
