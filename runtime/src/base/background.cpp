// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/background.h"

#include "base/float_mode.h"

#include <condition_variable>
#include <mutex>
#include <thread>

namespace thaw {

struct Background::Impl {
    thawTaskSystem system{};
    thawTask* task = nullptr;
    void* context = nullptr;
    FloatMode mode;
    void* handle = nullptr; // of a host's task

    std::mutex mutex;
    std::condition_variable changed;
    bool given = false, quit = false; // under mutex
    std::thread thread;

    static void run(void* self) {
        Impl& p = *static_cast<Impl*>(self);
        const FloatMode own;
        p.mode.apply();
        p.task(p.context);
        own.apply();
    }

    void main() {
        std::unique_lock<std::mutex> lock(mutex);
        for (;;) {
            changed.wait(lock, [&] { return given || quit; });
            if (!given) return;
            lock.unlock();
            run(this);
            lock.lock();
            given = false;
            changed.notify_all();
        }
    }
};

Background::Background(const thawTaskSystem& system) : impl_(std::make_unique<Impl>()) { impl_->system = system; }

Background::~Background() {
    wait();
    if (!impl_->thread.joinable()) return;
    {
        const std::lock_guard<std::mutex> lock(impl_->mutex);
        impl_->quit = true;
    }
    impl_->changed.notify_all();
    impl_->thread.join();
}

void Background::start(thawTask* task, void* context) {
    Impl& p = *impl_;
    p.task = task, p.context = context;
    p.mode = FloatMode();
    if (p.system.enqueue) {
        p.handle = p.system.enqueue(&Impl::run, &p, p.system.user);
    } else {
        if (!p.thread.joinable()) p.thread = std::thread(&Impl::main, &p);
        const std::lock_guard<std::mutex> lock(p.mutex);
        p.given = true;
        p.changed.notify_all();
    }
    busy_ = true;
}

void Background::wait() {
    if (!busy_) return;
    Impl& p = *impl_;
    if (p.system.enqueue) {
        if (p.handle) p.system.finish(p.handle, p.system.user);
        p.handle = nullptr;
    } else {
        std::unique_lock<std::mutex> lock(p.mutex);
        p.changed.wait(lock, [&] { return !p.given; });
    }
    busy_ = false;
}

} // namespace thaw
