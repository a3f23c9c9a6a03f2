// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "model/changes.h"
#include "player/scene.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>

namespace thaw::editor {

/// Meshes of scenes, each file read once as long as it stays what it is.
class MeshStore {
public:
    /// The same as the last time where no shape has changed. Throws scene::InputError that names the place in the
    /// scene.
    std::shared_ptr<const scene::SceneMeshes> load(const scene::Scene& scene);

private:
    struct File {
        scene::TriMesh mesh;
        int64_t time = 0;
    };
    std::map<std::string, File> files_;
    std::string key_;
    std::shared_ptr<const scene::SceneMeshes> last_;
};

/// A world that follows the scene it was made of. Not from two threads at a time.
class LiveWorld {
public:
    explicit LiveWorld(int threads) : threads_(threads) {}

    /// A new world. Throws scene::InputError or std::runtime_error; there is none then.
    void build(std::shared_ptr<const scene::Scene> scene, std::shared_ptr<const scene::SceneMeshes> meshes);
    /// Brings what changed since into the world as it stands; a body that was moved or reshaped comes anew, what was
    /// molten of it is gone with it. Where colliders only moved they go there over the next steps as a hand would, when
    /// they are driven, or jump. Throws as build does; what was refused is left as it was, all else is done. False:
    /// only a new world can have what changed, and nothing was done.
    bool follow(std::shared_ptr<const scene::Scene> scene, std::shared_ptr<const scene::SceneMeshes> meshes,
                bool driven);
    void clear();

    /// One step of 1/60 s. Returns thawStepStatus bits.
    uint32_t step(const thawBudget& budget);

    /// All of it that an image of the world does not hold.
    struct Standing {
        std::shared_ptr<const scene::Scene> scene;
        std::shared_ptr<const scene::SceneMeshes> meshes;
        std::vector<thawMaterialId> materials;
        std::vector<thawBodyId> bodies;
        std::vector<thawColliderId> colliders;
        std::vector<thawHeatSourceId> heatSources;
        std::vector<thawPathId> paths;
        std::vector<thawShapeId> shapes;
        std::vector<thawMeshReport> bodyReports, colliderReports;
        std::vector<bool> driven;
    };
    Standing standing() const;
    /// After the world was put back to when it stood so.
    void stand(const Standing& standing);

    thawWorld* world() const { return made_.world.get(); }
    const scene::SceneWorld& ids() const { return made_; }
    const std::shared_ptr<const scene::Scene>& scene() const { return scene_; }
    const std::shared_ptr<const scene::SceneMeshes>& meshes() const { return meshes_; }
    /// Where a collider is; not where it is on its way to.
    scene::Placement placementOf(size_t collider) const;

private:
    template <class F> void attempt(F&& part);
    void followMaterials(const scene::Scene& scene, const Changes& changes);
    void followColliders(const scene::Scene& scene, const scene::SceneMeshes& meshes, const Changes& changes,
                         bool driven);
    void followBodies(const scene::Scene& scene, const scene::SceneMeshes& meshes, const Changes& changes);
    void followControls(const scene::Scene& scene, const scene::SceneMeshes& meshes, const Changes& changes);
    void drive();

    int threads_;
    scene::SceneWorld made_;
    std::shared_ptr<const scene::Scene> scene_;
    std::shared_ptr<const scene::SceneMeshes> meshes_;
    std::vector<bool> driven_; // colliders on their way
    std::string refused_;
};

} // namespace thaw::editor
