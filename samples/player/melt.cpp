// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "run.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>

namespace thaw::player {

using scene::InputError;
using scene::oneLine;

namespace {
struct Options {
    std::string mesh, material = "wax", up = "y", saveScene;
    double size = 0.1, power = 0.0, spacing = 0.0, timeScale = -1.0;
    RunOptions run;
};

constexpr double kParticles = 11000.0; // what a 4 ms budget carries with room to spare
// W/m^2 of the body's size: 600 W over 0.1 m. Wax at its melting point loses 0.6 kW/m^2 to a room; under a lamp of 60 W
// the lower half of a body of 0.1 m takes up less than that, and no time scale melts it.
constexpr double kPowerPerSize2 = 6e4;
constexpr double kMeltSeconds = 8.0; // game time in which all of it would melt if nothing were lost; losses take half

// A scene around one mesh: it stands on a floor, a glowing ball hangs over its top.
scene::Scene makeScene(const Options& o) {
    checkRange("--size", o.size, 0.001, 100.0, "m");
    if (o.power != 0.0) checkRange("--power", o.power, 0.01, 1e6, "W");
    if (o.up != "y" && o.up != "z") throw InputError("--up: must be y or z, got '" + oneLine(o.up, 40) + "'");
    thawMaterialPreset preset = thawMaterial_presetCount;
    std::string known;
    for (int p = 0; p < thawMaterial_presetCount; ++p) {
        const std::string name = thawMaterialPresetName(thawMaterialPreset(p));
        known += (p ? ", " : "") + name;
        if (o.material == name) preset = thawMaterialPreset(p);
    }
    if (preset == thawMaterial_presetCount)
        throw InputError("--material: must be one of " + known + ", got '" + oneLine(o.material, 40) + "'");

    scene::TriMesh mesh;
    try {
        mesh = scene::importMesh(o.mesh);
    } catch (const std::runtime_error& e) {
        throw InputError(oneLine(o.mesh, 400) + ": " + e.what());
    }
    const thawQuat upright = o.up == "z" ? scene::quatFromDegrees(-90, 0, 0) : thawQuat{0, 0, 0, 1};
    scene::TriMesh turned = mesh;
    for (size_t i = 0; i < turned.vertices.size(); i += 3) {
        const thawVec3 v = scene::rotate(upright, {turned.vertices[i], turned.vertices[i + 1], turned.vertices[i + 2]});
        turned.vertices[i] = v.x, turned.vertices[i + 1] = v.y, turned.vertices[i + 2] = v.z;
    }
    const scene::Bounds b = scene::boundsOf(turned);
    const double extent[3] = {double(b.upper.x) - b.lower.x, double(b.upper.y) - b.lower.y,
                              double(b.upper.z) - b.lower.z};
    const double largest = std::max({extent[0], extent[1], extent[2]});
    const double volumeInFile = std::abs(scene::volumeOf(turned));
    if (!(largest > 0.0) || !std::isfinite(largest)) throw InputError(oneLine(o.mesh, 400) + ": has no extent");
    const double scale = o.size / largest;
    if (!(scale >= 1e-6 && scale <= 1e6))
        throw InputError(oneLine(o.mesh, 400) + ": is " + scene::shortest(float(largest)) +
                         " long in its file, too far from --size");
    // A mesh with holes has no clear volume; a third of its box is a common filling.
    const double box = extent[0] * extent[1] * extent[2];
    const double volume = (volumeInFile > 1e-3 * box ? volumeInFile : box / 3.0) * scale * scale * scale;

    scene::Scene s;
    s.name = std::filesystem::path(o.mesh).stem().string() + " of " + o.material;
    s.file = o.mesh;
    scene::Material material;
    material.name = o.material;
    material.preset = preset;
    thawInitMaterialDef(&material.def, preset);
    s.materials.push_back(material);
    const thawMaterialDef& m = material.def;

    if (o.spacing != 0.0) checkRange("--spacing", o.spacing, 1e-4, 1.0, "m");
    s.world.particleSpacing =
        float(o.spacing != 0.0 ? o.spacing : std::clamp(std::cbrt(volume / kParticles), 1e-4, 1.0));

    // Frozen goods start frozen; the room is warm in any case.
    const float ambient = s.world.ambientTemperature;
    scene::Body body;
    body.name = std::filesystem::path(o.mesh).stem().string();
    body.shape.type = scene::ShapeType::mesh;
    body.shape.meshFile = o.mesh;
    body.placement.rotation = upright;
    body.placement.scale = float(scale);
    body.placement.position = {float(-scale * 0.5 * (double(b.lower.x) + b.upper.x)), float(-scale * b.lower.y),
                               float(-scale * 0.5 * (double(b.lower.z) + b.upper.z))};
    if (m.solidus < ambient + 2.0f) body.temperature = m.solidus - 8.0f;
    const float start = std::isnan(body.temperature) ? ambient : body.temperature;
    s.bodies.push_back(body);

    const double width = scale * extent[0], height = scale * extent[1], depth = scale * extent[2];
    const double reach = std::max({width, height, depth});
    scene::HeatSource source;
    source.name = "lamp";
    const double above = 0.30 * reach;
    source.position = {0.0f, float(height + above), 0.0f};
    const double power = o.power != 0.0 ? o.power : std::min(kPowerPerSize2 * o.size * o.size, 1e6);
    source.power = float(power);
    source.radius = float(0.05 * reach);
    source.visual = scene::SourceVisual::glow;
    s.heatSources.push_back(source);

    // Heat seconds per game second so that what the lamp sends down melts the whole in kMeltSeconds. The share that
    // lands is that of a disc as wide as the body, half way down, seen from the lamp.
    const double radius = 0.5 * std::sqrt(std::max(width, 1e-3 * reach) * std::max(depth, 1e-3 * reach));
    const double distance = above + 0.5 * height;
    const double share = 0.5 * (1.0 - distance / std::hypot(distance, radius)) * m.absorptivity;
    const double joules =
        m.density * volume *
        (m.latentHeat + m.specificHeatSolid * std::max(0.0f, m.liquidus - start) + m.specificHeatLiquid * 20.0);
    if (o.timeScale >= 0.0)
        checkRange("--time-scale", o.timeScale, 0.0, 1e5);
    else if (o.timeScale != -1.0)
        throw InputError("--time-scale: must be in 0..100000");
    s.world.thermalTimeScale =
        float(o.timeScale >= 0.0 ? o.timeScale : std::clamp(joules / (power * share * kMeltSeconds), 1.0, 1e5));

    scene::Collider floor;
    floor.name = "floor";
    floor.shape.type = scene::ShapeType::plane;
    floor.color = {0.115f, 0.10f, 0.092f};
    s.colliders.push_back(floor);

    // The body, its lamp and a pool a body wider on each side are in the picture.
    const double tall = height + above + source.radius, wide = std::max({width, depth, reach}) * 2.9;
    const double half = 0.5 * std::max(tall, wide * 540.0 / 960.0) * 1.15;
    s.camera.fieldOfViewDegrees = 28.0f;
    const double away = half / std::tan(0.5 * 28.0 * std::numbers::pi / 180.0) + 0.5 * depth;
    s.camera.target = {0.0f, float(0.36 * tall), 0.0f};
    s.camera.eye = {float(0.35 * away), float(0.46 * tall + 0.22 * away), float(0.91 * away)};
    s.defaults.seconds = 20.0f;
    s.defaults.captures = {0.0f, 5.0f, 10.0f, 20.0f};
    return s;
}

int melt(const Options& o) {
    scene::Scene s = makeScene(o);
    if (!o.saveScene.empty()) {
        scene::Scene saved = s;
        namespace fs = std::filesystem;
        std::error_code error;
        fs::path folder = fs::absolute(o.saveScene, error).parent_path();
        const fs::path relative = fs::absolute(o.mesh, error).lexically_relative(folder);
        const std::string text = relative.generic_string();
        // A path that has to climb is better absolute: the scene may be moved, what it names hardly.
        const bool climbs = relative.empty() || text.compare(0, 2, "..") == 0;
        saved.bodies[0].shape.meshFile =
            climbs ? fs::absolute(o.mesh, error).lexically_normal().generic_string() : text;
        try {
            scene::saveScene(saved, o.saveScene);
        } catch (const std::runtime_error& e) {
            throw RunError(e.what());
        }
    }
    return runScene(s, o.run);
}
} // namespace

void addMelt(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("melt", "Melt a mesh of yours (OBJ, PLY, STL, glTF, GLB) under a lamp");
    auto o = std::make_shared<Options>();
    command->add_option("mesh", o->mesh, "Mesh file; closed, or nearly so")->required();
    command
        ->add_option("--material", o->material,
                     "wax, chocolate, butter, ice, icecream, darkchocolate, aluminium, iron or lava")
        ->capture_default_str();
    command->add_option("--size", o->size, "Largest dimension of the body, m")->capture_default_str();
    command->add_option("--up", o->up, "Axis of the file that points up: y or z")->capture_default_str();
    command->add_option("--power", o->power,
                        "Power of the lamp, W (default: 600 for 0.1 m, with the square of the size)");
    command->add_option("--spacing", o->spacing, "Distance of particles, m (default: so that about 11000 result)");
    command->add_option("--time-scale", o->timeScale,
                        "Seconds of heat in a second of motion (default: so that most melts in 20 to 30 s)");
    command->add_option("--save-scene", o->saveScene, "Also write the scene that was made, to edit it or run it again");
    o->run.addTo(*command);
    command->callback([=, &exitCode] { exitCode = melt(*o); });
}

} // namespace thaw::player
