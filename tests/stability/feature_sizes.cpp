// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world_fixture.h"

#include <algorithm>

TEST_CASE(
    "feature sizes: of a cold slab, fine and coarse, are there before the first step, and looking changes nothing") {
    for (const int coarsest : {0, 3}) {
        CAPTURE(coarsest);
        WorldFixture f;
        f.def.particleSpacing = 0.002f, f.def.maxParticles = 16000;
        f.create(), f.addMaterial();
        const float T = 0.01f, side = 0.08f;
        const Shape s = boxShape({0, 0, 0}, {side, 2 * T, side});
        thawBodyDef d;
        thawInitBodyDef(&d);
        d.material = f.material, d.mesh = s.mesh(), d.coarsestLevel = coarsest;
        thawBodyId id;
        REQUIRE(thawCreateBody(f.world, &d, &id, nullptr) == thawResult_ok);
        const uint64_t hash = thawWorld_GetStateHash(f.world);
        const float* sizes = nullptr;
        REQUIRE(thawWorld_GetFeatureSizes(f.world, &sizes) == thawResult_ok);
        REQUIRE(sizes != nullptr);
        const thawParticleView v = f.particles();
        double sum = 0;
        float worst = 0;
        int n = 0;
        for (int i = 0; i < v.count; ++i) {
            const float *x = v.positions + 4 * i,
                        rim = std::min(std::min(x[0], side - x[0]), std::min(x[2], side - x[2]));
            if (rim < 0.025f) continue;
            const float off = sizes[i] - (T + std::min(x[1], 2 * T - x[1]));
            sum += static_cast<double>(off), worst = std::max(worst, std::abs(off)), ++n;
        }
        REQUIRE(n > 40);
        CHECK(worst < 1.6f * f.def.particleSpacing); // of the coarse ones, three quarters of their own spacing
        CHECK(std::abs(sum / n) < 0.75 * static_cast<double>(f.def.particleSpacing));
        CHECK(thawWorld_GetStateHash(f.world) == hash);
        CHECK(thawWorld_GetFeatureSizes(f.world, nullptr) == thawResult_invalidArgument);
        CHECK(thawWorld_GetFeatureSizes(nullptr, &sizes) == thawResult_invalidArgument);
        CHECK(sizes == nullptr);
    }
    WorldFixture empty;
    empty.create();
    const float* sizes = nullptr;
    CHECK(thawWorld_GetFeatureSizes(empty.world, &sizes) == thawResult_ok);
}

TEST_CASE("feature sizes: looking in the middle of a flow leaves the bits of what follows as they are") {
    uint64_t hashes[2];
    for (const int look : {0, 1}) {
        WorldFixture f;
        f.create(), f.addMaterial(), f.addFloor();
        f.addBox({0, 0, 0}, {0.03f, 0.03f, 0.03f}, 380);
        for (int k = 0; k < 40; ++k) {
            f.step();
            const float* sizes;
            if (look) REQUIRE(thawWorld_GetFeatureSizes(f.world, &sizes) == thawResult_ok);
        }
        hashes[look] = thawWorld_GetStateHash(f.world);
    }
    CHECK(hashes[0] == hashes[1]);
}
