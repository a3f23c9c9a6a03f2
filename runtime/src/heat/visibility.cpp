// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "heat/visibility.h"

#include "base/math.h"
#include "heat/sphere_tree.h"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstring>
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

// Spheres whose movement is told as one region.
constexpr size_t kStirBatch = 128;
// Those that came or went are told one by one up to so many.
constexpr size_t kStirsApart = 48;
constexpr uint32_t kNoId = std::numeric_limits<uint32_t>::max();

} // namespace

struct Visibility::Impl {
    explicit Impl(Allocator& a) : tree(a), spheres(a), ids(a), taken(a), keys(a), places(a), stirs(a), batches(a) {}

    RTCDevice device = nullptr;
    RTCScene solidScene = nullptr;
    tbb::task_arena arena{1, 1};

    // A collider as it is in the tree.
    struct Occluder {
        thawColliderType type;
        const CleanMesh* mesh; // of which an instance is there; meshScenes keeps it alive
        Vec3 size;
        Transform place;
        RTCGeometry instance; // of a mesh
        int at;               // in solids, or in planes
        int index;            // of the collider
        uint64_t form;        // of a mesh
        bool same(const Collider& c) const {
            return type == c.type && mesh == c.mesh.get() && std::memcmp(&size, &c.size, sizeof size) == 0 &&
                   std::memcmp(&place, &c.transform, sizeof place) == 0;
        }
    };
    std::vector<Occluder> occluders;
    struct MeshScene {
        std::shared_ptr<const CleanMesh> mesh;
        RTCScene scene;
    };
    std::vector<MeshScene> meshScenes;
    RTCGeometry solidGeometry = nullptr;
    bool collidersDirty = false, meltDirty = false;
    std::vector<Solid> solids;
    struct Plane {
        Vec3 point, normal;
    };
    std::vector<Plane> planes;
    uint64_t version = 0;
    bool collidersKnown = false, anySolid = false;
    std::vector<Collider> stage; // of an image that is read

    SphereTree tree;
    Array<Vec4> spheres;  // of the last call
    Array<uint32_t> ids;  // of the same
    Array<uint8_t> taken; // per sphere of the last call: it is there again
    Array<uint32_t> keys; // open addressing: id
    Array<int> places;    // and which sphere it has
    Array<Stir> stirs;
    Array<Stir> batches; // of the spheres, per kStirBatch of them

    void stir(const Box& box, float amount) { stirs.push({box, amount, false}); }
    static bool shades(const Collider& c) {
        return c.alive && c.occluder && !(c.type == thawCollider_mesh && (!c.mesh || c.mesh->indices.empty()));
    }
    static Solid solidOf(const Collider& c) {
        return {c.type == thawCollider_box, c.transform.position, c.size, c.transform.rotation, c.bounds()};
    }
    static Plane planeOf(const Collider& c) { return {c.transform.position, rotate(c.transform.rotation, {0, 1, 0})}; }
    bool sameOccluders(const Collider* colliders, int count) const {
        size_t at = 0;
        for (int c = 0; c < count; ++c) {
            if (!shades(colliders[c])) continue;
            if (at == occluders.size()) return false;
            const Occluder& o = occluders[at++];
            const Collider& x = colliders[c];
            if (o.type != x.type || o.mesh != x.mesh.get() || o.index != c) return false;
            if (o.size.x != x.size.x || o.size.y != x.size.y || o.size.z != x.size.z) return false;
        }
        return at == occluders.size();
    }
    RTCScene sceneOf(const std::shared_ptr<const CleanMesh>& mesh);
    static void setInstance(RTCGeometry g, const Transform& t) {
        const Vec3 x = rotate(t.rotation, {1, 0, 0}), y = rotate(t.rotation, {0, 1, 0}),
                   z = rotate(t.rotation, {0, 0, 1});
        const float m[12] = {x.x, x.y, x.z, y.x, y.y, y.z, z.x, z.y, z.z, t.position.x, t.position.y, t.position.z};
        rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, m);
        rtcCommitGeometry(g);
    }

    size_t mask() const { return keys.size() - 1; }
    static size_t tableFor(size_t count) {
        size_t size = 64;
        while (size < 2 * count) size *= 2;
        return size;
    }
    static size_t scatter(uint32_t id) { return static_cast<size_t>(id * 2654435761u >> 7); }
    void makeTable() {
        const size_t size = tableFor(ids.size());
        keys.assign(size, kNoId), places.resizeRaw(size);
        for (size_t s = 0; s < ids.size(); ++s) {
            size_t k = scatter(ids[s]) & mask();
            while (keys[k] != kNoId) k = (k + 1) & mask();
            keys[k] = ids[s], places[k] = static_cast<int>(s);
        }
    }
    int find(uint32_t id) const {
        for (size_t k = scatter(id) & mask(); keys[k] != kNoId; k = (k + 1) & mask())
            if (keys[k] == id) return places[k];
        return -1;
    }
    void commit(RTCScene scene) {
        arena.execute([&] {
            FlushDenormals mode;
            rtcCommitScene(scene);
        });
    }
};

