// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "thaw/thaw.h"

#include <cstddef>
#include <vector>

namespace thaw::editor {

/// Lines as they are drawn by hand: made even, smooth, and changed point by point. Lengths in m.

float lengthOf(const std::vector<thawVec3>& line, bool closed);
/// As many points as come closest to even steps of `step` along the line, at least 2 (3 when closed); the first and the
/// last stay where they are.
std::vector<thawVec3> resampled(const std::vector<thawVec3>& line, float step, bool closed);
/// Takes the trembling of a hand out: passes of two steps, one back, so that the line does not shrink (G. Taubin,
/// 1995). Ends stay. passes: range 0..100.
std::vector<thawVec3> smoothed(std::vector<thawVec3> line, int passes, bool closed);

struct Nearest {
    size_t segment = 0; // from this point to the next
    float along = 0;    // 0..1 on it
    float distance = 0;
    thawVec3 point{};
};
/// Of a line that has a point at least.
Nearest nearestOn(const std::vector<thawVec3>& line, thawVec3 to, bool closed);

/// What is left of an open line after all within `radius` of a point is gone: none, one or several lines with at least
/// two points each.
std::vector<std::vector<thawVec3>> cutOut(const std::vector<thawVec3>& line, thawVec3 center, float radius);

} // namespace thaw::editor
