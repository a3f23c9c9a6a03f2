// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/tasks.h"
#include "geometry/colliders.h"
#include "motion/rigid.h"
#include "neighbors/neighbors.h"
#include "particles/particles.h"

namespace thaw {

struct AnchorFrame {
    Particles& particles;
    const Neighbors& neighbors; // of this step
    const Collider* colliders;
    int colliderCount;
    Tasks& tasks;
    Rigid& rigid;
    const uint16_t* mouldOn; // per shape, see HoldFrame
};

// Which collider each held piece hangs on, of those that are told apart (carry.h); pieces on all others hang on the
// world, which stands still. A piece is what hangs together through held particles of one anchor. It keeps its anchor
// as long as it touches it; a piece that something comes into which does not move with it comes loose as a whole: it
// goes on as a rigid piece, or as loose particles where it is small or soft, and is pushed.
class Anchors {
public:
    explicit Anchors(Allocator& allocator)
        : colliderBounds_(allocator), state_(allocator), queue_(allocator), touched_(allocator), found_(allocator) {}
    // Whether a held particle and a wall, or two held ones of different anchors, come into each other.
    bool pressed(const AnchorFrame& f);
    // Finds the pieces, what they hang on, and lets go of the pressed ones. fresh: colliders came to be told apart
    // since the last time, so that what hung on the world may hang on them. Returns how many particles came loose.
    int update(const AnchorFrame& f, bool fresh);

private:
    bool pressedAt(const AnchorFrame& f, size_t row, uint16_t anchor) const;
    void bounds(const AnchorFrame& f);

    Array<Box> colliderBounds_;
    Array<uint8_t> state_;   // per row: seen
    Array<uint32_t> queue_;  // rows of the piece in hand
    Array<int32_t> touched_; // per anchor: rows of the piece that touch it
    Array<uint8_t> found_;   // per block
};

} // namespace thaw
