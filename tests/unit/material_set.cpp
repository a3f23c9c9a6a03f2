// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world_fixture.h"

#include <algorithm>
#include <limits>

namespace {

thawMaterialDef preset(thawMaterialPreset kind = thawMaterial_wax) {
    thawMaterialDef m;
    thawInitMaterialDef(&m, kind);
    return m;
}

struct Half { // a block on a floor whose upper half is hot, or all of it has one temperature
    WorldFixture f;
    thawBodyId body{};
    explicit Half(const thawMaterialDef& m, float temperature = NAN, int coarsest = 0, bool anchored = true) {
        f.def.particleSpacing = 0.004f, f.def.convection = 0;
        f.create();
        f.addMaterial(m);
        f.addFloor();
        const Shape s = boxShape({0, 0, 0}, {0.04f, 0.04f, 0.04f});
        thawBodyDef d;
        thawInitBodyDef(&d);
        d.material = f.material, d.mesh = s.mesh(), d.temperature = temperature, d.coarsestLevel = coarsest;
        d.anchored = anchored;
        REQUIRE_MESSAGE(thawCreateBody(f.world, &d, &body, nullptr) == thawResult_ok, thawWorld_GetLastError(f.world));
    }
    thawResult set(const thawMaterialDef& m) { return thawMaterial_Set(f.world, f.material, &m); }
    void paint(float temperature) {
        const thawBrush brush{{0.02f, 0.04f, 0.02f}, 0.03f, 0.5f};
        REQUIRE(thawBody_PaintTemperature(f.world, body, &brush, temperature, nullptr) == thawResult_ok);
    }
};

bool near(double a, double b, double share) { return std::abs(a - b) <= share * std::abs(b); }

void checkBooked(const WorldFixture& f) {
    CHECK(f.ledger().massError < 1e-9);
    CHECK(f.ledger().energyError < 1e-9);
}

} // namespace

TEST_CASE("material set: what is there keeps its temperature and melts by the new range, the heat is booked") {
    Half h(preset(), 300);
    h.paint(340);
    h.f.step(3);
    const thawParticleView before = h.f.particles();
    std::vector<float> kelvin(before.temperatures, before.temperatures + before.count);
    std::vector<float> was(before.liquidFractions, before.liquidFractions + before.count);
    const thawLedger then = h.f.ledger();

    thawMaterialDef m = preset();
    m.solidus = 300, m.liquidus = 330, m.latentHeat = 1e5f, m.specificHeatLiquid = 3000;
    REQUIRE(h.set(m) == thawResult_ok);
    const thawParticleView v = h.f.particles();
    int melting = 0;
    for (int i = 0; i < v.count; ++i) {
        CHECK(v.temperatures[i] == doctest::Approx(kelvin[static_cast<size_t>(i)]).epsilon(1e-6));
        const float T = v.temperatures[i];
        CHECK(v.liquidFractions[i] == doctest::Approx(std::clamp((T - 300) / 30, 0.0f, 1.0f)).epsilon(1e-4));
        melting += v.liquidFractions[i] != was[static_cast<size_t>(i)];
    }
    CHECK(melting > 20);
    CHECK(std::abs(h.f.ledger().redefined) > 1);
    CHECK(h.f.ledger().redefined == doctest::Approx(h.f.ledger().energyNow - then.energyNow).epsilon(1e-9));
    checkBooked(h.f);
    h.f.step(5);
    checkBooked(h.f);
    CHECK(h.f.counters().moving > 50);
}

TEST_CASE("material set: the same again changes nothing, another colour nothing that is stepped") {
    Half a(preset(), 300), b(preset(), 300);
    a.paint(340), b.paint(340);
    a.f.step(4), b.f.step(4);
    const uint64_t hash = thawWorld_GetStateHash(a.f.world);
    thawMaterialDef m = preset();
    m.color = {1, 0, 0};
    REQUIRE(a.set(m) == thawResult_ok);
    CHECK(thawWorld_GetStateHash(a.f.world) == hash);
    a.f.step(4), b.f.step(4);
    CHECK(thawWorld_GetStateHash(a.f.world) == thawWorld_GetStateHash(b.f.world));
    m.viscosityLiquid *= 2;
    REQUIRE(a.set(m) == thawResult_ok);
    CHECK(thawWorld_GetStateHash(a.f.world) != thawWorld_GetStateHash(b.f.world));
    CHECK(a.f.ledger().redefined == 0);
}

