// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/memory.h"

namespace thaw {

void* Allocator::allocate(size_t size, size_t alignment) {
    const std::lock_guard<std::mutex> lock(mutex_);
    void* memory = hook_.alloc ? hook_.alloc(size, alignment, hook_.user)
                               : ::operator new(size, std::align_val_t(alignment), std::nothrow);
    if (!memory) throw std::bad_alloc();
    bytes_ += size;
    ++calls_;
    return memory;
}

void Allocator::release(void* memory, size_t size, size_t alignment) noexcept {
    if (!memory) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    bytes_ -= size;
    if (hook_.free)
        hook_.free(memory, size, hook_.user);
    else
        ::operator delete(memory, std::align_val_t(alignment));
}

size_t Allocator::bytes() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return bytes_;
}

size_t Allocator::calls() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return calls_;
}

} // namespace thaw
