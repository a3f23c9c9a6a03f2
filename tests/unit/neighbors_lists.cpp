// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "unit/neighbors_cloud.h"

#include <doctest/doctest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <string>

using namespace thaw;

namespace {

constexpr float kDx = 0.002f, kH = kSupport * kDx;

std::vector<Cloud::Point> uniform(int n, float h, Vec3 origin = {}) {
    Random random;
    float side = h / kSupport * std::cbrt(static_cast<float>(n));
    std::vector<Cloud::Point> points;
    for (int i = 0; i < n; ++i)
        points.push_back({origin + Vec3{random(0, side), random(0, side), random(0, side)}, h, random() < 0.3f});
    return points;
}

std::vector<Cloud::Point> mixed(int n) {
    std::vector<Cloud::Point> points = uniform(n, 1.6f * kH);
    Random random{77};
    for (Cloud::Point& p : points) p.support = kH * (1 + std::floor(random(0, 4)) / 3); // 1 to 2
    return points;
}

// The levels of adaptive particles: supports 2^(1/3) apart, in regions and strewn.
std::vector<Cloud::Point> levels(std::vector<Cloud::Point> points) {
    Random random{5};
    for (Cloud::Point& p : points) {
        const float region = p.position.x > 0.01f ? 3 : 0, level = random() < 0.3f ? std::floor(random(0, 4)) : region;
        p.support = kH * std::cbrt(std::exp2(level));
    }
    return points;
}

std::vector<Cloud::Point> clustered(int n) {
    Random random;
    std::vector<Cloud::Point> points;
    for (int i = 0; i < n; ++i) {
        int k = i % 7;
        Vec3 center{0.11f * static_cast<float>(k), 0.03f * static_cast<float>(k * k % 5),
                    -0.2f * static_cast<float>(k % 3)};
        float r = kDx * (k == 6 ? 1.1f : 4); // one of them is one cell full
        points.push_back({center + Vec3{random(-r, r), random(-r, r), random(-r, r)}, kH, k == 3});
    }
    return points;
}

std::vector<Cloud::Point> coincident(int n) {
    std::vector<Cloud::Point> points = uniform(n, kH);
    for (size_t i = 0; i + 3 < points.size(); i += 4)
        points[i + 1].position = points[i + 2].position = points[i].position;
    return points;
}

std::vector<Cloud::Point> elongated(int n) {
    Random random;
    std::vector<Cloud::Point> points;
    for (int i = 0; i < n; ++i)
        points.push_back(
            {{random(0, 2.5f * kDx), random(-3, 3) * kDx, kDx * 0.12f * static_cast<float>(i)}, kH, i % 5 == 0});
    return points;
}

// Clumps 1e4 m apart, and strays: more cells than anyone would allocate.
std::vector<Cloud::Point> farApart(int n) {
    Random random;
    std::vector<Cloud::Point> points;
    for (int i = 0; i < n; ++i) {
        int k = i % 4;
        Vec3 center{k & 1 ? 1e4f : -0.013f, k == 2 ? 3e3f : 0, k == 3 ? -1e4f : 0.7f};
        float r = kDx * 4;
        if (i % 97 == 0) r = 1e4f;
        points.push_back({center + Vec3{random(-r, r), random(-r, r), random(-r, r)}, kH, i % 3 == 0});
    }
    points[5].position = {3e30f, 0, 0};
    points[6].position = {3e30f, 0, 0};
    return points;
}

std::vector<Cloud::Point> sparse(int n) { // folded cells, and neighbours across the fold
    Random random;
    std::vector<Cloud::Point> points;
    for (int i = 0; i < n; i += 2) {
        Vec3 p{random(0, 0.7f), random(0, 0.6f), random(0, 0.9f)};
        points.push_back({p, kH, i % 8 == 0});
        points.push_back({p + Vec3{random(-1, 1) * kDx, random(-1, 1) * kDx, random(-1, 1) * kDx}, kH, false});
    }
    return points;
}

// Every pair, in double. Pairs whose distance rounds to the support may go either way, but the same way for both.
void checkAgainstAllPairs(const Cloud& c) {
    const Particles& p = c.particles;
    long wrong = 0, unordered = 0, oneSided = 0, total = 0;
    size_t most = 0;
    std::vector<std::vector<int>> lists;
    for (int i = 0; i < p.count; ++i) lists.push_back(c.list(i));
    for (int i = 0; i < p.count; ++i) {
        const std::vector<int>& list = lists[static_cast<size_t>(i)];
        total += static_cast<long>(list.size());
        most = std::max(most, list.size());
        for (size_t k = 1; k < list.size(); ++k) unordered += list[k - 1] >= list[k];
        size_t at = 0;
        for (int j = 0; j < p.count; ++j) {
            bool listed = at < list.size() && list[at] == j;
            at += listed;
            const Vec4 &a = p.position[static_cast<size_t>(i)], &b = p.position[static_cast<size_t>(j)];
            double dx = double(a.x) - double(b.x), dy = double(a.y) - double(b.y), dz = double(a.z) - double(b.z);
            double r = std::sqrt(dx * dx + dy * dy + dz * dz), s = 0.5 * (double(a.w) + double(b.w));
            if (std::fabs(r - s) > 1e-6 * s) wrong += listed != (i != j && r < s);
            if (listed) {
                const std::vector<int>& other = lists[static_cast<size_t>(j)];
                oneSided += !std::binary_search(other.begin(), other.end(), i);
            }
        }
        wrong += at != list.size(); // nothing else, no dummy in the middle
    }
    CHECK(wrong == 0);
    CHECK(unordered == 0);
    CHECK(oneSided == 0);
    CHECK(c.neighbors.maxNeighbors == static_cast<int>(most));
    CHECK(c.neighbors.meanNeighbors == doctest::Approx(static_cast<double>(total) / p.count));
    CHECK(total > 0);
    CHECK_FALSE(c.neighbors.clipped);
}

void onAllTargets(const std::function<void()>& f) {
    for (int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        const std::string name = hwy::TargetName(target);
        CAPTURE(name);
        f();
    }
    hwy::SetSupportedTargetsForTest(0);
}

struct Case {
    const char* name;
    std::vector<Cloud::Point> points;
};

std::vector<Case> cases() {
    return {{"uniform", uniform(1500, kH)},
            {"mixed", mixed(1300)},
            {"levels", levels(uniform(2500, 1.3f * kH))},
            {"levels and clusters", levels(clustered(1400))},
            {"levels in folded cells", levels(sparse(2200))},
            {"levels far apart", levels(farApart(1200))},
            {"clustered", clustered(900)},
            {"coincident", coincident(1203)},
            {"elongated", elongated(1500)},
            {"far apart", farApart(800)},
            {"1e4 m away", uniform(1000, 4 * kH, {1e4f, -1e4f, 1e4f})},
            {"sparse", sparse(1800)},
            {"one", uniform(1, kH)}};
}

} // namespace

