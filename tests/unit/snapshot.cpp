// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "world_fixture.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>

namespace {

using Image = std::vector<unsigned char>;

Image save(const thawWorld* world, thawSnapshotKind kind = thawSnapshot_world) {
    Image image(thawWorld_GetSnapshotSize(world, kind));
    REQUIRE(image.size() > 64);
    size_t written = 0;
    REQUIRE(thawWorld_Save(world, kind, image.data(), image.size(), &written) == thawResult_ok);
    REQUIRE(written == image.size());
    return image;
}
void restore(thawWorld* world, const Image& image) {
    const thawResult r = thawWorld_Restore(world, image.data(), image.size());
    REQUIRE_MESSAGE(r == thawResult_ok, std::string(thawWorld_GetLastError(world)));
}

// But for the number of the image and the checksum, which are in the head.
bool alike(const Image& a, const Image& b) { return std::equal(a.begin() + 64, a.end(), b.begin() + 64, b.end()); }

thawMaterialDef preset(thawMaterialPreset kind = thawMaterial_wax) {
    thawMaterialDef m;
    thawInitMaterialDef(&m, kind);
    return m;
}

// A scene with what its host does before each frame. What it made is known by index, so that it goes on in any world.
struct Scene : WorldFixture {
    std::function<void(int frame)> host = [](int) {};

