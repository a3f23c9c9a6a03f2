// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "model/items.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace thaw::editor {

using scene::Scene;

namespace {

thawVec3 plus(thawVec3 a, thawVec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
thawVec3 minus(thawVec3 a, thawVec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
thawVec3 times(thawVec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }

thawQuat inverse(thawQuat q) { return {-q.x, -q.y, -q.z, q.w}; }

thawQuat product(thawQuat a, thawQuat b) {
    const thawQuat q{a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                     a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
    const float l = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    return {q.x / l, q.y / l, q.z / l, q.w / l};
}

template <class S> auto placementIn(S& s, Item item) -> decltype(&s.bodies[0].placement) {
    const size_t i = size_t(item.index);
    switch (item.kind) {
    case Kind::body:
        return &s.bodies[i].placement;
    case Kind::collider:
        return &s.colliders[i].placement;
    case Kind::prop:
        return &s.props[i].placement;
    case Kind::shape:
        return s.shapes[i].contours.empty() ? &s.shapes[i].placement : nullptr;
    default:
        return nullptr;
    }
}

/// Every point of a path or of contours, with the collider in whose space they are.
template <class S, class F> void forPoints(S& s, Item item, F&& f) {
    if (item.kind == Kind::path) {
        auto& path = s.paths[size_t(item.index)];
        for (auto& p : path.points) f(p, path.collider);
    } else if (item.kind == Kind::shape) {
        auto& shape = s.shapes[size_t(item.index)];
        for (auto& contour : shape.contours)
            for (auto& p : contour) f(p, shape.collider);
    }
}

template <class List> Item last(Kind kind, const List& list) { return {kind, int(list.size()) - 1}; }

std::string shapeWord(const scene::Shape& shape) {
    if (shape.type != scene::ShapeType::mesh) return scene::shapeName(shape.type);
    const size_t slash = shape.meshFile.find_last_of("/\\"), from = slash == std::string::npos ? 0 : slash + 1;
    const std::string stem = shape.meshFile.substr(from, shape.meshFile.find_last_of('.') - from);
    return stem.empty() ? "mesh" : stem;
}

} // namespace

const char* kindName(Kind kind) {
    switch (kind) {
    case Kind::world:
        return "world";
    case Kind::camera:
        return "camera";
    case Kind::material:
        return "material";
    case Kind::body:
        return "body";
    case Kind::collider:
        return "collider";
    case Kind::source:
        return "heat source";
    case Kind::path:
        return "path";
    case Kind::shape:
        return "shape";
    case Kind::prop:
        return "prop";
    case Kind::none:
        break;
    }
    return "";
}

int countOf(const Scene& s, Kind kind) {
    switch (kind) {
    case Kind::none:
        return 0;
    case Kind::world:
    case Kind::camera:
        return 1;
    case Kind::material:
        return int(s.materials.size());
    case Kind::body:
        return int(s.bodies.size());
    case Kind::collider:
        return int(s.colliders.size());
    case Kind::source:
        return int(s.heatSources.size());
    case Kind::path:
        return int(s.paths.size());
    case Kind::shape:
        return int(s.shapes.size());
    case Kind::prop:
        return int(s.props.size());
    }
    return 0;
}

bool exists(const Scene& s, Item item) { return item.index >= 0 && item.index < countOf(s, item.kind); }

namespace {
template <class S> auto nameIn(S& s, Item item) -> decltype(&s.name) {
    const size_t i = size_t(item.index);
    switch (item.kind) {
    case Kind::material:
        return &s.materials[i].name;
    case Kind::body:
        return &s.bodies[i].name;
    case Kind::collider:
        return &s.colliders[i].name;
    case Kind::source:
        return &s.heatSources[i].name;
    case Kind::path:
        return &s.paths[i].name;
    case Kind::shape:
        return &s.shapes[i].name;
    case Kind::prop:
        return &s.props[i].name;
    default:
        return nullptr;
    }
}
} // namespace

std::string* nameOf(Scene& s, Item item) { return nameIn(s, item); }

std::string titleOf(const Scene& s, Item item) {
    const std::string* name = nameIn(s, item);
    if (!name) return kindName(item.kind);
    return name->empty() ? kindName(item.kind) + (" " + std::to_string(item.index)) : *name;
}

std::string freeName(const Scene& s, Kind kind, const std::string& wanted) {
    std::set<std::string> taken;
    for (int i = 0; i < countOf(s, kind); ++i) taken.insert(titleOf(s, {kind, i}));
    // "box 2" again gives "box 3".
    std::string stem = wanted;
    if (const size_t space = stem.find_last_of(' ');
        space != std::string::npos && space + 1 < stem.size() &&
        stem.find_first_not_of("0123456789", space + 1) == std::string::npos)
        stem.resize(space);
    std::string name = wanted;
    for (int n = 2; taken.count(name); ++n) name = stem + " " + std::to_string(n);
    return name;
}

bool hasPlace(Kind kind) {
    return kind == Kind::body || kind == Kind::collider || kind == Kind::prop || kind == Kind::source ||
           kind == Kind::path || kind == Kind::shape;
}

thawVec3 toWorld(const Scene& s, int collider, thawVec3 p) {
    if (collider < 0) return p;
    const scene::Placement& at = s.colliders[size_t(collider)].placement;
    return plus(scene::rotate(at.rotation, p), at.position);
}

thawVec3 fromWorld(const Scene& s, int collider, thawVec3 p) {
    if (collider < 0) return p;
    const scene::Placement& at = s.colliders[size_t(collider)].placement;
    return scene::rotate(inverse(at.rotation), minus(p, at.position));
}

thawVec3 pivotOf(const Scene& s, Item item) {
    if (const scene::Placement* p = placementIn(s, item)) {
        if (item.kind != Kind::shape) return p->position;
        return toWorld(s, s.shapes[size_t(item.index)].collider, p->position);
    }
    if (item.kind == Kind::source) return s.heatSources[size_t(item.index)].position;
    if (item.kind == Kind::camera) return s.camera.target;
    double sum[3] = {0, 0, 0};
    int count = 0;
    forPoints(s, item, [&](const thawVec3& p, int collider) {
        const thawVec3 x = toWorld(s, collider, p);
        sum[0] += double(x.x), sum[1] += double(x.y), sum[2] += double(x.z), ++count;
    });
    if (!count) return {};
    return {float(sum[0] / count), float(sum[1] / count), float(sum[2] / count)};
}

thawQuat rotationOf(const Scene& s, Item item) {
    if (const scene::Placement* p = placementIn(s, item)) return p->rotation;
    if (item.kind == Kind::source) return s.heatSources[size_t(item.index)].rotation;
    return {0, 0, 0, 1};
}

void move(Scene& s, Item item, thawVec3 by) {
    if (scene::Placement* at = placementIn(s, item)) {
        const int collider = item.kind == Kind::shape ? s.shapes[size_t(item.index)].collider : -1;
        at->position = fromWorld(s, collider, plus(toWorld(s, collider, at->position), by));
    } else if (item.kind == Kind::source) {
        thawVec3& position = s.heatSources[size_t(item.index)].position;
        position = plus(position, by);
    } else {
        forPoints(s, item,
                  [&](thawVec3& p, int collider) { p = fromWorld(s, collider, plus(toWorld(s, collider, p), by)); });
    }
}

void turn(Scene& s, Item item, thawVec3 pivot, thawQuat by) {
    const auto about = [&](thawVec3 p) { return plus(pivot, scene::rotate(by, minus(p, pivot))); };
    if (scene::Placement* at = placementIn(s, item)) {
        const int collider = item.kind == Kind::shape ? s.shapes[size_t(item.index)].collider : -1;
        at->position = fromWorld(s, collider, about(toWorld(s, collider, at->position)));
        const thawQuat base = collider < 0 ? thawQuat{0, 0, 0, 1} : s.colliders[size_t(collider)].placement.rotation;
        at->rotation = product(inverse(base), product(by, product(base, at->rotation)));
    } else if (item.kind == Kind::source) {
        scene::HeatSource& h = s.heatSources[size_t(item.index)];
        h.position = about(h.position), h.rotation = product(by, h.rotation);
    } else {
        if (item.kind == Kind::shape) {
            scene::FillShape& f = s.shapes[size_t(item.index)];
            const thawQuat base =
                f.collider < 0 ? thawQuat{0, 0, 0, 1} : s.colliders[size_t(f.collider)].placement.rotation;
            f.def.normal = scene::rotate(product(inverse(base), product(by, base)), f.def.normal);
        }
        forPoints(s, item,
                  [&](thawVec3& p, int collider) { p = fromWorld(s, collider, about(toWorld(s, collider, p))); });
    }
}

void resize(Scene& s, Item item, thawVec3 pivot, float factor) {
    const auto about = [&](thawVec3 p) { return plus(pivot, times(minus(p, pivot), factor)); };
    if (scene::Placement* at = placementIn(s, item)) {
        const int collider = item.kind == Kind::shape ? s.shapes[size_t(item.index)].collider : -1;
        at->position = fromWorld(s, collider, about(toWorld(s, collider, at->position)));
        at->scale = std::clamp(at->scale * factor, 1e-6f, 1e6f);
    } else if (item.kind == Kind::source) {
        scene::HeatSource& h = s.heatSources[size_t(item.index)];
        h.position = about(h.position);
        h.radius = std::clamp(h.radius * factor, 1e-4f, 10.0f);
        h.size = {std::clamp(h.size.x * factor, 2e-4f, 2e4f), h.size.y, std::clamp(h.size.z * factor, 2e-4f, 2e4f)};
    } else {
        forPoints(s, item,
                  [&](thawVec3& p, int collider) { p = fromWorld(s, collider, about(toWorld(s, collider, p))); });
    }
}

void erase(Scene& s, Item item) {
    const int i = item.index;
    const auto shifted = [&](int& of, int instead) {
        if (of == i)
            of = instead;
        else if (of > i)
            --of;
    };
    switch (item.kind) {
    case Kind::material: {
        if (!s.bodies.empty() && s.materials.size() == 1)
            throw scene::InputError("the last material cannot be deleted while there are bodies");
        s.materials.erase(s.materials.begin() + i);
        for (scene::Body& b : s.bodies) {
            shifted(b.material, 0);
            for (scene::Part& p : b.parts) shifted(p.material, 0);
        }
        break;
    }
    case Kind::collider:
        // What lay on it stays where it is.
        for (scene::Path& p : s.paths)
            if (p.collider == i)
                for (thawVec3& x : p.points) x = toWorld(s, i, x);
        for (scene::FillShape& f : s.shapes)
            if (f.collider == i) {
                for (auto& contour : f.contours)
                    for (thawVec3& x : contour) x = toWorld(s, i, x);
                f.placement.position = toWorld(s, i, f.placement.position);
                f.placement.rotation = product(s.colliders[size_t(i)].placement.rotation, f.placement.rotation);
                f.def.normal = scene::rotate(s.colliders[size_t(i)].placement.rotation, f.def.normal);
            }
        s.colliders.erase(s.colliders.begin() + i);
        for (scene::Path& p : s.paths) shifted(p.collider, -1);
        for (scene::FillShape& f : s.shapes) shifted(f.collider, -1);
        break;
    case Kind::body:
        s.bodies.erase(s.bodies.begin() + i);
        break;
    case Kind::source:
        s.heatSources.erase(s.heatSources.begin() + i);
        break;
    case Kind::path:
        s.paths.erase(s.paths.begin() + i);
        break;
    case Kind::shape:
        s.shapes.erase(s.shapes.begin() + i);
        break;
    case Kind::prop:
        s.props.erase(s.props.begin() + i);
        break;
    default:
        break;
    }
}

Item duplicate(Scene& s, Item item) {
    const size_t i = size_t(item.index);
    const std::string name = freeName(s, item.kind, titleOf(s, item));
    const auto copied = [&](auto& list) {
        list.push_back(list[i]);
        list.back().name = name;
        return last(item.kind, list);
    };
    Item made;
    switch (item.kind) {
    case Kind::material:
        return copied(s.materials);
    case Kind::body:
        made = copied(s.bodies);
        break;
    case Kind::collider:
        made = copied(s.colliders);
        break;
    case Kind::source:
        made = copied(s.heatSources);
        break;
    case Kind::path:
        made = copied(s.paths);
        break;
    case Kind::shape:
        made = copied(s.shapes);
        break;
    case Kind::prop:
        made = copied(s.props);
        break;
    default:
        return {};
    }
    move(s, made, {12 * s.world.particleSpacing, 0, 0});
    return made;
}

Item addMaterial(Scene& s, thawMaterialPreset preset) {
    scene::Material m;
    m.preset = preset;
    m.name = freeName(s, Kind::material, thawMaterialPresetName(preset));
    thawInitMaterialDef(&m.def, preset);
    s.materials.push_back(m);
    return last(Kind::material, s.materials);
}

int someMaterial(Scene& s) {
    if (s.materials.empty()) addMaterial(s, thawMaterial_wax);
    return 0;
}

Item addBody(Scene& s, const scene::Shape& shape, thawVec3 position) {
    scene::Body b;
    b.name = freeName(s, Kind::body, shapeWord(shape));
    b.shape = shape, b.placement.position = position;
    b.material = someMaterial(s);
    s.bodies.push_back(std::move(b));
    return last(Kind::body, s.bodies);
}

Item addCollider(Scene& s, const scene::Shape& shape, thawVec3 position) {
    scene::Collider c;
    c.name = freeName(s, Kind::collider, shapeWord(shape));
    c.shape = shape, c.placement.position = position;
    s.colliders.push_back(std::move(c));
    return last(Kind::collider, s.colliders);
}

Item addProp(Scene& s, const scene::Shape& shape, thawVec3 position) {
    scene::Prop p;
    p.name = freeName(s, Kind::prop, shapeWord(shape));
    p.shape = shape, p.placement.position = position;
    s.props.push_back(std::move(p));
    return last(Kind::prop, s.props);
}

Item addSource(Scene& s, thawHeatSourceType type, thawVec3 position) {
    scene::HeatSource h;
    const char* words[] = {"source", "lamp", "heater", "hot disc", "sun"};
    h.name = freeName(s, Kind::source, words[int(type)]);
    h.type = type, h.position = position;
    // So that a candle in the scene's own time melts within seconds.
    h.power = 30;
    h.radius = 3 * s.world.particleSpacing;
    if (type == thawHeatSource_directional) {
        h.visual = scene::SourceVisual::none;
        h.rotation = {1, 0, 0, 0}; // from above
    }
    if (type == thawHeatSource_rectangle || type == thawHeatSource_disc) h.rotation = {1, 0, 0, 0};
    if (type != thawHeatSource_point && type != thawHeatSource_directional) h.radius = 10 * s.world.particleSpacing;
    s.heatSources.push_back(std::move(h));
    return last(Kind::source, s.heatSources);
}

Item addPath(Scene& s, const std::vector<thawVec3>& points, int collider) {
    scene::Path p;
    thawInitPathDef(&p.def);
    p.name = freeName(s, Kind::path, "path");
    p.collider = collider;
    for (const thawVec3& x : points) p.points.push_back(fromWorld(s, collider, x));
    p.def.radius = std::clamp(4 * s.world.particleSpacing, 1e-4f, 10.0f);
    s.paths.push_back(std::move(p));
    return last(Kind::path, s.paths);
}

Item addShape(Scene& s, const std::vector<thawVec3>& contour, int collider) {
    scene::FillShape f;
    thawInitShapeDef(&f.def);
    f.name = freeName(s, Kind::shape, "shape");
    f.collider = collider;
    std::vector<thawVec3>& points = f.contours.emplace_back();
    for (const thawVec3& x : contour) points.push_back(fromWorld(s, collider, x));
    s.shapes.push_back(std::move(f));
    return last(Kind::shape, s.shapes);
}

float footOf(const scene::Shape& shape) {
    switch (shape.type) {
    case scene::ShapeType::box:
        return shape.size.y / 2;
    case scene::ShapeType::sphere:
        return shape.radius;
    case scene::ShapeType::cylinder:
    case scene::ShapeType::cone:
        return shape.height / 2;
    case scene::ShapeType::torus:
        return shape.tubeRadius;
    default:
        return 0;
    }
}

} // namespace thaw::editor
