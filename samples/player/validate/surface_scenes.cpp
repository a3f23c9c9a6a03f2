// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "report.h"
#include "run.h"
#include "validate/lab.h"
#include "validate/mesh_of.h"
#include "validate/validate.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace thaw::player {
namespace {

// Every tenth frame of a scene as captures step it, for as long as it says.
void check(Findings& found, const std::string& path) {
    const scene::Scene scene = scene::loadScene(path);
    const scene::SceneMeshes meshes = scene::loadMeshes(scene);
    const scene::SceneWorld built = scene::buildWorld(scene, meshes, defaultThreads());
    const thawBudget budget = makeBudget(scene, 0.0, kCaptureWork);
    int openEdges = 0, tangledEdges = 0, worstFrame = 0;
    double worst = 0;
    Report report;
    report.budget = budget;
    const int frames = framesOf(double(scene.defaults.seconds));
    for (int f = 0; f <= frames; ++f) {
        if (f > 0) stepOrThrow(built.world.get(), budget, report);
        if (f % 10 != 0) continue;
        thawSurfaceDef def;
        thawInitSurfaceDef(&def);
        thawSurfaceView surface;
        if (thawWorld_ExtractSurface(built.world.get(), &def, &surface) != thawResult_ok)
            throw LabError(thawWorld_GetLastError(built.world.get()));
        const Mesh mesh(surface);
        int open = 0, tangled = 0;
        mesh.faults(open, tangled);
        openEdges += open, tangledEdges += tangled;
        thawParticleView p;
        thawWorld_GetParticles(built.world.get(), &p);
        double volume = 0;
        for (int i = 0; i < p.count; ++i)
            volume += double(p.velocities[4 * i + 3]) / double(scene.materials[p.materials[i]].def.density);
        const double off = volume > 0 ? mesh.volume() / volume - 1 : mesh.triangles.empty() ? 0 : 1;
        if (std::abs(off) > std::abs(worst)) worst = off, worstFrame = f;
    }
    found.atMost(scene::oneLine(scene.name, 40) + ": edges with one triangle", 0, openEdges);
    found.atMost("edges with more than two", 0, tangledEdges);
    found.atMost(formatted("volume against the particles', frame %d (%+.1f %%)", worstFrame, 100 * worst), 0.03,
                 std::abs(worst));
}

void scenes(Findings& found) {
    std::vector<std::string> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(scenesFolder(), error))
        if (entry.path().extension() == ".json") files.push_back(entry.path().string());
    if (files.empty()) throw LabError("no scenes in " + scenesFolder() + " (--scenes FOLDER says where they are)");
    std::sort(files.begin(), files.end());
    for (const std::string& file : files) check(found, file);
}

} // namespace

CaseList sceneCases() {
    return {{"scenes", "every tenth frame of every sample scene: closed, and of the volume of its particles", scenes}};
}

} // namespace thaw::player
