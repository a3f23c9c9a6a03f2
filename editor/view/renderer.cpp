// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// A picture is made in these passes; numbers are for 960 x 540.
//
//   key map (1024^2) and flame maps (512^2 each): depth from the lights
//   behind (480 x 270), where melt is clear: everything else, and the depth of the melt's back
//   splats (960 x 540), where the melt is drawn from its particles: depths, filter, colours
//   geometry (960 x 540, multisampled): normal, roughness, kind; colour, translucency; depth
//   reduce (480 x 270) -> lighting: occlusion, soft shadow, light through wax, flames -> blur along surfaces
//   mirror (480 x 270): what the table reflects
//   classify -> shade (960 x 540, linear, half floats), one pass per kind of pixel, edges per sample -> flames
//   glow (240 x 135 and 120 x 68) -> composite (film curve, sRGB) -> scale or key
//
// The slow light at half size is what makes this affordable on a software rasteriser: shadows, occlusion and light in
// wax have no detail that a quarter of the pixels would miss, and they need some 40 texture reads each. Shading after
// the geometry and not with it is the other half: with triangles of a pixel or two llvmpipe ran the long shader 16
// times a pixel, and the frame took four times as long.

#include "view/renderer.h"

#include "view/color_map.h"
#include "view/data_scale.h"
#include "view/passes.h"
#include "view/splats.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace thaw::view {

namespace {

constexpr int kKeyMapSize = 1024, kFlameMapSize = 512;
constexpr float kFlameHalfWidth = 0.25f; // of a flame's height
constexpr float kNoClip[4] = {0, 0, 0, 1};
constexpr int kModePlain = 4, kModeFloor = 5;                          // beyond ViewMode, as in geometry.frag
constexpr int kMaxFlames = 8, kShadowedFlames = 4, kMaxMaterials = 16; // as in common.glsl

struct MeshBuffers {
    GlVertexArray array;
    GlBuffer positions, normals, temperatures, liquids, materials, mixtures, indices;
    GLsizei indexCount = 0;
    Bounds bounds;
    std::shared_ptr<const TriangleMesh> source; // keeps the address from being used again
    bool used = false;
};

Bounds transformed(const Bounds& b, const MeshInstance& instance) {
    Bounds out;
    for (int i = 0; i < 8 && !b.empty(); ++i) {
        const Vec3 corner{i & 1 ? b.upper.x : b.lower.x, i & 2 ? b.upper.y : b.lower.y, i & 4 ? b.upper.z : b.lower.z};
        out.add(rotate(instance.rotation, corner * instance.scale) + instance.position);
    }
    return out;
}

float flameHeight(const Glow& glow) { return glow.height > 0 ? glow.height : 8 * glow.radius; }

std::array<float, 3> floats(Vec3 v) { return {v.x, v.y, v.z}; }

} // namespace

MaterialLook materialLook(thawMaterialPreset preset) {
    switch (preset) {
    case thawMaterial_chocolate:
        return {{0.105f, 0.042f, 0.018f}, 0.12f, 0.46f, 0, 0};
    case thawMaterial_butter:
        return {{0.90f, 0.70f, 0.24f}, 0.55f, 0.38f, 0, 0.012f};
    case thawMaterial_ice:
        return {{0.74f, 0.87f, 0.93f}, 0.95f, 0.10f, 0.30f, 0.5f};
    case thawMaterial_icecream:
        return {{0.88f, 0.74f, 0.66f}, 0.40f, 0.62f, 0, 0};
    case thawMaterial_darkchocolate:
        return {{0.05f, 0.022f, 0.012f}, 0.08f, 0.42f, 0, 0};
    case thawMaterial_aluminium:
        return {{0.80f, 0.81f, 0.83f}, 0.0f, 0.25f, 0, 0};
    case thawMaterial_iron:
        return {{0.45f, 0.44f, 0.43f}, 0.0f, 0.40f, 0, 0};
    case thawMaterial_lava:
        return {{0.06f, 0.05f, 0.05f}, 0.0f, 0.70f, 0, 0};
    default:
        return {};
    }
}

Bounds sceneBounds(const Scene& scene) {
    Bounds bounds = surfaceBounds(scene.surface);
    for (const thawParticleView* view : {scene.particles, scene.splats})
        for (int32_t i = 0; view && i < view->count; ++i) {
            const float* p = view->positions + size_t(i) * 4;
            bounds.add(Vec3{p[0] - p[3], p[1] - p[3], p[2] - p[3]});
            bounds.add(Vec3{p[0] + p[3], p[1] + p[3], p[2] + p[3]});
        }
    for (const MeshInstance& instance : scene.meshes)
        if (instance.mesh) bounds.add(transformed(instance.mesh->bounds(), instance));
    for (const Glow& glow : scene.glows) {
        if (glow.shape == GlowShape::hidden) continue;
        const float h = glow.shape == GlowShape::flame ? 0.7f * flameHeight(glow) : glow.radius;
        bounds.add(glow.position + Vec3{0, h, 0});
        bounds.add(glow.position - Vec3{0, glow.radius, 0});
    }
    return bounds;
}

struct Renderer::State {
    std::string rendererText;
    GLint maxSamples = 4;

    GlProgram meshGeometry, meshDepth, meshKey, meshFlame, meshMirror, particleGeometry, particleKey;
    GlProgram regionProgram, reduce, mirrorBlur, lighting, blur, classify, shadeBackdrop, shadeThing, shadeClear,
        shadeFloor, shadeData, shadeEdge, flame, bloomDown, bloomBlur, composite, overlay;
    Splats splats;
    std::vector<GlProgram*> programs; // all of them

    GlVertexArray empty;
    MeshBuffers surface, floorMesh;
    std::vector<std::unique_ptr<MeshBuffers>> still;
    GlVertexArray particleArray;
    GlBuffer particleSpheres, particleValues;

    GlTexture keyMap, flameMap, ramp, overlayTexture;
    GlFramebuffer keyFramebuffer, flameFramebuffer;

    // Sized to the picture.
    int width = 0, height = 0, samples = 0, lightWidth = 0, lightHeight = 0;
    Target geometry, mirror, mirrorBlurred, behind, kinds, picture, output, bloom[2][2];
    GlTexture backDepth; // and of behind while that is drawn
    GlTexture mirrorDepth, lightTextures[2][2], sampleNormals, sampleAlbedos, sampleDepths;
    GlFramebuffer lightFramebuffers[2], sampleFramebuffer;

    std::vector<float> values; // of particles, 0..1

