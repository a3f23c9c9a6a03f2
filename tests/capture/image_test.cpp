// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "pictures.h"
#include "synthetic_candle.h"
#include "view/color_map.h"
#include "view/font.h"
#include "view/legend.h"
#include "view/mesh_io.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

using namespace thaw;
using namespace thaw::test;
using namespace thaw::view;
using view::Image;
using view::Rgba;

static std::string slurp(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

TEST_CASE("a PNG reads back as it was written") {
    Image image(37, 23);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            image.at(x, y) = {uint8_t(x * 6), uint8_t(y * 11), uint8_t(x * y), uint8_t(255 - x)};
    std::string error;
    const std::string path = artefact("round_trip.png");
    REQUIRE_MESSAGE(view::writePng(path, image, error), error);
    const std::optional<Image> back = view::readPng(path, error);
    REQUIRE_MESSAGE(back, error);
    CHECK(back->width == image.width);
    CHECK(back->pixels == image.pixels);
    CHECK_FALSE(view::writePng("/no/such/folder/x.png", image, error));
    CHECK(error.find("/no/such/folder/x.png") != std::string::npos);
    CHECK_FALSE(view::writePng(path, Image{}, error));
    CHECK_FALSE(view::readPng(artefact("missing.png"), error));
    std::ofstream(artefact("text.png")) << "no picture";
    CHECK_FALSE(view::readPng(artefact("text.png"), error));
}

TEST_CASE("compare counts pixels over the tolerance") {
    Image a(10, 10, {100, 100, 100, 255}), b = a;
    CHECK(view::compare(a, b, 0).maxChannel == 0);
    CHECK(view::compare(a, b, 0).shareOver == 0);
    b.at(3, 4).g = 110;
    b.at(5, 5).b = 102;
    const view::ImageDifference difference = view::compare(a, b, 5);
    CHECK(difference.maxChannel == 10);
    CHECK(difference.shareOver == doctest::Approx(0.01).scale(0));
    CHECK(difference.meanAbsolute == doctest::Approx(12.0 / 300).scale(0));
    CHECK(difference.picture.at(3, 4).r > difference.picture.at(3, 4).g);
    CHECK(difference.picture.at(5, 5).r == difference.picture.at(5, 5).g);
    CHECK(view::compare(a, b, 10).shareOver == 0);
    CHECK_FALSE(view::compare(a, Image(9, 10), 5).sameSize);
    CHECK(view::compare(a, Image(9, 10), 5).shareOver == 1);
}

TEST_CASE("every character has its own shape inside its box") {
    std::set<std::string> shapes;
    for (int c = 32; c < 128; ++c) {
        std::string shape;
        for (int y = 0; y < view::kGlyphHeight; ++y)
            for (int x = 0; x < view::kGlyphWidth; ++x)
                shape += view::glyphBit(static_cast<unsigned char>(c), x, y) ? '#' : '.';
        CHECK_MESSAGE(shapes.insert(shape).second, "character " << c << " looks like another");
        CHECK((shape.find('#') == std::string::npos) == (c == 32));
    }
    CHECK_FALSE(view::glyphBit('A', 5, 0));
    CHECK_FALSE(view::glyphBit('A', 0, 9));
    CHECK_FALSE(view::glyphBit(200, 2, 2));
}

TEST_CASE("text is drawn where it is asked for and cut at the edge") {
    Image image(60, 20);
    view::drawText(image, 2, 3, "I", 1, {255, 255, 255, 255});
    int set = 0;
    for (const Rgba& p : image.pixels) set += p.r == 255;
    CHECK(set == 11); // two bars of three and a stem of five
    CHECK(image.at(3, 3).r == 255);
    CHECK(image.at(4, 6).r == 255);
    CHECK(image.at(2, 3).r == 0);
    view::drawText(image, 50, 15, "cut off", 3, {255, 0, 0, 255});
    view::drawText(image, -100, -100, "outside", 2, {255, 0, 0, 255});
    CHECK(view::textWidth("abc", 2) == 34);
    CHECK(view::textWidth("\xC2\xB0"
                          "C",
                          1) == 11);
}

TEST_CASE("a contact sheet holds every picture over its caption") {
    std::vector<view::CaptionedImage> parts;
    for (int i = 0; i < 5; ++i)
        parts.push_back({Image(40, 30, {uint8_t(50 * i), 80, 200, 255}), "t = " + std::to_string(i) + " s"});
    const Image sheet = view::contactSheet(parts, 3);
    // Three columns and two rows, gaps of 6, captions of 12.
    CHECK(sheet.width == 6 + 3 * 46);
    CHECK(sheet.height == 6 + 2 * (30 + 12 + 6));
    CHECK(sheet.at(6 + 46 + 20, 6 + 15) == Rgba{50, 80, 200, 255});
    CHECK(sheet.at(6 + 46 + 20, 6 + 48 + 15) == Rgba{200, 80, 200, 255});
    int ink = 0;
    for (int x = 6; x < 46; ++x)
        for (int y = 36; y < 48; ++y) ink += sheet.at(x, y).r > 200;
    CHECK(ink > 20);
    CHECK(view::contactSheet({}).width == 0);
    CHECK(view::contactSheet(parts).width == sheet.width);
}

TEST_CASE("heat colours rise evenly in lightness from blue to red") {
    double last = -1;
    for (int i = 0; i <= 20; ++i) {
        const thawVec3 c = view::heatColor(static_cast<float>(i) / 20);
        const double y = 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
        CHECK(y > last);
        last = y;
    }
    const thawVec3 cold = view::heatColor(0), hot = view::heatColor(1);
    CHECK(cold.z > 4 * cold.x);
    CHECK(hot.x > 4 * hot.z);
    CHECK(view::heatColor(-5).x == cold.x);
    CHECK(view::heatColor(7).x == hot.x);
    CHECK(view::phaseOf(0) == view::Phase::solid);
    CHECK(view::phaseOf(0.5f) == view::Phase::mushy);
    CHECK(view::phaseOf(1) == view::Phase::liquid);
    CHECK(view::encodeSrgb(0.5f) == 188);
}

TEST_CASE("the temperature scale grows with its text and shows the ramp") {
    const Image one = view::temperatureLegend(293.15f, 373.15f, 1), two = view::temperatureLegend(293.15f, 373.15f, 2);
    CHECK(two.width == 2 * one.width);
    CHECK(two.height == 2 * one.height);
    int hot = 0, cold = 0;
    for (const Rgba& p : one.pixels) {
        hot += p.r > 180 && p.b < 100 && p.g < 170 && p.a == 255;
        cold += p.b > 100 && p.r < 70 && p.a == 255;
    }
    CHECK(hot > 100);
    CHECK(cold > 100);
    // A range without extent and a tiny one must not hang or divide by zero.
    CHECK(view::temperatureLegend(300, 300, 1).width > 0);
    CHECK(view::rangeLegend("speed", "m/s", 0, 1e-6f, 1).width > 0);
    CHECK(view::phaseLegend(1).height > 30);
}

TEST_CASE("a PLY has the vertices, the faces and the bytes it says") {
    const SyntheticCandle candle(24, 20);
    const thawSurfaceView surface = candle.view();
    const Vec3 color{0.5f, 0, 1};
    std::string error;
    const std::string path = artefact("candle.ply");
    REQUIRE_MESSAGE(view::writePly(path, surface, {&color, 1}, error), error);
    const std::string bytes = slurp(path);
    const std::string end = "end_header\n";
    const size_t head = bytes.find(end) + end.size();
    CHECK(bytes.rfind("ply\nformat binary_little_endian 1.0\n", 0) == 0);
    CHECK(bytes.find("element vertex " + std::to_string(surface.vertexCount) + "\n") < head);
    CHECK(bytes.find("element face " + std::to_string(surface.triangleCount) + "\n") < head);
    for (const char* name : {"float nx", "float temperature", "float liquid_fraction", "uchar red"})
        CHECK(bytes.find(std::string("property ") + name) < head);
    const size_t vertexBytes = 6 * 4 + 3 + 2 * 4 + 1, faceBytes = 1 + 3 * 4;
    REQUIRE(bytes.size() ==
            head + vertexBytes * size_t(surface.vertexCount) + faceBytes * size_t(surface.triangleCount));
    const size_t vertex = 101;
    float x = 0, kelvin = 0;
    std::memcpy(&x, bytes.data() + head + vertex * vertexBytes, 4);
    std::memcpy(&kelvin, bytes.data() + head + vertex * vertexBytes + 27, 4);
    CHECK(x == surface.positions[vertex * 3]);
    CHECK(kelvin == surface.temperatures[vertex]);
    CHECK(static_cast<unsigned char>(bytes[head + vertex * vertexBytes + 24]) == 188);
    CHECK(static_cast<unsigned char>(bytes[head + vertex * vertexBytes + 26]) == 255);
    uint32_t index = 0;
    std::memcpy(&index, bytes.data() + head + vertexBytes * size_t(surface.vertexCount) + 1 + 4, 4);
    CHECK(index == surface.indices[1]);
    CHECK_FALSE(view::writePly("/no/such/folder/x.ply", surface, {}, error));
    CHECK_FALSE(view::writePly(path, thawSurfaceView{}, {}, error));
    CHECK(error.find("empty") != std::string::npos);
}

TEST_CASE("an OBJ counts from one and keeps every digit") {
    const SyntheticCandle candle(16, 12);
    const thawSurfaceView surface = candle.view();
    std::string error;
    const std::string path = artefact("candle.obj");
    REQUIRE_MESSAGE(view::writeObj(path, surface, {}, error), error);
    std::istringstream lines(slurp(path));
    int vertices = 0, normals = 0, faces = 0;
    unsigned lowest = ~0u, highest = 0;
    bool exact = true;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string kind;
        words >> kind;
        if (kind == "v") {
            float p[3];
            words >> p[0] >> p[1] >> p[2];
            exact = exact && std::memcmp(p, surface.positions + size_t(vertices) * 3, 12) == 0;
            ++vertices;
        }
        if (kind == "vn") ++normals;
        if (kind == "f") {
            ++faces;
            unsigned a = 0;
            words >> a;
            lowest = std::min(lowest, a), highest = std::max(highest, a);
        }
    }
    CHECK(exact);
    CHECK(vertices == surface.vertexCount);
    CHECK(normals == surface.vertexCount);
    CHECK(faces == surface.triangleCount);
    CHECK(lowest == 1);
    CHECK(highest <= unsigned(surface.vertexCount));
}

