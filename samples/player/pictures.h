// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "args.h"
#include "scene.h"
#include "view/image.h"

#include <memory>
#include <string>

namespace thaw::player {

enum class PictureView {
    shaded,
    temperature, // of the surface
    phase,
    liquid,  // liquid fraction of the surface
    control, // shaded, with paths and shapes over it
    splats,  // shaded, the melt from its particles in screen space
    // Particles, as balls of their spacing:
    particles, // by temperature
    level,
    elfs, // extended local feature size
    velocity,
    exposure,    // area exposed to air
    absorptivity // of radiation, painted or the material's
};
struct NamedView {
    const char* name;
    PictureView view;
};
inline constexpr NamedView kNamedViews[] = {
    {"shaded", PictureView::shaded},       {"temperature", PictureView::temperature},
    {"phase", PictureView::phase},         {"liquid", PictureView::liquid},
    {"control", PictureView::control},     {"splats", PictureView::splats},
    {"particles", PictureView::particles}, {"level", PictureView::level},
    {"elfs", PictureView::elfs},           {"velocity", PictureView::velocity},
    {"exposure", PictureView::exposure},   {"absorptivity", PictureView::absorptivity}};
// Their names in words: "shaded, ... or absorptivity".
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
