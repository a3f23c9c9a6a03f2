// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// The mesh through the C API: beside the steps, in the host's own layout, and coarser where it may take less.
#include "world_fixture.h"

#include <algorithm>
#include <cstring>
#include <thread>

namespace {

// A block that melts from its top, on a floor.
struct MeltingBlock : WorldFixture {
    explicit MeltingBlock(int workers = 1, thawTaskSystem tasks = {}) {
        def.tasks = tasks;
        def.tasks.workerCount = workers;
        def.thermalTimeScale = 100;
        create();
        addMaterial();
        addFloor();
        addBox({-0.015f, 0, -0.015f}, {0.015f, 0.03f, 0.015f}, 320);
        addSource({0, 0.06f, 0}, 400);
        thawInitSurfaceDef(&surface);
    }
    thawSurfaceView extract() {
        thawSurfaceView view;
        REQUIRE_MESSAGE(thawWorld_ExtractSurface(world, &surface, &view) == thawResult_ok,
                        thawWorld_GetLastError(world));
        return view;
    }
    std::string error() const { return thawWorld_GetLastError(world); }
    thawSurfaceDef surface;
};

struct Copy {
    std::vector<float> positions, temperatures;
    std::vector<uint32_t> indices;
    explicit Copy(const thawSurfaceView& v)
        : positions(v.positions, v.positions + 3 * v.vertexCount),
          temperatures(v.temperatures, v.temperatures + v.vertexCount),
          indices(v.indices, v.indices + 3 * v.triangleCount) {}
    bool operator==(const Copy& o) const {
        return positions == o.positions && temperatures == o.temperatures && indices == o.indices;
    }
};

struct HostThreads {
    int started = 0, finished = 0;
    static void* enqueue(thawTask* task, void* context, void* user) {
        ++static_cast<HostThreads*>(user)->started;
        return new std::thread([=] { task(context); });
    }
    static void finish(void* handle, void* user) {
        ++static_cast<HostThreads*>(user)->finished;
        std::thread* t = static_cast<std::thread*>(handle);
        t->join();
        delete t;
    }
};

} // namespace

TEST_CASE("a mesh that is made beside the steps is that of its start") {
    HostThreads host;
    for (const bool hosts : {false, true}) {
        thawTaskSystem tasks{};
        if (hosts) tasks = {1, &HostThreads::enqueue, &HostThreads::finish, &host};
        MeltingBlock one, other(1, tasks);
        thawSurfaceView view{};
        for (int frame = 0; frame < 90; ++frame) {
            one.step(1), other.step(1);
            const Copy now(one.extract());
            const bool drawing = frame > 0;
            const Copy drawn(view); // stays while the next one is made
            REQUIRE_MESSAGE(thawWorld_StartSurface(other.world, &other.surface) == thawResult_ok, other.error());
            CHECK(other.counters().memoryBytes > 0); // while the maker takes memory
            one.step(1), other.step(1);
            if (drawing) CHECK(drawn == Copy(view));
            REQUIRE(thawWorld_FinishSurface(other.world, &view) == thawResult_ok);
            CHECK(now == Copy(view));
        }
        CHECK(thawWorld_GetStateHash(one.world) == thawWorld_GetStateHash(other.world));
        CHECK(one.counters().moving > 50); // it did melt
        // Nothing new: the same mesh.
        REQUIRE(thawWorld_StartSurface(other.world, &other.surface) == thawResult_ok);
        thawSurfaceView again;
        REQUIRE(thawWorld_FinishSurface(other.world, &again) == thawResult_ok);
        REQUIRE(thawWorld_StartSurface(other.world, &other.surface) == thawResult_ok);
        thawSurfaceView third;
        REQUIRE(thawWorld_FinishSurface(other.world, &third) == thawResult_ok);
        CHECK(Copy(again) == Copy(third));
        CHECK(again.positions == third.positions);
        // Left under way: the world waits for it when it goes.
        REQUIRE(thawWorld_StartSurface(other.world, &other.surface) == thawResult_ok);
    }
    CHECK(host.started > 90);
    CHECK(host.started == host.finished);
}

