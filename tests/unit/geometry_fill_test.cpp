// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "geometry_shapes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>

using namespace thaw;

namespace {

struct Filled {
    thawResult result;
    CleanMesh mesh;
    std::vector<Vec3> points;
    float particleVolume = 0;
    std::string message;
};

Filled fill(const shapes::Mesh& mesh, float spacing, float scale = 1, int workers = 1, int maxParticles = 1000000) {
    Filled f;
    Transform to;
    to.scale = scale;
    f.result = cleanMesh(mesh.view(), to, f.mesh, f.message);
    REQUIRE_MESSAGE(f.result == thawResult_ok, f.message);
    thawTaskSystem system{};
    system.workerCount = workers;
    Tasks tasks(system);
    f.result = fillMesh(f.mesh, spacing, maxParticles, tasks, f.points, f.particleVolume, f.message);
    return f;
}

} // namespace

TEST_CASE("fillings respect surface, spacing and density") {
    struct Case {
        const char* name;
        shapes::Mesh mesh;
        double maxGap;
    };
    // Spacing is 1. The gap is larger where nothing as thick as two half layers fits.
    const Case cases[] = {{"sphere", shapes::icosphere(8, 4), 1.0},
                          {"small sphere", shapes::icosphere(3, 4), 1.0},
                          {"box of whole layers", shapes::box({10, 10, 10}), 1.0},
                          {"box", shapes::box({10.4f, 10.4f, 10.4f}), 1.1},
                          {"brick", shapes::box({20.3f, 7.6f, 13.1f}), 1.1},
                          {"torus", shapes::torus(12, 4, 96, 48), 1.05},
                          {"cylinder", shapes::cylinder(5, 20, 64), 1.1},
                          {"plate", shapes::box({20, 1.5f, 20}), 1.3},
                          {"sheet", shapes::box({20, 1, 20}), 1.0}};
    for (const Case& c : cases) {
        CAPTURE(std::string(c.name));
        Filled f = fill(c.mesh, 1);
        REQUIRE(f.result == thawResult_ok);
        shapes::Quality q = shapes::measure(f.mesh, f.points, 1);
        CHECK(q.minDepth >= 0.25);
        CHECK(q.minPair >= 0.75);
        CHECK(q.maxGap <= c.maxGap);
        CHECK(f.particleVolume == doctest::Approx(1).epsilon(0.03));
        CHECK(double(f.particleVolume) * double(f.points.size()) ==
              doctest::Approx(f.mesh.report.volume).epsilon(1e-4));
        if (q.interior > 50) {
            CHECK(q.meanError <= 0.025);
            CHECK(q.maxError <= 0.12);
        }
    }
}

TEST_CASE("a box of whole layers is filled with the lattice itself") {
    Filled f = fill(shapes::box({5, 4, 3}), 1);
    REQUIRE(f.points.size() == 60);
    for (Vec3 p : f.points) {
        CHECK(p.x == doctest::Approx(std::round(p.x)).epsilon(1e-4));
        CHECK(std::abs(p.y - std::floor(p.y) - 0.5f) < 1e-4f);
    }
}

TEST_CASE("a long bar of two triangles a side has no holes") {
    for (const float length : {125.0f, 150.0f, 300.0f, 600.0f}) {
        CAPTURE(length);
        Filled f = fill(shapes::box({length, 3, 3}), 1);
        REQUIRE(f.points.size() == static_cast<size_t>(9 * length));
        for (Vec3 p : f.points) REQUIRE(std::abs(p.y - std::round(p.y)) < 1e-3f);
    }
}

TEST_CASE("the same bits at one and three workers") {
    shapes::Mesh mesh = shapes::torus(9, 3.3f, 64, 32);
    Filled one = fill(mesh, 1, 1, 1), three = fill(mesh, 1, 1, 3);
    REQUIRE(one.points.size() == three.points.size());
    CHECK(std::memcmp(one.points.data(), three.points.data(), one.points.size() * sizeof(Vec3)) == 0);
}

