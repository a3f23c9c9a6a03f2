// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world_fixture.h"

#include <algorithm>
#include <thread>

namespace {

// A small candle stump on a floor under a strong source: melts within seconds.
void stump(WorldFixture& f, float timeScale = 60, float power = 120) {
    f.def.thermalTimeScale = timeScale;
    f.create();
    f.addMaterial();
    f.addFloor();
    f.addBox({-0.012f, 0, -0.012f}, {0.012f, 0.04f, 0.012f});
    f.addSource({0, 0.05f, 0}, power);
}

} // namespace

TEST_CASE("world: an unheated body stands 60 s with no particle moving, and costs nothing") {
    WorldFixture f;
    f.create();
    f.addMaterial();
    f.addFloor();
    f.addBox({-0.012f, 0, -0.012f}, {0.012f, 0.05f, 0.012f});
    auto before = f.positions();
    f.step(60 * 60);
    auto after = f.positions();
    REQUIRE(after.size() == before.size());
    float worst = 0;
    for (auto& [id, x] : before) {
        thawVec3 y = after[id];
        worst = std::max({worst, std::abs(x.x - y.x), std::abs(x.y - y.y), std::abs(x.z - y.z)});
    }
    CHECK(worst <= 1e-5f);
    thawPlan p = f.plan();
    for (int s = thawStage_neighbors; s < thawStage_count; ++s) {
        CAPTURE(thawStageName(static_cast<thawStage>(s)));
        CHECK_FALSE(p.enabled[s]);
    }
    CHECK(f.counters().moving == 0);
}

TEST_CASE("world: melting keeps mass exactly and closes the energy ledger") {
    WorldFixture f;
    stump(f);
    const int count = f.counters().particles;
    f.step(600);
    CHECK(f.counters().particles == count);
    CHECK(f.counters().meltedFraction > 0.05f);
    CHECK(f.counters().moving > 20);
    CHECK(f.ledger().massError <= 1e-12);
    CHECK(f.ledger().energyError <= 1e-6);
    CHECK(f.ledger().absorbed > 0);
}

TEST_CASE("world: nothing leaks through the floor and nothing flies away") {
    WorldFixture f;
    stump(f, 150);
    for (int second = 0; second < 12; ++second) {
        f.step(60);
        thawParticleView v = f.particles();
        float lowest = 1, highest = 0, farthest = 0;
        for (int i = 0; i < v.count; ++i) {
            lowest = std::min(lowest, v.positions[4 * i + 1]), highest = std::max(highest, v.positions[4 * i + 1]);
            farthest = std::max(farthest, std::hypot(v.positions[4 * i], v.positions[4 * i + 2]));
        }
        CHECK(lowest >= 0.25f * f.def.particleSpacing);
        CHECK(highest <= 0.042f);
        CHECK(farthest <= 0.3f);
    }
    CHECK(f.counters().meltedFraction > 0.3f);
    CHECK(f.counters().moving > f.counters().particles / 5);
}

TEST_CASE("world: no drop is faster than its fall, under many sources") {
    for (int power = 115; power < 120; ++power) {
        WorldFixture f;
        stump(f, 150, static_cast<float>(power));
        int faster = 0;
        float highest = 0;
        for (int frame = 0; frame < 270; ++frame) {
            f.step();
            thawParticleView v = f.particles();
            for (int i = 0; i < v.count; ++i) {
                const float y = v.positions[4 * i + 1];
                const float *u = v.velocities + 4 * i, speed = std::hypot(u[0], u[1], u[2]);
                faster += speed > std::sqrt(2 * 9.81f * std::max(0.0f, 0.042f - y)) + 0.6f;
                highest = std::max(highest, y);
            }
        }
        CAPTURE(power);
        CHECK(faster == 0);
        CHECK(highest <= 0.05f);
    }
}

TEST_CASE("world: same plan, same state hash with 1, 2 and 4 threads and with the host's task system") {
    uint64_t expected[3] = {};
    for (int workers : {1, 2, 4}) {
        WorldFixture f;
        f.def.tasks.workerCount = workers;
        stump(f, 100);
        for (int k = 0; k < 3; ++k) {
            f.step(60);
            uint64_t h = thawWorld_GetStateHash(f.world);
            if (workers == 1) expected[k] = h;
            CAPTURE(workers);
            CHECK(h == expected[k]);
        }
        CHECK(f.counters().moving > 0);
    }
    WorldFixture f;
    f.def.tasks.workerCount = 3;
    f.def.tasks.enqueue = [](thawTask* task, void* context, void*) -> void* { return new std::thread(task, context); };
    f.def.tasks.finish = [](void* handle, void*) {
        auto* t = static_cast<std::thread*>(handle);
        t->join();
        delete t;
    };
    stump(f, 100);
    f.step(60);
    CHECK(thawWorld_GetStateHash(f.world) == expected[0]);
}

