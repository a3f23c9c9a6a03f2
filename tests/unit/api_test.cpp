// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world_fixture.h"

#include <cstring>

namespace {

std::string error(const WorldFixture& f) { return thawWorld_GetLastError(f.world); }
bool contains(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }
// As a C host may; a cast would be undefined here already.
template <class Enum> void store(Enum& e, int value) {
    static_assert(sizeof e == sizeof value);
    std::memcpy(&e, &value, sizeof value);
}

} // namespace

TEST_CASE("api: a definition that no thawInit function filled is refused") {
    thawWorldDef empty{};
    thawWorld* world = reinterpret_cast<thawWorld*>(1);
    char message[128] = "";
    CHECK(thawCreateWorld(&empty, &world, message, sizeof message) == thawResult_notInitialised);
    CHECK(world == nullptr);
    CHECK(contains(message, "worldDef"));
    CHECK(thawCreateWorld(nullptr, &world, nullptr, 0) == thawResult_invalidArgument);

    WorldFixture f;
    f.create();
    thawMaterialDef material{};
    thawMaterialId id;
    CHECK(thawCreateMaterial(f.world, &material, &id) == thawResult_notInitialised);
    thawInitMaterialDef(&material, thawMaterial_wax);
    material.structSize += 4; // of another version
    CHECK(thawCreateMaterial(f.world, &material, &id) == thawResult_notInitialised);
}

TEST_CASE("api: a field of the world out of range is named with its value") {
    struct Case {
        const char* field;
        void (*spoil)(thawWorldDef&);
        const char* value;
    };
    const Case cases[] = {
        {"particleSpacing", [](thawWorldDef& d) { d.particleSpacing = 0; }, "0"},
        {"particleSpacing", [](thawWorldDef& d) { d.particleSpacing = NAN; }, "nan"},
        {"maxParticles", [](thawWorldDef& d) { d.maxParticles = 10000000; }, "1e+07"},
        {"maxParticles", [](thawWorldDef& d) { d.maxParticles = -1; }, "-1"},
        {"gravity", [](thawWorldDef& d) { d.gravity.y = INFINITY; }, "inf"},
        {"ambientTemperature", [](thawWorldDef& d) { d.ambientTemperature = -1; }, "-1"},
        {"convection", [](thawWorldDef& d) { d.convection = -3; }, "-3"},
        {"thermalTimeScale", [](thawWorldDef& d) { d.thermalTimeScale = 2e5f; }, "200000"},
        {"thermalTimeScale", [](thawWorldDef& d) { d.thermalTimeScale = -1; }, "-1"},
        {"thermalTimeScale", [](thawWorldDef& d) { d.thermalTimeScale = NAN; }, "nan"},
        {"tasks.workerCount", [](thawWorldDef& d) { d.tasks.workerCount = 0; }, "0"},
        {"allocator",
         [](thawWorldDef& d) { d.allocator.alloc = [](size_t, size_t, void*) -> void* { return nullptr; }; }, "both"},
    };
    for (const Case& c : cases) {
        WorldFixture f;
        c.spoil(f.def);
        char message[256] = "";
        CAPTURE(c.field);
        CHECK(thawCreateWorld(&f.def, &f.world, message, sizeof message) == thawResult_invalidArgument);
        CHECK(contains(message, c.field));
        CHECK(contains(message, c.value));
    }
}

