// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/viewport.h"

#include "app/widgets.h"
#include "view/gl_objects.h"
#include "view/passes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace thaw::editor {

namespace {
using view::operator+;
using view::operator*;

// On a software rasteriser a picture takes a tenth of a second and more. While something moves a coarse one stands in.
constexpr double kStillSeconds = 0.35;
constexpr float kDraftMs = 60, kSlowMs = 25;
constexpr float kLeastShare = 0.4f;

bool same(const view::Camera& a, const view::Camera& b) { return std::memcmp(&a, &b, sizeof a) == 0; }
} // namespace

struct Viewport::Target {
    view::Target image;
    int usedWidth = 0, usedHeight = 0; // of the last picture in it
    bool draft = false;

    bool size(int w, int h, std::string& error) {
        if (w <= image.width && h <= image.height) return true;
        if (!view::makeTarget(image, GL_RGBA8, std::max(w, image.width), std::max(h, image.height), GL_LINEAR, nullptr,
                              error))
            return false;
        // The renderer leaves what it likes in alpha.
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_A, GL_ONE);
        return true;
    }
};

Viewport::Viewport() : target_(std::make_unique<Target>()), tools_(std::make_unique<ToolKit>()) {
    std::string error;
    renderer_ = view::Renderer::create(error);
    if (!renderer_) throw std::runtime_error("the renderer does not start: " + error);
    for (const char* name : {"llvmpipe", "softpipe", "SwiftShader", "swrast"})
        software_ = software_ || renderer_->rendererString().find(name) != std::string::npos;
}

Viewport::~Viewport() = default;

void Viewport::lookThroughScene(const Studio& studio) {
    lens.lookLike(scene::viewCamera(scene::cameraAt(studio.scene().camera, studio.frame().time)));
}

void Viewport::focus(const Studio& studio) {
    view::Bounds bounds;
    const Item item = studio.selection();
    const scene::Scene& s = studio.scene();
    if (item.kind == Kind::body && size_t(item.index) < studio.frame().bodies.size()) {
        const thawBodyState& body = studio.frame().bodies[size_t(item.index)];
        if (body.particles > 0) bounds.add(body.lower), bounds.add(body.upper);
    }
    if (bounds.empty() && exists(s, item) && hasPlace(item.kind)) {
        const thawVec3 at = pivotOf(s, item);
        const float r = 12 * s.world.particleSpacing;
        bounds.add(view::Vec3{at.x - r, at.y - r, at.z - r}), bounds.add(view::Vec3{at.x + r, at.y + r, at.z + r});
    }
    if (bounds.empty()) bounds = view::sceneBounds(scene_);
    lens.focus(bounds);
}

void Viewport::stage(const Studio& studio) {
    const Frame& f = studio.frame();
    if (!f.scene || (f.scene == staged_ && f.meshes == stagedMeshes_)) {
        // Colliders that are on their way move without a change of the scene.
        if (f.scene && f.meshes) placeColliders(f);
        return;
    }
    const view::Bounds bounds = scene_.stage;
    staged_ = f.scene, stagedMeshes_ = f.meshes;
    scene_ = {}, regions_.clear();
    if (f.meshes) {
        scene_ = scene::stageOf(*f.scene, *f.meshes, drawn_);
        regions_ = scene::regionsOf(*f.scene, *f.meshes);
    }
    looks_ = scene_.materials;
    scene_.stage = bounds;
    balls_ = scene::ParticleBalls(*f.scene, false);
    const scene::TemperatureRange range = scene::temperatureRangeOf(*f.scene);
    view_.temperatureLow = range.low, view_.temperatureHigh = range.high;
    view_.exposure = f.scene->look.exposure;
    if (f.meshes) placeColliders(f);
    dirty_ = true;
}

void Viewport::placeColliders(const Frame& f) {
    // In the order of stageOf: those that are seen, but for the plane that is the floor.
    size_t at = 0;
    bool floor = false;
    for (size_t i = 0; i < f.scene->colliders.size() && i < f.colliders.size(); ++i) {
        const scene::Collider& c = f.scene->colliders[i];
        if (!c.visible) continue;
        if (c.shape.type == scene::ShapeType::plane && !floor &&
            scene::rotate(c.placement.rotation, {0, 1, 0}).y > 0.9999f) {
            floor = true;
            continue;
        }
        if (at >= scene_.meshes.size()) return;
        scene_.meshes[at].position = f.colliders[i].position, scene_.meshes[at].rotation = f.colliders[i].rotation;
        ++at;
    }
}