    thawColliderId collider(uint32_t index1, uint16_t generation = 1) {
        return {index1, thawWorld_GetIdTag(world), generation};
    }
    thawColliderId add(thawColliderType type, thawVec3 position, thawVec3 size,
                       const std::function<void(thawColliderDef&)>& change = {}) {
        thawColliderDef d;
        thawInitColliderDef(&d, type);
        d.position = position, d.size = size;
        Shape s;
        if (type == thawCollider_mesh) s = boxShape({-size.x, -size.y, -size.z}, size), d.mesh = s.mesh();
        if (change) change(d);
        thawColliderId id;
        REQUIRE_MESSAGE(thawCreateCollider(world, &d, &id, nullptr) == thawResult_ok, thawWorld_GetLastError(world));
        return id;
    }
    thawBodyId add(const thawMaterialDef& m, thawVec3 low, thawVec3 high,
                   const std::function<void(thawBodyDef&)>& change = {}) {
        const thawMaterialId id = addMaterial(m);
        const Shape s = boxShape(low, high);
        thawBodyDef d;
        thawInitBodyDef(&d);
        d.material = id, d.mesh = s.mesh(), d.temperature = 300;
        if (change) change(d);
        thawBodyId body;
        REQUIRE_MESSAGE(thawCreateBody(world, &d, &body, nullptr) == thawResult_ok, thawWorld_GetLastError(world));
        return body;
    }
    void sphere(thawVec3 position, float temperature) {
        thawHeatSourceDef d;
        thawInitHeatSourceDef(&d);
        d.type = thawHeatSource_sphere, d.position = position, d.radius = 0.006f, d.temperature = temperature;
        thawHeatSourceId id;
        REQUIRE(thawCreateHeatSource(world, &d, &id) == thawResult_ok);
    }
    uint64_t hash() const { return thawWorld_GetStateHash(world); }
    void frame(int k) {
        host(k);
        step();
    }
};
using Make = std::function<void(Scene&)>;

void fill(Scene& f, int particles = 6000) {
    f.def.particleSpacing = 0.004f, f.def.maxParticles = particles, f.def.thermalTimeScale = 20;
}

// Candle: heat by rays, shadows of a mesh that moves, a floor that heats.
void melting(Scene& f) {
    fill(f);
    f.create();
    f.add(thawCollider_plane, {}, {1, 1, 1}, [](thawColliderDef& d) { d.temperature = 320; });
    f.add(thawCollider_mesh, {0.05f, 0.05f, 0.02f}, {0.004f, 0.01f, 0.02f},
          [](thawColliderDef& d) { d.reportImpulse = true; });
    f.add(preset(), {0, 0, 0}, {0.04f, 0.06f, 0.04f});
    f.sphere({0.09f, 0.05f, 0.02f}, 1500);
    f.addSource({0.02f, 0.1f, 0.02f}, 20);
    f.host = [&f](int k) {
        const float y = 0.05f + 0.01f * std::sin(0.2f * static_cast<float>(k));
        REQUIRE(thawCollider_SetTransform(f.world, f.collider(2), {0.05f, y, 0.02f}, {0, 0, 0, 1}) == thawResult_ok);
    };
}

// Melt on a path into a shape that moves, which sets.
void guided(Scene& f) {
    fill(f);
    f.create();
    f.add(thawCollider_plane, {}, {1, 1, 1});
    f.add(thawCollider_box, {0.1f, 0.01f, 0.02f}, {0.05f, 0.01f, 0.05f});
    f.add(preset(), {0, 0.03f, 0}, {0.05f, 0.05f, 0.04f}, [](thawBodyDef& d) { d.temperature = 350; });
    const thawVec3 line[] = {{0.02f, 0.04f, 0.02f}, {0.06f, 0.04f, 0.02f}, {0.1f, 0.03f, 0.02f}};
    thawPathDef p;
    thawInitPathDef(&p);
    p.points = line, p.pointCount = 3, p.radius = 0.015f, p.speed = 0.3f, p.beadSpacing = 0.04f;
    thawPathId path;
    REQUIRE(thawCreatePath(f.world, &p, &path) == thawResult_ok);
    const thawVec3 contour[] = {
        {0.06f, 0.02f, -0.02f}, {0.06f, 0.02f, 0.06f}, {0.14f, 0.02f, 0.06f}, {0.14f, 0.02f, -0.02f}};
    const int32_t size = 4;
    thawShapeDef s;
    thawInitShapeDef(&s);
    s.points = contour, s.contourSizes = &size, s.contourCount = 1, s.setFill = 0.3f, s.setTime = 0.3f;
    thawShapeId shape;
    REQUIRE_MESSAGE(thawCreateShape(f.world, &s, &shape) == thawResult_ok, thawWorld_GetLastError(f.world));
}

// Jelly that a piece falls on and a plate pushes.
void elastic(Scene& f) {
    fill(f);
    f.create();
    f.add(thawCollider_plane, {}, {1, 1, 1});
    f.add(thawCollider_box, {-0.05f, 0.02f, 0.02f}, {0.01f, 0.02f, 0.03f});
    thawMaterialDef jelly = preset();
    jelly.youngModulus = 8000, jelly.viscositySolid = 5, jelly.solidYieldStress = 400;
    f.add(jelly, {0, 0, 0}, {0.04f, 0.024f, 0.04f});
    f.add(preset(), {0.01f, 0.04f, 0.01f}, {0.03f, 0.056f, 0.03f}, [](thawBodyDef& d) { d.anchored = false; });
    f.sphere({0.06f, 0.03f, 0.02f}, 1300);
    f.host = [&f](int k) {
        const float x = -0.05f + 0.002f * static_cast<float>(std::min(k, 25));
        REQUIRE(thawCollider_SetTransform(f.world, f.collider(2), {x, 0.02f, 0.02f}, {0, 0, 0, 1}) == thawResult_ok);
    };
}

// Coarse wax, painted, beside ice that undercools and what burns.
void coarse(Scene& f) {
    fill(f);
    f.create();
    f.add(thawCollider_plane, {}, {1, 1, 1});
    const thawBodyId wax =
        f.add(preset(), {0, 0, 0}, {0.06f, 0.06f, 0.06f}, [](thawBodyDef& d) { d.coarsestLevel = 3; });
    thawMaterialDef ice = preset(thawMaterial_ice);
    ice.undercooling = 15;
    f.add(ice, {0.08f, 0, 0}, {0.12f, 0.03f, 0.04f}, [](thawBodyDef& d) { d.temperature = 280; });
    thawMaterialDef fuse = preset();
    fuse.burnTemperature = 340, fuse.burnRate = 0.2f;
    f.add(fuse, {0.02f, 0.06f, 0.02f}, {0.04f, 0.08f, 0.04f}, [](thawBodyDef& d) { d.temperature = 345; });
    f.sphere({0.07f, 0.07f, 0.03f}, 1600);
    const uint32_t body = wax.index1;
    f.host = [&f, body](int k) {
        if (k != 6) return;
        const thawBrush brush{{0, 0.03f, 0.03f}, 0.02f, 0.5f};
        const thawBodyId id{body, thawWorld_GetIdTag(f.world), 1};
        REQUIRE(thawBody_PaintTemperature(f.world, id, &brush, 345, nullptr) == thawResult_ok);
        REQUIRE(thawBody_PaintAbsorptivity(f.world, id, &brush, 0.9f, nullptr) == thawResult_ok);
    };
}

// As much as a budget in units has.
void governed(Scene& f) {
    melting(f);
    f.budget.mode = thawBudget_units, f.budget.units = 900;
}

// Nothing moves, then something does.
void still(Scene& f) {
    fill(f);
    f.create();
    f.add(thawCollider_plane, {}, {1, 1, 1});
    f.add(preset(), {0, 0, 0}, {0.04f, 0.04f, 0.04f});
    f.sphere({0.09f, 0.03f, 0.02f}, 1100);
    f.host = [&f](int k) {
        if (k == 18) REQUIRE(thawWorld_SetAmbient(f.world, 360, 500) == thawResult_ok);
    };
}

const std::pair<const char*, Make> kScenes[] = {{"melting", melting}, {"guided", guided},     {"elastic", elastic},
                                                {"coarse", coarse},   {"governed", governed}, {"still", still}};

thawLedger ledgerOf(const Scene& f) { return f.ledger(); }
bool same(const thawLedger& a, const thawLedger& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

} // namespace

TEST_CASE("snapshot: eight frames back and again gives the same bits, frame by frame") {
    for (const auto& [name, make] : kScenes) {
        CAPTURE(std::string(name));
        Scene f;
        make(f);
        constexpr int kFrames = 32, kBack = 8;
        std::vector<uint64_t> hashes;
        std::vector<Image> ring;
        std::vector<thawLedger> ledgers;
        const auto keep = [&](int k) {
            const size_t at = static_cast<size_t>(k);
            if (at == hashes.size()) {
                ring.push_back(save(f.world)), hashes.push_back(f.hash()), ledgers.push_back(ledgerOf(f));
                return;
            }
            CAPTURE(k);
            CHECK(f.hash() == hashes[at]);
            CHECK(alike(save(f.world), ring[at]));
            CHECK(same(ledgerOf(f), ledgers[at]));
        };
        keep(0);
        for (int k = 0; k < kFrames; ++k) {
            f.frame(k);
            keep(k + 1);
            if ((k + 1) % 12 != 0) continue;
            restore(f.world, ring[static_cast<size_t>(k + 1 - kBack)]);
            keep(k + 1 - kBack);
            for (int b = k + 1 - kBack; b <= k; ++b) f.frame(b), keep(b + 1);
        }
        restore(f.world, ring[0]);
        for (int k = 0; k < 4; ++k) keep(k), f.frame(k);
    }
}

TEST_CASE("snapshot: a world of its own goes on from a full image with the same bits, on any number of threads") {
    for (const auto& [name, make] : kScenes) {
        CAPTURE(std::string(name));
        Scene f;
        make(f);
        for (const int at : {0, 14}) {
            for (int k = at == 0 ? 0 : 1; k < at; ++k) f.frame(k);
            const Image image = save(f.world, thawSnapshot_full);
            const uint64_t then = f.hash();
            std::vector<uint64_t> hashes;
            for (int k = at; k < at + 10; ++k) f.frame(k), hashes.push_back(f.hash());
            restore(f.world, image);
            for (const int workers : {1, 2, 4}) {
                CAPTURE(workers);
                Scene other;
                other.host = [](int) {};
                other.def = f.def, other.budget = f.budget;
                other.def.tasks.workerCount = workers;
                other.create();
                restore(other.world, image);
                CHECK(other.hash() == then);
                CHECK(same(ledgerOf(other), ledgerOf(f)));
                thawWorld* const mine = std::exchange(f.world, other.world); // the host's own moves go there
                for (int k = at; k < at + 10; ++k) {
                    f.frame(k);
                    CHECK(f.hash() == hashes[static_cast<size_t>(k - at)]);
                }
                f.world = mine;
            }
            if (at == 0) f.frame(0);
        }
    }
}

TEST_CASE("snapshot: the mesh after a restore is the one that there was, as made anew") {
    Scene f;
    melting(f);
    for (int k = 0; k < 10; ++k) f.frame(k);
    thawSurfaceDef d;
    thawInitSurfaceDef(&d);
    const auto mesh = [&](thawWorld* world) {
        thawSurfaceView v;
        REQUIRE(thawWorld_ExtractSurface(world, &d, &v) == thawResult_ok);
        REQUIRE(v.vertexCount > 100);
        std::vector<float> all(v.positions, v.positions + 3 * v.vertexCount);
        all.insert(all.end(), v.normals, v.normals + 3 * v.vertexCount);
        all.insert(all.end(), v.temperatures, v.temperatures + v.vertexCount);
        all.insert(all.end(), v.indices, v.indices + 3 * v.triangleCount);
        return all;
    };
    const Image image = save(f.world, thawSnapshot_full);
    const auto then = mesh(f.world);
    for (int k = 10; k < 25; ++k) f.frame(k);
    CHECK(mesh(f.world) != then);
    restore(f.world, image);
    CHECK(mesh(f.world) == then);
    Scene other;
    other.def = f.def;
    other.create();
    restore(other.world, image);
    CHECK(mesh(other.world) == then);
}

TEST_CASE("snapshot: what was destroyed is back with its id, what was created is stale, and comes again with its id") {
    Scene f;
    guided(f);
    f.add(thawCollider_mesh, {0.3f, 0.05f, 0}, {0.02f, 0.02f, 0.02f});
    const uint16_t tag = thawWorld_GetIdTag(f.world);
    const thawBodyId body{1, tag, 1};
    const thawColliderId mesh{3, tag, 1};
    const thawPathId path{1, tag, 1};
    const thawShapeId shape{1, tag, 1};
    const thawHeatSourceId lamp = f.addSource({1, 1, 1}, 5);
    for (int k = 0; k < 5; ++k) f.frame(k);
    const Image image = save(f.world);
    const uint64_t then = f.hash();
    REQUIRE(thawDestroyBody(f.world, body) == thawResult_ok);
    REQUIRE(thawDestroyCollider(f.world, mesh) == thawResult_ok);
    REQUIRE(thawDestroyPath(f.world, path) == thawResult_ok);
    REQUIRE(thawDestroyShape(f.world, shape) == thawResult_ok);
    REQUIRE(thawDestroyHeatSource(f.world, lamp) == thawResult_ok);
    f.frame(5);
    const thawHeatSourceId late = f.addSource({1, 1, 1}, 5);
    const thawMaterialId lateMaterial = f.addMaterial();
    const thawColliderId lateCollider = f.add(thawCollider_sphere, {1, 1, 1}, {0.1f, 0, 0});
    restore(f.world, image);
    CHECK(f.hash() == then);
    thawBodyState state;
    CHECK(thawBody_GetState(f.world, body, &state) == thawResult_ok);
    CHECK(state.particles > 100);
    thawVec3 x;
    thawQuat q;
    CHECK(thawCollider_GetTransform(f.world, mesh, &x, &q) == thawResult_ok);
    CHECK(x.x == 0.3f);
    thawPathState p;
    CHECK(thawPath_GetState(f.world, path, &p) == thawResult_ok);
    thawShapeState s;
    CHECK(thawShape_GetState(f.world, shape, &s) == thawResult_ok);
    CHECK(thawCollider_GetTransform(f.world, lateCollider, &x, &q) == thawResult_staleId);
    CHECK(thawDestroyHeatSource(f.world, late) == thawResult_staleId);
    const thawMaterialDef m = preset();
    CHECK(thawMaterial_Set(f.world, lateMaterial, &m) == thawResult_staleId);
    REQUIRE(thawDestroyHeatSource(f.world, lamp) == thawResult_ok);
    const thawHeatSourceId again = f.addSource({1, 1, 1}, 5);
    CHECK((again.index1 == late.index1 && again.generation == late.generation));
}

TEST_CASE("snapshot: an image that is not whole is refused, and the world stays as it is") {
    Scene f;
    elastic(f);
    for (int k = 0; k < 6; ++k) f.frame(k);
    const Image image = save(f.world, thawSnapshot_full);
    for (int k = 6; k < 9; ++k) f.frame(k);
    const Image before = save(f.world);
    const auto refused = [&](const Image& bad, size_t size) {
        const thawResult r = thawWorld_Restore(f.world, bad.data(), size);
        return r == thawResult_badImage && std::strncmp(thawWorld_GetLastError(f.world), "image: ", 7) == 0;
    };
    Image bad = image;
    int wrong = 0;
    for (size_t k = 0; k < 64; ++k)
        for (int bit = 0; bit < 8; ++bit) {
            bad[k] ^= static_cast<unsigned char>(1 << bit);
            wrong += !refused(bad, bad.size());
            bad[k] = image[k];
        }
    CHECK(wrong == 0);
    uint32_t random = 1;
    for (int n = 0; n < 400; ++n) {
        random = random * 1664525 + 1013904223;
        const size_t at = random % image.size();
        bad[at] ^= static_cast<unsigned char>(1u << (random >> 29));
        wrong += !refused(bad, bad.size());
        bad[at] = image[at];
    }
    CHECK(wrong == 0);
    bad.push_back(0);
    wrong += !refused(bad, bad.size());
    CHECK(wrong == 0);
    CHECK(save(f.world).size() == before.size());
    CHECK(thawWorld_Restore(f.world, nullptr, 100) == thawResult_invalidArgument);
    CHECK(thawWorld_Restore(nullptr, image.data(), image.size()) == thawResult_invalidArgument);
    const Image after = save(f.world);
    CHECK(alike(after, before));
    restore(f.world, image);
}

TEST_CASE("snapshot: cut short at any length it is refused") {
    Scene f;
    f.def.maxParticles = 64, f.def.particleSpacing = 0.01f;
    f.create();
    f.add(thawCollider_plane, {}, {1, 1, 1});
    f.add(preset(), {0, 0, 0}, {0.02f, 0.02f, 0.02f});
    f.step(3);
    const Image image = save(f.world, thawSnapshot_full);
    const uint64_t hash = f.hash();
    int wrong = 0;
    for (size_t size = 0; size < image.size(); ++size)
        wrong += thawWorld_Restore(f.world, image.data(), size) != thawResult_badImage;
    CHECK(wrong == 0);
    CHECK(f.hash() == hash);
    Image small(image.size() - 1);
    size_t written = 7;
    CHECK(thawWorld_Save(f.world, thawSnapshot_full, small.data(), small.size(), &written) == thawResult_capacity);
    CHECK(written == 0);
    CHECK(thawWorld_Save(f.world, thawSnapshot_full, nullptr, 0, nullptr) == thawResult_capacity);
    CHECK(thawWorld_Save(nullptr, thawSnapshot_full, small.data(), small.size(), nullptr) ==
          thawResult_invalidArgument);
    CHECK(thawWorld_GetSnapshotSize(nullptr, thawSnapshot_full) == 0);
    restore(f.world, image);
}

TEST_CASE("snapshot: a world of another kind, or without the mesh, refuses it") {
    Scene f;
    melting(f);
    f.step(3);
    const Image image = save(f.world), full = save(f.world, thawSnapshot_full);
    const auto refusal = [&](const Image& i, const std::function<void(thawWorldDef&)>& change) {
        Scene other;
        other.def = f.def;
        change(other.def);
        other.create();
        const uint64_t hash = other.hash();
        const thawResult r = thawWorld_Restore(other.world, i.data(), i.size());
        if (r == thawResult_ok) return std::string();
        CHECK(other.hash() == hash);
        CHECK(other.counters().particles == 0);
        return std::string(thawWorld_GetLastError(other.world));
    };
    CHECK(refusal(full, [](thawWorldDef&) {}).empty());
    CHECK(refusal(image, [](thawWorldDef&) {}).find("mesh of a collider") != std::string::npos);
    CHECK(refusal(full, [](thawWorldDef& d) { d.particleSpacing = 0.005f; }).find("particleSpacing") !=
          std::string::npos);
    CHECK(refusal(full, [](thawWorldDef& d) { d.maxParticles = 100; }).find("maxParticles") != std::string::npos);
    CHECK(!refusal(full, [](thawWorldDef& d) { d.maxColliders = 1; }).empty());
    CHECK(!refusal(full, [](thawWorldDef& d) { d.maxHeatSources = 1; }).empty());
    CHECK(refusal(full, [](thawWorldDef& d) { d.maxParticles = 20000, d.maxColliders = 9; }).empty());
}

TEST_CASE("snapshot: meshes are kept as long as an image may name them") {
    Scene f;
    melting(f);
    f.step();
    const thawColliderId mesh = f.collider(2);
    const Image first = save(f.world);
    f.step();
    REQUIRE(thawDestroyCollider(f.world, mesh) == thawResult_ok);
    f.step(); // which no longer sees its shadow
    REQUIRE(thawWorld_ForgetSnapshots(f.world, first.data(), first.size()) == thawResult_ok);
    const Image second = save(f.world);
    restore(f.world, first);
    REQUIRE(thawDestroyCollider(f.world, mesh) == thawResult_ok);
    REQUIRE(thawWorld_ForgetSnapshots(f.world, first.data(), first.size()) == thawResult_ok);
    restore(f.world, first);
    restore(f.world, second);
    REQUIRE(thawWorld_ForgetSnapshots(f.world, second.data(), second.size()) == thawResult_ok);
    CHECK(thawWorld_Restore(f.world, first.data(), first.size()) == thawResult_badImage);
    restore(f.world, second);
    CHECK(thawWorld_ForgetSnapshots(f.world, first.data(), 3) == thawResult_badImage);
    CHECK(thawWorld_ForgetSnapshots(f.world, nullptr, 0) == thawResult_ok);
    restore(f.world, second);
}

TEST_CASE("snapshot: saving and going back in the same world allocates nothing") {
    struct Count {
        int taken = 0;
    } count;
    Scene f;
    fill(f);
    f.def.allocator = {[](size_t size, size_t alignment, void* user) {
                           ++static_cast<Count*>(user)->taken;
                           return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
                       },
                       [](void* memory, size_t, void*) { std::free(memory); }, &count};
    melting(f);
    for (int k = 0; k < 10; ++k) f.frame(k);
    Image image(thawWorld_GetSnapshotSize(f.world, thawSnapshot_world) + 100000);
    size_t written = 0;
    REQUIRE(thawWorld_Save(f.world, thawSnapshot_world, image.data(), image.size(), &written) == thawResult_ok);
    for (int k = 10; k < 20; ++k) f.frame(k);
    const int before = count.taken;
    for (int n = 0; n < 3; ++n) {
        REQUIRE(thawWorld_Restore(f.world, image.data(), written) == thawResult_ok);
        for (int k = 10; k < 20; ++k) f.frame(k);
    }
    CHECK(count.taken == before);
    thawDestroyWorld(std::exchange(f.world, nullptr));
}
