// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "view/splats.h"

#include <algorithm>
#include <cmath>

namespace thaw::view {

namespace {

constexpr float kShadowSize = 0.8f;  // of the axes: what is lit must not lie behind beads that the filter has taken off
constexpr float kColorSize = 1.6f;   // from where colours come
constexpr float kFilterReach = 2.0f; // spacings

} // namespace

std::vector<Recipe> Splats::recipes() {
    return {{depth_, "splat.vert", "splat.glsl+splat_depth.frag", "CAMERA_PASS"},
            {color_, "splat.vert", "splat.glsl+splat_color.frag", "CAMERA_PASS"},
            {key_, "splat.vert", "splat.glsl+splat_shadow.frag", "KEY_PASS"},
            {flame_, "splat.vert", "splat.glsl+splat_shadow.frag", "FLAME_PASS"},
            {mirror_, "splat.vert", "splat.glsl+mirror.glsl+splat_mirror.frag", "CAMERA_PASS"},
            {filter_, "fullscreen.vert", "splat_filter.frag", ""},
            {resolve_, "fullscreen.vert", "surface.glsl+splat_resolve.frag", ""}};
}

bool Splats::resize(int width, int height, std::string& error) {
    if (width == width_ && height == height_) return true;
    width_ = height_ = 0;
    if (!makeTarget(splats_, GL_RG32F, width, height, GL_NEAREST, nullptr, error)) return false;
    for (Target& target : smooth_)
        if (!makeTarget(target, GL_R32F, width, height, GL_NEAREST, nullptr, error)) return false;
    // Colours change from particle to particle and not within one.
    const int w = (width + 1) / 2, h = (height + 1) / 2;
    if (!makeTarget(colors_, GL_RGBA16F, w, h, GL_LINEAR, nullptr, error)) return false;
    makeTexture(carried_, GL_RGBA16F, w, h, GL_LINEAR);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, carried_.get(), 0);
    const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(2, both);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return error = "the driver refuses the buffers of the splats", false;
    width_ = width, height_ = height;
    return true;
}

void Splats::upload(const Scene& scene) {
    bounds_ = {};
    count_ = scene.splats ? std::max(scene.splats->count, 0) : 0;
    if (empty()) return;
    const thawParticleView& p = *scene.splats;
    spacing_ = scene.splatSpacing;
    stateData_.clear();
    for (size_t i = 0; i < static_cast<size_t>(count_); ++i) {
        const float* x = scene.splatShapes.centers + 4 * i;
        stateData_.insert(stateData_.end(),
                          {p.temperatures ? p.temperatures[i] : 0, p.liquidFractions ? p.liquidFractions[i] : 0,
                           p.materials ? static_cast<float>(p.materials[i]) : 0});
        bounds_.add(Vec3{x[0], x[1], x[2]});
    }
    glBindVertexArray(array_.get());
    const auto stream = [&](GLuint index, GlBuffer& buffer, const float* data, GLint components) {
        view::upload(buffer, GL_ARRAY_BUFFER, data, static_cast<size_t>(count_ * components) * 4, GL_STREAM_DRAW);
        attribute(index, components, GL_FLOAT);
        glVertexAttribDivisor(index, 1);
    };
    stream(0, centers_, scene.splatShapes.centers, 4);
    stream(1, axes_, scene.splatShapes.axes, 4);
    stream(2, states_, stateData_.data(), 3);
    glBindVertexArray(0);
}

void Splats::draw(GlProgram& program, float size) {
    program.use();
    program.set("uSplatSize", size);
    glBindVertexArray(array_.get());
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count_);
}

