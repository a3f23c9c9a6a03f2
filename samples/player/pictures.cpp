// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "pictures.h"

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

PictureView parseView(const std::string& name, const std::string& text) {
    if (text == "shaded") return PictureView::shaded;
    if (text == "temperature") return PictureView::temperature;
    if (text == "phase") return PictureView::phase;
    if (text == "particles") return PictureView::particles;
    if (text == "level") return PictureView::level;
    if (text == "elfs") return PictureView::elfs;
    throw InputError(name + ": must be " + kPictureViews + ", got '" + oneLine(text, 40) + "'");
}

struct Pictures::State {
    std::unique_ptr<view::HeadlessContext> context; // before the renderer: it must outlive it
    std::unique_ptr<view::Renderer> renderer;
    view::Scene scene;
    view::View view;
    scene::Camera camera;
    std::vector<view::CaptionedImage> taken;

    // Particles as balls of half their spacing, of those that are drawn.
    float spacing = 0;
    bool cut = false;
    std::vector<double> middle; // x y z, of the first picture
    struct Balls {
        std::vector<float> positions, temperatures, sizes;
        std::vector<uint8_t> levels;
        thawParticleView view{};
    } balls;
    void gatherBalls(thawWorld* world, PictureView mode);
};

void Pictures::State::gatherBalls(thawWorld* world, PictureView mode) {
    const float* sizes = nullptr;
    if (mode == PictureView::elfs && thawWorld_GetFeatureSizes(world, &sizes) != thawResult_ok)
        throw RunError(std::string("no feature sizes: ") + thawWorld_GetLastError(world));
    thawParticleView all;
    thawWorld_GetParticles(world, &all);
    if (middle.empty()) {
        middle.assign(3, 0);
        for (int i = 0; i < all.count; ++i)
            for (size_t a = 0; a < 3; ++a)
                middle[a] += double(all.positions[4 * size_t(i) + a]) / std::max(all.count, 1);
    }
    // Upright, so that what runs down a side is cut along its way.
    const double way[2] = {double(view.camera.target.x - view.camera.eye.x),
                           double(view.camera.target.z - view.camera.eye.z)};
    balls = {};
    for (int i = 0; i < all.count; ++i) {
        const float* x = all.positions + 4 * size_t(i);
        if (cut && way[0] * (double(x[0]) - middle[0]) + way[1] * (double(x[2]) - middle[2]) < 0) continue;
        balls.positions.insert(balls.positions.end(), x, x + 3);
        balls.positions.push_back(0.5f * spacing * std::exp2(float(all.levels[i]) / 3));
        balls.temperatures.push_back(all.temperatures[i]), balls.levels.push_back(all.levels[i]);
        if (sizes) balls.sizes.push_back(sizes[i]);
    }
    balls.view.count = int32_t(balls.levels.size());
    balls.view.positions = balls.positions.data(), balls.view.temperatures = balls.temperatures.data();
    balls.view.levels = balls.levels.data();
    scene.particles = &balls.view;
    scene.particleColor = mode == PictureView::level  ? view::ParticleColor::level
                          : mode == PictureView::elfs ? view::ParticleColor::featureSize
                                                      : view::ParticleColor::temperature;
    scene.featureSizes = balls.sizes.data();
    scene.levelCounts = {};
    for (int i = 0; i < all.count; ++i) ++scene.levelCounts[all.levels[i]];
    // One scale for all pictures, in whole spacings.
    if (sizes && !(view.featureHigh > 0) && all.count > 0)
        view.featureHigh = spacing * std::ceil(*std::max_element(sizes, sizes + all.count) / spacing);
}

Pictures::Pictures(const scene::Scene& scene, const scene::SceneMeshes& meshes, PictureSize size, bool cut)
    : state_(std::make_unique<State>()) {
    State& s = *state_;
    s.spacing = scene.world.particleSpacing, s.cut = cut;
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

void Pictures::take(thawWorld* world, PictureView mode, const std::string& caption, const std::string& path) {
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
    s.view.mode = mode == PictureView::temperature ? view::ViewMode::temperature
                  : mode == PictureView::phase     ? view::ViewMode::phase
                                                   : view::ViewMode::shaded;
    s.scene.particles = nullptr;
    if (mode == PictureView::particles || mode == PictureView::level || mode == PictureView::elfs) {
        s.scene.surface = {};
        s.gatherBalls(world, mode);
    }
    std::string error;
    std::optional<view::Image> image = s.renderer->capture(s.scene, s.view, error);
    if (!image) throw RunError("no picture: " + oneLine(error, 300));
    if (!view::writePng(path, *image, error)) throw RunError(oneLine(path, 400) + ": " + oneLine(error, 200));
    s.taken.push_back({std::move(*image), caption});
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