    bool build(std::string& error);
    bool resize(int w, int h, int wantedSamples, std::string& error);
    bool draw(const Scene& scene, const View& view, GLuint framebuffer, std::string& error);

    void uploadSurface(const thawSurfaceView& view);
    MeshBuffers& stillMesh(const std::shared_ptr<const TriangleMesh>& mesh);
    void drawRegions(const std::vector<Region>& regions);
    void fullscreen() {
        glBindVertexArray(empty.get());
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
};

bool Renderer::State::build(std::string& error) {
    if (epoxy_gl_version() < 33) return error = "OpenGL 3.3 is needed", false;
    const auto text = [](GLenum name) {
        const GLubyte* s = glGetString(name);
        return std::string(s ? reinterpret_cast<const char*>(s) : "unknown");
    };
    rendererText = text(GL_RENDERER) + " | " + text(GL_VERSION);
    glGetIntegerv(GL_MAX_SAMPLES, &maxSamples);

    std::vector<Recipe> recipes = {
        {meshGeometry, "mesh.vert", "surface.glsl+geometry.frag", "CAMERA_PASS"},
        {meshDepth, "mesh.vert", "depth.frag", "CAMERA_PASS"},
        {meshKey, "mesh.vert", "depth.frag", "KEY_PASS"},
        {meshFlame, "mesh.vert", "depth.frag", "FLAME_PASS"},
        {meshMirror, "mesh.vert", "mirror.glsl+mirror.frag", "CAMERA_PASS"},
        {particleGeometry, "particle.vert", "sphere.glsl+particle_geometry.frag", "CAMERA_PASS"},
        {particleKey, "particle.vert", "sphere.glsl+particle_depth.frag", "KEY_PASS"},
        {reduce, "fullscreen.vert", "reduce.frag", ""},
        {lighting, "fullscreen.vert", "lighting.frag", ""},
        {blur, "fullscreen.vert", "blur.frag", ""},
        {mirrorBlur, "fullscreen.vert", "mirror_blur.frag", ""},
        {classify, "fullscreen.vert", "classify.frag", ""},
        {shadeBackdrop, "fullscreen.vert", "shade.frag", "BACKDROP_PASS"},
        {shadeThing, "fullscreen.vert", "shade.frag", "THING_PASS"},
        {shadeClear, "fullscreen.vert", "shade.frag", "CLEAR_PASS"},
        {shadeFloor, "fullscreen.vert", "shade.frag", "FLOOR_PASS"},
        {shadeData, "fullscreen.vert", "shade.frag", "DATA_PASS"},
        {shadeEdge, "fullscreen.vert", "shade.frag", "EDGE_PASS"},
        {flame, "flame.vert", "flame.frag", ""},
        {bloomDown, "fullscreen.vert", "bloom_down.frag", ""},
        {bloomBlur, "fullscreen.vert", "bloom_blur.frag", ""},
        {composite, "fullscreen.vert", "composite.frag", ""},
        {regionProgram, "region.vert", "region.frag", ""},
        {overlay, "fullscreen.vert", "overlay.frag", ""},
    };
    for (const Recipe& r : splats.recipes()) recipes.push_back(r);
    for (const Recipe& r : recipes) {
        programs.push_back(&r.program);
        if (!r.program.build(r.vertex, r.fragment, r.pass, error)) return false;
        r.program.use();
        r.program.set("uKeyMap", unitKeyMap);
        r.program.set("uFlameMap", unitFlameMap);
        r.program.set("uGeometry", unitGeometry);
        r.program.set("uLight", unitLight);
        r.program.set("uFlame", unitFlame);
        r.program.set("uMirror", unitMirror);
        r.program.set("uRamp", unitRamp);
        r.program.set("uSource", unitSource);
        r.program.set("uNormals", unitNormals);
        r.program.set("uKinds", unitKinds);
        r.program.set("uAlbedos", unitAlbedos);
        r.program.set("uDepths", unitDepths);
        r.program.set("uPicture", unitSource);
        r.program.set("uBloomNear", unitNear);
        r.program.set("uBloomFar", unitFar);
        r.program.set("uBehind", unitBehind);
        r.program.set("uBack", unitBack);
        r.program.set("uSplats", unitSplats);
        r.program.set("uSmooth", unitSplatDepths);
        r.program.set("uSplatAlbedos", unitSplatAlbedos);
        r.program.set("uSplatStates", unitSplatStates);
    }
    glUseProgram(0);

    const auto depthOnly = [&](GlFramebuffer& framebuffer) {
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.get());
        glDrawBuffer(GL_NONE);
        glReadBuffer(GL_NONE);
    };
    makeTexture(keyMap, GL_DEPTH_COMPONENT32F, kKeyMapSize, kKeyMapSize, GL_NEAREST);
    depthOnly(keyFramebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, keyMap.get(), 0);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return error = "the driver refuses a shadow map", false;
    bindTexture(unitFlameMap, GL_TEXTURE_2D_ARRAY, flameMap.get());
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_COMPONENT32F, kFlameMapSize, kFlameMapSize, kShadowedFlames, 0,
                 GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
    setTexture(GL_TEXTURE_2D_ARRAY, GL_NEAREST);
    depthOnly(flameFramebuffer);

    std::array<float, 256 * 3> colors;
    for (size_t i = 0; i < 256; ++i) {
        const Vec3 c = heatColor(static_cast<float>(i) / 255);
        colors[i * 3] = c.x, colors[i * 3 + 1] = c.y, colors[i * 3 + 2] = c.z;
    }
    bindTexture(unitRamp, GL_TEXTURE_2D, ramp.get());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, 256, 1, 0, GL_RGB, GL_FLOAT, colors.data());
    setTexture(GL_TEXTURE_2D, GL_LINEAR);

    // The floor as a grid: one quad that reaches behind the eye loses precision when it is clipped.
    std::vector<float> grid, normals;
    std::vector<uint32_t> indices;
    constexpr uint32_t kCells = 16;
    for (uint32_t j = 0; j <= kCells; ++j)
        for (uint32_t i = 0; i <= kCells; ++i) {
            grid.insert(grid.end(),
                        {2.0f * static_cast<float>(i) / kCells - 1, 0, 2.0f * static_cast<float>(j) / kCells - 1});
            normals.insert(normals.end(), {0, 1, 0});
        }
    for (uint32_t j = 0; j < kCells; ++j)
        for (uint32_t i = 0; i < kCells; ++i) {
            const uint32_t a = j * (kCells + 1) + i, b = a + kCells + 1;
            indices.insert(indices.end(), {a, b, a + 1, a + 1, b, b + 1});
        }
    glBindVertexArray(floorMesh.array.get());
    upload(floorMesh.positions, GL_ARRAY_BUFFER, grid.data(), grid.size() * 4, GL_STATIC_DRAW);
    attribute(0, 3, GL_FLOAT);
    upload(floorMesh.normals, GL_ARRAY_BUFFER, normals.data(), normals.size() * 4, GL_STATIC_DRAW);
    attribute(1, 3, GL_FLOAT);
    upload(floorMesh.indices, GL_ELEMENT_ARRAY_BUFFER, indices.data(), indices.size() * 4, GL_STATIC_DRAW);
    floorMesh.indexCount = static_cast<GLsizei>(indices.size());
    glBindVertexArray(0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (const GLenum code = glGetError()) return error = "OpenGL error " + std::to_string(code) + " at start", false;
    return true;
}

