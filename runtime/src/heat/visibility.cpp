// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "heat/visibility.h"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <vector>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace thaw {
namespace {

// Embree asks for denormals to be flushed while it runs; the thread's mode is the host's and is put back.
class FlushDenormals {
public:
#if defined(__SSE2__)
    FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040u); } // FTZ, DAZ
    ~FlushDenormals() { _mm_setcsr(saved_); }
#else
    FlushDenormals() = default;
#endif
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

private:
    [[maybe_unused]] unsigned saved_ = 0;
};

// Boxes and spheres of the colliders.
struct Solid {
    bool box;
    Vec3 center, size; // sphere: radius in size.x
    Quat rotation;     // box: into the world
    Box bounds;
};

// A ray of any packet size that Embree hands to a callback.
struct Lane {
    RTCRayN* rays;
    unsigned n, i;
    Vec3 origin() const { return {RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)}; }
    Vec3 direction() const { return {RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)}; }
    float nearest() const { return RTCRayN_tnear(rays, n, i); }
    float farthest() const { return RTCRayN_tfar(rays, n, i); }
    void block() const { RTCRayN_tfar(rays, n, i) = -INFINITY; }
};

// Only entering counts, here and for triangles: a particle that lies a little inside of an obstacle looks out of it,
// and a source inside of one is behind its surface.
bool entersSphere(Vec3 o, Vec3 d, Vec3 center, float radius, float from, float to) {
    const Vec3 v = o - center;
    const float b = dot(v, d), disc = b * b - (dot(v, v) - radius * radius);
    if (disc < 0) return false;
    const float t = -b - std::sqrt(disc);
    return t > from && t < to;
}

bool entersBox(const Solid& s, Vec3 o, Vec3 d, float from, float to) {
    const Vec3 lo = rotate(conjugate(s.rotation), o - s.center), ld = rotate(conjugate(s.rotation), d);
    const float p[3] = {lo.x, lo.y, lo.z}, v[3] = {ld.x, ld.y, ld.z}, e[3] = {s.size.x, s.size.y, s.size.z};
    float enter = -INFINITY, leave = INFINITY;
    for (int a = 0; a < 3; ++a) {
        if (std::abs(v[a]) < 1e-12f) {
            if (std::abs(p[a]) >= e[a]) return false;
            continue;
        }
        const float t0 = (-e[a] - p[a]) / v[a], t1 = (e[a] - p[a]) / v[a];
        enter = std::max(enter, std::min(t0, t1)), leave = std::min(leave, std::max(t0, t1));
    }
    return enter < leave && enter > from && enter < to;
}

void solidBounds(const RTCBoundsFunctionArguments* a) {
    const Box& b = (*static_cast<const std::vector<Solid>*>(a->geometryUserPtr))[a->primID].bounds;
    *a->bounds_o = {b.lower.x, b.lower.y, b.lower.z, 0, b.upper.x, b.upper.y, b.upper.z, 0};
}

void solidOccluded(const RTCOccludedFunctionNArguments* a) {
    const Solid& s = (*static_cast<const std::vector<Solid>*>(a->geometryUserPtr))[a->primID];
    for (unsigned i = 0; i < a->N; ++i) {
        if (!a->valid[i]) continue;
        const Lane ray{a->ray, a->N, i};
        const bool hit =
            s.box ? entersBox(s, ray.origin(), ray.direction(), ray.nearest(), ray.farthest())
                  : entersSphere(ray.origin(), ray.direction(), s.center, s.size.x, ray.nearest(), ray.farthest());
        if (hit) ray.block();
    }
}

void frontFacesOnly(const RTCFilterFunctionNArguments* a) {
    for (unsigned i = 0; i < a->N; ++i) {
        if (!a->valid[i]) continue;
        const Vec3 d = Lane{a->ray, a->N, i}.direction();
        const Vec3 n{RTCHitN_Ng_x(a->hit, a->N, i), RTCHitN_Ng_y(a->hit, a->N, i), RTCHitN_Ng_z(a->hit, a->N, i)};
        if (dot(d, n) > 0) a->valid[i] = 0;
    }
}

void sphereBounds(const RTCBoundsFunctionArguments* a) {
    const Vec4& s = static_cast<const Vec4*>(a->geometryUserPtr)[a->primID];
    const float r = s.w * 1.0001f; // so that no rounding in the tree decides what a sphere's own test decides
    *a->bounds_o = {s.x - r, s.y - r, s.z - r, 0, s.x + r, s.y + r, s.z + r, 0};
}