TEST_CASE("world: an elastic solid that melts has the same state hash with 1, 2, 3 and 4 threads") {
    // Softening and letting go read what neighbours in other blocks write.
    WorldFixture f[4];
    for (int n = 0; n < 4; ++n) {
        WorldFixture& w = f[n];
        w.def.tasks.workerCount = n + 1;
        w.def.particleSpacing = 0.004f, w.def.thermalTimeScale = 40;
        w.create();
        thawMaterialDef m;
        thawInitMaterialDef(&m, thawMaterial_wax);
        m.density = 1000, m.solidus = 300, m.liquidus = 310;
        m.viscositySolid = 1e3f, m.viscosityLiquid = 0.05f, m.youngModulus = 1e5f;
        w.addMaterial(m);
        w.addFloor();
        w.addBox({-0.024f, 0, -0.024f}, {0.024f, 0.056f, 0.024f}, 298);
        w.addSource({0.06f, 0.045f, 0}, 480);
    }
    for (int i = 0; i < 240; ++i) {
        f[0].step();
        for (int n = 1; n < 4; ++n) {
            f[n].step();
            REQUIRE(thawWorld_GetStateHash(f[n].world) == thawWorld_GetStateHash(f[0].world));
        }
    }
    CHECK(f[0].counters().meltedFraction > 0.02f);
    CHECK(f[0].counters().particles > 1500);
}

TEST_CASE("world: the governor's plan, fed back as work units, gives the same bits") {
    WorldFixture a, b;
    a.budget.mode = thawBudget_milliseconds, a.budget.milliseconds = 0.4f;
    stump(a, 100), stump(b, 100);
    bool varied = false;
    thawWork first{};
    for (int i = 0; i < 240; ++i) {
        a.step();
        thawPlan p = a.plan();
        if (i == 0) first = p.work;
        varied |= p.work.viscosityIterations != first.viscosityIterations || p.work.rayRefresh != first.rayRefresh;
        b.budget.work = p.work;
        b.step();
        REQUIRE(thawWorld_GetStateHash(a.world) == thawWorld_GetStateHash(b.world));
    }
    CHECK(varied); // the budget was tight enough to make the plan change
}

TEST_CASE("world: a late step gives up iterations, says so, and does it again from its plan") {
    WorldFixture late, again, whole;
    for (WorldFixture* f : {&late, &again, &whole}) stump(*f, 100);
    for (WorldFixture* f : {&late, &again, &whole}) f->step(60); // it melts
    late.budget.mode = thawBudget_milliseconds, late.budget.milliseconds = 0;
    late.budget.least = late.budget.most; // nothing but lateness may take work away
    late.budget.least.finestLevel = 0;
    whole.budget.work = late.budget.most;
    for (int i = 0; i < 60; ++i) {
        const uint32_t status = late.step();
        CHECK((status & thawStep_late) != 0);
        CHECK((status & thawStep_overBudget) != 0);
        CHECK(late.plan().work.lateAfter > 0);
        CHECK(late.plan().work.pressureIterations == late.budget.most.pressureIterations);
        again.budget.work = late.plan().work;
        CHECK((again.step() & (thawStep_late | thawStep_overBudget)) == thawStep_late);
        REQUIRE(thawWorld_GetStateHash(late.world) == thawWorld_GetStateHash(again.world));
        CHECK((whole.step() & thawStep_late) == 0);
        REQUIRE(late.counters().moving > 0);
        CHECK(late.counters().pressureIterations <= 2 * late.counters().subSteps);
        CHECK(late.counters().viscosityIterations <= 3 * late.counters().subSteps);
        CHECK(whole.counters().pressureIterations == 64 * whole.counters().subSteps);
    }
    CHECK(thawWorld_GetStateHash(late.world) != thawWorld_GetStateHash(whole.world));
    thawLedger l;
    thawWorld_GetLedger(late.world, &l);
    CHECK(l.massError == 0);
    CHECK(l.energyError < 1e-6);
}

TEST_CASE("world: a budget in units chooses the same on any number of threads, and keeps to it") {
    WorldFixture f[3];
    const int threads[3] = {1, 2, 4};
    for (int n = 0; n < 3; ++n) {
        f[n].def.tasks.workerCount = threads[n];
        f[n].budget.mode = thawBudget_units, f[n].budget.units = 900;
        stump(f[n], 100);
    }
    bool varied = false, over = false;
    thawWork first{};
    for (int i = 0; i < 240; ++i) {
        uint32_t status[3];
        for (int n = 0; n < 3; ++n) status[n] = f[n].step();
        for (int n = 1; n < 3; ++n) {
            REQUIRE(thawWorld_GetStateHash(f[n].world) == thawWorld_GetStateHash(f[0].world));
            REQUIRE(status[n] == status[0]);
        }
        const thawPlan p = f[0].plan();
        if (i == 0) first = p.work;
        varied |= p.work.pressureIterations != first.pressureIterations;
        over |= (status[0] & thawStep_overBudget) != 0;
        CHECK(((status[0] & thawStep_overBudget) != 0) == (p.units > 900));
    }
    CHECK(varied);
    CHECK_FALSE(over);
}