TEST_CASE("material set: without a melting range, half molten stays half molten") {
    thawMaterialDef m = preset(thawMaterial_ice);
    m.solidus = m.liquidus = 273.15f;
    Half h(m, 273.15f);
    thawHeatSourceId lamp = h.f.addSource({0.02f, 0.06f, 0.02f}, 2000);
    h.f.step(60);
    const float melted = h.f.counters().meltedFraction;
    CHECK(melted > 0.002f);
    m.latentHeat *= 3;
    REQUIRE(h.set(m) == thawResult_ok);
    CHECK(near(h.f.counters().meltedFraction, melted, 1e-5));
    CHECK(h.f.ledger().redefined > 0);
    REQUIRE(thawDestroyHeatSource(h.f.world, lamp) == thawResult_ok);
    h.f.step(2);
    checkBooked(h.f);
}

TEST_CASE("material set: another density is another mass, with its heat in the ledger") {
    Half h(preset(), 350);
    h.f.step(10);
    const thawLedger before = h.f.ledger();
    for (const float factor : {2.0f, 0.5f}) {
        CAPTURE(factor);
        thawMaterialDef m = preset();
        m.density *= factor;
        REQUIRE(h.set(m) == thawResult_ok);
        CHECK(near(h.f.ledger().massNow, static_cast<double>(factor) * before.massNow, 1e-6));
        CHECK(near(h.f.ledger().energyNow, static_cast<double>(factor) * before.energyNow, 1e-6));
        checkBooked(h.f);
    }
    // It lies as it did: the pressure bears the new weight.
    h.f.step(60);
    thawMaterialDef m = preset();
    m.density *= 2;
    const float still = h.f.counters().maxSpeed;
    REQUIRE(h.set(m) == thawResult_ok);
    h.f.step(1);
    CHECK(h.f.counters().maxSpeed < 2 * still + 0.02f);
    CHECK(h.f.counters().maxCompression < 0.1f);
}

TEST_CASE("material set: what is undercooled sets when the new material does not undercool") {
    thawMaterialDef m = preset(thawMaterial_ice);
    m.undercooling = 20;
    Half h(m, 280);
    h.paint(280);
    h.f.step(2);
    thawMaterialDef warm = m;
    warm.solidus = warm.liquidus = 290; // 10 K below its melting point now
    REQUIRE(h.set(warm) == thawResult_ok);
    h.f.step(1);
    CHECK(h.f.counters().meltedFraction == doctest::Approx(1));
    CHECK(h.f.counters().maxTemperature == doctest::Approx(280).epsilon(1e-4));
    warm.undercooling = 0;
    const double heat = h.f.ledger().energyNow;
    REQUIRE(h.set(warm) == thawResult_ok);
    CHECK(h.f.ledger().energyNow == heat);
    h.f.step(1);
    CHECK(h.f.counters().meltedFraction < 0.95f);
    CHECK(h.f.counters().meltedFraction > 0.5f);
    CHECK(h.f.counters().minTemperature == doctest::Approx(290).epsilon(1e-3));
    checkBooked(h.f);
}

