// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "args.h"
#include "scene_stage.h"
#include "view/image.h"

#include <memory>
#include <string>

namespace thaw::player {

using scene::kNamedViews;
using scene::NamedView;
using scene::PictureView;

// The names of kNamedViews in words: "shaded, ... or absorptivity".
std::string pictureViews();
// Throws InputError.
PictureView parseView(const std::string& name, const std::string& text);

// Takes pictures of a world and keeps them for a contact sheet.
class Pictures {
public:
    // Throws RunError when there is no way to draw on this machine. cut: of the particles, only those behind the middle
    // of what there is at first.
    Pictures(const scene::Scene& scene, const scene::SceneMeshes& meshes, PictureSize size, bool cut = false);
    ~Pictures();
    Pictures(const Pictures&) = delete;
    Pictures& operator=(const Pictures&) = delete;

    // Draws the world as it is now. Throws RunError.
    view::Image draw(thawWorld* world, PictureView view);
    // The same into a PNG file, and keeps it. Throws RunError.
    void take(thawWorld* world, PictureView view, const std::string& caption, const std::string& path);
    // The other's pictures come after its own; the other has none then.
    void append(Pictures& other);
    // The other's pictures come one by one after each `columns` of its own; the other has none then.
    void beside(Pictures& other, int columns);
    // All pictures so far in a grid; columns 0: as square as it gets. Throws RunError.
    void writeSheet(const std::string& path, const std::string& title, int columns = 0) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

// The surface of the melt as it is now; the ending says which format: .ply or .obj. Throws RunError.
void writeSurface(thawWorld* world, const scene::Scene& scene, const std::string& path);

} // namespace thaw::player
