// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Properties of pictures that hold on every renderer.

#include "pictures.h"
#include "view/color_map.h"
#include "view_fixture.h"

#include <algorithm>
#include <cmath>

using namespace thaw;
using namespace thaw::test;
using namespace thaw::view;
using view::Image;
using view::Rgba;

TEST_CASE_FIXTURE(ViewFixture, "a shaded candle stands out, covers its share and throws a shadow") {
    const Image image = draw(candle.scene(), smallView());
    // Wax is much brighter than backdrop and table here; the silhouette follows from the camera.
    int bright = 0;
    int left = image.width, right = -1;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const Rgba p = image.at(x, y);
            if (p.r > 140) {
                ++bright;
                left = std::min(left, x), right = std::max(right, x);
            }
        }
    const double coverage = double(bright) / (image.width * image.height);
    CHECK(coverage > 0.05);
    CHECK(coverage < 0.13);
    CHECK(left > image.width / 4);
    CHECK(right < image.width * 3 / 4);
    // The key light comes from the left: the table is darker on the right, close to the foot.
    const Mean lit = meanOf(image, 0.30, 0.86, 0.36, 0.90), shadow = meanOf(image, 0.62, 0.86, 0.68, 0.90);
    CHECK(shadow.luminance() < 0.7 * lit.luminance());
    // The flame is warm and nearly white in its middle.
    const Mean flame = meanOf(image, 0.494, 0.22, 0.506, 0.26);
    CHECK(flame.r > 220);
    CHECK(flame.r > flame.b);
}

TEST_CASE_FIXTURE(ViewFixture, "a ball shades the table where it touches it") {
    view::Scene scene;
    view::MeshInstance ball;
    ball.mesh = std::make_shared<view::TriangleMesh>(view::makeSphere(0.03f));
    ball.position = {0, 0.03f, 0};
    ball.color = {0.5f, 0.5f, 0.5f};
    scene.meshes.push_back(ball);
    // Light from behind the eye, so that its shadow falls away from us and only the contact is left in front.
    scene.key.direction = {0, 0.7f, 1};
    view::View v = smallView();
    v.camera = {{0, 0.06f, 0.30f}, {0, 0.03f, 0}, {0, 1, 0}, 0.4f};
    const Image image = draw(scene, v);
    // Beside the place where it touches, against the same row further off.
    const double contact = meanOf(image, 0.39, 0.70, 0.41, 0.72).luminance();
    const double open = meanOf(image, 0.22, 0.70, 0.26, 0.72).luminance();
    CHECK(contact < 0.75 * open);
    // Also where there is no key light that could throw a shadow: less of the room is seen from there.
    const float intensity = scene.key.intensity;
    scene.key.intensity = 0;
    const float reflectivity = scene.floor.reflectivity;
    scene.floor.reflectivity = 0;
    const Image dim = draw(scene, v);
    scene.meshes.front().position.y = 0.12f;
    const Image lifted = draw(scene, v);
    scene.meshes.front().position.y = 0.03f;
    CHECK(meanOf(dim, 0.47, 0.765, 0.53, 0.78).luminance() < 0.8 * meanOf(lifted, 0.47, 0.765, 0.53, 0.78).luminance());
    scene.floor.reflectivity = reflectivity;
    scene.key.intensity = intensity;
    // The lit side of the ball faces us, the one behind it is in its shadow.
    const Mean lit = meanOf(image, 0.48, 0.40, 0.52, 0.46);
    scene.key.direction = {0, 0.7f, -1};
    const Image behind = draw(scene, v);
    CHECK(meanOf(behind, 0.48, 0.40, 0.52, 0.46).luminance() < 0.75 * lit.luminance());
    const double shadow = meanOf(behind, 0.49, 0.86, 0.51, 0.90).luminance();
    CHECK(shadow < 0.6 * meanOf(image, 0.49, 0.86, 0.51, 0.90).luminance());
}

