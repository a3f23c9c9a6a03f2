// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Pictures of every way to draw, against those in golden/. They are of the renderer that golden/renderer.txt names, and
// are compared on that one only; what holds on every renderer is in capture_test.cpp and splats_test.cpp.
// THAW_UPDATE_GOLDEN=1 writes them and that name anew.

#include "pictures.h"
#include "splat_shapes.h"
#include "view_fixture.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

using namespace thaw;
using namespace thaw::test;
using namespace thaw::view;
using view::Image;

namespace {

constexpr int kTolerance = 6;       // of 255, in any channel
constexpr double kMostOver = 0.002; // share of the pixels that may differ by more

std::string goldenPath(const std::string& name) {
    return std::string(THAW_SOURCE_DIR) + "/tests/capture/golden/" + name;
}

// Whether an image is the golden one, within the tolerance. If not, it and where it differs are written as artefacts.
bool matches(const Image& image, const Image& golden, const std::string& name, std::string& error) {
    const view::ImageDifference difference = view::compare(image, golden, kTolerance);
    if (difference.sameSize && difference.shareOver <= kMostOver) return true;
    error = view::writePng(artefact((name + ".actual.png").c_str()), image, error) &&
                    (!difference.sameSize ||
                     view::writePng(artefact((name + ".difference.png").c_str()), difference.picture, error))
                ? "see " + artefact((name + ".actual.png").c_str())
                : error;
    return false;
}

view::View goldenView(view::ViewMode mode = view::ViewMode::shaded) {
    view::View v;
    v.width = 240, v.height = 180;
    v.camera = SyntheticCandle::camera(240.0f / 180);
    v.mode = mode;
    v.temperatureLow = 293.15f, v.temperatureHigh = 353.15f;
    return v;
}

struct GoldenFixture : ViewFixture {
    SyntheticParticles particles;
    thawParticleView particleView = particles.view();
    bool update = false, comparable = false;

    GoldenFixture() {
        const char* asked = std::getenv("THAW_UPDATE_GOLDEN");
        update = asked && *asked == '1';
        std::string key;
        std::ifstream file(goldenPath("renderer.txt"));
        std::getline(file, key);
        comparable = key == renderer->rendererString();
        if (update && !comparable) std::ofstream(goldenPath("renderer.txt")) << renderer->rendererString() << "\n";
        if (!update && !comparable)
            MESSAGE("the golden pictures are of \"" << key << "\", this is \"" << renderer->rendererString() << "\"");
    }
    void check(const std::string& name, const view::Scene& scene, const view::View& v) {
        const Image image = draw(scene, v);
        if (update) {
            REQUIRE_MESSAGE(view::writePng(goldenPath(name + ".png"), image, error), error);
            return;
        }
        if (!comparable) return;
        const std::optional<Image> golden = view::readPng(goldenPath(name + ".png"), error);
        REQUIRE_MESSAGE(golden, error);
        const bool same = matches(image, *golden, name, error);
        CHECK_MESSAGE(same, error);
    }
    view::Scene balls(view::ParticleColor color) const {
        view::Scene scene = candle.scene();
        scene.surface = {};
        scene.particles = &particleView, scene.particleColor = color;
        return scene;
    }
};

} // namespace

TEST_CASE_FIXTURE(GoldenFixture, "golden pictures: the surface") {
    check("shaded", candle.scene(), goldenView());
    check("temperature", candle.scene(), goldenView(view::ViewMode::temperature));
    check("phase", candle.scene(), goldenView(view::ViewMode::phase));
    check("liquid", candle.scene(), goldenView(view::ViewMode::liquid));
}

