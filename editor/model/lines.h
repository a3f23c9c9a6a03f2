// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "model/items.h"

#include <vector>

namespace thaw::editor {

/// Paths and contours alike: lines through points.
struct Line {
    std::vector<thawVec3> points; // m, in the world
    bool closed = false;
};
/// The lines of a path or shape, none of anything else.
std::vector<Line> linesOf(const scene::Scene& scene, Item item);
/// The points of one of them, in the space of what it lies on; null where there is none.
std::vector<thawVec3>* pointsOf(scene::Scene& scene, Item item, int contour);
/// That a path or shape moves with, -1 for none.
int colliderOf(const scene::Scene& scene, Item item);
std::vector<thawVec3> worldPoints(const scene::Scene& scene, const std::vector<thawVec3>& points, int collider);

} // namespace thaw::editor