TEST_CASE_FIXTURE(ViewFixture, "the flame lights the wax from inside, most at the top") {
    view::Scene burning = candle.scene(), out = burning;
    out.glows.clear();
    const Image a = draw(burning, smallView()), b = draw(out, smallView());
    const Mean topLit = meanOf(a, 0.51, 0.37, 0.55, 0.41), topDark = meanOf(b, 0.51, 0.37, 0.55, 0.41);
    const Mean lowLit = meanOf(a, 0.51, 0.75, 0.55, 0.80), lowDark = meanOf(b, 0.51, 0.75, 0.55, 0.80);
    CHECK(topLit.luminance() > topDark.luminance() + 15);
    CHECK(topLit.luminance() - topDark.luminance() > 2 * (lowLit.luminance() - lowDark.luminance()));
    // What comes through is warmer than the key light's wax.
    CHECK((topLit.r - topDark.r) > (topLit.b - topDark.b));
    // An opaque material keeps it out.
    burning.materials[0].translucency = 0;
    const Mean opaque = meanOf(draw(burning, smallView()), 0.51, 0.37, 0.55, 0.41);
    CHECK(opaque.luminance() < topLit.luminance() - 10);
}

TEST_CASE_FIXTURE(ViewFixture, "temperature view: hot is redder, the scale is there and stays put") {
    view::View v = smallView(view::ViewMode::temperature);
    v.temperatureLow = 295, v.temperatureHigh = 345;
    const Image image = draw(candle.scene(), v);
    const Mean hot = meanOf(image, 0.49, 0.345, 0.51, 0.36), cold = meanOf(image, 0.47, 0.72, 0.53, 0.80);
    CHECK(hot.r > cold.r + 60);
    CHECK(hot.r / (hot.b + 1) > 2 * cold.r / (cold.b + 1));
    CHECK(cold.b > cold.r + 40);
    // Without the scale only the corner differs; in it are the ends of the colour ramp.
    v.legend = false;
    const Image plain = draw(candle.scene(), v);
    int changedOutside = 0;
    bool blueEnd = false, hotEnd = false;
    const Vec3 ends[2] = {view::heatColor(0.02f), view::heatColor(0.98f)};
    const auto close = [](Rgba p, thawVec3 c) {
        return std::abs(p.r - view::encodeSrgb(c.x)) < 12 && std::abs(p.g - view::encodeSrgb(c.y)) < 12 &&
               std::abs(p.b - view::encodeSrgb(c.z)) < 12;
    };
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const bool corner = x > image.width * 0.7 && y < image.height * 0.85;
            if (!corner && !(image.at(x, y) == plain.at(x, y))) ++changedOutside;
            if (corner && close(image.at(x, y), ends[0])) blueEnd = true;
            if (corner && close(image.at(x, y), ends[1])) hotEnd = true;
        }
    CHECK(changedOutside == 0);
    CHECK(blueEnd);
    CHECK(hotEnd);
    CHECK(meanOf(image, 0.9, 0.05, 0.97, 0.3).luminance() != meanOf(plain, 0.9, 0.05, 0.97, 0.3).luminance());
}

TEST_CASE_FIXTURE(ViewFixture, "phase view: solid below, liquid in the pool") {
    view::View v = smallView(view::ViewMode::phase);
    v.camera.eye = v.camera.target + Vec3{0.08f, 0.22f, 0.16f};
    const Image image = draw(candle.scene(), v);
    int solid = 0, liquid = 0, mushy = 0, lowestLiquid = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width * 7 / 10; ++x) {
            const Rgba p = image.at(x, y);
            if (p.b > p.r + 30) ++solid;
            if (p.r > p.g + 70 && p.r > p.b + 60) ++liquid, lowestLiquid = std::max(lowestLiquid, y);
            if (p.r > p.b + 60 && p.g > p.b + 40) ++mushy;
        }
    CHECK(solid > 2000);
    CHECK(liquid > 100);
    CHECK(mushy > 100);
    CHECK(lowestLiquid < image.height / 2);
}

