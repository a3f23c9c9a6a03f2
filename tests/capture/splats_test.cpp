// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "pictures.h"
#include "splat_shapes.h"
#include "view/color_map.h"
#include "view_fixture.h"

#include <algorithm>
#include <cmath>

using namespace thaw;
using namespace thaw::test;
using namespace thaw::view;
using view::Image;
using view::Rgba;

namespace {

constexpr float kSpacing = 0.004f;

// Particles that a test makes by hand, with what the surface reads of them.
struct Melt {
    std::vector<float> positions, normals, temperatures, liquids;
    std::vector<uint8_t> materials;

    void add(view::Vec3 p, view::Vec3 n, float kelvin = 300, float liquid = 0, uint8_t material = 0) {
        positions.insert(positions.end(), {p.x, p.y, p.z, 0.5f * kSpacing});
        normals.insert(normals.end(), {n.x, n.y, n.z, length(n) > 0 ? kSpacing * kSpacing : 0});
        temperatures.push_back(kelvin), liquids.push_back(liquid), materials.push_back(material);
    }
    // A ball on a lattice; what is on the right is hot, liquid and of the second material.
    void addBall(view::Vec3 center, float radius) {
        const int n = int(radius / kSpacing) + 1;
        for (int k = -n; k <= n; ++k)
            for (int j = -n; j <= n; ++j)
                for (int i = -n; i <= n; ++i) {
                    const view::Vec3 d = view::Vec3{float(i), float(j), float(k)} * kSpacing;
                    const float r = length(d);
                    if (r > radius) continue;
                    const bool surface = r > radius - kSpacing, right = d.x > 0;
                    add(center + d, surface ? d * (1 / r) : view::Vec3{0, 0, 0}, right ? 340 : 300, right ? 1 : 0,
                        right);
                }
    }
    thawParticleView view() const {
        thawParticleView v{};
        v.count = int32_t(temperatures.size());
        v.positions = positions.data(), v.normals = normals.data();
        v.temperatures = temperatures.data(), v.liquidFractions = liquids.data(), v.materials = materials.data();
        return v;
    }
};

view::Scene ballScene() {
    view::Scene scene;
    scene.materials = {{{0.8f, 0.8f, 0.8f}, 0.0f, 0.6f}, {{0.7f, 0.1f, 0.1f}, 0.0f, 0.6f}};
    scene.splatSpacing = kSpacing;
    scene.stage.add(view::Vec3{-0.05f, 0, -0.05f}), scene.stage.add(view::Vec3{0.05f, 0.08f, 0.05f});
    return scene;
}
view::View ballView() {
    view::View v = ViewFixture::smallView();
    v.legend = false;
    v.camera = {{0, 0.03f, 0.3f}, {0, 0.03f, 0}, {0, 1, 0}, 0.4f};
    return v;
}
constexpr float kRadius = 0.026f;
const view::TriangleMesh& sphere() {
    static const view::TriangleMesh mesh = view::makeSphere(kRadius);
    return mesh;
}
} // namespace

TEST_CASE_FIXTURE(ViewFixture, "a ball of particles in screen space looks like a ball") {
    Melt melt;
    melt.addBall({0, 0.03f, 0}, kRadius);
    const thawParticleView particles = melt.view();
    view::Scene scene = ballScene(), mesh = ballScene();
    const ShapesOf particlesShapes(particles, kSpacing);
    scene.splats = &particles, scene.splatShapes = particlesShapes.view();
    view::MeshInstance ball;
    ball.mesh = std::make_shared<view::TriangleMesh>(sphere());
    ball.position = {0, 0.03f, 0}, ball.color = scene.materials[0].color, ball.roughness = 0.6f;
    mesh.meshes.push_back(ball);
    scene.floor.visible = mesh.floor.visible = false;
    // One colour: form and light are those of the sphere.
    std::fill(melt.materials.begin(), melt.materials.end(), uint8_t(0));
    std::fill(melt.liquids.begin(), melt.liquids.end(), 0.0f);
    view::Scene nothing = scene;
    nothing.splats = nullptr;
    const Image a = draw(scene, ballView()), b = draw(mesh, ballView()), empty = draw(nothing, ballView());
    const view::View v = ballView();
    const double pixels = kRadius / (2 * 0.3 * std::tan(0.2)) * v.height;
    int covered = 0, expected = 0, holes = 0, between = 0;
    double difference = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            const double r = std::hypot(x + 0.5 - a.width / 2.0, y + 0.5 - a.height / 2.0);
            const bool here = a.at(x, y).r > 110 || r<0.5 * pixels, there = b.at(x, y).r> 110 || r < 0.5 * pixels;
            covered += here, expected += there;
            if (r < 0.92 * pixels) {
                difference += std::abs(a.at(x, y).g - b.at(x, y).g);
                holes += a.at(x, y).g < 40 && b.at(x, y).g > 60;
            }
        }
    CHECK(std::abs(covered - expected) < 0.06 * expected);
    CHECK(holes == 0);
    CHECK(difference / (3.14159 * 0.92 * 0.92 * pixels * pixels) < 12);
    // Its outline has steps between: samples count one by one.
    view::View one = v;
    one.samples = 1;
    const Image hard = draw(scene, one);
    int soft = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i)
        between += std::abs(a.pixels[i].g - hard.pixels[i].g) > 20, soft += a.pixels[i].g != hard.pixels[i].g;
    CHECK(between > 40);
    CHECK(soft < 8 * 2 * 3.14159 * pixels);
}