TEST_CASE("material set: rigid becomes elastic and sags, elastic becomes rigid and stays as it is") {
    for (const int coarsest : {0, 3}) {
        CAPTURE(coarsest);
        Half h(preset(), 300, coarsest);
        h.f.step(5);
        CHECK(h.f.counters().moving == 0);
        const auto top = [&] {
            float y = 0;
            for (const auto& [id, x] : h.f.positions()) y = std::max(y, x.y);
            return y;
        };
        const float high = top();
        thawMaterialDef soft = preset();
        soft.youngModulus = 2000, soft.viscositySolid = 2;
        REQUIRE_MESSAGE(h.set(soft) == thawResult_ok, thawWorld_GetLastError(h.f.world));
        h.f.step(120);
        const float sagged = top();
        CHECK(sagged < high - 0.001f); // rho g h^2 / 2E = 3 mm
        CHECK(sagged > high - 0.008f);
        soft.youngModulus = 20000;
        REQUIRE(h.set(soft) == thawResult_ok);
        h.f.step(240);
        const float stiff = top();
        CHECK(stiff > sagged + 0.0008f);
        REQUIRE(h.set(preset()) == thawResult_ok);
        h.f.step(30);
        CHECK(h.f.counters().moving == 0);
        CHECK(near(top(), stiff, 1e-3));
        checkBooked(h.f);
    }
}

TEST_CASE("material set: a jelly in flight that becomes rigid flies on as one piece, and back") {
    thawMaterialDef soft = preset();
    soft.youngModulus = 20000;
    Half h(soft, 300, 0, false);
    const Shape s = boxShape({0.1f, 0.3f, 0}, {0.13f, 0.33f, 0.03f});
    thawBodyDef d;
    thawInitBodyDef(&d);
    d.material = h.f.material, d.mesh = s.mesh(), d.temperature = 300, d.velocity = {0.5f, 0, 0};
    d.angularVelocity = {0, 0, 3}, d.anchored = false;
    thawBodyId flying;
    REQUIRE(thawCreateBody(h.f.world, &d, &flying, nullptr) == thawResult_ok);
    const auto x = [&] {
        thawBodyState b;
        REQUIRE(thawBody_GetState(h.f.world, flying, &b) == thawResult_ok);
        return b.center;
    };
    h.f.step(3);
    thawVec3 a = x();
    const int pieces = h.f.counters().pieces;
    REQUIRE(h.set(preset()) == thawResult_ok);
    h.f.step(3);
    CHECK(h.f.counters().pieces >= pieces + 1);
    thawVec3 b = x();
    CHECK(near(b.x - a.x, 0.5 * 3 / 60, 0.03));
    REQUIRE(h.set(soft) == thawResult_ok);
    CHECK(h.f.counters().pieces == 0);
    h.f.step(3);
    CHECK(near(x().x - b.x, 0.5 * 3 / 60, 0.03));
    CHECK(x().y < b.y);
}

TEST_CASE("material set: refused like creation, with the world unchanged") {
    Half h(preset(), 300, 2);
    h.paint(340);
    h.f.step(3);
    const uint64_t hash = thawWorld_GetStateHash(h.f.world);
    thawMaterialDef m = preset();
    m.density = 0;
    CHECK(h.set(m) == thawResult_invalidArgument);
    CHECK(std::string(thawWorld_GetLastError(h.f.world)).find("density") == 0);
    m = preset(), m.solidus = NAN;
    CHECK(h.set(m) == thawResult_invalidArgument);
    m = preset(), m.cookie = 0;
    CHECK(h.set(m) == thawResult_notInitialised);
    m = preset(), m.viscosityLiquid *= 2;
    WorldFixture other;
    other.create();
    for (const thawMaterialId id : {thawMaterialId{}, other.addMaterial(), thawMaterialId{2, h.f.material.world, 1}}) {
        CHECK(thawMaterial_Set(h.f.world, id, &m) == thawResult_staleId);
    }
    CHECK(thawMaterial_Set(nullptr, h.f.material, &m) == thawResult_invalidArgument);
    CHECK(thawMaterial_Set(h.f.world, h.f.material, nullptr) == thawResult_invalidArgument);
    CHECK(thawWorld_GetStateHash(h.f.world) == hash);
}

