// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "thaw/thaw.h"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

// A world through the C API, as a host sees it, with shapes to put in.
struct Shape {
    std::vector<float> vertices;
    std::vector<uint32_t> indices;
    thawMesh mesh() const { return {vertices.data(), vertices.size() / 3, indices.data(), indices.size() / 3}; }
};

inline Shape boxShape(thawVec3 low, thawVec3 high) {
    Shape s;
    for (int k = 0; k < 8; ++k)
        for (float v : {k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z})
            s.vertices.push_back(v);
    s.indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    return s;
}

struct WorldFixture {
    thawWorldDef def;
    thawWorld* world = nullptr;
    thawMaterialId material{};
    thawBudget budget;

    WorldFixture() {
        thawInitWorldDef(&def);
        thawInitBudget(&budget);
        def.maxParticles = 8192;
    }
    WorldFixture(const WorldFixture&) = delete;
    WorldFixture& operator=(const WorldFixture&) = delete;
    ~WorldFixture() { thawDestroyWorld(world); }

    void create() {
        char message[256];
        thawResult r = thawCreateWorld(&def, &world, message, sizeof message);
        REQUIRE_MESSAGE(r == thawResult_ok, message);
    }
    thawMaterialId addMaterial(thawMaterialPreset preset = thawMaterial_wax) {
        thawMaterialDef d;
        thawInitMaterialDef(&d, preset);
        return addMaterial(d);
    }
    thawMaterialId addMaterial(const thawMaterialDef& d) {
        REQUIRE_MESSAGE(thawCreateMaterial(world, &d, &material) == thawResult_ok, thawWorld_GetLastError(world));
        return material;
    }
    thawBodyId addBox(thawVec3 low, thawVec3 high, float temperature = NAN) {
        Shape s = boxShape(low, high);
        thawBodyDef d;
        thawInitBodyDef(&d);
        d.material = material, d.mesh = s.mesh(), d.temperature = temperature;
        thawBodyId id;
        REQUIRE_MESSAGE(thawCreateBody(world, &d, &id, nullptr) == thawResult_ok, thawWorld_GetLastError(world));
        return id;
    }
    thawColliderId addFloor(float y = 0) {
        thawColliderDef d;
        thawInitColliderDef(&d, thawCollider_plane);
        d.position = {0, y, 0};
        thawColliderId id;
        REQUIRE(thawCreateCollider(world, &d, &id, nullptr) == thawResult_ok);
        return id;
    }
    thawHeatSourceId addSource(thawVec3 position, float power) {
        thawHeatSourceDef d;
        thawInitHeatSourceDef(&d);
        d.position = position, d.power = power;
        thawHeatSourceId id;
        REQUIRE(thawCreateHeatSource(world, &d, &id) == thawResult_ok);
        return id;
    }
    uint32_t step(int frames = 1) {
        uint32_t status = 0;
        for (int i = 0; i < frames; ++i) status |= thawWorld_Step(world, 1.0f / 60, &budget);
        REQUIRE_MESSAGE((status & thawStep_refused) == 0, thawWorld_GetLastError(world));
        return status;
    }
    thawCounters counters() const {
        thawCounters c;
        thawWorld_GetCounters(world, &c);
        return c;
    }
    thawLedger ledger() const {
        thawLedger l;
        thawWorld_GetLedger(world, &l);
        return l;
    }
    thawPlan plan() const {
        thawPlan p;
        thawWorld_GetPlan(world, &p);
        return p;
    }
    thawParticleView particles() const {
        thawParticleView v;
        thawWorld_GetParticles(world, &v);
        return v;
    }
    // Positions by stable id.
    std::map<uint32_t, thawVec3> positions() const {
        thawParticleView v = particles();
        std::map<uint32_t, thawVec3> out;
        for (int i = 0; i < v.count; ++i)
            out[v.ids[i]] = {v.positions[4 * i], v.positions[4 * i + 1], v.positions[4 * i + 2]};
        return out;
    }
};