void Splats::fullscreen() {
    glBindVertexArray(empty_.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

// What the melt can cover on screen, with room for the filter; all when some of it is beside the eye.
void Splats::frame(const Mat4& worldToClip) {
    const float room = 10 * spacing_; // coarse particles are twice as large
    float lower[2] = {INFINITY, INFINITY}, upper[2] = {-INFINITY, -INFINITY};
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p{corner & 1 ? bounds_.upper.x + room : bounds_.lower.x - room,
                     corner & 2 ? bounds_.upper.y + room : bounds_.lower.y - room,
                     corner & 4 ? bounds_.upper.z + room : bounds_.lower.z - room};
        const auto row = [&](size_t r) {
            const auto& m = worldToClip.m;
            return m[r] * p.x + m[4 + r] * p.y + m[8 + r] * p.z + m[12 + r];
        };
        const float w = row(3);
        if (!(w > 1e-6f)) {
            scissor_ = {0, 0, width_, height_};
            return;
        }
        for (size_t axis = 0; axis < 2; ++axis)
            lower[axis] = std::fmin(lower[axis], row(axis) / w), upper[axis] = std::fmax(upper[axis], row(axis) / w);
    }
    const int sizes[2] = {width_, height_};
    for (size_t axis = 0; axis < 2; ++axis) {
        const auto size = static_cast<float>(sizes[axis]);
        const float a = std::clamp((0.5f + 0.5f * lower[axis]) * size, 0.0f, size);
        const float b = std::clamp((0.5f + 0.5f * upper[axis]) * size, 0.0f, size);
        scissor_[axis] = static_cast<int>(a) & ~1;
        scissor_[axis + 2] = static_cast<int>(std::ceil(b)) - scissor_[axis];
    }
}

void Splats::prepare(const Mat4& worldToClip) {
    if (empty()) return;
    frame(worldToClip);
    glEnable(GL_SCISSOR_TEST);
    glScissor(scissor_[0], scissor_[1], scissor_[2], scissor_[3]);
    glDisable(GL_DEPTH_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, splats_.framebuffer.get());
    glViewport(0, 0, width_, height_);
    const float nothing[4] = {-1e9f, -3, 0, 0}, zero[4] = {0, 0, 0, 0};
    glClearBufferfv(GL_COLOR, 0, nothing);
    glEnable(GL_BLEND);
    glBlendEquation(GL_MAX);
    draw(depth_, 1);
    glBlendEquation(GL_FUNC_ADD);
    glDisable(GL_BLEND);

    filter_.use();
    filter_.set("uSpacing", spacing_);
    for (int pass = 0; pass < 4; ++pass) {
        const Target &from = pass == 0 ? splats_ : smooth_[1 - pass % 2], &to = smooth_[pass % 2];
        glBindFramebuffer(GL_FRAMEBUFFER, const_cast<Target&>(to).framebuffer.get());
        bindTexture(unitSource, GL_TEXTURE_2D, const_cast<Target&>(from).texture.get());
        if (pass < 2) glClearBufferfv(GL_COLOR, 0, zero); // what it discards; the same pixels later
        filter_.set("uFirst", pass == 0 ? 1 : 0);
        filter_.set("uStep", pass % 2 == 0 ? 1 : 0, pass % 2);
        filter_.set("uFilterReach", pass < 2 ? kFilterReach : 0.5f * kFilterReach);
        fullscreen();
    }

    bindTexture(unitSplatDepths, GL_TEXTURE_2D, smooth_[1].texture.get());
    bindTexture(unitSplats, GL_TEXTURE_2D, splats_.texture.get());
    glBindFramebuffer(GL_FRAMEBUFFER, colors_.framebuffer.get());
    glViewport(0, 0, colors_.width, colors_.height);
    glScissor(scissor_[0] / 2, scissor_[1] / 2, (scissor_[2] + 1) / 2, (scissor_[3] + 1) / 2);
    glClearBufferfv(GL_COLOR, 0, zero);
    glClearBufferfv(GL_COLOR, 1, zero);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    color_.use();
    color_.set("uSpacing", spacing_);
    color_.set("uTargetSize", static_cast<float>(colors_.width), static_cast<float>(colors_.height));
    draw(color_, kColorSize);
    glDisable(GL_BLEND);
    bindTexture(unitSplatAlbedos, GL_TEXTURE_2D, colors_.texture.get());
    bindTexture(unitSplatStates, GL_TEXTURE_2D, carried_.get());
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_SCISSOR_TEST);
}

void Splats::drawKey() {
    if (!empty()) draw(key_, kShadowSize);
}

void Splats::drawFlame(int layer) {
    if (empty()) return;
    flame_.use();
    flame_.set("uFlameLayer", layer);
    draw(flame_, kShadowSize);
}

void Splats::drawMirror() {
    if (!empty()) draw(mirror_, 1);
}

void Splats::resolve(int samples) {
    if (empty()) return;
    resolve_.use();
    glEnable(GL_SCISSOR_TEST);
    glScissor(scissor_[0], scissor_[1], scissor_[2], scissor_[3]);
    resolve_.set("uOutline", 0);
    fullscreen();
    resolve_.set("uOutline", 1);
    glEnable(GL_SAMPLE_MASK);
    for (int s = 0; s < samples; ++s) {
        float place[2] = {0.5f, 0.5f};
        glGetMultisamplefv(GL_SAMPLE_POSITION, static_cast<GLuint>(s), place);
        resolve_.set("uSampleOffset", place[0] - 0.5f, place[1] - 0.5f);
        glSampleMaski(0, 1u << s);
        fullscreen();
    }
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_SAMPLE_MASK);
}

} // namespace thaw::view