TEST_CASE("a framed camera sees all corners and no more room than asked for") {
    view::Bounds bounds;
    bounds.add(Vec3{-0.02f, 0, -0.05f});
    bounds.add(Vec3{0.03f, 0.2f, 0.01f});
    for (const float aspect : {0.5f, 1.0f, 1.78f})
        for (const float azimuth : {0.0f, 1.1f, 3.0f}) {
            view::Orbit orbit;
            orbit.azimuth = azimuth;
            orbit.margin = 1;
            const view::Camera c = view::frame(bounds, orbit, aspect);
            const Vec3 forward = normalize(c.target - c.eye), right = normalize(cross(forward, c.up)),
                       up = cross(right, forward);
            float most = 0;
            for (int i = 0; i < 8; ++i) {
                const Vec3 d = Vec3{i & 1 ? 0.03f : -0.02f, i & 2 ? 0.2f : 0, i & 4 ? 0.01f : -0.05f} - c.eye;
                const float depth = dot(d, forward), t = std::tan(c.fieldOfView / 2);
                most = std::max(
                    {most, std::fabs(dot(d, right)) / (depth * t * aspect), std::fabs(dot(d, up)) / (depth * t)});
            }
            CHECK(most == doctest::Approx(1).epsilon(0.001));
        }
    CHECK(view::frame({}, {}, 1).fieldOfView > 0);
}

