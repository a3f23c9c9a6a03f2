// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "levels/feature_size.h"

#include "base/kernel.h"
#include "neighbors/exposure.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

using namespace thaw;

namespace {

// A melt of unit spacing, jittered as a liquid's inside is, in any shape that a function says.
struct Melt {
    Allocator allocator;
    Particles particles{allocator};
    Neighbors neighbors{allocator};
    Tasks tasks;
    FeatureSize features{allocator};
    Array<float> volume{allocator}, none{allocator};
    uint32_t steps = 0;

    static thawTaskSystem workers(int count) {
        thawTaskSystem s{};
        s.workerCount = count;
        return s;
    }
    explicit Melt(int workerCount = 1) : tasks(workers(workerCount)) {}

    void fill(Vec3 low, Vec3 high, const std::function<bool(Vec3)>& inside, float jitter) {
        std::mt19937 random(5);
        std::uniform_real_distribution<float> off(-jitter, jitter);
        std::vector<Vec3> points;
        for (float z = low.z + 0.5f; z < high.z; ++z)
            for (float y = low.y + 0.5f; y < high.y; ++y)
                for (float x = low.x + 0.5f; x < high.x; ++x)
                    if (inside({x, y, z})) points.push_back({x + off(random), y + off(random), z + off(random)});
        particles.allocate(static_cast<int>(points.size()));
        for (const Vec3& x : points) {
            const size_t k = static_cast<size_t>(particles.count++);
            particles.position[k] = {x.x, x.y, x.z, kSupport};
            particles.velocity[k].w = 1, particles.id[k] = static_cast<uint32_t>(k);
        }
        lists();
    }
    void lists(const std::vector<Collider>& colliders = {}) {
        particles.pad();
        neighbors.sort(particles, tasks), neighbors.build(particles, tasks);
        const size_t n = static_cast<size_t>(particles.count);
        volume.assign(n + Particles::kPadding, 0), none.assign(n + Particles::kPadding, 0);
        std::fill_n(volume.begin(), n, 1.0f);
        neighbors.weigh(particles, volume.data(), none.data(), tasks);
        findExposure(particles, neighbors, volume.data(), colliders.data(), static_cast<int>(colliders.size()), nullptr,
                     tasks);
    }
    FeatureFrame frame() { return {particles, neighbors, tasks, 1, particles.count}; }
    void step(int n) {
        for (int k = 0; k < n; ++k) features.relax(frame(), steps++ % 4, 4);
    }
    float size(size_t k) const { return static_cast<float>(particles.feature[k].size) / FeatureSize::kUnits; }
    float largest() const {
        float most = 0;
        for (size_t k = 0; k < static_cast<size_t>(particles.count); ++k) most = std::max(most, size(k));
        return most;
    }
    // Largest difference from what it should be, over the rows for which that is not negative; mean of it.
    struct Error {
        float worst = 0, mean = 0, wrong = 0; // wrong: share of them that are off by more than a spacing
    };
    Error error(const std::function<float(Vec3)>& exact) const {
        Error e;
        int n = 0;
        for (size_t k = 0; k < static_cast<size_t>(particles.count); ++k) {
            const float should = exact(particles.position[k].xyz());
            if (should < 0) continue;
            const float off = std::abs(size(k) - should);
            e.worst = std::max(e.worst, off), e.mean += off, e.wrong += off > 1, ++n;
        }
        REQUIRE(n > 20);
        e.mean /= static_cast<float>(n), e.wrong /= static_cast<float>(n);
        return e;
    }
};

} // namespace

TEST_CASE("feature size: a slab's is half its thickness at the surface, and grows with depth") {
    for (const float jitter : {0.0f, 0.1f})
        for (const int layers : {5, 8, 13, 20}) {
            CAPTURE(jitter);
            CAPTURE(layers);
            Melt m;
            const float T = 0.5f * static_cast<float>(layers), side = 60;
            m.fill(
                {0, 0, 0}, {side, 2 * T, side}, [](Vec3) { return true; }, jitter);
            m.features.settle(m.frame());
            const Melt::Error e = m.error([&](Vec3 x) {
                const float rim = std::min(std::min(x.x, side - x.x), std::min(x.z, side - x.z));
                return rim > 2.5f * T ? T + std::min(x.y, 2 * T - x.y) : -1.0f;
            });
            CHECK(e.worst < 1.1f);
            CHECK(e.mean < 0.4f);
        }
}

TEST_CASE("feature size: a ball's is its radius and the depth") {
    for (const float jitter : {0.0f, 0.1f, 0.15f})
        for (const float R : {4.0f, 7.0f, 11.0f}) {
            CAPTURE(jitter);
            CAPTURE(R);
            Melt m;
            m.fill(
                {-R, -R, -R}, {R, R, R}, [&](Vec3 x) { return length(x) < R; }, jitter);
            m.features.settle(m.frame());
            const Melt::Error e = m.error([&](Vec3 x) { return R + std::max(0.0f, R - length(x)); });
            // The last is more disorder than a liquid has, with holes that pass for surface.
            const bool strewn = jitter > 0.1f;
            CHECK(e.worst < (strewn ? 4 : 2));
            CHECK(e.wrong < (strewn ? 0.35f : 0.05f));
            CHECK(e.mean < (strewn ? 0.9f : 0.6f));
        }
}

