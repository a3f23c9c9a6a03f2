// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "app/lens.h"
#include "app/studio.h"
#include "app/toolkit.h"
#include "view/renderer.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace thaw::editor {

/// The picture of the scene, with what is drawn over it, and the pointer in it. Belongs to the OpenGL context that was
/// current when it was made.
class Viewport {
public:
    /// Throws std::runtime_error when the context cannot draw.
    Viewport();
    ~Viewport();
    Viewport(const Viewport&) = delete;
    Viewport& operator=(const Viewport&) = delete;

    /// Fills the rest of the current ImGui window.
    void show(Studio& studio);
    /// The picture as it is, alone, in this size. Throws std::runtime_error.
    view::Image picture(Studio& studio, int width, int height);

    void focus(const Studio& studio);
    void lookThroughScene(const Studio& studio);
    Lens lens;
    /// Where the pointer was since the last frame, where that is known.
    std::vector<ImVec2> trail;
    /// The picture is the newest, and not a coarse one that stands in.
    bool sharp() const { return sharp_; }
    /// ms that the last picture took.
    float drawMs() const { return drawMs_; }
    /// ms that all pictures took.
    double drawnMs() const { return drawnMs_; }

    ToolKit& tools() { return *tools_; }

private:
    void stage(const Studio& studio);
    void placeColliders(const Frame& frame);
    view::Bounds stageBounds() const;
    void melt(const Studio& studio);
    void draw(Studio& studio, int width, int height);
    void pointer(Studio& studio);

    struct Target;
    std::unique_ptr<view::Renderer> renderer_;
    std::unique_ptr<Target> target_;
    std::unique_ptr<ToolKit> tools_;
    Pointer pointer_;

    scene::DrawnMeshes drawn_;
    scene::ParticleBalls balls_;
    view::Scene scene_;
    view::View view_;
    std::vector<view::Region> regions_;
    std::vector<view::MaterialLook> looks_; // of the scene's materials
    std::shared_ptr<const scene::Scene> staged_;
    std::shared_ptr<const scene::SceneMeshes> stagedMeshes_;
    thawParticleView particles_{};
    uint64_t framedFor_ = 0;
    bool dirty_ = true, software_ = false, sharp_ = false;

    // What the picture shows, and how long it took.
    uint64_t drawnFrame_ = ~0ull;
    view::Camera drawnCamera_;
    ViewSettings drawnView_;
    ImVec2 drawnSize_{0, 0};
    double drawnMs_ = 0;
    float drawMs_ = 0, draftMs_ = 0, fullMs_ = 1e9f;
    float share_ = 0.5f; // of the pixels of a draft, in each direction
    double lastChange_ = 0;
    std::string error_;
};

} // namespace thaw::editor
