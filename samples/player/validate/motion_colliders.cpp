// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Colliders that move: nothing passes through them, and what they report is what the particles gained.
#include "validate/lab.h"
#include "validate/validate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace thaw::player {
namespace {

constexpr double kStep = 1.0 / 60;

struct Place {
    thawVec3 position{0, 0, 0};
    thawQuat rotation{0, 0, 0, 1};
};

thawQuat turned(thawVec3 axis, double angle) {
    const float s = static_cast<float>(std::sin(0.5 * angle));
    return {s * axis.x, s * axis.y, s * axis.z, static_cast<float>(std::cos(0.5 * angle))};
}

std::array<double, 3> rotated(thawQuat q, const std::array<double, 3>& v) {
    const double u[3] = {static_cast<double>(q.x), static_cast<double>(q.y), static_cast<double>(q.z)};
    const double w = static_cast<double>(q.w);
    std::array<double, 3> t{}, out{};
    for (size_t k = 0; k < 3; ++k) t[k] = 2 * (u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
    for (size_t k = 0; k < 3; ++k)
        out[k] = v[k] + w * t[k] + u[(k + 1) % 3] * t[(k + 2) % 3] - u[(k + 2) % 3] * t[(k + 1) % 3];
    return out;
}

std::array<double, 3> localOf(const Place& at, const float* x) {
    return rotated({-at.rotation.x, -at.rotation.y, -at.rotation.z, at.rotation.w},
                   {static_cast<double>(x[0]) - static_cast<double>(at.position.x),
                    static_cast<double>(x[1]) - static_cast<double>(at.position.y),
                    static_cast<double>(x[2]) - static_cast<double>(at.position.z)});
}

// A lab whose colliders all report, with the balance of what they report against what the particles have.
class Shop {
public:
    Shop(float spacing, int maxParticles, thawVec3 gravity = {0, -9.81f, 0})
        : lab(spacing, maxParticles, gravity), gravity_(gravity) {}

    thawColliderId add(thawColliderDef d) {
        d.reportImpulse = true;
        return all_.emplace_back(lab.collider(d));
    }
    thawColliderId box(thawVec3 half, Place at) {
        thawColliderDef d;
        thawInitColliderDef(&d, thawCollider_box);
        d.size = half, d.position = at.position, d.rotation = at.rotation;
        return add(d);
    }
    void plane(thawVec3 at, thawVec3 normal) {
        thawColliderDef d;
        thawInitColliderDef(&d, thawCollider_plane);
        d.position = at, d.rotation = turnTo({0, 1, 0}, normal);
        add(d);
    }
    void tank(thawVec3 lower, thawVec3 upper) {
        plane({0, lower.y, 0}, {0, 1, 0});
        plane({lower.x, 0, 0}, {1, 0, 0}), plane({upper.x, 0, 0}, {-1, 0, 0});
        plane({0, 0, lower.z}, {0, 0, 1}), plane({0, 0, upper.z}, {0, 0, -1});
    }
    void move(thawColliderId id, const Place& to) {
        if (thawCollider_SetTransform(lab.world(), id, to.position, to.rotation) != thawResult_ok)
            throw LabError(thawWorld_GetLastError(lab.world()));
    }
    // Steps; `before` and `after` get the frame's number.
    void step(int frames, const std::function<void(int)>& before = {}, const std::function<void(int)>& after = {}) {
        for (int f = 1; f <= frames; ++f) {
            if (before) before(f);
            const Momentum old = momentumOf(lab.particles());
            const std::array<double, 4> weight = massOf();
            lab.step(1);
            const Momentum now = momentumOf(lab.particles());
            const std::array<double, 4> later = massOf();
            const double g[3] = {static_cast<double>(gravity_.x), static_cast<double>(gravity_.y),
                                 static_cast<double>(gravity_.z)};
            double J[3] = {}, T[3] = {};
            for (const thawColliderId id : all_) {
                thawColliderImpulse i;
                thawVec3 x;
                thawQuat q;
                if (thawCollider_GetImpulse(lab.world(), id, &i) != thawResult_ok ||
                    thawCollider_GetTransform(lab.world(), id, &x, &q) != thawResult_ok)
                    throw LabError("no impulse");
                const double j[3] = {static_cast<double>(i.linear.x), static_cast<double>(i.linear.y),
                                     static_cast<double>(i.linear.z)};
                const double t[3] = {static_cast<double>(i.angular.x), static_cast<double>(i.angular.y),
                                     static_cast<double>(i.angular.z)};
                const double r[3] = {static_cast<double>(x.x), static_cast<double>(x.y), static_cast<double>(x.z)};
                for (size_t k = 0; k < 3; ++k) {
                    const double about = t[k] + r[(k + 1) % 3] * j[(k + 2) % 3] - r[(k + 2) % 3] * j[(k + 1) % 3];
                    J[k] += j[k], T[k] += about;
                    scale_[k] += std::abs(j[k]), turnScale_ += std::abs(about);
                }
            }
            for (size_t k = 0; k < 3; ++k) {
                const size_t a = (k + 1) % 3, b = (k + 2) % 3;
                lost_[k] += now.p[k] - old.p[k] - kStep * weight[3] * g[k] + J[k];
                // Gravity's turn about the origin, at the middle of the way.
                const double pull = 0.5 * ((weight[a] + later[a]) * g[b] - (weight[b] + later[b]) * g[a]);
                turnLost_[k] += now.l[k] - old.l[k] - kStep * pull + T[k];
            }
            if (after) after(f);
        }
    }
    // Rows about the balance since the begin.
    void balance(Findings& found, bool angular = false) const {
        const double largest = std::max({scale_[0], scale_[1], scale_[2]});
        double worst = 0;
        for (size_t k = 0; k < 3; ++k)
            if (scale_[k] > 0.02 * largest) worst = std::max(worst, std::abs(lost_[k]) / scale_[k]);
        found.atMost("impulse - momentum, worst axis / all impulses", 0.05, worst);
        if (angular)
            found.atMost(
                "angular, the same", 0.05,
                std::sqrt(turnLost_[0] * turnLost_[0] + turnLost_[1] * turnLost_[1] + turnLost_[2] * turnLost_[2]) /
                    turnScale_);
    }
    Lab lab;

private:
    // Mass-weighted position and mass.
    std::array<double, 4> massOf() const {
        const thawParticleView p = lab.particles();
        std::array<double, 4> s{};
        for (int i = 0; i < p.count; ++i) {
            const double m = static_cast<double>(p.velocities[4 * i + 3]);
            for (int k = 0; k < 3; ++k) s[static_cast<size_t>(k)] += m * static_cast<double>(p.positions[4 * i + k]);
            s[3] += m;
        }
        return s;
    }
    thawVec3 gravity_;
    std::vector<thawColliderId> all_;
    double lost_[3] = {}, scale_[3] = {}, turnLost_[3] = {}, turnScale_ = 0;
};

// Counts who goes through a flat box from one side to the other, away from its rim.
class Crossings {
public:
    Crossings(thawVec3 half, int axis, double rim) : axis_(static_cast<size_t>(axis)), rim_(rim) {
        half_ = {static_cast<double>(half.x), static_cast<double>(half.y), static_cast<double>(half.z)};
    }
    void look(const thawParticleView& p, const Place& at) {
        std::map<uint32_t, double> now;
        for (int i = 0; i < p.count; ++i) {
            const std::array<double, 3> x = localOf(at, p.positions + 4 * i);
            bool over = true;
            for (size_t k = 0; k < 3; ++k) over &= k == axis_ || std::abs(x[k]) < half_[k] - rim_;
            if (!over) continue;
            inside += std::abs(x[axis_]) < half_[axis_];
            const auto before = sides_.find(p.ids[i]);
            crossed += before != sides_.end() && before->second * x[axis_] < 0;
            now[p.ids[i]] = x[axis_];
        }
        sides_ = std::move(now);
    }
    int crossed = 0, inside = 0;

private:
    std::array<double, 3> half_{};
    size_t axis_;
    double rim_;
    std::map<uint32_t, double> sides_;
};

float at(double x) { return static_cast<float>(x); }

void pushedPlate(Findings& found) {
    Shop shop(0.004f, 6000);
    shop.tank({-0.06f, 0, -0.03f}, {0.06f, 1, 0.03f});
    const thawVec3 half{0.001f, 0.03f, 0.02f};
    Place plate{{-0.04f, 0.034f, 0}, {0, 0, 0, 1}};
    const thawColliderId id = shop.box(half, plate);
    shop.lab.box(shop.lab.material(Lab::plain(1000, 0.5f)), {-0.06f, 0, -0.03f}, {0.06f, 0.04f, 0.03f}, Lab::kLiquid);
    shop.step(60);
    Crossings seen(half, 0, 0.004);
    seen.look(shop.lab.particles(), plate);
    double force = 0;
    shop.step(
        24,
        [&](int) {
            plate.position.x += at(0.2 * kStep);
            shop.move(id, plate);
        },
        [&](int) {
            thawColliderImpulse i;
            thawCollider_GetImpulse(shop.lab.world(), id, &i);
            force -= static_cast<double>(i.linear.x);
            seen.look(shop.lab.particles(), plate);
        });
    found.atMost("went through the plate", 0, seen.crossed);
    found.atMost("inside of it, particles x frames", 0, seen.inside);
    found.atLeast("impulse against the way, N s", 1e-3, force);
    shop.step(60);
    found.atMost("mean compression a second later", 0.01, static_cast<double>(shop.lab.counters().meanCompression));
    shop.balance(found, true);
}

void stirringSpoon(Findings& found) {
    Shop shop(0.004f, 6000);
    shop.tank({-0.04f, 0, -0.04f}, {0.04f, 1, 0.04f});
    const thawVec3 half{0.012f, 0.02f, 0.0015f};
    const auto spoon = [](double t) {
        const double a = 2 * kPi * t; // one turn a second
        return Place{{at(0.02 * std::sin(a)), 0.024f, at(0.02 * std::cos(a))}, turned({0, 1, 0}, a + kPi / 2)};
    };
    const thawColliderId id = shop.box(half, spoon(0));
    shop.lab.box(shop.lab.material(Lab::plain(1000, 2)), {-0.04f, 0, -0.04f}, {0.04f, 0.032f, 0.04f}, Lab::kLiquid);
    shop.step(40);
    Crossings seen(half, 2, 0.004);
    double turn = 0;
    shop.step(
        120, [&](int f) { shop.move(id, spoon(f * kStep)); },
        [&](int f) {
            seen.look(shop.lab.particles(), spoon(f * kStep));
            if (f > 60) turn += momentumOf(shop.lab.particles()).l[1] / 60;
        });
    found.atMost("went through the spoon", 0, seen.crossed);
    found.atLeast("liquid turns along, kg m^2/s", 1e-5, turn);
    shop.balance(found, true);
}

void spinningBlade(Findings& found) {
    Shop shop(0.004f, 6000);
    shop.tank({-0.04f, 0, -0.04f}, {0.04f, 1, 0.04f});
    const thawVec3 half{0.03f, 0.01f, 0.001f};
    // Gets going within a second, up to 4 turns a second: the tips go 3 spacings a frame.
    const auto blade = [](int f) {
        const double t = std::min(f * kStep, 1.0), on = std::max(f * kStep - 1, 0.0);
        return Place{{0, 0.018f, 0}, turned({0, 1, 0}, std::fmod(8 * kPi * (0.5 * t * t + on), 2 * kPi))};
    };
    const thawColliderId id = shop.box(half, blade(0));
    shop.lab.box(shop.lab.material(Lab::plain(1000, 1)), {-0.04f, 0, -0.04f}, {0.04f, 0.032f, 0.04f}, Lab::kLiquid);
    shop.step(40);
    Crossings seen(half, 2, 0.004);
    shop.step(
        120, [&](int f) { shop.move(id, blade(f)); }, [&](int f) { seen.look(shop.lab.particles(), blade(f)); });
    found.atMost("went through the blade", 0, seen.crossed);
    found.atMost("inside of it, particles x frames", 0, seen.inside);
    shop.balance(found, true);
}

void tiltingBox(Findings& found) {
    Shop shop(0.004f, 6000);
    // Floor and four walls, each a box of its own, about a common pivot.
    struct Part {
        thawVec3 half, offset;
        thawColliderId id;
    };
    const float wide = 0.04f, wall = 0.004f, high = 0.03f;
    Part parts[5] = {{{wide + 2 * wall, wall, wide + 2 * wall}, {0, -wall, 0}, {}},
                     {{wall, high, wide + 2 * wall}, {wide + wall, high, 0}, {}},
                     {{wall, high, wide + 2 * wall}, {-wide - wall, high, 0}, {}},
                     {{wide, high, wall}, {0, high, wide + wall}, {}},
                     {{wide, high, wall}, {0, high, -wide - wall}, {}}};
    const auto placeOf = [](const Part& p, double angle) {
        const thawQuat q = turned({0, 0, 1}, angle);
        const std::array<double, 3> x = rotated(
            q, {static_cast<double>(p.offset.x), static_cast<double>(p.offset.y), static_cast<double>(p.offset.z)});
        return Place{{at(x[0]), at(x[1]), at(x[2])}, q};
    };
    for (Part& p : parts) p.id = shop.box(p.half, placeOf(p, 0));
    shop.lab.box(shop.lab.material(Lab::plain(1000, 0.5f)), {-wide, 0, -wide}, {wide, 0.024f, wide}, Lab::kLiquid);
    shop.step(40);
    const auto angleAt = [](int f) { return 0.45 * std::sin(2 * kPi * f / 60.0); };
    int lost = 0;
    double sides = 0;
    shop.step(
        180,
        [&](int f) {
            for (const Part& p : parts) shop.move(p.id, placeOf(p, angleAt(f)));
        },
        [&](int f) {
            const thawParticleView v = shop.lab.particles();
            const Place pan{{0, 0, 0}, turned({0, 0, 1}, angleAt(f))};
            lost = 0;
            double mean = 0;
            for (int i = 0; i < v.count; ++i) {
                const std::array<double, 3> x = localOf(pan, v.positions + 4 * i);
                lost += x[1] < 0 ||
                        (x[1] < 2 * static_cast<double>(high) &&
                         (std::abs(x[0]) > static_cast<double>(wide) || std::abs(x[2]) > static_cast<double>(wide)));
                mean += x[0] / v.count;
            }
            sides = std::max(sides, std::abs(mean));
        });
    found.atMost("outside of the box", 0, lost);
    found.atLeast("liquid goes from side to side, m", 0.004, sides);
    shop.balance(found, true);
}

void sphereThroughMelt(Findings& found) {
    Shop shop(0.004f, 8000);
    shop.tank({-0.04f, 0, -0.04f}, {0.04f, 1, 0.04f});
    thawColliderDef d;
    thawInitColliderDef(&d, thawCollider_sphere);
    d.size.x = 0.014f, d.position = {0, 0.08f, 0};
    const thawColliderId id = shop.add(d);
    shop.lab.box(shop.lab.material(Lab::plain(1000, 1)), {-0.04f, 0, -0.04f}, {0.04f, 0.05f, 0.04f}, Lab::kLiquid);
    shop.step(60);
    int inside = 0;
    double up = 0;
    float y = d.position.y;
    shop.step(
        60,
        [&](int) {
            y = std::max(0.02f, y - at(0.6 * kStep));
            shop.move(id, {{0, y, 0}, {0, 0, 0, 1}});
        },
        [&](int f) {
            const thawParticleView v = shop.lab.particles();
            for (int i = 0; i < v.count; ++i) {
                const std::array<double, 3> x = localOf({{0, y, 0}, {0, 0, 0, 1}}, v.positions + 4 * i);
                inside += std::hypot(x[0], x[1], x[2]) < static_cast<double>(d.size.x);
            }
            thawColliderImpulse i;
            thawCollider_GetImpulse(shop.lab.world(), id, &i);
            if (f > 40) up += static_cast<double>(i.linear.y) / (20 * kStep);
        });
    found.atMost("inside of the ball, particles x frames", 0, inside);
    // Archimedes, once it stands still.
    found.within("lift of the resting ball, N", 4 / 3.0 * kPi * std::pow(0.014, 3) * 1000 * 9.81, up, 0.1);
    shop.balance(found);
}

void slowPiston(Findings& found) {
    Shop shop(0.004f, 6000);
    shop.tank({-0.03f, 0, -0.03f}, {0.03f, 1, 0.03f});
    const thawVec3 half{0.03f, 0.005f, 0.03f};
    Place piston{{0, 0.065f, 0}, {0, 0, 0, 1}};
    const thawColliderId id = shop.box(half, piston);
    // Half as wide as the tank, twice as high as it will be.
    shop.lab.box(shop.lab.material(Lab::plain(1000, 20)), {-0.03f, 0, -0.03f}, {0.0f, 0.056f, 0.03f}, Lab::kLiquid);
    int above = 0;
    const float rest = 0.028f + 0.002f;
    shop.step(
        240,
        [&](int) {
            piston.position.y = std::max(rest + half.y, piston.position.y - at(0.02 * kStep));
            shop.move(id, piston);
        },
        [&](int) {
            const thawParticleView v = shop.lab.particles();
            above = 0;
            for (int i = 0; i < v.count; ++i) above += v.positions[4 * i + 1] > piston.position.y - half.y;
        });
    found.atMost("above the piston's face", 0, above);
    found.atMost("mean compression at the end", 0.02, static_cast<double>(shop.lab.counters().meanCompression));
    found.atMost("largest compression at the end", 0.1, static_cast<double>(shop.lab.counters().maxCompression));
    shop.balance(found);
}

std::map<uint32_t, std::array<double, 3>> positionsOf(const Lab& lab) {
    std::map<uint32_t, std::array<double, 3>> out;
    const thawParticleView v = lab.particles();
    for (int i = 0; i < v.count; ++i)
        for (size_t k = 0; k < 3; ++k)
            out[v.ids[i]][k] = static_cast<double>(v.positions[4 * static_cast<size_t>(i) + k]);
    return out;
}

void turntable(Findings& found) {
    Shop shop(0.004f, 6000);
    const thawVec3 half{0.06f, 0.004f, 0.06f};
    const thawColliderId id = shop.box(half, {{0, -0.004f, 0}, {0, 0, 0, 1}});
    const thawMaterialId m = shop.lab.material(Lab::plain(1000, 5));
    shop.lab.box(m, {0.01f, 0, 0.01f}, {0.034f, 0.024f, 0.034f}, Lab::kSolid);
    shop.step(20);
    const auto start = positionsOf(shop.lab);
    shop.step(120, [&](int f) { shop.move(id, {{0, -0.004f, 0}, turned({0, 1, 0}, 2 * kPi * f / 60.0)}); });
    double off = 0;
    const auto end = positionsOf(shop.lab); // after two turns
    for (const auto& [particle, x] : end) {
        const auto& y = start.at(particle);
        off = std::max(off, std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]));
    }
    found.atMost("held piece after two turns off its place, spacings", 0.01, off / 0.004);
    shop.balance(found, true);
}

