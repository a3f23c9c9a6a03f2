// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "app/gizmo.h"
#include "app/lens.h"
#include "app/studio.h"

#include <imgui/imgui.h>

#include <cmath>
#include <optional>
#include <vector>

namespace thaw::editor {

/// As its button has it: "Path".
const char* toolName(Tool tool);

/// The pointer over the picture in one frame.
struct Pointer {
    ImVec2 at{0, 0};
    std::vector<ImVec2> trail;                            // where it was since the last frame, `at` last
    bool over = false;                                    // nothing lies between it and the picture
    bool pressed = false, held = false, released = false; // the left button, begun over the picture
    bool clickedTwice = false;
    bool shift = false, ctrl = false;
};

constexpr float kReach = 9; // pixels, of what can be taken hold of
inline float between(ImVec2 a, ImVec2 b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// What the left button does, and what is drawn over the picture.
class ToolKit {
public:
    void update(Studio& studio, const Lens& lens, const Pointer& pointer, ImDrawList& draw);
    /// Escape: gives up what is being drawn. False when there is nothing.
    bool cancel();
    /// Enter, Backspace and Delete while a tool has something to do with them. False: not used.
    bool removeNode(Studio& studio);
    /// In words, for the status line.
    static const char* help(Tool tool);

private:
    struct Touch {
        Item item; // a path, a shape, a source
        int contour = 0, node = -1;
    };
    std::optional<Touch> touched(const Studio& studio, const Lens& lens, ImVec2 at) const;
    std::optional<Hit> under(Studio& studio, const Lens& lens, ImVec2 at) const;
    void select(Studio& studio, const Lens& lens, const Pointer& pointer);
    void drawLine(Studio& studio, const Lens& lens, const Pointer& pointer, bool closed);
    void finishLine(Studio& studio, const Lens& lens, bool closed);
    bool dragNode(Studio& studio, const Lens& lens, const Pointer& pointer);
    void insertNode(Studio& studio, const Lens& lens, const Pointer& pointer);
    void placeSource(Studio& studio, const Lens& lens, const Pointer& pointer, ImDrawList& draw);
    void placeCollider(Studio& studio, const Lens& lens, const Pointer& pointer);
    void paint(Studio& studio, const Lens& lens, const Pointer& pointer);
    void wipe(Studio& studio, const Lens& lens, const Pointer& pointer);
    void probe(Studio& studio, const Lens& lens, const Pointer& pointer) const;
    void box(const Studio& studio, const Lens& lens, Item item, ImDrawList& draw) const;
    void overlay(Studio& studio, const Lens& lens, const Pointer& pointer, ImDrawList& draw) const;

    Gizmo gizmo_;
    std::vector<thawVec3> line_;       // being drawn, in the world
    std::vector<int> lineColliders_;   // that its points lie on, -1: none
    std::optional<Hit> anchor_, last_; // where the button went down; what was under it last
    bool dragging_ = false;            // a node
    Touch grabbed_;
    float pushed_ = 0;                                            // m, of a source that is placed
    mutable std::shared_ptr<const scene::SceneMeshes> boxMeshes_; // of which these are
    mutable Item boxItem_;
    mutable scene::Bounds boxBounds_;
    int strokes_ = 0; // so that each is one step of undo
};

} // namespace thaw::editor