TEST_CASE("neighbors: lists equal all pairs within the support") {
    for (const Case& test : cases()) {
        if (test.points.size() == 1) continue;
        const std::string name = test.name;
        CAPTURE(name);
        onAllTargets([&] {
            Cloud c(test.points, 2);
            c.sort();
            c.build();
            checkAgainstAllPairs(c);
        });
    }
}

TEST_CASE("neighbors: no particles, one particle") {
    Cloud none({});
    none.sort();
    none.build();
    none.weigh();
    CHECK(none.neighbors.groupCount == 0);
    int found = 0;
    none.neighbors.forCandidates({0, 0, 0}, kH, [&](int) { ++found; });
    CHECK(found == 0);

    Cloud one({{{1, 2, 3}, kH, false}});
    one.sort();
    one.build();
    one.weigh();
    CHECK(one.neighbors.groupCount == 1);
    CHECK(one.neighbors.width[0] == 0);
    double self = 21 / (2 * 3.14159265358979) / (2.2 * 2.2 * 2.2) / double(latticeSum());
    CHECK(one.neighbors.volumeFraction[0] == doctest::Approx(self).epsilon(1e-5).scale(0));
    one.neighbors.forCandidates({1, 2, 3.001f}, kH, [&](int) { ++found; });
    CHECK(found == 1);
}