void conveyor(Findings& found) {
    // A floor that goes along its own plane takes the liquid with it, by drag alone.
    Shop shop(0.004f, 6000);
    const thawVec3 half{0.2f, 0.004f, 0.05f};
    Place belt{{0, -0.004f, 0}, {0, 0, 0, 1}};
    const thawColliderId id = shop.box(half, belt);
    shop.lab.box(shop.lab.material(Lab::plain(1000, 5)), {-0.02f, 0, -0.02f}, {0.02f, 0.012f, 0.02f}, Lab::kLiquid);
    shop.step(30);
    shop.step(30, [&](int) {
        belt.position.x += at(0.1 * kStep);
        shop.move(id, belt);
    });
    // In the mean: it spreads at the same time.
    const Momentum m = momentumOf(shop.lab.particles());
    found.within("speed of the liquid along, m/s", 0.1, m.p[0] / (0.04 * 0.012 * 0.04 * 1000), 0.02);
    shop.balance(found);
}

void sweptPlate(Findings& found) {
    // In free space: a plate thinner than a particle, five spacings a frame, at a ball of liquid.
    Shop shop(0.004f, 6000, {0, 0, 0});
    const thawVec3 half{0.0005f, 0.04f, 0.04f};
    Place plate{{-0.1f, 0, 0}, {0, 0, 0, 1}};
    const thawColliderId id = shop.box(half, plate);
    thawMaterialDef def = Lab::plain(1000, 1);
    def.cohesion = 6;
    shop.lab.body(shop.lab.material(def), scene::makeSphere(0.016f), {0, 0.004f, 0}, Lab::kLiquid);
    shop.step(5);
    Crossings seen(half, 0, 0.004);
    int behind = 0;
    shop.step(
        12,
        [&](int) {
            plate.position.x += 5 * 0.004f;
            shop.move(id, plate);
        },
        [&](int) {
            const thawParticleView v = shop.lab.particles();
            seen.look(v, plate);
            behind = 0;
            for (int i = 0; i < v.count; ++i) behind += v.positions[4 * i] < plate.position.x;
        });
    found.atMost("went through the plate", 0, seen.crossed);
    found.atMost("behind the plate at the end", 0, behind);
    shop.balance(found, true);
}