void Viewport::melt(const Studio& studio) {
    const Frame& f = studio.frame();
    scene_.surface = f.mesh.view();
    // A material's index in a world is not its index in the scene once one was deleted.
    scene_.materials.clear();
    for (const int i : f.materialOfIndex)
        scene_.materials.push_back(i >= 0 && size_t(i) < looks_.size() ? looks_[size_t(i)] : view::MaterialLook{});
    scene_.time = float(f.time);
    if (scene_.stage.empty() || (f.frame == 0 && f.built)) scene_.stage = stageBounds();
    scene_.particles = nullptr, scene_.splats = nullptr;
    scene_.regions.clear();
    if (studio.view.controls || studio.view.picture == scene::PictureView::control) scene_.regions = regions_;
    view_.mode = scene::modeOf(studio.view.picture);
    const ViewSettings& v = studio.view;
    view_.cut.on = v.clip;
    const view::Bounds& b = scene_.stage;
    const view::Vec3 middle = b.empty() ? view::Vec3{0, 0, 0} : b.center();
    // To the viewer along that axis, so that one looks at what is cut.
    const view::Vec3 eye = lens.camera().eye;
    const float sides[3] = {eye.x - middle.x, eye.y - middle.y, eye.z - middle.z};
    const float side = sides[v.clipAxis] < 0 ? -1.0f : 1.0f;
    view_.cut.normal = {v.clipAxis == 0 ? side : 0, v.clipAxis == 1 ? side : 0, v.clipAxis == 2 ? side : 0};
    view_.cut.point = middle + view_.cut.normal * v.clipOffset;
    particles_ = f.particles.view();
    if (studio.view.picture == scene::PictureView::splats && particles_.count > 0 &&
        f.particles.splats().count == particles_.count) {
        scene_.splats = &particles_;
        scene_.splatShapes = f.particles.splats();
    }
    if (scene::isOfParticles(studio.view.picture) && particles_.count > 0) {
        const bool sizes = studio.view.picture == scene::PictureView::elfs;
        if (!sizes || f.particles.featureSizes().size() == size_t(particles_.count)) {
            scene_.surface = {};
            balls_.show(particles_, sizes ? f.particles.featureSizes().data() : nullptr, studio.view.picture,
                        lens.camera(), scene_);
        }
    }
}

view::Bounds Viewport::stageBounds() const {
    view::Scene plain = scene_;
    plain.particles = plain.splats = nullptr;
    plain.stage = {};
    return view::sceneBounds(plain);
}

