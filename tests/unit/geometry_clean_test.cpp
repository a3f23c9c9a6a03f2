// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "geometry_shapes.h"

#include "geometry/triangle_tree.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

using namespace thaw;

namespace {

struct Cleaned {
    thawResult result;
    CleanMesh mesh;
    std::string message;
};

Cleaned clean(const shapes::Mesh& mesh, const Transform& to = {}) {
    Cleaned c;
    c.result = cleanMesh(mesh.view(), to, c.mesh, c.message);
    return c;
}

bool has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

double wind(const CleanMesh& m, Vec3 p) { return double(TriangleTree(m.vertices, m.indices).winding(p)); }

} // namespace

TEST_CASE("winding number of a tetrahedron is 1 inside and 0 outside") {
    Cleaned c = clean(shapes::tetrahedron());
    REQUIRE(c.result == thawResult_ok);
    for (Vec3 p : {Vec3{0.1f, 0.1f, 0.1f}, {0.25f, 0.25f, 0.25f}, {0.01f, 0.01f, 0.9f}}) {
        CHECK(wind(c.mesh, p) == doctest::Approx(1).epsilon(1e-4));
        CHECK(exactWinding(c.mesh.vertices, c.mesh.indices, p) == doctest::Approx(1).epsilon(1e-6));
    }
    for (Vec3 p : {Vec3{0.4f, 0.4f, 0.4f}, {-0.01f, 0.2f, 0.2f}, {5, 5, 5}, {-1e4f, 0, 0}})
        CHECK(std::abs(wind(c.mesh, p)) < 1e-3);
}

TEST_CASE("the tree agrees with the sum over all triangles") {
    shapes::Mesh m = shapes::icosphere(1, 4);
    m.append(shapes::torus(1.5f, 0.3f, 60, 24), {0.2f, 0.1f, 0});
    m.indices.resize(m.indices.size() - 90); // a hole, so that fractions occur
    std::vector<Vec3> vertices;
    for (size_t i = 0; i < m.vertices.size(); i += 3)
        vertices.push_back({m.vertices[i], m.vertices[i + 1], m.vertices[i + 2]});
    TriangleTree tree(vertices, m.indices);
    double worst = 0, sum = 0;
    int n = 0;
    for (float x = -2; x < 2; x += 0.31f)
        for (float y = -1.2f; y < 1.2f; y += 0.23f)
            for (float z = -2; z < 2; z += 0.37f, ++n) {
                Vec3 p{x, y, z};
                double error = std::abs(double(tree.winding(p)) - exactWinding(vertices, m.indices, p));
                worst = std::max(worst, error), sum += error;
                // Nearest point: by brute force over the vertices it can only be nearer.
                float d = std::sqrt(tree.nearest(p).distance2), v = INFINITY;
                for (size_t i = 0; i < vertices.size(); i += 7) v = std::min(v, length(vertices[i] - p));
                CHECK(d <= v * 1.0001f);
            }
    CHECK(worst < 0.06);
    CHECK(sum / n < 0.005);
}

TEST_CASE("nested and overlapping shapes wind twice, a cavity winds zero") {
    shapes::Mesh nested = shapes::box({4, 4, 4});
    nested.append(shapes::box({2, 2, 2}));
    Cleaned c = clean(nested);
    REQUIRE(c.result == thawResult_ok);
    CHECK(wind(c.mesh, {0, 0, 0}) == doctest::Approx(2).epsilon(1e-3));
    CHECK(wind(c.mesh, {1.5f, 0, 0}) == doctest::Approx(1).epsilon(1e-3));
    CHECK(c.mesh.report.volume == doctest::Approx(64).epsilon(0.02)); // not 72
    CHECK(c.mesh.report.components == 2);

    shapes::Mesh hollow = shapes::box({4, 4, 4});
    hollow.append(shapes::box({2, 2, 2}), {}, true);
    c = clean(hollow);
    REQUIRE(c.result == thawResult_ok);
    CHECK(std::abs(wind(c.mesh, {0, 0, 0})) < 1e-3);
    CHECK(c.mesh.report.volume == doctest::Approx(56).epsilon(1e-5));
    CHECK_FALSE(c.mesh.report.inverted);

    shapes::Mesh overlap = shapes::box({2, 2, 2});
    overlap.append(shapes::box({2, 2, 2}), {1, 0.3f, 0.2f});
    c = clean(overlap);
    REQUIRE(c.result == thawResult_ok);
    CHECK(wind(c.mesh, {0.5f, 0.1f, 0.1f}) == doctest::Approx(2).epsilon(1e-3));
    CHECK(c.mesh.report.volume == doctest::Approx(16 - 1 * 1.7 * 1.8).epsilon(0.02));
}

