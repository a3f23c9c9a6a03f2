// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "pictures.h"
#include "scene_stage.h"

#include "view/context.h"
#include "view/image.h"
#include "view/mesh_io.h"
#include "view/renderer.h"

#include <algorithm>
#include <filesystem>

namespace thaw::player {

using scene::InputError;
using scene::oneLine;

std::string pictureViews() {
    std::string names;
    for (size_t i = 0; i < std::size(kNamedViews); ++i)
        names += std::string(i == 0 ? "" : i + 1 < std::size(kNamedViews) ? ", " : " or ") + kNamedViews[i].name;
    return names;
}

PictureView parseView(const std::string& name, const std::string& text) {
    for (const NamedView& known : kNamedViews)
        if (text == known.name) return known.view;
    throw InputError(name + ": must be " + pictureViews() + ", got '" + oneLine(text, 40) + "'");
}

struct Pictures::State {
    std::unique_ptr<view::HeadlessContext> context; // before the renderer: it must outlive it
    std::unique_ptr<view::Renderer> renderer;
    view::Scene scene;
    view::View view;
    scene::Camera camera;
    std::vector<view::CaptionedImage> taken;

    std::vector<view::Region> regions; // of the paths and shapes
    scene::DrawnMeshes drawn;
    scene::ParticleBalls balls;
};

Pictures::Pictures(const scene::Scene& scene, const scene::SceneMeshes& meshes, PictureSize size, bool cut)
    : state_(std::make_unique<State>()) {
    State& s = *state_;
    s.balls = scene::ParticleBalls(scene, cut);
    s.scene = scene::stageOf(scene, meshes, s.drawn);
    s.regions = regionsOf(scene, meshes);
    std::string error;
    s.context = view::HeadlessContext::create(error);
    if (!s.context) throw RunError("no way to draw on this machine: " + oneLine(error, 300));
    s.renderer = view::Renderer::create(error);
    if (!s.renderer) throw RunError("the renderer does not start: " + oneLine(error, 300));

    s.camera = scene.camera;
    s.view.width = size.width;
    s.view.height = size.height;
    s.view.exposure = scene.look.exposure;
    const scene::TemperatureRange range = scene::temperatureRangeOf(scene);
    s.view.temperatureLow = range.low;
    s.view.temperatureHigh = range.high;
}

Pictures::~Pictures() = default;

view::Image Pictures::draw(thawWorld* world, PictureView mode) {
    State& s = *state_;
    thawSurfaceDef def;
    thawInitSurfaceDef(&def);
    if (thawWorld_ExtractSurface(world, &def, &s.scene.surface) != thawResult_ok)
        throw RunError(std::string("no surface: ") + thawWorld_GetLastError(world));
    thawCounters counters;
    thawWorld_GetCounters(world, &counters);
    s.scene.time = float(counters.time);
    s.view.camera = scene::viewCamera(scene::cameraAt(s.camera, counters.time));
    if (s.scene.stage.empty()) s.scene.stage = view::sceneBounds(s.scene); // as it stands at first
    s.view.mode = modeOf(mode);
    s.scene.particles = nullptr;
    s.scene.regions.clear();
    if (mode == PictureView::control) s.scene.regions = s.regions;
    thawParticleView melt;
    s.scene.splats = nullptr;
    if (mode == PictureView::splats) {
        thawWorld_GetParticles(world, &melt);
        s.scene.splats = &melt;
        if (thawWorld_GetSplats(world, &s.scene.splatShapes) != thawResult_ok)
            throw RunError(std::string("no splats: ") + thawWorld_GetLastError(world));
    }
    if (isOfParticles(mode)) {
        s.scene.surface = {};
        const float* sizes = nullptr;
        if (mode == PictureView::elfs && thawWorld_GetFeatureSizes(world, &sizes) != thawResult_ok)
            throw RunError(std::string("no feature sizes: ") + thawWorld_GetLastError(world));
        thawParticleView all;
        thawWorld_GetParticles(world, &all);
        s.balls.show(all, sizes, mode, s.view.camera, s.scene);
    }
    std::string error;
    std::optional<view::Image> image = s.renderer->capture(s.scene, s.view, error);
    if (!image) throw RunError("no picture: " + oneLine(error, 300));
    return std::move(*image);
}

void Pictures::take(thawWorld* world, PictureView mode, const std::string& caption, const std::string& path) {
    view::Image image = draw(world, mode);
    std::string error;
    if (!view::writePng(path, image, error)) throw RunError(oneLine(path, 400) + ": " + oneLine(error, 200));
    state_->taken.push_back({std::move(image), caption});
}

void Pictures::append(Pictures& other) {
    for (auto& picture : other.state_->taken) state_->taken.push_back(std::move(picture));
    other.state_->taken.clear();
}

void Pictures::beside(Pictures& other, int columns) {
    std::vector<view::CaptionedImage> all;
    auto &own = state_->taken, &more = other.state_->taken;
    for (size_t i = 0, k = 0; i < own.size() || k < more.size();) {
        for (int c = 0; c < columns && i < own.size(); ++c) all.push_back(std::move(own[i++]));
        if (k < more.size()) all.push_back(std::move(more[k++]));
    }
    own = std::move(all), more.clear();
}

void Pictures::writeSheet(const std::string& path, const std::string& title, int columns) const {
    std::string error;
    const view::Image sheet = view::contactSheet(state_->taken, columns, title);
    if (!view::writePng(path, sheet, error)) throw RunError(oneLine(path, 400) + ": " + oneLine(error, 200));
}

void writeSurface(thawWorld* world, const scene::Scene& scene, const std::string& path) {
    thawSurfaceDef def;
    thawInitSurfaceDef(&def);
    thawSurfaceView surface;
    if (thawWorld_ExtractSurface(world, &def, &surface) != thawResult_ok)
        throw RunError(std::string("no surface: ") + thawWorld_GetLastError(world));
    std::vector<thawVec3> colors;
    for (const scene::Material& material : scene.materials) colors.push_back(material.def.color);
    std::string error;
    const bool written = std::filesystem::path(path).extension() == ".obj"
                             ? view::writeObj(path, surface, colors, error)
                             : view::writePly(path, surface, colors, error);
    if (!written) throw RunError(oneLine(path, 400) + ": " + oneLine(error, 200));
}

} // namespace thaw::player
