// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "player/scene.h"

#include <vector>

namespace thaw::editor {

/// One thing of a list after an edit.
struct Kept {
    int was = -1;         // its index before; -1: it is new
    bool changed = false; // something of it other than its name and looks
};
struct KeptBody : Kept {
    int paintFrom = 0; // paint that it had before; more was added
};
struct KeptCollider : Kept { // changed: its form
    bool moved = false, surface = false, heat = false;
};

/// What an edit changed in a scene. Found by what is there, so that it does not matter whether it came from a panel, a
/// tool, undo or another file: what stands alike at both ends of a list is the same, and what is between is told apart
/// by order where there are as many as before, else by name.
struct Changes {
    std::vector<Kept> materials, heatSources, paths, shapes;
    std::vector<KeptBody> bodies;
    std::vector<KeptCollider> colliders;
    bool world = false;    // its settings
    bool capacity = false; // particleSpacing or maxParticles: only another world has them
    /// Whether a world made of the one differs from a world made of the other.
    bool any() const { return any_; }

private:
    friend Changes changesBetween(const scene::Scene& before, const scene::Scene& after);
    bool any_ = false;
};
Changes changesBetween(const scene::Scene& before, const scene::Scene& after);

} // namespace thaw::editor
