// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "view/orbit.h"

#include <algorithm>

namespace thaw::view {

Camera frame(const Bounds& bounds, const Orbit& orbit, float aspect) {
    Camera camera;
    camera.fieldOfView = std::clamp(orbit.fieldOfView, 0.01f, 3.0f);
    if (bounds.empty()) return camera;
    const float elevation = std::clamp(orbit.elevation, -1.5f, 1.5f);
    const Vec3 back{std::cos(elevation) * std::sin(orbit.azimuth), std::sin(elevation),
                    std::cos(elevation) * std::cos(orbit.azimuth)};
    const Vec3 right = normalize(cross({0, 1, 0}, back), {1, 0, 0});
    const Vec3 up = cross(back, right);
    const Vec3 center = bounds.center();
    const float tanY = std::tan(camera.fieldOfView / 2) / std::max(orbit.margin, 1.0f), tanX = tanY * aspect;
    // The distance at which every corner lies inside the frustum; a sphere around the box would leave tall things
    // small.
    float distance = 1e-4f;
    for (int i = 0; i < 8; ++i) {
        const Vec3 corner{i & 1 ? bounds.upper.x : bounds.lower.x, i & 2 ? bounds.upper.y : bounds.lower.y,
                          i & 4 ? bounds.upper.z : bounds.lower.z};
        const Vec3 d = corner - center;
        const float nearer = dot(d, back);
        distance = std::max(distance, nearer + std::fabs(dot(d, right)) / tanX);
        distance = std::max(distance, nearer + std::fabs(dot(d, up)) / tanY);
    }
    camera.eye = center + back * distance;
    camera.target = center;
    return camera;
}

Bounds surfaceBounds(const thawSurfaceView& surface) {
    Bounds bounds;
    for (int32_t i = 0; i < surface.vertexCount; ++i) {
        const float* p = surface.positions + size_t(i) * 3;
        bounds.add(Vec3{p[0], p[1], p[2]});
    }
    return bounds;
}

} // namespace thaw::view