TEST_CASE_FIXTURE(ViewFixture, "particles are balls in the colours of their values") {
    const std::vector<float> spheres{-0.03f, 0.03f, 0, 0.02f, 0.03f, 0.03f, 0, 0.02f};
    const std::vector<float> velocities{0, 0, 0, 1, 0, 2.0f, 0, 1}, kelvin{300, 340}, liquid{1, 0};
    thawParticleView particles{};
    particles.count = 2;
    particles.positions = spheres.data();
    particles.velocities = velocities.data();
    particles.temperatures = kelvin.data();
    particles.liquidFractions = liquid.data();
    view::Scene scene;
    scene.particles = &particles;
    view::View v = smallView();
    v.legend = false;
    v.camera = {{0, 0.03f, 0.3f}, {0, 0.03f, 0}, {0, 1, 0}, 0.4f};
    const auto redness = [&](view::ParticleColor color, bool rightOne) {
        scene.particleColor = color;
        const double x = rightOne ? 0.64 : 0.36;
        const Mean m = meanOf(draw(scene, v), x - 0.02, 0.46, x + 0.02, 0.54);
        return m.r / (m.b + 1);
    };
    CHECK(redness(view::ParticleColor::temperature, true) > 3 * redness(view::ParticleColor::temperature, false));
    CHECK(redness(view::ParticleColor::speed, true) > 3 * redness(view::ParticleColor::speed, false));
    CHECK(redness(view::ParticleColor::liquidFraction, false) > 3 * redness(view::ParticleColor::liquidFraction, true));
    // Levels have their own colours, thin things are red.
    const std::vector<uint8_t> levels{0, 3};
    const std::vector<float> sizes{0.001f, 0.01f};
    particles.levels = levels.data();
    scene.particleValues = {sizes.data(), "size", "m", 0, 0, true};
    CHECK(redness(view::ParticleColor::level, true) > 3 * redness(view::ParticleColor::level, false));
    CHECK(redness(view::ParticleColor::values, false) > 3 * redness(view::ParticleColor::values, true));
    scene.particleValues.high = 0.1f; // both are thin then
    CHECK(redness(view::ParticleColor::values, true) > 0.5 * redness(view::ParticleColor::values, false));
    // The key of the levels has a row more or less lit by what it counts.
    v.legend = true, scene.particleColor = view::ParticleColor::level;
    const Image counted = draw(scene, v);
    scene.levelCounts = {1, 20, 300, 4000};
    const Image told = draw(scene, v);
    CHECK(counted.pixels != told.pixels);
    CHECK(meanOf(counted, 0.0, 0.0, 0.6, 1.0).luminance() == meanOf(told, 0.0, 0.0, 0.6, 1.0).luminance());
    v.legend = false;
    // A ball of radius 0.02 at 0.3 m in a picture 0.1216 m high there covers a known area.
    scene.floor.visible = false;
    scene.particleColor = view::ParticleColor::temperature;
    const Image image = draw(scene, v);
    int covered = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = image.width / 2; x < image.width; ++x)
            if (image.at(x, y).r > image.at(x, y).b + 60) ++covered;
    const double radiusPixels = 0.02 / (2 * 0.3 * std::tan(0.2)) * image.height;
    CHECK(covered == doctest::Approx(3.14159 * radiusPixels * radiusPixels).epsilon(0.12));
}

TEST_CASE_FIXTURE(ViewFixture, "liquid view: the fraction is a scale, not three steps") {
    view::View v = smallView(view::ViewMode::liquid);
    v.camera.eye = v.camera.target + Vec3{0.08f, 0.22f, 0.16f};
    const SyntheticCandle whole = candle;
    const auto top = [&](float fraction) {
        std::fill(candle.liquidFractions.begin(), candle.liquidFractions.end(), fraction);
        return meanOf(draw(candle.scene(), v), 0.48, 0.45, 0.52, 0.5);
    };
    double last = -1;
    for (const float fraction : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
        const double luminance = top(fraction).luminance();
        CHECK_MESSAGE(luminance > last + 8, fraction);
        last = luminance;
    }
    candle = whole;
    v.legend = false;
    const Image plain = draw(candle.scene(), v);
    v.legend = true;
    CHECK(plain.pixels != draw(candle.scene(), v).pixels);
}

