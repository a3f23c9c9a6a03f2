// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// What a scene file holds, how it is read and written, and how it becomes a world. Uses thaw.h and the standard library
// only, so that the player and the editor share it. The format is described in samples/scenes/README.md.
#pragma once

#include "mesh.h"
#include "thaw/thaw.h"

#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace thaw::scene {

constexpr int kSceneVersion = 1;
constexpr int kMaxParticles = 4'000'000; // of thawWorldDef.maxParticles

// Bad input. what() is one line: "FILE: at /json/pointer: what is wrong".
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

enum class ShapeType { plane, box, sphere, cylinder, cone, torus, mesh };

struct Shape {
    ShapeType type = ShapeType::box;
    thawVec3 size{0.05f, 0.05f, 0.05f}; // box: edge lengths in m, range 1e-5..1e3
    float radius = 0.025f;              // sphere, cylinder, cone, torus; m, range 1e-5..1e3
    float height = 0.05f;               // cylinder, cone; m, range 1e-5..1e3
    float tubeRadius = 0.008f;          // torus; m, smaller than radius
    std::string meshFile;               // mesh: path, relative to the scene's folder
};

struct Placement {
    thawVec3 position{}; // m, each within 1e4
    thawQuat rotation{0.0f, 0.0f, 0.0f, 1.0f};
    float scale = 1.0f; // range 1e-6..1e6
};

struct WorldSettings {
    float particleSpacing = 0.002f;       // m, range 1e-4..1
    int maxParticles = 0;                 // range 8..4000000; 0: as many as the bodies need and a tenth more
    thawVec3 gravity{0.0f, -9.81f, 0.0f}; // m/s^2, each within 1000
    float ambientTemperature = 293.15f;   // K, range 100..10000
    float convection = 10.0f;             // W/(m^2 K), range 0..1e4
    float thermalTimeScale = 1.0f;        // range 0..1e5
};

struct Material {
    std::string name;
    thawMaterialPreset preset = thawMaterial_wax;
    thawMaterialDef def{}; // filled by thawInitMaterialDef, then changed
};

// What of a body is of another material.
struct Part {
    Shape shape;         // what lies inside of it; not a plane
    Placement placement; // in the space of the body's shape
    float depth = 0;     // m, > 0: what lies deeper beneath the body's surface instead; range 1e-6..1e4
    int material = 0;    // index into Scene::materials
};

// Of a body that is there; NaN leaves what it has.
struct Paint {
    thawBrush brush{{0, 0, 0}, 0.01f, 0}; // in the world
    float temperature = NAN;              // K, range 0..1e5
    float absorptivity = NAN;             // 1, range 0..1
};

struct Body {
    std::string name;
    Shape shape; // not a plane
    Placement placement;
    int material = 0;         // index into Scene::materials
    float temperature = NAN;  // K, range 100..10000; NaN: ambient
    std::vector<Part> parts;  // at most 64, later ones count where they overlap
    int coarsestLevel = 0;    // highest level that its solid starts with, 0..3
    bool anchored = true;     // stuck to the collider that it touches; false: stands free
    std::vector<Paint> paint; // at most 4096, one after the other
};

struct Collider {
    std::string name;
    Shape shape;
    Placement placement;
    bool adhesive = true;
    bool occluder = true;
    float slipLength = 0.0f;             // m, range 0..1e4
    float friction = 0.5f;               // range 0..10
    float temperature = NAN;             // K, range 0..1e5; NaN: exchanges no heat
    float contactConductance = INFINITY; // W/(m^2 K), range 0..infinity
    bool visible = true;
    thawVec3 color{0.35f, 0.33f, 0.31f}; // linear RGB 0..1
};

enum class SourceVisual { none, flame, glow };

struct HeatSource {
    std::string name;
    thawVec3 position{};   // m
    float power = 20.0f;   // W, range -1e6..1e6
    float radius = 0.005f; // m, range 1e-4..10
    bool enabled = true;
    SourceVisual visual = SourceVisual::glow;
    thawHeatSourceType type = thawHeatSource_point;
    thawQuat rotation{0.0f, 0.0f, 0.0f, 1.0f}; // rectangle, disc, directional: shines along its local +y
    thawVec3 size{0.1f, 0.0f, 0.1f};           // rectangle: edge lengths x and z in m, range 2e-4..2e4; y is not read
    float temperature = 1300.0f;               // K, sphere, rectangle, disc; range 0..1e9
    float emissivity = 1.0f;                   // of the same, range 0..1
    float irradiance = 1000.0f;                // W/m^2, directional; range -1e12..1e12
};

// See thawPathDef.
struct Path {
    std::string name;
    std::vector<thawVec3> points; // m, in the space of the collider if there is one
    thawPathDef def{};            // but for points and collider
    int collider = -1;            // index into Scene::colliders
};

// See thawShapeDef.
struct FillShape {
    std::string name;
    std::vector<std::vector<thawVec3>> contours; // m, in the space of the collider if there is one; none: a mesh
    Shape shape;                                 // without contours; not a plane
    Placement placement;                         // of that
    thawShapeDef def{};                          // but for points, contours, mesh, its placement and collider
    int collider = -1;                           // index into Scene::colliders
};

// Seen only: a wick, a spoon. Takes no part in the simulation.
struct Prop {
    std::string name;
    Shape shape; // not a plane
    Placement placement;
    thawVec3 color{0.2f, 0.2f, 0.2f};
};

struct CameraKey {
    float time = 0.0f; // s, range 0..3600
    thawVec3 eye{}, target{};
    float fieldOfViewDegrees = 35.0f; // vertical, range 1..150
};