TEST_CASE("world: a body too big for its budget goes to the coarsest level and never stalls") {
    WorldFixture f;
    f.def.maxParticles = 20000;
    f.create();
    f.addMaterial();
    f.addFloor();
    f.budget.mode = thawBudget_units, f.budget.units = 0;
    f.addBox({-0.024f, 0, -0.024f}, {0.024f, 0.04f, 0.024f}, 360); // liquid: 11,520 particles
    const int start = f.counters().particles;
    REQUIRE(start > 10000);
    uint32_t status = 0;
    for (int i = 0; i < 400; ++i) {
        status = f.step();
        CHECK((status & thawStep_refused) == 0);
    }
    CHECK((status & thawStep_overBudget) != 0);
    CHECK(f.plan().work.finestLevel == 3);
    CHECK(f.counters().steps == 400);
    CHECK(f.counters().particles < start / 4);
    CHECK(f.counters().levels[3] > f.counters().particles / 2);
    thawLedger l;
    thawWorld_GetLedger(f.world, &l);
    CHECK(l.massError < 1e-6);
}

TEST_CASE("world: the hash tells worlds apart") {
    WorldFixture a, b;
    stump(a), stump(b);
    a.step(30), b.step(30);
    REQUIRE(thawWorld_GetStateHash(a.world) == thawWorld_GetStateHash(b.world));
    thawWorld_SetGravity(b.world, {0, -9.80f, 0});
    CHECK(thawWorld_GetStateHash(a.world) != thawWorld_GetStateHash(b.world));
}

TEST_CASE("world: a piece that nothing holds falls as a lump, lands and is held again") {
    WorldFixture f;
    f.create();
    f.addMaterial();
    f.addFloor();
    thawBodyId body = f.addBox({-0.008f, 0.03f, -0.008f}, {0.008f, 0.046f, 0.008f});
    thawBodyState start, s;
    thawBody_GetState(f.world, body, &start);
    f.step(3); // it is found to hang on nothing
    CHECK(f.counters().moving == f.counters().particles);
    f.step(120);
    thawBody_GetState(f.world, body, &s);
    CHECK(s.center.y == doctest::Approx(0.008f).epsilon(0.12).scale(0));
    CHECK(s.lower.y >= 0.25f * f.def.particleSpacing);
    // Still a cube: its extent changed by less than a spacing.
    CHECK(s.upper.x - s.lower.x < start.upper.x - start.lower.x + f.def.particleSpacing);
    CHECK(s.upper.y - s.lower.y > start.upper.y - start.lower.y - f.def.particleSpacing);
    CHECK(f.counters().moving == 0);
}

TEST_CASE("world: liquid cools, sets and then stands still") {
    WorldFixture f;
    f.def.thermalTimeScale = 300;
    f.def.convection = 100;
    f.create();
    f.addMaterial();
    f.addFloor();
    f.addBox({-0.008f, 0, -0.008f}, {0.008f, 0.012f, 0.008f}, 335); // liquid
    f.step(2);
    CHECK(f.counters().moving == f.counters().particles);
    f.step(1500);
    CHECK(f.counters().meltedFraction == 0);
    CHECK(f.counters().moving == 0);
    auto before = f.positions();
    f.step(300);
    CHECK(f.positions().at(1).y == before.at(1).y);
    thawLedger l = f.ledger();
    CHECK(l.energyError <= 1e-6);
}

TEST_CASE("world: destroying a body takes its mass and energy out of the ledger") {
    WorldFixture f;
    f.create();
    f.addMaterial();
    f.addFloor();
    thawBodyId a = f.addBox({-0.02f, 0, -0.005f}, {-0.01f, 0.01f, 0.005f});
    f.addBox({0.01f, 0, -0.005f}, {0.02f, 0.01f, 0.005f});
    f.step(5);
    const int count = f.counters().particles;
    REQUIRE(thawDestroyBody(f.world, a) == thawResult_ok);
    CHECK(f.counters().particles == count / 2);
    f.step(5);
    thawLedger l = f.ledger();
    CHECK(l.massRemoved == doctest::Approx(l.massAdded / 2).epsilon(0.01).scale(0));
    CHECK(l.massError <= 1e-12);
    CHECK(l.energyError <= 1e-9);
}

TEST_CASE("world: heat every n-th step loses no heat time") {
    double absorbed[2];
    int k = 0;
    for (int interval : {1, 4}) {
        WorldFixture f;
        f.budget.work.heatInterval = interval;
        f.def.convection = 0;
        f.def.thermalTimeScale = 2;
        stump(f, 2);
        f.step(120);
        absorbed[k++] = f.ledger().absorbed;
    }
    CHECK(absorbed[1] == doctest::Approx(absorbed[0]).epsilon(0.03).scale(0));
}

TEST_CASE("world: an empty world steps and answers") {
    WorldFixture f;
    f.create();
    f.step(10);
    CHECK(f.counters().particles == 0);
    thawSurfaceDef d;
    thawInitSurfaceDef(&d);
    thawSurfaceView v;
    CHECK(thawWorld_ExtractSurface(f.world, &d, &v) == thawResult_ok);
    CHECK(v.triangleCount == 0);
    CHECK(f.plan().reason[thawStage_pressure] == thawReason_noParticles);
}
