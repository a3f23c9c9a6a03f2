// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "run.h"

#include <cstdio>

namespace thaw::player {

namespace {
std::string vectorText(const thawVec3& v) {
    return "(" + scene::shortest(v.x) + ", " + scene::shortest(v.y) + ", " + scene::shortest(v.z) + ")";
}

std::string repairs(const thawMeshReport& r) {
    std::string out;
    auto count = [&](uint32_t n, const char* what) {
        if (n) out += (out.empty() ? "" : ", ") + std::to_string(n) + " " + what;
    };
    count(r.duplicateVertices, "duplicate vertices welded");
    count(r.degenerateTriangles, "triangles without area left out");
    count(r.openEdges, "open edges closed");
    count(r.nonManifoldEdges, "edges with more than two triangles");
    count(r.inconsistentEdges, "edges whose triangles disagree about the outside");
    if (r.inverted) out += std::string(out.empty() ? "" : ", ") + "turned inside out";
    return out.empty() ? "nothing to repair" : out;
}

void printMesh(const scene::TriMesh& mesh, const thawMeshReport& r) {
    std::printf("    mesh: %zu triangles, %zu vertices, %u piece%s, %.4g cm^3, %.4g cm^2; %s\n", mesh.triangleCount(),
                mesh.vertexCount(), r.components, r.components == 1 ? "" : "s", r.volume * 1e6, r.area * 1e4,
                repairs(r).c_str());
}

std::string sourceText(const scene::HeatSource& h) {
    const std::string place = " at " + vectorText(h.position) + " m", kelvin = formatted("%g K", double(h.temperature));
    switch (h.type) {
    case thawHeatSource_point:
        return formatted("%g W", double(h.power)) + place + formatted(", radius %g m", double(h.radius));
    case thawHeatSource_sphere:
        return "sphere, " + kelvin + place + formatted(", radius %g m", double(h.radius));
    case thawHeatSource_rectangle:
        return "rectangle, " + kelvin + place + formatted(", %g by %g m", double(h.size.x), double(h.size.z));
    case thawHeatSource_disc:
        return "disc, " + kelvin + place + formatted(", radius %g m", double(h.radius));
    case thawHeatSource_directional:
        return formatted("directional, %g W/m^2", double(h.irradiance));
    }
    return "";
}

int info(const std::string& file) {
    const scene::Scene scene = scene::loadScene(file);
    const scene::SceneMeshes meshes = scene::loadMeshes(scene);
    const scene::SceneWorld built = scene::buildWorld(scene, meshes, 1);
    const thawWorld* world = built.world.get();
    thawCounters c;
    thawWorld_GetCounters(world, &c);

    std::printf("%s (%s)\n", scene::oneLine(scene.name, 120).c_str(), scene::oneLine(file, 300).c_str());
    const scene::WorldSettings& w = scene.world;
    std::printf(
        "world: spacing %s m, gravity %s m/s^2, ambient %s K, convection %s W/(m^2 K), heat runs %s times as fast\n",
        scene::shortest(w.particleSpacing).c_str(), vectorText(w.gravity).c_str(),
        scene::shortest(w.ambientTemperature).c_str(), scene::shortest(w.convection).c_str(),
        scene::shortest(w.thermalTimeScale).c_str());
    std::printf("particles: %d of at most %d, %.1f MB\n", c.particles, c.capacity, double(c.memoryBytes) / 1e6);

    std::printf("materials: %zu\n", scene.materials.size());
    for (const scene::Material& m : scene.materials) {
        const thawMaterialDef& d = m.def;
        std::printf("  %s (preset %s)\n", scene::oneLine(m.name, 80).c_str(), thawMaterialPresetName(m.preset));
        std::printf("    melts %g to %g K, latent heat %g kJ/kg, density %g kg/m^3\n", double(d.solidus),
                    double(d.liquidus), double(d.latentHeat) / 1e3, double(d.density));
        std::printf("    specific heat %g solid, %g liquid J/(kg K); conductivity %g solid, %g liquid W/(m K)\n",
                    double(d.specificHeatSolid), double(d.specificHeatLiquid), double(d.conductivitySolid),
                    double(d.conductivityLiquid));
        std::printf(
            "    viscosity %g solid, %g liquid Pa s; absorptivity %g, emissivity %g, cohesion %g, adhesion %g\n",
            double(d.viscositySolid), double(d.viscosityLiquid), double(d.absorptivity), double(d.emissivity),
            double(d.cohesion), double(d.adhesion));
        if (d.yieldStress > 0)
            std::printf("    yields at %g Pa, %s\n", double(d.yieldStress),
                        d.flow == thawFlow_casson ? "Casson" : "Bingham");
    }
    std::printf("bodies: %zu\n", scene.bodies.size());
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
        const scene::Body& b = scene.bodies[i];
        thawBodyState state{};
        thawBody_GetState(world, built.bodies[i], &state);
        std::printf("  %s: %s of %s, %d particles, %.4g g, %.2f K, from %s to %s m\n",
                    scene::oneLine(b.name, 80).c_str(),
                    b.shape.type == scene::ShapeType::mesh ? scene::oneLine(b.shape.meshFile, 120).c_str()
                                                           : scene::shapeName(b.shape.type),
                    scene::oneLine(scene.materials[size_t(b.material)].name, 80).c_str(), state.particles,
                    double(state.mass) * 1e3, double(state.meanTemperature), vectorText(state.lower).c_str(),
                    vectorText(state.upper).c_str());
        printMesh(meshes.bodies[i], built.bodyReports[i]);
    }
    std::printf("colliders: %zu\n", scene.colliders.size());
    for (size_t i = 0; i < scene.colliders.size(); ++i) {
        const scene::Collider& k = scene.colliders[i];
        std::printf("  %s: %s at %s m%s%s\n", scene::oneLine(k.name, 80).c_str(), scene::shapeName(k.shape.type),
                    vectorText(k.placement.position).c_str(), k.adhesive ? ", melt clings" : "",
                    k.occluder ? ", shades" : "");
        if (!meshes.colliders[i].indices.empty() && built.colliderReports[i].volume > 0.0)
            printMesh(meshes.colliders[i], built.colliderReports[i]);
    }
    std::printf("heat sources: %zu\n", scene.heatSources.size());
    for (const scene::HeatSource& h : scene.heatSources)
        std::printf("  %s: %s%s\n", scene::oneLine(h.name, 80).c_str(), sourceText(h).c_str(),
                    h.enabled ? "" : ", off");

