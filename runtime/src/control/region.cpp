// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "control/region.h"

#include "base/math.h"
#include "control/outline.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace thaw {
namespace {

constexpr size_t kMostNodes = size_t{1} << 20;
constexpr float kMargin = 4; // spacings of distance around what is to be filled

uint64_t hashOf(uint64_t h, Vec3 x) {
    h = hashCombine(h, std::bit_cast<uint32_t>(x.x));
    return hashCombine(hashCombine(h, std::bit_cast<uint32_t>(x.y)), std::bit_cast<uint32_t>(x.z));
}

// The sum of the triangles between the middle and each edge, turned to one side: contours of holes run the other way
// round, and a figure of eight cancels itself.
Vec3 normalOf(const Vec3* points, const int32_t* sizes, int contours, Vec3 middle) {
    Vec3 reference, sum;
    for (int pass = 0; pass < 2; ++pass)
        for (int c = 0, first = 0; c < contours; first += sizes[c++])
            for (int k = 0; k < sizes[c]; ++k) {
                const Vec3 a = points[first + k] - middle, b = points[first + (k + 1) % sizes[c]] - middle,
                           n = cross(a, b);
                if (pass == 0)
                    reference = dot(n, n) > dot(reference, reference) ? n : reference;
                else
                    sum += dot(n, reference) < 0 ? -n : n;
            }
    return sum;
}

} // namespace

bool Region::make(const Vec3* points, const int32_t* sizes, int contours, Vec3 normal, Vec3 up, float spacing,
                  std::string& message) {
    *this = {};
    flat_ = true;
    int count = 0;
    for (int c = 0; c < contours; ++c) count += sizes[c];
    Box box;
    hash_ = hashOf(1, normal);
    for (int c = 0, k = 0; c < contours; ++c) {
        hash_ = hashCombine(hash_, static_cast<uint64_t>(sizes[c]));
        for (const int end = k + sizes[c]; k < end; ++k) box.grow(points[k]), hash_ = hashOf(hash_, points[k]);
    }
    middle_ = 0.5f * (box.lower + box.upper);
    const float extent = length(box.upper - box.lower);
    Vec3 n = normal;
    if (dot(n, n) == 0) {
        n = normalOf(points, sizes, contours, middle_);
        if (dot(n, up) < 0) n = -n;
    }
    if (!(length(n) > 1e-6f * extent * extent) || !(extent > 0)) {
        message = "points: the contours enclose no area";
        return false;
    }
    n_ = normalizeOr(n, {0, 0, 1});
    hash_ = hashOf(hash_, n_); // which side is the upper one depends on the gravity of now
    u_ = normalizeOr(cross(std::abs(n_.x) < 0.7f ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, n_), {1, 0, 0});
    v_ = cross(n_, u_);
    std::vector<Flat> outline;
    outline.reserve(static_cast<size_t>(count));
    for (int k = 0; k < count; ++k) {
        const Vec3 x = into(points[k]);
        bounds_.grow(x), outline.push_back({x.x, x.y});
    }
    size_ = outlineDistance(outline, sizes, contours, 0.25f * spacing, kMargin * spacing, kMostNodes, grid_);
    if (!(size_ > spacing * spacing)) {
        message = "points: the contours enclose " + std::to_string(1e6f * std::max(0.0f, size_)) +
                  " mm^2, less than one particle covers";
        return false;
    }
    return true;
}

bool Region::make(const CleanMesh& mesh, float spacing, Tasks& tasks, std::string& message) {
    *this = {};
    bounds_ = mesh.bounds;
    size_ = static_cast<float>(mesh.report.volume);
    if (!(size_ > spacing * spacing * spacing)) {
        message =
            "mesh: encloses " + std::to_string(1e9f * std::max(0.0f, size_)) + " mm^3, less than one particle fills";
        return false;
    }
    grid_ = makeDistanceGrid(mesh, 0.5f * spacing, kMargin * spacing, kMostNodes, tasks);
    hash_ = 2;
    for (const Vec3& x : mesh.vertices) hash_ = hashOf(hash_, x);
    for (const uint32_t i : mesh.indices) hash_ = hashCombine(hash_, i);
    return true;
}

float Region::distance(Vec3 x, Vec3& outward) const {
    if (!flat_) return grid_.sample(x, outward);
    return grid_.sample({x.x, x.y, 0.5f * grid_.cell}, outward);
}

void Region::state(StateIo& io) {
    io(flat_, middle_, u_, v_, n_, bounds_, size_, hash_);
    grid_.state(io);
}

} // namespace thaw
