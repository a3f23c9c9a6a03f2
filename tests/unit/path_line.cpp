// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "control/path_line.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace thaw;

TEST_CASE("path: equal steps along straight parts, and the nearest place") {
    PathLine line;
    std::string message;
    const Vec3 points[] = {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 2, 0}};
    REQUIRE(line.make(points, 4, false, 0.1f, 0.2f, message));
    CHECK(line.length() == doctest::Approx(3));
    CHECK(line.at(0.5f).point.x == doctest::Approx(0.5));
    CHECK(line.at(2.0f).point.y == doctest::Approx(1));
    CHECK(line.at(2.0f).tangent.y == doctest::Approx(1));
    CHECK(line.at(-1).along == 0);
    CHECK(line.at(99).along == doctest::Approx(3));
    Foot foot;
    REQUIRE(line.nearest({0.3f, 0.15f, 0}, foot));
    CHECK(foot.along == doctest::Approx(0.3));
    CHECK_FALSE(line.nearest({0.3f, 0.25f, 0}, foot)); // beyond its reach
    CHECK_FALSE(line.nearest({5, 5, 5}, foot));
    CHECK(line.nearest({1.1f, 1.5f, 0}, 0.0f, 1.2f).along ==
          doctest::Approx(1.2).epsilon(0.02)); // only where it may look
}

TEST_CASE("path: a spline goes through its points and is no shorter than the way between them") {
    PathLine smooth, straight;
    std::string message;
    const Vec3 points[] = {{0, 0, 0}, {0.1f, 0.05f, 0}, {0.2f, -0.05f, 0.02f}, {0.3f, 0, 0}};
    REQUIRE(smooth.make(points, 4, true, 0.01f, 0.02f, message));
    REQUIRE(straight.make(points, 4, false, 0.01f, 0.02f, message));
    CHECK(smooth.length() > straight.length());
    CHECK(smooth.length() < 1.3f * straight.length());
    for (const Vec3& x : points) {
        Foot foot;
        REQUIRE(smooth.nearest(x, foot));
        CHECK(length(foot.point - x) < 1e-3f);
    }
    CHECK(smooth.hash() != straight.hash());
    // Where a straight one turns at once, it turns bit by bit.
    const auto sharpest = [](const PathLine& l) {
        float least = 1;
        for (float s = 0; s + 0.004f < l.length(); s += 0.001f)
            least = std::min(least, dot(l.at(s).tangent, l.at(s + 0.004f).tangent));
        return least;
    };
    CHECK(sharpest(smooth) > 0.9f);
    CHECK(sharpest(straight) < 0.7f);
}

TEST_CASE("path: what is no line is refused, what is long has its limit") {
    PathLine line;
    std::string message;
    const Vec3 same[] = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
    CHECK_FALSE(line.make(same, 3, true, 0.1f, 0.2f, message));
    CHECK(message.find("3") != std::string::npos);
    CHECK_FALSE(line.make(same, 0, true, 0.1f, 0.2f, message));
    const Vec3 far[] = {{-1e5f, 0, 0}, {1e5f, 0, 0}};
    REQUIRE(line.make(far, 2, true, 1e-4f, 2e-4f, message));
    CHECK(line.points().size() <= 16385);
    CHECK(line.at(1e5f).point.x == doctest::Approx(0).epsilon(1e-3).scale(1e5));
}