TEST_CASE("material set: coarse solid that cannot split stays rigid") {
    WorldFixture f;
    f.def.particleSpacing = 0.004f, f.def.maxParticles = 400;
    f.create();
    f.addMaterial();
    f.addFloor();
    const Shape s = boxShape({0, 0, 0}, {0.04f, 0.04f, 0.04f});
    thawBodyDef d;
    thawInitBodyDef(&d);
    d.material = f.material, d.mesh = s.mesh(), d.temperature = 280, d.coarsestLevel = 2;
    thawBodyId body;
    REQUIRE_MESSAGE(thawCreateBody(f.world, &d, &body, nullptr) == thawResult_ok, thawWorld_GetLastError(f.world));
    const uint64_t hash = thawWorld_GetStateHash(f.world);
    thawMaterialDef soft = preset();
    soft.youngModulus = 1e4f;
    CHECK(thawMaterial_Set(f.world, f.material, &soft) == thawResult_capacity);
    CHECK(std::string(thawWorld_GetLastError(f.world)).find("youngModulus") == 0);
    CHECK(thawWorld_GetStateHash(f.world) == hash);
}

TEST_CASE("material set: the same bits on any number of threads") {
    uint64_t hashes[3];
    int n = 0;
    for (const int workers : {1, 2, 4}) {
        WorldFixture f;
        f.def.particleSpacing = 0.004f, f.def.tasks.workerCount = workers;
        f.create();
        f.addMaterial();
        f.addFloor();
        f.addBox({0, 0, 0}, {0.04f, 0.06f, 0.04f}, 320);
        f.addSource({0.06f, 0.03f, 0.02f}, 60);
        for (int k = 0; k < 30; ++k) {
            thawMaterialDef m = preset();
            m.solidus = 325 - 0.5f * static_cast<float>(k), m.density = 800 + 10 * static_cast<float>(k);
            m.youngModulus = k > 10 && k < 20 ? 1e4f : 0;
            REQUIRE(thawMaterial_Set(f.world, f.material, &m) == thawResult_ok);
            f.step();
        }
        checkBooked(f);
        hashes[n++] = thawWorld_GetStateHash(f.world);
    }
    CHECK(hashes[0] == hashes[1]);
    CHECK(hashes[0] == hashes[2]);
}

namespace {

// A brick on a slope, as one piece.
struct Slope : WorldFixture {
    thawColliderId floor{};
    explicit Slope(float youngModulus = 0) {
        def.particleSpacing = 0.004f, def.thermalTimeScale = 0;
        def.gravity = {9.81f * std::sin(0.3f), -9.81f * std::cos(0.3f), 0};
        create();
        thawMaterialDef m = preset();
        m.youngModulus = youngModulus;
        addMaterial(m);
        thawColliderDef d;
        thawInitColliderDef(&d, thawCollider_plane);
        d.friction = 1;
        REQUIRE(thawCreateCollider(world, &d, &floor, nullptr) == thawResult_ok);
    }
    thawBodyId brick() {
        const Shape s = boxShape({0, 0.002f, 0}, {0.032f, 0.018f, 0.032f});
        thawBodyDef b;
        thawInitBodyDef(&b);
        b.material = material, b.mesh = s.mesh(), b.temperature = 300, b.anchored = false;
        thawBodyId id;
        REQUIRE(thawCreateBody(world, &b, &id, nullptr) == thawResult_ok);
        return id;
    }
    float x(thawBodyId id) {
        thawBodyState s;
        REQUIRE(thawBody_GetState(world, id, &s) == thawResult_ok);
        return s.center.x;
    }
};

} // namespace

TEST_CASE("collider surface: a brick that sleeps on a slope slides when the friction goes") {
    Slope f;
    const thawBodyId id = f.brick();
    f.step(90);
    const float at = f.x(id);
    f.step(10);
    REQUIRE(f.x(id) == at);
    REQUIRE(thawCollider_SetSurface(f.world, f.floor, true, true, 0, 0) == thawResult_ok);
    f.step(30);
    // 1/2 g sin(0.3) t^2 = 0.36 m
    CHECK(near(f.x(id) - at, 0.5 * 9.81 * std::sin(0.3) * 0.25, 0.1));
}

