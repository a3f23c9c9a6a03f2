// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "app/lens.h"
#include "app/studio.h"

#include <imgui/imgui.h>

namespace thaw::editor {

struct Pointer;

/// The handle by which what is chosen is moved, turned and resized.
class Gizmo {
public:
    /// True while it has the pointer.
    bool update(Studio& studio, const Lens& lens, const Pointer& pointer, ImDrawList& draw);
    bool held() const { return part_ != Part::none && grabbed_; }
    void drop() { grabbed_ = false, part_ = Part::none; }

private:
    /// x, y, z: along or about an axis; yz, zx, xy: in a plane; screen: facing the viewer.
    enum class Part { none, x, y, z, yz, zx, xy, screen };
    Part partAt(Tool tool, const Lens& lens, thawVec3 pivot, float size, ImVec2 at) const;
    void paint(Tool tool, const Lens& lens, thawVec3 pivot, float size, ImDrawList& draw) const;
    void drag(Studio& studio, const Lens& lens, const Pointer& pointer);

    Part part_ = Part::none;
    bool grabbed_ = false;
    scene::Scene before_; // as it was when it was grabbed
    thawVec3 pivot_{};
    ImVec2 from_{0, 0};
    int drags_ = 0;
    float shown_ = 0; // m, degrees or factor of this drag
};

} // namespace thaw::editor
