// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "model/live_world.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace thaw::editor {

namespace {

constexpr float kStep = 1.0f / 60;
constexpr float kHandSpeed = 0.6f; // m/s, of a collider that is dragged: some 5 spacings a step at the finest
constexpr float kHandTurn = 6.0f;  // rad/s

void check(thawResult result, const scene::Scene& scene, const std::string& place, const thawWorld* world) {
    if (result == thawResult_ok) return;
    const std::string text = thawWorld_GetLastError(world);
    throw scene::InputError(scene::oneLine(scene.file.empty() ? scene.name : scene.file, 400) + ": at " + place + ": " +
                            (text.empty() ? thawResultString(result) : text));
}

std::string placeOf(const char* list, size_t i) { return std::string("/") + list + "/" + std::to_string(i); }

float dot(const thawQuat& a, const thawQuat& b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }

/// Some of the way from one turn to another, the short way round.
thawQuat turned(const thawQuat& from, thawQuat to, float share) {
    if (dot(from, to) < 0) to = {-to.x, -to.y, -to.z, -to.w};
    thawQuat q{from.x + share * (to.x - from.x), from.y + share * (to.y - from.y), from.z + share * (to.z - from.z),
               from.w + share * (to.w - from.w)};
    const float l = std::sqrt(dot(q, q));
    return l > 0 ? thawQuat{q.x / l, q.y / l, q.z / l, q.w / l} : to;
}

/// In the order of the list after, what is in the list before; the rest of that is given to gone.
template <class Id, class K, class Gone>
std::vector<Id> reordered(const std::vector<Id>& before, const std::vector<K>& kept, Gone&& gone) {
    std::vector<Id> out(kept.size());
    std::vector<bool> stays(before.size(), false);
    for (size_t i = 0; i < kept.size(); ++i)
        if (kept[i].was >= 0) out[i] = before[size_t(kept[i].was)], stays[size_t(kept[i].was)] = true;
    for (size_t i = 0; i < before.size(); ++i)
        if (!stays[i]) gone(before[i]);
    return out;
}

} // namespace

void LiveWorld::clear() {
    made_ = {};
    scene_.reset(), meshes_.reset(), driven_.clear();
}

void LiveWorld::build(std::shared_ptr<const scene::Scene> scene, std::shared_ptr<const scene::SceneMeshes> meshes) {
    clear();
    made_ = scene::buildWorld(*scene, *meshes, threads_, true);
    scene_ = std::move(scene), meshes_ = std::move(meshes);
    driven_.assign(scene_->colliders.size(), false);
}

bool LiveWorld::follow(std::shared_ptr<const scene::Scene> next, std::shared_ptr<const scene::SceneMeshes> meshes,
                       bool driven) {
    const Changes changes = changesBetween(*scene_, *next);
    if (changes.capacity) return false;
    thawWorld* w = world();
    if (changes.world) {
        const scene::WorldSettings& s = next->world;
        check(thawWorld_SetGravity(w, s.gravity), *next, "/world/gravity", w);
        check(thawWorld_SetAmbient(w, s.ambientTemperature, s.convection), *next, "/world/ambientTemperature", w);
        check(thawWorld_SetThermalTimeScale(w, s.thermalTimeScale), *next, "/world/thermalTimeScale", w);
    }
    refused_.clear();
    // In this order what is made finds what it refers to.
    followMaterials(*next, changes);
    followColliders(*next, *meshes, changes, driven);
    followBodies(*next, *meshes, changes);
    followControls(*next, *meshes, changes);
    scene_ = std::move(next), meshes_ = std::move(meshes);
    if (!refused_.empty()) throw scene::InputError(refused_);
    return true;
}

template <class F> void LiveWorld::attempt(F&& part) {
    try {
        part();
    } catch (const scene::InputError& e) {
        if (refused_.empty()) refused_ = e.what();
    }
}