Visibility::Visibility(Allocator& allocator) : impl_(std::make_unique<Impl>(allocator)) {
    // No "threads=": in Embree 3.13.5 it caps TBB for the whole process.
    FlushDenormals mode;
    impl_->arena.execute([&] { impl_->device = rtcNewDevice("set_affinity=0,start_threads=0"); });
    if (!impl_->device) throw std::bad_alloc();
    impl_->solidScene = rtcNewScene(impl_->device);
    rtcSetSceneFlags(impl_->solidScene, RTC_SCENE_FLAG_ROBUST);
}

Visibility::~Visibility() {
    if (!impl_ || !impl_->device) return;
    for (const auto& s : impl_->meshScenes) rtcReleaseScene(s.scene);
    rtcReleaseScene(impl_->solidScene);
    rtcReleaseDevice(impl_->device);
}

// The tree of one mesh, in its own space; kept for as long as some collider has it.
RTCScene Visibility::Impl::sceneOf(const std::shared_ptr<const CleanMesh>& mesh) {
    for (const MeshScene& s : meshScenes)
        if (s.mesh == mesh) return s.scene;
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    // Copied: Embree reads 16 bytes at a vertex, past the end of the last one.
    void* v =
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), mesh->vertices.size());
    void* i = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t),
                                      mesh->indices.size() / 3);
    if (!v || !i) {
        rtcReleaseGeometry(g);
        throw std::bad_alloc();
    }
    std::copy(mesh->vertices.begin(), mesh->vertices.end(), static_cast<Vec3*>(v));
    std::copy(mesh->indices.begin(), mesh->indices.end(), static_cast<uint32_t*>(i));
    rtcSetGeometryOccludedFilterFunction(g, frontFacesOnly);
    rtcCommitGeometry(g);
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcAttachGeometry(scene, g);
    rtcReleaseGeometry(g);
    commit(scene);
    meshScenes.push_back({mesh, scene});
    return scene;
}