TEST_CASE("scale does not matter to a filling") {
    Filled small = fill(shapes::icosphere(6, 3), 0.002f, 0.002f);
    Filled large = fill(shapes::icosphere(6, 3), 0.5f, 0.5f);
    CHECK(std::abs(double(small.points.size()) - double(large.points.size())) <= 3);
    CHECK(shapes::measure(small.mesh, small.points, 0.002f).minPair >= 0.75);
}

TEST_CASE("wicks and sheets under one spacing get a line and a layer") {
    Filled wick = fill(shapes::cylinder(0.25f, 20, 24), 1);
    REQUIRE(wick.result == thawResult_ok);
    CHECK(wick.points.size() >= 12);
    shapes::Quality q = shapes::measure(wick.mesh, wick.points, 1);
    CHECK(q.minDepth > 0.1);
    CHECK(q.maxGap < 1.1);
    Filled sheet = fill(shapes::box({20, 0.5f, 20}), 1);
    REQUIRE(sheet.result == thawResult_ok);
    q = shapes::measure(sheet.mesh, sheet.points, 1);
    CHECK(q.minDepth > 0.02);
    CHECK(q.maxGap < 1.1);
    CHECK(q.minPair >= 0.75);
}

TEST_CASE("what is too thin for particles is said") {
    shapes::Mesh mesh = shapes::box({10, 10, 10});
    CHECK(fill(mesh, 1).message.empty());
    mesh.append(shapes::box({20, 0.01f, 8}));
    Filled f = fill(mesh, 1);
    REQUIRE(f.result == thawResult_ok);
    CHECK(f.message.find("too thin") != std::string::npos);
}

TEST_CASE("holes are filled over") {
    shapes::Mesh mesh = shapes::icosphere(8, 4);
    mesh.indices.resize(mesh.indices.size() - 3 * 40); // of 5120
    Filled f = fill(mesh, 1);
    REQUIRE(f.result == thawResult_ok);
    CHECK(f.mesh.report.openEdges > 10);
    CHECK(double(f.points.size()) == doctest::Approx(2140).epsilon(0.02));
    for (Vec3 p : f.points) CHECK(length(p) < 8.3f);
}

TEST_CASE("what cannot be filled is refused with numbers") {
    Filled f = fill(shapes::icosphere(0.3f, 2), 1);
    CHECK(f.result == thawResult_badMesh);
    CHECK(f.message.find("nothing fits") != std::string::npos);
    CHECK(f.message.find("(1 m)") != std::string::npos);
    f = fill(shapes::box({10, 10, 10}), 1, 1, 1, 900);
    CHECK(f.result == thawResult_capacity);
    CHECK(f.message.find("1000") != std::string::npos);
    CHECK(f.message.find("900") != std::string::npos);
    CHECK(f.points.empty());
    f = fill(shapes::box({10, 10, 10}), 1, 1, 1, 1000);
    CHECK(f.result == thawResult_ok);
    CHECK(fill(shapes::box({10, 10, 10}), NAN).result == thawResult_invalidArgument);
    CHECK(fill(shapes::box({100, 100, 100}), 1e-4f, 100).result == thawResult_capacity);
}

TEST_CASE("the bunny is filled well") {
    shapes::Mesh bunny;
    if (!shapes::readObj(shapes::kBunny, bunny)) {
        MESSAGE("skipped: " << shapes::kBunny << " is not there");
        return;
    }
    Filled f = fill(bunny, 0.002f, 0.05f); // 0.1 m wide
    REQUIRE(f.result == thawResult_ok);
    CHECK(f.mesh.watertight);
    CHECK(f.mesh.report.openEdges == 0);
    CHECK(f.mesh.report.volume == doctest::Approx(2.0e-4).epsilon(0.01).scale(0));
    CHECK(f.particleVolume == doctest::Approx(8e-9).epsilon(0.01).scale(0));
    shapes::Quality q = shapes::measure(f.mesh, f.points, 0.002f);
    auto shallow = std::count_if(q.depths.begin(), q.depths.end(), [](float d) { return d < 0.25f; });
    CHECK(double(shallow) <= 0.001 * double(q.count)); // ear rims are thinner than a spacing
    CHECK(q.minDepth > 0);
    CHECK(q.minPair >= 0.75);
    CHECK(q.gapShare <= 0.002);
    CHECK(q.meanError <= 0.02);
    CHECK(q.maxError <= 0.12);
}
