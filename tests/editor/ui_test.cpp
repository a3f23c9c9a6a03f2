// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "hand.h"

#include "player/scene.h"

#include <GLFW/glfw3.h>
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <iterator>

using namespace thaw::editor;
namespace scene = thaw::scene;

namespace {

const std::string kScenes = std::string(THAW_SOURCE_DIR) + "/samples/scenes/";

/// Draws down the side of the candle that is seen, in the shape of an S.
void drawS(Hand& hand) {
    const auto side = [&](float x, float y) { return hand.at(thawVec3{x, y, 0.017f}); };
    hand.move(side(0, 0.105f));
    hand.press();
    for (int i = 0; i <= 24; ++i) {
        const float u = float(i) / 24;
        hand.move(side(0.009f * std::sin(6.283f * u), 0.105f - 0.08f * u));
    }
    hand.release();
    hand.frame(2);
}

} // namespace

TEST_CASE("ui: a path is drawn with the mouse, taken back, done again, saved and read back the same") {
    const Folder folder;
    Hand hand(folder);
    hand.app().drop(kScenes + "candle.json");
    REQUIRE(hand.settle());
    hand.click("tool Path");
    CHECK(hand.studio().tool == Tool::path);
    drawS(hand);
    REQUIRE(hand.studio().scene().paths.size() == 1);
    const std::vector<thawVec3> points = hand.studio().scene().paths[0].points;
    CHECK(points.size() >= 6);
    // It lies on the candle's side: 17 mm from its axis, which is a little bent.
    for (const thawVec3& p : points) {
        CHECK(std::hypot(p.x, p.z) == doctest::Approx(0.017).epsilon(0.25));
        CHECK(p.z > 0);
    }
    CHECK(points.front().y > points.back().y + 0.06f);
    CHECK(hand.studio().selection() == Item{Kind::path, 0});

    hand.key(GLFW_KEY_Z, true);
    CHECK(hand.studio().scene().paths.empty());
    hand.key(GLFW_KEY_Y, true);
    REQUIRE(hand.studio().scene().paths.size() == 1);
    CHECK(hand.studio().document().unsaved());
    const std::string text = scene::writeScene(hand.studio().scene());
    REQUIRE(hand.studio().saveAs(folder / "s.json"));
    CHECK_FALSE(hand.studio().document().unsaved());
    const std::string saved = scene::writeScene(hand.studio().scene());
    REQUIRE(hand.studio().open(folder / "s.json"));
    CHECK(scene::writeScene(hand.studio().scene()) == saved);
    CHECK(text.size() > 100);
}

TEST_CASE("ui: heat is placed before a surface, the scene plays, and what is drawn is followed") {
    const Folder folder;
    Hand hand(folder);
    hand.app().drop(kScenes + "candle.json");
    REQUIRE(hand.settle());
    hand.studio().edit("no flame", [](scene::Scene& s) { s.heatSources.clear(); });
    hand.click("tool Path");
    drawS(hand);
    hand.click("tool Heat");
    const thawVec3 top{0, 0.1f, 0.018f};
    hand.click(hand.at(top));
    REQUIRE(hand.studio().scene().heatSources.size() == 1);
    const scene::HeatSource h = hand.studio().scene().heatSources[0];
    // In front of the side that was clicked, ten spacings off.
    CHECK(h.position.z == doctest::Approx(0.018 + 10 * 0.00235).epsilon(0.25));
    CHECK(hand.studio().selection() == Item{Kind::source, 0});
    // A hotter one: what takes minutes is to be seen in seconds.
    hand.studio().edit("hot", [](scene::Scene& s) { s.heatSources[0].power = 1500; });
    hand.studio().edit("lock", [](scene::Scene& s) { s.paths[0].def.strength = 1, s.paths[0].def.reach = 0.05f; });
    REQUIRE(hand.settle());
    for (int i = 0; i < 300; ++i) ++hand.studio().orders().steps;
    REQUIRE(hand.wait([&] { return hand.studio().frame().frame == 300; }));
    CHECK(hand.studio().frame().counters.meltedFraction > 0.01f);
    REQUIRE(hand.studio().frame().paths.size() == 1);
    const thawPathState path = hand.studio().frame().paths[0];
    CHECK(path.captured > 0.5e-3f);
    // Within the reach that was asked for; without the path what has melted runs down all around.
    CHECK(path.meanDistance < 0.02f);

    // Back to the start it is all wax again.
    hand.click("Reset");
    REQUIRE(hand.settle());
    CHECK(hand.studio().frame().frame == 0);
    CHECK(hand.studio().frame().counters.meltedFraction == 0);
}

