// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world_fixture.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <set>

namespace {

// A candle stump of 3,000 of the finest particles, as coarse as asked.
struct Stump : WorldFixture {
    explicit Stump(int coarsest, float power = 120, bool anchored = true, float side = 0.015f, float height = 0.05f) {
        def.thermalTimeScale = 60;
        create(), addMaterial(), addFloor();
        box(coarsest, {-side, 0, -side}, {side, height, side}, anchored);
        if (power > 0) source = addSource({0, height + 0.012f, 0}, power);
    }
    void box(int coarsest, thawVec3 low, thawVec3 high, bool anchored, thawQuat turn = {0, 0, 0, 1},
             thawVec3 at = {0, 0, 0}) {
        const Shape s = boxShape(low, high);
        thawBodyDef d;
        thawInitBodyDef(&d);
        d.material = material, d.mesh = s.mesh(), d.coarsestLevel = coarsest, d.anchored = anchored;
        d.rotation = turn, d.position = at;
        thawBodyId id;
        REQUIRE_MESSAGE(thawCreateBody(world, &d, &id, nullptr) == thawResult_ok, thawWorld_GetLastError(world));
    }
    std::vector<float> surface() const {
        thawSurfaceDef d;
        thawInitSurfaceDef(&d);
        thawSurfaceView v;
        REQUIRE(thawWorld_ExtractSurface(world, &d, &v) == thawResult_ok);
        return {v.positions, v.positions + 3 * v.vertexCount};
    }
    double mass() const {
        const thawParticleView v = particles();
        double m = 0;
        for (int i = 0; i < v.count; ++i) m += static_cast<double>(v.velocities[4 * i + 3]);
        return m;
    }
    thawHeatSourceId source{};
};

double farthest(const std::vector<float>& a, const std::vector<float>& b) {
    REQUIRE(a.size() == b.size());
    double worst = 0;
    for (size_t k = 0; k < a.size(); ++k) worst = std::max(worst, static_cast<double>(std::abs(a[k] - b[k])));
    return worst;
}

std::vector<std::array<float, 3>> sortedPositions(const WorldFixture& f) {
    const thawParticleView v = f.particles();
    std::vector<std::array<float, 3>> out;
    for (int i = 0; i < v.count; ++i)
        out.push_back({v.positions[4 * i], v.positions[4 * i + 1], v.positions[4 * i + 2]});
    std::sort(out.begin(), out.end());
    return out;
}

} // namespace

TEST_CASE("levels: an unheated body of coarse particles has the mass, the area and the surface of a fine one") {
    Stump fine(0, 0), coarse(3, 0);
    CHECK(coarse.counters().particles * 5 <= fine.counters().particles);
    CHECK(coarse.mass() == doctest::Approx(fine.mass()).epsilon(1e-7));
    CHECK(farthest(fine.surface(), coarse.surface()) < 1e-6);
    const auto area = [](const WorldFixture& f) {
        double a = 0;
        const thawParticleView v = f.particles();
        for (int i = 0; i < v.count; ++i) a += static_cast<double>(v.normals[4 * i + 3]);
        return a;
    };
    CHECK(area(coarse) == doctest::Approx(area(fine)).epsilon(0.002)); // at the first look, which may be the only one
    fine.step(), coarse.step();
    CHECK(area(coarse) == doctest::Approx(area(fine)).epsilon(0.002));
    const thawParticleView v = coarse.particles();
    for (int i = 0; i < v.count; ++i) {
        // Nothing inside the body takes part in what only a surface does.
        const float* x = v.positions + 4 * i;
        const bool deep = std::abs(x[0]) < 0.009f && std::abs(x[2]) < 0.009f && x[1] > 0.006f && x[1] < 0.044f;
        if (deep) CHECK((v.flags[i] & thawParticle_surface) == 0);
    }
}