bool Renderer::State::resize(int w, int h, int wantedSamples, std::string& error) {
    const int n = std::clamp(wantedSamples, 1, std::max(1, static_cast<int>(maxSamples)));
    if (w == width && h == height && n == samples) return true;
    width = height = 0; // so that a failure is not taken for a finished size
    // Small pictures light every pixel: at half of 320 x 180 a drip is one sample wide.
    const int divisor = w * h > 300000 ? 2 : 1;
    lightWidth = (w + divisor - 1) / divisor, lightHeight = (h + divisor - 1) / divisor;
    if (!makeTarget(geometry, GL_RGBA32F, lightWidth, lightHeight, GL_NEAREST, nullptr, error)) return false;
    for (int i = 0; i < 2; ++i) {
        makeTexture(lightTextures[i][0], GL_RGBA8, lightWidth, lightHeight, GL_NEAREST);
        makeTexture(lightTextures[i][1], GL_RGBA16F, lightWidth, lightHeight, GL_NEAREST);
        glBindFramebuffer(GL_FRAMEBUFFER, lightFramebuffers[i].get());
        for (int k = 0; k < 2; ++k)
            glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(k), GL_TEXTURE_2D,
                                   lightTextures[i][k].get(), 0);
        const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
        glDrawBuffers(2, both);
        if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
            return error = "the driver refuses the light buffers", false;
    }
    if (!makeTarget(mirror, GL_RGBA16F, (w + 1) / 2, (h + 1) / 2, GL_LINEAR, &mirrorDepth, error)) return false;
    if (!makeTarget(mirrorBlurred, GL_RGBA16F, (w + 1) / 2, (h + 1) / 2, GL_LINEAR, nullptr, error)) return false;
    if (!makeTarget(behind, GL_RGBA16F, (w + 1) / 2, (h + 1) / 2, GL_LINEAR, &backDepth, error)) return false;
    if (!makeTarget(kinds, GL_R8, w, h, GL_NEAREST, nullptr, error)) return false;
    if (!makeTarget(picture, GL_RGBA16F, w, h, GL_LINEAR, nullptr, error)) return false;
    if (!makeTarget(output, GL_RGBA8, w, h, GL_NEAREST, nullptr, error)) return false;
    for (int i = 0; i < 2; ++i)
        for (int k = 0; k < 2; ++k)
            if (!makeTarget(bloom[i][k], GL_RGBA16F, std::max(1, w >> (2 + i)), std::max(1, h >> (2 + i)), GL_LINEAR,
                            nullptr, error))
                return false;

    glBindFramebuffer(GL_FRAMEBUFFER, sampleFramebuffer.get());
    const auto sampled = [&](GlTexture& target, GLenum format, GLenum attachment) {
        bindTexture(unitSource, GL_TEXTURE_2D_MULTISAMPLE, target.get());
        glTexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, n, format, w, h, GL_TRUE);
        glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D_MULTISAMPLE, target.get(), 0);
    };
    sampled(sampleNormals, GL_RGBA16F, GL_COLOR_ATTACHMENT0);
    sampled(sampleAlbedos, GL_RGBA8, GL_COLOR_ATTACHMENT1);
    sampled(sampleDepths, GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT);
    bindTexture(unitSource, GL_TEXTURE_2D_MULTISAMPLE, 0);
    const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(2, both);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        return error = "the driver refuses " + std::to_string(n) + " samples at " + std::to_string(w) + " x " +
                       std::to_string(h),
               false;
    width = w, height = h, samples = n;
    return true;
}

void Renderer::State::uploadSurface(const thawSurfaceView& view) {
    surface.indexCount = view.triangleCount * 3;
    surface.bounds = surfaceBounds(view);
    if (!surface.indexCount) return;
    const auto n = static_cast<size_t>(view.vertexCount);
    glBindVertexArray(surface.array.get());
    upload(surface.positions, GL_ARRAY_BUFFER, view.positions, n * 12, GL_STREAM_DRAW);
    attribute(0, 3, GL_FLOAT);
    upload(surface.normals, GL_ARRAY_BUFFER, view.normals, n * 12, GL_STREAM_DRAW);
    attribute(1, 3, GL_FLOAT);
    const auto optional = [&](GLuint index, GlBuffer& buffer, const void* data, size_t size, GLenum type) {
        if (data) {
            upload(buffer, GL_ARRAY_BUFFER, data, n * size, GL_STREAM_DRAW);
            attribute(index, 1, type);
        } else
            glDisableVertexAttribArray(index);
    };
    optional(2, surface.temperatures, view.temperatures, 4, GL_FLOAT);
    optional(3, surface.liquids, view.liquidFractions, 4, GL_FLOAT);
    if (view.mixtures) {
        // Four materials and their shares.
        upload(surface.mixtures, GL_ARRAY_BUFFER, view.mixtures, n * 8, GL_STREAM_DRAW);
        glVertexAttribPointer(4, 4, GL_UNSIGNED_BYTE, GL_FALSE, 8, nullptr);
        glVertexAttribPointer(5, 4, GL_UNSIGNED_BYTE, GL_TRUE, 8, reinterpret_cast<const void*>(4));
        glEnableVertexAttribArray(4), glEnableVertexAttribArray(5);
    } else {
        glDisableVertexAttribArray(5);
        optional(4, surface.materials, view.materials, 1, GL_UNSIGNED_BYTE);
    }
    upload(surface.indices, GL_ELEMENT_ARRAY_BUFFER, view.indices, static_cast<size_t>(surface.indexCount) * 4,
           GL_STREAM_DRAW);
    glBindVertexArray(0);
}