TEST_CASE("api: a field of a material out of range is named with its value") {
    WorldFixture f;
    f.create();
    struct Case {
        const char* field;
        void (*spoil)(thawMaterialDef&);
    };
    const Case cases[] = {
        {"density", [](thawMaterialDef& d) { d.density = -5; }},
        {"density", [](thawMaterialDef& d) { d.density = NAN; }},
        {"liquidus", [](thawMaterialDef& d) { d.liquidus = d.solidus - 1; }},
        {"latentHeat", [](thawMaterialDef& d) { d.latentHeat = -1; }},
        {"specificHeatSolid", [](thawMaterialDef& d) { d.specificHeatSolid = 0; }},
        {"conductivityLiquid", [](thawMaterialDef& d) { d.conductivityLiquid = -1; }},
        {"viscosityLiquid", [](thawMaterialDef& d) { d.viscosityLiquid = 0; }},
        {"yieldStress", [](thawMaterialDef& d) { d.yieldStress = -1; }},
        {"viscositySolid", [](thawMaterialDef& d) { d.viscositySolid = 1e9f; }},
        {"absorptivity", [](thawMaterialDef& d) { d.absorptivity = 1.5f; }},
        {"emissivity", [](thawMaterialDef& d) { d.emissivity = -0.1f; }},
        {"setFraction", [](thawMaterialDef& d) { d.setFraction = d.releaseFraction + 0.1f; }},
        {"youngModulus", [](thawMaterialDef& d) { d.youngModulus = -1; }},
        {"solidYieldStress", [](thawMaterialDef& d) { d.solidYieldStress = NAN; }},
        {"relaxationTime", [](thawMaterialDef& d) { d.relaxationTime = -1; }},
        {"breakStrain", [](thawMaterialDef& d) { d.breakStrain = 1.5f; }},
        {"burnTemperature", [](thawMaterialDef& d) { d.burnTemperature = d.liquidus - 1; }},
        {"vapourHeat", [](thawMaterialDef& d) { d.vapourHeat = -1; }},
        {"burnRate", [](thawMaterialDef& d) { d.burnRate = NAN; }},
        {"undercooling", [](thawMaterialDef& d) { d.undercooling = -1; }},
        {"undercooling", [](thawMaterialDef& d) { d.undercooling = d.solidus; }},
        {"color", [](thawMaterialDef& d) { d.color.z = NAN; }},
    };
    for (const Case& c : cases) {
        thawMaterialDef d;
        thawInitMaterialDef(&d, thawMaterial_wax);
        c.spoil(d);
        thawMaterialId id{7, 7, 7};
        CAPTURE(c.field);
        CHECK(thawCreateMaterial(f.world, &d, &id) == thawResult_invalidArgument);
        CHECK(id.index1 == 0);
        CHECK(contains(error(f), c.field));
        CHECK(f.counters().materials == 0);
    }
}

TEST_CASE("api: a field of a collider out of range is named with its value") {
    struct Case {
        const char* field;
        thawColliderType type;
        void (*spoil)(thawColliderDef&);
        const char* value;
    };
    const Case cases[] = {
        {"type", thawCollider_plane, [](thawColliderDef& d) { store(d.type, 9); }, "9"},
        {"type", thawCollider_plane, [](thawColliderDef& d) { store(d.type, -1); }, "-1"},
        {"position", thawCollider_plane, [](thawColliderDef& d) { d.position.y = NAN; }, "nan"},
        {"rotation", thawCollider_plane, [](thawColliderDef& d) { d.rotation.w = 2; }, "2"},
        {"size.x", thawCollider_sphere, [](thawColliderDef& d) { d.size.x = 0; }, "0"},
        {"size.y", thawCollider_box, [](thawColliderDef& d) { d.size.y = -3; }, "-3"},
        {"scale", thawCollider_mesh, [](thawColliderDef& d) { d.scale = 0; }, "0"},
        {"mesh", thawCollider_mesh, [](thawColliderDef&) {}, ""},
    };
    WorldFixture f;
    f.create();
    const uint64_t before = thawWorld_GetStateHash(f.world);
    for (const Case& c : cases) {
        thawColliderDef d;
        thawInitColliderDef(&d, c.type);
        c.spoil(d);
        thawColliderId id{1, 1, 1};
        CAPTURE(c.field);
        CHECK(thawCreateCollider(f.world, &d, &id, nullptr) != thawResult_ok);
        CHECK(contains(error(f), c.field));
        CHECK(contains(error(f), c.value));
        CHECK(id.index1 == 0);
    }
    CHECK(thawWorld_GetStateHash(f.world) == before);
}

TEST_CASE("api: presets are valid, named and distinct") {
    WorldFixture f;
    f.create();
    for (int p = 0; p < thawMaterial_presetCount; ++p) {
        thawMaterialDef d;
        thawInitMaterialDef(&d, static_cast<thawMaterialPreset>(p));
        thawMaterialId id;
        CHECK(thawCreateMaterial(f.world, &d, &id) == thawResult_ok);
        REQUIRE(thawMaterialPresetName(static_cast<thawMaterialPreset>(p)) != nullptr);
        for (int q = 0; q < p; ++q)
            CHECK(std::strcmp(thawMaterialPresetName(static_cast<thawMaterialPreset>(p)),
                              thawMaterialPresetName(static_cast<thawMaterialPreset>(q))) != 0);
    }
    CHECK(thawMaterialPresetName(thawMaterial_presetCount) == nullptr);
}

