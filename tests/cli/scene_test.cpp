// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "../../samples/player/scene.h"
#include "player.h"

#include <doctest/doctest.h>

#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>

using namespace thaw::scene;
using namespace thaw::test;

namespace {
// What the reader says about a text; "" when it takes it.
std::string complaint(const std::string& text) {
    try {
        parseScene(text, "f.json", "");
        return "";
    } catch (const InputError& e) {
        return e.what();
    }
}

Scene fullScene() {
    Scene s;
    s.name = "all \"of\" it\\ \n\t\xc3\xa9";
    s.world = {0.00123f, 5000, {0.1f, -9.80665f, 1e-7f}, 301.7f, 12.345f, 33.3333f};
    for (int p = 0; p < thawMaterial_presetCount; ++p) {
        Material m;
        m.name = "m" + std::to_string(p);
        m.preset = thawMaterialPreset(p);
        thawInitMaterialDef(&m.def, m.preset);
        s.materials.push_back(m);
    }
    thawMaterialDef& d = s.materials[3].def;
    d.density = 917.3f, d.solidus = 270.1f, d.liquidus = 275.9f, d.latentHeat = 1.0f / 3.0f,
    d.specificHeatSolid = 2001.5f;
    d.specificHeatLiquid = 4001.5f, d.conductivitySolid = 2.02f, d.conductivityLiquid = 0.551f,
    d.viscositySolid = 12345.6f;
    d.viscosityLiquid = 0.00177f, d.yieldStress = 12.5f, d.flow = thawFlow_casson, d.absorptivity = 0.31f,
    d.emissivity = 0.87f, d.cohesion = 3.3f, d.adhesion = 1.7f;
    d.setFraction = 0.11f, d.releaseFraction = 0.77f, d.color = {0.1f, 0.2f, 0.3f};
    d.youngModulus = 12345, d.solidYieldStress = 123.4f, d.relaxationTime = 5.5f, d.breakStrain = 0.33f;
    d.burnTemperature = 500, d.vapourHeat = 2.5e5f, d.burnRate = 3.5f, d.undercooling = 12.25f;
    const ShapeType types[] = {ShapeType::box,  ShapeType::sphere, ShapeType::cylinder,
                               ShapeType::cone, ShapeType::torus,  ShapeType::mesh};
    for (ShapeType type : types) {
        Body b;
        b.name = shapeName(type);
        b.shape = {type, {0.011f, 0.022f, 0.033f}, 0.044f, 0.055f, 0.0066f, "a b/c.obj"};
        b.placement = {{0.1f, -0.2f, 1e-5f}, quatFromDegrees(10, 20, 30), 1.5f};
        b.material = int(type) % 5;
        if (type != ShapeType::box) b.temperature = 287.654f;
        Part inner;
        inner.shape = b.shape, inner.placement = b.placement, inner.material = 4;
        Part deep;
        deep.depth = 0.0123f, deep.material = 2;
        if (type != ShapeType::cone) b.parts = {inner, deep};
        b.anchored = type != ShapeType::box;
        Paint hot, black;
        hot.brush = {{0.1f, -0.25f, 0.3f}, 0.0123f, 0.75f}, hot.temperature = 345.6f;
        black.brush = {{0, 1, 0}, 0.5f, 0}, black.absorptivity = 0.875f;
        if (type != ShapeType::torus) b.paint = {hot, black};
        s.bodies.push_back(b);
        Collider c;
        c.name = "wall";
        c.shape = b.shape;
        c.placement = b.placement;
        c.adhesive = type == ShapeType::box;
        c.occluder = type == ShapeType::cone;
        c.visible = type == ShapeType::torus;
        c.slipLength = 0.0031f, c.friction = 1.25f;
        if (type != ShapeType::torus) c.temperature = 371.25f, c.contactConductance = 512.5f;
        c.color = {0.7f, 0.0f, 1.0f};
        s.colliders.push_back(c);
        Prop p;
        p.name = "prop";
        p.shape = b.shape;
        p.color = {0.25f, 0.5f, 0.125f};
        s.props.push_back(p);
    }
    s.colliders[0].shape.type = ShapeType::plane;
    for (SourceVisual v : {SourceVisual::none, SourceVisual::flame, SourceVisual::glow}) {
        HeatSource h;
        h.name = "h", h.position = {0.3f, 0.2f, 0.1f}, h.power = -17.25f, h.radius = 0.0125f;
        h.enabled = v == SourceVisual::none, h.visual = v;
        if (v == SourceVisual::flame) {
            h.type = thawHeatSource_rectangle, h.rotation = {0.6f, 0, 0, 0.8f}, h.size = {0.03f, 0, 0.7f};
            h.temperature = 1234.5f, h.emissivity = 0.3f;
        } else if (v == SourceVisual::glow) {
            h.type = thawHeatSource_directional, h.irradiance = -812.5f;
        }
        s.heatSources.push_back(h);
    }
    Path path;
    path.name = "p";
    path.points = {{0.1f, 0.2f, 0.3f}, {-0.4f, 0.5f, 0.6f}, {0.7f, 0.8f, 0.9f}};
    thawInitPathDef(&path.def);
    s.paths.push_back(path);
    thawPathDef& way = path.def;
    path.collider = 0;
    way.smooth = way.enabled = false, way.radius = 0.02f, way.reach = 0.07f, way.strength = 0.35f, way.speed = 0.11f;
    way.arrivalTime = 4.5f, way.share = 0.7f, way.priority = -3, way.startAbsorptivity = 0.95f;
    s.paths.push_back(path);
    s.camera = {{1, 2, 3}, {0.5f, 0.25f, 0.1f}, 41.5f, {{0.5f, {1, 2, 3.1f}, {0.1f, 0.2f, 0.3f}, 40.5f}, {}}};
    s.camera.keys[1] = {7.25f, {3.3f, 2.2f, 1.1f}, {0.4f, 0.5f, 0.6f}, 17.5f};
    s.look = {{0.0f, 0.6f, 0.8f}, 1.7f};
    s.defaults = {12.5f, 2.75f, {0.0f, 1.1f, 2.2f}};
    return s;
}
// Edges that do not have exactly one partner in the other direction: 0 for a closed, consistent surface.
size_t unpairedEdges(const TriMesh& mesh) {
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (size_t i = 0; i < mesh.indices.size(); ++i) {
        const uint32_t from = mesh.indices[i], to = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
        ++edges[{from, to}];
        --edges[{to, from}];
    }
    size_t open = 0;
    for (const auto& edge : edges) open += edge.second != 0;
    return open;
}
} // namespace