TEST_CASE("neighbors: more candidates than are copied, and more neighbours than are kept") {
    // 5000 rows in one cell but few within the support of each other, thanks to one huge particle far away.
    std::vector<Cloud::Point> points = uniform(5000, kH);
    points.push_back({{1, 1, 1}, 0.2f, true});
    onAllTargets([&] {
        Cloud c(points);
        c.sort();
        c.build();
        CHECK(c.particles.moverCount < 5000);
        checkAgainstAllPairs(c);
    });

    std::vector<Cloud::Point> heap(700, Cloud::Point{{0.5f, 0.5f, 0.5f}, kH, false});
    onAllTargets([&] {
        Cloud c(heap);
        c.sort();
        c.build();
        CHECK(c.neighbors.clipped);
        CHECK(c.neighbors.maxNeighbors == Neighbors::kMaxNeighbors);
        for (int i : {0, 13, 255, 256, 300, 699}) {
            std::vector<int> list = c.list(i);
            REQUIRE(list.size() == 256);
            for (int k = 0; k < 256; ++k) CHECK(list[static_cast<size_t>(k)] == k + (k >= i ? 1 : 0));
        }
    });
}

TEST_CASE("neighbors: sort puts movers first, follows the cells and keeps each particle together") {
    for (const Case& test : cases()) {
        const std::string name = test.name;
        CAPTURE(name);
        Cloud c(test.points, 3);
        int n = c.particles.count;
        c.sort();
        const Particles& p = c.particles;
        std::vector<int> seen(static_cast<size_t>(n), 0);
        int movers = 0, broken = 0;
        for (int i = 0; i < n; ++i) {
            size_t k = static_cast<size_t>(i);
            uint32_t id = p.id[k];
            ++seen[id];
            const Cloud::Point& from = test.points[id];
            float f = static_cast<float>(id);
            movers += !p.fixed(i);
            bool same = p.position[k].x == from.position.x && p.position[k].y == from.position.y &&
                        p.position[k].z == from.position.z && p.position[k].w == from.support &&
                        p.velocity[k].w == f + 3 && p.velocityChange[k].z == -f - 2 && p.normal[k].y == 3 * f &&
                        p.enthalpy[k] == 7.5 * id && p.temperature[k] == 11 * f && p.liquidFraction[k] == 13 * f &&
                        p.pressure[k] == 17 * f && p.stiffness[k] == 19 * f && p.rayChange[k] == 23 * f &&
                        p.body[k] == static_cast<uint16_t>(id * 29) && p.material[k] == static_cast<uint8_t>(id * 31) &&
                        p.level[k] == static_cast<uint8_t>(id * 37) && p.fixed(i) == from.fixed &&
                        bool(p.flags[k] & kSurface) == (id % 3 == 0) && p.fixed(i) == (i >= p.moverCount);
            broken += !same;
        }
        CHECK(broken == 0);
        CHECK(std::count(seen.begin(), seen.end(), 1) == n);
        CHECK(p.moverCount == movers);
        for (int i = n; i < n + Particles::kPadding; ++i) {
            CHECK(p.position[static_cast<size_t>(i)].x == Particles::kFar);
            CHECK(p.velocity[static_cast<size_t>(i)].w == 0);
        }
        // Stable: the same positions again change nothing.
        std::vector<uint32_t> ids(p.id.begin(), p.id.begin() + n);
        c.sort();
        CHECK(std::equal(ids.begin(), ids.end(), p.id.begin()));
    }
    // Rows of one cell keep their order.
    std::vector<Cloud::Point> heap(100, Cloud::Point{{0.5f, 0.5f, 0.5f}, kH, false});
    for (size_t i = 0; i < heap.size(); i += 2) heap[i].position.z = -0.5f;
    Cloud c(heap);
    c.sort();
    for (int i = 0; i < 50; ++i) {
        CHECK(c.particles.id[static_cast<size_t>(i)] == static_cast<uint32_t>(2 * i));
        CHECK(c.particles.id[static_cast<size_t>(50 + i)] == static_cast<uint32_t>(2 * i + 1));
    }
}