TEST_CASE_FIXTURE(ViewFixture, "splats carry material, temperature and liquid fraction, and throw shadows") {
    Melt melt;
    melt.addBall({0, 0.03f, 0}, kRadius);
    const thawParticleView particles = melt.view();
    view::Scene scene = ballScene();
    const ShapesOf particlesShapes(particles, kSpacing);
    scene.splats = &particles, scene.splatShapes = particlesShapes.view();
    view::View v = ballView();
    const auto sides = [&](view::ViewMode mode) {
        v.mode = mode;
        const Image image = draw(scene, v);
        const Mean left = meanOf(image, 0.44, 0.45, 0.47, 0.55), right = meanOf(image, 0.53, 0.45, 0.56, 0.55);
        return std::pair{left.r / (left.b + 1), right.r / (right.b + 1)};
    };
    v.temperatureLow = 300, v.temperatureHigh = 340;
    for (const view::ViewMode mode :
         {view::ViewMode::shaded, view::ViewMode::temperature, view::ViewMode::liquid, view::ViewMode::phase}) {
        const auto [left, right] = sides(mode);
        CHECK(right > 2.5 * left);
    }
    // On the table, away from the light, it is darker than without the ball; as is its mirror image's place.
    v.mode = view::ViewMode::shaded;
    v.camera.eye.y = 0.12f;
    const Image with = draw(scene, v);
    scene.splats = nullptr;
    const Image without = draw(scene, v);
    CHECK(meanOf(with, 0.60, 0.66, 0.64, 0.70).luminance() < 0.7 * meanOf(without, 0.60, 0.66, 0.64, 0.70).luminance());
    // Both at once: splats go before the mesh.
    view::Scene both = candle.scene();
    Melt far;
    far.add({0, -1, 0}, {0, 1, 0});
    const thawParticleView hidden = far.view();
    const ShapesOf hiddenShapes(hidden, kSpacing);
    both.splats = &hidden, both.splatShapes = hiddenShapes.view();
    CHECK(meanOf(draw(both, smallView()), 0.47, 0.6, 0.53, 0.7).luminance() <
          0.7 * meanOf(draw(candle.scene(), smallView()), 0.47, 0.6, 0.53, 0.7).luminance());
    both.splatSpacing = 0;
    CHECK_FALSE(renderer->capture(both, smallView(), error));
}

TEST_CASE_FIXTURE(ViewFixture, "what is before something else in screen space keeps its edge") {
    Melt melt;
    melt.addBall({0, 0.03f, -0.02f}, kRadius);
    std::fill(melt.materials.begin(), melt.materials.end(), uint8_t(0));
    const size_t behind = melt.materials.size();
    melt.addBall({0, 0.03f, 0.05f}, 2.3f * kSpacing);
    std::fill(melt.materials.begin() + std::ptrdiff_t(behind), melt.materials.end(), uint8_t(1));
    std::fill(melt.liquids.begin(), melt.liquids.end(), 0.0f);
    const thawParticleView particles = melt.view();
    view::Scene scene = ballScene();
    const ShapesOf particlesShapes(particles, kSpacing);
    scene.splats = &particles, scene.splatShapes = particlesShapes.view();
    const Image image = draw(scene, ballView());
    // From red to grey within three pixels, at the radius of the small ball.
    const double pixels = 2.5 * kSpacing / (2 * 0.25 * std::tan(0.2)) * image.height;
    const auto redness = [&](double r) {
        const Rgba p = image.at(int(image.width / 2 - r), image.height / 2);
        return double(p.r) / (p.g + 1);
    };
    CHECK(redness(pixels - 3) > 2);
    CHECK(redness(pixels + 4) < 1.4);
}

TEST_CASE_FIXTURE(ViewFixture, "a single drop on a wall stays in front of it") {
    Melt melt;
    melt.add({0, 0.03f, 0.5f * kSpacing}, {0, 0, 1}, 300, 0, 1);
    const thawParticleView particles = melt.view();
    view::Scene scene = ballScene();
    const ShapesOf particlesShapes(particles, kSpacing);
    scene.splats = &particles, scene.splatShapes = particlesShapes.view();
    view::MeshInstance wall;
    wall.mesh = std::make_shared<view::TriangleMesh>(view::makeBox({0.04f, 0.03f, 0.01f}));
    wall.position = {0, 0.03f, -0.01f}, wall.color = {0.5f, 0.5f, 0.5f};
    scene.meshes.push_back(wall);
    const Image image = draw(scene, ballView());
    // It shows nearly all of the disc of a ball of its volume.
    int red = 0;
    for (const Rgba& p : image.pixels) red += p.r > 2 * p.g;
    const double pixels = 0.62 * kSpacing / (2 * 0.3 * std::tan(0.2)) * image.height;
    CHECK(red > 0.5 * 3.14159 * pixels * pixels);
    CHECK(red < 1.3 * 3.14159 * pixels * pixels);
}