TEST_CASE("every field of a scene survives writing and reading") {
    const Scene a = fullScene();
    const Scene b = parseScene(writeScene(a), "x.json", "somewhere");
    CHECK(b.directory == "somewhere");
    CHECK(b.name == a.name);
    CHECK(std::memcmp(&a.world, &b.world, sizeof a.world) == 0);
    REQUIRE(a.materials.size() == b.materials.size());
    for (size_t i = 0; i < a.materials.size(); ++i) {
        CHECK(a.materials[i].name == b.materials[i].name);
        CHECK(a.materials[i].preset == b.materials[i].preset);
        CHECK(std::memcmp(&a.materials[i].def, &b.materials[i].def, sizeof(thawMaterialDef)) == 0);
    }
    REQUIRE(a.bodies.size() == b.bodies.size());
    REQUIRE(a.colliders.size() == b.colliders.size());
    REQUIRE(a.props.size() == b.props.size());
    auto sameShape = [](const Shape& p, const Shape& q) {
        CHECK(p.type == q.type);
        if (p.type == ShapeType::mesh) CHECK(p.meshFile == q.meshFile);
        if (p.type == ShapeType::box) CHECK(std::memcmp(&p.size, &q.size, sizeof p.size) == 0);
        if (p.type == ShapeType::cylinder || p.type == ShapeType::cone) CHECK(p.height == q.height);
        if (p.type == ShapeType::torus) CHECK(p.tubeRadius == q.tubeRadius);
        if (p.type != ShapeType::mesh && p.type != ShapeType::box && p.type != ShapeType::plane)
            CHECK(p.radius == q.radius);
    };
    for (size_t i = 0; i < a.bodies.size(); ++i) {
        sameShape(a.bodies[i].shape, b.bodies[i].shape);
        CHECK(a.bodies[i].name == b.bodies[i].name);
        CHECK(std::memcmp(&a.bodies[i].placement, &b.bodies[i].placement, sizeof(Placement)) == 0);
        CHECK(a.bodies[i].material == b.bodies[i].material);
        CHECK(a.bodies[i].anchored == b.bodies[i].anchored);
        CHECK(std::isnan(a.bodies[i].temperature) == std::isnan(b.bodies[i].temperature));
        if (!std::isnan(a.bodies[i].temperature)) CHECK(a.bodies[i].temperature == b.bodies[i].temperature);
        REQUIRE(a.bodies[i].parts.size() == b.bodies[i].parts.size());
        for (size_t k = 0; k < a.bodies[i].parts.size(); ++k) {
            const Part &p = a.bodies[i].parts[k], &q = b.bodies[i].parts[k];
            CHECK(p.material == q.material);
            CHECK(p.depth == q.depth);
            if (p.depth > 0) continue;
            sameShape(p.shape, q.shape);
            CHECK(std::memcmp(&p.placement, &q.placement, sizeof(Placement)) == 0);
        }
        REQUIRE(a.bodies[i].paint.size() == b.bodies[i].paint.size());
        for (size_t k = 0; k < a.bodies[i].paint.size(); ++k) {
            const Paint &p = a.bodies[i].paint[k], &q = b.bodies[i].paint[k];
            CHECK(std::memcmp(&p.brush, &q.brush, sizeof(thawBrush)) == 0);
            CHECK(std::memcmp(&p.temperature, &q.temperature, sizeof(float)) == 0);
            CHECK(std::memcmp(&p.absorptivity, &q.absorptivity, sizeof(float)) == 0);
        }
        CHECK(a.colliders[i].slipLength == b.colliders[i].slipLength);
        CHECK(a.colliders[i].friction == b.colliders[i].friction);
        CHECK(std::memcmp(&a.colliders[i].temperature, &b.colliders[i].temperature, sizeof(float)) == 0);
        CHECK(a.colliders[i].contactConductance == b.colliders[i].contactConductance);
        sameShape(a.colliders[i].shape, b.colliders[i].shape);
        CHECK(std::memcmp(&a.colliders[i].placement, &b.colliders[i].placement, sizeof(Placement)) == 0);
        CHECK(a.colliders[i].adhesive == b.colliders[i].adhesive);
        CHECK(a.colliders[i].occluder == b.colliders[i].occluder);
        CHECK(a.colliders[i].visible == b.colliders[i].visible);
        CHECK(a.colliders[i].color.x == b.colliders[i].color.x);
        sameShape(a.props[i].shape, b.props[i].shape);
        CHECK(a.props[i].color.z == b.props[i].color.z);
    }
    REQUIRE(b.heatSources.size() == 3);
    for (size_t i = 0; i < 3; ++i) {
        CHECK(a.heatSources[i].visual == b.heatSources[i].visual);
        CHECK(a.heatSources[i].enabled == b.heatSources[i].enabled);
        CHECK(a.heatSources[i].power == b.heatSources[i].power);
        CHECK(a.heatSources[i].radius == b.heatSources[i].radius);
        CHECK(a.heatSources[i].type == b.heatSources[i].type);
        CHECK(a.heatSources[i].rotation.x == b.heatSources[i].rotation.x);
        CHECK(a.heatSources[i].rotation.w == b.heatSources[i].rotation.w);
        CHECK(a.heatSources[i].size.x == b.heatSources[i].size.x);
        CHECK(a.heatSources[i].size.z == b.heatSources[i].size.z);
        CHECK(a.heatSources[i].temperature == b.heatSources[i].temperature);
        CHECK(a.heatSources[i].emissivity == b.heatSources[i].emissivity);
        CHECK(a.heatSources[i].irradiance == b.heatSources[i].irradiance);
        CHECK(a.heatSources[i].position.z == b.heatSources[i].position.z);
    }
    REQUIRE(b.paths.size() == 2);
    for (size_t i = 0; i < 2; ++i) {
        const thawPathDef &x = a.paths[i].def, &y = b.paths[i].def;
        CHECK(a.paths[i].name == b.paths[i].name);
        CHECK(a.paths[i].collider == b.paths[i].collider);
        REQUIRE(b.paths[i].points.size() == 3);
        CHECK(std::memcmp(a.paths[i].points.data(), b.paths[i].points.data(), 3 * sizeof(thawVec3)) == 0);
        CHECK(x.smooth == y.smooth);
        CHECK(x.enabled == y.enabled);
        CHECK(x.radius == y.radius);
        CHECK(x.reach == y.reach);
        CHECK(x.strength == y.strength);
        CHECK(x.speed == y.speed);
        CHECK(x.arrivalTime == y.arrivalTime);
        CHECK(x.share == y.share);
        CHECK(x.priority == y.priority);
        CHECK((x.startAbsorptivity == y.startAbsorptivity ||
               (std::isnan(x.startAbsorptivity) && std::isnan(y.startAbsorptivity))));
    }
    CHECK(std::memcmp(&a.camera.eye, &b.camera.eye, sizeof(thawVec3)) == 0);
    CHECK(std::memcmp(&a.camera.target, &b.camera.target, sizeof(thawVec3)) == 0);
    CHECK(a.camera.fieldOfViewDegrees == b.camera.fieldOfViewDegrees);
    REQUIRE(b.camera.keys.size() == 2);
    CHECK(std::memcmp(a.camera.keys.data(), b.camera.keys.data(), 2 * sizeof(CameraKey)) == 0);
    CHECK(a.look.exposure == b.look.exposure);
    CHECK(a.defaults.captures == b.defaults.captures);
    CHECK(a.defaults.seconds == b.defaults.seconds);
    CHECK(a.defaults.budgetMilliseconds == b.defaults.budgetMilliseconds);
    CHECK(writeScene(b) == writeScene(a));
}

