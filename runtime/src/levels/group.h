// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/types.h"
#include "geometry/mesh_fill.h"

#include <cstdint>
#include <vector>

namespace thaw {

// Points of a body in the order of Reference: groups of 8 first, then of 4, of 2 and single ones, each group such that
// the halves of it, and the halves of those, lie together as well.
struct Groups {
    std::vector<uint32_t> order;      // index of the point
    size_t ends[4] = {};              // by level 0..3: how many points come before the end of the groups that high
    int levelOf(size_t place) const { // of the group at that place
        int level = 3;
        while (level > 0 && place >= ends[level]) --level;
        return level;
    }
    // Particles of at most that level that they make of so many points; without groups, all are single.
    size_t rows(size_t points, int highest) const {
        if (order.empty()) return points;
        size_t n = 0;
        for (size_t place = 0; place < order.size(); ++n)
            place += size_t{1} << (levelOf(place) < highest ? levelOf(place) : highest);
        return n;
    }
};

// Groups compact neighbours of one kind: the bricks of 2 x 2 x 2 points that the filling's lattice makes, and what
// comes near to one where the filling was relaxed. kind: a label per point, kAlone for what stays single. Load time
// only.
inline constexpr uint8_t kAlone = 255;
Groups groupPoints(const std::vector<Vec3>& points, const std::vector<uint8_t>& kind, const FillLattice& lattice);

} // namespace thaw
