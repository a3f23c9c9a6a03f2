// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "control/path_line.h"

#include "base/math.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace thaw {
namespace {

// Steps: a radius holds so many, a path at most kMostSteps.
constexpr float kStepsPerRadius = 8;
constexpr size_t kMostSteps = 16384;
// Parts of a spline between two of its points.
constexpr int kSplineParts = 8;

// Centripetal Catmull-Rom (Barry and Goldman's pyramid) between b and c at t in 0..1: no loops and no cusps.
Vec3 spline(Vec3 a, Vec3 b, Vec3 c, Vec3 d, float t) {
    const auto knot = [](Vec3 p, Vec3 q) { return std::max(std::sqrt(length(q - p)), 1e-6f); };
    const float t1 = knot(a, b), t2 = t1 + knot(b, c), t3 = t2 + knot(c, d), s = t1 + t * (t2 - t1);
    const auto mix = [&](Vec3 p, Vec3 q, float from, float to) {
        return ((to - s) / (to - from)) * p + ((s - from) / (to - from)) * q;
    };
    const Vec3 A1 = mix(a, b, 0, t1), A2 = mix(b, c, t1, t2), A3 = mix(c, d, t2, t3);
    return mix(mix(A1, A2, 0, t2), mix(A2, A3, t1, t3), t1, t2);
}

} // namespace

bool PathLine::make(const Vec3* points, size_t count, bool smooth, float radius, float reach, std::string& message) {
    *this = {};
    reach_ = reach;
    std::vector<Vec3> given;
    for (size_t k = 0; k < count; ++k)
        if (given.empty() || thaw::length(points[k] - given.back()) > 1e-6f) given.push_back(points[k]);
    if (given.size() < 2) {
        message = "points: a path needs two that differ, got " + std::to_string(count) + " of which " +
                  std::to_string(given.size()) + " differ";
        return false;
    }
    std::vector<Vec3> line;
    if (smooth && given.size() > 2) {
        const size_t last = given.size() - 1;
        line.push_back(given[0]);
        for (size_t k = 0; k < last; ++k) {
            const Vec3 b = given[k], c = given[k + 1], a = k > 0 ? given[k - 1] : b - (c - b),
                       d = k + 2 <= last ? given[k + 2] : c + (c - b);
            for (int part = 1; part <= kSplineParts; ++part)
                line.push_back(part == kSplineParts ? c : spline(a, b, c, d, static_cast<float>(part) / kSplineParts));
        }
    } else {
        line = std::move(given);
    }
    std::vector<double> along(line.size(), 0);
    for (size_t k = 1; k < line.size(); ++k)
        along[k] = along[k - 1] + static_cast<double>(thaw::length(line[k] - line[k - 1]));
    length_ = static_cast<float>(along.back());
    const size_t steps =
        std::clamp(static_cast<size_t>(std::ceil(kStepsPerRadius * length_ / radius)), size_t{1}, kMostSteps);
    step_ = length_ / static_cast<float>(steps);
    for (size_t k = 0, at = 0; k <= steps; ++k) {
        const double s = along.back() * static_cast<double>(k) / static_cast<double>(steps);
        while (at + 2 < line.size() && along[at + 1] < s) ++at;
        const double part = along[at + 1] - along[at];
        const float t = part > 0 ? static_cast<float>(std::clamp((s - along[at]) / part, 0.0, 1.0)) : 0;
        point_.push_back(line[at] + t * (line[at + 1] - line[at]));
        bounds_.grow(point_.back());
    }
    for (const Vec3& x : point_)
        hash_ = hashCombine(hashCombine(hash_, std::bit_cast<uint32_t>(x.x)),
                            std::bit_cast<uint32_t>(x.y) | static_cast<uint64_t>(std::bit_cast<uint32_t>(x.z)) << 32);
    // The way from a step before to a step after: what turns sharply turns within a fourth of the radius.
    for (size_t k = 0; k <= steps; ++k) {
        const Vec3 way = point_[std::min(steps, k + 1)] - point_[k > 0 ? k - 1 : 0];
        tangent_.push_back(normalizeOr(way, k > 0 ? tangent_.back() : Vec3{1, 0, 0}));
    }
    for (size_t k = 0; k <= steps; ++k) {
        const auto cell = [&](float v) { return static_cast<int64_t>(std::floor(v / reach_)); };
        cells_.push_back({keyOf(cell(point_[k].x), cell(point_[k].y), cell(point_[k].z)), static_cast<uint32_t>(k)});
    }
    std::sort(cells_.begin(), cells_.end(),
              [](const Cell& a, const Cell& b) { return a.key != b.key ? a.key < b.key : a.node < b.node; });
    return true;
}