TEST_CASE("the sample scenes read, and read the same after writing") {
    size_t scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(THAW_SOURCE_DIR "/samples/scenes")) {
        if (entry.path().extension() != ".json") continue;
        ++scenes;
        CAPTURE(entry.path().filename().string());
        const Scene a = loadScene(entry.path().string());
        CHECK_FALSE(a.bodies.empty());
        CHECK_FALSE(a.heatSources.empty());
        CHECK(writeScene(parseScene(writeScene(a), "", "")) == writeScene(a));
    }
    CHECK(scenes >= 1);
}

TEST_CASE("a scene may leave out nearly everything") {
    const Scene s =
        parseScene(R"({"thawScene": 1, "bodies": [{"shape": {"type": "sphere", "radius": 0.02}}]})", "", "");
    CHECK(s.bodies[0].material == 0);
    REQUIRE(s.materials.size() == 1);
    CHECK(s.materials[0].preset == thawMaterial_wax);
    CHECK(std::isnan(s.bodies[0].temperature));
    CHECK(s.world.particleSpacing == 0.002f);
}

TEST_CASE("a material may stand in its body, and a preset's name will do") {
    const Scene s = parseScene(R"({"thawScene": 1, "bodies": [
        {"name": "a", "shape": {"type": "sphere", "radius": 0.02}, "material": {"preset": "ice", "density": 900}},
        {"name": "b", "shape": {"type": "sphere", "radius": 0.02}, "material": "butter"},
        {"name": "c", "shape": {"type": "sphere", "radius": 0.02}, "material": "butter"}]})",
                               "", "");
    REQUIRE(s.materials.size() == 2);
    CHECK(s.materials[0].def.density == 900.0f);
    CHECK(s.materials[0].preset == thawMaterial_ice);
    CHECK(s.bodies[1].material == 1);
    CHECK(s.bodies[2].material == 1);
}