MeshBuffers& Renderer::State::stillMesh(const std::shared_ptr<const TriangleMesh>& mesh) {
    for (auto& known : still)
        if (known->source == mesh) {
            known->used = true;
            return *known;
        }
    auto made = std::make_unique<MeshBuffers>();
    made->source = mesh;
    made->used = true;
    made->bounds = mesh->bounds();
    made->indexCount = static_cast<GLsizei>(mesh->indices.size());
    glBindVertexArray(made->array.get());
    upload(made->positions, GL_ARRAY_BUFFER, mesh->positions.data(), mesh->positions.size() * 4, GL_STATIC_DRAW);
    attribute(0, 3, GL_FLOAT);
    upload(made->normals, GL_ARRAY_BUFFER, mesh->normals.data(), mesh->normals.size() * 4, GL_STATIC_DRAW);
    attribute(1, 3, GL_FLOAT);
    upload(made->indices, GL_ELEMENT_ARRAY_BUFFER, mesh->indices.data(), mesh->indices.size() * 4, GL_STATIC_DRAW);
    glBindVertexArray(0);
    still.push_back(std::move(made));
    return *still.back();
}

// Into the bound framebuffer, over a finished picture.
void Renderer::State::drawRegions(const std::vector<Region>& regions) {
    if (regions.empty()) return;
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    glEnable(GL_CULL_FACE);
    regionProgram.use();
    const auto pass = [&](const Region& region, float opacity) {
        const Vec3 c = regionColor(region.kind);
        const Vec3 shown{encodeSrgb(c.x) / 255.0f, encodeSrgb(c.y) / 255.0f, encodeSrgb(c.z) / 255.0f};
        regionProgram.set3("uColor", floats(shown).data());
        regionProgram.set("uOpacity", opacity);
        const MeshBuffers& mesh = stillMesh(region.mesh);
        glBindVertexArray(const_cast<MeshBuffers&>(mesh).array.get());
        glDrawElements(GL_TRIANGLES, mesh.indexCount, GL_UNSIGNED_INT, nullptr);
    };
    // Bodies first, so that lines are not veiled.
    for (const Region& region : regions)
        if (region.kind == RegionKind::path || region.kind == RegionKind::target)
            pass(region, region.kind == RegionKind::path ? 0.35f : 0.2f);
    for (const Region& region : regions)
        if (region.kind != RegionKind::path && region.kind != RegionKind::target) pass(region, 0.95f);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    for (const Region& region : regions)
        if (region.kind == RegionKind::target) pass(region, 0.4f);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
}

static bool checkScene(const Scene& scene, const View& view, std::string& error) {
    const auto refuse = [&](const std::string& why) { return error = why, false; };
    if (view.width < 16 || view.width > 8192 || view.height < 16 || view.height > 8192)
        return refuse("view.width and view.height must be 16..8192, got " + std::to_string(view.width) + " x " +
                      std::to_string(view.height));
    if (!(view.exposure > 0)) return refuse("view.exposure must be above 0");
    const Camera& c = view.camera;
    if (!(c.fieldOfView >= 0.01f && c.fieldOfView <= 3)) return refuse("camera.fieldOfView must be 0.01..3 rad");
    if (!(length(c.target - c.eye) > 1e-9f)) return refuse("camera.eye and camera.target are the same place");
    if (!(length(cross(c.target - c.eye, c.up)) > 1e-9f * length(c.target - c.eye)))
        return refuse("camera.up lies along the line of sight");
    if (!(length(scene.key.direction) > 1e-9f)) return refuse("key.direction has no length");
    const thawSurfaceView& s = scene.surface;
    if (s.vertexCount < 0 || s.triangleCount < 0) return refuse("surface counts must not be negative");
    if (s.triangleCount > 0) {
        if (!s.positions || !s.normals || !s.indices) return refuse("surface lacks positions, normals or indices");
        const auto vertices = static_cast<uint32_t>(s.vertexCount);
        for (size_t i = 0; i < static_cast<size_t>(s.triangleCount) * 3; ++i)
            if (s.indices[i] >= vertices)
                return refuse("surface index " + std::to_string(s.indices[i]) + " is beyond its " +
                              std::to_string(vertices) + " vertices");
    }
    for (const MeshInstance& m : scene.meshes) {
        if (!m.mesh) return refuse("a mesh instance has no mesh");
        if (m.mesh->normals.size() != m.mesh->positions.size()) return refuse("a mesh lacks normals");
        for (const uint32_t i : m.mesh->indices)
            if (i >= m.mesh->positions.size() / 3) return refuse("a mesh index is beyond its vertices");
    }
    for (const Region& r : scene.regions)
        if (!r.mesh || r.mesh->normals.size() != r.mesh->positions.size()) return refuse("a region has no mesh");
    if (scene.splats && !(scene.splatSpacing > 0)) return refuse("splatSpacing must be above 0");
    if (scene.splats && scene.splats->count > 0 &&
        (scene.splatShapes.count != scene.splats->count || !scene.splatShapes.centers || !scene.splatShapes.axes))
        return refuse("splats lack shapes");
    for (const thawParticleView* particles : {scene.particles, scene.splats}) {
        if (!particles) continue;
        const thawParticleView& p = *particles;
        if (p.count < 0 || (p.count > 0 && !p.positions)) return refuse("particles lack positions");
    }
    return true;
}

