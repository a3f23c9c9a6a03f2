// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "particles/splats.h"
#include "world_fixture.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <vector>

using namespace thaw;

namespace {

constexpr float kSpacing = 0.004f;

struct Melt {
    std::vector<Vec4> positions, normals;
    Allocator allocator;
    Tasks tasks;
    SplatShapes shapes;

    explicit Melt(int workers = 1) : tasks(system(workers)), shapes(allocator) {}
    static thawTaskSystem system(int workers) {
        thawTaskSystem s{};
        s.workerCount = workers;
        return s;
    }
    void add(Vec3 at, Vec3 normal, float spacing = kSpacing) {
        positions.push_back({at.x, at.y, at.z, 2.2f * spacing});
        normals.push_back({normal.x, normal.y, normal.z, 0});
    }
    void make() { shapes.make({int(positions.size()), positions.data(), normals.data()}, tasks); }
};

void addBeads(Melt& melt, Vec3 from) {
    for (int j = 0; j < 12; ++j)
        for (int i = 0; i < 12; ++i)
            melt.add(from + kSpacing * Vec3{float(i), float((i * 7 + j * 5) % 3 - 1) * 0.2f, float(j)}, {0, 1, 0});
}

} // namespace

TEST_CASE("splats: beads of a plane become flat, a drop stays where it is and round, what is inside a ball") {
    for (float far : {0.0f, -1.7f, 4000.0f}) {
        Melt melt;
        addBeads(melt, {0, far, 0});
        melt.add({0.3f, 0.2f, 0.1f}, {1, 0, 0}); // by itself
        melt.add({0.02f, far, 0.02f}, {0, 0, 0}, 2 * kSpacing);
        melt.make();
        if (far > 1000) continue; // nothing but that it comes back: floats there are coarser than the spacing
        float before = 0, after = 0;
        for (int j = 2; j < 10; ++j)
            for (int i = 2; i < 10; ++i) {
                const size_t row = size_t(j * 12 + i);
                const Vec4 &c = melt.shapes.centers[row], &a = melt.shapes.axes[row];
                before = std::fmax(before, std::fabs(melt.positions[row].y - far));
                after = std::fmax(after, std::fabs(c.y - far));
                CHECK(a.y > 0.999f);
                CHECK(a.w < 0.6f * c.w);
                // Flat, half a spacing is outside of it.
                CHECK(std::fabs(a.w - 0.5f * kSpacing) < 0.05f * kSpacing);
            }
        CHECK(after < 0.35f * before);
        const Vec4 &drop = melt.shapes.centers[144], &inner = melt.shapes.centers[145];
        CHECK(length(drop.xyz() - Vec3{0.3f, 0.2f, 0.1f}) < 1e-6f);
        CHECK(drop.w == melt.shapes.axes[144].w);
        // Balls of the particle's volume.
        CHECK(std::fabs(4.18879f * drop.w * drop.w * drop.w / (kSpacing * kSpacing * kSpacing) - 1) < 0.01f);
        CHECK(std::fabs(inner.w - 2 * drop.w) < 1e-6f);
        CHECK(melt.shapes.axes[145].w == inner.w);
    }
}

TEST_CASE("splats: a sheet of two layers keeps its thickness") {
    Melt melt;
    for (int layer = 0; layer < 2; ++layer)
        for (int j = 0; j < 10; ++j)
            for (int i = 0; i < 10; ++i)
                melt.add(kSpacing * Vec3{float(i), float(layer), float(j)}, {0, layer ? 1.0f : -1.0f, 0});
    melt.make();
    for (size_t row = 0; row < 100; ++row)
        CHECK(std::fabs(melt.shapes.centers[row + 100].y - melt.shapes.centers[row].y - kSpacing) < 0.02f * kSpacing);
}

TEST_CASE("splats: the same bits on any number of workers, and no memory the second time") {
    Melt one(1), many(4);
    for (Melt* m : {&one, &many})
        for (int k = 0; k < 5; ++k) addBeads(*m, {0.02f * float(k), 0.001f * float(k), 0});
    one.make(), many.make();
    REQUIRE(one.shapes.centers.size() == 720);
    CHECK(std::memcmp(one.shapes.centers.data(), many.shapes.centers.data(), 720 * sizeof(Vec4)) == 0);
    CHECK(std::memcmp(one.shapes.axes.data(), many.shapes.axes.data(), 720 * sizeof(Vec4)) == 0);
    const size_t calls = one.allocator.calls();
    one.make();
    CHECK(one.allocator.calls() == calls);
}

TEST_CASE("splats: of a world, in the order of its particles") {
    WorldFixture f;
    f.create();
    thawSplatView view;
    REQUIRE(thawWorld_GetSplats(f.world, &view) == thawResult_ok);
    CHECK(view.count == 0);
    f.addMaterial();
    f.addBox({0, 0, 0}, {0.03f, 0.03f, 0.03f});
    f.step(2);
    REQUIRE(thawWorld_GetSplats(f.world, &view) == thawResult_ok);
    const thawParticleView p = f.particles();
    REQUIRE(view.count == p.count);
    int flat = 0;
    for (int i = 0; i < p.count; ++i) {
        const float *c = view.centers + 4 * i, *a = view.axes + 4 * i, *x = p.positions + 4 * i;
        CHECK(std::hypot(c[0] - x[0], c[1] - x[1], c[2] - x[2]) < 0.5f * f.def.particleSpacing);
        CHECK(std::fabs(std::hypot(a[0], a[1], a[2]) - 1) < 1e-4f);
        flat += a[3] < 0.6f * c[3];
    }
    CHECK(flat > p.count / 10);
    CHECK(flat < p.count / 2);
    CHECK(thawWorld_GetSplats(f.world, nullptr) == thawResult_invalidArgument);
}
