// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "hand.h"

#include "player/scene.h"

#include <GLFW/glfw3.h>
#include <doctest/doctest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <random>

// A hand that knows nothing, for THAW_RANDOM_SECONDS (3), from THAW_RANDOM_SEED (1). With THAW_RANDOM_TRACE set it says
// what it does before it does it.

using namespace thaw::editor;
namespace scene = thaw::scene;

namespace {

// 500 particles: a step and a picture take little, so that much can happen.
constexpr const char* kScene = R"({
  "thawScene": 1,
  "name": "toy",
  "world": {"particleSpacing": 0.004, "thermalTimeScale": 30},
  "materials": [{"name": "wax", "preset": "wax"}],
  "bodies": [
    {"name": "block", "shape": {"type": "box", "size": [0.03, 0.03, 0.03]}, "position": [0, 0.015, 0], "material": "wax"},
    {"name": "cube", "mesh": "cube.obj", "position": [0.04, 0.01, 0], "material": "wax"}
  ],
  "colliders": [
    {"name": "table", "shape": {"type": "plane"}},
    {"name": "post", "shape": {"type": "cylinder", "radius": 0.005, "height": 0.04}, "position": [-0.03, 0.02, 0]}
  ],
  "heatSources": [{"name": "flame", "position": [0, 0.05, 0], "power": 300, "radius": 0.003}],
  "paths": [{"name": "way", "points": [[0, 0.03, 0.016], [0, 0.015, 0.016], [0.01, 0.002, 0.03]], "radius": 0.006}],
  "shapes": [{"name": "pool", "contours": [[[0.02, 0, 0.02], [0.05, 0, 0.02], [0.05, 0, 0.05], [0.02, 0, 0.05]]]}],
  "camera": {"eye": [0.06, 0.1, 0.2], "target": [0, 0.02, 0], "fieldOfViewDegrees": 30}
})";
constexpr const char* kCube = "v -0.01 -0.01 -0.01\nv 0.01 -0.01 -0.01\nv 0.01 0.01 -0.01\nv -0.01 0.01 -0.01\n"
                              "v -0.01 -0.01 0.01\nv 0.01 -0.01 0.01\nv 0.01 0.01 0.01\nv -0.01 0.01 0.01\n"
                              "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

double setting(const char* name, double usual) {
    const char* set = std::getenv(name);
    return set ? std::atof(set) : usual;
}

class Monkey {
public:
    Monkey(const Folder& folder, uint32_t seed) : folder_(folder), random_(seed) {
        begin();
        hand_->app().drop(folder_ / "toy.json");
        hand_->frame(2);
        remember();
    }

    void act();
    Hand& hand() { return *hand_; }
    /// Of the scene that is open, as it was when it was opened or begun.
    const std::string& first() const { return first_; }
    std::string story() const {
        std::string out;
        for (const std::string& s : done_) out += s + "\n";
        return out;
    }
    int acts = 0, starts = 0, edits = 0;

private:
    void begin() {
        hand_.reset(); // before another one: ImGui's context is one
        hand_ = std::make_unique<Hand>(folder_, 700, 460);
        number_ = 0, ++starts;
    }
    void remember() {
        if (number_ == hand_->studio().sceneNumber()) return;
        number_ = hand_->studio().sceneNumber();
        first_ = scene::writeScene(hand_->studio().scene());
    }
    void say(const std::string& what) {
        done_.push_back(what);
        if (done_.size() > 25) done_.pop_front();
        if (std::getenv("THAW_RANDOM_TRACE")) std::fprintf(stderr, "%d %s\n", acts, what.c_str());
    }
    int below(int n) { return int(random_() % uint32_t(n)); }
    Hand::Point anywhere() { return {float(below(hand_->width())), float(below(hand_->height()))}; }
    /// Leaves out what leads to files that are not the test's.
    bool allowed(const std::string& control) const { return control != "Up"; }
    bool choosesFiles() { return hand_->sees("file name") || hand_->sees("export folder"); }
    std::string someControl(bool picture);
    Hand::Point in(const std::string& control) {
        const Controls::Place& p = hand_->app().controls().all().at(control);
        return {p.x + p.width * float(below(100)) / 100, p.y + p.height * float(below(100)) / 100};
    }
    Hand::Point notForbidden(Hand::Point p) {
        const auto up = hand_->app().controls().all().find("Up");
        if (up == hand_->app().controls().all().end()) return p;
        const Controls::Place& r = up->second;
        return p.x >= r.x && p.y >= r.y && p.x < r.x + r.width && p.y < r.y + r.height ? Hand::Point{1, 1} : p;
    }

    const Folder& folder_;
    std::mt19937 random_;
    std::unique_ptr<Hand> hand_;
    std::deque<std::string> done_;
    uint64_t number_ = 0;
    std::string first_;
};

std::string Monkey::someControl(bool picture) {
    const auto& all = hand_->app().controls().all();
    if (picture && all.count("viewport") && below(2)) return "viewport";
    std::vector<std::string> names;
    for (const auto& [name, place] : all)
        if (allowed(name)) names.push_back(name);
    return names.empty() ? std::string() : names[size_t(below(int(names.size())))];
}