TEST_CASE("rotations in degrees turn about x, then y, then z") {
    const Scene s = parseScene(
        R"({"thawScene": 1, "bodies": [{"shape": {"type": "sphere", "radius": 0.02}, "rotationDegrees": [90, 0, 90]}]})",
        "", "");
    const thawVec3 v = rotate(s.bodies[0].placement.rotation, {0, 0, 1}); // x: z -> -y; z: -y -> x
    CHECK(v.x == doctest::Approx(1.0).epsilon(1e-5));
    CHECK(std::abs(v.y) < 1e-5);
    CHECK(std::abs(v.z) < 1e-5);
}

TEST_CASE("what is wrong is named with its place and value") {
    struct Case {
        const char *what, *with, *says;
    };
    const Case cases[] = {
        {"\"density\": 900", "\"density\": -3", "f.json: at /materials/0/density: must be in 1..30000 kg/m^3, got -3"},
        {"\"density\": 900", "\"density\": 2000000000",
         "/materials/0/density: must be in 1..30000 kg/m^3, got 2000000000"},
        {"\"density\": 900", "\"density\": \"900 kg\"",
         "/materials/0/density: must be a number (kg/m^3), got \"900 kg\""},
        {"\"density\": 900", "\"density\": null", "/materials/0/density: must be a number (kg/m^3), got null"},
        {"\"density\": 900", "\"densty\": 900", "/materials/0/densty: unknown key (did you mean 'density'?)"},
        {"\"density\": 900", "\"density\": 900, \"density\": 901", "/materials/0/density: key given twice"},
        {"\"density\": 900", "\"density\": 1e400", "number too large near '1e400'"},
        {"\"density\": 900", "\"density\": NaN", "f.json:6:59: not valid JSON"},
        {"\"density\": 900", "\"solidus\": 340",
         "/materials/0/solidus: must not be above liquidus (331.15 K), got 340"},
        {"\"density\": 900", "\"setFraction\": 0.9", "/materials/0/setFraction: must not be above releaseFraction"},
        {"\"preset\": \"wax\"", "\"preset\": \"lead\"", "/materials/0/preset: must be one of wax, chocolate"},
        {"\"temperature\": 300", "\"temperature\": 20",
         "/bodies/0/temperature: must be in 100..10000 K, got 20 (temperatures"},
        {"\"temperature\": 300", "\"tempreature\": 300",
         "/bodies/0/tempreature: unknown key (did you mean 'temperature'?)"},
        {"\"material\": \"m\"", "\"material\": \"n\"",
         "/bodies/0/material: names no entry of /materials and no preset"},
        {"\"material\": \"m\"", "\"material\": {\"density\": -3}",
         "at /bodies/0/material/density: must be in 1..30000"},
        {"\"size\": [0.03, 0.03, 0.03]", "\"size\": [0.03, 0.03]",
         "/bodies/0/shape/size: must be an array of 3 numbers"},
        {"\"size\": [0.03, 0.03, 0.03]", "\"size\": [0.03, 0.03, 0]",
         "/bodies/0/shape/size/2: must be in 1e-05..1000 m, got 0"},
        {"\"type\": \"box\"", "\"type\": \"plane\"", "/bodies/0/shape/type: must be one of box, sphere"},
        {"\"type\": \"box\"", "\"type\": \"torus\", \"radius\": 0.01, \"tubeRadius\": 0.02",
         "/bodies/0/shape/tubeRadius: must be in"},
        {"\"position\": [0, 0.015, 0]", "\"position\": [0, 1e5, 0]",
         "/bodies/0/position/1: must be in -10000..10000 m"},
        {"\"position\": [0, 0.015, 0]", "\"rotation\": [0, 0, 0, 0]", "/bodies/0/rotation: must have length 1, has 0"},
        {"\"position\": [0, 0.015, 0]", "\"scale\": 0", "/bodies/0/scale: must be in 1e-06..1000000, got 0"},
        {"\"position\": [0, 0.015, 0]", "\"mesh\": \"a.obj\"", "/bodies/0/mesh: give either shape or mesh"},
        {"\"position\": [0, 0.06, 0], ", "", "at /heatSources/0: key 'position' is missing"},
        {"\"power\": 40", "\"power\": 1e7", "/heatSources/0/power: must be in -1000000..1000000 W, got 10000000.0"},
        {"\"power\": 40", "\"type\": \"lamp\"",
         "/heatSources/0/type: must be one of point, sphere, rectangle, disc, directional, got \"lamp\""},
        {"\"power\": 40", "\"type\": \"sphere\", \"temperature\": -1", "/heatSources/0/temperature: must be in"},
        {"\"power\": 40", "\"enabled\": 1", "/heatSources/0/enabled: must be true or false, got 1"},
        {"\"power\": 40", "\"visual\": \"spark\"",
         "/heatSources/0/visual: must be one of none, flame, glow, got \"spark\""},
        {"\"particleSpacing\": 0.005", "\"particleSpacing\": 0",
         "/world/particleSpacing: must be in 0.0001..1 m, got 0"},
        {"\"particleSpacing\": 0.005", "\"maxParticles\": 2000000000",
         "/world/maxParticles: must be in 8..4000000, got"},
        {"\"particleSpacing\": 0.005", "\"maxParticles\": 10.5",
         "/world/maxParticles: must be a whole number, got 10.5"},
        {"\"target\": [0, 0.015, 0]", "\"target\": [0.1, 0.1, 0.2]", "/camera/target: lies in the eye"},
        {"\"target\": [0, 0.015, 0]", "\"keys\": [{\"time\": 2}, {\"eye\": [0, 0, 1]}]",
         "at /camera/keys/1: key 'time' is missing"},
        {"\"target\": [0, 0.015, 0]", "\"keys\": [{\"time\": 2}, {\"time\": 2}]",
         "/camera/keys/1/time: must be later than the key before it, at 2 s, got 2"},
        {"\"target\": [0, 0.015, 0]", "\"keys\": [{\"time\": -1}]",
         "/camera/keys/0/time: must be in 0..3600 s, got -1"},
        {"\"target\": [0, 0.015, 0]", "\"keys\": [{\"time\": 1, \"target\": [0.1, 0.1, 0.2]}]",
         "/camera/keys/0/target: lies in the eye"},
        {"\"target\": [0, 0.015, 0]",
         "\"target\": [0, 0, 0], \"keys\": [{\"time\": 1, \"eye\": [0, 0, 1]}, {\"time\": 2, \"eye\": [0, 0, -1]}]",
         "/camera/keys/1/target: meets the eye on the way to this key"},
        {"\"target\": [0, 0.015, 0]", "\"keys\": [{\"time\": 1, \"fov\": 30}]", "/camera/keys/0/fov: unknown key"},
        {"\"target\": [0, 0.015, 0]", "\"keys\": 3", "/camera/keys: must be an array, got 3"},
        {"\"exposure\": 1", "\"sunDirection\": [0, 0, 0]", "/look/sunDirection: has no length"},
        {"[0, 0.1]", "[0, -1]", "/defaults/captures/1: must be in 0..3600 s, got -1"},
        {"\"thawScene\": 1", "\"thawScene\": 2", "/thawScene: is version 2, this program reads version 1"},
        {"\"thawScene\": 1,", "", "key 'thawScene' is missing"},
        {"\"name\": \"small\"", "\"name\": 7", "/name: must be a text, got 7"},
        {"\"colliders\": [", "\"colliders\": {}, \"x\": [", "/colliders: must be an array, got an object"},
        {"\"bodies\": [{", "\"bodies\": [3, {", "/bodies/0: must be an object, got 3"},
        {"\"defaults\"", "\"a/b~\\u0001\"", "/a~1b~0 : unknown key"},
    };
    REQUIRE(complaint(kSmallScene) == "");
    for (const Case& c : cases) {
        CAPTURE(c.with);
        const std::string said = complaint(replaced(kSmallScene, c.what, c.with));
        CHECK_MESSAGE(contains(said, c.says), "said: " << said);
        CHECK_FALSE(contains(said, "\n"));
    }
}