TEST_CASE_FIXTURE(ViewFixture, "paths and shapes lie over the picture, fainter behind things, with a key") {
    view::Scene scene = candle.scene();
    view::View v = smallView();
    const Image plain = draw(scene, v);
    // Two tubes across the candle, before it and behind it.
    const auto bluer = [&](float z, double x) {
        const Vec3 points[2] = {{-0.06f, 0.05f, z}, {0.06f, 0.05f, z}};
        thawPathDef def;
        thawInitPathDef(&def);
        def.points = points, def.pointCount = 2, def.radius = 0.004f;
        scene.regions = view::pathRegions(def, {0, 0, 0}, {0, 0, 0, 1});
        scene.regions.pop_back(); // without its arrows
        v.camera = {{0, 0.05f, 0.4f}, {0, 0.05f, 0}, {0, 1, 0}, 0.4f};
        std::vector<view::Region> regions;
        std::swap(regions, scene.regions);
        const Mean without = meanOf(draw(scene, v), x - 0.01, 0.49, x + 0.01, 0.51);
        std::swap(regions, scene.regions);
        const Mean with = meanOf(draw(scene, v), x - 0.01, 0.49, x + 0.01, 0.51);
        return (with.b - with.r) - (without.b - without.r);
    };
    const double before = bluer(0.04f, 0.5), behind = bluer(-0.04f, 0.5), beside = bluer(-0.04f, 0.37);
    CHECK(before > 25);
    CHECK(beside > 25);
    CHECK(behind > 4);
    CHECK(behind < 0.5 * before);
    v.legend = false;
    const Image bare = draw(scene, v);
    v.legend = true;
    const Image keyed = draw(scene, v);
    CHECK(meanOf(bare, 0.85, 0, 1, 0.1).luminance() != meanOf(keyed, 0.85, 0, 1, 0.1).luminance());
    scene.regions.front().mesh = nullptr;
    CHECK_FALSE(renderer->capture(scene, v, error));
    // What was drawn leaves nothing behind.
    CHECK(draw(candle.scene(), smallView()).pixels == plain.pixels);
}

TEST_CASE_FIXTURE(ViewFixture, "one sees through what is clear, the less the thicker it is, and not through the rest") {
    const view::TriangleMesh slab = view::makeBox({0.03f, 0.03f, 0.01f});
    const std::vector<float> liquid(slab.positions.size() / 3, 1);
    view::Scene scene;
    scene.floor.visible = false;
    scene.surface.vertexCount = int32_t(slab.positions.size() / 3);
    scene.surface.triangleCount = int32_t(slab.indices.size() / 3);
    scene.surface.positions = slab.positions.data(), scene.surface.normals = slab.normals.data();
    scene.surface.indices = slab.indices.data();
    scene.stage.add(Vec3{-0.05f, -0.05f, -0.05f}), scene.stage.add(Vec3{0.05f, 0.05f, 0.05f});
    view::MeshInstance ball;
    ball.mesh = std::make_shared<view::TriangleMesh>(view::makeSphere(0.02f));
    ball.position = {0, 0, -0.05f}, ball.color = {0.6f, 0.01f, 0.01f};
    scene.meshes.push_back(ball);
    view::View v = smallView();
    v.camera = {{0, 0, 0.3f}, {0, 0, 0}, {0, 1, 0}, 0.4f};
    const auto redness = [&](float clear, float meltClear) {
        scene.materials = {{{0.7f, 0.7f, 0.7f}, 0, 0.4f, clear, meltClear}};
        const Image image = draw(scene, v);
        const Mean middle = meanOf(image, 0.48, 0.46, 0.52, 0.54);
        return middle.r - middle.b;
    };
    const double none = redness(0, 0), little = redness(0.02f, 0), much = redness(1, 0);
    CHECK(std::abs(none) < 12);
    CHECK(little > none + 8);
    CHECK(much > little + 20);
    // Of melt its own counts.
    CHECK(redness(0, 1) == none);
    scene.surface.liquidFractions = liquid.data();
    CHECK(redness(0, 1) > little);
    CHECK(std::abs(redness(1, 0)) < 12);
    // In a data view nothing is clear.
    v.mode = view::ViewMode::liquid;
    scene.materials[0].meltClearDepth = 0;
    const Image opaque = draw(scene, v);
    scene.materials[0].meltClearDepth = 1;
    CHECK(opaque.pixels == draw(scene, v).pixels);
}