void sphereOccluded(const RTCOccludedFunctionNArguments* a) {
    const Vec4& s = static_cast<const Vec4*>(a->geometryUserPtr)[a->primID];
    if (a->N == 8) {
        // The packets that cast() makes, in a form that compilers turn into vector code.
        RTCRay8& r = *reinterpret_cast<RTCRay8*>(a->ray);
        const float rr = s.w * s.w;
        float t[8], disc[8];
        for (int i = 0; i < 8; ++i) {
            const float x = r.org_x[i] - s.x, y = r.org_y[i] - s.y, z = r.org_z[i] - s.z;
            const float b = x * r.dir_x[i] + y * r.dir_y[i] + z * r.dir_z[i];
            disc[i] = b * b - (x * x + y * y + z * z - rr);
            t[i] = -b - std::sqrt(disc[i] > 0 ? disc[i] : 0.0f);
        }
        for (int i = 0; i < 8; ++i) {
            const bool hit = a->valid[i] && disc[i] >= 0 && t[i] > r.tnear[i] && t[i] < r.tfar[i];
            r.tfar[i] = hit ? -INFINITY : r.tfar[i];
        }
        return;
    }
    for (unsigned i = 0; i < a->N; ++i) {
        if (!a->valid[i]) continue;
        const Lane ray{a->ray, a->N, i};
        if (entersSphere(ray.origin(), ray.direction(), s.xyz(), s.w, ray.nearest(), ray.farthest())) ray.block();
    }
}

// The tree loses quality as the spheres move away from where it was built: refit only so often.
constexpr int kRefitsPerBuild = 32;
// Places kept for particles that come to the surface before the next build, as a share of the spheres.
constexpr float kSpare = 0.15f;
constexpr uint32_t kNoId = std::numeric_limits<uint32_t>::max();

} // namespace

struct Visibility::Impl {
    explicit Impl(Allocator& a) : spheres(a), ids(a), taken(a), keys(a), slots(a), unplaced(a) {}

    RTCDevice device = nullptr;
    RTCScene solidScene = nullptr, meltScene = nullptr;
    RTCGeometry melt = nullptr;
    tbb::task_arena arena{1, 1};

    std::vector<Solid> solids;
    struct Plane {
        Vec3 point, normal;
    };
    std::vector<Plane> planes;
    uint64_t version = 0;
    bool collidersKnown = false, anySolid = false;

    // Places of the tree. A place without a particle repeats the sphere of place 0: Embree drops what has no bounds,
    // and a refit could not bring it back.
    Array<Vec4> spheres;
    Array<uint32_t> ids;  // per place, kNoId when free
    Array<uint8_t> taken; // per place, in this call
    Array<uint32_t> keys; // open addressing: id
    Array<int> slots;     // and its place
    Array<int> unplaced;  // indices of spheres without a place yet
    int refitsSinceBuild = 0;
    int live = 0;

    size_t mask() const { return keys.size() - 1; }
    static size_t placesFor(size_t n) { return n + static_cast<size_t>(kSpare * static_cast<float>(n)) + 8; }
    static size_t tableFor(size_t places) {
        size_t size = 64;
        while (size < 2 * places) size *= 2;
        return size;
    }
    static size_t scatter(uint32_t id) { return static_cast<size_t>(id * 2654435761u >> 7); }
    void makeTable() {
        const size_t size = tableFor(ids.size());
        keys.assign(size, kNoId), slots.resizeRaw(size);
        for (size_t s = 0; s < ids.size(); ++s) {
            if (ids[s] == kNoId) continue;
            size_t k = scatter(ids[s]) & mask();
            while (keys[k] != kNoId) k = (k + 1) & mask();
            keys[k] = ids[s], slots[k] = static_cast<int>(s);
        }
    }
    int find(uint32_t id) const {
        for (size_t k = scatter(id) & mask(); keys[k] != kNoId; k = (k + 1) & mask())
            if (keys[k] == id) return slots[k];
        return -1;
    }
    void commit(RTCScene scene) {
        arena.execute([&] {
            FlushDenormals mode;
            rtcCommitScene(scene);
        });
    }
    void build() {
        if (melt) rtcDetachGeometry(meltScene, 0), rtcReleaseGeometry(melt);
        melt = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(melt, static_cast<unsigned>(spheres.size()));
        rtcSetGeometryUserData(melt, spheres.data());
        rtcSetGeometryBoundsFunction(melt, sphereBounds, nullptr);
        rtcSetGeometryOccludedFunction(melt, sphereOccluded);
        rtcSetGeometryBuildQuality(melt, RTC_BUILD_QUALITY_REFIT);
        rtcCommitGeometry(melt);
        rtcAttachGeometryByID(meltScene, melt, 0);
        commit(meltScene);
        refitsSinceBuild = 0;
    }
};

