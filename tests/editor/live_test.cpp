// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "hand.h"
#include "model/autosave.h"
#include "model/history.h"
#include "model/live_world.h"
#include "model/mailbox.h"
#include "model/pick.h"
#include "model/presets.h"
#include "model/reference.h"
#include "model/simulation.h"

#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>

using namespace thaw::editor;
namespace scene = thaw::scene;

namespace {

using ScenePtr = std::shared_ptr<const scene::Scene>;

/// Two blocks of wax on a floor, one of them hot, under a lamp.
scene::Scene blocks() {
    return scene::parseScene(R"({
        "thawScene": 1,
        "world": {"particleSpacing": 0.004, "thermalTimeScale": 20},
        "materials": [{"name": "wax", "preset": "wax"}, {"name": "ice", "preset": "ice"}],
        "bodies": [
            {"name": "a", "shape": {"type": "box", "size": [0.04, 0.03, 0.04]}, "position": [0, 0.015, 0], "material": "wax",
             "temperature": 345},
            {"name": "b", "shape": {"type": "box", "size": [0.03, 0.03, 0.03]}, "position": [0.08, 0.015, 0], "material": "wax"}],
        "colliders": [{"name": "floor", "shape": {"type": "plane"}},
                      {"name": "post", "shape": {"type": "box", "size": [0.01, 0.05, 0.01]}, "position": [0.04, 0.025, 0]}],
        "heatSources": [{"name": "lamp", "position": [0, 0.1, 0], "power": 300}],
        "paths": [{"name": "p", "points": [[0.02, 0, 0.02], [0.06, 0, 0.06]], "collider": "floor"}]})",
                             "blocks", ".");
}

thawBudget work() {
    thawBudget b;
    thawInitBudget(&b);
    return b;
}

struct Live {
    MeshStore store;
    LiveWorld world{1};
    scene::Scene scene = blocks();

    Live() { build(); }
    void build() {
        auto s = std::make_shared<const scene::Scene>(scene);
        world.build(s, store.load(*s));
    }
    bool follow(bool driven = false) {
        auto s = std::make_shared<const scene::Scene>(scene);
        return world.follow(s, store.load(*s), driven);
    }
    void steps(int n) {
        for (int i = 0; i < n; ++i) CHECK((world.step(work()) & thawStep_refused) == 0);
    }
    thawCounters counters() const {
        thawCounters c;
        thawWorld_GetCounters(world.world(), &c);
        return c;
    }
    uint64_t hash() const { return thawWorld_GetStateHash(world.world()); }
};

} // namespace

TEST_CASE("mailbox: the newest arrives whole, in order, and nobody waits") {
    struct Letter {
        std::array<uint64_t, 64> words{};
    };
    Mailbox<Letter> box;
    constexpr uint64_t kLetters = 200000;
    std::thread writer([&] {
        for (uint64_t i = 1; i <= kLetters; ++i) {
            box.writing().words.fill(i);
            box.send();
        }
    });
    uint64_t last = 0, torn = 0, back = 0;
    while (last < kLetters) {
        if (!box.take()) continue;
        const Letter& letter = box.reading();
        for (const uint64_t w : letter.words) torn += w != letter.words[0];
        back += letter.words[0] <= last;
        last = letter.words[0];
    }
    writer.join();
    CHECK(torn == 0);
    CHECK(back == 0);
    CHECK_FALSE(box.take());
    CHECK(box.taken());
}

TEST_CASE("live world: with room for edits it runs as a scene that was loaded") {
    Live live;
    const scene::Scene s = blocks();
    const scene::SceneWorld plain = scene::buildWorld(s, scene::loadMeshes(s), 1);
    CHECK(live.hash() == thawWorld_GetStateHash(plain.world.get()));
    live.steps(40);
    const thawBudget b = work();
    for (int i = 0; i < 40; ++i) thawWorld_Step(plain.world.get(), 1.0f / 60, &b);
    CHECK(live.hash() == thawWorld_GetStateHash(plain.world.get()));
}

