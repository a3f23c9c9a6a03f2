// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "thaw/thaw.h"

#include <cstddef>
#include <cstring>
#include <mutex>
#include <new>
#include <type_traits>
#include <utility>

namespace thaw {

// All memory of a world goes through here: the host's hook, or the C++ runtime. Counts what is out.
// allocate throws std::bad_alloc, which the C boundary turns into thawResult_outOfMemory.
class Allocator {
public:
    explicit Allocator(const thawAllocator& hook = {}) : hook_(hook) {}
    Allocator(const Allocator&) = delete;
    Allocator& operator=(const Allocator&) = delete;

    void* allocate(size_t size, size_t alignment);
    void release(void* memory, size_t size, size_t alignment) noexcept;
    size_t bytes() const;
    size_t calls() const; // allocations since creation: a step after warm-up must not raise it

private:
    thawAllocator hook_;
    mutable std::mutex mutex_; // a mesh may be made while the world steps
    size_t bytes_ = 0, calls_ = 0;
};

// A growable array of plain data, 64-byte aligned. Growing keeps the contents; new elements are value-initialised.
template <class T> class Array {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    explicit Array(Allocator& allocator) : allocator_(&allocator) {}
    Array(const Array&) = delete;
    Array& operator=(const Array&) = delete;
    Array(Array&& o) noexcept : Array(*o.allocator_) { swap(o); }
    Array& operator=(Array&& o) noexcept {
        swap(o);
        return *this;
    }
    ~Array() { free(); }

    void swap(Array& o) noexcept {
        std::swap(allocator_, o.allocator_), std::swap(data_, o.data_);
        std::swap(size_, o.size_), std::swap(capacity_, o.capacity_);
    }
    void reserve(size_t capacity) {
        if (capacity <= capacity_) return;
        T* data = static_cast<T*>(allocator_->allocate(capacity * sizeof(T), kAlignment));
        if (size_) std::memcpy(static_cast<void*>(data), data_, size_ * sizeof(T));
        size_t size = size_;
        free();
        data_ = data, capacity_ = capacity, size_ = size;
    }
    void resize(size_t size) {
        if (size > capacity_) reserve(size + size / 2);
        for (size_t i = size_; i < size; ++i) new (data_ + i) T();
        size_ = size;
    }
    // Without initialising: for scratch that is written before it is read.
    void resizeRaw(size_t size) {
        if (size > capacity_) reserve(size + size / 4);
        size_ = size;
    }
    void assign(size_t size, const T& value) {
        resizeRaw(size);
        for (size_t i = 0; i < size; ++i) data_[i] = value;
    }
    void push(const T& value) {
        if (size_ == capacity_) {
            T copy = value;
            reserve(capacity_ ? 2 * capacity_ : 16);
            data_[size_++] = copy;
        } else {
            data_[size_++] = value;
        }
    }
    void clear() { size_ = 0; }

    T* data() { return data_; }
    const T* data() const { return data_; }
    size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    T& operator[](size_t i) { return data_[i]; }
    const T& operator[](size_t i) const { return data_[i]; }
    T* begin() { return data_; }
    T* end() { return data_ + size_; }
    const T* begin() const { return data_; }
    const T* end() const { return data_ + size_; }
    Allocator& allocator() const { return *allocator_; }

private:
    static constexpr size_t kAlignment = alignof(T) > 64 ? alignof(T) : 64;
    void free() noexcept {
        if (data_) allocator_->release(data_, capacity_ * sizeof(T), kAlignment);
        data_ = nullptr, size_ = capacity_ = 0;
    }
    Allocator* allocator_;
    T* data_ = nullptr;
    size_t size_ = 0, capacity_ = 0;
};

} // namespace thaw
