// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "scene.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace thaw::scene {

namespace {
std::string messageAt(const Scene& scene, const std::string& place, const std::string& what) {
    return oneLine(scene.file.empty() ? scene.name : scene.file, 400) + ": at " + place + ": " + oneLine(what, 300);
}

std::string placeOf(const char* list, size_t index) { return std::string("/") + list + "/" + std::to_string(index); }

std::string rounded(double count) {
    char text[40];
    std::snprintf(text, sizeof text, count < 1e9 ? "%.0f" : "%.2g", count);
    return text;
}

std::string resolved(const std::string& file, const std::string& directory) {
    const std::filesystem::path path(file);
    return path.is_absolute() || directory.empty() ? file : (std::filesystem::path(directory) / path).string();
}

// The particles that a scene asks for, refused here because the library would first take the memory for them.
int capacityFor(const Scene& scene, const SceneMeshes& meshes) {
    const float spacing = scene.world.particleSpacing;
    double total = 0.0, largest = -1.0;
    size_t largestBody = 0;
    for (size_t b = 0; b < scene.bodies.size(); ++b) {
        const double count = estimateParticles(meshes.bodies[b], scene.bodies[b].placement.scale, spacing);
        total += count;
        if (count > largest) largest = count, largestBody = b;
    }
    const int limit = scene.world.maxParticles ? scene.world.maxParticles : kMaxParticles;
    if (total > limit) {
        std::string hint;
        const Bounds bounds = boundsOf(meshes.bodies[largestBody]);
        const float scale = scene.bodies[largestBody].placement.scale;
        const float extent = scale * std::max({bounds.upper.x - bounds.lower.x, bounds.upper.y - bounds.lower.y,
                                               bounds.upper.z - bounds.lower.z});
        if (extent > 2.0f)
            hint = "; " + placeOf("bodies", largestBody) + " is " + shortest(extent) +
                   " m long: if it is in millimetres give it scale 0.001";
        // 1.02: room for the difference between a volume and a filled lattice.
        const double needed = spacing * std::cbrt(1.02 * total / limit);
        char enough[40];
        std::snprintf(enough, sizeof enough, "%.3g", needed);
        throw InputError(messageAt(scene, "/world/particleSpacing",
                                   shortest(spacing) + " m gives about " + rounded(total) +
                                       " particles, the maximum is " + std::to_string(limit) + " (" + enough +
                                       " m would do" + hint + ")"));
    }
    if (scene.world.maxParticles) return scene.world.maxParticles;
    return int(std::clamp(1.1 * total + 256.0, 8.0, double(kMaxParticles)));
}

[[noreturn]] void refused(const Scene& scene, const std::string& place, thawResult result, const thawWorld* world) {
    const std::string text = thawWorld_GetLastError(world);
    const std::string what = text.empty() ? thawResultString(result) : text;
    if (result == thawResult_outOfMemory || result == thawResult_internal)
        throw std::runtime_error(messageAt(scene, place, what));
    throw InputError(messageAt(scene, place, what));
}
} // namespace

TriMesh makeShape(const Shape& shape, const std::string& directory, const MeshReader& read) {
    switch (shape.type) {
    case ShapeType::plane:
        return {};
    case ShapeType::box:
        return makeBox(shape.size);
    case ShapeType::sphere:
        return makeSphere(shape.radius);
    case ShapeType::cylinder:
        return makeCylinder(shape.radius, shape.height);
    case ShapeType::cone:
        return makeCone(shape.radius, shape.height);
    case ShapeType::torus:
        return makeTorus(shape.radius, shape.tubeRadius);
    case ShapeType::mesh:
        return read(resolved(shape.meshFile, directory));
    }
    return {};
}

SceneMeshes loadMeshes(const Scene& scene, const MeshReader& read) {
    SceneMeshes out;
    auto load = [&](const char* list, size_t index, const Shape& shape) {
        try {
            return makeShape(shape, scene.directory, read);
        } catch (const InputError&) {
            throw;
        } catch (const std::exception& e) {
            throw InputError(
                messageAt(scene, placeOf(list, index) + "/mesh", oneLine(shape.meshFile, 120) + ": " + e.what()));
        }
    };
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
        out.bodies.push_back(load("bodies", i, scene.bodies[i].shape));
        std::vector<TriMesh>& parts = out.parts.emplace_back();
        for (const Part& part : scene.bodies[i].parts) {
            TriMesh& mesh = parts.emplace_back();
            if (part.depth > 0) continue;
            mesh = load("bodies", i, part.shape);
            const Placement& p = part.placement;
            for (size_t v = 0; v < mesh.vertices.size(); v += 3) {
                float* x = &mesh.vertices[v];
                const thawVec3 y = rotate(p.rotation, {p.scale * x[0], p.scale * x[1], p.scale * x[2]});
                x[0] = p.position.x + y.x, x[1] = p.position.y + y.y, x[2] = p.position.z + y.z;
            }
        }
    }
    for (size_t i = 0; i < scene.colliders.size(); ++i)
        out.colliders.push_back(load("colliders", i, scene.colliders[i].shape));
    for (size_t i = 0; i < scene.shapes.size(); ++i)
        out.shapes.push_back(scene.shapes[i].contours.empty() ? load("shapes", i, scene.shapes[i].shape) : TriMesh{});
    for (size_t i = 0; i < scene.props.size(); ++i) out.props.push_back(load("props", i, scene.props[i].shape));
    return out;
}