void Viewport::draw(Studio& studio, int width, int height) {
    const double start = now();
    view_.width = width, view_.height = height;
    view_.camera = lens.camera();
    error_.clear();
    if (target_->size(width, height, error_)) {
        melt(studio);
        renderer_->draw(scene_, view_, target_->image.framebuffer.get(), error_);
        if (software_) glFinish();
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    target_->usedWidth = width, target_->usedHeight = height;
    const double end = now();
    drawMs_ = float(1000 * (end - start));
    drawnMs_ += 1000 * (end - start);
    studio.spans.add({start, end, SpanKind::draw});
}

view::Image Viewport::picture(Studio& studio, int width, int height) {
    stage(studio);
    // Whatever the window made do with last.
    view_.samples = 4, view_.legend = true, view_.draft = false;
    view_.width = width, view_.height = height;
    const Frame& f = studio.frame();
    view_.camera = studio.view.followCamera && f.scene
                       ? scene::viewCamera(scene::cameraAt(studio.scene().camera, f.time))
                       : lens.camera();
    melt(studio);
    std::string error;
    std::optional<view::Image> image = renderer_->capture(scene_, view_, error);
    dirty_ = true;
    if (!image) throw std::runtime_error(error);
    return std::move(*image);
}

void Viewport::show(Studio& studio) {
    const ImVec2 low = ImGui::GetCursorScreenPos(), space = ImGui::GetContentRegionAvail();
    const ImVec2 size(std::max(32.0f, std::floor(space.x)), std::max(32.0f, std::floor(space.y)));
    lens.place(low, size);
    const Frame& f = studio.frame();
    if (f.scene && framedFor_ != studio.sceneNumber()) {
        framedFor_ = studio.sceneNumber();
        lookThroughScene(studio);
        scene_.stage = {};
    }
    if (studio.view.followCamera && f.scene)
        lens.lookLike(scene::viewCamera(scene::cameraAt(studio.scene().camera, f.time)));

    // The buttons of the mouse other than the left one, and the wheel, belong to the camera.
    ImGui::InvisibleButton("viewport", size,
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                               ImGuiButtonFlags_MouseButtonMiddle);
    ui::note("viewport");
    pointer(studio);

    stage(studio);
    const view::Camera camera = lens.camera();
    dirty_ = dirty_ || drawnFrame_ != studio.framesTaken() || !same(camera, drawnCamera_) ||
             drawnView_.picture != studio.view.picture || drawnView_.controls != studio.view.controls ||
             drawnView_.clip != studio.view.clip || drawnView_.clipAxis != studio.view.clipAxis ||
             drawnView_.clipOffset != studio.view.clipOffset || drawnSize_.x != size.x || drawnSize_.y != size.y;
    const double time = now();
    // In pixels of the screen, of which a point of the window may have several.
    const ImVec2 dots = ImGui::GetIO().DisplayFramebufferScale;
    const int width = std::clamp(int(size.x * dots.x), 32, 8192), height = std::clamp(int(size.y * dots.y), 32, 8192);
    if (dirty_) {
        lastChange_ = time;
        const bool draft = software_ && fullMs_ > kSlowMs;
        if (draft) {
            const float share = std::clamp(share_ * std::sqrt(kDraftMs / std::max(draftMs_, 1.0f)), kLeastShare, 1.0f);
            share_ = draftMs_ > 0 ? share : 0.5f;
        }
        view_.samples = draft ? 1 : 4;
        // Blurred in a draft, so only where colours mean something.
        view_.legend = !draft || studio.view.picture != scene::PictureView::shaded;
        view_.draft = draft;
        draw(studio, draft ? std::max(32, int(float(width) * share_)) : width,
             draft ? std::max(32, int(float(height) * share_)) : height);
        target_->draft = draft;
        (draft ? draftMs_ : fullMs_) = drawMs_;
        drawnFrame_ = studio.framesTaken(), drawnCamera_ = camera, drawnView_ = studio.view, drawnSize_ = size;
        dirty_ = false;
    } else if (target_->draft && time - lastChange_ > kStillSeconds && !studio.playing() && !ImGui::IsAnyMouseDown()) {
        view_.samples = 4, view_.legend = true, view_.draft = false;
        draw(studio, width, height);
        target_->draft = false;
        fullMs_ = drawMs_;
    }

    sharp_ = !target_->draft && drawnFrame_ == studio.framesTaken() && same(camera, drawnCamera_);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 high(low.x + size.x, low.y + size.y);
    const float u = float(target_->usedWidth) / float(std::max(target_->image.width, 1)),
                v = float(target_->usedHeight) / float(std::max(target_->image.height, 1));
    list.AddImage(ImTextureID(intptr_t(target_->image.texture.get())), low, high, {0, v}, {u, 0});
    list.PushClipRect(low, high, true);
    tools_->update(studio, lens, pointer_, list);
    if (!f.built) {
        const char* text =
            f.error.empty() ? (f.scene && !f.scene->bodies.empty() ? "building the world ..." : "") : f.error.c_str();
        list.AddText({low.x + 12, low.y + 12}, IM_COL32(255, 190, 120, 255), text);
    }
    if (!error_.empty()) list.AddText({low.x + 12, low.y + 32}, IM_COL32(255, 120, 120, 255), error_.c_str());
    list.PopClipRect();
}

void Viewport::pointer(Studio& studio) {
    const ImGuiIO& io = ImGui::GetIO();
    pointer_ = {};
    pointer_.at = io.MousePos;
    pointer_.trail = trail;
    if (pointer_.trail.empty()) pointer_.trail.push_back(pointer_.at);
    pointer_.over = ImGui::IsItemHovered();
    pointer_.shift = io.KeyShift, pointer_.ctrl = io.KeyCtrl;
    const bool active = ImGui::IsItemActive();
    const bool left = !io.KeyAlt;
    pointer_.pressed = left && ImGui::IsItemActivated() && ImGui::IsMouseClicked(ImGuiMouseButton_Left);
    pointer_.held = left && active && ImGui::IsMouseDown(ImGuiMouseButton_Left);
    pointer_.released = ImGui::IsItemDeactivated() && ImGui::IsMouseReleased(ImGuiMouseButton_Left);
    pointer_.clickedTwice = pointer_.over && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left);
    const ImVec2 way = io.MouseDelta;
    const auto dragged = [&](ImGuiMouseButton button) { return active && ImGui::IsMouseDragging(button, 2); };
    const bool orbits = dragged(ImGuiMouseButton_Right) || (io.KeyAlt && dragged(ImGuiMouseButton_Left)) ||
                        (!io.KeyShift && dragged(ImGuiMouseButton_Middle));
    const bool pans = io.KeyShift && (dragged(ImGuiMouseButton_Middle) || dragged(ImGuiMouseButton_Right));
    if (pans)
        lens.pan(way), studio.view.followCamera = false;
    else if (orbits)
        lens.orbit(way), studio.view.followCamera = false;
    if (pointer_.over && io.MouseWheel != 0 && !io.KeyCtrl) {
        const std::optional<Hit> hit = studio.picker().cast(lens.ray(pointer_.at));
        lens.zoom(io.MouseWheel, hit ? std::optional(hit->point) : std::nullopt);
        studio.view.followCamera = false;
    }
}

} // namespace thaw::editor
