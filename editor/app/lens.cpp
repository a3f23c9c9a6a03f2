// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/lens.h"

#include "view/math.h"

#include <algorithm>
#include <cmath>

namespace thaw::editor {

using namespace thaw::view;

namespace {
constexpr float kSteepest = 1.55f; // rad; upright beyond it has no meaning
} // namespace

Lens::Axes Lens::axes() const {
    const Vec3 back{std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                    std::cos(azimuth) * std::cos(elevation)};
    const Vec3 forward = back * -1.0f;
    const Vec3 right = normalize(cross(forward, {0, 1, 0}), {1, 0, 0});
    return {right, cross(right, forward), forward};
}

view::Camera Lens::camera() const {
    view::Camera out;
    out.eye = target - axes().forward * distance;
    out.target = target, out.fieldOfView = fieldOfView;
    return out;
}

void Lens::lookLike(const view::Camera& c) {
    const Vec3 back = c.eye - c.target;
    distance = std::clamp(length(back), 1e-3f, 1e4f);
    target = c.target, fieldOfView = c.fieldOfView;
    elevation = std::clamp(std::asin(std::clamp(back.y / distance, -1.0f, 1.0f)), -kSteepest, kSteepest);
    if (back.x != 0 || back.z != 0) azimuth = std::atan2(back.x, back.z);
}

void Lens::focus(const Bounds& bounds) {
    if (bounds.empty()) return;
    target = bounds.center();
    const float aspect = size_.y > 0 ? size_.x / size_.y : 1;
    const float half = std::min(std::tan(fieldOfView / 2), aspect * std::tan(fieldOfView / 2));
    distance = std::clamp(1.15f * std::max(bounds.radius(), 1e-3f) / std::sin(std::atan(half)), 1e-3f, 1e4f);
}

void Lens::orbit(ImVec2 pixels) {
    azimuth -= 0.008f * pixels.x;
    elevation = std::clamp(elevation + 0.008f * pixels.y, -kSteepest, kSteepest);
}

void Lens::pan(ImVec2 pixels) {
    const Axes a = axes();
    const float size = pixelSize(target);
    target = target - a.right * (pixels.x * size) + a.up * (pixels.y * size);
}

void Lens::zoom(float steps, std::optional<thawVec3> at) {
    const float before = distance, factor = std::pow(0.88f, std::clamp(steps, -20.0f, 20.0f));
    distance = std::clamp(distance * factor, 1e-3f, 1e4f);
    if (at) target = target + (*at - target) * (0.6f * (1 - distance / before));
}

bool Lens::contains(ImVec2 p) const {
    return p.x >= low_.x && p.y >= low_.y && p.x < low_.x + size_.x && p.y < low_.y + size_.y;
}

std::optional<ImVec2> Lens::project(thawVec3 point) const {
    const Axes a = axes();
    const Vec3 d = point - camera().eye;
    const float depth = dot(d, a.forward);
    if (!(depth > 1e-5f)) return {};
    const float half = std::tan(fieldOfView / 2), scale = 0.5f * size_.y / (half * depth);
    return ImVec2(low_.x + 0.5f * size_.x + scale * dot(d, a.right), low_.y + 0.5f * size_.y - scale * dot(d, a.up));
}

Ray Lens::ray(ImVec2 p) const {
    const Axes a = axes();
    const float half = std::tan(fieldOfView / 2), scale = 2 * half / std::max(size_.y, 1.0f);
    const float x = (p.x - low_.x - 0.5f * size_.x) * scale, y = -(p.y - low_.y - 0.5f * size_.y) * scale;
    return {camera().eye, normalize(a.forward + a.right * x + a.up * y)};
}

float Lens::pixelSize(thawVec3 at) const {
    const float depth = std::max(dot(at - camera().eye, axes().forward), 1e-5f);
    return 2 * std::tan(fieldOfView / 2) * depth / std::max(size_.y, 1.0f);
}

} // namespace thaw::editor
