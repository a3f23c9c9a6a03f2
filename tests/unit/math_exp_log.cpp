// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/math.h"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

using namespace thaw;

TEST_CASE("math: exp, log and cube root within 1e-7") {
    double worstExp = 0, worstLog = 0, worstCbrt = 0;
    for (int k = -8600; k <= 8800; ++k) {
        float x = static_cast<float>(k) * 0.01f;
        double e = std::exp(double(x));
        worstExp = std::max(worstExp, std::fabs(double(detExp(x)) - e) / e);
    }
    for (float x = 1e-30f; x < 1e30f; x *= 1.0173f) {
        double l = std::log(double(x));
        worstLog = std::max(worstLog, std::fabs(double(detLog(x)) - l) / std::max(1.0, std::fabs(l)));
        double c = std::cbrt(double(x));
        worstCbrt = std::max(worstCbrt, std::fabs(double(detCbrt(x)) - c) / c);
    }
    CHECK(worstExp < 1e-7);
    CHECK(worstLog < 1e-7);
    CHECK(worstCbrt < 1e-7);
}

TEST_CASE("math: ends of the range") {
    CHECK(detExp(0) == 1);
    CHECK(detExp(-1000) == 0);
    CHECK(detExp(-INFINITY) == 0);
    CHECK(detExp(NAN) == 0);
    CHECK(std::isfinite(detExp(1000)));
    CHECK(detExp(1000) == detExp(88));
    CHECK(detLog(1) == 0);
    CHECK(detCbrt(0) == 0);
    CHECK(detCbrt(-8) == 0);
    CHECK(detCbrt(8) == doctest::Approx(2).epsilon(1e-7));
    CHECK(detCbrt(27) == doctest::Approx(3).epsilon(1e-7));
}

TEST_CASE("math: the bits are those of the day the state format was fixed") {
    CHECK(std::bit_cast<uint32_t>(detExp(1.0f)) == 0x402df854u);
    CHECK(std::bit_cast<uint32_t>(detLog(2.0f)) == 0x3f317218u);
    CHECK(std::bit_cast<uint32_t>(detCbrt(2.0f)) == 0x3fa14518u);
}

TEST_CASE("math: hashes depend on value and order") {
    std::set<uint64_t> seen;
    for (uint64_t a = 0; a < 100; ++a)
        for (uint64_t b = 0; b < 100; ++b) seen.insert(hashCombine(hashCombine(1, a), b));
    CHECK(seen.size() == 10000);
}