    if (!scene.paths.empty()) std::printf("paths: %zu\n", scene.paths.size());
    for (size_t i = 0; i < scene.paths.size(); ++i) {
        const thawPathDef& d = scene.paths[i].def;
        thawPathState state;
        if (thawPath_GetState(world, built.paths[i], &state) != thawResult_ok) continue;
        std::printf("  %s: %g m long, radius %g m, strength %g, %s%s\n",
                    scene::oneLine(scene.paths[i].name, 80).c_str(), double(state.length), double(d.radius),
                    double(d.strength),
                    d.arrivalTime > 0 ? formatted("arrives after %g s", double(d.arrivalTime)).c_str()
                                      : formatted("%g m/s", double(d.speed)).c_str(),
                    d.enabled ? "" : ", off");
    }

    if (!scene.shapes.empty()) std::printf("shapes: %zu\n", scene.shapes.size());
    for (size_t i = 0; i < scene.shapes.size(); ++i) {
        const scene::FillShape& shape = scene.shapes[i];
        thawShapeState state;
        if (thawShape_GetState(world, built.shapes[i], &state) != thawResult_ok) continue;
        const std::string what = shape.contours.empty()
                                     ? formatted("%g cm^3", double(state.size) * 1e6)
                                     : formatted("%zu contour%s, %g cm^2", shape.contours.size(),
                                                 shape.contours.size() == 1 ? "" : "s", double(state.size) * 1e4);
        std::printf("  %s: %s, strength %g%s%s\n", scene::oneLine(shape.name, 80).c_str(), what.c_str(),
                    double(shape.def.strength),
                    shape.def.sets ? formatted(", sets when %g full", double(shape.def.setFill)).c_str() : "",
                    shape.def.enabled ? "" : ", off");
    }

    const thawBudget budget = makeBudget(scene, 0.0, "");
    thawPlan plan;
    const thawResult result = thawWorld_PreviewPlan(world, &budget, &plan);
    if (result != thawResult_ok) throw RunError(std::string("no plan: ") + thawResultString(result));
    std::printf("first step within %g ms: at most %d sub-steps, %d pressure, %d viscosity iterations\n",
                double(budget.milliseconds), plan.work.subSteps, plan.work.pressureIterations,
                plan.work.viscosityIterations);
    for (int s = 0; s < thawStage_count; ++s)
        std::printf("  %-11s %-3s %s\n", thawStageName(thawStage(s)), plan.enabled[s] ? "on" : "off",
                    thawReasonString(plan.reason[s]));
    return kExitOk;
}
} // namespace

void addInfo(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("info", "What a scene holds, and which stages its first step runs and why");
    auto file = std::make_shared<std::string>();
    command->add_option("scene", *file, "Scene file (JSON)")->required();
    command->callback([=, &exitCode] { exitCode = info(*file); });
}

} // namespace thaw::player
