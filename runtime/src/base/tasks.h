// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "thaw/thaw.h"

#include <algorithm>
#include <memory>
#include <type_traits>

namespace thaw {

// Fork-join over fixed blocks of an index range. Blocks depend on the range only, never on the number of workers, so
// whatever is reduced in block order has the same bits on any number of threads. Each worker owns a contiguous share of
// the blocks and steals only when it is done (one shared counter was 20 % slower, KERNELS.md 6.8).
class Tasks {
public:
    // Own pool of workers - 1 threads, or the host's hooks. Throws std::bad_alloc or std::system_error.
    explicit Tasks(const thawTaskSystem& system);
    ~Tasks();
    Tasks(const Tasks&) = delete;
    Tasks& operator=(const Tasks&) = delete;

    int workerCount() const;
    // Of them, so many take part from now on, 1 to workerCount(): the bits are the same.
    void useWorkers(int count);
    // ms since the last call that the caller waited for workers which had begun and did not get on. Of the own pool.
    float takeStalledMs();

    // Calls f(begin, end, block, worker) for every block [begin, end) of [0, count). f must not throw.
    template <class F> void forBlocks(int count, int blockSize, F&& f) {
        if (count <= 0) return;
        using Fn = std::remove_reference_t<F>;
        Job job{[](void* context, int begin, int end, int block, int worker) {
                    (*static_cast<Fn*>(context))(begin, end, block, worker);
                },
                const_cast<void*>(static_cast<const void*>(&f)), count, blockSize};
        run(job);
    }
    static int blockCount(int count, int blockSize) { return (count + blockSize - 1) / blockSize; }

    struct Job {
        void (*call)(void* context, int begin, int end, int block, int worker);
        void* context;
        int count, blockSize;
    };

private:
    void run(const Job& job);
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace thaw
