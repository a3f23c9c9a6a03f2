// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "model/changes.h"
#include "model/items.h"
#include "model/stroke.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace thaw::editor;
namespace scene = thaw::scene;

namespace {

scene::Scene candle() { return scene::loadScene(std::string(THAW_SOURCE_DIR) + "/samples/scenes/candle_path.json"); }

float far(thawVec3 a, thawVec3 b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

} // namespace

TEST_CASE("items: what is moved, turned and resized is where it should be, whatever it is") {
    scene::Scene s = candle();
    thawShapeDef def;
    thawInitShapeDef(&def);
    s.colliders[1].placement.position = {0.1f, 0.2f, 0.3f};
    s.colliders[1].placement.rotation = scene::quatFromDegrees(20, 30, 40);
    const Item contour = addShape(s, {{0, 0, 0}, {0.1f, 0, 0}, {0.1f, 0, 0.1f}}, 1);
    for (const Item item : {Item{Kind::body, 0}, Item{Kind::collider, 1}, Item{Kind::source, 0}, Item{Kind::path, 0},
                            contour, Item{Kind::prop, 0}}) {
        CAPTURE(kindName(item.kind));
        const thawVec3 was = pivotOf(s, item);
        move(s, item, {0.01f, -0.02f, 0.03f});
        CHECK(far(pivotOf(s, item), {was.x + 0.01f, was.y - 0.02f, was.z + 0.03f}) < 1e-6f);
        // A quarter about y through the origin: x goes to -z.
        const thawVec3 before = pivotOf(s, item);
        turn(s, item, {0, 0, 0}, scene::quatFromDegrees(0, 90, 0));
        CHECK(far(pivotOf(s, item), {before.z, before.y, -before.x}) < 1e-6f);
        const thawVec3 then = pivotOf(s, item);
        resize(s, item, {0, 0, 0}, 2);
        CHECK(far(pivotOf(s, item), {2 * then.x, 2 * then.y, 2 * then.z}) < 1e-6f);
    }
    CHECK(s.bodies[0].placement.scale == 2);
    // It is a scene all the same.
    CHECK_NOTHROW(scene::parseScene(scene::writeScene(s), "", s.directory));
}

TEST_CASE("items: what refers to something that is deleted, or to what comes after it, refers to the right thing") {
    scene::Scene s = candle();
    addMaterial(s, thawMaterial_ice);
    addMaterial(s, thawMaterial_butter);
    s.bodies.push_back(s.bodies[0]), s.bodies[1].material = 2;
    s.paths[0].collider = 1;
    s.colliders[1].placement.position = {0.1f, 0, 0};
    const thawVec3 first = toWorld(s, 1, s.paths[0].points[0]);
    erase(s, {Kind::material, 0});
    CHECK(s.bodies[0].material == 0);
    CHECK(s.materials[size_t(s.bodies[1].material)].preset == thawMaterial_butter);
    erase(s, {Kind::collider, 0});
    CHECK(s.paths[0].collider == 0);
    erase(s, {Kind::collider, 0});
    CHECK(s.paths[0].collider == -1);
    CHECK(far(s.paths[0].points[0], first) < 1e-6f);
    erase(s, {Kind::material, 0});
    CHECK_THROWS_AS(erase(s, {Kind::material, 0}), scene::InputError);
    CHECK(s.materials.size() == 1);
}

TEST_CASE("items: copies and new things have names of their own") {
    scene::Scene s = candle();
    const Item copy = duplicate(s, {Kind::body, 0});
    CHECK(titleOf(s, copy) == "candle 2");
    CHECK(titleOf(s, duplicate(s, copy)) == "candle 3");
    CHECK(titleOf(s, addMaterial(s, thawMaterial_wax)) == "wax");
    CHECK(titleOf(s, addMaterial(s, thawMaterial_wax)) == "wax 2");
    for (int type = 0; type < 5; ++type) addSource(s, thawHeatSourceType(type), {0, 0.1f, 0});
    for (int type = 1; type < 6; ++type) {
        scene::Shape shape;
        shape.type = scene::ShapeType(type);
        addBody(s, shape, {}), addCollider(s, shape, {}), addProp(s, shape, {});
    }
    // All of them are as a scene may have them.
    const scene::Scene back = scene::parseScene(scene::writeScene(s), "", s.directory);
    CHECK(back.bodies.size() == 8);
    CHECK(back.heatSources.size() == 6);
}

TEST_CASE("changes: what an edit changed is found, and only that") {
    const scene::Scene a = candle();
    CHECK_FALSE(changesBetween(a, a).any());
    SUBCASE("looks need no other world") {
        scene::Scene b = a;
        b.camera.eye.x += 1, b.name = "other", b.colliders[0].color = {1, 0, 0}, b.bodies[0].name = "wax";
        b.heatSources[0].visual = scene::SourceVisual::glow, b.props.clear(), b.defaults.seconds = 3;
        CHECK_FALSE(changesBetween(a, b).any());
    }
    SUBCASE("one of each kind") {
        scene::Scene b = a;
        b.heatSources[0].power += 1;
        b.paths[0].def.radius *= 2;
        b.colliders[0].friction = 0.1f, b.colliders[1].placement.position.y += 0.01f;
        b.materials[0].def.viscosityLiquid *= 2;
        b.world.gravity.y = -1;
        const Changes c = changesBetween(a, b);
        CHECK(c.any());
        CHECK(c.world);
        CHECK_FALSE(c.capacity);
        CHECK(c.heatSources[0].changed);
        CHECK(c.paths[0].changed);
        CHECK(c.colliders[0].surface);
        CHECK_FALSE(c.colliders[0].moved);
        CHECK_FALSE(c.colliders[0].changed);
        CHECK(c.colliders[1].moved);
        CHECK_FALSE(c.colliders[1].surface);
        CHECK(c.materials[0].changed);
        CHECK_FALSE(c.bodies[0].changed);
    }
    SUBCASE("what is added or deleted in the middle leaves the rest") {
        scene::Scene b = a;
        for (int i = 0; i < 3; ++i) addSource(b, thawHeatSource_point, {0, float(i), 0});
        scene::Scene c = b;
        erase(c, {Kind::source, 1});
        const Changes gone = changesBetween(b, c);
        REQUIRE(gone.heatSources.size() == 3);
        CHECK(gone.any());
        for (int i = 0; i < 3; ++i) {
            CHECK(gone.heatSources[size_t(i)].was == (i == 0 ? 0 : i + 1));
            CHECK_FALSE(gone.heatSources[size_t(i)].changed);
        }
        const Changes back = changesBetween(c, b);
        CHECK(back.heatSources[1].was == -1);
        CHECK(back.heatSources[2].was == 1);
    }
    SUBCASE("a material that is renamed or follows one that is deleted makes no new body") {
        scene::Scene b = a;
        b.materials[0].name = "other wax";
        CHECK_FALSE(changesBetween(a, b).bodies[0].changed);
        scene::Scene first = a;
        first.materials.insert(first.materials.begin(), first.materials[0]);
        first.materials[0].name = "unused", first.bodies[0].material = 1;
        CHECK_FALSE(changesBetween(first, a).bodies[0].changed);
        addMaterial(first, thawMaterial_ice);
        scene::Scene other = first;
        other.bodies[0].material = 2;
        CHECK(changesBetween(first, other).bodies[0].changed);
    }
    SUBCASE("paint that is added goes onto the body that is there") {
        scene::Scene b = a;
        scene::Paint dab;
        dab.temperature = 400;
        b.bodies[0].paint = {dab, dab};
        const Changes c = changesBetween(a, b);
        CHECK_FALSE(c.bodies[0].changed);
        CHECK(c.bodies[0].paintFrom == 0);
        CHECK(c.any());
        CHECK(changesBetween(b, a).bodies[0].changed);
        scene::Scene more = b;
        more.bodies[0].paint.push_back(dab);
        CHECK(changesBetween(b, more).bodies[0].paintFrom == 2);
        more.bodies[0].paint[0].temperature = 300;
        CHECK(changesBetween(b, more).bodies[0].changed);
    }
}

TEST_CASE("strokes: even, smooth, and as long as they were drawn") {
    std::vector<thawVec3> circle;
    for (int i = 0; i < 57; ++i) {
        const float a = 2 * 3.14159265f * float(i) / 57;
        circle.push_back({std::cos(a), 0, std::sin(a)});
    }
    const std::vector<thawVec3> even = resampled(circle, 0.1f, true);
    CHECK(even.size() == 63);
    for (size_t i = 0; i < even.size(); ++i)
        CHECK(far(even[i], even[(i + 1) % even.size()]) == doctest::Approx(lengthOf(even, true) / 63).epsilon(0.01));
    // Passes take out a jag, and do not shrink the circle.
    std::vector<thawVec3> jagged = even;
    for (size_t i = 0; i < jagged.size(); i += 2) jagged[i].x *= 1.05f, jagged[i].z *= 1.05f;
    const std::vector<thawVec3> smooth = smoothed(jagged, 10, true);
    float least = 2, most = 0;
    for (const thawVec3& p : smooth) {
        least = std::min(least, std::hypot(p.x, p.z));
        most = std::max(most, std::hypot(p.x, p.z));
    }
    CHECK(most - least < 0.3f * 0.05f);
    CHECK(least > 1.0f);
    // Ends of an open line stay, whatever is done to it.
    const std::vector<thawVec3> line{{0, 0, 0}, {1, 0.3f, 0}, {2, -0.1f, 0}, {3, 0, 0}};
    CHECK(far(smoothed(line, 20, false).front(), line.front()) == 0);
    CHECK(far(resampled(line, 0.11f, false).back(), line.back()) == 0);
    CHECK(nearestOn(line, {0.5f, 0.15f, 0.2f}, false).distance == doctest::Approx(0.2f));
    CHECK(nearestOn(line, {0.5f, 0.15f, 0}, false).segment == 0);
}

TEST_CASE("strokes: what is erased is gone, and only that") {
    const std::vector<thawVec3> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
    const auto middle = cutOut(line, {1.5f, 0.3f, 0}, 0.5f);
    REQUIRE(middle.size() == 2);
    CHECK(far(middle[0].back(), {1.1f, 0, 0}) < 1e-6f);
    CHECK(far(middle[1].front(), {1.9f, 0, 0}) < 1e-6f);
    CHECK(middle[0].size() == 3);
    CHECK(middle[1].size() == 3);
    const auto end = cutOut(line, {3, 0, 0}, 1.25f);
    REQUIRE(end.size() == 1);
    CHECK(far(end[0].back(), {1.75f, 0, 0}) < 1e-6f);
    CHECK(cutOut(line, {1.5f, 0, 0}, 5).empty());
    REQUIRE(cutOut(line, {1.5f, 2, 0}, 1).size() == 1);
    CHECK(cutOut(line, {1.5f, 2, 0}, 1)[0].size() == 4);
}