void LiveWorld::followMaterials(const scene::Scene& next, const Changes& changes) {
    // Materials live as long as their world: what is gone is not used any more.
    made_.materials = reordered(made_.materials, changes.materials, [](thawMaterialId) {});
    for (size_t i = 0; i < changes.materials.size(); ++i)
        attempt([&] {
            thawMaterialId& id = made_.materials[i];
            if (id.index1 == 0)
                id = scene::createMaterial(world(), next, i);
            else if (changes.materials[i].changed)
                check(thawMaterial_Set(world(), id, &next.materials[i].def), next, placeOf("materials", i), world());
        });
}

void LiveWorld::followColliders(const scene::Scene& next, const scene::SceneMeshes& meshes, const Changes& changes,
                                bool driven) {
    made_.colliders =
        reordered(made_.colliders, changes.colliders, [&](thawColliderId id) { thawDestroyCollider(world(), id); });
    made_.colliderReports.resize(changes.colliders.size());
    std::vector<bool> way(changes.colliders.size(), false);
    for (size_t i = 0; i < changes.colliders.size(); ++i) {
        const KeptCollider& kept = changes.colliders[i];
        way[i] = kept.was >= 0 && driven_[size_t(kept.was)];
        attempt([&] {
            thawColliderId& id = made_.colliders[i];
            const scene::Collider& c = next.colliders[i];
            if (kept.changed && id.index1) thawDestroyCollider(world(), std::exchange(id, {}));
            if (id.index1 == 0) {
                id = scene::createCollider(world(), next, meshes, i, &made_.colliderReports[i]);
                way[i] = false;
                return;
            }
            if (kept.moved && driven)
                way[i] = true;
            else if (kept.moved) {
                check(thawCollider_Teleport(world(), id, c.placement.position, c.placement.rotation), next,
                      placeOf("colliders", i), world());
                way[i] = false;
            }
            if (kept.heat)
                check(thawCollider_SetHeat(world(), id, c.temperature, c.contactConductance), next,
                      placeOf("colliders", i), world());
            if (kept.surface)
                check(thawCollider_SetSurface(world(), id, c.adhesive, c.occluder, c.slipLength, c.friction), next,
                      placeOf("colliders", i), world());
        });
    }
    driven_ = std::move(way);
}

void LiveWorld::followBodies(const scene::Scene& next, const scene::SceneMeshes& meshes, const Changes& changes) {
    made_.bodies = reordered(made_.bodies, changes.bodies, [&](thawBodyId id) { thawDestroyBody(world(), id); });
    made_.bodyReports.resize(changes.bodies.size());
    // Room first, and then what takes it.
    for (size_t i = 0; i < changes.bodies.size(); ++i)
        if (thawBodyId& id = made_.bodies[i]; changes.bodies[i].changed && id.index1)
            thawDestroyBody(world(), std::exchange(id, {}));
    for (size_t i = 0; i < changes.bodies.size(); ++i)
        attempt([&] {
            thawBodyId& id = made_.bodies[i];
            if (id.index1 == 0)
                id = scene::createBody(world(), next, meshes, i, made_.materials, &made_.bodyReports[i]);
            else
                scene::paintBody(world(), next, i, id, size_t(changes.bodies[i].paintFrom));
        });
}