double estimateParticles(const TriMesh& mesh, float scale, float spacing) {
    return std::abs(volumeOf(mesh)) * std::pow(double(scale) / spacing, 3.0);
}

thawHeatSourceDef sourceDef(const HeatSource& h) {
    thawHeatSourceDef d;
    thawInitHeatSourceDef(&d);
    d.position = h.position;
    d.power = h.power;
    d.radius = h.radius;
    d.enabled = h.enabled;
    d.type = h.type;
    d.rotation = h.rotation;
    d.size = {0.5f * h.size.x, d.size.y, 0.5f * h.size.z};
    d.temperature = h.temperature;
    d.emissivity = h.emissivity;
    d.irradiance = h.irradiance;
    return d;
}

thawPathDef pathDef(const Path& path, const std::vector<thawColliderId>& colliders) {
    thawPathDef d = path.def;
    d.points = path.points.data(), d.pointCount = int32_t(path.points.size());
    if (path.collider >= 0) d.collider = colliders[size_t(path.collider)];
    return d;
}

FillShapeDef::FillShapeDef(const FillShape& shape, const TriMesh& mesh) : def(shape.def) {
    for (const std::vector<thawVec3>& contour : shape.contours) {
        points_.insert(points_.end(), contour.begin(), contour.end());
        sizes_.push_back(int32_t(contour.size()));
    }
    def.points = points_.data(), def.contourSizes = sizes_.data(), def.contourCount = int32_t(sizes_.size());
    if (!sizes_.empty()) return;
    def.mesh = mesh.view();
    def.position = shape.placement.position, def.rotation = shape.placement.rotation;
    def.scale = shape.placement.scale;
}

thawMaterialId createMaterial(thawWorld* world, const Scene& scene, size_t i) {
    thawMaterialId id{};
    const thawResult result = thawCreateMaterial(world, &scene.materials[i].def, &id);
    if (result != thawResult_ok) refused(scene, placeOf("materials", i), result, world);
    return id;
}

thawColliderId createCollider(thawWorld* world, const Scene& scene, const SceneMeshes& meshes, size_t i,
                              thawMeshReport* report) {
    const Collider& c = scene.colliders[i];
    thawColliderType type = thawCollider_mesh;
    thawVec3 size{};
    const float s = c.placement.scale;
    if (c.shape.type == ShapeType::plane) type = thawCollider_plane;
    if (c.shape.type == ShapeType::box) {
        type = thawCollider_box;
        size = {0.5f * s * c.shape.size.x, 0.5f * s * c.shape.size.y, 0.5f * s * c.shape.size.z};
    }
    if (c.shape.type == ShapeType::sphere) {
        type = thawCollider_sphere;
        size.x = s * c.shape.radius;
    }
    thawColliderDef d;
    thawInitColliderDef(&d, type);
    d.position = c.placement.position;
    d.rotation = c.placement.rotation;
    if (type == thawCollider_box) d.size = size;
    if (type == thawCollider_sphere) d.size.x = size.x;
    if (type == thawCollider_mesh) {
        d.mesh = meshes.colliders[i].view();
        d.scale = s;
    }
    d.adhesive = c.adhesive;
    d.slipLength = c.slipLength;
    d.friction = c.friction;
    d.temperature = c.temperature;
    d.contactConductance = c.contactConductance;
    d.occluder = c.occluder;
    thawColliderId id{};
    const thawResult result = thawCreateCollider(world, &d, &id, report);
    if (result != thawResult_ok) refused(scene, placeOf("colliders", i), result, world);
    return id;
}

void paintBody(thawWorld* world, const Scene& scene, size_t i, thawBodyId id, size_t first) {
    const Body& b = scene.bodies[i];
    for (size_t k = first; k < b.paint.size(); ++k) {
        const Paint& paint = b.paint[k];
        thawResult painted = thawResult_ok;
        if (!std::isnan(paint.temperature))
            painted = thawBody_PaintTemperature(world, id, &paint.brush, paint.temperature, nullptr);
        if (painted == thawResult_ok && !std::isnan(paint.absorptivity))
            painted = thawBody_PaintAbsorptivity(world, id, &paint.brush, paint.absorptivity, nullptr);
        if (painted != thawResult_ok) refused(scene, placeOf("bodies", i), painted, world);
    }
}

