// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "model/pick.h"
#include "view/orbit.h"

#include <imgui/imgui.h>

#include <optional>

namespace thaw::editor {

/// The camera of the viewport, which goes around a point, and what it maps to which pixel.
class Lens {
public:
    thawVec3 target{0, 0.05f, 0};
    float distance = 0.4f;                   // m, range 1e-3..1e4
    float azimuth = 0.4f, elevation = 0.25f; // rad; azimuth 0 looks along -z
    float fieldOfView = 0.6f;                // rad, vertical

    view::Camera camera() const;
    void lookLike(const view::Camera& camera);
    /// Sees all of the bounds, from where it looks now.
    void focus(const view::Bounds& bounds);
    void orbit(ImVec2 pixels);
    void pan(ImVec2 pixels);
    /// steps of the wheel, towards what is at `at`.
    void zoom(float steps, std::optional<thawVec3> at);

    /// Where the picture is on the screen.
    void place(ImVec2 low, ImVec2 size) { low_ = low, size_ = size; }
    ImVec2 low() const { return low_; }
    ImVec2 size() const { return size_; }
    bool contains(ImVec2 pixel) const;
    /// Nothing for what is behind the camera.
    std::optional<ImVec2> project(thawVec3 point) const;
    Ray ray(ImVec2 pixel) const;
    /// m that a pixel covers at a point.
    float pixelSize(thawVec3 at) const;

private:
    struct Axes {
        thawVec3 right, up, forward;
    };
    Axes axes() const;
    ImVec2 low_{0, 0}, size_{960, 540};
};

} // namespace thaw::editor
