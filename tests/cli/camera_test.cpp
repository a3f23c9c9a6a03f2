// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "../../samples/player/scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace thaw::scene;

namespace {
// Uneven in time, with a turn back, a flat stretch and a steep one.
Camera path() {
    Camera c;
    c.eye = {9, 9, 9}, c.target = {8, 8, 8};
    c.keys = {{1.0f, {0, 0, 1}, {0, 0, 0}, 30},
              {2.0f, {1, 5, 1}, {0, 1, 0}, 30},
              {4.0f, {2, -3, 1}, {0, 2, 0}, 50},
              {4.5f, {9, -3, 1}, {0, 8, 0}, 20}};
    return c;
}
} // namespace

TEST_CASE("a camera without keys stands where it is at every time") {
    Camera c;
    c.eye = {1, 2, 3}, c.target = {4, 5, 6}, c.fieldOfViewDegrees = 21;
    for (const double t : {0.0, 3.0, 1e6}) {
        const Camera now = cameraAt(c, t);
        CHECK(now.eye.y == 2.0f);
        CHECK(now.target.z == 6.0f);
        CHECK(now.fieldOfViewDegrees == 21.0f);
    }
}

TEST_CASE("a camera goes through its keys, and stands before the first and after the last") {
    const Camera c = path();
    const auto same = [](const Camera& now, const CameraKey& key) {
        CHECK(now.eye.x == key.eye.x);
        CHECK(now.eye.y == key.eye.y);
        CHECK(now.eye.z == key.eye.z);
        CHECK(now.target.y == key.target.y);
        CHECK(now.fieldOfViewDegrees == key.fieldOfViewDegrees);
    };
    for (const CameraKey& key : c.keys) same(cameraAt(c, double(key.time)), key);
    same(cameraAt(c, 0), c.keys.front());
    same(cameraAt(c, 100), c.keys.back());
    Camera one = c;
    one.keys.resize(1);
    for (const double t : {0.0, 1.0, 2.0}) same(cameraAt(one, t), c.keys.front());
}

TEST_CASE("between two keys a camera stays between them, moves smoothly, and keeps its pace on a line") {
    const Camera c = path();
    const auto number = [](const Camera& now, int i) {
        return double(i == 0 ? now.eye.x : i == 1 ? now.eye.y : i == 2 ? now.target.y : now.fieldOfViewDegrees);
    };
    const auto ofKey = [](const CameraKey& key, int i) {
        return double(i == 0 ? key.eye.x : i == 1 ? key.eye.y : i == 2 ? key.target.y : key.fieldOfViewDegrees);
    };
    for (size_t k = 0; k + 1 < c.keys.size(); ++k)
        for (int i = 0; i < 4; ++i) {
            const double a = ofKey(c.keys[k], i), b = ofKey(c.keys[k + 1], i);
            double last = a;
            for (int s = 1; s <= 50; ++s) {
                const double t = double(c.keys[k].time) + double(c.keys[k + 1].time - c.keys[k].time) * s / 50;
                const double x = number(cameraAt(c, t), i);
                CHECK(x >= std::min(a, b) - 1e-6);
                CHECK(x <= std::max(a, b) + 1e-6);
                CHECK((x - last) * (b - a) >= -1e-6); // never back
                last = x;
            }
        }
    // No jump in speed at a key: the slopes just before and after are alike; straight lines would differ by 1 and 2.5.
    for (size_t k = 1; k + 1 < c.keys.size(); ++k)
        for (int i = 0; i < 4; ++i) {
            const double t = double(c.keys[k].time), d = 2e-4;
            const double before = (number(cameraAt(c, t), i) - number(cameraAt(c, t - d), i)) / d,
                         after = (number(cameraAt(c, t + d), i) - number(cameraAt(c, t), i)) / d;
            CHECK(std::abs(before - after) < 0.25);
        }
    // Evenly spaced keys on a line: even speed between inner ones.
    Camera line;
    for (int k = 0; k < 5; ++k) line.keys.push_back({float(k), {float(2 * k), 0, 5}, {0, 0, 0}, 35});
    for (int s = 0; s <= 10; ++s)
        CHECK(cameraAt(line, 1.0 + 0.2 * s).eye.x == doctest::Approx(2.0 + 0.4 * s).epsilon(1e-5));
}