// Half a hollow sphere, open above, its rim at y = 0.
scene::TriMesh bowl(double inner, double outer) {
    constexpr int kDown = 16;
    std::vector<scene::ProfilePoint> profile;
    for (int k = 0; k <= kDown; ++k) {
        const double a = 0.5 * kPi * k / kDown;
        profile.push_back({outer * std::sin(a), -outer * std::cos(a)});
    }
    for (int k = kDown; k >= 0; --k) {
        const double a = 0.5 * kPi * k / kDown;
        profile.push_back({inner * std::sin(a), -inner * std::cos(a)});
    }
    return scene::makeLathe(profile, 48);
}

void shakenBowl(Findings& found) {
    Shop shop(0.004f, 6000);
    const scene::TriMesh mesh = bowl(0.04, 0.046);
    thawColliderDef d;
    thawInitColliderDef(&d, thawCollider_mesh);
    d.mesh = mesh.view();
    const thawColliderId id = shop.add(d);
    shop.lab.body(shop.lab.material(Lab::plain(1000, 0.5f)), scene::makeSphere(0.02f), {0, -0.015f, 0}, Lab::kLiquid);
    shop.step(60);
    const auto placeAt = [](int f) {
        const double t = f / 60.0;
        return Place{{at(0.012 * std::sin(2 * kPi * 2 * t)), at(0.006 * std::sin(2 * kPi * t)), 0},
                     turned({0, 0, 1}, 0.3 * std::sin(2 * kPi * t))};
    };
    int through = 0;
    shop.step(
        180, [&](int f) { shop.move(id, placeAt(f)); },
        [&](int f) {
            const thawParticleView v = shop.lab.particles();
            through = 0;
            for (int i = 0; i < v.count; ++i) {
                const std::array<double, 3> x = localOf(placeAt(f), v.positions + 4 * i);
                through += x[1] < 0 && std::hypot(x[0], x[1], x[2]) > 0.041;
            }
        });
    found.atMost("in the bowl's wall or through it", 0, through);
    shop.balance(found, true);
}