bool Renderer::State::draw(const Scene& scene, const View& view, GLuint framebuffer, std::string& error) {
    if (!checkScene(scene, view, error) || !resize(view.width, view.height, view.samples, error)) return false;
    while (glGetError() != GL_NO_ERROR) {
    } // of others, before this frame

    uploadSurface(scene.splats ? thawSurfaceView{} : scene.surface);
    splats.upload(scene);
    if (!splats.empty() && !splats.resize(width, height, error)) return false;
    for (auto& known : still) known->used = false;
    std::vector<MeshBuffers*> meshes;
    for (const MeshInstance& instance : scene.meshes) meshes.push_back(&stillMesh(instance.mesh));
    for (const Region& region : scene.regions) stillMesh(region.mesh);
    std::erase_if(still, [](const auto& known) { return !known->used; });

    // The scale of the scene: what melts, and things near it. A table of metres must not stretch the shadow map.
    Bounds bounds = surface.bounds;
    bounds.add(splats.bounds());
    if (scene.particles)
        for (int32_t i = 0; i < scene.particles->count; ++i) {
            const float* p = scene.particles->positions + size_t(i) * 4;
            bounds.add(Vec3{p[0], p[1], p[2]});
        }
    const Bounds melt = bounds;
    for (size_t i = 0; i < meshes.size(); ++i) {
        const Bounds b = transformed(meshes[i]->bounds, scene.meshes[i]);
        if (melt.empty() || b.radius() < 3 * melt.radius()) bounds.add(b);
    }
    if (!scene.stage.empty()) bounds = scene.stage;
    if (bounds.empty()) bounds.add(Vec3{-0.1f, 0, -0.1f}), bounds.add(Vec3{0.1f, 0.2f, 0.1f});
    const float radius = std::max(bounds.radius(), 1e-4f);
    const Vec3 center = bounds.center();

    // Camera.
    const Camera& camera = view.camera;
    const Vec3 forward = normalize(camera.target - camera.eye), right = normalize(cross(forward, camera.up)),
               up = cross(right, forward);
    const float tanHalf = std::tan(camera.fieldOfView / 2), aspect = static_cast<float>(view.width) / view.height;
    const float distance = length(camera.eye - center);
    const float floorRadius = 9 * radius + distance;
    const float near = std::max(0.02f * radius, (distance - radius) * 0.1f), far = distance + 2 * floorRadius;
    const Mat4 viewM = viewMatrix(camera.eye, right, up, forward), projection = perspective(tanHalf, aspect, near, far);
    const bool floorShown = scene.floor.visible && camera.eye.y > scene.floor.height;

    // Key light.
    const Vec3 keyDirection = normalize(scene.key.direction), keyRight = perpendicular(keyDirection),
               keyUp = cross(keyDirection, keyRight);
    const float keyHalf = radius * 1.08f;
    const Mat4 keyView = viewMatrix(center + keyDirection * (3 * radius), keyRight, keyUp, keyDirection * -1);
    // Deep enough for the floor behind the shadow of a low light; what is before it is clamped.
    const float keyDepth = 12 * radius;
    Mat4 half;
    half.m = {0.5f, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 0.5f, 0, 0.5f, 0.5f, 0.5f, 1};
    const Mat4 keyMatrix = half * orthographic(keyHalf, 0, keyDepth) * keyView;

    // Flames.
    std::array<float, kMaxFlames * 4> flamePositions{};
    std::array<float, kMaxFlames * 3> flameColors{};
    std::array<Vec3, kShadowedFlames> flameAxes{}, flameRights{}, flameUps{};
    const float flameReach = 8 * radius;
    int flameCount = 0;
    for (const Glow& glow : scene.glows) {
        if (glow.power <= 0 || flameCount == kMaxFlames) continue;
        const auto i = static_cast<size_t>(flameCount++);
        const float strength = 1.25f * glow.power / (glow.power + 25) * (0.3f * radius) * (0.3f * radius);
        const float flicker = glow.shape == GlowShape::flame
                                  ? 1 + 0.03f * std::sin(9.7f * scene.time) + 0.02f * std::sin(23 * scene.time)
                                  : 1;
        const float soft = std::max(glow.radius, 0.22f * radius);
        const float values4[4] = {glow.position.x, glow.position.y, glow.position.z, soft};
        std::copy(values4, values4 + 4, flamePositions.begin() + static_cast<std::ptrdiff_t>(i * 4));
        const Vec3 color = glow.color * (strength * flicker * 3.6f);
        std::memcpy(&flameColors[i * 3], &color, 12);
        if (i < kShadowedFlames) {
            flameAxes[i] = normalize(center - glow.position, {0, -1, 0});
            flameRights[i] = perpendicular(flameAxes[i]);
            flameUps[i] = cross(flameAxes[i], flameRights[i]);
        }
    }

    const DataScale scale = dataScale(scene, view, values);
    const auto particleCount = static_cast<GLsizei>(values.size());
    if (particleCount > 0) {
        glBindVertexArray(particleArray.get());
        upload(particleSpheres, GL_ARRAY_BUFFER, scene.particles->positions, values.size() * 16, GL_STREAM_DRAW);
        attribute(0, 4, GL_FLOAT);
        glVertexAttribDivisor(0, 1);
        upload(particleValues, GL_ARRAY_BUFFER, values.data(), values.size() * 4, GL_STREAM_DRAW);
        attribute(1, 1, GL_FLOAT);
        glVertexAttribDivisor(1, 1);
        glBindVertexArray(0);
    }

    const bool dataView = view.mode != ViewMode::shaded || particleCount > 0;
    const int modeNumber =
        view.mode == ViewMode::shaded && particleCount > 0 ? kModePlain : static_cast<int>(view.mode);
    const Vec3 dataCenter{0.055f, 0.057f, 0.062f}, dataEdge{0.03f, 0.031f, 0.034f};

    std::array<float, kMaxMaterials * 4> materialColors{};
    std::array<float, kMaxMaterials> materialRoughness{};
    std::array<float, kMaxMaterials * 2> materialClear{};
    bool anyClear = false;
    for (size_t i = 0; i < kMaxMaterials; ++i) {
        const MaterialLook look =
            scene.materials.empty() ? MaterialLook{} : scene.materials[std::min(i, scene.materials.size() - 1)];
        const float four[4] = {look.color.x, look.color.y, look.color.z, std::clamp(look.translucency, 0.0f, 1.0f)};
        std::copy(four, four + 4, materialColors.begin() + static_cast<std::ptrdiff_t>(i * 4));
        materialRoughness[i] = std::clamp(look.roughness, 0.05f, 1.0f);
        // As in common.glsl.
        const auto share = [](float depth) { return std::max(depth, 0.0f) / (std::max(depth, 0.0f) + 0.05f); };
        if (view.draft) continue;
        materialClear[2 * i] = share(look.clearDepth), materialClear[2 * i + 1] = share(look.meltClearDepth);
        anyClear = anyClear || look.clearDepth > 0 || look.meltClearDepth > 0;
    }

    const Vec3 keyColor = scene.key.color * scene.key.intensity;
    const auto vec = [](GlProgram& p, const char* name, Vec3 v) { p.set3(name, floats(v).data()); };
    const auto setCamera = [&](GlProgram& p, const Mat4& v, Vec3 eye, Vec3 u) {
        p.setMatrix("uView", v.m.data());
        vec(p, "uEye", eye);
        vec(p, "uCameraUp", u * tanHalf);
    };
    for (GlProgram* program : programs) {
        GlProgram& p = *program;
        p.use();
        setCamera(p, viewM, camera.eye, up);
        p.setMatrix("uProjection", projection.m.data());
        vec(p, "uCameraRight", right * (tanHalf * aspect));
        vec(p, "uCameraForward", forward);
        p.set("uSceneRadius", radius);
        p.set("uNearFar", near, far);
        p.set("uPictureSize", static_cast<float>(view.width), static_cast<float>(view.height));
        p.set("uSampleCount", samples);
        p.set("uFloorHeight", scene.floor.height);
        vec(p, "uKeyDirection", keyDirection);
        vec(p, "uKeyColor", keyColor);
        vec(p, "uKeyRight", keyRight);
        vec(p, "uKeyUp", keyUp);
        p.set("uKeyAngle", std::clamp(scene.key.angle, 0.0f, 0.5f));
        p.setMatrix("uKeyMatrix", keyMatrix.m.data());
        p.set("uKeyExtent", 2 * keyHalf);
        p.set("uKeyDepth", keyDepth);
        p.set("uKeyTexel", 1.0f / kKeyMapSize);
        vec(p, "uZenith", scene.environment.zenith);
        vec(p, "uHorizon", scene.environment.horizon);
        vec(p, "uGround", scene.environment.ground);
        vec(p, "uBackdropCenter", dataView ? dataCenter : scene.environment.backdropCenter);
        vec(p, "uBackdropEdge", dataView ? dataEdge : scene.environment.backdropEdge);
        p.set("uFlameCount", flameCount);
        p.set4("uFlamePosition", flamePositions.data(), kMaxFlames);
        p.set3("uFlameColor", flameColors.data(), kMaxFlames);
        p.set3("uFlameAxis", &flameAxes[0].x, kShadowedFlames);
        p.set3("uFlameRight", &flameRights[0].x, kShadowedFlames);
        p.set3("uFlameUp", &flameUps[0].x, kShadowedFlames);
        p.set("uFlameReach", flameReach);
        p.set4("uClip", kNoClip, 1);
        p.set("uMode", modeNumber);
        p.set("uLightScale", static_cast<float>(lightWidth) / view.width,
              static_cast<float>(lightHeight) / view.height);
        p.set("uTemperatureRange", scale.temperatureLow, scale.temperatureHigh);
    }
    for (GlProgram* p : splats.materialPrograms()) {
        p->use();
        p->set4("uMaterialColor", materialColors.data(), kMaxMaterials);
        p->set1("uMaterialRoughness", materialRoughness.data(), kMaxMaterials);
    }
    glUseProgram(0);

    const auto setMaterial = [&](GlProgram& p, const MeshInstance* instance) {
        const Mat4 model = instance ? transform(instance->position, instance->rotation, instance->scale) : Mat4{};
        p.setMatrix("uModel", model.m.data());
        if (instance) {
            const float color[4] = {instance->color.x, instance->color.y, instance->color.z, 0};
            const float roughness = std::clamp(instance->roughness, 0.05f, 1.0f);
            p.set4("uMaterialColor", color, 1);
            p.set1("uMaterialRoughness", &roughness, 1);
            p.set("uMaterialClear", 0.0f, 0.0f);
        } else {
            p.set4("uMaterialColor", materialColors.data(), kMaxMaterials);
            p.set1("uMaterialRoughness", materialRoughness.data(), kMaxMaterials);
            p.set2("uMaterialClear", materialClear.data(), kMaxMaterials);
        }
    };
    const auto drawIndexed = [&](const MeshBuffers& mesh) {
        glBindVertexArray(const_cast<MeshBuffers&>(mesh).array.get());
        glDrawElements(GL_TRIANGLES, mesh.indexCount, GL_UNSIGNED_INT, nullptr);
    };
    const bool showSurface = surface.indexCount > 0;
    enum class Melt { none, front, whole };
    // Meshes and particles of the scene with a pair of programs.
    const auto drawThings = [&](GlProgram& meshProgram, GlProgram* particleProgram, bool castersOnly,
                                Melt part = Melt::whole) {
        meshProgram.use();
        glVertexAttrib1f(2, scale.temperatureLow);
        glVertexAttrib1f(3, 0);
        glVertexAttrib1f(4, 0);
        if (showSurface && part != Melt::none) {
            // A melt surface is closed and its triangles turn outward; of other meshes nobody promises that.
            if (part == Melt::front) glEnable(GL_CULL_FACE);
            setMaterial(meshProgram, nullptr);
            drawIndexed(surface);
            glDisable(GL_CULL_FACE);
        }
        for (size_t i = 0; i < meshes.size(); ++i) {
            if (castersOnly && !scene.meshes[i].castsShadow) continue;
            setMaterial(meshProgram, &scene.meshes[i]);
            if (modeNumber != 0) meshProgram.set("uMode", kModePlain);
            drawIndexed(*meshes[i]);
        }
        if (modeNumber != 0) meshProgram.set("uMode", modeNumber);
        if (particleProgram && particleCount > 0) {
            particleProgram->use();
            glBindVertexArray(particleArray.get());
            glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, particleCount);
        }
    };

    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_STENCIL_TEST);
    glDisable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    glFrontFace(GL_CCW);
    glDisable(GL_FRAMEBUFFER_SRGB);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glDisable(GL_CLIP_DISTANCE0);
    bindTexture(unitRamp, GL_TEXTURE_2D, ramp.get());

    // Maps of the lights.
    glEnable(GL_DEPTH_CLAMP);
    glBindFramebuffer(GL_FRAMEBUFFER, keyFramebuffer.get());
    glViewport(0, 0, kKeyMapSize, kKeyMapSize);
    glClear(GL_DEPTH_BUFFER_BIT);
    if (!view.draft) {
        drawThings(meshKey, &particleKey, true);
        splats.drawKey();
    }
    glDisable(GL_DEPTH_CLAMP);
    glEnable(GL_CLIP_DISTANCE0);
    glViewport(0, 0, kFlameMapSize, kFlameMapSize);
    glBindFramebuffer(GL_FRAMEBUFFER, flameFramebuffer.get());
    for (int i = 0; i < std::min(flameCount, kShadowedFlames) && view.mode == ViewMode::shaded; ++i) {
        glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, flameMap.get(), 0, i);
        glClear(GL_DEPTH_BUFFER_BIT);
        if (view.draft) continue;
        meshFlame.use();
        meshFlame.set("uFlameLayer", i);
        drawThings(meshFlame, nullptr, true);
        splats.drawFlame(i);
    }
    bindTexture(unitKeyMap, GL_TEXTURE_2D, keyMap.get());
    bindTexture(unitFlameMap, GL_TEXTURE_2D_ARRAY, flameMap.get());

    // Mirror image of the table.
    const bool reflects = floorShown && !dataView && !view.draft && scene.floor.reflectivity > 0;
    glBindFramebuffer(GL_FRAMEBUFFER, mirror.framebuffer.get());
    glViewport(0, 0, mirror.width, mirror.height);
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    const float underFloor[4] = {0, 1, 0, -scene.floor.height};
    if (reflects) {
        const float y2 = 2 * scene.floor.height;
        Mat4 flip;
        flip.m = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, y2, 0, 1};
        meshMirror.use();
        setCamera(meshMirror, viewM * flip, {camera.eye.x, y2 - camera.eye.y, camera.eye.z}, up);
        meshMirror.set4("uClip", underFloor, 1);
        drawThings(meshMirror, nullptr, false);
        splats.mirrorProgram().use();
        setCamera(splats.mirrorProgram(), viewM * flip, {camera.eye.x, y2 - camera.eye.y, camera.eye.z}, up);
        splats.mirrorProgram().set4("uClip", underFloor, 1);
        splats.drawMirror();
    }
    glDisable(GL_CLIP_DISTANCE0);
    bindTexture(unitMirror, GL_TEXTURE_2D, mirror.texture.get());
    glDisable(GL_DEPTH_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, mirrorBlurred.framebuffer.get());
    mirrorBlur.use();
    fullscreen();
    bindTexture(unitMirror, GL_TEXTURE_2D, mirrorBlurred.texture.get());
    glEnable(GL_DEPTH_TEST);

    // What is seen through clear melt: everything else, and how thick it is.
    const bool clear = anyClear && showSurface && !dataView;
    if (clear) {
        glBindFramebuffer(GL_FRAMEBUFFER, behind.framebuffer.get());
        glViewport(0, 0, behind.width, behind.height);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        meshMirror.use();
        setCamera(meshMirror, viewM, camera.eye, up);
        meshMirror.set4("uClip", kNoClip, 1);
        drawThings(meshMirror, nullptr, false, Melt::none);
        glClear(GL_DEPTH_BUFFER_BIT);
        glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        glEnable(GL_CULL_FACE);
        glCullFace(GL_FRONT);
        meshDepth.use();
        setMaterial(meshDepth, nullptr);
        drawIndexed(surface);
        glCullFace(GL_BACK);
        glDisable(GL_CULL_FACE);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        bindTexture(unitBehind, GL_TEXTURE_2D, behind.texture.get());
        bindTexture(unitBack, GL_TEXTURE_2D, backDepth.get());
    }

    // Geometry.
    splats.prepare(projection * viewM);
    MeshInstance ground;
    ground.position = {center.x, scene.floor.height, center.z};
    ground.scale = floorRadius;
    ground.color = dataView ? Vec3{0.075f, 0.077f, 0.082f} : scene.floor.color;
    glBindFramebuffer(GL_FRAMEBUFFER, sampleFramebuffer.get());
    glViewport(0, 0, view.width, view.height);
    glEnable(GL_MULTISAMPLE);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    const Vec3 phases[3] = {phaseColor(Phase::solid), phaseColor(Phase::mushy), phaseColor(Phase::liquid)};
    for (GlProgram* p : {&meshGeometry, &splats.resolveProgram()}) {
        p->use();
        p->set3("uPhaseColor", &phases[0].x, 3);
        p->set("uPhaseLimits", kSolidBelow, kLiquidAbove);
    }
    splats.resolve(samples);
    const bool cut = view.cut.on;
    if (cut) {
        const Vec3 n = normalize(view.cut.normal);
        const float plane[4] = {-n.x, -n.y, -n.z, dot(n, view.cut.point)};
        for (GlProgram* p : {&meshGeometry, &particleGeometry}) p->use(), p->set4("uClip", plane, 1);
        meshGeometry.use();
        meshGeometry.set("uInside", 1);
        glEnable(GL_CLIP_DISTANCE0);
    }
    drawThings(meshGeometry, &particleGeometry, false, cut ? Melt::whole : Melt::front);
    if (cut) {
        glDisable(GL_CLIP_DISTANCE0);
        meshGeometry.use();
        meshGeometry.set("uInside", 0);
        meshGeometry.set4("uClip", kNoClip, 1); // the floor stays whole
    }
    if (floorShown) {
        meshGeometry.use();
        setMaterial(meshGeometry, &ground);
        meshGeometry.set("uMode", kModeFloor);
        drawIndexed(floorMesh);
    }
    bindTexture(unitNormals, GL_TEXTURE_2D_MULTISAMPLE, sampleNormals.get());
    bindTexture(unitAlbedos, GL_TEXTURE_2D_MULTISAMPLE, sampleAlbedos.get());
    bindTexture(unitDepths, GL_TEXTURE_2D_MULTISAMPLE, sampleDepths.get());

    // Slow light.
    glDisable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    glBindFramebuffer(GL_FRAMEBUFFER, geometry.framebuffer.get());
    glViewport(0, 0, lightWidth, lightHeight);
    reduce.use();
    fullscreen();
    bindTexture(unitGeometry, GL_TEXTURE_2D, geometry.texture.get());
    // Where nothing is they keep these values: whatever was left there must not seep into the picture.
    const float open[4] = {1, 1, 0, 1}, dark[4] = {0, 0, 0, 1};
    for (GlFramebuffer& lightFramebuffer : lightFramebuffers) {
        glBindFramebuffer(GL_FRAMEBUFFER, lightFramebuffer.get());
        glClearBufferfv(GL_COLOR, 0, open);
        glClearBufferfv(GL_COLOR, 1, dark);
    }
    glBindFramebuffer(GL_FRAMEBUFFER, lightFramebuffers[0].get());
    lighting.use();
    lighting.set("uOcclusionRadius", 0.16f * radius);
    lighting.set("uScatter", 0.125f * radius);
    if (view.mode != ViewMode::shaded) lighting.set("uFlameCount", 0);
    fullscreen();
    blur.use();
    for (int pass = 0; pass < 2; ++pass) {
        glBindFramebuffer(GL_FRAMEBUFFER, lightFramebuffers[1 - pass].get());
        bindTexture(unitLight, GL_TEXTURE_2D, lightTextures[pass][0].get());
        bindTexture(unitFlame, GL_TEXTURE_2D, lightTextures[pass][1].get());
        blur.set("uStep", pass == 0 ? 1 : 0, pass == 0 ? 0 : 1);
        fullscreen();
    }
    bindTexture(unitLight, GL_TEXTURE_2D, lightTextures[0][0].get());
    bindTexture(unitFlame, GL_TEXTURE_2D, lightTextures[0][1].get());

    // Colour.
    glViewport(0, 0, view.width, view.height);
    glBindFramebuffer(GL_FRAMEBUFFER, kinds.framebuffer.get());
    classify.use();
    fullscreen();
    bindTexture(unitKinds, GL_TEXTURE_2D, kinds.texture.get());
    glBindFramebuffer(GL_FRAMEBUFFER, picture.framebuffer.get());
    for (GlProgram* p : {&shadeBackdrop, &shadeThing, &shadeClear, &shadeFloor, &shadeData, &shadeEdge}) {
        if (p == &shadeClear && !clear) continue;
        p->use();
        p->set("uPlain", dataView ? 1 : 0);
        vec(*p, "uFloorCenter", ground.position);
        p->set("uReflectivity", reflects ? scene.floor.reflectivity : 0.0f);
        p->set("uFadeRadius", 6.5f * radius);
        vec(*p, "uFloorColor", ground.color);
        p->set("uFloorShown", floorShown ? 1 : 0);
        fullscreen();
    }
    flame.use();
    flame.set("uTime", scene.time);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    for (const Glow& glow : scene.glows) {
        if (glow.shape == GlowShape::hidden) continue;
        const bool cold = glow.power <= 0, ball = cold || glow.shape == GlowShape::ball;
        const float h = flameHeight(glow), warmth = cold ? 0.6f : 0.75f + 0.5f * glow.power / (glow.power + 25);
        // A third of the flame is below its position; the square is larger, for the halo (see flame.frag).
        vec(flame, "uFlameCenter", ball ? glow.position : glow.position + Vec3{0, h / 6, 0});
        flame.set("uFlameSize", ball ? 2 * glow.radius : kFlameHalfWidth * 3 * h, ball ? 2 * glow.radius : 0.8f * h);
        flame.set("uUpright", ball ? 0 : 1);
        flame.set("uShape", ball ? 1 : 0);
        vec(flame, "uTint", cold ? Vec3{0.12f, 0.35f, 1.0f} : glow.color);
        flame.set("uBrightness", warmth * (dataView ? 0.12f : 1.0f));
        glBindVertexArray(empty.get());
        glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
    glDisable(GL_BLEND);

    // Glow.
    for (int i = 0; i < 2 && !dataView; ++i) {
        const Target &from = i == 0 ? picture : bloom[0][0], &to = bloom[i][0], &side = bloom[i][1];
        const auto into = [&](const Target& target, const Target& source) {
            glBindFramebuffer(GL_FRAMEBUFFER, const_cast<Target&>(target).framebuffer.get());
            glViewport(0, 0, target.width, target.height);
            bindTexture(unitSource, GL_TEXTURE_2D, const_cast<Target&>(source).texture.get());
        };
        into(to, from);
        bloomDown.use();
        bloomDown.set("uThreshold", i == 0 ? 1.0f : 0.0f);
        fullscreen();
        bloomBlur.use();
        for (int round = 0; round < 3; ++round) {
            const float spread = static_cast<float>(1 << round);
            into(side, to);
            bloomBlur.set("uDirection", spread, 0.0f);
            fullscreen();
            into(to, side);
            bloomBlur.set("uDirection", 0.0f, spread);
            fullscreen();
        }
    }
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, view.width, view.height);
    bindTexture(unitSource, GL_TEXTURE_2D, picture.texture.get());
    bindTexture(unitNear, GL_TEXTURE_2D, bloom[0][0].texture.get());
    bindTexture(unitFar, GL_TEXTURE_2D, bloom[1][0].texture.get());
    composite.use();
    composite.set("uExposure", view.exposure);
    composite.set("uMode", dataView ? 1 : 0);
    fullscreen();

    drawRegions(scene.regions);
    const int size = std::clamp(view.height / 270, 1, 4);
    if (const Image panel = view.legend ? legendOf(scene, view, scale, size) : Image{}; panel.width > 0) {
        const int gap = 6 * size;
        bindTexture(unitSource, GL_TEXTURE_2D, overlayTexture.get());
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, panel.width, panel.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                     panel.pixels.data());
        setTexture(GL_TEXTURE_2D, GL_NEAREST);
        glViewport(view.width - panel.width - gap, view.height - panel.height - gap, panel.width, panel.height);
        glEnable(GL_BLEND);
        glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
        overlay.use();
        fullscreen();
        glDisable(GL_BLEND);
        glViewport(0, 0, view.width, view.height);
    }

    for (int unit = unitCount - 1; unit >= 0; --unit) {
        bindTexture(unit, GL_TEXTURE_2D, 0);
        glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, 0);
        if (unit == unitFlameMap) glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
    }
    glDepthMask(GL_TRUE);
    glBindVertexArray(0);
    glUseProgram(0);
    if (const GLenum code = glGetError()) return error = "OpenGL error " + std::to_string(code), false;
    return true;
}