TEST_CASE("live world: each kind of edit gets in while it runs") {
    Live live;
    live.steps(20);
    const thawCounters before = live.counters();

    SUBCASE("what is added and deleted") {
        addSource(live.scene, thawHeatSource_sphere, {0, 0.2f, 0});
        addBody(live.scene, live.scene.bodies[1].shape, {0.16f, 0.015f, 0});
        addCollider(live.scene, live.scene.colliders[1].shape, {0.3f, 0.025f, 0});
        addShape(live.scene, {{0.1f, 0, 0.1f}, {0.15f, 0, 0.1f}, {0.15f, 0, 0.15f}}, -1);
        CHECK(live.follow());
        const thawCounters more = live.counters();
        CHECK(more.heatSources == 2);
        CHECK(more.bodies == 3);
        CHECK(more.colliders == 3);
        CHECK(more.shapes == 1);
        CHECK(more.particles > before.particles + 300);
        live.steps(5);
        erase(live.scene, {Kind::body, 1});
        erase(live.scene, {Kind::source, 0});
        erase(live.scene, {Kind::collider, 0});
        CHECK(live.follow());
        const thawCounters less = live.counters();
        CHECK(less.bodies == 2);
        CHECK(less.heatSources == 1);
        CHECK(less.colliders == 2);
        // Its path stays, in the world.
        CHECK(less.paths == 1);
        // The hot one goes on melting: it is not a new one.
        thawBodyState first;
        REQUIRE(thawBody_GetState(live.world.world(), live.world.ids().bodies[0], &first) == thawResult_ok);
        CHECK(first.meltedFraction > 0);
        live.steps(5);
    }
    SUBCASE("a body that is moved comes anew where it shall be, the others stay") {
        thawBodyState a;
        REQUIRE(thawBody_GetState(live.world.world(), live.world.ids().bodies[0], &a) == thawResult_ok);
        live.scene.bodies[1].placement.position.y = 0.1f;
        CHECK(live.follow());
        thawBodyState b, still;
        REQUIRE(thawBody_GetState(live.world.world(), live.world.ids().bodies[1], &b) == thawResult_ok);
        REQUIRE(thawBody_GetState(live.world.world(), live.world.ids().bodies[0], &still) == thawResult_ok);
        CHECK(b.center.y == doctest::Approx(0.1).epsilon(0.01));
        CHECK(still.center.y == a.center.y);
        CHECK(still.meltedFraction == a.meltedFraction);
        // The lattice of a body that is placed elsewhere differs by a few.
        CHECK(live.counters().particles == doctest::Approx(before.particles).epsilon(0.02));
    }
    SUBCASE("a collider that is dragged goes there as a hand would, one that is placed jumps") {
        live.scene.colliders[1].placement.position.z = 0.1f;
        CHECK(live.follow(true));
        CHECK(live.world.placementOf(1).position.z == 0);
        live.steps(1);
        const float first = live.world.placementOf(1).position.z;
        CHECK(first > 0);
        CHECK(first <= 0.0101f);
        live.steps(15);
        CHECK(live.world.placementOf(1).position.z == doctest::Approx(0.1));
        live.scene.colliders[1].placement.position.z = -0.1f;
        CHECK(live.follow(false));
        CHECK(live.world.placementOf(1).position.z == doctest::Approx(-0.1));
    }
    SUBCASE("paint goes onto what is there") {
        scene::Paint dab;
        dab.brush = {{0.08f, 0.03f, 0}, 0.01f, 0};
        dab.temperature = 400;
        live.scene.bodies[1].paint = {dab};
        CHECK(live.follow());
        CHECK(live.counters().maxTemperature > 390);
        const double painted = [&] {
            thawLedger l;
            thawWorld_GetLedger(live.world.world(), &l);
            return l.painted;
        }();
        CHECK(painted > 0);
        // The same dab is not painted again with the next edit.
        live.scene.world.convection = 11;
        CHECK(live.follow());
        thawLedger l;
        thawWorld_GetLedger(live.world.world(), &l);
        CHECK(l.painted == painted);
    }
    SUBCASE("a collider of another form takes its paths along") {
        live.scene.paths[0].collider = 1;
        CHECK(live.follow());
        live.scene.colliders[1].shape.size.x = 0.02f;
        CHECK(live.follow());
        CHECK(live.counters().paths == 1);
        CHECK(live.counters().colliders == 2);
        thawPathState state;
        CHECK(thawPath_GetState(live.world.world(), live.world.ids().paths[0], &state) == thawResult_ok);
    }
    SUBCASE("material, world, surface and heat of colliders") {
        live.scene.materials[0].def.viscosityLiquid = 50;
        live.scene.world.gravity = {0, 0, 0};
        live.scene.colliders[0].temperature = 500, live.scene.colliders[0].friction = 0;
        CHECK(live.follow());
        live.steps(5);
        thawLedger l;
        thawWorld_GetLedger(live.world.world(), &l);
        CHECK(l.contact > 0);
    }
    SUBCASE("another spacing needs another world") {
        live.scene.world.particleSpacing = 0.005f;
        const uint64_t hash = live.hash();
        CHECK_FALSE(live.follow());
        CHECK(live.hash() == hash);
    }
    SUBCASE("what does not fit is refused, the rest gets in, and what was there goes on") {
        scene::Shape huge;
        huge.size = {1, 1, 1};
        addBody(live.scene, huge, {5, 0, 0});
        addSource(live.scene, thawHeatSource_point, {0, 1, 0});
        CHECK_THROWS_AS(live.follow(), scene::InputError);
        CHECK(live.counters().bodies == 2);
        CHECK(live.counters().heatSources == 2);
        live.steps(2);
        // Made smaller it fits.
        live.scene.bodies[2].shape.size = {0.03f, 0.03f, 0.03f};
        CHECK(live.follow());
        CHECK(live.counters().bodies == 3);
    }
}

