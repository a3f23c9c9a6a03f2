// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "player/scene.h"

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace thaw::editor {

/// What of a scene its melt depends on, as a number: not names, camera, looks and budget.
uint64_t meltHash(const scene::Scene& scene);

/// How a scene melts when time does not count: finest particles, many sub-steps and iterations, all rays. What a run
/// within a budget gives up is seen beside it.
struct Reference {
    struct Row {
        float time = 0, melted = 0, meanTemperature = 0; // s, 1, K
    };
    uint64_t hash = 0;     // meltHash of its scene
    std::vector<Row> rows; // by time

    /// Between two rows; nothing outside of them.
    std::optional<Row> at(double time) const;
};

/// Beside the scene: candle.json has candle.reference.csv.
std::string referencePath(const std::string& scenePath);
/// Nothing when there is no such file, or it is not one.
std::optional<Reference> loadReference(const std::string& path);
/// Throws std::runtime_error.
void saveReference(const Reference& reference, const std::string& path);

/// Makes a reference on a thread of its own.
class ReferenceRun {
public:
    ReferenceRun() = default;
    ~ReferenceRun() { cancel(); }
    ReferenceRun(const ReferenceRun&) = delete;
    ReferenceRun& operator=(const ReferenceRun&) = delete;

    /// Of the length that the scene says. One at a time: another one ends that.
    void start(const scene::Scene& scene, int threads);
    void cancel();
    bool running() const { return thread_.joinable() && !done_; }
    float progress() const { return progress_; }
    /// What it made, or why not, once.
    struct Result {
        Reference reference;
        std::string error;
    };
    std::optional<Result> take();

private:
    void run(const scene::Scene& scene, int threads);
    std::thread thread_;
    std::atomic<bool> quit_{false}, done_{false};
    std::atomic<float> progress_{0};
    Result result_;
};

} // namespace thaw::editor