TEST_CASE("feature size: films of one and two layers have a spacing") {
    for (const int layers : {1, 2}) {
        Melt m;
        m.fill(
            {0, 0, 0}, {30, static_cast<float>(layers), 30}, [](Vec3) { return true; }, 0.1f);
        m.features.settle(m.frame());
        CHECK(m.largest() <= 1);
    }
}

TEST_CASE("feature size: of two balls on a thin neck the neck alone is small") {
    Melt m;
    const float R = 8, a = 1.6f, apart = 22;
    const auto ball = [&](Vec3 x) { return std::min(length(x), length(x - Vec3{apart, 0, 0})); };
    m.fill(
        {-R, -R, -R}, {apart + R, R, R},
        [&](Vec3 x) { return ball(x) < R || (x.x > 0 && x.x < apart && x.y * x.y + x.z * x.z < a * a); }, 0.1f);
    m.features.settle(m.frame());
    int neck = 0;
    float thickest = 0, thinnest = 32;
    for (size_t k = 0; k < static_cast<size_t>(m.particles.count); ++k) {
        const Vec3 x = m.particles.position[k].xyz();
        if (x.x > R + 1 && x.x < apart - R - 1) {
            thickest = std::max(thickest, m.size(k)), ++neck;
        }
        // As far from the neck as the ball is wide.
        if (x.x < -1 && length(x) < R) thinnest = std::min(thinnest, m.size(k));
    }
    CHECK(neck > 20);
    CHECK(thickest <= 2 * a + 0.5f); // exact: 2 a in the middle
    CHECK(thinnest > R - 1.5f);
}

TEST_CASE("feature size: a wall is no surface, a pool on a floor is as thick as it is deep") {
    Melt m;
    const float depth = 8, side = 40;
    m.fill(
        {0, 0, 0}, {side, depth, side}, [](Vec3) { return true; }, 0.1f);
    std::vector<Collider> floor(1);
    floor[0].type = thawCollider_plane, floor[0].alive = true;
    m.lists(floor);
    m.features.settle(m.frame());
    const Melt::Error e = m.error([&](Vec3 x) {
        const float rim = std::min(std::min(x.x, side - x.x), std::min(x.z, side - x.z));
        return rim > 15 ? depth + (depth - x.y) : -1.0f;
    });
    CHECK(e.worst < 1.2f);
    CHECK(e.mean < 0.6f);
}

TEST_CASE("feature size: follows a pool that drains to a film and one that fills, a quarter of the rows in each step") {
    for (const int workers : {1, 3}) {
        Melt m(workers);
        const float side = 40;
        m.fill(
            {0, 0, 0}, {side, 12, side}, [](Vec3) { return true; }, 0.1f);
        // From nothing: it takes four steps a spacing or two.
        m.step(80);
        const auto middle = [&](float T) {
            return [=](Vec3 x) {
                const float rim = std::min(std::min(x.x, side - x.x), std::min(x.z, side - x.z));
                return rim > 15 ? T + std::min(x.y, 2 * T - x.y) : -1.0f;
            };
        };
        CHECK(m.error(middle(6)).worst < 1.2f);
        const int all = m.particles.count;
        // The lowest two layers stay.
        int kept = 0;
        for (int i = 0; i < all; ++i)
            if (m.particles.position[static_cast<size_t>(i)].y < 2)
                m.particles.copyRow(static_cast<size_t>(kept++), static_cast<size_t>(i));
        m.particles.count = kept;
        m.lists();
        m.step(16);
        CHECK(m.largest() <= 1);
        // The rest comes back, and knows nothing: values grow again.
        for (int i = 0; i < kept; ++i)
            for (int layer = 1; layer < 6; ++layer) {
                const size_t k = static_cast<size_t>(m.particles.count++);
                m.particles.copyRow(k, static_cast<size_t>(i));
                m.particles.position[k].y += 2 * static_cast<float>(layer),
                    m.particles.id[k] = static_cast<uint32_t>(k);
            }
        m.lists();
        m.step(80);
        CHECK(m.error(middle(6)).worst < 1.2f);
    }
}

TEST_CASE("feature size: the same on any number of workers") {
    std::vector<uint8_t> first;
    for (const int workers : {1, 2, 4}) {
        Melt m(workers);
        m.fill(
            {-9, -9, -9}, {9, 9, 9}, [&](Vec3 x) { return length(x) < 9; }, 0.2f);
        std::vector<uint8_t> all;
        for (int k = 0; k < 30; ++k) {
            m.step(1);
            for (size_t i = 0; i < static_cast<size_t>(m.particles.count); ++i)
                all.push_back(m.particles.feature[i].size);
        }
        if (workers == 1) first = all;
        CHECK(all == first);
    }
}
