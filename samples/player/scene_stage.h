// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// What of a scene is drawn beside its melt, and how: what captures and the editor have in common.
#pragma once

#include "scene.h"
#include "view/renderer.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace thaw::scene {

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
// Whether a view draws particles in place of the surface.
bool isOfParticles(PictureView view);
view::ViewMode modeOf(PictureView view);

// Triangles of shapes as they are drawn, each made once.
class DrawnMeshes {
public:
    std::shared_ptr<const view::TriangleMesh> of(const Shape& shape, const TriMesh& mesh, const std::string& directory);
    std::shared_ptr<const view::TriangleMesh> plane(); // a square with sides of 2 m
    // Forgets them all, where mesh files have changed.
    void clear() { known_.clear(); }

private:
    std::map<std::string, std::shared_ptr<const view::TriangleMesh>> known_;
};

// Colliders, props, glows, floor, light and looks; the melt is left out. Meshes as loadMeshes gives them.
view::Scene stageOf(const Scene& scene, const SceneMeshes& meshes, DrawnMeshes& drawn);
// Paths and shapes that are on.
std::vector<view::Region> regionsOf(const Scene& scene, const SceneMeshes& meshes);

// Ends of one scale in K for all pictures of a scene, so that they can be compared.
struct TemperatureRange {
    float low, high;
};
TemperatureRange temperatureRangeOf(const Scene& scene);

view::Camera viewCamera(const Camera& camera);

// The particles of a world as balls of half their spacing.
class ParticleBalls {
public:
    ParticleBalls() = default;
    // cut: only those behind the middle of what there is at first.
    ParticleBalls(const Scene& scene, bool cut);
    // Puts them into a scene to be drawn, which reads them until the next call. featureSizes: as many, for
    // PictureView::elfs only.
    void show(const thawParticleView& all, const float* featureSizes, PictureView mode, const view::Camera& camera,
              view::Scene& scene);

private:
    float spacing_ = 0, featureHigh_ = 0;
    bool cut_ = false;
    std::vector<double> middle_;      // x y z, of the first picture
    std::vector<float> absorptivity_; // of each material
    std::vector<float> positions_, velocities_, temperatures_, values_;
    std::vector<uint8_t> levels_;
    thawParticleView view_{};
};

} // namespace thaw::scene