TEST_CASE_FIXTURE(ViewFixture, "a crease between sides of one colour has no stairs") {
    view::Scene scene;
    scene.floor.visible = false;
    view::MeshInstance box;
    box.mesh = std::make_shared<view::TriangleMesh>(view::makeBox({0.03f, 0.03f, 0.03f}));
    box.color = {0.5f, 0.5f, 0.5f}, box.roughness = 1;
    scene.meshes.push_back(box);
    scene.key.direction = {-1, 0.2f, 0.1f};
    // One edge stands in the middle, leaning.
    view::View v = smallView();
    v.camera = {{0.2f, 0, 0.2f}, {0, 0, 0}, {0.1f, 1, -0.1f}, 0.15f};
    const Image smooth = draw(scene, v);
    v.samples = 1;
    const Image hard = draw(scene, v);
    int between = 0;
    for (int y = smooth.height / 4; y < smooth.height * 3 / 4; ++y)
        for (int x = smooth.width * 2 / 5; x < smooth.width * 3 / 5; ++x)
            between += std::abs(smooth.at(x, y).g - hard.at(x, y).g) > 4;
    CHECK(between > 40);
}

TEST_CASE_FIXTURE(ViewFixture, "the same scene gives the same bytes, whatever was drawn between") {
    const Image first = draw(candle.scene(), smallView());
    view::View other = smallView(view::ViewMode::temperature);
    other.width = 200, other.height = 200;
    draw(candle.scene(), other);
    view::Scene empty;
    draw(empty, smallView());
    const Image again = draw(candle.scene(), smallView());
    CHECK(first.pixels == again.pixels);
    std::unique_ptr<view::Renderer> second = view::Renderer::create(error);
    REQUIRE_MESSAGE(second, error);
    const std::optional<Image> fresh = second->capture(candle.scene(), smallView(), error);
    REQUIRE_MESSAGE(fresh, error);
    CHECK(first.pixels == fresh->pixels);
}

TEST_CASE_FIXTURE(ViewFixture, "two contexts live side by side and one outlives the other") {
    const Image before = draw(candle.scene(), smallView());
    {
        std::unique_ptr<view::HeadlessContext> other = view::HeadlessContext::create(error);
        REQUIRE_MESSAGE(other, error);
        std::unique_ptr<view::Renderer> there = view::Renderer::create(error);
        REQUIRE_MESSAGE(there, error);
        const std::optional<Image> image = there->capture(candle.scene(), smallView(), error);
        REQUIRE_MESSAGE(image, error);
        CHECK(image->pixels == before.pixels);
    }
    REQUIRE(context->makeCurrent());
    CHECK(draw(candle.scene(), smallView()).pixels == before.pixels);
}

TEST_CASE_FIXTURE(ViewFixture, "what cannot be drawn is refused with the reason") {
    view::View v = smallView();
    const auto refused = [&](const view::Scene& scene, const view::View& bad, const char* word) {
        error.clear();
        CHECK_FALSE(renderer->capture(scene, bad, error));
        CHECK_MESSAGE(error.find(word) != std::string::npos, error);
    };
    v.width = 8;
    refused(candle.scene(), v, "width");
    v = smallView();
    v.camera.target = v.camera.eye;
    refused(candle.scene(), v, "eye");
    v = smallView();
    v.camera.up = v.camera.target - v.camera.eye;
    refused(candle.scene(), v, "up");
    view::Scene scene = candle.scene();
    std::vector<uint32_t> wrong = candle.indices;
    wrong[7] = static_cast<uint32_t>(candle.positions.size());
    scene.surface.indices = wrong.data();
    refused(scene, smallView(), "index");
    scene = candle.scene();
    scene.meshes.front().mesh = nullptr;
    refused(scene, smallView(), "mesh");
    // And it still draws.
    CHECK(draw(candle.scene(), smallView()).width == 320);
}
