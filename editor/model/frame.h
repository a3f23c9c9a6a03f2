// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "player/scene.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace thaw::editor {

/// Copies of what a world shows, which stay when it steps on. They keep their memory.
class MeltMesh {
public:
    void copy(const thawSurfaceView& from);
    thawSurfaceView view() const;

private:
    std::vector<float> positions_, normals_, temperatures_, liquid_;
    std::vector<uint8_t> materials_, mixtures_;
    std::vector<uint16_t> bodies_;
    std::vector<uint32_t> indices_;
    int32_t level_ = 0;
};

class MeltParticles {
public:
    void copy(const thawParticleView& from, const float* featureSizes);
    void copySplats(const thawSplatView& from);
    void clear();
    thawParticleView view() const;
    thawSplatView splats() const;
    /// As many as particles, or none.
    const std::vector<float>& featureSizes() const { return features_; }

private:
    int32_t moving_ = 0;
    std::vector<float> positions_, velocities_, temperatures_, liquid_, normals_, features_, centers_, axes_;
    std::vector<uint32_t> ids_;
    std::vector<uint16_t> bodies_;
    std::vector<uint8_t> materials_, flags_, absorptivities_, levels_;
};

/// What one step took and gave, for graphs.
struct StepSample {
    int64_t frame = 0;   // that it led to
    thawProfile profile; // ms
    float surfaceMs = 0; // of making the mesh after it; 0: not made
    float budgetMs = 0;
    uint32_t status = 0; // thawStepStatus bits
    thawWork work;
    std::array<int32_t, 4> levels{};
    float melted = 0, meanTemperature = 0; // 1, K: mass-weighted
};

/// Who did what when, for the timeline of threads. Seconds of one steady clock.
enum class SpanKind : uint8_t { step, surface, copy, build, rewind, panels, draw };
struct Span {
    double start = 0, end = 0;
    SpanKind kind = SpanKind::step;
};

/// The last N of something.
template <class T, int N> class Last {
public:
    void add(const T& item) { items_[size_t(count_++ % N)] = item; }
    void clear() { count_ = 0; }
    int size() const { return int(count_ < N ? count_ : N); }
    /// 0: the oldest that is there.
    const T& operator[](int i) const { return items_[size_t((count_ - size() + i) % N)]; }
    const T& newest() const { return (*this)[size() - 1]; }
    void replaceNewest(const T& item) { items_[size_t((count_ - 1) % N)] = item; }

private:
    std::array<T, size_t(N)> items_{};
    int64_t count_ = 0;
};

/// What the simulation shows of itself at one time.
struct Frame {
    int64_t frame = 0;                                // steps since the start
    double time = 0;                                  // s of motion
    bool built = false;                               // there is a world
    bool working = false;                             // what was asked for last is not in here yet
    uint64_t revision = 0;                            // of the scene that this shows
    uint64_t resets = 0;                              // Orders::resets that were carried out
    std::shared_ptr<const scene::Scene> scene;        // null before the first
    std::shared_ptr<const scene::SceneMeshes> meshes; // of it
    /// Why there is no world, or why the last change did not get into it; "" when all is well.
    std::string error;

    MeltMesh mesh;
    MeltParticles particles;      // empty unless asked for
    std::vector<int> bodyOfIndex; // thawSurfaceView's and thawParticleView's body to Scene::bodies; -1: gone
    std::vector<int> materialOfIndex;

    thawCounters counters{};
    thawPlan plan{};
    thawLedger ledger{};
    std::vector<thawBodyState> bodies;
    std::vector<scene::Placement> colliders; // where they are
    std::vector<thawMeshReport> bodyReports;
    std::vector<thawPathState> paths;
    std::vector<thawShapeState> shapes;
    Last<StepSample, 480> steps;
    Last<Span, 512> spans;
    int64_t oldest = 0, newest = 0; // frames that can be gone back and forth to
    size_t snapshotBytes = 0;
};

} // namespace thaw::editor