Visibility::Visibility(Allocator& allocator) : impl_(std::make_unique<Impl>(allocator)) {
    // No "threads=": in Embree 3.13.5 it caps TBB for the whole process.
    FlushDenormals mode;
    impl_->arena.execute([&] { impl_->device = rtcNewDevice("set_affinity=0,start_threads=0"); });
    if (!impl_->device) throw std::bad_alloc();
    impl_->solidScene = rtcNewScene(impl_->device), impl_->meltScene = rtcNewScene(impl_->device);
    rtcSetSceneFlags(impl_->solidScene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneFlags(impl_->meltScene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST));
    rtcSetSceneBuildQuality(impl_->meltScene, RTC_BUILD_QUALITY_LOW);
}

Visibility::~Visibility() {
    if (!impl_ || !impl_->device) return;
    if (impl_->melt) rtcReleaseGeometry(impl_->melt);
    rtcReleaseScene(impl_->meltScene), rtcReleaseScene(impl_->solidScene);
    rtcReleaseDevice(impl_->device);
}

void Visibility::setColliders(const Collider* colliders, int count, uint64_t version) {
    Impl& m = *impl_;
    if (m.collidersKnown && m.version == version) return;
    m.collidersKnown = true, m.version = version;
    rtcReleaseScene(m.solidScene);
    m.solidScene = rtcNewScene(m.device);
    rtcSetSceneFlags(m.solidScene, RTC_SCENE_FLAG_ROBUST);
    m.solids.clear(), m.planes.clear();
    m.anySolid = false;
    for (int c = 0; c < count; ++c) {
        const Collider& o = colliders[c];
        if (!o.alive || !o.occluder) continue;
        if (o.type == thawCollider_plane) {
            m.planes.push_back({o.transform.position, rotate(o.transform.rotation, {0, 1, 0})});
        } else if (o.type == thawCollider_mesh) {
            if (!o.mesh || o.mesh->indices.empty()) continue;
            RTCGeometry g = rtcNewGeometry(m.device, RTC_GEOMETRY_TYPE_TRIANGLE);
            // Copied: Embree reads 16 bytes at a vertex, past the end of the last one.
            void* v = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3),
                                              o.mesh->vertices.size());
            void* i = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t),
                                              o.mesh->indices.size() / 3);
            if (!v || !i) {
                rtcReleaseGeometry(g);
                throw std::bad_alloc();
            }
            std::transform(o.mesh->vertices.begin(), o.mesh->vertices.end(), static_cast<Vec3*>(v),
                           [&](Vec3 x) { return o.transform.position + rotate(o.transform.rotation, x); });
            std::copy(o.mesh->indices.begin(), o.mesh->indices.end(), static_cast<uint32_t*>(i));
            rtcSetGeometryOccludedFilterFunction(g, frontFacesOnly);
            rtcCommitGeometry(g);
            rtcAttachGeometry(m.solidScene, g);
            rtcReleaseGeometry(g);
            m.anySolid = true;
        } else {
            m.solids.push_back(
                {o.type == thawCollider_box, o.transform.position, o.size, o.transform.rotation, o.bounds()});
        }
    }
    if (!m.solids.empty()) {
        RTCGeometry g = rtcNewGeometry(m.device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(g, static_cast<unsigned>(m.solids.size()));
        rtcSetGeometryUserData(g, &m.solids);
        rtcSetGeometryBoundsFunction(g, solidBounds, nullptr);
        rtcSetGeometryOccludedFunction(g, solidOccluded);
        rtcCommitGeometry(g);
        rtcAttachGeometry(m.solidScene, g);
        rtcReleaseGeometry(g);
        m.anySolid = true;
    }
    m.commit(m.solidScene);
}