void Visibility::setColliders(const Collider* colliders, int count, uint64_t version) {
    Impl& m = *impl_;
    if (m.collidersKnown && m.version == version) return;
    m.version = version;
    if (m.collidersKnown && m.sameOccluders(colliders, count)) {
        bool solidsMoved = false;
        size_t at = 0;
        for (int c = 0; c < count; ++c) {
            if (!Impl::shades(colliders[c])) continue;
            Impl::Occluder& o = m.occluders[at++];
            const Transform &was = o.place, &now = colliders[c].transform;
            if (std::memcmp(&was, &now, sizeof now) == 0) continue;
            Collider before = colliders[c];
            before.transform = was;
            before.moveTo(now, 1);
            const Box box = before.bounds();
            const Vec3 center = 0.5f * (box.lower + box.upper);
            const bool plane = o.type == thawCollider_plane;
            m.stir(before.sweptBounds(),
                   plane ? INFINITY : before.reachOfMotion(center, 0.5f * length(box.upper - box.lower)));
            o.place = now;
            if (plane)
                m.planes[static_cast<size_t>(o.at)] = Impl::planeOf(colliders[c]);
            else if (o.type == thawCollider_mesh)
                Impl::setInstance(o.instance, now);
            else
                m.solids[static_cast<size_t>(o.at)] = Impl::solidOf(colliders[c]), solidsMoved = true;
            m.collidersDirty |= !plane;
            ++colliderMoves_;
        }
        if (solidsMoved) rtcCommitGeometry(m.solidGeometry);
        return;
    }
    // What is gone, or is something else now.
    std::vector<char> stays(static_cast<size_t>(count));
    for (const Impl::Occluder& o : m.occluders) {
        if (o.index < count && Impl::shades(colliders[o.index]) && o.same(colliders[o.index])) {
            stays[static_cast<size_t>(o.index)] = 1;
            continue;
        }
        Collider was;
        was.type = o.type, was.size = o.size, was.transform = o.place;
        if (o.type == thawCollider_mesh) was.mesh = std::shared_ptr<const CleanMesh>(std::shared_ptr<void>(), o.mesh);
        m.stir(was.bounds(), INFINITY);
    }
    m.collidersKnown = false;
    rtcReleaseScene(m.solidScene);
    m.solidScene = rtcNewScene(m.device);
    rtcSetSceneFlags(m.solidScene, RTC_SCENE_FLAG_ROBUST);
    m.occluders.clear(), m.solids.clear(), m.planes.clear();
    m.solidGeometry = nullptr, m.anySolid = false;
    for (size_t k = 0; k < m.meshScenes.size();) {
        const auto& mesh = m.meshScenes[k].mesh;
        if (std::any_of(colliders, colliders + count,
                        [&](const Collider& c) { return Impl::shades(c) && c.mesh == mesh; })) {
            ++k;
            continue;
        }
        rtcReleaseScene(m.meshScenes[k].scene);
        m.meshScenes.erase(m.meshScenes.begin() + static_cast<std::ptrdiff_t>(k));
    }
    for (int c = 0; c < count; ++c) {
        const Collider& o = colliders[c];
        if (!Impl::shades(o)) continue;
        Impl::Occluder entry{o.type, o.mesh.get(), o.size, o.transform, nullptr, 0, c, o.form};
        if (o.type == thawCollider_plane) {
            entry.at = static_cast<int>(m.planes.size());
            m.planes.push_back(Impl::planeOf(o));
        } else if (o.type == thawCollider_mesh) {
            entry.instance = rtcNewGeometry(m.device, RTC_GEOMETRY_TYPE_INSTANCE);
            rtcSetGeometryInstancedScene(entry.instance, m.sceneOf(o.mesh));
            rtcSetGeometryTimeStepCount(entry.instance, 1);
            Impl::setInstance(entry.instance, o.transform);
            rtcAttachGeometry(m.solidScene, entry.instance);
            rtcReleaseGeometry(entry.instance); // the scene keeps it
            m.anySolid = true;
        } else {
            entry.at = static_cast<int>(m.solids.size());
            m.solids.push_back(Impl::solidOf(o));
        }
        m.occluders.push_back(entry);
        if (!stays[static_cast<size_t>(c)]) m.stir(o.bounds(), INFINITY);
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
        m.solidGeometry = g;
        m.anySolid = true;
    }
    m.collidersKnown = m.collidersDirty = true;
    ++colliderBuilds_;
}

void Visibility::setSpheres(const Vec4* spheres, const uint32_t* ids, int count, int most, float* moved) {
    Impl& m = *impl_;
    const size_t n = static_cast<size_t>(count), room = static_cast<size_t>(std::max(count, most));
    m.spheres.reserve(room), m.ids.reserve(room), m.taken.reserve(room), m.tree.reserve(std::max(count, most));
    m.keys.reserve(Impl::tableFor(room)), m.places.reserve(Impl::tableFor(room));
    m.batches.reserve(room / kStirBatch + 1);
    m.stirs.reserve(room / kStirBatch + kStirsApart + 2 * m.occluders.size() + 16);
    const auto boxOf = [](const Vec4& s) { return Box{s.xyz() - Vec3{s.w, s.w, s.w}, s.xyz() + Vec3{s.w, s.w, s.w}}; };
    // Spheres of a batch lie together: rows are in the order of cells.
    m.batches.assign((n + kStirBatch - 1) / kStirBatch, Stir{{}, 0, true});
    const auto stirs = [&](size_t i, const Vec4& was, float amount) {
        Stir& batch = m.batches[i / kStirBatch];
        const Box now = boxOf(spheres[i]);
        batch.box.grow(now.lower), batch.box.grow(now.upper);
        batch.box.grow(boxOf(was).lower), batch.box.grow(boxOf(was).upper);
        batch.amount = std::max(batch.amount, amount);
    };
    // Who is no more among them, each by itself as long as they are few.
    const size_t limit = m.stirs.size() + kStirsApart;
    const auto gone = [&](const Vec4& s) {
        const Box box = boxOf(s);
        if (m.stirs.size() < limit) return m.stirs.push({box, s.w, true});
        Stir& last = m.stirs[m.stirs.size() - 1];
        last.box.grow(box.lower), last.box.grow(box.upper), last.amount = std::max(last.amount, s.w);
    };
    m.makeTable();
    m.taken.assign(m.ids.size(), uint8_t{0});
    bool changed = n != m.ids.size();
    for (size_t i = 0; i < n; ++i) {
        const int place = m.find(ids[i]);
        if (place < 0) {
            changed = true;
            gone(spheres[i]); // came, which is the same to those behind it
            if (moved) moved[i] = spheres[i].w;
            continue;
        }
        const Vec4& was = m.spheres[static_cast<size_t>(place)];
        const float way = length(spheres[i].xyz() - was.xyz());
        if (way > 0) stirs(i, was, way);
        if (moved) moved[i] = way;
        changed |= way > 0 || was.w != spheres[i].w;
        m.taken[static_cast<size_t>(place)] = 1;
    }
    for (size_t s = 0; s < m.ids.size(); ++s)
        if (!m.taken[s]) gone(m.spheres[s]);
    for (const Stir& batch : m.batches)
        if (batch.amount > 0) m.stirs.push(batch);
    m.spheres.resizeRaw(n), m.ids.resizeRaw(n);
    std::copy(spheres, spheres + n, m.spheres.begin()), std::copy(ids, ids + n, m.ids.begin());
    m.meltDirty |= changed;
}

