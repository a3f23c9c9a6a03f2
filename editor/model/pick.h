// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "model/items.h"

#include <memory>
#include <optional>
#include <vector>

namespace thaw::editor {

struct Ray {
    thawVec3 origin, direction; // direction: unit
};

/// A point of a surface that a ray met.
struct Hit {
    Item item;          // a body for the melt
    thawVec3 point;     // m, in the world
    thawVec3 normal;    // unit, towards where the ray came from
    float distance = 0; // m
};

/// Finds what is under the pointer: the melt as it stands, colliders and props. One thread.
class Picker {
public:
    Picker();
    ~Picker();
    Picker(const Picker&) = delete;
    Picker& operator=(const Picker&) = delete;

    /// What stands still. placements: where colliders are, as many; empty: where the scene has them.
    void setScene(std::shared_ptr<const scene::Scene> scene, std::shared_ptr<const scene::SceneMeshes> meshes,
                  const std::vector<scene::Placement>& placements);
    /// The melt; bodyOfIndex as in Frame. Read during the call only.
    void setMelt(const thawSurfaceView& surface, const std::vector<int>& bodyOfIndex);
    /// The nearest thing. hidden: whether colliders that are not drawn count as well.
    std::optional<Hit> cast(const Ray& ray, bool hidden = false) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace thaw::editor
