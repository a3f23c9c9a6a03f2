// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "args.h"
#include "scene.h"

#include <memory>
#include <string>

namespace thaw::player {

enum class PictureView { shaded, temperature, phase };
// Throws InputError.
PictureView parseView(const std::string& name, const std::string& text);

// Takes pictures of a world and keeps them for a contact sheet.
class Pictures {
public:
    // Throws RunError when there is no way to draw on this machine.
    Pictures(const scene::Scene& scene, const scene::SceneMeshes& meshes, PictureSize size);
    ~Pictures();
    Pictures(const Pictures&) = delete;
    Pictures& operator=(const Pictures&) = delete;

    // Draws the world as it is now into a PNG file. Throws RunError.
    void take(thawWorld* world, PictureView view, const std::string& caption, const std::string& path);
    // The other's pictures come after its own; the other has none then.
    void append(Pictures& other);
    // All pictures so far in a grid. Throws RunError.
    void writeSheet(const std::string& path, const std::string& title) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

// The surface of the melt as it is now; the ending says which format: .ply or .obj. Throws RunError.
void writeSurface(thawWorld* world, const scene::Scene& scene, const std::string& path);

} // namespace thaw::player