TEST_CASE("ui: what is chosen is moved by its handle, in one step of undo") {
    const Folder folder;
    Hand hand(folder);
    hand.app().drop(kScenes + "ice.json");
    REQUIRE(hand.settle());
    hand.click("tool Move");
    hand.click("item " + titleOf(hand.studio().scene(), {Kind::body, 0}));
    REQUIRE(hand.studio().selection() == Item{Kind::body, 0});
    const thawVec3 was = pivotOf(hand.studio().scene(), {Kind::body, 0});
    const std::string undo = hand.studio().document().undoText();
    const Hand::Point from = hand.at(was);
    // The tip of the arrow that points up is some 80 pixels above.
    hand.drag({from.x, from.y - 60}, {from.x, from.y - 110});
    const thawVec3 is = pivotOf(hand.studio().scene(), {Kind::body, 0});
    CHECK(is.y > was.y + 0.005f);
    CHECK(is.x == was.x);
    CHECK(is.z == was.z);
    hand.key(GLFW_KEY_Z, true);
    CHECK(pivotOf(hand.studio().scene(), {Kind::body, 0}).y == was.y);
    CHECK(hand.studio().document().undoText() == undo);
}

TEST_CASE("ui: closing with unsaved changes asks, and nothing is lost whatever the answer") {
    const Folder folder;
    {
        Hand hand(folder);
        hand.app().drop(kScenes + "ice.json");
        REQUIRE(hand.settle());
        REQUIRE(hand.studio().saveAs(folder / "ice.json"));
        hand.studio().edit("hotter", [](scene::Scene& s) { s.world.ambientTemperature = 300; });
        hand.app().close();
        hand.frame(3);
        CHECK_FALSE(hand.app().closed());
        REQUIRE(hand.sees("keep editing"));
        hand.click("keep editing");
        CHECK_FALSE(hand.app().closed());
        CHECK(hand.studio().document().unsaved());
        hand.app().close();
        hand.frame(3);
        hand.click("save first");
        hand.frame(3);
        CHECK(hand.app().closed());
        CHECK(scene::loadScene(folder / "ice.json").world.ambientTemperature == 300);
    }
    {
        Hand hand(folder);
        CHECK(hand.studio().settings.recent.front() == folder / "ice.json");
        hand.app().drop(folder / "ice.json");
        REQUIRE(hand.settle());
        hand.studio().edit("colder", [](scene::Scene& s) { s.world.ambientTemperature = 280; });
        hand.app().close();
        hand.frame(3);
        hand.click("discard");
        hand.frame(2);
        CHECK(hand.app().closed());
        CHECK(scene::loadScene(folder / "ice.json").world.ambientTemperature == 300);
    }
}

TEST_CASE("ui: a mesh that is dropped is added in its unit, standing on the floor") {
    const Folder folder;
    Hand hand(folder);
    hand.studio().edit("spacing", [](scene::Scene& s) { s.world.particleSpacing = 0.004f; });
    hand.app().drop(kScenes + "meshes/bunny.obj");
    REQUIRE(hand.wait([&] { return hand.sees("accept import"); }));
    hand.click("accept import");
    REQUIRE(hand.settle());
    REQUIRE(hand.studio().scene().bodies.size() == 1);
    CHECK(hand.studio().frame().error == "");
    CHECK(hand.studio().frame().bodies[0].particles > 1000);
    // Particles are half a spacing inside.
    CHECK(std::fabs(hand.studio().frame().bodies[0].lower.y - 0.002f) < 0.001f);
    // Saved elsewhere, the file of the mesh is found from there.
    REQUIRE(hand.studio().saveAs(folder / "bunny.json"));
    CHECK_NOTHROW(scene::loadMeshes(scene::loadScene(folder / "bunny.json")));
}