TEST_CASE("history: any frame comes back with the same bits, through edits, and as far as memory allows") {
    for (const size_t limit : {size_t{256} << 20, size_t{2} << 20}) {
        CAPTURE(limit);
        Live live;
        History history(limit);
        history.begin(live.world);
        std::vector<uint64_t> hashes{live.hash()};
        thawBudget budget = work();
        for (int64_t frame = 1; frame <= 90; ++frame) {
            if (frame == 25) live.scene.heatSources[0].power = 900, live.follow();
            if (frame == 41) erase(live.scene, {Kind::body, 1}), live.follow();
            if (frame == 55) addBody(live.scene, live.scene.bodies[0].shape, {0, 0.2f, 0}), live.follow();
            if (frame == 67) live.scene.colliders[1].placement.position.x = 0.1f, live.follow(true);
            live.world.step(budget);
            thawPlan plan;
            thawWorld_GetPlan(live.world.world(), &plan);
            history.add(frame, {plan.work, live.world.scene(), frame >= 67}, live.world);
            hashes.push_back(live.hash());
        }
        CHECK(history.newest() == 90);
        CHECK(history.bytes() <= std::max(limit, size_t{3} << 20));
        for (const int64_t to :
             {int64_t{89}, int64_t{3}, int64_t{60}, int64_t{0}, int64_t{24}, int64_t{42}, int64_t{90}, int64_t{70}}) {
            CAPTURE(to);
            int64_t at = history.restore(to, live.world);
            REQUIRE(at >= 0);
            CHECK(at <= to);
            CHECK(live.hash() == hashes[size_t(at)]);
            while (at < to) {
                const History::Step& step = history.step(++at);
                if (step.scene != live.world.scene())
                    live.world.follow(step.scene, live.store.load(*step.scene), step.driven);
                thawBudget again = work();
                again.work = step.work;
                live.world.step(again);
                REQUIRE(live.hash() == hashes[size_t(at)]);
            }
        }
        history.cut(50);
        CHECK(history.newest() == 50);
        CHECK(history.imageBefore(1000) <= 50);
    }
}

