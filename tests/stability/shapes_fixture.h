// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "world_fixture.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <vector>

struct Drawing {
    std::vector<thawVec3> points;
    std::vector<int32_t> sizes;

    Drawing& ellipse(float x, float z, float rx, float rz, int count = 40, float y = 0) {
        for (int k = 0; k < count; ++k) {
            const float a = 6.2831853f * static_cast<float>(k) / static_cast<float>(count);
            points.push_back({x + rx * std::cos(a), y, z + rz * std::sin(a)});
        }
        sizes.push_back(count);
        return *this;
    }
    thawShapeDef def() const {
        thawShapeDef d;
        thawInitShapeDef(&d);
        d.points = points.data(), d.contourSizes = sizes.data(), d.contourCount = static_cast<int32_t>(sizes.size());
        return d;
    }
};

// An octahedron, divided.
struct Ball {
    std::vector<float> vertices;
    std::vector<uint32_t> indices;

    explicit Ball(float radius) {
        constexpr int kParts = 8;
        for (int face = 0; face < 8; ++face) {
            const float sx = face & 1 ? -1.0f : 1.0f, sy = face & 2 ? -1.0f : 1.0f, sz = face & 4 ? -1.0f : 1.0f;
            const bool turned = sx * sy * sz < 0;
            const auto put = [&](int i, int j) {
                const float x = sx * static_cast<float>(i), y = sy * static_cast<float>(j),
                            z = sz * static_cast<float>(kParts - i - j), l = std::sqrt(x * x + y * y + z * z);
                for (const float v : {x, y, z}) vertices.push_back(radius * v / l);
                return static_cast<uint32_t>(vertices.size() / 3 - 1);
            };
            const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
                indices.insert(indices.end(), {a, turned ? c : b, turned ? b : c});
            };
            for (int i = 0; i < kParts; ++i)
                for (int j = 0; j < kParts - i; ++j) {
                    add(put(i, j), put(i + 1, j), put(i, j + 1));
                    if (i + j + 1 < kParts) add(put(i + 1, j), put(i + 1, j + 1), put(i, j + 1));
                }
        }
    }
    thawShapeDef def() const {
        thawShapeDef d;
        thawInitShapeDef(&d);
        d.mesh = {vertices.data(), vertices.size() / 3, indices.data(), indices.size() / 3};
        return d;
    }
};

inline thawShapeId addShape(WorldFixture& f, const thawShapeDef& d) {
    thawShapeId id;
    REQUIRE_MESSAGE(thawCreateShape(f.world, &d, &id) == thawResult_ok, thawWorld_GetLastError(f.world));
    return id;
}

inline thawShapeState stateOf(WorldFixture& f, thawShapeId id) {
    thawShapeState s;
    REQUIRE(thawShape_GetState(f.world, id, &s) == thawResult_ok);
    return s;
}

// Wax of half a Pa s, of which there is none yet, and a floor.
inline void waxOnFloor(WorldFixture& f, float heat = 0, float density = NAN) {
    f.def.thermalTimeScale = heat;
    f.create();
    thawMaterialDef m;
    thawInitMaterialDef(&m, thawMaterial_wax);
    m.viscosityLiquid = 0.5f;
    if (!std::isnan(density)) m.density = density;
    f.addMaterial(m);
    f.addFloor();
}

// A block of liquid on a floor. heat: seconds of it per second.
inline void pool(WorldFixture& f, float heat = 0) {
    waxOnFloor(f, heat, 800);
    f.addBox({-0.016f, 0, -0.016f}, {0.016f, 0.012f, 0.016f}, 345);
}

template <class F> double shareOf(const WorldFixture& f, F&& in) {
    thawParticleView p;
    thawWorld_GetParticles(f.world, &p);
    int count = 0;
    for (int i = 0; i < p.count; ++i) count += in(p.positions + 4 * i);
    return static_cast<double>(count) / p.count;
}