TEST_CASE("made meshes are closed and face outward") {
    for (const view::TriangleMesh& mesh :
         {view::makeBox({1, 2, 3}), view::makeSphere(1.5f), view::makeCylinder(0.5f, 2)}) {
        double volume = 0;
        int against = 0;
        const auto at = [](const std::vector<float>& v, uint32_t i) {
            return Vec3{v[i * 3], v[i * 3 + 1], v[i * 3 + 2]};
        };
        for (size_t t = 0; t < mesh.indices.size(); t += 3) {
            const Vec3 a = at(mesh.positions, mesh.indices[t]), b = at(mesh.positions, mesh.indices[t + 1]),
                       c = at(mesh.positions, mesh.indices[t + 2]);
            volume += dot(a, cross(b, c)) / 6;
            const Vec3 n = cross(b - a, c - a);
            const Vec3 mean = at(mesh.normals, mesh.indices[t]) + at(mesh.normals, mesh.indices[t + 1]) +
                              at(mesh.normals, mesh.indices[t + 2]);
            if (length(n) > 1e-7f && dot(n, mean) <= 0) ++against;
        }
        CHECK(against == 0);
        const double expected = mesh.bounds().upper.x == 1 ? 48 : mesh.bounds().upper.y == 2 ? 1.4399 : 14.137;
        CHECK(volume == doctest::Approx(expected).epsilon(0.03));
    }
}