TEST_CASE("levels: split to the end, all particles stand where a fine body has them, also after a fall and a turn") {
    const float s = std::sin(0.35f), c = std::cos(0.35f);
    const auto fallen = [&](int coarsest) {
        auto f = std::make_unique<Stump>(0, 0.0f, true, 0.004f, 0.004f); // something to fall on that stays
        f->box(coarsest, {-0.012f, -0.012f, -0.012f}, {0.012f, 0.012f, 0.012f}, false, {s, 0, 0, c}, {0, 0.06f, 0});
        return f;
    };
    auto fine = fallen(0), coarse = fallen(3);
    for (int k = 0; k < 240; ++k) fine->step(), coarse->step();
    // Each has fallen in its own way in the end: how its particles stand to each other is what counts.
    coarse->budget.work.coarsestLevel = 0;
    coarse->step(12);
    REQUIRE(coarse->counters().levels[0] == coarse->counters().particles);
    REQUIRE(coarse->counters().particles == fine->counters().particles);
    const auto distances = [](const WorldFixture& f) { // of each to its nearest
        const auto p = sortedPositions(f);
        std::vector<float> d;
        for (size_t i = 0; i < p.size(); ++i) {
            float nearest = 1;
            for (size_t j = 0; j < p.size(); ++j)
                if (i != j)
                    nearest = std::min(nearest, std::hypot(p[i][0] - p[j][0], p[i][1] - p[j][1], p[i][2] - p[j][2]));
            d.push_back(nearest);
        }
        std::sort(d.begin(), d.end());
        return d;
    };
    const std::vector<float> a = distances(*fine), b = distances(*coarse);
    for (size_t k = 0; k < a.size(); k += 50) CHECK(b[k] == doctest::Approx(a[k]).epsilon(0.02));
}

TEST_CASE("levels: melting goes as with fine particles only, and keeps mass and energy") {
    Stump fine(0), coarse(3);
    // Later the ways of single drops decide: two fine ones whose source is 0.01 mm apart differ by 1 to 4 % then.
    for (const double tolerance : {0.01, 0.03, 0.08, 0.08, 0.08, 0.08}) {
        fine.step(60), coarse.step(60);
        const double melted = static_cast<double>(fine.counters().meltedFraction);
        CHECK(static_cast<double>(coarse.counters().meltedFraction) == doctest::Approx(melted).epsilon(tolerance));
    }
    CHECK(fine.counters().meltedFraction > 0.1f);
    CHECK(coarse.ledger().massError <= 1e-6);
    CHECK(coarse.ledger().energyError <= 1e-6);
    std::set<uint32_t> ids;
    const thawParticleView v = coarse.particles();
    for (int i = 0; i < v.count; ++i) {
        CHECK(ids.insert(v.ids[i]).second);
        if (v.liquidFractions[i] > 0.5f) CHECK(v.levels[i] == 0);
    }
}

TEST_CASE("levels: what was split for nothing merges back to the same particles") {
    Stump f(3, 8);
    const auto before = sortedPositions(f);
    const double mass = f.mass();
    f.step(10);
    REQUIRE(f.counters().particles > static_cast<int>(before.size()) * 5 / 4);
    REQUIRE(f.counters().meltedFraction == 0);
    REQUIRE(thawDestroyHeatSource(f.world, f.source) == thawResult_ok);
    f.step(900);
    const auto after = sortedPositions(f);
    REQUIRE(after.size() == before.size());
    for (const auto& x : before) {
        float nearest = 1;
        for (const auto& y : after) nearest = std::min(nearest, std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]));
        CHECK(nearest < 1e-6f);
    }
    CHECK(f.mass() == doctest::Approx(mass).epsilon(1e-12));
    CHECK(f.ledger().energyError <= 1e-6);
}