TEST_CASE("one mesh at a time, and none that was not started") {
    MeltingBlock f;
    thawSurfaceView view;
    CHECK(thawWorld_FinishSurface(f.world, &view) == thawResult_invalidArgument);
    CHECK(f.error().find("start one first") != std::string::npos);
    REQUIRE(thawWorld_StartSurface(f.world, &f.surface) == thawResult_ok);
    CHECK(thawWorld_StartSurface(f.world, &f.surface) == thawResult_invalidArgument);
    CHECK(thawWorld_ExtractSurface(f.world, &f.surface, &view) == thawResult_invalidArgument);
    CHECK(f.error().find("finish it first") != std::string::npos);
    CHECK(thawWorld_FinishSurface(f.world, nullptr) == thawResult_invalidArgument);
    CHECK(thawWorld_FinishSurface(f.world, &view) == thawResult_ok);
    CHECK(view.vertexCount > 100);
    f.surface.cellSize = 9;
    CHECK(thawWorld_StartSurface(f.world, &f.surface) == thawResult_invalidArgument);
    CHECK(f.error().find("cellSize") != std::string::npos);
    f.surface.cellSize = 1;
    CHECK(f.extract().vertexCount < view.vertexCount);
}

TEST_CASE("a mesh in the host's own layout") {
    MeltingBlock f(2);
    f.step(40);
    const thawSurfaceView view = f.extract();
    const size_t vertices = static_cast<size_t>(view.vertexCount),
                 indices = 3 * static_cast<size_t>(view.triangleCount);
    thawSurfaceBuffers b;
    thawInitSurfaceBuffers(&b);
    struct Vertex {
        float temperature;
        uint8_t mixture[8];
        float position[3];
        uint16_t body;
        uint8_t material, untouched;
        float normal[3], liquid;
    };
    std::vector<Vertex> out(vertices + 1);
    std::memset(static_cast<void*>(out.data()), 0xab, out.size() * sizeof(Vertex));
    std::vector<uint16_t> shorts(indices + 1, 0xabab);
    b.vertices = out.data(), b.vertexStride = sizeof(Vertex);
    b.temperatureOffset = 0, b.mixtureOffset = 4, b.positionOffset = 12, b.bodyOffset = 24, b.materialOffset = 26;
    b.normalOffset = 28, b.liquidFractionOffset = 40;
    b.indices = shorts.data(), b.indexSize = 2;
    b.vertexCapacity = view.vertexCount - 1, b.indexCapacity = 3 * view.triangleCount;
    CHECK(thawWorld_WriteSurface(f.world, &view, &b) == thawResult_capacity);
    CHECK(f.error().find(std::to_string(view.vertexCount)) != std::string::npos);
    ++b.vertexCapacity, --b.indexCapacity;
    CHECK(thawWorld_WriteSurface(f.world, &view, &b) == thawResult_capacity);
    CHECK(out[0].untouched == 0xab);
    CHECK(shorts[0] == 0xabab);
    ++b.indexCapacity;
    REQUIRE_MESSAGE(thawWorld_WriteSurface(f.world, &view, &b) == thawResult_ok, f.error());
    int wrong = 0;
    for (size_t v = 0; v < vertices; ++v) {
        wrong += std::memcmp(out[v].position, view.positions + 3 * v, 12) != 0;
        wrong += std::memcmp(out[v].normal, view.normals + 3 * v, 12) != 0;
        wrong += out[v].temperature != view.temperatures[v] || out[v].liquid != view.liquidFractions[v];
        wrong += out[v].material != view.materials[v] || out[v].body != view.bodies[v] || out[v].untouched != 0xab;
        wrong += std::memcmp(out[v].mixture, view.mixtures + 8 * v, 8) != 0;
    }
    for (size_t k = 0; k < indices; ++k) wrong += shorts[k] != view.indices[k];
    CHECK(wrong == 0);
    CHECK(out[vertices].untouched == 0xab);
    CHECK(shorts[indices] == 0xabab);

    // What does not fit is refused by name.
    const auto refused = [&](auto&& spoil, const char* name) {
        thawSurfaceBuffers bad = b;
        spoil(bad);
        CAPTURE(name);
        CHECK(thawWorld_WriteSurface(f.world, &view, &bad) == thawResult_invalidArgument);
        CHECK(f.error().find(name) != std::string::npos);
    };
    refused([](thawSurfaceBuffers& s) { s.vertexStride = 42; }, "vertexStride");
    refused([](thawSurfaceBuffers& s) { s.normalOffset = 36; }, "normalOffset");
    refused([](thawSurfaceBuffers& s) { s.bodyOffset = 25; }, "bodyOffset");
    refused([](thawSurfaceBuffers& s) { s.positionOffset = -2; }, "positionOffset");
    refused([](thawSurfaceBuffers& s) { s.positionOffset = INT32_MAX - 3; }, "positionOffset");
    refused([](thawSurfaceBuffers& s) { s.indexSize = 3; }, "indexSize");
    refused([](thawSurfaceBuffers& s) { s.indices = static_cast<char*>(s.indices) + 1; }, "indices");
    refused([](thawSurfaceBuffers& s) { s.vertices = nullptr; }, "vertices");
    refused([](thawSurfaceBuffers& s) { s.indices = nullptr; }, "indices");
    thawSurfaceBuffers never{};
    CHECK(thawWorld_WriteSurface(f.world, &view, &never) == thawResult_notInitialised);
    CHECK(thawWorld_WriteSurface(f.world, nullptr, &b) == thawResult_invalidArgument);
}