TEST_CASE("collider surface: what hangs on it goes on hanging, melt slides on what lets it") {
    WorldFixture f;
    f.def.particleSpacing = 0.004f, f.def.thermalTimeScale = 0;
    f.create();
    f.addMaterial();
    thawColliderDef d;
    thawInitColliderDef(&d, thawCollider_box);
    d.size = {0.05f, 0.01f, 0.05f}, d.position = {0, 0.1f, 0};
    thawColliderId plate;
    REQUIRE(thawCreateCollider(f.world, &d, &plate, nullptr) == thawResult_ok);
    f.addBox({-0.02f, 0.06f, -0.02f}, {0.02f, 0.09f, 0.02f}, 300);
    f.step(5);
    const auto before = f.positions();
    REQUIRE(f.counters().fixed == f.counters().particles);
    REQUIRE(thawCollider_SetSurface(f.world, plate, false, false, 0.1f, 0) == thawResult_ok);
    f.step(20);
    CHECK(f.counters().fixed == f.counters().particles);
    const auto after = f.positions();
    for (const auto& [id, x] : before) CHECK(after.at(id).y == x.y);
}

TEST_CASE("collider surface: melt on an incline runs faster where it slips") {
    const auto run = [](float slip) {
        WorldFixture f;
        f.def.particleSpacing = 0.004f, f.def.thermalTimeScale = 0;
        f.def.gravity = {9.81f * std::sin(0.3f), -9.81f * std::cos(0.3f), 0};
        f.create();
        thawMaterialDef m = preset();
        m.viscosityLiquid = 1;
        f.addMaterial(m);
        const thawColliderId floor = f.addFloor();
        const thawBodyId id = f.addBox({0, 0, 0}, {0.06f, 0.016f, 0.06f}, 350);
        f.step(5);
        REQUIRE(thawCollider_SetSurface(f.world, floor, true, true, slip, 0.5f) == thawResult_ok);
        f.step(30);
        thawBodyState s;
        REQUIRE(thawBody_GetState(f.world, id, &s) == thawResult_ok);
        return s.center.x;
    };
    CHECK(run(1) > run(0) + 0.03f);
}

TEST_CASE("collider surface: one that is no occluder any more lets the sun through") {
    WorldFixture f;
    f.def.particleSpacing = 0.004f, f.def.convection = 0;
    f.create();
    f.addMaterial();
    f.addFloor();
    f.addBox({0, 0, 0}, {0.04f, 0.02f, 0.04f}, 300);
    thawColliderDef d;
    thawInitColliderDef(&d, thawCollider_box);
    d.size = {0.1f, 0.01f, 0.1f}, d.position = {0.02f, 0.1f, 0.02f};
    thawColliderId roof;
    REQUIRE(thawCreateCollider(f.world, &d, &roof, nullptr) == thawResult_ok);
    f.addSource({0.02f, 0.2f, 0.02f}, 50);
    const auto absorbed = [&] {
        const double before = f.ledger().absorbed;
        f.step(3);
        return f.ledger().absorbed - before;
    };
    const double shade = absorbed();
    REQUIRE(thawCollider_SetSurface(f.world, roof, true, false, 0, 0.5f) == thawResult_ok);
    const double light = absorbed();
    REQUIRE(thawCollider_SetSurface(f.world, roof, true, true, 0, 0.5f) == thawResult_ok);
    CHECK(shade == 0);
    CHECK(light > 0);
    CHECK(absorbed() == 0);
}

TEST_CASE("collider surface: refused out of range and for who is not there") {
    WorldFixture f;
    f.create();
    const thawColliderId floor = f.addFloor();
    const uint64_t hash = thawWorld_GetStateHash(f.world);
    CHECK(thawCollider_SetSurface(f.world, floor, true, true, -1, 0) == thawResult_invalidArgument);
    CHECK(thawCollider_SetSurface(f.world, floor, true, true, 0, NAN) == thawResult_invalidArgument);
    CHECK(thawCollider_SetSurface(f.world, {}, true, true, 0, 0) == thawResult_staleId);
    CHECK(thawCollider_SetSurface(nullptr, floor, true, true, 0, 0) == thawResult_invalidArgument);
    CHECK(thawWorld_GetStateHash(f.world) == hash);
    CHECK(thawCollider_SetSurface(f.world, floor, true, true, 0, 0.1f) == thawResult_ok);
    CHECK(thawWorld_GetStateHash(f.world) != hash);
}