TEST_CASE_FIXTURE(GoldenFixture, "golden pictures: particles") {
    check("particles", balls(view::ParticleColor::temperature), goldenView());
    check("fraction", balls(view::ParticleColor::liquidFraction), goldenView());
    check("level", balls(view::ParticleColor::level), goldenView());
    check("velocity", balls(view::ParticleColor::speed), goldenView());
    view::Scene sizes = balls(view::ParticleColor::values);
    sizes.particleValues = {particles.sizes.data(), "ELFS", "mm", 0, 28, true};
    check("elfs", sizes, goldenView());
}

TEST_CASE_FIXTURE(GoldenFixture, "golden pictures: splats") {
    view::Scene scene = candle.scene();
    const ShapesOf shapes(particleView, SyntheticParticles::kSpacing);
    scene.splats = &particleView, scene.splatShapes = shapes.view(), scene.splatSpacing = SyntheticParticles::kSpacing;
    check("splats", scene, goldenView());
    check("splats_temperature", scene, goldenView(view::ViewMode::temperature));
}

TEST_CASE_FIXTURE(GoldenFixture, "golden pictures: control") {
    view::Scene scene = candle.scene();
    const view::Vec3 points[] = {
        {0, 0.1f, 0.01f}, {0.01f, 0.08f, 0.025f}, {-0.01f, 0.04f, 0.025f}, {0.01f, 0.005f, 0.03f}};
    thawPathDef path;
    thawInitPathDef(&path);
    path.points = points, path.pointCount = 4, path.radius = 0.006f;
    scene.regions = view::pathRegions(path);
    std::vector<view::Vec3> contour;
    for (int i = 0; i < 40; ++i) {
        const float a = 6.2831853f * float(i) / 40, r = 0.034f + 0.006f * std::sin(5 * a);
        contour.push_back({r * std::cos(a), 0.001f, r * std::sin(a)});
    }
    const int32_t size = 40;
    thawShapeDef shape;
    thawInitShapeDef(&shape);
    shape.points = contour.data(), shape.contourSizes = &size, shape.contourCount = 1, shape.reach = 0.012f;
    for (view::Region& r : view::shapeRegions(shape)) scene.regions.push_back(r);
    const view::TriangleMesh ball = view::makeSphere(0.012f, 16);
    thawShapeDef target;
    thawInitShapeDef(&target);
    target.mesh = {ball.positions.data(), ball.positions.size() / 3, ball.indices.data(), ball.indices.size() / 3};
    target.position = {-0.04f, 0.05f, 0};
    for (view::Region& r : view::shapeRegions(target)) scene.regions.push_back(r);
    check("control", scene, goldenView());
}

TEST_CASE("a picture that is not the golden one is left beside where it differs") {
    std::string error;
    const std::string name = "self-check";
    const auto file = [&](const char* kind) { return artefact((name + kind).c_str()); };
    std::filesystem::remove(file(".actual.png")), std::filesystem::remove(file(".difference.png"));
    Image golden(40, 30, {100, 100, 100, 255}), image = golden;
    for (int x = 0; x < 40; ++x) image.at(x, 5).r = 106; // at the tolerance
    image.at(1, 1).g = 200, image.at(2, 1).g = 200;      // 2 of 1200 pixels
    CHECK(matches(image, golden, name, error));
    CHECK_FALSE(std::filesystem::exists(file(".actual.png")));
    image.at(3, 1).g = 200;
    CHECK_FALSE(matches(image, golden, name, error));
    CHECK(error.find(file(".actual.png")) != std::string::npos);
    const std::optional<Image> actual = view::readPng(file(".actual.png"), error);
    REQUIRE_MESSAGE(actual, error);
    CHECK(actual->pixels == image.pixels);
    const std::optional<Image> where = view::readPng(file(".difference.png"), error);
    REQUIRE_MESSAGE(where, error);
    CHECK(where->at(3, 1).r > where->at(3, 1).g + 60);
    CHECK(where->at(20, 20).r == where->at(20, 20).g);
    CHECK_FALSE(matches(Image(8, 8), golden, name, error));
    std::filesystem::remove(file(".actual.png")), std::filesystem::remove(file(".difference.png"));
}