TEST_CASE("levels: an elastic body of coarse particles melts as one of fine ones does, which it is where it melts") {
    struct Jelly : WorldFixture {
        explicit Jelly(int coarsest, int workers = 2) {
            def.tasks.workerCount = workers, def.thermalTimeScale = 60;
            create();
            thawMaterialDef m;
            thawInitMaterialDef(&m, thawMaterial_wax);
            m.youngModulus = 5e4f;
            addMaterial(m), addFloor();
            const Shape s = boxShape({-0.016f, 0, -0.016f}, {0.016f, 0.048f, 0.016f});
            thawBodyDef d;
            thawInitBodyDef(&d);
            d.material = material, d.mesh = s.mesh(), d.coarsestLevel = coarsest;
            thawBodyId id;
            REQUIRE(thawCreateBody(world, &d, &id, nullptr) == thawResult_ok);
            addSource({0, 0.06f, 0}, 120);
        }
    };
    Jelly fine(0), coarse(3);
    CHECK(coarse.counters().particles * 4 <= fine.counters().particles);
    for (const double tolerance : {0.02, 0.05, 0.08}) {
        fine.step(60), coarse.step(60);
        const double melted = static_cast<double>(fine.counters().meltedFraction);
        CHECK(static_cast<double>(coarse.counters().meltedFraction) == doctest::Approx(melted).epsilon(tolerance));
    }
    CHECK(fine.counters().meltedFraction > 0.03f);
    CHECK(coarse.counters().particles < fine.counters().particles * 9 / 10);
    CHECK(coarse.ledger().massError <= 1e-6);
    CHECK(coarse.ledger().energyError <= 1e-6);
    const thawParticleView v = coarse.particles();
    for (int i = 0; i < v.count; ++i)
        if (v.liquidFractions[i] > 0) CHECK(v.levels[i] == 0);
    uint64_t first = 0;
    for (const int workers : {1, 2, 4}) {
        Jelly j(3, workers);
        j.step(90);
        const uint64_t hash = thawWorld_GetStateHash(j.world);
        if (workers == 1) first = hash;
        CHECK(hash == first);
    }
}

TEST_CASE("levels: an elastic body that spins and splits spins on, and its surface turns with it") {
    WorldFixture f;
    f.def.thermalTimeScale = 0, f.def.gravity = {0, 0, 0};
    f.create();
    thawMaterialDef m;
    thawInitMaterialDef(&m, thawMaterial_wax);
    m.youngModulus = 2e5f;
    f.addMaterial(m);
    const Shape s = boxShape({-0.016f, -0.012f, -0.008f}, {0.016f, 0.012f, 0.008f});
    thawBodyDef d;
    thawInitBodyDef(&d);
    d.material = f.material, d.mesh = s.mesh(), d.coarsestLevel = 3, d.anchored = false;
    d.velocity = {0.2f, 0.1f, 0}, d.angularVelocity = {0, 0, 6};
    thawBodyId id;
    REQUIRE(thawCreateBody(f.world, &d, &id, nullptr) == thawResult_ok);
    const int coarse = f.counters().particles;
    // rad/s about z, and the momentum.
    const auto spin = [&](double(&momentum)[3]) {
        const thawParticleView v = f.particles();
        double mass = 0, x[3] = {}, u[3] = {}, turns = 0, inertia = 0;
        for (int i = 0; i < v.count; ++i)
            for (int k = 0; k < 3; ++k) {
                const double w = static_cast<double>(v.velocities[4 * i + 3]);
                x[k] += w * static_cast<double>(v.positions[4 * i + k]), mass += k == 0 ? w : 0;
                u[k] += w * static_cast<double>(v.velocities[4 * i + k]);
            }
        for (int i = 0; i < v.count; ++i) {
            const double w = static_cast<double>(v.velocities[4 * i + 3]);
            const double dx = static_cast<double>(v.positions[4 * i]) - x[0] / mass;
            const double dy = static_cast<double>(v.positions[4 * i + 1]) - x[1] / mass;
            turns +=
                w * (dx * static_cast<double>(v.velocities[4 * i + 1]) - dy * static_cast<double>(v.velocities[4 * i]));
            inertia += w * (dx * dx + dy * dy);
        }
        for (int k = 0; k < 3; ++k) momentum[k] = u[k];
        return turns / inertia;
    };
    f.step(30);
    double before[3], after[3];
    const double was = spin(before);
    CHECK(was > 5);
    // The corners of a block of 32 x 24 mm, wherever it has turned to: the surface of coarse particles that lay as the
    // filling put them would stand out or in.
    thawSurfaceDef sd;
    thawInitSurfaceDef(&sd);
    const auto outermost = [&] {
        thawSurfaceView v;
        REQUIRE(thawWorld_ExtractSurface(f.world, &sd, &v) == thawResult_ok);
        thawBodyState state;
        REQUIRE(thawBody_GetState(f.world, id, &state) == thawResult_ok);
        double sum = 0;
        for (int i = 0; i < v.vertexCount; ++i)
            sum += std::hypot(static_cast<double>(v.positions[3 * i] - state.center.x),
                              static_cast<double>(v.positions[3 * i + 1] - state.center.y));
        return sum / v.vertexCount;
    };
    const double wide = outermost();
    thawBodyState now;
    REQUIRE(thawBody_GetState(f.world, id, &now) == thawResult_ok);
    const thawBrush brush{now.center, 1, 0};
    int painted = 0;
    REQUIRE(thawBody_PaintAbsorptivity(f.world, id, &brush, 0.7f, &painted) == thawResult_ok);
    REQUIRE(f.counters().particles >= 7 * coarse);
    CHECK(outermost() == doctest::Approx(wide).epsilon(0.002));
    CHECK(spin(after) == doctest::Approx(was).epsilon(0.01));
    for (int k = 0; k < 3; ++k) CHECK(std::abs(after[k] - before[k]) <= 1e-6 * std::hypot(before[0], before[1]));
    f.step(5);
    CHECK(spin(after) == doctest::Approx(was).epsilon(0.03));
    for (int k = 0; k < 3; ++k) CHECK(std::abs(after[k] - before[k]) <= 1e-5 * std::hypot(before[0], before[1]));
}