thawBodyId createBody(thawWorld* world, const Scene& scene, const SceneMeshes& meshes, size_t i,
                      const std::vector<thawMaterialId>& materials, thawMeshReport* report) {
    const Body& b = scene.bodies[i];
    thawBodyDef d;
    thawInitBodyDef(&d);
    d.material = materials[size_t(b.material)];
    d.mesh = meshes.bodies[i].view();
    d.position = b.placement.position;
    d.rotation = b.placement.rotation;
    d.scale = b.placement.scale;
    d.temperature = b.temperature;
    std::vector<thawBodyPart> parts;
    for (size_t k = 0; k < b.parts.size(); ++k) {
        thawBodyPart& part = parts.emplace_back();
        part = {};
        part.material = materials[size_t(b.parts[k].material)];
        part.depth = b.parts[k].depth;
        if (part.depth <= 0) part.mesh = meshes.parts[i][k].view();
    }
    d.parts = parts.data(), d.partCount = int32_t(parts.size());
    d.anchored = b.anchored;
    d.coarsestLevel = b.coarsestLevel;
    thawBodyId id{};
    const thawResult result = thawCreateBody(world, &d, &id, report);
    if (result != thawResult_ok) refused(scene, placeOf("bodies", i), result, world);
    paintBody(world, scene, i, id, 0);
    return id;
}

thawHeatSourceId createSource(thawWorld* world, const Scene& scene, size_t i) {
    const thawHeatSourceDef d = sourceDef(scene.heatSources[i]);
    thawHeatSourceId id{};
    const thawResult result = thawCreateHeatSource(world, &d, &id);
    if (result != thawResult_ok) refused(scene, placeOf("heatSources", i), result, world);
    return id;
}

thawPathId createPath(thawWorld* world, const Scene& scene, size_t i, const std::vector<thawColliderId>& colliders) {
    const thawPathDef d = pathDef(scene.paths[i], colliders);
    thawPathId id{};
    const thawResult result = thawCreatePath(world, &d, &id);
    if (result != thawResult_ok) refused(scene, placeOf("paths", i), result, world);
    return id;
}

thawShapeId createShape(thawWorld* world, const Scene& scene, const SceneMeshes& meshes, size_t i,
                        const std::vector<thawColliderId>& colliders) {
    const FillShape& shape = scene.shapes[i];
    FillShapeDef fill(shape, meshes.shapes[i]);
    if (shape.collider >= 0) fill.def.collider = colliders[size_t(shape.collider)];
    thawShapeId id{};
    const thawResult result = thawCreateShape(world, &fill.def, &id);
    if (result != thawResult_ok) refused(scene, placeOf("shapes", i), result, world);
    return id;
}

SceneWorld buildWorld(const Scene& scene, const SceneMeshes& meshes, int threads, bool room) {
    SceneWorld out;
    thawWorldDef def;
    thawInitWorldDef(&def);
    const WorldSettings& w = scene.world;
    const int spare = room ? 32 : 0;
    def.particleSpacing = w.particleSpacing;
    def.maxParticles = capacityFor(scene, meshes);
    if (room && !w.maxParticles)
        def.maxParticles = std::min(kMaxParticles, def.maxParticles + std::max(def.maxParticles / 2, 20000));
    def.maxMaterials = std::min(255, std::max(1, int(scene.materials.size()) + spare));
    def.maxBodies = std::max(1, int(scene.bodies.size()) + spare);
    def.maxColliders = std::max(1, int(scene.colliders.size()) + spare);
    def.maxHeatSources = std::max(1, int(scene.heatSources.size()) + spare);
    def.maxPaths = std::max(1, int(scene.paths.size()) + spare);
    def.maxShapes = std::max(1, int(scene.shapes.size()) + spare);
    def.gravity = w.gravity;
    def.ambientTemperature = w.ambientTemperature;
    def.convection = w.convection;
    def.thermalTimeScale = w.thermalTimeScale;
    def.tasks.workerCount = threads;
    thawWorld* raw = nullptr;
    char message[256] = "";
    const thawResult made = thawCreateWorld(&def, &raw, message, sizeof message);
    if (made == thawResult_outOfMemory)
        throw std::runtime_error(messageAt(scene, "/world/maxParticles",
                                           "not enough memory for " + std::to_string(def.maxParticles) + " particles"));
    if (made != thawResult_ok)
        throw InputError(messageAt(scene, "/world", *message ? message : thawResultString(made)));
    out.world.reset(raw);

    for (size_t i = 0; i < scene.materials.size(); ++i) out.materials.push_back(createMaterial(raw, scene, i));
    for (size_t i = 0; i < scene.colliders.size(); ++i)
        out.colliders.push_back(createCollider(raw, scene, meshes, i, &out.colliderReports.emplace_back()));
    for (size_t i = 0; i < scene.bodies.size(); ++i)
        out.bodies.push_back(createBody(raw, scene, meshes, i, out.materials, &out.bodyReports.emplace_back()));
    for (size_t i = 0; i < scene.heatSources.size(); ++i) out.heatSources.push_back(createSource(raw, scene, i));
    for (size_t i = 0; i < scene.paths.size(); ++i) out.paths.push_back(createPath(raw, scene, i, out.colliders));
    for (size_t i = 0; i < scene.shapes.size(); ++i)
        out.shapes.push_back(createShape(raw, scene, meshes, i, out.colliders));
    return out;
}

} // namespace thaw::scene
