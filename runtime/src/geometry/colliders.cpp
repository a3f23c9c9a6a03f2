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

// Bounds of a turned box around `center` of the space that `to` takes into the world, without its scale.
Box boxAround(const Transform& to, Vec3 center, Vec3 half) {
    const Vec3 x = rotate(to.rotation, {half.x, 0, 0}), y = rotate(to.rotation, {0, half.y, 0}),
               z = rotate(to.rotation, {0, 0, half.z}), c = to.position + rotate(to.rotation, center);
    const Vec3 e{std::abs(x.x) + std::abs(y.x) + std::abs(z.x), std::abs(x.y) + std::abs(y.y) + std::abs(z.y),
                 std::abs(x.z) + std::abs(y.z) + std::abs(z.z)};
    return {c - e, c + e};
}

Quat product(Quat a, Quat b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

// A unit quaternion of a turn by less than half: its last part follows from the others, so that turning by it again
// and again neither grows nor shrinks what is turned.
Quat unit(Quat q) {
    const double x = q.x, y = q.y, z = q.z, w = q.w, l = 1 / std::sqrt(x * x + y * y + z * z + w * w);
    const float a = static_cast<float>(x * l), b = static_cast<float>(y * l), c = static_cast<float>(z * l);
    const double rest = 1 - (static_cast<double>(a) * a + static_cast<double>(b) * b + static_cast<double>(c) * c);
    return {a, b, c, static_cast<float>(std::copysign(std::sqrt(std::max(rest, 0.0)), w))};
}

Quat part(Quat turn, float share) {
    return unit({share * turn.x, share * turn.y, share * turn.z, 1 - share + share * turn.w});
}

// Turn that takes `from` to `to`, the short way.
Quat turnBetween(Quat from, Quat to) {
    if (from.x == to.x && from.y == to.y && from.z == to.z && from.w == to.w) return {};
    Quat q = product(to, conjugate(from));
    if (q.w < 0) q = {-q.x, -q.y, -q.z, -q.w};
    return unit(q);
}

} // namespace

Transform between(const Transform& from, const Transform& to, float share) {
    if (share >= 1) return to;
    const Quat turn = part(turnBetween(from.rotation, to.rotation), share);
    return {from.position + share * (to.position - from.position), unit(product(turn, from.rotation)), from.scale};
}

Transform Collider::at(float share) const {
    return {transform.position + share * shift, unit(product(part(turn, share), transform.rotation)), transform.scale};
}

void Collider::moveTo(const Transform& to, float dt) {
    shift = to.position - transform.position;
    turn = turnBetween(transform.rotation, to.rotation);
    next = to;
    rate = 1 / dt;
    moves = dot(shift, shift) > 0 || turn.x != 0 || turn.y != 0 || turn.z != 0;
}

float Collider::reachOfMotion(Vec3 x, float radius) const {
    if (!moves) return 0;
    const float sine = 2 * length(Vec3{turn.x, turn.y, turn.z}); // chord of the turn at radius 1
    return length(shift) + (sine > 0 ? sine * (length(x - transform.position) + radius) : 0);
}

float Collider::distance(Vec3 p, Vec3& normal, float share) const {
    if (!moves || share <= 0) return distance(p, normal);
    // The point where it would have been at the start, if it were fixed to the collider.
    const Quat turned = part(turn, share);
    const Vec3 start = transform.position + rotate(conjugate(turned), p - transform.position - share * shift);
    const float d = distance(start, normal);
    normal = rotate(turned, normal);
    return d;
}

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
        if (grid) {
            d = grid->sample(rotate(conjugate(transform.rotation), p - transform.position), normal);
            normal = rotate(transform.rotation, normal);
            return d;
        }
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
    case thawCollider_box:
        return boxAround(transform, {}, size);
    case thawCollider_mesh:
        if (mesh && !mesh->bounds.empty())
            return boxAround(transform, 0.5f * (mesh->bounds.lower + mesh->bounds.upper),
                             0.5f * (mesh->bounds.upper - mesh->bounds.lower));
        break;
    }
    return box;
}

Box Collider::sweptBounds() const {
    Box b = bounds();
    if (!moves || type == thawCollider_plane || b.empty()) return b;
    const Vec3 center = 0.5f * (b.lower + b.upper);
    const float r = reachOfMotion(center, 0.5f * length(b.upper - b.lower));
    return {b.lower - Vec3{r, r, r}, b.upper + Vec3{r, r, r}};
}

void WallFinder::gather(const Collider* colliders, const Box* bounds, int colliderCount, const Box& box, float reach) {
    count_ = 0, colliders_ = colliders, bounds_ = bounds, all_ = false, motion_ = 0, colliderCount_ = colliderCount;
    if (box.empty()) return;
    const Vec3 center = 0.5f * (box.lower + box.upper), grow{reach, reach, reach};
    const Vec3 lower = box.lower - grow, upper = box.upper + grow;
    // No distance changes faster than the point moves; the rest is for grids, whose slope is not quite 1.
    const float radius = 0.5f * length(box.upper - box.lower), far = 1.25f * (radius + reach);
    for (int c = 0; c < colliderCount; ++c) {
        if (!colliders[c].alive) continue;
        const Box b = bounds ? bounds[c] : colliders[c].sweptBounds();
        if (b.lower.x > upper.x || b.upper.x < lower.x || b.lower.y > upper.y || b.upper.y < lower.y ||
            b.lower.z > upper.z || b.upper.z < lower.z)
            continue;
        Vec3 normal;
        const float way = colliders[c].reachOfMotion(center, radius);
        if (colliders[c].distance(center, normal) > far + 1.25f * way) continue;
        motion_ = std::max(motion_, way);
        if (count_ == kNear) {
            all_ = true;
            continue;
        }
        near_[count_++] = {&colliders[c], b, normal};
    }
}

void ColliderForm::state(StateIo& io) {
    constexpr size_t kMost = size_t{1} << 28;
    io(key);
    io.block(mesh.vertices, kMost), io.block(mesh.indices, kMost);
    io(mesh.bounds, mesh.watertight);
    for (const uint32_t i : mesh.indices)
        if (i >= mesh.vertices.size()) return io.fail("a mesh that names a vertex that it does not have");
    if (mesh.indices.size() % 3 != 0) return io.fail("a mesh with part of a triangle");
    grid.state(io);
}

void Collider::state(StateIo& io, const ColliderForms& forms) {
    io(alive);
    if (!alive) {
        if (io.restores()) *this = {};
        return;
    }
    io.index(type, thawCollider_mesh + 1);
    io(transform, size, adhesive, occluder, slipLength, friction, temperature, conductance, form);
    io(report, kinematic, hasTarget, target);
    io.report(impulse);
    if (!io.restores()) return;
    moves = false, next = transform, shift = {}, turn = {}, rate = 0;
    grid = nullptr, mesh = nullptr;
    if (type != thawCollider_mesh) return;
    if (const auto made = forms.find(form))
        take(made);
    else
        io.fail("the mesh of a collider is neither in this world any more nor in the image");
}

} // namespace thaw