TEST_CASE("faces that look inward are turned: all, a part, one piece") {
    shapes::Mesh m;
    m.append(shapes::icosphere(1, 2), {}, true);
    Cleaned c = clean(m);
    REQUIRE(c.result == thawResult_ok);
    CHECK(c.mesh.report.inverted);
    CHECK(wind(c.mesh, {0, 0, 0}) == doctest::Approx(1).epsilon(0.08));
    CHECK(c.mesh.report.volume > 4);

    shapes::Mesh part = shapes::icosphere(1, 2);
    for (size_t t = 0; t < part.indices.size(); t += 15) std::swap(part.indices[t], part.indices[t + 1]);
    c = clean(part);
    REQUIRE(c.result == thawResult_ok);
    CHECK_FALSE(c.mesh.report.inverted);
    CHECK(c.mesh.report.inconsistentEdges > 100);
    CHECK(c.mesh.watertight);
    CHECK(wind(c.mesh, {0.3f, 0.2f, 0}) == doctest::Approx(1).epsilon(0.08));

    shapes::Mesh two = shapes::icosphere(1, 2);
    two.append(shapes::icosphere(0.5f, 2), {3, 0, 0}, true);
    c = clean(two);
    REQUIRE(c.result == thawResult_ok);
    CHECK(c.mesh.report.inverted);
    CHECK(wind(c.mesh, {3, 0, 0}) == doctest::Approx(1).epsilon(0.08));
    CHECK(wind(c.mesh, {0, 0, 0}) == doctest::Approx(1).epsilon(0.08));
}

TEST_CASE("vertices are welded and useless triangles dropped, and the report counts them") {
    shapes::Mesh b = shapes::box({1, 1, 1}), soup;
    for (uint32_t i : b.indices)
        soup.indices.push_back(soup.vertex({b.vertices[3 * i], b.vertices[3 * i + 1], b.vertices[3 * i + 2]}));
    soup.triangle(0, 0, 5);
    soup.triangle(0, 1, 2); // the first triangle again
    Cleaned c = clean(soup);
    REQUIRE(c.result == thawResult_ok);
    CHECK(c.mesh.vertices.size() == 8);
    CHECK(c.mesh.indices.size() == 36);
    CHECK(c.mesh.report.duplicateVertices == 28);
    CHECK(c.mesh.report.degenerateTriangles == 2);
    CHECK(c.mesh.report.openEdges == 0);
    CHECK(c.mesh.report.components == 1);
    CHECK(c.mesh.report.volume == doctest::Approx(1).epsilon(1e-6));
    CHECK(c.mesh.report.area == doctest::Approx(6).epsilon(1e-6));
    CHECK(c.mesh.watertight);
}

TEST_CASE("a mesh exported with both sides is one solid") {
    shapes::Mesh m = shapes::box({1, 2, 3}), back = m;
    for (size_t t = 0; t < back.indices.size(); t += 3)
        m.triangle(back.indices[t], back.indices[t + 2], back.indices[t + 1]);
    Cleaned c = clean(m);
    REQUIRE(c.result == thawResult_ok);
    CHECK(c.mesh.report.volume == doctest::Approx(6).epsilon(1e-5));
    CHECK(c.mesh.report.degenerateTriangles == 12);
}

TEST_CASE("a box without one triangle is closed by its winding number") {
    shapes::Mesh m = shapes::box({2, 2, 2});
    m.indices.resize(m.indices.size() - 3);
    Cleaned c = clean(m);
    REQUIRE(c.result == thawResult_ok);
    CHECK(c.mesh.report.openEdges == 3);
    CHECK_FALSE(c.mesh.watertight);
    CHECK(wind(c.mesh, {0, 0, 0}) > 0.8);
    CHECK(wind(c.mesh, {3, 3, 3}) < 0.1);
    CHECK(c.mesh.report.volume == doctest::Approx(8).epsilon(0.1));
}

TEST_CASE("a transformed mesh has the transformed volume and bounds") {
    Transform to;
    to.position = {10, -3, 2};
    to.rotation = {0.5f, 0.5f, 0.5f, 0.5f}; // x -> y -> z -> x
    to.scale = 3;
    Cleaned c = clean(shapes::box({1, 2, 4}), to);
    REQUIRE(c.result == thawResult_ok);
    CHECK(c.mesh.report.volume == doctest::Approx(27 * 8).epsilon(1e-5));
    CHECK(c.mesh.bounds.lower.x == doctest::Approx(10 - 6));
    CHECK(c.mesh.bounds.upper.y == doctest::Approx(-3 + 1.5));
    CHECK(c.mesh.bounds.upper.z == doctest::Approx(2 + 3));
}