TEST_CASE("ui: what cannot be read or written is said in a window, with the reason") {
    const Folder folder;
    Hand hand(folder);
    const auto complains = [&](const char* of) {
        hand.frame(3);
        REQUIRE(hand.studio().complaints.size() == 1);
        CHECK(hand.studio().complaints[0].text.find(of) != std::string::npos);
        REQUIRE(hand.sees("close message"));
        hand.click("close message");
        CHECK(hand.studio().complaints.empty());
    };
    std::ofstream(folder / "broken.json") << "{\"thawScene\": 1, \"bodies\": 7}";
    hand.app().drop(folder / "broken.json");
    complains("/bodies");
    hand.app().drop(folder / "missing.json");
    complains("missing.json");
    hand.app().drop(folder / "song.mp3");
    complains("song.mp3");
    std::ofstream(folder / "broken.obj") << "not a mesh";
    hand.app().drop(folder / "broken.obj");
    REQUIRE(hand.wait([&] { return !hand.studio().complaints.empty(); }));
    complains("broken.obj");
    CHECK_FALSE(hand.studio().saveAs(folder / "nowhere/s.json"));
    complains("nowhere/s.json");
    // A mesh that is gone: the scene opens, the reason is shown, and it can be edited.
    std::ofstream(folder / "gone.json") << R"({"thawScene": 1, "bodies": [{"mesh": "gone.obj", "material": "wax"}]})";
    REQUIRE(hand.studio().open(folder / "gone.json"));
    REQUIRE(hand.settle());
    CHECK(hand.studio().frame().error.find("gone.obj") != std::string::npos);
    hand.studio().select({Kind::body, 0});
    hand.studio().removeSelection();
    REQUIRE(hand.settle());
    CHECK(hand.studio().frame().error == "");
}

