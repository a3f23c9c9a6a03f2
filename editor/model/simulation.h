// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "model/frame.h"
#include "model/live_world.h"
#include "model/mailbox.h"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <thread>

namespace thaw::editor {

/// Seconds of a steady clock that all spans use.
double now();

/// What the one who shows the simulation wants of it. All of it holds until it is said anew; what is counted is asked
/// for once each time that the number is another one.
struct Orders {
    std::shared_ptr<const scene::Scene> scene; // null: no world
    uint64_t revision = 0;                     // of it
    bool playing = false;
    float speed = 1;  // of the game against the clock, range 0.01..1
    float loopAt = 0; // s of motion after which it starts again; 0: it goes on
    uint64_t resets = 0, steps = 0;
    uint64_t seeks = 0;
    int64_t seekTo = 0; // frame that the last of them asked for
    thawBudget budget{};
    bool particles = false, featureSizes = false, splats = false; // wanted in frames
};

/// Runs a scene on a thread of its own. Whoever shows it sends orders and receives frames; neither side ever waits for
/// the other or takes memory while the other looks at it.
class Simulation {
public:
    /// threads: that step, range 1..64.
    explicit Simulation(int threads);
    ~Simulation();
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    void send(const Orders& orders);
    /// True when there was a newer frame.
    bool receive() { return frames_.take(); }
    const Frame& frame() const { return frames_.reading(); }

private:
    struct Worker;
    std::unique_ptr<Worker> worker_;
    Mailbox<Orders> orders_;
    Mailbox<Frame> frames_;
    std::atomic<uint32_t> wake_{0};
    std::atomic<bool> quit_{false};
    std::thread thread_;
};

} // namespace thaw::editor
