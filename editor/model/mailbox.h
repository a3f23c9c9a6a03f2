// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace thaw::editor {

/// Hands the newest of something from one thread to another: neither ever waits for the other, and what is in it keeps
/// its memory. Three of them: one is written, one is read, one lies between. What was not taken in time is written
/// over.
template <class T> class Mailbox {
public:
    /// The writer's.
    T& writing() { return slots_[writing_]; }
    /// What was written is the newest; writing() is another one, with something old in it.
    void send() { writing_ = between_.exchange(uint8_t(writing_ | kNew), std::memory_order_acq_rel) & kSlot; }
    /// Whether the reader has taken what was sent last. Writer's.
    bool taken() const { return !(between_.load(std::memory_order_acquire) & kNew); }

    /// The reader's. True when there was something newer: reading() is that now.
    bool take() {
        if (!(between_.load(std::memory_order_acquire) & kNew)) return false;
        reading_ = between_.exchange(reading_, std::memory_order_acq_rel) & kSlot;
        return true;
    }
    T& reading() { return slots_[reading_]; }
    const T& reading() const { return slots_[reading_]; }

private:
    static constexpr uint8_t kSlot = 3, kNew = 4;
    std::array<T, 3> slots_{};
    std::atomic<uint8_t> between_{1};
    uint8_t writing_ = 0, reading_ = 2;
};

} // namespace thaw::editor
