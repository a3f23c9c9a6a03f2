// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/kernel.h"
#include "particles/particles.h"

// What hangs together with what.
namespace thaw {

// In spacings. Touching: the 18 nearest of a cubic lattice (1.41 spacings) are links, the 8 body diagonals (1.73) are
// not. A wall nearer than kAnchor is one to hang on.
inline constexpr float kLink = 1.5f, kAnchor = 1.0f;

inline bool linked(const Particles& p, uint32_t i, uint32_t j) {
    const Vec4 x = p.position[i], y = p.position[j];
    // Pairs of level 1 lie end to end in two of their edges: 1.59 spacings.
    const float stretch = p.level[i] == 1 && p.level[j] == 1 ? 1.1f : 1.0f;
    const float reach = stretch * kLink * 0.5f * (x.w + y.w) / kSupport;
    const Vec3 d = y.xyz() - x.xyz();
    return dot(d, d) < reach * reach;
}

} // namespace thaw
