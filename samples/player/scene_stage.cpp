// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "scene_stage.h"

#include <algorithm>
#include <numbers>

namespace thaw::scene {

namespace {
// Own normals for flat shapes: averaged ones would make a box look like a pillow.
std::shared_ptr<const view::TriangleMesh> drawable(const Shape& shape, const TriMesh& mesh) {
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

std::string keyOf(const Shape& s, const std::string& directory) {
    std::string key = shapeName(s.type);
    for (const float f : {s.size.x, s.size.y, s.size.z, s.radius, s.height, s.tubeRadius}) key += " " + shortest(f);
    return s.type == ShapeType::mesh ? key + " " + s.meshFile + " " + directory : key;
}

view::MaterialLook lookOf(const Material& material) {
    view::MaterialLook look = view::materialLook(material.preset);
    look.color = material.def.color;
    return look;
}
} // namespace

std::shared_ptr<const view::TriangleMesh> DrawnMeshes::of(const Shape& shape, const TriMesh& mesh,
                                                          const std::string& directory) {
    std::shared_ptr<const view::TriangleMesh>& found = known_[keyOf(shape, directory)];
    if (!found) found = drawable(shape, mesh);
    return found;
}

bool isOfParticles(PictureView view) {
    switch (view) {
    case PictureView::particles:
    case PictureView::level:
    case PictureView::elfs:
    case PictureView::velocity:
    case PictureView::exposure:
    case PictureView::absorptivity:
        return true;
    default:
        return false;
    }
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

view::Scene stageOf(const Scene& scene, const SceneMeshes& meshes, DrawnMeshes& drawn) {
    view::Scene out;
    const auto instance = [&](const Shape& shape, const TriMesh& mesh, const Placement& placement,
                              const thawVec3& color) {
        view::MeshInstance made;
        made.mesh = drawn.of(shape, mesh, scene.directory);
        made.position = placement.position;
        made.rotation = placement.rotation;
        made.scale = placement.scale;
        made.color = color;
        out.meshes.push_back(made);
    };
    out.splatSpacing = scene.world.particleSpacing;
    for (const Material& material : scene.materials) out.materials.push_back(lookOf(material));
    out.floor.visible = false;
    for (size_t i = 0; i < scene.colliders.size(); ++i) {
        const Collider& c = scene.colliders[i];
        if (!c.visible) continue;
        if (c.shape.type != ShapeType::plane) {
            instance(c.shape, meshes.colliders[i], c.placement, c.color);
            continue;
        }
        const thawVec3 normal = rotate(c.placement.rotation, {0, 1, 0});
        if (!out.floor.visible && normal.y > 0.9999f) {
            out.floor.visible = true;
            out.floor.height = c.placement.position.y;
            out.floor.color = c.color;
        } else {
            view::MeshInstance wall;
            wall.mesh = drawn.plane();
            wall.position = c.placement.position;
            wall.rotation = c.placement.rotation;
            wall.color = c.color;
            out.meshes.push_back(wall);
        }
    }
    for (size_t i = 0; i < scene.props.size(); ++i)
        instance(scene.props[i].shape, meshes.props[i], scene.props[i].placement, scene.props[i].color);
    for (const HeatSource& h : scene.heatSources) {
        if (!h.enabled || h.visual == SourceVisual::none || h.type == thawHeatSource_directional) continue;
        view::Glow glow;
        glow.position = h.position;
        // A heat lamp of 600 W is mostly infrared: as light it would burn the picture out.
        glow.power = std::min(h.power, 30.0f);
        glow.radius = h.radius;
        glow.shape = h.visual == SourceVisual::flame ? view::GlowShape::flame : view::GlowShape::ball;
        out.glows.push_back(glow);
    }
    out.key.direction = scene.look.sunDirection;
    return out;
}

std::shared_ptr<const view::TriangleMesh> DrawnMeshes::plane() {
    std::shared_ptr<const view::TriangleMesh>& found = known_["plane"];
    if (!found) found = std::make_shared<view::TriangleMesh>(view::makePlane(1.0f));
    return found;
}

std::vector<view::Region> regionsOf(const Scene& scene, const SceneMeshes& meshes) {
    std::vector<view::Region> out;
    const auto add = [&](std::vector<view::Region> more) { out.insert(out.end(), more.begin(), more.end()); };
    const auto place = [&](int collider) {
        return collider < 0 ? Placement{} : scene.colliders[size_t(collider)].placement;
    };
    for (const Path& path : scene.paths) {
        thawPathDef def = path.def;
        def.points = path.points.data(), def.pointCount = int32_t(path.points.size());
        const Placement at = place(path.collider);
        if (def.enabled) add(view::pathRegions(def, at.position, at.rotation));
    }
    for (size_t i = 0; i < scene.shapes.size(); ++i) {
        const FillShape& shape = scene.shapes[i];
        const FillShapeDef made(shape, meshes.shapes[i]);
        const Placement at = place(shape.collider);
        if (made.def.enabled) add(view::shapeRegions(made.def, at.position, at.rotation));
    }
    return out;
}

TemperatureRange temperatureRangeOf(const Scene& scene) {
    TemperatureRange r{scene.world.ambientTemperature, scene.world.ambientTemperature};
    for (const Body& body : scene.bodies) {
        const float start = std::isnan(body.temperature) ? scene.world.ambientTemperature : body.temperature;
        r.low = std::min(r.low, start);
        r.high = std::max({r.high, start, scene.materials[size_t(body.material)].def.liquidus + 25.0f});
        for (const Part& part : body.parts)
            r.high = std::max(r.high, scene.materials[size_t(part.material)].def.liquidus + 25.0f);
    }
    return r;
}

view::Camera viewCamera(const Camera& camera) {
    view::Camera out;
    out.eye = camera.eye, out.target = camera.target;
    out.fieldOfView = camera.fieldOfViewDegrees * std::numbers::pi_v<float> / 180.0f;
    return out;
}

} // namespace thaw::scene