TEST_CASE("ui: nodes of a path are moved, inserted and deleted, and what is erased is cut out") {
    const Folder folder;
    Hand hand(folder);
    hand.app().drop(kScenes + "candle.json");
    REQUIRE(hand.settle());
    hand.click("tool Path");
    drawS(hand);
    const auto path = [&]() -> const scene::Path& { return hand.studio().scene().paths[0]; };
    REQUIRE(hand.studio().scene().paths.size() == 1);
    const std::vector<thawVec3> drawn = path().points;
    const size_t middle = drawn.size() / 2;
    // Down the side by 5 mm; it stays on the surface, and the others where they are.
    const Hand::Point from = hand.at(drawn[middle]);
    hand.drag(from, {from.x + 10, from.y + 14});
    REQUIRE(path().points.size() == drawn.size());
    CHECK(path().points[middle].y < drawn[middle].y - 0.001f);
    CHECK(std::hypot(path().points[middle].x, path().points[middle].z) == doctest::Approx(0.017).epsilon(0.25));
    CHECK(path().points[middle + 1].y == drawn[middle + 1].y);
    hand.key(GLFW_KEY_Z, true);
    CHECK(path().points[middle].y == drawn[middle].y);

    const thawVec3 a = drawn[1], b = drawn[2];
    hand.clickTwice(hand.at(thawVec3{(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2}));
    REQUIRE(path().points.size() == drawn.size() + 1);
    CHECK(path().points[2].y < a.y);
    CHECK(path().points[2].y > b.y);
    hand.key(GLFW_KEY_DELETE);
    CHECK(path().points.size() == drawn.size());
    CHECK(path().points[2].y == b.y);

    hand.studio().tools.brushRadius = 0.006f;
    hand.click("tool Erase");
    hand.click(hand.at(drawn[middle]));
    REQUIRE(hand.studio().scene().paths.size() == 2);
    CHECK(path().points.back().y > drawn[middle].y);
    CHECK(hand.studio().scene().paths[1].points.front().y < drawn[middle].y);
    CHECK(hand.studio().scene().paths[1].name != path().name);
    hand.key(GLFW_KEY_Z, true);
    CHECK(hand.studio().scene().paths.size() == 1);
}

TEST_CASE("ui: a shape is drawn on a surface, and one inside of it is its hole") {
    const Folder folder;
    Hand hand(folder);
    hand.app().drop(kScenes + "ice.json");
    REQUIRE(hand.settle());
    hand.app().viewport().lens.lookLike({{0, 0.5f, 0.25f}, {0, 0, 0}, {0, 1, 0}, 0.6f});
    hand.studio().edit("a bare table", [](scene::Scene& s) { s.bodies.clear(); });
    REQUIRE(hand.settle());
    const auto ring = [&](float radius) {
        const auto on = [&](int i) {
            const float a = 0.2618f * float(i);
            return hand.at(thawVec3{radius * std::cos(a), 0, radius * std::sin(a)});
        };
        hand.move(on(0));
        hand.press();
        for (int i = 1; i < 24; ++i) hand.move(on(i));
        hand.release();
        hand.frame(2);
    };
    hand.click("tool Shape");
    ring(0.08f);
    REQUIRE(hand.studio().scene().shapes.size() == 1);
    REQUIRE(hand.studio().scene().shapes[0].contours.size() == 1);
    for (const thawVec3& p : hand.studio().scene().shapes[0].contours[0]) {
        CHECK(std::hypot(p.x, p.z) == doctest::Approx(0.08).epsilon(0.05));
        CHECK(std::fabs(p.y) < 0.001f);
    }
    ring(0.03f);
    REQUIRE(hand.studio().scene().shapes.size() == 1);
    CHECK(hand.studio().scene().shapes[0].contours.size() == 2);
    REQUIRE(hand.settle());
    // The library has it as a disc with a hole.
    REQUIRE(hand.studio().frame().shapes.size() == 1);
    CHECK(hand.studio().frame().shapes[0].size == doctest::Approx(3.14159 * (0.0064 - 0.0009)).epsilon(0.08));
    // With nothing chosen it is another shape.
    hand.studio().select({});
    ring(0.05f);
    CHECK(hand.studio().scene().shapes.size() == 2);
}

TEST_CASE("ui: paint heats what the brush touches, and a particle says all that it knows") {
    const Folder folder;
    Hand hand(folder);
    hand.app().drop(kScenes + "candle.json");
    REQUIRE(hand.settle());
    hand.click("tool Warmth");
    hand.studio().tools.paintTemperature = 380, hand.studio().tools.brushRadius = 0.008f;
    const Hand::Point top = hand.at(thawVec3{0, 0.1f, 0.018f}), low = hand.at(thawVec3{0, 0.06f, 0.018f});
    hand.drag(top, low, 12);
    const size_t dabs = hand.studio().scene().bodies[0].paint.size();
    CHECK(dabs >= 4);
    REQUIRE(hand.settle());
    CHECK(hand.studio().frame().counters.maxTemperature == doctest::Approx(380).epsilon(0.01));
    CHECK(hand.studio().frame().counters.meltedFraction > 0.005f);
    hand.click("tool Soot");
    hand.drag(top, low, 12);
    CHECK(hand.studio().scene().bodies[0].paint.size() > dabs);
    CHECK(hand.studio().scene().bodies[0].paint.back().absorptivity == 1);
    hand.click("tool Probe");
    REQUIRE(hand.wait([&] { return hand.studio().frame().particles.view().count > 0; }));
    hand.click(top);
    REQUIRE(hand.studio().hasPickedParticle);
    const thawParticleView all = hand.studio().frame().particles.view();
    bool found = false;
    for (int i = 0; i < all.count; ++i)
        if (all.ids[i] == hand.studio().pickedParticle) {
            found = true;
            CHECK(all.positions[4 * size_t(i) + 1] == doctest::Approx(0.1).epsilon(0.05));
            CHECK(all.positions[4 * size_t(i) + 2] > 0.01f);
        }
    CHECK(found);
    // Each stroke is one step.
    hand.key(GLFW_KEY_Z, true);
    CHECK(hand.studio().scene().bodies[0].paint.size() == dabs);
    hand.key(GLFW_KEY_Z, true);
    CHECK(hand.studio().scene().bodies[0].paint.empty());
    REQUIRE(hand.settle());
    CHECK(hand.studio().frame().counters.meltedFraction == 0);
}

TEST_CASE("ui: an export writes numbered pictures and meshes of the run, the same each time") {
    const Folder folder;
    Hand hand(folder, 800, 500);
    hand.app().drop(kScenes + "ice.json");
    REQUIRE(hand.settle());
    const auto run = [&](const char* name) {
        ExportSettings settings;
        settings.folder = folder / name;
        settings.meshes = true, settings.every = 10, settings.seconds = 0.5f;
        settings.width = 160, settings.height = 90;
        REQUIRE(hand.app().exporter().begin(hand.studio(), settings) == "");
        CHECK(hand.wait([&] { return !hand.app().exporter().running(); }));
        CHECK(hand.studio().complaints.empty());
    };
    const auto content = [&](const std::string& file) {
        std::ifstream in(folder / file, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(in), {});
    };
    run("a"), run("b");
    for (const char* file : {"picture_00000.png", "picture_00030.png", "mesh_00000.ply", "mesh_00030.ply"}) {
        CAPTURE(file);
        CHECK(content("a/" + std::string(file)).size() > 500);
        CHECK(content("a/" + std::string(file)) == content("b/" + std::string(file)));
    }
    CHECK(content("a/mesh_00000.ply") != content("a/mesh_00030.ply"));
    CHECK_FALSE(std::filesystem::exists(folder / "a/mesh_00040.ply"));
}