TEST_CASE("simulation: goes where it is told, and shows what it did") {
    Simulation simulation(1);
    Orders orders;
    orders.scene = std::make_shared<const scene::Scene>(blocks());
    orders.revision = 1;
    orders.budget = work();
    orders.particles = true;
    const auto wait = [&](auto&& so) {
        for (int i = 0; i < 60000; ++i) {
            simulation.receive();
            if (so(simulation.frame())) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return false;
    };
    simulation.send(orders);
    REQUIRE(wait([](const Frame& f) { return f.built && f.revision == 1; }));
    CHECK(simulation.frame().mesh.view().triangleCount > 100);
    CHECK(simulation.frame().particles.view().count == simulation.frame().counters.particles);
    orders.steps = 45;
    simulation.send(orders);
    REQUIRE(wait([](const Frame& f) { return f.frame == 45; }));
    CHECK(simulation.frame().steps.newest().frame == 45);
    const float melted = simulation.frame().counters.meltedFraction;
    const auto vertex = [&] { return simulation.frame().mesh.view().positions[1]; };
    const float y = vertex();
    CHECK(melted > 0);
    // Back, and forth again: the same.
    orders.seeks = 1, orders.seekTo = 7;
    simulation.send(orders);
    REQUIRE(wait([](const Frame& f) { return f.frame == 7 && !f.working; }));
    CHECK(simulation.frame().newest == 45);
    CHECK(simulation.frame().time == doctest::Approx(7.0 / 60));
    orders.seeks = 2, orders.seekTo = 45;
    simulation.send(orders);
    REQUIRE(wait([](const Frame& f) { return f.frame == 45 && !f.working; }));
    CHECK(simulation.frame().counters.meltedFraction == melted);
    CHECK(vertex() == y);
    // An edit in the past: what came after it was another story.
    orders.seeks = 3, orders.seekTo = 20;
    simulation.send(orders);
    REQUIRE(wait([](const Frame& f) { return f.frame == 20 && !f.working; }));
    scene::Scene hotter = blocks();
    hotter.heatSources[0].power = 2000;
    orders.scene = std::make_shared<const scene::Scene>(hotter);
    orders.revision = 2;
    simulation.send(orders);
    REQUIRE(wait([](const Frame& f) { return f.revision == 2; }));
    CHECK(simulation.frame().newest == 20);
    // Back to the start it is that of the scene as it is now.
    orders.resets = 1;
    simulation.send(orders);
    REQUIRE(wait([](const Frame& f) { return f.resets == 1; }));
    CHECK(simulation.frame().frame == 0);
    CHECK(simulation.frame().error == "");
    // Nothing that can be made a world: the reason, and no world.
    scene::Scene none = hotter;
    none.bodies[0].shape.type = scene::ShapeType::mesh, none.bodies[0].shape.meshFile = "gone.obj";
    orders.scene = std::make_shared<const scene::Scene>(none);
    orders.revision = 3;
    simulation.send(orders);
    REQUIRE(wait([](const Frame& f) { return f.revision == 3; }));
    CHECK_FALSE(simulation.frame().built);
    CHECK(simulation.frame().error.find("gone.obj") != std::string::npos);
}

TEST_CASE("picking: the nearest surface under a ray, with its side and what it belongs to") {
    auto s = std::make_shared<scene::Scene>(blocks());
    s->colliders[1].placement = {{0.04f, 0.2f, 0}, scene::quatFromDegrees(0, 45, 0), 2};
    const auto meshes = std::make_shared<const scene::SceneMeshes>(scene::loadMeshes(*s));
    Picker picker;
    picker.setScene(s, meshes, {});
    // The post: twice its size, turned; its side is at 0.01 x sqrt 2 along z.
    const std::optional<Hit> post = picker.cast({{0.04f, 0.2f, 1}, {0, 0, -1}});
    REQUIRE(post);
    CHECK(post->item == Item{Kind::collider, 1});
    CHECK(post->point.z == doctest::Approx(0.01 * std::sqrt(2.0)).epsilon(0.001));
    CHECK(post->distance == doctest::Approx(1 - 0.01 * std::sqrt(2.0)).epsilon(0.001));
    const std::optional<Hit> floor = picker.cast({{5, 1, 5}, {0, -1, 0}});
    REQUIRE(floor);
    CHECK(floor->item == Item{Kind::collider, 0});
    CHECK(floor->normal.y == 1);
    CHECK_FALSE(picker.cast({{5, 1, 5}, {0, 1, 0}}));
    // Where they have moved to, not where the scene has them.
    picker.setScene(s, meshes, {{}, {{0.5f, 0.2f, 0}, {0, 0, 0, 1}, 2}});
    CHECK_FALSE(picker.cast({{0.04f, 0.2f, 1}, {0, 0, -1}}));
    CHECK(picker.cast({{0.5f, 0.2f, 1}, {0, 0, -1}})->item == Item{Kind::collider, 1});
    // The melt, by body, even after another one was deleted.
    Live live;
    erase(live.scene, {Kind::body, 0});
    REQUIRE(live.follow());
    thawSurfaceDef def;
    thawInitSurfaceDef(&def);
    thawSurfaceView view;
    REQUIRE(thawWorld_ExtractSurface(live.world.world(), &def, &view) == thawResult_ok);
    std::vector<int> map(live.world.ids().bodies[0].index1, -1);
    map.back() = 0;
    picker.setMelt(view, map);
    const std::optional<Hit> melt = picker.cast({{0.08f, 1, 0}, {0, -1, 0}});
    REQUIRE(melt);
    CHECK(melt->item == Item{Kind::body, 0});
    CHECK(melt->point.y == doctest::Approx(0.03).epsilon(0.05));
    CHECK(melt->normal.y > 0.9f);
}

TEST_CASE("reference: stored, read back, and known to be of this scene") {
    const Folder folder;
    scene::Scene s = blocks();
    s.defaults.seconds = 0.2f;
    ReferenceRun run;
    run.start(s, 1);
    std::optional<ReferenceRun::Result> made;
    for (int i = 0; i < 60000 && !(made = run.take()); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    REQUIRE(made);
    CHECK(made->error == "");
    const Reference& r = made->reference;
    CHECK(r.rows.size() == 13);
    CHECK(r.rows.back().meanTemperature != r.rows.front().meanTemperature);
    CHECK(r.rows.front().melted > 0.5f);
    const std::string path = referencePath(folder / "blocks.json");
    CHECK(path == folder / "blocks.reference.csv");
    saveReference(r, path);
    const std::optional<Reference> back = loadReference(path);
    REQUIRE(back);
    CHECK(back->hash == meltHash(s));
    CHECK(back->rows.back().melted == r.rows.back().melted);
    CHECK(back->at(0.1)->time == doctest::Approx(0.1));
    CHECK_FALSE(back->at(5));
    // Looks and names do not matter, heat does.
    scene::Scene other = s;
    other.camera.eye.x += 1, other.name = "x", other.colliders[0].color = {1, 1, 1},
                             other.defaults.budgetMilliseconds = 2;
    CHECK(meltHash(other) == meltHash(s));
    other.heatSources[0].power += 1;
    CHECK(meltHash(other) != meltHash(s));
    std::ofstream(path) << "time,melted\n0,0\n";
    CHECK_FALSE(loadReference(path));
    run.start(s, 1);
    run.cancel();
    CHECK_FALSE(run.take());
}

TEST_CASE("settings, presets and autosaves survive, and what is broken does no harm") {
    const Folder folder;
    const Places places{folder / "config", folder / "state"};
    Settings settings;
    settings.outlinerWidth = 321, settings.snap = true;
    for (int i = 0; i < 20; ++i) settings.remember(folder / ("s" + std::to_string(i % 15) + ".json"));
    CHECK(settings.recent.size() == 12);
    CHECK(settings.recent[0] == folder / "s4.json");
    REQUIRE(saveSettings(places, settings));
    const Settings back = loadSettings(places);
    CHECK(back.outlinerWidth == 321);
    CHECK(back.snap);
    CHECK(back.recent == settings.recent);
    std::ofstream(folder / "config/settings.json") << "{\"outlinerWidth\": \"wide\", \"scale\": 99, \"recent\": 3";
    CHECK(loadSettings(places).outlinerWidth == Settings{}.outlinerWidth);
    std::ofstream(folder / "config/settings.json") << "{\"outlinerWidth\": \"wide\", \"scale\": 99, \"recent\": 3}";
    CHECK(loadSettings(places).scale == 4);

    scene::Scene s = blocks();
    s.materials[0].name = "../my wax", s.materials[0].def.cohesion = 7;
    savePreset(places, s.materials[0]);
    const std::vector<std::string> own = ownPresets(places);
    REQUIRE(own.size() == 1);
    CHECK(own[0].find('/') == std::string::npos);
    CHECK(loadPreset(places, own[0]).def.cohesion == 7);

    // A process that is gone: its work is found, and ours is not.
    Document document;
    document.edit("add", [](scene::Scene& t) { addMaterial(t, thawMaterial_ice); });
    {
        Autosave autosave(places);
        CHECK(autosave.keep(document) == "");
        CHECK(autosave.lost().empty());
        const std::string mine = folder / ("state/autosave/" + std::to_string(getpid()) + ".json");
        REQUIRE(std::filesystem::exists(mine));
        std::filesystem::copy_file(mine, folder / "state/autosave/999999999.json");
        std::ofstream(folder / "state/autosave/999999998.json") << "{";
        const std::vector<Lost> lost = autosave.lost();
        REQUIRE(lost.size() == 1);
        CHECK(scene::parseScene(lost[0].text, "", lost[0].directory).materials.size() == 1);
        Autosave::discard(lost[0]);
        CHECK(autosave.lost().empty());
        // Saved: nothing is left to recover.
        document.saveAs(folder / "s.json");
        CHECK(autosave.keep(document) == "");
        CHECK_FALSE(std::filesystem::exists(mine));
        document.edit("add", [](scene::Scene& t) { addMaterial(t, thawMaterial_ice); });
        CHECK(autosave.keep(document) == "");
        CHECK(std::filesystem::exists(mine));
    }
    CHECK_FALSE(std::filesystem::exists(folder / ("state/autosave/" + std::to_string(getpid()) + ".json")));
}
