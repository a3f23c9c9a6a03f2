// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "thaw/thaw.h"

#include <cstdint>
#include <string>
#include <vector>

namespace thaw::player {

// Everything that is said about a run; filled step by step.
class Report {
public:
    // How the run was set up.
    std::string name;
    int threads = 1;
    thawBudget budget{};
    float limitMs = 4.0f; // frames are counted against it also when the budget is work units

    // What controls did by the end, for those that the scene has.
    struct PathNote {
        std::string name;
        thawPathState state;
    };
    struct ShapeNote {
        std::string name;
        thawShapeState state;
    };
    std::vector<PathNote> paths;
    std::vector<ShapeNote> shapes;

    // Notes what the last step did. ms: wall clock of the call, by the caller's own watch.
    void addStep(const thawWorld* world, double ms, uint32_t status);
    double heatShare() const; // of the time of all stages: radiation, conduction, loss, and phase
    // Notes the state at the end; call once, after the last step.
    void finish(const thawWorld* world);

    size_t steps() const { return milliseconds_.size(); }
    double percentile(double share) const;
    size_t framesOver() const;
    uint32_t statusUnion() const;
    uint32_t lastStatus() const { return lastStatus_; }
    double lastMilliseconds() const { return milliseconds_.empty() ? 0 : milliseconds_.back(); }
    const thawCounters& counters() const { return counters_; }
    uint64_t hash() const { return hash_; }
    // What is wrong with the run, one line a fault; empty when it is sound.
    std::vector<std::string> faults() const;

    std::string table() const; // several lines, for people
    std::string json() const;  // the same and more, for programs
    std::string csvHeader() const;
    std::string csvLine() const; // of the last step

private:
    std::vector<double> milliseconds_;
    std::vector<size_t> statusCounts_ = std::vector<size_t>(32, 0);
    double stageMs_[thawStage_count] = {};
    size_t stageRuns_[thawStage_count] = {};
    double subSteps_ = 0, pressure_ = 0, viscosity_ = 0, rays_ = 0;
    int mostSubSteps_ = 0, mostPressure_ = 0, mostViscosity_ = 0;
    uint32_t lastStatus_ = 0;
    thawCounters counters_{};
    thawProfile profile_{};
    thawPlan plan_{};
    thawLedger ledger_{};
    uint64_t hash_ = 0;
};

// Nearest rank: the smallest value that `share` of all do not exceed. 0 of none.
double percentile(std::vector<double> values, double share);
// Bits in words, "nothing" for none.
std::string statusWords(uint32_t status);
std::string hashText(uint64_t hash);
std::string budgetText(const thawBudget& budget); // in words
// printf into a string.
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
std::string
formatted(const char* format, ...);

} // namespace thaw::player