TEST_CASE("api: ids that are null, stale or foreign are refused") {
    WorldFixture a, b;
    a.create(), b.create();
    a.addMaterial();
    thawHeatSourceId source = a.addSource({0, 1, 0}, 5);
    thawHeatSourceDef d;
    thawInitHeatSourceDef(&d);
    CHECK(thawHeatSource_Set(a.world, source, &d) == thawResult_ok);
    CHECK(thawHeatSource_Set(b.world, source, &d) == thawResult_staleId);
    CHECK(thawHeatSource_Set(a.world, {}, &d) == thawResult_staleId);
    CHECK(thawDestroyHeatSource(a.world, source) == thawResult_ok);
    CHECK(thawDestroyHeatSource(a.world, source) == thawResult_staleId);
    thawHeatSourceId again = a.addSource({0, 1, 0}, 5); // the slot is used again, the old id must not fit
    CHECK(again.index1 == source.index1);
    CHECK(thawHeatSource_Set(a.world, source, &d) == thawResult_staleId);

    thawBodyId body = a.addBox({0, 0, 0}, {0.01f, 0.01f, 0.01f});
    thawBodyState state;
    CHECK(thawBody_GetState(a.world, body, &state) == thawResult_ok);
    CHECK(thawBody_GetState(b.world, body, &state) == thawResult_staleId);
    CHECK(thawDestroyBody(a.world, body) == thawResult_ok);
    CHECK(thawBody_GetState(a.world, body, &state) == thawResult_staleId);
    CHECK(a.counters().particles == 0);

    b.addMaterial();
    Shape shape = boxShape({0, 0, 0}, {0.01f, 0.01f, 0.01f});
    thawBodyDef def;
    thawInitBodyDef(&def);
    def.mesh = shape.mesh();
    def.material = a.material;
    CHECK(thawCreateBody(b.world, &def, &body, nullptr) == thawResult_staleId);
    CHECK(body.index1 == 0);

    thawColliderId floor = a.addFloor();
    CHECK(thawDestroyCollider(b.world, floor) == thawResult_staleId);
    CHECK(thawDestroyCollider(a.world, floor) == thawResult_ok);
    CHECK(thawDestroyCollider(a.world, floor) == thawResult_staleId);
}

TEST_CASE("api: capacities are kept and named") {
    WorldFixture f;
    f.def.maxParticles = 100, f.def.maxHeatSources = 1, f.def.maxMaterials = 1;
    f.create();
    f.addMaterial();
    thawMaterialDef material;
    thawInitMaterialDef(&material, thawMaterial_wax);
    thawMaterialId materialId;
    CHECK(thawCreateMaterial(f.world, &material, &materialId) == thawResult_capacity);
    Shape shape = boxShape({0, 0, 0}, {0.02f, 0.02f, 0.02f});
    thawBodyDef def;
    thawInitBodyDef(&def);
    def.mesh = shape.mesh(), def.material = f.material;
    thawBodyId id;
    CHECK(thawCreateBody(f.world, &def, &id, nullptr) == thawResult_capacity);
    CHECK(contains(error(f), "100"));
    CHECK(f.counters().particles == 0);
    f.addSource({0, 1, 0}, 1);
    thawHeatSourceDef source;
    thawInitHeatSourceDef(&source);
    thawHeatSourceId sourceId;
    CHECK(thawCreateHeatSource(f.world, &source, &sourceId) == thawResult_capacity);
    CHECK(contains(error(f), "maxHeatSources"));
}

TEST_CASE("api: a mesh that cannot be filled is refused with its reason") {
    WorldFixture f;
    f.create();
    f.addMaterial();
    auto refuse = [&](const Shape& s) {
        thawBodyDef def;
        thawInitBodyDef(&def);
        def.mesh = s.mesh(), def.material = f.material;
        thawBodyId id;
        thawResult r = thawCreateBody(f.world, &def, &id, nullptr);
        CHECK(id.index1 == 0);
        return r;
    };
    CHECK(refuse({}) == thawResult_badMesh);
    Shape s = boxShape({0, 0, 0}, {0.02f, 0.02f, 0.02f});
    s.vertices[4] = NAN;
    CHECK(refuse(s) != thawResult_ok);
    CHECK(contains(error(f), "vertex 1"));
    s = boxShape({0, 0, 0}, {0.02f, 0.02f, 0.02f});
    s.indices[3] = 99;
    CHECK(refuse(s) != thawResult_ok);
    CHECK(contains(error(f), "99"));
    s = boxShape({0, 0, 0}, {0.02f, 0.02f, 0});
    CHECK(refuse(s) == thawResult_badMesh);
    CHECK(f.counters().particles == 0);
}