void closingWall(Findings& found) {
    Shop shop(0.004f, 6000);
    shop.plane({0, 0, 0}, {0, 1, 0});
    const thawVec3 half{0.004f, 0.03f, 0.03f};
    Place wall{{-0.03f, 0.03f, 0}, {0, 0, 0, 1}};
    const thawColliderId id = shop.box(half, wall);
    shop.lab.box(shop.lab.material(Lab::plain(1000, 5)), {-0.016f, 0, -0.016f}, {0.016f, 0.024f, 0.016f}, Lab::kSolid);
    shop.step(20);
    Crossings seen(half, 0, 0.004);
    double push = 0;
    shop.step(
        60,
        [&](int) {
            wall.position.x += at(0.05 * kStep);
            shop.move(id, wall);
        },
        [&](int) {
            seen.look(shop.lab.particles(), wall);
            thawColliderImpulse i;
            thawCollider_GetImpulse(shop.lab.world(), id, &i);
            push -= static_cast<double>(i.linear.x);
        });
    double most = -1;
    const thawParticleView v = shop.lab.particles();
    for (int i = 0; i < v.count; ++i) most = std::max(most, static_cast<double>(v.positions[4 * i]));
    found.atMost("went through the wall", 0, seen.crossed);
    found.atMost("inside of it, particles x frames", 0, seen.inside);
    // The wall's face ends 40 mm to the left of where the solid's far face would be, had it kept its length.
    found.atLeast("far face of the solid, m", 0.024 + 0.024, most + 0.002);
    found.atLeast("impulse against the way, N s", 1e-4, push);
    shop.balance(found);
}

