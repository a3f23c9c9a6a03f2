// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/tasks.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <limits>
#include <thread>
#include <vector>

using namespace thaw;

namespace {

thawTaskSystem ownPool(int workers) {
    thawTaskSystem s{};
    s.workerCount = workers;
    return s;
}

// A host that runs each task on a thread of its own, or refuses some by running them inline.
struct Host {
    int enqueued = 0, finished = 0, inFlight = 0, mostInFlight = 0;
    bool inlineEverySecond = false;
    void (*onStart)() = nullptr;

    static void* enqueue(thawTask* task, void* context, void* user) {
        Host* h = static_cast<Host*>(user);
        if (h->inlineEverySecond && h->enqueued++ % 2) {
            task(context);
            return nullptr;
        }
        h->mostInFlight = std::max(h->mostInFlight, ++h->inFlight);
        return new std::thread([task, context, h] {
            if (h->onStart) h->onStart(); // what the host's threads are like
            task(context);
        });
    }
    static void finish(void* handle, void* user) {
        Host* h = static_cast<Host*>(user);
        std::thread* t = static_cast<std::thread*>(handle);
        t->join();
        delete t;
        --h->inFlight, ++h->finished;
    }
    thawTaskSystem system(int workers) { return {workers, &enqueue, &finish, this}; }
};

void checkEveryBlockOnce(Tasks& tasks, int count, int blockSize) {
    std::vector<int> hits(static_cast<size_t>(count), 0);
    std::vector<int> blockHits(static_cast<size_t>(Tasks::blockCount(count, blockSize)), 0);
    std::atomic<int> wrong{0};
    tasks.forBlocks(count, blockSize, [&](int begin, int end, int block, int worker) {
        if (begin != block * blockSize || end != std::min(count, begin + blockSize)) ++wrong;
        if (worker < 0 || worker >= tasks.workerCount()) ++wrong;
        ++blockHits[static_cast<size_t>(block)];
        for (int i = begin; i < end; ++i) ++hits[static_cast<size_t>(i)];
    });
    CHECK(wrong == 0);
    CHECK(std::count(hits.begin(), hits.end(), 1) == count);
    CHECK(std::count(blockHits.begin(), blockHits.end(), 1) == static_cast<long>(blockHits.size()));
}

} // namespace

TEST_CASE("tasks: every block exactly once") {
    for (int workers : {1, 2, 3, 4, 8}) {
        CAPTURE(workers);
        Tasks tasks(ownPool(workers));
        CHECK(tasks.workerCount() == workers);
        for (int count : {1, 2, 7, 8, 100, 1001})
            for (int blockSize : {1, 3, 8, 1000, 5000}) checkEveryBlockOnce(tasks, count, blockSize);
        int calls = 0;
        tasks.forBlocks(0, 8, [&](int, int, int, int) { ++calls; });
        tasks.forBlocks(-5, 8, [&](int, int, int, int) { ++calls; });
        CHECK(calls == 0);
    }
    Tasks clamped(ownPool(0));
    CHECK(clamped.workerCount() == 1);
}

TEST_CASE("tasks: a range whose end is the largest int") {
    Tasks tasks(ownPool(2));
    std::atomic<int64_t> sum{0};
    const int most = std::numeric_limits<int>::max(), size = 1 << 28;
    tasks.forBlocks(most, size, [&](int begin, int end, int, int) { sum += int64_t(end) - begin; });
    CHECK(sum.load() == most);
}

