// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/tasks.h"

#include "base/float_mode.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace thaw {
namespace {

constexpr int kMaxWorkers = 64;
// A step is a chain of runs a few microseconds apart: a worker that slept between them would cost a system call (about
// 5 us) each time. Longer gaps are the host's frame, where spinning would burn a core for nothing.
constexpr auto kSpin = std::chrono::microseconds(40);

inline void relax() {
#if defined(__SSE2__)
    _mm_pause();
#else
    std::this_thread::yield();
#endif
}

// Without the overflow of begin + blockSize.
int blockEnd(const Tasks::Job& job, int begin) {
    return job.count - begin <= job.blockSize ? job.count : begin + job.blockSize;
}

} // namespace

struct Tasks::Impl {
    // Own line each, so that a worker that takes its own blocks does not disturb the others.
    struct alignas(64) Share {
        std::atomic<int> next{0};
        int end = 0;
        Impl* impl = nullptr; // context of a host task
        int worker = 0;
        void* handle = nullptr;
    };

    thawTaskSystem system{};
    int workers = 1;
    std::atomic<int> used{1}; // of them; changes between jobs
    float stalledMs = 0;
    Share shares[kMaxWorkers];
    Job job{};
    FloatMode mode;

    // Own pool. gate: bit 31 a job is open, bits 8..30 its number, bits 0..7 workers inside. Who finds it closed was
    // not needed; the caller only waits for those inside, never for one that the system has not scheduled yet.
    static constexpr uint32_t kOpen = 1u << 31, kNumberStep = 1u << 8, kNumberMask = 0x7fffff00u, kInsideMask = 0xffu;
    alignas(64) std::atomic<uint32_t> gate{0};
    alignas(64) std::atomic<int> sleepers{0};
    std::atomic<bool> quit{false};
    std::mutex mutex;
    std::condition_variable wake;
    std::thread threads[kMaxWorkers];

    void work(int worker) {
        for (int s = 0; s < workers; ++s) { // own share first, then the next one's
            int owner = worker + s < workers ? worker + s : worker + s - workers;
            Share& share = shares[owner];
            while (share.next.load(std::memory_order_relaxed) < share.end) {
                int block = share.next.fetch_add(1, std::memory_order_relaxed);
                if (block >= share.end) break;
                int begin = block * job.blockSize;
                job.call(job.context, begin, blockEnd(job, begin), block, worker);
            }
        }
    }

    static void hostTask(void* context) {
        Share* share = static_cast<Share*>(context);
        FloatMode own;
        share->impl->mode.apply();
        share->impl->work(share->worker);
        own.apply();
    }

    void threadMain(int worker) {
        uint32_t last = 0; // number of the last job seen; the first has 1
        for (;;) {
            uint32_t seen = waitForJob(last);
            if (quit.load()) return;
            last = seen & kNumberMask;
            if (worker >= used.load(std::memory_order_relaxed)) continue;
            while ((seen & kOpen) && (seen & kNumberMask) == last)
                if (gate.compare_exchange_weak(seen, seen + 1)) {
                    mode.apply();
                    work(worker);
                    gate.fetch_sub(1);
                    break;
                }
        }
    }

    bool news(uint32_t g, uint32_t last) const { return ((g & kOpen) && (g & kNumberMask) != last) || quit.load(); }

    uint32_t waitForJob(uint32_t last) {
        auto until = std::chrono::steady_clock::now() + kSpin;
        do {
            for (int k = 0; k < 64; ++k, relax()) {
                uint32_t g = gate.load();
                if (news(g, last)) return g;
            }
        } while (std::chrono::steady_clock::now() < until);
        std::unique_lock<std::mutex> lock(mutex);
        // Sequentially consistent on both sides: either the caller sees this sleeper, or the sleeper sees the open
        // gate.
        sleepers.fetch_add(1);
        uint32_t g;
        while (!news(g = gate.load(), last)) wake.wait(lock);
        sleepers.fetch_sub(1);
        return g;
    }