TEST_CASE("the plan says how coarse the mesh is, and a budget in units chooses the same again") {
    MeltingBlock f;
    f.step(30);
    std::vector<int> counts;
    for (int level = 0; level <= 3; ++level) {
        f.budget.work.surfaceLevel = level;
        f.step(1);
        const thawSurfaceView view = f.extract();
        CHECK(view.level == level);
        counts.push_back(view.vertexCount);
    }
    // In all a quarter; a thin film may fall between two cells or not.
    for (size_t k = 1; k < counts.size(); ++k) CHECK(counts[k] < 1.1 * counts[k - 1]);
    CHECK(counts[3] < 0.45 * counts[0]);
    CHECK(counts[3] > 0.15 * counts[0]);
    const auto chosen = [](float milliseconds) {
        MeltingBlock w;
        w.budget.mode = thawBudget_units;
        w.budget.surfaceMilliseconds = milliseconds;
        std::vector<int> levels;
        for (int k = 0; k < 120; ++k) {
            w.step(1);
            levels.push_back(w.extract().level);
        }
        return levels;
    };
    const std::vector<int> any = chosen(0), plenty = chosen(100), little = chosen(0.2f);
    CHECK(*std::max_element(any.begin(), any.end()) == 0);
    CHECK(*std::max_element(plenty.begin(), plenty.end()) == 0);
    CHECK(little.back() == 3);
    CHECK(little == chosen(0.2f));
}

namespace {

// Mean height of a block's lower face, in spacings, when it hangs so many above the floor.
float lowerFace(float gap) {
    WorldFixture f;
    f.def.gravity = {0, 0, 0};
    f.create();
    f.addMaterial();
    f.addFloor();
    const float spacing = f.def.particleSpacing, side = 8 * spacing;
    f.addBox({-side, gap * spacing, -side}, {side, gap * spacing + side, side}, 300);
    thawSurfaceDef def;
    thawInitSurfaceDef(&def);
    thawSurfaceView view;
    REQUIRE(thawWorld_ExtractSurface(f.world, &def, &view) == thawResult_ok);
    double sum = 0;
    int count = 0;
    for (int i = 0; i < view.vertexCount; ++i) {
        const float* x = view.positions + 3 * i;
        if (!(view.normals[3 * i + 1] < -0.9f) || std::max(std::abs(x[0]), std::abs(x[2])) > 0.7f * side) continue;
        sum += x[1] / spacing, ++count;
    }
    REQUIRE(count > 100);
    return float(sum / count);
}

} // namespace

TEST_CASE("the mesh reaches a wall that there is no room before") {
    for (float gap : {0.0f, 0.1f, 0.2f}) CHECK(std::abs(lowerFace(gap)) < 0.09f);
    CHECK(lowerFace(0.6f) == doctest::Approx(0.6).epsilon(0.1)); // for it is not there yet
}
