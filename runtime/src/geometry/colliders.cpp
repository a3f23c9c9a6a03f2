// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "geometry/colliders.h"

#include <algorithm>

namespace thaw {

namespace {

// Exact distance to a box around the origin, inside and out. Inside, the nearest face; of equally near ones x before y
// before z.
inline float boxDistance(Vec3 p, Vec3 half, Vec3& normal) {
    Vec3 q{std::abs(p.x) - half.x, std::abs(p.y) - half.y, std::abs(p.z) - half.z};
    Vec3 sign{p.x < 0 ? -1.0f : 1.0f, p.y < 0 ? -1.0f : 1.0f, p.z < 0 ? -1.0f : 1.0f};
    Vec3 out{std::max(q.x, 0.0f), std::max(q.y, 0.0f), std::max(q.z, 0.0f)};
    float d2 = dot(out, out);
    if (d2 > 1e-30f) { // below, the square has lost its digits
        float d = std::sqrt(d2), inverse = 1 / d;
        normal = {sign.x * out.x * inverse, sign.y * out.y * inverse, sign.z * out.z * inverse};
        return d;
    }
    if (q.x >= q.y && q.x >= q.z) return normal = {sign.x, 0, 0}, q.x;
    if (q.y >= q.z) return normal = {0, sign.y, 0}, q.y;
    return normal = {0, 0, sign.z}, q.z;
}

} // namespace

float Collider::distance(Vec3 p, Vec3& normal) const {
    float d = INFINITY;
    if (!isFinite(p)) {
        normal = {0, 1, 0};
        return d;
    }
    switch (type) {
    case thawCollider_plane:
        normal = rotate(transform.rotation, {0, 1, 0});
        d = dot(normal, p - transform.position);
        break;
    case thawCollider_sphere: {
        Vec3 r = p - transform.position;
        float l = length(r);
        normal = l > 1e-20f ? (1 / l) * r : Vec3{0, 1, 0};
        d = l - size.x;
        break;
    }
    case thawCollider_box: {
        Vec3 n;
        d = boxDistance(rotate(conjugate(transform.rotation), p - transform.position), size, n);
        normal = rotate(transform.rotation, n);
        break;
    }
    case thawCollider_mesh:
        if (grid) return grid->sample(p, normal);
        break;
    }
    if (std::isfinite(d)) return d;
    normal = {0, 1, 0};
    return INFINITY;
}

Box Collider::bounds() const {
    Box box;
    switch (type) {
    case thawCollider_plane:
        return {{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}};
    case thawCollider_sphere: {
        Vec3 r{size.x, size.x, size.x};
        return {transform.position - r, transform.position + r};
    }
    case thawCollider_box: {
        Vec3 x = rotate(transform.rotation, {size.x, 0, 0}), y = rotate(transform.rotation, {0, size.y, 0}),
             z = rotate(transform.rotation, {0, 0, size.z});
        Vec3 e{std::abs(x.x) + std::abs(y.x) + std::abs(z.x), std::abs(x.y) + std::abs(y.y) + std::abs(z.y),
               std::abs(x.z) + std::abs(y.z) + std::abs(z.z)};
        return {transform.position - e, transform.position + e};
    }
    case thawCollider_mesh:
        if (mesh) return mesh->bounds;
        break;
    }
    return box;
}

void WallFinder::gather(const Collider* colliders, const Box* bounds, int colliderCount, const Box& box, float reach) {
    count_ = 0, colliders_ = colliders, bounds_ = bounds, all_ = false, colliderCount_ = colliderCount;
    if (box.empty()) return;
    const Vec3 center = 0.5f * (box.lower + box.upper), grow{reach, reach, reach};
    const Vec3 lower = box.lower - grow, upper = box.upper + grow;
    // No distance changes faster than the point moves; the rest is for grids, whose slope is not quite 1.
    const float far = 1.25f * (0.5f * length(box.upper - box.lower) + reach);
    for (int c = 0; c < colliderCount; ++c) {
        if (!colliders[c].alive) continue;
        const Box b = bounds ? bounds[c] : colliders[c].bounds();
        if (b.lower.x > upper.x || b.upper.x < lower.x || b.lower.y > upper.y || b.upper.y < lower.y ||
            b.lower.z > upper.z || b.upper.z < lower.z)
            continue;
        Vec3 normal;
        if (colliders[c].distance(center, normal) > far) continue;
        if (count_ == kNear) {
            all_ = true;
            return;
        }
        near_[count_++] = {&colliders[c], b, normal};
    }
}

} // namespace thaw