const Array<Stir>& Visibility::stirs() const { return impl_->stirs; }
void Visibility::clearStirs() { impl_->stirs.clear(); }

void Visibility::commit() {
    Impl& m = *impl_;
    if (m.collidersDirty) m.commit(m.solidScene), m.collidersDirty = false;
    if (!m.meltDirty) return;
    m.meltDirty = false;
    m.tree.build(m.spheres.data(), static_cast<int>(m.spheres.size()));
    ++meltBuilds_;
}

void Visibility::state(StateIo& io, const ColliderForms& forms) {
    Impl& m = *impl_;
    io.block(m.spheres, io.limits.particles), io.block(m.ids, io.limits.particles);
    if (io.restores()) m.meltDirty = true;
    if (!io.reads()) {
        size_t n = io.count(m.occluders.size(), m.occluders.size());
        for (size_t k = 0; k < n; ++k) {
            Impl::Occluder& o = m.occluders[k];
            io(o.index, o.type, o.size, o.place, o.form);
        }
        return;
    }
    // As colliders, of which the trees are made again where they are not what they were.
    const size_t n = io.count(0, io.limits.colliders);
    m.stage.resize(io.limits.colliders);
    for (Collider& c : m.stage) c = {};
    for (size_t k = 0; k < n && io.good(); ++k) {
        uint32_t index = 0;
        StateIo::Trial trial(io);
        io.index(index, io.limits.colliders);
        if (!io.good()) return;
        Collider& c = m.stage[index];
        c.alive = true;
        io.index(c.type, thawCollider_mesh + 1);
        io(c.size, c.transform, c.form);
        if (c.type != thawCollider_mesh) continue;
        if (const auto made = forms.find(c.form))
            c.take(made);
        else
            io.fail("the mesh of a collider is neither in this world any more nor in the image");
    }
    if (!io.restores() || !io.good()) return;
    m.version = ~uint64_t{0};
    setColliders(m.stage.data(), static_cast<int>(m.stage.size()), m.version - 1);
    clearStirs();
}

bool Visibility::names(uint64_t form) const {
    const auto& all = impl_->occluders;
    return std::any_of(all.begin(), all.end(),
                       [&](const Impl::Occluder& o) { return o.type == thawCollider_mesh && o.form == form; });
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
    for (int i = 0; i < count; ++i) {
        if (!valid[i]) continue;
        const Ray& r = rays[i];
        const Vec3 way = r.surface + r.distance * r.direction - r.raised;
        if (!m.tree.blocks({r.raised, normalizeOr(way, r.direction), r.skip, length(way)})) continue;
        blocked[i] = true, valid[i] = 0, --open;
    }
    if (open == 0 || !m.anySolid) return;
    RTCRay8 packet;
    for (int i = 0; i < 8; ++i) {
        const Ray& r = rays[i < count ? i : 0];
        packet.org_x[i] = r.surface.x, packet.org_y[i] = r.surface.y, packet.org_z[i] = r.surface.z;
        packet.dir_x[i] = r.direction.x, packet.dir_y[i] = r.direction.y, packet.dir_z[i] = r.direction.z;
        packet.tnear[i] = 0, packet.tfar[i] = std::max(0.0f, r.distance);
        packet.time[i] = 0, packet.mask[i] = ~0u, packet.id[i] = 0, packet.flags[i] = 0;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded8(valid, m.solidScene, &context, &packet);
    for (int i = 0; i < count; ++i)
        if (valid[i] && packet.tfar[i] < 0) blocked[i] = true;
}

} // namespace thaw