TEST_CASE("levels: the same bits on any number of threads") {
    uint64_t first = 0;
    for (int workers : {1, 2, 3}) {
        WorldFixture f;
        f.def.tasks.workerCount = workers;
        f.def.thermalTimeScale = 60;
        f.create(), f.addMaterial(), f.addFloor();
        const Shape s = boxShape({-0.012f, 0, -0.012f}, {0.012f, 0.04f, 0.012f});
        thawBodyDef d;
        thawInitBodyDef(&d);
        d.material = f.material, d.mesh = s.mesh(), d.coarsestLevel = 3;
        thawBodyId id;
        REQUIRE(thawCreateBody(f.world, &d, &id, nullptr) == thawResult_ok);
        f.addSource({0, 0.05f, 0}, 120);
        f.step(150);
        const uint64_t hash = thawWorld_GetStateHash(f.world);
        if (workers == 1) first = hash;
        CHECK(hash == first);
    }
}

TEST_CASE(
    "levels: a body with more points than there is room for starts coarse, says what stays coarse, or is refused") {
    WorldFixture f;
    f.def.maxParticles = 1000;
    f.def.thermalTimeScale = 60;
    f.create(), f.addMaterial(), f.addFloor();
    const Shape s = boxShape({-0.015f, 0, -0.015f}, {0.015f, 0.05f, 0.015f});
    thawBodyDef d;
    thawInitBodyDef(&d);
    d.material = f.material, d.mesh = s.mesh();
    thawBodyId id;
    CHECK(thawCreateBody(f.world, &d, &id, nullptr) == thawResult_capacity);
    d.coarsestLevel = 1;
    CHECK(thawCreateBody(f.world, &d, &id, nullptr) == thawResult_capacity);
    CHECK(std::string(thawWorld_GetLastError(f.world)).find("coarsestLevel") != std::string::npos);
    CHECK(f.counters().particles == 0);
    d.coarsestLevel = 3;
    REQUIRE(thawCreateBody(f.world, &d, &id, nullptr) == thawResult_ok);
    f.addSource({0, 0.06f, 0}, 200);
    const uint32_t status = f.step(300);
    CHECK((status & thawStep_splitsClipped) != 0);
    CHECK(f.counters().particles <= 1000);
    CHECK(f.counters().meltedFraction > 0.05f);
    CHECK(f.ledger().massError <= 1e-6);
    // A body that goes takes its points along: the others keep theirs.
    REQUIRE(thawDestroyBody(f.world, id) == thawResult_ok);
    f.step(2);
    CHECK(f.counters().particles == 0);
    REQUIRE(thawCreateBody(f.world, &d, &id, nullptr) == thawResult_ok);
    f.step(2);
}