TEST_CASE("damaged and hostile text is refused in one line, never worse") {
    CHECK(contains(complaint(""), "f.json:1:1: not valid JSON"));
    CHECK(contains(complaint("{\n  \"thawScene\": 1,\n}"), "f.json:3:1: not valid JSON"));
    CHECK(contains(complaint("[]"), "must be an object"));
    CHECK(contains(complaint(std::string(1'000'000, '[')), "nested more than 32 deep"));
    CHECK(contains(complaint("\xff\xfe{}"), "not valid JSON"));
    CHECK(contains(complaint("{\"thawScene\": 1, \"name\": \"\xc3\x28\"}"), "not valid JSON"));

    // Every prefix, and a few thousand single-byte changes by a fixed generator.
    const std::string good = kSmallScene;
    for (size_t n = 0; n < good.size(); ++n) CHECK(contains(complaint(good.substr(0, n)), "f.json:"));
    uint32_t state = 12345;
    auto next = [&](uint32_t bound) {
        state = state * 1664525u + 1013904223u;
        return (state >> 8) % bound;
    };
    const char alphabet[] = "{}[]\",:-0123456789.eE \n\\truefalsn\x01\x80\xff";
    size_t refused = 0;
    for (int i = 0; i < 5000; ++i) {
        std::string text = good;
        for (uint32_t n = 1 + next(3); n; --n) text[next(uint32_t(text.size()))] = alphabet[next(sizeof alphabet - 1)];
        const std::string said = complaint(text);
        refused += !said.empty();
        if (contains(said, "\n")) FAIL_CHECK("two lines: " << said);
    }
    CHECK(refused > 3000);
}