TEST_CASE("refusals name the reason and the place") {
    shapes::Mesh good = shapes::icosphere(1, 2);
    SUBCASE("not finite") {
        shapes::Mesh m = good;
        m.vertices[3 * 17 + 1] = std::numeric_limits<float>::quiet_NaN();
        Cleaned c = clean(m);
        CHECK(c.result == thawResult_invalidArgument);
        CHECK(has(c.message, "vertex 17 is not finite (y = nan)"));
        m.vertices[3 * 17 + 1] = -INFINITY;
        CHECK(has(clean(m).message, "(y = -inf)"));
    }
    SUBCASE("index out of range") {
        shapes::Mesh m = good;
        m.indices[12] = 900;
        Cleaned c = clean(m);
        CHECK(c.result == thawResult_invalidArgument);
        CHECK(has(c.message, "index 12 names vertex 900 of 162"));
    }
    SUBCASE("nothing there") {
        CHECK(clean({}).result == thawResult_badMesh);
        CHECK(has(clean({}).message, "no triangles"));
        thawMesh view = good.view();
        view.indices = nullptr;
        CleanMesh out;
        std::string message;
        CHECK(cleanMesh(view, {}, out, message) == thawResult_invalidArgument);
        CHECK(has(message, "mesh.indices is NULL"));
        view = good.view(), view.vertexCount = size_t(1) << 60;
        CHECK(cleanMesh(view, {}, out, message) == thawResult_invalidArgument);
        CHECK(has(message, "mesh.vertexCount"));
    }
    SUBCASE("only degenerate") {
        shapes::Mesh m;
        m.vertex({0, 0, 0}), m.vertex({1, 1, 1}), m.vertex({2, 2, 2});
        m.triangle(0, 1, 2), m.triangle(1, 1, 2);
        Cleaned c = clean(m);
        CHECK(c.result == thawResult_badMesh);
        CHECK(has(c.message, "all 2 are degenerate"));
    }
    SUBCASE("a sheet") {
        shapes::Mesh m;
        for (int i = 0; i < 16; ++i) m.vertex({float(i % 4), 0.2f * float(i % 3), float(i / 4)});
        for (uint32_t i = 0; i < 11; ++i)
            if (i % 4 != 3) m.quad(i, i + 4, i + 5, i + 1);
        Cleaned c = clean(m);
        CHECK(c.result == thawResult_badMesh);
        CAPTURE(c.message);
        CHECK(has(c.message, "open by 12 edges and encloses no volume"));
        CHECK(c.mesh.report.openEdges == 12);
    }
    SUBCASE("closed without volume") {
        shapes::Mesh m;
        m.vertex({0, 0, 0}), m.vertex({1, 0, 0}), m.vertex({1, 0, 1}), m.vertex({0, 0, 1}), m.vertex({0.5f, 0, 0.5f});
        m.quad(0, 1, 2, 3);
        for (uint32_t i = 0; i < 4; ++i) m.triangle(i, 4, (i + 1) % 4);
        Cleaned c = clean(m);
        CHECK(c.result == thawResult_badMesh);
        CHECK(has(c.message, "encloses no volume"));
    }
    SUBCASE("half of it missing") {
        shapes::Mesh m;
        m.vertices = good.vertices;
        for (size_t t = 0; t < good.indices.size(); t += 3) {
            float y = 0;
            for (size_t k = 0; k < 3; ++k) y += good.vertices[3 * good.indices[t + k] + 1];
            if (y < 0) m.triangle(good.indices[t], good.indices[t + 1], good.indices[t + 2]);
        }
        Cleaned c = clean(m);
        CHECK(c.result == thawResult_badMesh);
        CHECK(has(c.message, "open by"));
        CHECK(has(c.message, "ambiguous"));
    }
    SUBCASE("nine triangles at random") {
        shapes::Mesh m;
        uint32_t r = 7;
        auto random = [&] { return r = r * 1664525u + 1013904223u, float(r >> 8) / 16777216.0f; };
        for (uint32_t i = 0; i < 27; ++i) m.vertex({random(), random(), random()});
        for (uint32_t i = 0; i < 27; i += 3) m.triangle(i, i + 1, i + 2);
        Cleaned c = clean(m);
        CHECK(c.result == thawResult_badMesh);
        CHECK(has(c.message, "open by 27 edges"));
        CHECK(c.mesh.report.components == 9);
    }
    SUBCASE("too far and too large") {
        Transform to;
        to.scale = 2e4f;
        Cleaned c = clean(good, to);
        CHECK(c.result == thawResult_invalidArgument);
        CHECK(has(c.message, "at most 10000 m"));
        to.scale = 0.01f, to.position = {9000, 0, 0};
        c = clean(good, to);
        CHECK(c.result == thawResult_badMesh);
        CHECK(has(c.message, "float resolves"));
        to.scale = 1000;
        CHECK(clean(good, to).result == thawResult_ok);
        to.scale = -1;
        CHECK(clean(good, to).result == thawResult_invalidArgument);
    }
}
