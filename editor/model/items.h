// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "player/scene.h"

#include <optional>
#include <string>

namespace thaw::editor {

/// What of a scene can be chosen and changed.
enum class Kind { none, world, camera, material, body, collider, source, path, shape, prop };
struct Item {
    Kind kind = Kind::none;
    int index = 0; // in its list; 0 for the world and the camera
    bool operator==(const Item&) const = default;
    explicit operator bool() const { return kind != Kind::none; }
};

/// "body", "heat source", ...
const char* kindName(Kind kind);
/// How many there are; 1 of the world and the camera.
int countOf(const scene::Scene& scene, Kind kind);
bool exists(const scene::Scene& scene, Item item);
/// Null for the world and the camera.
std::string* nameOf(scene::Scene& scene, Item item);
/// As the outliner shows it: its name, or its kind and number.
std::string titleOf(const scene::Scene& scene, Item item);
/// A name that no other of its kind has: "box", "box 2", ...
std::string freeName(const scene::Scene& scene, Kind kind, const std::string& wanted);

/// Whether it stands somewhere.
bool hasPlace(Kind kind);
/// Where its handle is: its position, or the middle of its points, in the world.
thawVec3 pivotOf(const scene::Scene& scene, Item item);
thawQuat rotationOf(const scene::Scene& scene, Item item);
void move(scene::Scene& scene, Item item, thawVec3 by);
/// About a pivot, in the world. factor: range 1e-3..1e3.
void turn(scene::Scene& scene, Item item, thawVec3 pivot, thawQuat by);
void resize(scene::Scene& scene, Item item, thawVec3 pivot, float factor);

/// Takes it out; what referred to it refers to the first material, or to no collider. The last material that something
/// is made of stays: throws scene::InputError.
void erase(scene::Scene& scene, Item item);
/// A copy beside it, and which it is.
Item duplicate(scene::Scene& scene, Item item);

/// New things, as good defaults have them, and which they are.
Item addMaterial(scene::Scene& scene, thawMaterialPreset preset);
/// A material of the scene, or wax where there is none.
int someMaterial(scene::Scene& scene);
Item addBody(scene::Scene& scene, const scene::Shape& shape, thawVec3 position);
Item addCollider(scene::Scene& scene, const scene::Shape& shape, thawVec3 position);
Item addProp(scene::Scene& scene, const scene::Shape& shape, thawVec3 position);
Item addSource(scene::Scene& scene, thawHeatSourceType type, thawVec3 position);
/// points: in the world; collider: that they lie on, or -1.
Item addPath(scene::Scene& scene, const std::vector<thawVec3>& points, int collider);
Item addShape(scene::Scene& scene, const std::vector<thawVec3>& contour, int collider);

/// How far below its origin a shape reaches, so that it can stand on something.
float footOf(const scene::Shape& shape);

/// Points of a collider's space in the world, and back.
thawVec3 toWorld(const scene::Scene& scene, int collider, thawVec3 point);
thawVec3 fromWorld(const scene::Scene& scene, int collider, thawVec3 point);

} // namespace thaw::editor