TEST_CASE("api: step refuses bad time steps and budgets and changes nothing") {
    WorldFixture f;
    f.create();
    const uint64_t before = thawWorld_GetStateHash(f.world);
    for (float dt : {0.0f, -1.0f, NAN, 1.0f}) {
        CHECK(thawWorld_Step(f.world, dt, nullptr) == thawStep_refused);
        CHECK(contains(error(f), "timeStep"));
    }
    struct Case {
        const char* field;
        void (*spoil)(thawBudget&);
    };
    const Case cases[] = {
        {"milliseconds", [](thawBudget& b) { b.mode = thawBudget_milliseconds, b.milliseconds = -4; }},
        {"milliseconds", [](thawBudget& b) { b.mode = thawBudget_milliseconds, b.milliseconds = NAN; }},
        {"subSteps", [](thawBudget& b) { b.work.subSteps = 0; }},
        {"rayRefresh", [](thawBudget& b) { b.work.rayRefresh = 2; }},
        {"heatCycles", [](thawBudget& b) { b.work.heatCycles = 0; }},
        {"heatInterval", [](thawBudget& b) { b.work.heatInterval = 100; }},
        {"units", [](thawBudget& b) { b.mode = thawBudget_units, b.units = NAN; }},
        {"most.subSteps", [](thawBudget& b) { b.mode = thawBudget_units, b.most.subSteps = 17; }},
        {"least.rayRefresh", [](thawBudget& b) { b.mode = thawBudget_milliseconds, b.least.rayRefresh = NAN; }},
        {"work.lateAfter", [](thawBudget& b) { b.work.lateAfter = -1; }},
        {"milliseconds", [](thawBudget& b) { b.mode = thawBudget_milliseconds, b.milliseconds = 2e9f; }},
        {"mode", [](thawBudget& b) { store(b.mode, 9); }},
    };
    for (const Case& c : cases) {
        thawBudget b;
        thawInitBudget(&b);
        c.spoil(b);
        CAPTURE(c.field);
        CHECK(thawWorld_Step(f.world, 1.0f / 60, &b) == thawStep_refused);
        CHECK(contains(error(f), c.field));
    }
    CHECK(thawWorld_GetStateHash(f.world) == before);
    CHECK(f.counters().steps == 0);
    CHECK(thawWorld_Step(nullptr, 1.0f / 60, nullptr) == thawStep_refused);
}

TEST_CASE("api: every bit, stage and reason has words") {
    for (uint32_t bit = 1; bit <= thawStep_late; bit <<= 1) CHECK(std::strlen(thawStepStatusString(bit)) > 0);
    CHECK(std::strlen(thawStepStatusString(0)) == 0);
    for (int s = 0; s < thawStage_count; ++s) CHECK(std::strlen(thawStageName(static_cast<thawStage>(s))) > 0);
    for (int r = 0; r <= thawReason_oneLevel; ++r) CHECK(std::strlen(thawReasonString(static_cast<thawReason>(r))) > 0);
    CHECK(thawGetVersion() == THAW_VERSION);
    CHECK(contains(thawGetBuildString(), "thaw "));
}

TEST_CASE("api: a world takes its memory from the host's allocator and gives all of it back") {
    struct Count {
        size_t out = 0, calls = 0;
    } count;
    WorldFixture f;
    f.def.allocator.user = &count;
    f.def.allocator.alloc = [](size_t size, size_t alignment, void* user) -> void* {
        Count& c = *static_cast<Count*>(user);
        c.out += size, ++c.calls;
        return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    };
    f.def.allocator.free = [](void* memory, size_t size, void* user) {
        static_cast<Count*>(user)->out -= size;
        std::free(memory);
    };
    f.create();
    f.addMaterial();
    f.addFloor();
    f.addBox({-0.01f, 0, -0.01f}, {0.01f, 0.02f, 0.01f}, 340);
    f.addSource({0, 0.03f, 0}, 50);
    f.step(30);
    CHECK(count.out == f.counters().memoryBytes);
    const size_t warm = count.calls;
    f.step(120);
    CHECK(count.calls == warm); // nothing is allocated in a step after warm-up
    thawDestroyWorld(f.world);
    f.world = nullptr;
    CHECK(count.out == 0);
}

TEST_CASE("api: the n-th allocation failing at creation gives an error and leaks nothing, for every n") {
    struct Fail {
        size_t left = 0, out = 0;
    } fail;
    bool succeeded = false;
    for (size_t n = 0; n < 400 && !succeeded; ++n) {
        WorldFixture f;
        fail = {n, 0};
        f.def.allocator.user = &fail;
        f.def.allocator.alloc = [](size_t size, size_t alignment, void* user) -> void* {
            Fail& c = *static_cast<Fail*>(user);
            if (c.left-- == 0) return c.left = 0, nullptr;
            c.out += size;
            return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
        };
        f.def.allocator.free = [](void* memory, size_t size, void* user) {
            static_cast<Fail*>(user)->out -= size;
            std::free(memory);
        };
        char message[128];
        thawResult r = thawCreateWorld(&f.def, &f.world, message, sizeof message);
        CHECK((r == thawResult_ok || r == thawResult_outOfMemory));
        succeeded = r == thawResult_ok;
        thawDestroyWorld(f.world);
        f.world = nullptr;
        CHECK(fail.out == 0);
    }
    CHECK(succeeded);
}