TEST_CASE("levels: a pool at rest hardly notices that it merges and splits") {
    for (const float dx : {0.002f, 0.004f}) {
        WorldFixture f;
        f.def.particleSpacing = dx, f.def.thermalTimeScale = 0;
        f.create();
        thawMaterialDef m;
        thawInitMaterialDef(&m, thawMaterial_wax);
        m.viscosityLiquid = 1, m.cohesion = 0, m.adhesion = 0;
        f.addMaterial(m), f.addFloor();
        const float side = 10 * dx;
        for (int k = 0; k < 4; ++k) {
            thawColliderDef d;
            thawInitColliderDef(&d, thawCollider_box);
            d.size = {side, side, side};
            d.position = {k == 0   ? -side
                          : k == 1 ? 2 * side
                                   : 0.5f * side,
                          0.9f * side,
                          k == 2   ? -side
                          : k == 3 ? 2 * side
                                   : 0.5f * side};
            thawColliderId id;
            REQUIRE(thawCreateCollider(f.world, &d, &id, nullptr) == thawResult_ok);
        }
        f.addBox({0, 0, 0}, {side, side, side}, m.liquidus + 10);
        f.step(300);
        const auto state = [&](double& fastest, double& rms) {
            const thawParticleView v = f.particles();
            double most = 0, sum = 0, mass = 0;
            for (int i = 0; i < v.count; ++i) {
                const float* u = v.velocities + 4 * i;
                const double s2 = static_cast<double>(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
                most = std::max(most, s2), sum += static_cast<double>(u[3]) * s2, mass += static_cast<double>(u[3]);
            }
            fastest = std::max(fastest, std::sqrt(most)), rms = std::max(rms, std::sqrt(sum / mass));
        };
        const int rows = f.counters().particles;
        const float coarser = 2 * dx / 0.004f; // mm/s that an event may bring, as the spacing
        for (const int finest : {1, 0}) {
            double fastest = 0, rms = 0;
            f.budget.work.finestLevel = finest;
            float compression = 0;
            for (int k = 0; k < 900; ++k) {
                f.step(), state(fastest, rms);
                compression = std::max(compression, f.counters().meanCompression);
            }
            CHECK(1e3 * rms < static_cast<double>(1.6f * coarser));
            // A half that comes to lie behind a wall is pushed out of it at 12 and more.
            CHECK(1e3 * fastest < static_cast<double>((finest ? 20 : 10) * coarser));
            CHECK(compression < 0.03f);
            if (finest == 1)
                CHECK(f.counters().particles < rows * 11 / 20);
            else
                CHECK(f.counters().particles == rows);
            fastest = rms = 0, state(fastest, rms);
            CHECK(1e3 * rms < 0.3);
            CHECK(f.ledger().massError < 1e-6);
        }
    }
}

TEST_CASE("levels: heat runs along bricks of two and four points as it runs across them") {
    for (const int level : {1, 2}) {
        double passed[3];
        for (int axis = 0; axis < 3; ++axis) {
            WorldFixture f;
            f.def.thermalTimeScale = 400, f.def.gravity = {0, 0, 0}, f.def.convection = 0;
            f.def.particleSpacing = 0.002f;
            f.create();
            thawMaterialDef m;
            thawInitMaterialDef(&m, thawMaterial_wax);
            m.absorptivity = m.emissivity = 0, m.solidus = m.liquidus = 1e4f;
            f.addMaterial(m);
            f.budget.work.finestLevel = f.budget.work.coarsestLevel = level;
            for (const int half : {0, 1}) {
                float low[3] = {0, 0, 0}, high[3] = {0.024f, 0.024f, 0.024f};
                low[axis] = 0.032f * static_cast<float>(half), high[axis] = low[axis] + 0.032f;
                const Shape s = boxShape({low[0], low[1], low[2]}, {high[0], high[1], high[2]});
                thawBodyDef d;
                thawInitBodyDef(&d);
                d.material = f.material, d.mesh = s.mesh(), d.coarsestLevel = level;
                d.temperature = half ? 300.0f : 400.0f;
                thawBodyId id;
                REQUIRE(thawCreateBody(f.world, &d, &id, nullptr) == thawResult_ok);
            }
            REQUIRE(f.counters().levels[level] == f.counters().particles);
            f.step(120);
            passed[axis] = 0;
            const thawParticleView v = f.particles();
            for (int i = 0; i < v.count; ++i)
                if (v.positions[4 * i + axis] > 0.032f)
                    passed[axis] += static_cast<double>(v.temperatures[i] - 300) / v.count;
        }
        CHECK(passed[0] > 1);
        CHECK(passed[1] == doctest::Approx(passed[0]).epsilon(0.03));
        CHECK(passed[2] == doctest::Approx(passed[0]).epsilon(0.03));
    }
}

TEST_CASE("levels: paint on coarse particles is as fine as on fine ones, and does not merge away") {
    const auto painted = [](int coarsest, int maxParticles, std::map<std::array<int, 3>, int>& absorbs) {
        auto f = std::make_unique<WorldFixture>();
        f->def.maxParticles = maxParticles, f->def.gravity = {0, 0, 0};
        f->create(), f->addMaterial();
        const Shape s = boxShape({0, 0, 0}, {0.024f, 0.024f, 0.024f});
        thawBodyDef d;
        thawInitBodyDef(&d);
        d.material = f->material, d.mesh = s.mesh(), d.coarsestLevel = coarsest;
        thawBodyId id;
        REQUIRE(thawCreateBody(f->world, &d, &id, nullptr) == thawResult_ok);
        const thawBrush brush{{0.012f, 0.024f, 0.012f}, 0.0071f, 0};
        int32_t n = 0;
        REQUIRE(thawBody_PaintAbsorptivity(f->world, id, &brush, 0.75f, &n) == thawResult_ok);
        int seen = 0;
        const auto look = [&] {
            absorbs.clear(), seen = 0;
            const thawParticleView v = f->particles();
            for (int i = 0; i < v.count; ++i) {
                const float* x = v.positions + 4 * i;
                const auto at = [&](int a) { return static_cast<int>(std::lround(x[a] * 1e5f)); };
                absorbs[{at(0), at(1), at(2)}] = v.absorptivities[i];
                seen += v.absorptivities[i] > 0;
            }
        };
        look();
        CHECK(seen == n);
        f->step(200); // merging is free to happen
        look();
        return std::make_pair(n, seen);
    };
    std::map<std::array<int, 3>, int> fine, coarse, full;
    const auto [one, kept] = painted(0, 4000, fine);
    const auto [two, left] = painted(3, 4000, coarse);
    CHECK(one > 50);
    CHECK(one == kept);
    CHECK(two == one);
    // Every fine particle is the paint of the fine body there; what merged is within it or outside.
    CHECK(coarse.size() < fine.size());
    int mixed = 0, same = 0;
    for (const auto& [x, a] : coarse)
        if (const auto it = fine.find(x); it != fine.end()) (it->second == a ? same : mixed) += 1;
    CHECK(same > 30);
    CHECK(mixed == 0);
    CHECK(left <= two);
    // Where there is no room they are painted whole: those whose middle is in the brush.
    const auto [three, whole] = painted(3, static_cast<int>(fine.size() / 8), full);
    CHECK(full.size() == fine.size() / 8);
    CHECK(three > 0);
    CHECK(whole == three);
}