struct Camera {
    thawVec3 eye{0.0f, 0.15f, 0.35f};
    thawVec3 target{0.0f, 0.05f, 0.0f};
    float fieldOfViewDegrees = 35.0f; // vertical, range 1..150
    std::vector<CameraKey> keys;      // at most 1000, times ascending; none: it stands still
};

// The camera at a time in s, without keys: those of `camera` smoothly run through. Each number is a monotone cubic of
// time (Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5, 1984): between two keys it never leaves what they span.
// Before the first and after the last key it is theirs.
Camera cameraAt(const Camera& camera, double time);

struct Look {
    thawVec3 sunDirection{-0.62f, 0.66f, 0.36f}; // toward the sun, any length but 0
    float exposure = 1.0f;                       // range 0.01..100
};

struct Defaults {
    float seconds = 10.0f;           // of motion, range 0.01..3600
    float budgetMilliseconds = 4.0f; // range 0.05..1e4
    std::vector<float> captures;     // s, at most 1000
};

struct Scene {
    std::string name = "untitled";
    std::string file;      // it came from, for messages; "" when made in memory
    std::string directory; // relative mesh files start here; "" is the current one
    WorldSettings world;
    std::vector<Material> materials;
    std::vector<Body> bodies;
    std::vector<Collider> colliders;
    std::vector<HeatSource> heatSources;
    std::vector<Path> paths;
    std::vector<FillShape> shapes;
    std::vector<Prop> props;
    Camera camera;
    Look look;
    Defaults defaults;
};

// Reads and checks a scene. Throws InputError. Mesh files are not opened.
Scene loadScene(const std::string& path);
// The same from text; file is used in messages, directory for mesh files.
Scene parseScene(const std::string& text, const std::string& file, const std::string& directory);
// The scene as text that parseScene reads back to the same values, bit for bit.
std::string writeScene(const Scene& scene);
// Writes it to a file, beside it first and then in its place. Throws std::runtime_error with the reason; what stood
// there is then untouched.
void saveScene(const Scene& scene, const std::string& path);
// Any text, in the same way.
void saveText(const std::string& text, const std::string& path);

const char* shapeName(ShapeType type);
// Plain text on one line: control characters become spaces, long text is cut.
std::string oneLine(const std::string& text, size_t limit = 120);
// Shortest decimal that reads back as the same float.
std::string shortest(float value);

// Triangles of everything that has some; reads mesh files. Indices match the scene's vectors.
struct SceneMeshes {
    std::vector<TriMesh> bodies, colliders, shapes, props; // empty for planes and contours
    std::vector<std::vector<TriMesh>> parts;               // of each body, in its space; empty for a depth
};
// What reads a mesh file; throws std::runtime_error as importMesh does.
using MeshReader = std::function<TriMesh(const std::string& path)>;
// Throws InputError that names the place in the scene.
SceneMeshes loadMeshes(const Scene& scene, const MeshReader& read = importMesh);
TriMesh makeShape(const Shape& shape, const std::string& directory, const MeshReader& read = importMesh);

// Particles that a mesh will hold, from its volume.
double estimateParticles(const TriMesh& mesh, float scale, float spacing);

struct WorldDeleter {
    void operator()(thawWorld* world) const { thawDestroyWorld(world); }
};

// A scene made into a world. Ids match the scene's vectors.
struct SceneWorld {
    std::unique_ptr<thawWorld, WorldDeleter> world;
    std::vector<thawMaterialId> materials;
    std::vector<thawBodyId> bodies;
    std::vector<thawMeshReport> bodyReports;
    std::vector<thawColliderId> colliders;
    std::vector<thawMeshReport> colliderReports; // zero for what is not a mesh
    std::vector<thawHeatSourceId> heatSources;
    std::vector<thawPathId> paths;
    std::vector<thawShapeId> shapes;
};

thawHeatSourceDef sourceDef(const HeatSource& source);

// The definition of a shape, with the memory that it points to; mesh: its triangles, where it has no contours, which
// must stay as long. Collider is not set.
struct FillShapeDef {
    FillShapeDef(const FillShape& shape, const TriMesh& mesh);
    FillShapeDef(const FillShapeDef&) = delete;
    FillShapeDef& operator=(const FillShapeDef&) = delete;
    thawShapeDef def;

private:
    std::vector<thawVec3> points_;
    std::vector<int32_t> sizes_;
};

// The definition of a path, with the scene's points; colliders as in SceneWorld.
thawPathDef pathDef(const Path& path, const std::vector<thawColliderId>& colliders);

// Throws InputError when the scene asks for what cannot be, std::runtime_error when memory is short.
// threads: range 1..64. room: for 32 more of everything and half as many particles again, for who edits the scene
// while it runs; not where the scene says maxParticles itself.
SceneWorld buildWorld(const Scene& scene, const SceneMeshes& meshes, int threads, bool room = false);

// One thing of the scene in a world that is there. Throw as buildWorld does. report: not null.
thawMaterialId createMaterial(thawWorld* world, const Scene& scene, size_t i);
thawColliderId createCollider(thawWorld* world, const Scene& scene, const SceneMeshes& meshes, size_t i,
                              thawMeshReport* report);
thawBodyId createBody(thawWorld* world, const Scene& scene, const SceneMeshes& meshes, size_t i,
                      const std::vector<thawMaterialId>& materials, thawMeshReport* report);
// A body's paint from the first-th on.
void paintBody(thawWorld* world, const Scene& scene, size_t i, thawBodyId id, size_t first);
thawHeatSourceId createSource(thawWorld* world, const Scene& scene, size_t i);
thawPathId createPath(thawWorld* world, const Scene& scene, size_t i, const std::vector<thawColliderId>& colliders);
thawShapeId createShape(thawWorld* world, const Scene& scene, const SceneMeshes& meshes, size_t i,
                        const std::vector<thawColliderId>& colliders);

} // namespace thaw::scene