TEST_CASE("shortest decimals read back the same") {
    for (float v : {0.0022f, 1.0f / 3.0f, 1e-30f, 123456789.0f, std::numeric_limits<float>::max()})
        CHECK(std::strtof(shortest(v).c_str(), nullptr) == v);
    CHECK(shortest(0.0022f) == "0.0022");
}

TEST_CASE("the meshes of the candle scene are what the player makes") {
    struct Case {
        const char* file;
        TriMesh mesh;
        double volume; // m^3, a plain cylinder and a plain dish of about the same size
        double tolerance;
        double foot = 0; // m, height of its lowest point
    };
    const Case cases[] = {{"candle.obj", makeCandle(), 3.14159 * 0.017 * 0.017 * 0.12, 0.1},
                          {"saucer.obj", makeSaucer(), 24e-6, 0.1},
                          // A cone and a rim; two balls, and one, of which the feet are flat.
                          {"cone.obj", makeWaffleCone(), 109e-6, 0.02},
                          {"scoops.obj", makeScoops(), 139e-6, 0.02, 0.135 - 0.72 * 0.027},
                          {"upper_scoop.obj", makeUpperScoop(), 57e-6, 0.02, 0.168 - 0.72 * 0.024},
                          {"star.obj", makeStar(), 40.8e-6, 0.01},
                          // What it held when its picture was judged; a disc, a wall and a bar.
                          {"bunny.obj", makeBunny(), 243e-6, 0.01},
                          {"pan.obj", makePan(), 267e-6, 0.1, -0.0035}};
    for (const Case& c : cases) {
        CAPTURE(c.file);
        CHECK(unpairedEdges(c.mesh) == 0);
        CHECK(volumeOf(c.mesh) == doctest::Approx(c.volume).epsilon(c.tolerance).scale(0));
        CHECK(std::abs(double(boundsOf(c.mesh).lower.y) - c.foot) < 1e-6);
        std::ifstream in(std::string(THAW_SOURCE_DIR "/samples/scenes/meshes/") + c.file);
        size_t vertices = 0, faces = 0, far = 0;
        for (std::string line; std::getline(in, line);) {
            double x, y, z;
            if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) == 3 && vertices < c.mesh.vertexCount()) {
                const float* v = &c.mesh.vertices[3 * vertices++];
                far += std::abs(x - v[0]) > 1.5e-6 || std::abs(y - v[1]) > 1.5e-6 || std::abs(z - v[2]) > 1.5e-6;
            }
            faces += line.compare(0, 2, "f ") == 0;
        }
        CHECK(vertices == c.mesh.vertexCount());
        CHECK(faces == c.mesh.triangleCount());
        CHECK(far == 0);
    }
}

TEST_CASE("shapes are closed, outward and as large as asked") {
    struct Case {
        TriMesh mesh;
        double volume, tolerance;
    };
    const double pi = 3.14159265358979;
    const Case cases[] = {
        {makeBox({0.1f, 0.2f, 0.3f}), 0.006, 1e-5},
        {makeSphere(0.1f), 4.0 / 3.0 * pi * 1e-3, 0.01},
        {makeCylinder(0.1f, 0.3f), pi * 0.01 * 0.3, 0.01},
        {makeCone(0.1f, 0.3f), pi * 0.01 * 0.1, 0.01},
        {makeTorus(0.1f, 0.03f), 2.0 * pi * pi * 0.1 * 0.0009, 0.02},
    };
    for (const Case& c : cases) CHECK(volumeOf(c.mesh) == doctest::Approx(c.volume).epsilon(c.tolerance).scale(0));
    for (const Case& c : cases) CHECK(unpairedEdges(c.mesh) == 0);
}