void lift(Findings& found) {
    Shop shop(0.004f, 6000);
    const thawVec3 half{0.03f, 0.004f, 0.03f};
    const thawColliderId id = shop.box(half, {{0, -0.004f, 0}, {0, 0, 0, 1}});
    shop.lab.box(shop.lab.material(Lab::plain(1000, 5)), {-0.012f, 0, -0.012f}, {0.012f, 0.024f, 0.012f}, Lab::kSolid);
    shop.step(20);
    const auto start = positionsOf(shop.lab);
    const auto height = [](int f) { return 0.05 * (1 - std::cos(2 * kPi * f / 60.0)); };
    double worst = 0;
    shop.step(
        120,
        [&](int f) {
            shop.move(id, {{0, at(height(f) - 0.004), 0}, {0, 0, 0, 1}});
        },
        [&](int f) {
            for (const auto& [particle, x] : positionsOf(shop.lab)) {
                const auto& y = start.at(particle);
                worst = std::max(worst, std::hypot(x[0] - y[0], x[1] - y[1] - height(f), x[2] - y[2]));
            }
        });
    found.atMost("held piece off its place on the lift, spacings", 0.01, worst / 0.004);
    thawColliderImpulse i;
    shop.step(2);
    thawCollider_GetImpulse(shop.lab.world(), id, &i);
    found.within("weight on the resting lift, N", -1000 * 0.024 * 0.024 * 0.024 * 9.81,
                 static_cast<double>(i.linear.y) / kStep, 0.01);
    shop.balance(found, true);
}

} // namespace

