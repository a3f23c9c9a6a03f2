// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "model/pick.h"

#include <embree3/rtcore.h>

#include <cmath>
#include <cstring>
#include <map>
#include <stdexcept>

namespace thaw::editor {

namespace {

thawVec3 minus(thawVec3 a, thawVec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
float dot(thawVec3 a, thawVec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
thawVec3 along(const Ray& r, float t) {
    return {r.origin.x + t * r.direction.x, r.origin.y + t * r.direction.y, r.origin.z + t * r.direction.z};
}
thawVec3 unit(thawVec3 v) {
    const float l = std::sqrt(dot(v, v));
    return l > 0 ? thawVec3{v.x / l, v.y / l, v.z / l} : thawVec3{0, 1, 0};
}

struct Found {
    float t;
    thawVec3 normal;
    uint32_t triangle;
};

/// Triangles that rays can be shot at.
class Triangles {
public:
    Triangles(RTCDevice device, const float* vertices, size_t vertexCount, const uint32_t* indices, size_t count) {
        if (count == 0) return;
        scene_ = rtcNewScene(device);
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
        void* v = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                          vertexCount);
        void* i =
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), count);
        if (v && i) {
            std::memcpy(v, vertices, 3 * sizeof(float) * vertexCount);
            std::memcpy(i, indices, 3 * sizeof(uint32_t) * count);
            rtcCommitGeometry(geometry);
            rtcAttachGeometry(scene_, geometry);
        }
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    ~Triangles() {
        if (scene_) rtcReleaseScene(scene_);
    }
    Triangles(const Triangles&) = delete;
    Triangles& operator=(const Triangles&) = delete;

    std::optional<Found> cast(const Ray& ray) const {
        if (!scene_) return {};
        RTCRayHit q{};
        q.ray.org_x = ray.origin.x, q.ray.org_y = ray.origin.y, q.ray.org_z = ray.origin.z;
        q.ray.dir_x = ray.direction.x, q.ray.dir_y = ray.direction.y, q.ray.dir_z = ray.direction.z;
        q.ray.tfar = INFINITY, q.ray.mask = unsigned(-1);
        q.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene_, &context, &q);
        if (q.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
        return Found{q.ray.tfar, unit({q.hit.Ng_x, q.hit.Ng_y, q.hit.Ng_z}), q.hit.primID};
    }

private:
    RTCScene scene_ = nullptr;
};

} // namespace

struct Picker::State {
    RTCDevice device = rtcNewDevice(nullptr);
    std::shared_ptr<const scene::Scene> scene;
    std::shared_ptr<const scene::SceneMeshes> meshes;
    std::vector<scene::Placement> placements;
    std::vector<std::unique_ptr<Triangles>> colliders, props;
    std::unique_ptr<Triangles> melt;
    std::vector<int> bodies; // of each triangle of the melt

    ~State() {
        melt.reset(), colliders.clear(), props.clear();
        if (device) rtcReleaseDevice(device);
    }

    static std::optional<Found> placed(const Triangles& triangles, const scene::Placement& at, const Ray& ray) {
        const thawQuat back{-at.rotation.x, -at.rotation.y, -at.rotation.z, at.rotation.w};
        const thawVec3 o = scene::rotate(back, minus(ray.origin, at.position));
        const Ray local{{o.x / at.scale, o.y / at.scale, o.z / at.scale}, scene::rotate(back, ray.direction)};
        std::optional<Found> found = triangles.cast(local);
        if (found) found->t *= at.scale, found->normal = scene::rotate(at.rotation, found->normal);
        return found;
    }
    static std::optional<Found> plane(const scene::Placement& at, const Ray& ray) {
        const thawVec3 n = scene::rotate(at.rotation, {0, 1, 0});
        const float down = dot(n, ray.direction);
        if (std::fabs(down) < 1e-6f) return {};
        const float t = dot(n, minus(at.position, ray.origin)) / down;
        if (!(t > 0)) return {};
        return Found{t, n, 0};
    }
};

Picker::Picker() : state_(std::make_unique<State>()) {
    if (!state_->device) throw std::runtime_error("Embree does not start");
}
Picker::~Picker() = default;

void Picker::setScene(std::shared_ptr<const scene::Scene> scene, std::shared_ptr<const scene::SceneMeshes> meshes,
                      const std::vector<scene::Placement>& placements) {
    State& s = *state_;
    if (meshes != s.meshes) {
        const auto build = [&](const std::vector<scene::TriMesh>& from) {
            std::vector<std::unique_ptr<Triangles>> out;
            for (const scene::TriMesh& m : from)
                out.push_back(std::make_unique<Triangles>(s.device, m.vertices.data(), m.vertexCount(),
                                                          m.indices.data(), m.triangleCount()));
            return out;
        };
        s.colliders.clear(), s.props.clear();
        if (meshes) s.colliders = build(meshes->colliders), s.props = build(meshes->props);
    }
    s.scene = std::move(scene), s.meshes = std::move(meshes), s.placements = placements;
}

void Picker::setMelt(const thawSurfaceView& surface, const std::vector<int>& bodyOfIndex) {
    State& s = *state_;
    s.melt = std::make_unique<Triangles>(s.device, surface.positions, size_t(surface.vertexCount), surface.indices,
                                         size_t(surface.triangleCount));
    s.bodies.resize(size_t(surface.triangleCount));
    for (size_t i = 0; i < s.bodies.size(); ++i) {
        const size_t body = surface.bodies[surface.indices[3 * i]];
        s.bodies[i] = body < bodyOfIndex.size() ? bodyOfIndex[body] : -1;
    }
}

std::optional<Hit> Picker::cast(const Ray& ray, bool hidden) const {
    const State& s = *state_;
    std::optional<Hit> best;
    const auto offer = [&](const std::optional<Found>& found, Item item) {
        if (!found || !(found->t > 0) || (best && best->distance <= found->t)) return;
        thawVec3 n = found->normal;
        if (dot(n, ray.direction) > 0) n = {-n.x, -n.y, -n.z};
        best = Hit{item, along(ray, found->t), n, found->t};
    };
    if (s.melt)
        if (const std::optional<Found> found = s.melt->cast(ray)) {
            const int body = s.bodies[found->triangle];
            offer(found, body < 0 ? Item{} : Item{Kind::body, body});
        }
    if (!s.scene || !s.meshes) return best;
    for (size_t i = 0; i < s.scene->colliders.size() && i < s.colliders.size(); ++i) {
        const scene::Collider& c = s.scene->colliders[i];
        if (!c.visible && !hidden) continue;
        const scene::Placement& at = i < s.placements.size() ? s.placements[i] : c.placement;
        const Item item{Kind::collider, int(i)};
        offer(c.shape.type == scene::ShapeType::plane ? State::plane(at, ray) : State::placed(*s.colliders[i], at, ray),
              item);
    }
    for (size_t i = 0; i < s.scene->props.size() && i < s.props.size(); ++i)
        offer(State::placed(*s.props[i], s.scene->props[i].placement, ray), {Kind::prop, int(i)});
    return best;
}

} // namespace thaw::editor
