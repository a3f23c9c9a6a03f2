// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "thaw/thaw.h"

#include <memory>

namespace thaw {

// One thing at a time beside the caller: on a task of the host, or on an own thread that the first one makes.
class Background {
public:
    explicit Background(const thawTaskSystem& system);
    ~Background(); // waits for what is under way
    Background(const Background&) = delete;
    Background& operator=(const Background&) = delete;

    // Starts task(context), which must not throw, with the caller's rounding and denormals; nothing else may be under
    // way. Throws std::bad_alloc or std::system_error, and has then not started it.
    void start(thawTask* task, void* context);
    void wait();                        // until it is done
    bool busy() const { return busy_; } // started and not waited for

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    bool busy_ = false;
};

} // namespace thaw
