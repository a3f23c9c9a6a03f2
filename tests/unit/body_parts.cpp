// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world_fixture.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace {

// A box of 40 x 32 x 48 mm around (0.1, 0.2, 0), turned, with parts.
struct PartsFixture : WorldFixture {
    thawMaterialId materials[3];
    Shape whole = boxShape({-0.02f, -0.016f, -0.024f}, {0.02f, 0.016f, 0.024f});
    thawBodyDef body;
    PartsFixture() {
        def.particleSpacing = 0.002f;
        create();
        int k = 0;
        for (float density : {1300.0f, 550.0f, 900.0f}) {
            thawMaterialDef d;
            thawInitMaterialDef(&d, thawMaterial_wax);
            d.density = density;
            materials[k++] = addMaterial(d);
        }
        thawInitBodyDef(&body);
        body.material = materials[0], body.mesh = whole.mesh();
        body.position = {0.1f, 0.2f, 0};
        body.rotation = {0, 0, std::sin(0.3f), std::cos(0.3f)};
    }
    // Back in the space of the mesh.
    thawVec3 local(const float* x) const {
        const float c = std::cos(0.6f), s = std::sin(0.6f), dx = x[0] - 0.1f, dy = x[1] - 0.2f;
        return {c * dx + s * dy, c * dy - s * dx, x[2]};
    }
    static float depth(thawVec3 p) {
        return std::min({0.02f - std::abs(p.x), 0.016f - std::abs(p.y), 0.024f - std::abs(p.z)});
    }
};

} // namespace

TEST_CASE("body parts: a shell by depth, a core by mesh, later parts first") {
    PartsFixture f;
    const Shape wick = boxShape({-0.004f, -0.1f, -0.004f}, {0.004f, 0.1f, 0.004f});
    thawBodyPart parts[2] = {};
    parts[0].material = f.materials[1], parts[0].depth = 0.006f;
    parts[1].material = f.materials[2], parts[1].mesh = wick.mesh();
    f.body.parts = parts, f.body.partCount = 2;
    thawBodyId id;
    REQUIRE_MESSAGE(thawCreateBody(f.world, &f.body, &id, nullptr) == thawResult_ok, thawWorld_GetLastError(f.world));
    const thawParticleView v = f.particles();
    int of[3] = {};
    double mass = 0;
    const float density[3] = {1300, 550, 900}, tight = 1e-5f;
    for (int i = 0; i < v.count; ++i) {
        const thawVec3 p = f.local(v.positions + 4 * i);
        const float out = std::max(std::abs(p.x), std::abs(p.z)) - 0.004f, deep = f.depth(p) - 0.006f;
        if (std::abs(out) < tight || std::abs(deep) < tight) continue;
        const int wanted = out < 0 ? 2 : deep > 0 ? 1 : 0;
        CHECK(v.materials[i] == wanted);
        ++of[wanted];
        CHECK(v.velocities[4 * i + 3] == doctest::Approx(density[wanted] * 8e-9f).epsilon(0.02));
        mass += static_cast<double>(v.velocities[4 * i + 3]);
    }
    for (int n : of) CHECK(n > 200); // the wick is 4 x 4 x 16
    CHECK(f.ledger().massNow == doctest::Approx(mass).epsilon(1e-3));
}

TEST_CASE("body parts: what is refused, with its name, and changes nothing") {
    PartsFixture f;
    thawBodyPart parts[2] = {};
    parts[0].material = f.materials[1], parts[0].depth = 0.006f;
    parts[1].material = f.materials[2], parts[1].depth = 0.008f;
    f.body.parts = parts;
    thawBodyId id;
    const auto refuses = [&](thawResult result, const std::string& says) {
        CHECK(thawCreateBody(f.world, &f.body, &id, nullptr) == result);
        const std::string message = thawWorld_GetLastError(f.world);
        CHECK_MESSAGE(message.find(says) != std::string::npos, message);
        CHECK(f.particles().count == 0);
    };
    f.body.partCount = -1;
    refuses(thawResult_invalidArgument, "partCount");
    f.body.partCount = 65;
    refuses(thawResult_invalidArgument, "65");
    f.body.partCount = 2;
    parts[1].depth = NAN;
    refuses(thawResult_invalidArgument, "parts[1].depth");
    parts[1].depth = 0;
    refuses(thawResult_invalidArgument, "parts[1].depth");
    const Shape wick = boxShape({-0.004f, -0.1f, -0.004f}, {0.004f, 0.1f, 0.004f});
    parts[1].mesh = wick.mesh(), parts[1].mesh.triangleCount = 0;
    refuses(thawResult_badMesh, "parts[1].mesh");
    Shape bad = wick;
    bad.vertices[4] = NAN;
    parts[1].mesh = bad.mesh();
    CHECK(thawCreateBody(f.world, &f.body, &id, nullptr) != thawResult_ok);
    CHECK(std::string(thawWorld_GetLastError(f.world)).find("parts[1].mesh") == 0);
    parts[1].mesh = wick.mesh(), parts[1].material.index1 = 9;
    refuses(thawResult_staleId, "parts[1].material");
    f.body.parts = nullptr;
    refuses(thawResult_invalidArgument, "parts: is NULL");
}
