// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/state_io.h"
#include "base/types.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace thaw {

// A place on a line: m along it, the point and the unit way there.
struct Foot {
    float along = 0;
    Vec3 point, tangent;
};

// A line through given points, as equal steps that are a small part of its radius.
class PathLine {
public:
    // smooth: a centripetal Catmull-Rom spline through the points, else straight between them. Points that coincide
    // count once. False and a message when fewer than two differ.
    bool make(const Vec3* points, size_t count, bool smooth, float radius, float reach, std::string& message);

    float length() const { return length_; }
    uint64_t hash() const { return hash_; } // of what it was made of
    float reach() const { return reach_; }
    void state(StateIo& io);
    const std::vector<Vec3>& points() const { return point_; }
    Foot at(float along) const;
    // The nearest place to x within [from, to] m along it.
    Foot nearest(Vec3 x, float from, float to) const;
    // The nearest of all; false when none is within the reach it was made with.
    bool nearest(Vec3 x, Foot& foot) const;

private:
    struct Cell {
        uint64_t key;
        uint32_t node;
    };
    uint64_t keyOf(int64_t x, int64_t y, int64_t z) const;

    std::vector<Vec3> point_, tangent_;
    std::vector<Cell> cells_; // nodes by cell of the reach, in order of their keys
    Box bounds_;
    float step_ = 0, length_ = 0, reach_ = 0;
    uint64_t hash_ = 0;
};

} // namespace thaw
