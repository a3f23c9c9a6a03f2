// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <thread>
#include <vector>

namespace thaw::player {

// Threads that take a core each, as another program would, for as long as this lives.
class Busy {
public:
    explicit Busy(int threads) {
        for (int k = 0; k < threads; ++k)
            threads_.emplace_back([this] {
                for (volatile unsigned n = 0; !stop_.load(std::memory_order_relaxed);) n = n + 1;
            });
    }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;
    ~Busy() {
        stop_ = true;
        for (std::thread& t : threads_) t.join();
    }

private:
    std::atomic<bool> stop_{false};
    std::vector<std::thread> threads_;
};

} // namespace thaw::player