    void wakeUp(int wanted) {
        int asleep = sleepers.load();
        if (asleep == 0) return;
        { std::lock_guard<std::mutex> lock(mutex); } // who is about to wait has checked the gate before or waits now
        if (wanted >= asleep || used.load(std::memory_order_relaxed) < workers) // one alone may be the wrong one
            wake.notify_all();
        else
            for (int k = 0; k < wanted; ++k) wake.notify_one();
    }

    void stop() {
        quit.store(true);
        { std::lock_guard<std::mutex> lock(mutex); }
        wake.notify_all();
        for (std::thread& t : threads)
            if (t.joinable()) t.join();
    }
};

Tasks::Tasks(const thawTaskSystem& system) : impl_(std::make_unique<Impl>()) {
    Impl& p = *impl_;
    p.system = system;
    p.workers = std::clamp(system.workerCount, 1, kMaxWorkers);
    p.used = p.workers;
    for (int w = 0; w < p.workers; ++w) p.shares[w].impl = &p, p.shares[w].worker = w;
    if (system.enqueue) return;
    try {
        for (int w = 1; w < p.workers; ++w) p.threads[w] = std::thread(&Impl::threadMain, &p, w);
    } catch (...) {
        p.stop();
        throw;
    }
}

Tasks::~Tasks() { impl_->stop(); }

int Tasks::workerCount() const { return impl_->workers; }

void Tasks::useWorkers(int count) {
    impl_->used.store(std::clamp(count, 1, impl_->workers), std::memory_order_relaxed);
}

float Tasks::takeStalledMs() {
    const float ms = impl_->stalledMs;
    impl_->stalledMs = 0;
    return ms;
}

void Tasks::run(const Job& wanted) {
    Impl& p = *impl_;
    const int used = p.used.load(std::memory_order_relaxed);
    Job job = wanted;
    if (job.blockSize < 1) job.blockSize = 1;
    int blocks = static_cast<int>((static_cast<int64_t>(job.count) + job.blockSize - 1) / job.blockSize);
    if (used == 1 || blocks == 1) {
        for (int b = 0; b < blocks; ++b) {
            int begin = b * job.blockSize;
            job.call(job.context, begin, blockEnd(job, begin), b, 0);
        }
        return;
    }

    p.job = job;
    p.mode = FloatMode();
    for (int w = 0; w < p.workers; ++w) { // who does not take part has none of them
        const int share = std::min(w, used), next = std::min(w + 1, used);
        p.shares[w].next.store(static_cast<int>(static_cast<int64_t>(blocks) * share / used),
                               std::memory_order_relaxed);
        p.shares[w].end = static_cast<int>(static_cast<int64_t>(blocks) * next / used);
    }
    int helpers = std::min(used, blocks) - 1;

    if (p.system.enqueue) {
        for (int w = 1; w <= helpers; ++w)
            p.shares[w].handle = p.system.enqueue(&Impl::hostTask, &p.shares[w], p.system.user);
        p.work(0);
        for (int w = 1; w <= helpers; ++w)
            if (p.shares[w].handle) p.system.finish(p.shares[w].handle, p.system.user);
        return;
    }

    uint32_t number = (p.gate.load() + Impl::kNumberStep) & Impl::kNumberMask;
    p.gate.store(Impl::kOpen | number);
    p.wakeUp(helpers);
    p.work(0);
    p.gate.fetch_and(~Impl::kOpen);
    for (int k = 0; p.gate.load() & Impl::kInsideMask; ++k) {
        if (k < 4096) {
            relax();
            continue;
        }
        const auto start = std::chrono::steady_clock::now();
        while (p.gate.load() & Impl::kInsideMask) std::this_thread::yield(); // the one inside may need this core
        p.stalledMs += std::chrono::duration<float, std::milli>(std::chrono::steady_clock::now() - start).count();
        break;
    }
}

} // namespace thaw