void LiveWorld::followControls(const scene::Scene& next, const scene::SceneMeshes& meshes, const Changes& changes) {
    made_.heatSources = reordered(made_.heatSources, changes.heatSources,
                                  [&](thawHeatSourceId id) { thawDestroyHeatSource(world(), id); });
    for (size_t i = 0; i < changes.heatSources.size(); ++i)
        attempt([&] {
            thawHeatSourceId& id = made_.heatSources[i];
            if (id.index1 == 0) {
                id = scene::createSource(world(), next, i);
            } else if (changes.heatSources[i].changed) {
                const thawHeatSourceDef def = scene::sourceDef(next.heatSources[i]);
                check(thawHeatSource_Set(world(), id, &def), next, placeOf("heatSources", i), world());
            }
        });
    // What moved with a collider that came anew went with the old one: it is stale.
    made_.paths = reordered(made_.paths, changes.paths, [&](thawPathId id) { thawDestroyPath(world(), id); });
    for (size_t i = 0; i < changes.paths.size(); ++i)
        attempt([&] {
            thawPathId& id = made_.paths[i];
            if (id.index1 && !changes.paths[i].changed) return;
            const thawPathDef def = scene::pathDef(next.paths[i], made_.colliders);
            const thawResult set = id.index1 ? thawPath_Set(world(), id, &def) : thawResult_staleId;
            if (set == thawResult_staleId)
                id = {}, id = scene::createPath(world(), next, i, made_.colliders);
            else
                check(set, next, placeOf("paths", i), world());
        });
    made_.shapes = reordered(made_.shapes, changes.shapes, [&](thawShapeId id) { thawDestroyShape(world(), id); });
    for (size_t i = 0; i < changes.shapes.size(); ++i)
        attempt([&] {
            thawShapeId& id = made_.shapes[i];
            if (id.index1 && !changes.shapes[i].changed) return;
            scene::FillShapeDef fill(next.shapes[i], meshes.shapes[i]);
            if (next.shapes[i].collider >= 0) fill.def.collider = made_.colliders[size_t(next.shapes[i].collider)];
            const thawResult set = id.index1 ? thawShape_Set(world(), id, &fill.def) : thawResult_staleId;
            if (set == thawResult_staleId)
                id = {}, id = scene::createShape(world(), next, meshes, i, made_.colliders);
            else
                check(set, next, placeOf("shapes", i), world());
        });
}

LiveWorld::Standing LiveWorld::standing() const {
    return {scene_,      meshes_,      made_.materials,   made_.bodies,          made_.colliders, made_.heatSources,
            made_.paths, made_.shapes, made_.bodyReports, made_.colliderReports, driven_};
}

void LiveWorld::stand(const Standing& s) {
    scene_ = s.scene, meshes_ = s.meshes;
    made_.materials = s.materials, made_.bodies = s.bodies, made_.colliders = s.colliders;
    made_.heatSources = s.heatSources, made_.paths = s.paths, made_.shapes = s.shapes;
    made_.bodyReports = s.bodyReports, made_.colliderReports = s.colliderReports;
    driven_ = s.driven;
}

scene::Placement LiveWorld::placementOf(size_t collider) const {
    scene::Placement out = scene_->colliders[collider].placement;
    thawCollider_GetTransform(world(), made_.colliders[collider], &out.position, &out.rotation);
    return out;
}

void LiveWorld::drive() {
    for (size_t i = 0; i < driven_.size(); ++i) {
        if (!driven_[i]) continue;
        const scene::Placement at = placementOf(i), to = scene_->colliders[i].placement;
        const thawVec3 way{to.position.x - at.position.x, to.position.y - at.position.y, to.position.z - at.position.z};
        const float far = std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z);
        const float turn = 2 * std::acos(std::min(1.0f, std::fabs(dot(at.rotation, to.rotation))));
        const float steps = std::max({1.0f, far / (kHandSpeed * kStep), turn / (kHandTurn * kStep)});
        const float share = 1 / steps;
        const bool there = steps <= 1;
        const thawVec3 position = there ? to.position
                                        : thawVec3{at.position.x + share * way.x, at.position.y + share * way.y,
                                                   at.position.z + share * way.z};
        thawCollider_SetTransform(world(), made_.colliders[i], position,
                                  there ? to.rotation : turned(at.rotation, to.rotation, share));
        driven_[i] = !there;
    }
}

uint32_t LiveWorld::step(const thawBudget& budget) {
    drive();
    return thawWorld_Step(world(), kStep, &budget);
}

} // namespace thaw::editor