TEST_CASE("tasks: many runs in a row, some after the workers fell asleep") {
    Tasks tasks(ownPool(3));
    std::vector<long> sums(64, 0);
    for (int run = 0; run < 3000; ++run) {
        if (run % 500 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        tasks.forBlocks(64, 1, [&](int begin, int, int, int) { sums[static_cast<size_t>(begin)] += run; });
    }
    for (long s : sums) CHECK(s == 3000L * 2999 / 2);
}

TEST_CASE("tasks: a slow block does not hold up the others") {
    Tasks tasks(ownPool(2));
    std::atomic<int> done{0};
    int doneWhenSlowEnds = 0;
    tasks.forBlocks(32, 1, [&](int, int, int block, int) {
        if (block == 0) { // waits for all others, its own share included: only stealing can do them
            auto giveUp = std::chrono::steady_clock::now() + std::chrono::seconds(20);
            while (done.load() < 31 && std::chrono::steady_clock::now() < giveUp) std::this_thread::yield();
            doneWhenSlowEnds = done.load();
        } else {
            ++done;
        }
    });
    CHECK(doneWhenSlowEnds == 31);
}

TEST_CASE("tasks: idle workers use no processor time") {
    Tasks tasks(ownPool(4));
    tasks.forBlocks(64, 1, [](int, int, int, int) {});
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    std::clock_t before = std::clock(); // of all threads
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    double seconds = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    CHECK(seconds < 0.02); // three that spin would use 0.2 to 0.6
}

TEST_CASE("tasks: the host's threads") {
    for (bool mixed : {false, true}) {
        Host host;
        host.inlineEverySecond = mixed;
        {
            Tasks tasks(host.system(4));
            CHECK(tasks.workerCount() == 4);
            for (int count : {1, 5, 100}) checkEveryBlockOnce(tasks, count, 3);
        }
        CHECK(host.inFlight == 0);
        CHECK(host.finished > 0);
        CHECK(host.mostInFlight <= 3);
        CHECK(host.mostInFlight >= 1);
    }
}

#if defined(__SSE2__)
#include <xmmintrin.h>

TEST_CASE("tasks: workers round and flush as the caller does") {
    const unsigned before = _mm_getcsr();
    for (bool hosted : {false, true}) {
        Host host;
        host.onStart = [] { _mm_setcsr(0x1f80); };
        Tasks tasks(hosted ? host.system(3) : ownPool(3));
        for (unsigned flush : {0x8040u, 0u}) { // flush to zero and denormals are zero, or neither
            _mm_setcsr((before & ~0x8040u) | flush);
            std::atomic<int> wrong{0}, helped{0};
            tasks.forBlocks(3, 1, [&](int, int, int, int worker) {
                volatile float tiny = 1e-30f;
                volatile float product = tiny * 1e-12f; // a denormal
                if ((product == 0) != (flush != 0)) ++wrong;
                if (worker != 0) ++helped;
                auto giveUp = std::chrono::steady_clock::now() + std::chrono::seconds(20);
                while (helped == 0 && std::chrono::steady_clock::now() < giveUp) std::this_thread::yield();
            });
            CHECK(wrong.load() == 0);
            CHECK(helped.load() > 0);
        }
        _mm_setcsr(before);
    }
}
#endif

TEST_CASE("tasks: fewer workers do the same, and those that are left out stay out") {
    Tasks tasks(ownPool(4));
    Host host;
    Tasks hosted(host.system(4));
    for (Tasks* t : {&tasks, &hosted})
        for (const int used : {3, 1, 2, 4, 99, 0}) {
            t->useWorkers(used);
            const int most = std::clamp(used, 1, 4);
            std::atomic<int> outsiders{0};
            for (int k = 0; k < 20; ++k) {
                std::vector<int> hits(500, 0);
                t->forBlocks(500, 10, [&](int begin, int end, int, int worker) {
                    outsiders += worker >= most;
                    for (int i = begin; i < end; ++i) ++hits[static_cast<size_t>(i)];
                });
                CHECK(std::count(hits.begin(), hits.end(), 1) == 500);
            }
            CHECK(outsiders == 0);
        }
    CHECK(tasks.takeStalledMs() >= 0);
    CHECK(tasks.takeStalledMs() == 0);
}

TEST_CASE("tasks: what the caller waits for a worker that does not get on is counted") {
    Tasks tasks(ownPool(2));
    float stalled = 0;
    for (int k = 0; k < 20 && stalled < 4; ++k) { // the worker may come too late to take its block
        std::atomic<bool> inside{false};
        tasks.forBlocks(2, 1, [&](int, int, int, int worker) {
            if (worker == 1) {
                inside = true;
                std::this_thread::sleep_for(std::chrono::milliseconds(10));
            } else {
                const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(50);
                while (!inside && std::chrono::steady_clock::now() < until) std::this_thread::yield();
            }
        });
        stalled += tasks.takeStalledMs();
    }
    CHECK(stalled >= 4);
}
