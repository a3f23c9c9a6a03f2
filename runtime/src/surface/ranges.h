// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"

#include <cstdint>

namespace thaw {

// Ranges of one long array, for things whose size changes from time to time: what does not change does not move. Sizes
// come in steps, and what is given back is taken by the next of its step.
class RangePool {
public:
    struct Range {
        uint32_t begin = 0, capacity = 0;
    };

    explicit RangePool(Allocator& allocator) : next_(allocator) { clear(); }
    void clear(); // forgets all ranges
    // Makes room for count, nothing for 0; keeps the place where it fits and is not far too large.
    void fit(Range& range, uint32_t count);
    size_t size() const { return next_.size() * kUnit; } // of the array that holds all ranges

private:
    static constexpr uint32_t kUnit = 16, kSteps = 48, kNone = ~0u;
    uint32_t heads_[kSteps];
    Array<uint32_t> next_; // per unit: the next free range of the same step, in units
};

} // namespace thaw