TEST_CASE("neighbors: the same bits for any number of workers") {
    for (const Case& test :
         {Case{"uniform", uniform(30011, kH)}, Case{"mixed", mixed(9000)}, Case{"far apart", farApart(3000)}}) {
        const std::string name = test.name;
        CAPTURE(name);
        Cloud one(test.points, 1);
        one.sort(), one.build(), one.weigh();
        for (int workers = 2; workers <= 4; ++workers) {
            CAPTURE(workers);
            Cloud c(test.points, workers);
            c.sort(), c.build(), c.weigh();
            auto equal = [](const auto& a, const auto& b) {
                return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
            };
            CHECK(equal(one.particles.id, c.particles.id));
            CHECK(equal(one.neighbors.first, c.neighbors.first));
            CHECK(equal(one.neighbors.width, c.neighbors.width));
            CHECK(equal(one.neighbors.volumeFraction, c.neighbors.volumeFraction));
            CHECK(equal(one.neighbors.gradientSum, c.neighbors.gradientSum));
            bool same = true;
            for (int g = 0; g < one.neighbors.groupCount; ++g) {
                size_t k = static_cast<size_t>(g), at = one.neighbors.first[k], size = 8 * one.neighbors.width[k];
                same &= std::memcmp(&one.neighbors.entries[at], &c.neighbors.entries[at], 4 * size) == 0;
                same &= std::memcmp(&one.neighbors.gradient[at], &c.neighbors.gradient[at], 4 * size) == 0;
            }
            CHECK(same);
        }
    }
}

TEST_CASE("neighbors: nothing is allocated once the sizes are known") {
    for (const Case& test : cases()) {
        const std::string name = test.name;
        CAPTURE(name);
        Cloud c(test.points, 2);
        c.sort(), c.build(), c.weigh();
        size_t calls = c.allocator.calls();
        c.sort(), c.build(), c.weigh();
        CHECK(c.allocator.calls() == calls);
    }
    // And while they move about.
    Cloud c(uniform(20000, kH), 2);
    Random random;
    size_t calls = 0;
    for (int step = 0; step < 12; ++step) {
        for (int i = 0; i < c.particles.count; ++i) {
            Vec4& x = c.particles.position[static_cast<size_t>(i)];
            x.x += 0.1f * kDx * random(-1, 1), x.y += 0.1f * kDx * random(-1, 1);
        }
        c.sort(), c.build(), c.weigh();
        if (step == 1) calls = c.allocator.calls();
    }
    CHECK(c.allocator.calls() == calls);
}

TEST_CASE("neighbors: lists stay right when crowds form where there were none") {
    Cloud c(uniform(4000, kH), 2);
    c.sort(), c.build();
    for (int i = 0; i < 2000; ++i) { // squeeze half of them into a fifth of the volume
        Vec4& x = c.particles.position[static_cast<size_t>(i)];
        x = {x.x * 0.6f, x.y * 0.6f, x.z * 0.6f, x.w};
    }
    c.sort(), c.build();
    checkAgainstAllPairs(c);
}

TEST_CASE("neighbors: candidates hold everything in reach, in order and once") {
    for (const Case& test : cases()) {
        const std::string name = test.name;
        CAPTURE(name);
        Cloud c(test.points);
        c.sort();
        const Particles& p = c.particles;
        Random random;
        int missed = 0, twice = 0, wrongKind = 0;
        float h = 0;
        for (const Cloud::Point& q : test.points) h = std::max(h, q.support);
        for (int k = 0; k < 300; ++k) {
            Vec3 at = p.position[static_cast<size_t>(random(0, 0.999f) * static_cast<float>(p.count))].xyz() +
                      Vec3{random(-1, 1) * h, random(-1, 1) * h, random(-1, 1) * h};
            const float radius = random(0.1f, 1) * h;
            std::vector<int> found, fixed;
            c.neighbors.forCandidates(at, radius, [&](int j) { found.push_back(j); });
            c.neighbors.forFixedCandidates(at, radius, [&](int j) { fixed.push_back(j); });
            found.erase(std::lower_bound(found.begin(), found.end(), p.moverCount), found.end());
            found.insert(found.end(), fixed.begin(), fixed.end());
            wrongKind += !fixed.empty() && fixed.front() < p.moverCount;
            for (size_t m = 1; m < found.size(); ++m) twice += found[m - 1] >= found[m];
            for (int j = 0; j < p.count; ++j)
                if (length(p.position[static_cast<size_t>(j)].xyz() - at) <= radius)
                    missed += !std::binary_search(found.begin(), found.end(), j);
        }
        CHECK(missed == 0);
        CHECK(twice == 0);
        CHECK(wrongKind == 0);
    }
}