void Monkey::act() {
    static constexpr int keys[] = {GLFW_KEY_Q,      GLFW_KEY_W,      GLFW_KEY_E,         GLFW_KEY_R,
                                   GLFW_KEY_P,      GLFW_KEY_O,      GLFW_KEY_H,         GLFW_KEY_C,
                                   GLFW_KEY_T,      GLFW_KEY_A,      GLFW_KEY_X,         GLFW_KEY_I,
                                   GLFW_KEY_F,      GLFW_KEY_V,      GLFW_KEY_SPACE,     GLFW_KEY_RIGHT,
                                   GLFW_KEY_LEFT,   GLFW_KEY_HOME,   GLFW_KEY_ENTER,     GLFW_KEY_SLASH,
                                   GLFW_KEY_TAB,    GLFW_KEY_UP,     GLFW_KEY_DOWN,      GLFW_KEY_LEFT_BRACKET,
                                   GLFW_KEY_DELETE, GLFW_KEY_ESCAPE, GLFW_KEY_BACKSPACE, GLFW_KEY_RIGHT_BRACKET};
    static constexpr int commands[] = {GLFW_KEY_Z, GLFW_KEY_Z, GLFW_KEY_Z, GLFW_KEY_Y, GLFW_KEY_Y,
                                       GLFW_KEY_D, GLFW_KEY_D, GLFW_KEY_N, GLFW_KEY_O, GLFW_KEY_S,
                                       GLFW_KEY_Q, GLFW_KEY_I, GLFW_KEY_E, GLFW_KEY_A};
    int what = below(100);
    const uint64_t revision = hand_->studio().document().revision();
    // A window that asks something takes all input: not for long.
    if (ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel) && below(3) == 0) {
        say("escape");
        hand_->key(GLFW_KEY_ESCAPE);
        what = 100;
    } else if (what < 28) {
        const std::string control = someControl(false);
        if (control.empty()) return hand_->frame();
        const Hand::Point at = in(control);
        say("click " + control);
        hand_->click(at, below(12) ? 0 : 1);
    } else if (what < 32) {
        const Hand::Point at = notForbidden(anywhere());
        say("click anywhere");
        hand_->click(at, below(3));
    } else if (what < 36) {
        const std::string control = someControl(true);
        if (control.empty()) return hand_->frame();
        const Hand::Point at = in(control);
        say("double click " + control);
        hand_->clickTwice(at);
    } else if (what < 62) {
        const std::string from = someControl(true);
        if (from.empty()) return hand_->frame();
        const Hand::Point a = in(from), b = from == "viewport" ? in(from) : anywhere();
        say("drag " + from);
        hand_->drag(a, b, 2 + below(5), below(4) ? 0 : below(3));
    } else if (what < 66) {
        say("wheel");
        hand_->move(anywhere());
        hand_->wheel(float(below(7) - 3), below(3) == 0);
    } else if (what < 82) {
        const int key = keys[below(int(std::size(keys)))];
        say("key " + std::to_string(key));
        // In a name for files: nothing that takes it out of the folder.
        if (!choosesFiles() || key == GLFW_KEY_ENTER || key == GLFW_KEY_ESCAPE) hand_->key(key, false, below(4) == 0);
    } else if (what < 91) {
        const int key = commands[below(int(std::size(commands)))];
        say("ctrl " + std::to_string(key));
        if (!choosesFiles()) hand_->key(key, true, below(5) == 0);
    } else if (what < 97) {
        static constexpr const char* texts[] = {"0",    "1",   "-1", "0.01", "1e9", "nan",
                                                "12.5", "wax", "-",  "1e-9", "a b", "\"\\"};
        const std::string text = choosesFiles() ? std::string("name") + char('a' + below(4)) : texts[below(12)];
        say("type " + text);
        hand_->type(text);
        if (below(2)) hand_->key(GLFW_KEY_ENTER);
    } else if (what < 100) {
        say("resize");
        hand_->resize(320 + below(600), 240 + below(360));
        hand_->frame(2);
    }
    ++acts;
    if (hand_->studio().document().revision() != revision) ++edits;
    remember();
    if (hand_->app().closed()) {
        say("again");
        begin();
        hand_->app().drop(folder_ / "toy.json");
        hand_->frame(2);
        remember();
    }
}

} // namespace

TEST_CASE("random: whatever is pressed and dragged, the scene stays one, and undo and redo lead back and forth") {
    const Folder folder;
    std::ofstream(folder / "toy.json") << kScene;
    std::ofstream(folder / "cube.obj") << kCube;
    // Names without a folder stay in this one.
    const std::filesystem::path was = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    const uint32_t seed = uint32_t(setting("THAW_RANDOM_SEED", 1));
    const double seconds = setting("THAW_RANDOM_SECONDS", 3);
    {
        MESSAGE("seed " << seed);
        Monkey monkey(folder, seed);
        const double end = now() + seconds;
        while (now() < end) monkey.act();
        MESSAGE(monkey.acts << " acts, " << monkey.edits << " edits, " << monkey.starts << " starts");
        INFO("seed " << seed << ", the last acts:\n" << monkey.story());
        Hand& hand = monkey.hand();
        Studio& studio = hand.studio();
        studio.endGesture();
        CHECK(monkey.acts > 5);

        const std::string text = scene::writeScene(studio.scene());
        REQUIRE_NOTHROW(scene::parseScene(text, "again", studio.scene().directory));
        CHECK(scene::writeScene(scene::parseScene(text, "again", studio.scene().directory)) == text);

        while (studio.document().canRedo()) studio.redo();
        const std::string last = scene::writeScene(studio.scene());
        while (studio.document().canUndo()) studio.undo();
        CHECK(scene::writeScene(studio.scene()) == monkey.first());
        while (studio.document().canRedo()) studio.redo();
        CHECK(scene::writeScene(studio.scene()) == last);

        // The simulation follows: it shows the scene, or says why it cannot.
        REQUIRE(hand.settle());
        CHECK((studio.frame().built || !studio.frame().error.empty()));
        while (studio.document().canUndo()) studio.undo();
        studio.reset();
        REQUIRE(hand.settle());
        CHECK(studio.frame().error == "");
        CHECK(studio.frame().built);
    }
    std::filesystem::current_path(was);
}
