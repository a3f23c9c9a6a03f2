// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include "view/passes.h"
#include "view/renderer.h"

#include <array>
#include <vector>

namespace thaw::view {

/// The melt from its particles in screen space: ellipsoids, their depths smoothed into one surface, which goes into the
/// geometry buffer.
class Splats {
public:
    std::vector<Recipe> recipes();
    /// For pictures of this size. False, with the reason in error.
    bool resize(int width, int height, std::string& error);
    /// What the scene draws as splats, if anything.
    void upload(const Scene& scene);
    bool empty() const { return count_ == 0; }
    const Bounds& bounds() const { return bounds_; }

    /// Makes the smoothed depths and what the surface carries. Changes framebuffer and viewport.
    void prepare(const Mat4& worldToClip);
    /// Each sets its program and draws into the bound framebuffer.
    void drawKey();
    void drawFlame(int layer);
    /// The program is to be given the mirrored camera before.
    GlProgram& mirrorProgram() { return mirror_; }
    void drawMirror();
    /// Into the geometry buffer, which is bound; the program is to be given the colours of the phases before.
    GlProgram& resolveProgram() { return resolve_; }
    void resolve(int samples);
    /// Programs that know the materials.
    std::vector<GlProgram*> materialPrograms() { return {&color_, &mirror_}; }

private:
    void draw(GlProgram& program, float size);
    void fullscreen();
    void frame(const Mat4& worldToClip);

    GlProgram depth_, color_, key_, flame_, mirror_, filter_, resolve_;
    GlVertexArray array_, empty_;
    GlBuffer centers_, axes_, states_;
    Target splats_, smooth_[2], colors_;
    GlTexture carried_;
    int width_ = 0, height_ = 0, count_ = 0;
    float spacing_ = 0;
    std::array<int, 4> scissor_{}; // x y width height
    Bounds bounds_;
    std::vector<float> stateData_;
};

} // namespace thaw::view