CaseList colliderCases() {
    return {
        {"collider-plate", "a plate is pushed through a pool of 0.5 Pa s at 0.2 m/s", pushedPlate},
        {"collider-spoon", "a spoon stirs 2 Pa s, one turn a second", stirringSpoon},
        {"collider-blade", "a thin blade spins in 1 Pa s, up to 4 turns a second", spinningBlade},
        {"collider-tilt", "a box of five parts with 0.5 Pa s inside tilts by 26 degrees to and fro", tiltingBox},
        {"collider-ball", "a ball goes down into 1 Pa s at 0.6 m/s and stops", sphereThroughMelt},
        {"collider-piston", "a piston comes down on a heap of 20 Pa s and stops at its volume", slowPiston},
        {"collider-turntable", "a table turns with a solid piece on it", turntable},
        {"collider-belt", "a belt carries 5 Pa s along", conveyor},
        {"collider-swept-plate", "a plate of a quarter spacing hits a free blob at five spacings a frame", sweptPlate},
        {"collider-bowl", "a bowl (mesh) with 0.5 Pa s inside is shaken and tilted", shakenBowl},
        {"collider-wall", "a wall closes on a solid piece that stands on the floor", closingWall},
        {"collider-lift", "a lift carries a solid piece up and down", lift},
    };
}

} // namespace thaw::player
