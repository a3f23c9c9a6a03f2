// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include "view/image.h"
#include "view/mesh.h"
#include "view/orbit.h"
#include "view/regions.h"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace thaw::view {

enum class ViewMode {
    shaded,      // a studio picture
    temperature, // colours for kelvin, with a scale
    phase,       // solid, mushy, liquid, with a key
    liquid       // colours for the liquid fraction, with a scale
};

enum class ParticleColor {
    temperature,
    liquidFraction,
    speed,
    level, // a colour for each, and a key with counts
    values // Scene::particleValues
};

/// Numbers of the host's own as colours of particles, and their scale.
struct ParticleValues {
    const float* values = nullptr; // one for each particle, read during the call only
    std::string title, unit;       // of the scale
    float low = 0, high = 0;       // its ends, in that unit; equal: up to the largest
    bool reversed = false;         // the low end is the hot one
};

/// How a melt material looks. At most 16 are told apart; a higher index takes the last.
struct MaterialLook {
    Vec3 color{0.86f, 0.78f, 0.62f}; // linear RGB 0..1
    float translucency = 0.75f;      // 0 opaque .. 1 light goes about an eighth of the scene's radius deep
    float roughness = 0.42f;         // 0.05 polished .. 1 matt, of the solid; melt always shines
    float clearDepth = 0;            // m, how deep one sees into the solid: e^-1 is left there; 0: only its surface
    float meltClearDepth = 0.004f;   // m, and into melt
};
/// A look that suits a preset of thaw; its colour is the preset's own unless you set color afterwards.
MaterialLook materialLook(thawMaterialPreset preset);

/// A still thing beside the melt: collider, wick, stand.
struct MeshInstance {
    std::shared_ptr<const TriangleMesh> mesh; // not null; must not change while a renderer knows it
    Vec3 position{0, 0, 0};
    thawQuat rotation{0, 0, 0, 1};
    float scale = 1;
    Vec3 color{0.30f, 0.30f, 0.32f}; // linear RGB
    float roughness = 0.5f;
    bool castsShadow = true;
};

enum class GlowShape {
    flame, // upright candle flame
    ball,  // glowing ball of the source's radius
    hidden // lights the scene only
};

/// A heat source as light. Its brightness follows the power gently (80 W is bright, 5 W dim) and the scene's size.
struct Glow {
    Vec3 position{0, 0, 0}; // m; a third of the flame is below it
    float power = 20;       // W; not above zero: drawn as a cold blue ball that gives no light
    float radius = 0.005f;  // m
    GlowShape shape = GlowShape::flame;
    float height = 0; // m of a flame; 0: eight radii
    Vec3 color{1.0f, 0.58f, 0.22f};
};

/// The main light, from one side and at infinity.
struct KeyLight {
    Vec3 direction{-0.80f, 0.58f, 0.08f}; // towards the light, any length but 0
    Vec3 color{1.0f, 0.95f, 0.88f};       // linear RGB
    float intensity = 1.15f;
    float angle = 0.16f; // rad, radius of the light as seen from the scene: how soft shadows are; range 0..0.5
};

/// Light from all round, by height.
struct Environment {
    Vec3 zenith{0.30f, 0.33f, 0.40f}, horizon{0.17f, 0.17f, 0.19f}, ground{0.07f, 0.06f, 0.055f};
    Vec3 backdropCenter{0.115f, 0.105f, 0.100f}, backdropEdge{0.012f, 0.012f, 0.015f}; // behind everything
};

/// A level table that runs into the backdrop.
struct Floor {
    bool visible = true;
    float height = 0; // m
    Vec3 color{0.115f, 0.10f, 0.092f};
    float reflectivity = 0.8f; // 0 matt .. 1 polished
};

struct Scene {
    thawSurfaceView surface{};           // read during the call only; may be empty
    std::vector<MaterialLook> materials; // by index of surface.materials; empty: wax
    std::vector<MeshInstance> meshes;
    std::vector<Glow> glows; // the first 8 give light, the first 4 of them cast shadows
    /// The melt from its particles, in screen space, in place of surface when not null: temperatures, liquidFractions
    /// and materials are read, of positions the spheres of influence, during the call only; splatShapes goes with it.
    const thawParticleView* splats = nullptr;
    thawSplatView splatShapes{};                 // as many
    float splatSpacing = 0.002f;                 // m, of those at level 0; > 0
    const thawParticleView* particles = nullptr; // drawn as balls when not null
    ParticleColor particleColor = ParticleColor::temperature;
    ParticleValues particleValues;    // for that colour only
    std::array<int, 4> levelCounts{}; // for the key of the levels; all 0: what is drawn is counted
    std::vector<Region> regions;      // laid over the picture, fainter behind things, with a key
    Floor floor;
    KeyLight key;
    Environment environment;
    float time = 0; // s, moves the flames
    /// What lights, shadows and depths are scaled to. Empty: what is in the scene, which grows as melt spreads; give it
    /// where pictures of one melt are to match.
    Bounds stage;
};

/// Leaves out the things and the melt on one side of a plane, to look inside; shadows stay whole. Not of splats.
struct Cut {
    bool on = false;
    Vec3 point{0, 0, 0}, normal{0, 0, 1}; // m; out of the plane, to what is left out; any length but 0
};

struct View {
    Camera camera;
    Cut cut;
    int width = 960, height = 540; // pixels, 16..8192 each
    int samples = 4;               // per pixel against stairs at edges; 1..8, cut to what the driver has
    ViewMode mode = ViewMode::shaded;
    float exposure = 1;                            // factor, > 0
    float temperatureLow = 0, temperatureHigh = 0; // K, ends of the scale; equal: from the data
    float speedHigh = 0;                           // m/s, end of the scale of particle speeds; 0: from the data
    bool legend = true;                            // scale or key in the picture, where the mode has one
    bool draft = false; // no shadows, reflections and looking through: half the time, while something moves
};

/// Draws scenes with OpenGL 3.3 core. Belongs to the context that was current when it was made (of a HeadlessContext or
/// of a window) and must be used and destroyed while that is current.
class Renderer {
public:
    /// nullptr, with the reason in error, when the context is too old or a shader does not compile.
    static std::unique_ptr<Renderer> create(std::string& error);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Draws into a framebuffer of view.width x view.height at its lower left corner; 0 is the window. Leaves that
    /// framebuffer bound and the program, vertex array and textures unbound. False, with the reason in error.
    bool draw(const Scene& scene, const View& view, unsigned framebuffer, std::string& error);
    /// Draws and reads back. nullopt, with the reason in error.
    std::optional<Image> capture(const Scene& scene, const View& view, std::string& error);
    /// GL_RENDERER and GL_VERSION.
    const std::string& rendererString() const;

private:
    struct State;
    explicit Renderer(std::unique_ptr<State> made);
    std::unique_ptr<State> state;
};

/// Everything a scene shows but the floor, for framing: surface, particles, meshes and flames.
Bounds sceneBounds(const Scene& scene);

} // namespace thaw::view