std::unique_ptr<Renderer> Renderer::create(std::string& error) {
    auto made = std::make_unique<State>();
    if (!made->build(error)) return nullptr;
    return std::unique_ptr<Renderer>(new Renderer(std::move(made)));
}

Renderer::Renderer(std::unique_ptr<State> made) : state(std::move(made)) {}
Renderer::~Renderer() = default;

const std::string& Renderer::rendererString() const { return state->rendererText; }

bool Renderer::draw(const Scene& scene, const View& view, unsigned framebuffer, std::string& error) {
    return state->draw(scene, view, framebuffer, error);
}

std::optional<Image> Renderer::capture(const Scene& scene, const View& view, std::string& error) {
    if (!checkScene(scene, view, error) || !state->resize(view.width, view.height, view.samples, error))
        return std::nullopt;
    if (!state->draw(scene, view, state->output.framebuffer.get(), error)) return std::nullopt;
    Image image(view.width, view.height);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, view.width, view.height, GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data());
    if (const GLenum code = glGetError()) {
        error = "reading the picture back failed with OpenGL error " + std::to_string(code);
        return std::nullopt;
    }
    for (int y = 0; y < image.height / 2; ++y)
        std::swap_ranges(&image.at(0, y), &image.at(0, y) + image.width, &image.at(0, image.height - 1 - y));
    for (Rgba& p : image.pixels) p.a = 255;
    return image;
}

} // namespace thaw::view