void Visibility::setSpheres(const Vec4* spheres, const uint32_t* ids, int count, int most) {
    Impl& m = *impl_;
    const bool hadNone = m.live == 0;
    m.live = count;
    if (count == 0) return;
    const size_t n = static_cast<size_t>(count);
    bool fits = !hadNone && m.spheres.size() >= n && 2 * n >= m.spheres.size();
    bool changed = false;
    if (fits) {
        m.makeTable();
        m.taken.assign(m.ids.size(), uint8_t{0});
        m.unplaced.clear();
        const auto put = [&](size_t slot, size_t i) {
            const Vec4 &was = m.spheres[slot], &now = spheres[i];
            changed |= was.x != now.x || was.y != now.y || was.z != now.z || was.w != now.w;
            m.spheres[slot] = now, m.ids[slot] = ids[i], m.taken[slot] = 1;
        };
        for (size_t i = 0; i < n; ++i) {
            const int slot = m.find(ids[i]);
            if (slot < 0)
                m.unplaced.push(static_cast<int>(i));
            else
                put(static_cast<size_t>(slot), i);
        }
        size_t slot = 0;
        for (int i : m.unplaced) {
            while (m.taken[slot]) ++slot;
            put(slot, static_cast<size_t>(i));
        }
        for (size_t s = 0; s < m.ids.size(); ++s) {
            if (m.taken[s]) continue;
            const Vec4 &was = m.spheres[s], &now = spheres[0];
            changed |= was.x != now.x || was.y != now.y || was.z != now.z || was.w != now.w;
            m.ids[s] = kNoId, m.spheres[s] = now;
        }
    }
    if (fits && !changed) return;
    if (fits && m.refitsSinceBuild < kRefitsPerBuild) {
        rtcCommitGeometry(m.melt);
        m.commit(m.meltScene);
        ++m.refitsSinceBuild, ++refits_;
        return;
    }
    // Embree reads the spheres where they are, so they may only move when it builds anew.
    const size_t places = Impl::placesFor(n), mostPlaces = Impl::placesFor(static_cast<size_t>(std::max(count, most)));
    m.spheres.reserve(mostPlaces), m.ids.reserve(mostPlaces), m.taken.reserve(mostPlaces);
    m.keys.reserve(Impl::tableFor(mostPlaces)), m.slots.reserve(Impl::tableFor(mostPlaces));
    m.unplaced.reserve(mostPlaces);
    m.spheres.resizeRaw(places), m.ids.resizeRaw(places);
    for (size_t s = 0; s < places; ++s) {
        m.spheres[s] = spheres[s < n ? s : 0];
        m.ids[s] = s < n ? ids[s] : kNoId;
    }
    m.build();
    ++rebuilds_;
}

void Visibility::cast(const Ray* rays, int count, bool* blocked) const {
    const Impl& m = *impl_;
    FlushDenormals mode;
    alignas(32) int valid[8];
    int open = 0;
    for (int i = 0; i < 8; ++i) {
        valid[i] = 0;
        if (i >= count) continue;
        const Vec3 source = rays[i].surface + rays[i].distance * rays[i].direction;
        bool behind = false;
        for (const Impl::Plane& p : m.planes) behind |= dot(p.normal, source - p.point) <= 0;
        blocked[i] = behind;
        valid[i] = behind ? 0 : -1;
        open += !behind;
    }
    RTCRay8 packet;
    const auto trace = [&](RTCScene scene, bool melt) {
        for (int i = 0; i < 8; ++i) {
            const Ray& r = rays[i < count ? i : 0];
            Vec3 o = r.surface, d = r.direction;
            float reach = r.distance;
            if (melt) {
                const Vec3 way = r.surface + r.distance * r.direction - r.raised;
                reach = length(way);
                o = r.raised, d = normalizeOr(way, r.direction);
            }
            packet.org_x[i] = o.x, packet.org_y[i] = o.y, packet.org_z[i] = o.z;
            packet.dir_x[i] = d.x, packet.dir_y[i] = d.y, packet.dir_z[i] = d.z;
            packet.tnear[i] = melt ? r.skip : 0;
            packet.tfar[i] = reach;
            packet.time[i] = 0, packet.mask[i] = ~0u, packet.id[i] = 0, packet.flags[i] = 0;
            // Embree wants tnear <= tfar: a source within the skipped neighbourhood is in sight.
            if (!(packet.tfar[i] > packet.tnear[i])) packet.tfar[i] = packet.tnear[i];
        }
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        rtcOccluded8(valid, scene, &context, &packet);
        for (int i = 0; i < count; ++i)
            if (valid[i] && packet.tfar[i] < 0) blocked[i] = true, valid[i] = 0, --open;
    };
    if (open > 0 && m.live > 0) trace(m.meltScene, true);
    if (open > 0 && m.anySolid) trace(m.solidScene, false);
}

} // namespace thaw
