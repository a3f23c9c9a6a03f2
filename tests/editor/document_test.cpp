// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "hand.h"
#include "model/document.h"

#include <doctest/doctest.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <unistd.h>

using thaw::editor::Document;
namespace scene = thaw::scene;
namespace fs = std::filesystem;

namespace {

std::string contentOf(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

const std::string kCandle = std::string(THAW_SOURCE_DIR) + "/samples/scenes/candle.json";

// Something that random edits do.
void stir(scene::Scene& s, uint32_t dice) {
    switch (dice % 5) {
    case 0:
        s.bodies.push_back({});
        s.bodies.back().name = "box " + std::to_string(dice);
        if (s.materials.empty()) {
            s.materials.push_back({"wax", thawMaterial_wax, {}});
            thawInitMaterialDef(&s.materials.back().def, thawMaterial_wax);
        }
        break;
    case 1:
        if (!s.bodies.empty()) s.bodies.back().placement.position.x += 0.1f;
        break;
    case 2:
        if (s.bodies.size() > 1) s.bodies.erase(s.bodies.begin());
        break;
    case 3:
        s.camera.fieldOfViewDegrees = 20 + float(dice % 50);
        break;
    default:
        s.heatSources.push_back({});
        s.heatSources.back().name = "source " + std::to_string(s.heatSources.size());
        s.heatSources.back().position = {float(dice % 7) * 0.1f, 0, 0};
    }
}

} // namespace

TEST_CASE("document: undo and redo bring back each state, bit for bit") {
    Document d;
    CHECK_FALSE(d.canUndo());
    CHECK_FALSE(d.unsaved());
    std::vector<std::string> states{scene::writeScene(d.scene())};
    uint32_t dice = 1;
    for (int k = 0; k < 200; ++k) {
        dice = dice * 1664525u + 1013904223u;
        const uint64_t before = d.revision();
        const bool changed = d.edit("edit " + std::to_string(k), [&](scene::Scene& s) { stir(s, dice >> 8); });
        CHECK(changed == (d.revision() != before));
        if (changed) {
            states.push_back(scene::writeScene(d.scene()));
            CHECK(d.undoText() == "edit " + std::to_string(k));
        }
    }
    REQUIRE(states.size() > 100);
    for (size_t k = states.size() - 1; k-- > 0;) {
        REQUIRE(d.canUndo());
        d.undo();
        REQUIRE(scene::writeScene(d.scene()) == states[k]);
    }
    CHECK_FALSE(d.canUndo());
    CHECK_FALSE(d.unsaved()); // what it was at first
    for (size_t k = 1; k < states.size(); ++k) {
        d.redo();
        REQUIRE(scene::writeScene(d.scene()) == states[k]);
    }
    CHECK_FALSE(d.canRedo());
    d.undo(), d.undo();
    d.edit("another way", [](scene::Scene& s) { s.name = "another"; });
    CHECK_FALSE(d.canRedo());
    CHECK(d.undoText() == "another way");
}

TEST_CASE("document: a drag is one edit, and one that ends where it began is none") {
    Document d;
    d.open(kCandle);
    const float x = d.scene().bodies[0].placement.position.x;
    const auto drag = [&](float to, const std::string& gesture) {
        return d.edit(
            "Move candle", [&](scene::Scene& s) { s.bodies[0].placement.position.x = to; }, gesture);
    };
    const float there = x + 0.01f * 20.0f;
    for (int k = 1; k <= 20; ++k) CHECK(drag(x + 0.01f * float(k), "move 0"));
    d.undo();
    CHECK(d.scene().bodies[0].placement.position.x == x);
    CHECK_FALSE(d.canUndo());
    d.redo();
    CHECK(d.scene().bodies[0].placement.position.x == there);
    // A second drag is another edit.
    d.endGesture();
    drag(x + 0.3f, "move 0"), drag(x + 0.4f, "move 0");
    d.undo();
    CHECK(d.scene().bodies[0].placement.position.x == there);
    drag(x + 0.5f, "move 1"), drag(there, "move 1");
    CHECK(d.undoText() == "Move candle");
    d.undo();
    CHECK(d.scene().bodies[0].placement.position.x == x);
    CHECK_FALSE(d.canUndo());
    CHECK_FALSE(d.edit("Nothing", [](scene::Scene&) {}));
}

TEST_CASE("document: what would not be read back is not let in") {
    Document d;
    d.open(kCandle);
    const std::string before = scene::writeScene(d.scene());
    const uint64_t revision = d.revision();
    CHECK_THROWS_AS(d.edit("Shrink", [](scene::Scene& s) { s.bodies[0].placement.scale = -1; }), scene::InputError);
    CHECK_THROWS_AS(d.edit("Heat", [](scene::Scene& s) { s.heatSources[0].power = 1e30f; }), scene::InputError);
    CHECK(scene::writeScene(d.scene()) == before);
    CHECK(d.revision() == revision);
    CHECK_FALSE(d.canUndo());
    CHECK_FALSE(d.unsaved());
}

TEST_CASE("document: saved, opened again, and saved elsewhere with the same meshes") {
    Folder folder;
    Document d;
    d.open(kCandle);
    CHECK_FALSE(d.unsaved());
    d.edit("Rename", [](scene::Scene& s) { s.name = "mine"; });
    CHECK(d.unsaved());
    fs::create_directories(folder / "deep/er");
    const std::string path = folder / "deep/er/mine.json";
    d.saveAs(path);
    CHECK_FALSE(d.unsaved());
    CHECK(d.path() == path);
    const auto meshPlace = [](const Document& doc) {
        return fs::canonical(fs::path(doc.scene().directory) / doc.scene().bodies[0].shape.meshFile);
    };
    CHECK(meshPlace(d) == fs::canonical(fs::path(kCandle).parent_path() / "meshes/candle.obj"));
    Document again;
    again.open(path);
    CHECK(scene::writeScene(again.scene()) == scene::writeScene(d.scene()));
    CHECK(meshPlace(again) == meshPlace(d));
    // States of before know where the meshes are now; and the saved one is the saved one.
    d.undo();
    CHECK(d.scene().name == "candle");
    CHECK(meshPlace(d) == meshPlace(again));
    CHECK(d.unsaved());
    d.redo();
    CHECK_FALSE(d.unsaved());
    d.edit("Rename", [](scene::Scene& s) { s.name = "third"; });
    d.undo();
    CHECK_FALSE(d.unsaved());
}

TEST_CASE("document: what cannot be saved leaves the file and the document as they were") {
    Folder folder;
    Document d;
    CHECK_THROWS_AS(d.save(), std::runtime_error); // it has no file
    d.edit("Rename", [](scene::Scene& s) { s.name = "first"; });
    const std::string path = folder / "scene.json";
    d.saveAs(path);
    const std::string first = contentOf(path);
    d.edit("Rename", [](scene::Scene& s) { s.name = "second"; });
    fs::create_directories(folder / "scene.part.json"); // stands where the new file would be written
    CHECK_THROWS_AS(d.save(), std::runtime_error);
    CHECK(contentOf(path) == first);
    CHECK(d.unsaved());
    CHECK(d.scene().name == "second");
    CHECK_THROWS_AS(d.saveAs(folder / "nowhere/scene.json"), std::runtime_error);
    CHECK(d.path() == path);
    fs::remove_all(folder / "scene.part.json");
    d.save();
    CHECK_FALSE(d.unsaved());
    CHECK(contentOf(path) != first);
    CHECK_FALSE(fs::exists(folder / "scene.part.json"));
    // A link stays one.
    fs::create_symlink(path, folder / "link.json");
    d.edit("Rename", [](scene::Scene& s) { s.name = "third"; });
    d.saveAs(folder / "link.json");
    CHECK(fs::is_symlink(folder / "link.json"));
    CHECK(contentOf(path).find("third") != std::string::npos);
}

TEST_CASE("document: a file that cannot be opened leaves the scene as it was") {
    Folder folder;
    Document d;
    d.open(kCandle);
    d.edit("Rename", [](scene::Scene& s) { s.name = "mine"; });
    std::ofstream(folder / "bad.json") << "{\"thawScene\": 1, \"bodies\": [{\"shape\": 3}]}";
    CHECK_THROWS_AS(d.open(folder / "bad.json"), scene::InputError);
    CHECK_THROWS_AS(d.open(folder / "missing.json"), scene::InputError);
    CHECK(d.scene().name == "mine");
    CHECK(d.path() == kCandle);
    CHECK(d.unsaved());
    CHECK(d.canUndo());
    // After a crash: what was saved by itself is back, and is not what the file has.
    const std::string text = scene::writeScene(d.scene()), directory = d.scene().directory;
    Document back;
    back.recover(text, directory, kCandle);
    CHECK(back.scene().name == "mine");
    CHECK(back.unsaved());
    CHECK(back.path() == kCandle);
}

TEST_CASE("document: history keeps to its memory, the newest last") {
    Document d(200'000);
    d.open(kCandle);
    for (int k = 0; k < 500; ++k) d.edit("Rename", [&](scene::Scene& s) { s.name = "name " + std::to_string(k); });
    CHECK(d.historyBytes() <= 200'000);
    int undone = 0;
    for (; d.canUndo(); d.undo()) ++undone;
    CHECK(undone > 20);
    CHECK(d.scene().name == "name " + std::to_string(499 - undone));
    Document tiny(1);
    tiny.edit("Rename", [](scene::Scene& s) { s.name = "a"; });
    tiny.edit("Rename", [](scene::Scene& s) { s.name = "b"; });
    tiny.undo();
    CHECK(tiny.scene().name == "a");
}
