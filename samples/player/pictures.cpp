// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "pictures.h"
#include "pictures_particles.h"

#include "view/context.h"
#include "view/image.h"
#include "view/mesh_io.h"
#include "view/renderer.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

namespace thaw::player {

using scene::InputError;
using scene::oneLine;
using scene::ShapeType;

namespace {
// Own normals for flat shapes: averaged ones would make a box look like a pillow.
std::shared_ptr<const view::TriangleMesh> drawable(const scene::Shape& shape, const scene::TriMesh& mesh) {
    if (shape.type == ShapeType::box)
        return std::make_shared<view::TriangleMesh>(
            view::makeBox({shape.size.x / 2, shape.size.y / 2, shape.size.z / 2}));
    if (shape.type == ShapeType::sphere) return std::make_shared<view::TriangleMesh>(view::makeSphere(shape.radius));
    if (shape.type == ShapeType::cylinder) {
        view::TriangleMesh cylinder = view::makeCylinder(shape.radius, shape.height, 48);
        for (size_t i = 1; i < cylinder.positions.size(); i += 3) cylinder.positions[i] -= shape.height / 2;
        return std::make_shared<view::TriangleMesh>(std::move(cylinder));
    }
    return std::make_shared<view::TriangleMesh>(view::makeMesh(mesh.view()));
}

view::MeshInstance instance(const scene::Shape& shape, const scene::TriMesh& mesh, const scene::Placement& placement,
                            const thawVec3& color) {
    view::MeshInstance out;
    out.mesh = drawable(shape, mesh);
    out.position = placement.position;
    out.rotation = placement.rotation;
    out.scale = placement.scale;
    out.color = color;
    return out;
}

view::MaterialLook lookOf(const scene::Material& material) {
    view::MaterialLook look = view::materialLook(material.preset);
    look.color = material.def.color;
    return look;
}
} // namespace

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
    ParticleBalls balls;
};

namespace {
std::vector<view::Region> regionsOf(const scene::Scene& scene, const scene::SceneMeshes& meshes) {
    std::vector<view::Region> out;
    const auto add = [&](std::vector<view::Region> more) { out.insert(out.end(), more.begin(), more.end()); };
    const auto place = [&](int collider) {
        return collider < 0 ? scene::Placement{} : scene.colliders[size_t(collider)].placement;
    };
    for (const scene::Path& path : scene.paths) {
        thawPathDef def = path.def;
        def.points = path.points.data(), def.pointCount = int32_t(path.points.size());
        const scene::Placement at = place(path.collider);
        if (def.enabled) add(view::pathRegions(def, at.position, at.rotation));
    }
    for (size_t i = 0; i < scene.shapes.size(); ++i) {
        const scene::FillShape& shape = scene.shapes[i];
        const scene::FillShapeDef made(shape, meshes.shapes[i]);
        const scene::Placement at = place(shape.collider);
        if (made.def.enabled) add(view::shapeRegions(made.def, at.position, at.rotation));
    }
    return out;
}

view::ViewMode modeOf(PictureView view) {
    switch (view) {
    case PictureView::temperature:
        return view::ViewMode::temperature;
    case PictureView::phase:
        return view::ViewMode::phase;
    case PictureView::liquid:
        return view::ViewMode::liquid;
    default:
        return view::ViewMode::shaded;
    }
}
} // namespace

Pictures::Pictures(const scene::Scene& scene, const scene::SceneMeshes& meshes, PictureSize size, bool cut)
    : state_(std::make_unique<State>()) {
    State& s = *state_;
    s.balls = ParticleBalls(scene, cut);
    s.scene.splatSpacing = scene.world.particleSpacing;
    s.regions = regionsOf(scene, meshes);
    std::string error;
    s.context = view::HeadlessContext::create(error);
    if (!s.context) throw RunError("no way to draw on this machine: " + oneLine(error, 300));
    s.renderer = view::Renderer::create(error);
    if (!s.renderer) throw RunError("the renderer does not start: " + oneLine(error, 300));

    for (const scene::Material& material : scene.materials) s.scene.materials.push_back(lookOf(material));
    s.scene.floor.visible = false;
    for (size_t i = 0; i < scene.colliders.size(); ++i) {
        const scene::Collider& c = scene.colliders[i];
        if (!c.visible) continue;
        if (c.shape.type != ShapeType::plane) {
            s.scene.meshes.push_back(instance(c.shape, meshes.colliders[i], c.placement, c.color));
            continue;
        }
        const thawVec3 normal = scene::rotate(c.placement.rotation, {0, 1, 0});
        if (!s.scene.floor.visible && normal.y > 0.9999f) {
            s.scene.floor.visible = true;
            s.scene.floor.height = c.placement.position.y;
            s.scene.floor.color = c.color;
        } else {
            view::MeshInstance wall;
            wall.mesh = std::make_shared<view::TriangleMesh>(view::makePlane(1.0f));
            wall.position = c.placement.position;
            wall.rotation = c.placement.rotation;
            wall.color = c.color;
            s.scene.meshes.push_back(wall);
        }
    }
    for (size_t i = 0; i < scene.props.size(); ++i)
        s.scene.meshes.push_back(
            instance(scene.props[i].shape, meshes.props[i], scene.props[i].placement, scene.props[i].color));
    for (const scene::HeatSource& h : scene.heatSources) {
        if (!h.enabled || h.visual == scene::SourceVisual::none || h.type == thawHeatSource_directional) continue;
        view::Glow glow;
        glow.position = h.position;
        glow.power =
            std::min(h.power, 30.0f); // a heat lamp of 600 W is mostly infrared: as light it would burn the picture out
        glow.radius = h.radius;
        glow.shape = h.visual == scene::SourceVisual::flame ? view::GlowShape::flame : view::GlowShape::ball;
        s.scene.glows.push_back(glow);
    }
    s.scene.key.direction = scene.look.sunDirection;

    s.camera = scene.camera;
    s.view.width = size.width;
    s.view.height = size.height;
    s.view.exposure = scene.look.exposure;
    // One scale for all pictures of a run, so that they can be compared.
    float low = scene.world.ambientTemperature, high = low;
    for (const scene::Body& body : scene.bodies) {
        const float start = std::isnan(body.temperature) ? scene.world.ambientTemperature : body.temperature;
        low = std::min(low, start);
        high = std::max({high, start, scene.materials[size_t(body.material)].def.liquidus + 25.0f});
        for (const scene::Part& part : body.parts)
            high = std::max(high, scene.materials[size_t(part.material)].def.liquidus + 25.0f);
    }
    s.view.temperatureLow = low;
    s.view.temperatureHigh = high;
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
    const scene::Camera camera = scene::cameraAt(s.camera, counters.time);
    s.view.camera.eye = camera.eye, s.view.camera.target = camera.target;
    s.view.camera.fieldOfView = camera.fieldOfViewDegrees * std::numbers::pi_v<float> / 180.0f;
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
        s.balls.show(world, mode, s.view.camera, s.scene);
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
