// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/ranges.h"

namespace thaw {
namespace {

// 1, 2, 3, 4, 6, 8, 12, 16, ... units
uint32_t unitsOf(uint32_t step) {
    if (step < 2) return step + 1;
    return (step & 1 ? 4u : 3u) << ((step - 2) / 2);
}

uint32_t stepFor(uint32_t units) {
    uint32_t step = 0;
    while (unitsOf(step) < units) ++step;
    return step;
}

} // namespace

void RangePool::clear() {
    for (uint32_t& head : heads_) head = kNone;
    next_.clear();
}

void RangePool::fit(Range& range, uint32_t count) {
    if (count <= range.capacity && (count > 0) == (range.capacity > 0) && count * 4 + 4 * kUnit >= range.capacity)
        return;
    if (range.capacity > 0) {
        const uint32_t step = stepFor(range.capacity / kUnit);
        next_[range.begin / kUnit] = heads_[step];
        heads_[step] = range.begin / kUnit;
        range = {};
    }
    if (count == 0) return;
    const uint32_t step = stepFor((count + kUnit - 1) / kUnit), units = unitsOf(step);
    uint32_t at = heads_[step];
    if (at != kNone) {
        heads_[step] = next_[at];
    } else {
        at = uint32_t(next_.size());
        next_.resizeRaw(at + units);
    }
    range = {at * kUnit, units * kUnit};
}

} // namespace thaw
