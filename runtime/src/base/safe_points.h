// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>

namespace thaw {

// Where a step that runs late may give up work: places that the stepping thread passes in an order that depends on the
// step's inputs alone. Against a clock it notes at which of them the step was late; given that number, a step without a
// clock gives up the same.
class SafePoints {
public:
    using Clock = std::chrono::steady_clock;

    // From `lateAfter` on it is late; 0: never.
    void count(int32_t lateAfter) { *this = {}, after_ = lateAfter; }
    // Late when, at one of them, the time since `start` and the rest together are more than `milliseconds`.
    void watch(Clock::time_point start, float milliseconds) {
        *this = {}, start_ = start, budget_ = milliseconds, watches_ = true;
    }
    // ms that are still to come after the points that follow, until said anew.
    void expect(float rest) { rest_ = rest; }

    // Passes one. Once late, it stays so until the end of the step.
    bool late() {
        ++passed_;
        if (at_ > 0) return true;
        const bool now = watches_
                             ? std::chrono::duration<float, std::milli>(Clock::now() - start_).count() + rest_ > budget_
                             : passed_ == after_;
        if (now) at_ = passed_;
        return now;
    }
    // The number of the one where it was, 0: it was not.
    int32_t lateAt() const { return at_; }

private:
    Clock::time_point start_{};
    float budget_ = 0, rest_ = 0;
    int32_t after_ = 0, passed_ = 0, at_ = 0;
    bool watches_ = false;
};

} // namespace thaw