uint64_t PathLine::keyOf(int64_t x, int64_t y, int64_t z) const {
    // Far apart places may share a key: the distance decides.
    return hashCombine(hashCombine(hashCombine(0, static_cast<uint64_t>(x)), static_cast<uint64_t>(y)),
                       static_cast<uint64_t>(z));
}

Foot PathLine::at(float along) const {
    const float u = std::clamp(along, 0.0f, length_) / step_;
    const size_t k = std::min(static_cast<size_t>(u), point_.size() - 2);
    const float t = std::min(u - static_cast<float>(k), 1.0f);
    const Vec3 way = normalizeOr((1 - t) * tangent_[k] + t * tangent_[k + 1], tangent_[k]);
    return {step_ * (static_cast<float>(k) + t), (1 - t) * point_[k] + t * point_[k + 1], way};
}

Foot PathLine::nearest(Vec3 x, float from, float to) const {
    const size_t last = point_.size() - 1;
    const size_t begin = std::min(static_cast<size_t>(std::max(0.0f, from) / step_), last - 1);
    const size_t end =
        std::clamp(static_cast<size_t>(std::ceil(std::clamp(to, 0.0f, length_) / step_)), begin + 1, last);
    float best = INFINITY, along = 0;
    for (size_t k = begin; k < end; ++k) {
        const Vec3 a = point_[k], way = point_[k + 1] - a;
        const float square = dot(way, way);
        const float t = square > 0 ? std::clamp(dot(x - a, way) / square, 0.0f, 1.0f) : 0;
        const Vec3 d = x - (a + t * way);
        if (const float d2 = dot(d, d); d2 < best) best = d2, along = step_ * (static_cast<float>(k) + t);
    }
    return at(along);
}

bool PathLine::nearest(Vec3 x, Foot& foot) const {
    const auto outside = [&](float v, float low, float high) { return v < low - reach_ || v > high + reach_; };
    if (outside(x.x, bounds_.lower.x, bounds_.upper.x) || outside(x.y, bounds_.lower.y, bounds_.upper.y) ||
        outside(x.z, bounds_.lower.z, bounds_.upper.z))
        return false;
    const auto cell = [&](float v) { return static_cast<int64_t>(std::floor(v / reach_)); };
    float best = reach_ * reach_;
    uint32_t node = ~0u;
    for (int64_t dz = -1; dz <= 1; ++dz)
        for (int64_t dy = -1; dy <= 1; ++dy)
            for (int64_t dx = -1; dx <= 1; ++dx) {
                const uint64_t key = keyOf(cell(x.x) + dx, cell(x.y) + dy, cell(x.z) + dz);
                auto it = std::lower_bound(cells_.begin(), cells_.end(), key,
                                           [](const Cell& c, uint64_t k) { return c.key < k; });
                for (; it != cells_.end() && it->key == key; ++it) {
                    const Vec3 d = x - point_[it->node];
                    if (const float d2 = dot(d, d); d2 < best || (d2 == best && it->node < node))
                        best = d2, node = it->node;
                }
            }
    if (node == ~0u) return false;
    const float s = step_ * static_cast<float>(node);
    foot = nearest(x, s - step_, s + step_);
    return true;
}

void PathLine::state(StateIo& io) {
    io(bounds_, step_, length_, reach_, hash_);
    io.block(point_, kMostSteps + 2), io.block(tangent_, kMostSteps + 2);
    io.list(cells_, kMostSteps + 2, [&](Cell& c) { io(c.key), io.index(c.node, point_.size()); });
    if (io.restores() && (point_.size() < 2 || tangent_.size() != point_.size() || !(step_ > 0) || !(length_ > 0) ||
                          !(length_ / step_ < static_cast<float>(point_.size()))))
        io.fail("a line that cannot be");
}

} // namespace thaw
