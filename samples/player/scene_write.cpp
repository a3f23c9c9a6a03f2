// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "scene.h"
#include "view/part_file.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>

namespace thaw::scene {

namespace {
std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (char c : text) {
        const unsigned char u = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (u < 32) {
            char escape[8];
            std::snprintf(escape, sizeof escape, "\\u%04x", u);
            out += escape;
        } else {
            out += c;
        }
    }
    return out + "\"";
}

std::string array(std::initializer_list<float> values) {
    std::string out = "[";
    for (float v : values) out += (out.size() > 1 ? ", " : "") + shortest(v);
    return out + "]";
}

std::string vector(const thawVec3& v) { return array({v.x, v.y, v.z}); }

std::string boolean(bool value) { return value ? "true" : "false"; }

bool same(const thawVec3& a, const thawVec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

// Collects "key": value pairs and lays them out, one a line.
class ObjectText {
public:
    explicit ObjectText(int indent) : indent_(size_t(indent)) {}
    void add(const std::string& key, const std::string& value) {
        text_ += (text_.empty() ? "\n" : ",\n") + std::string(indent_ + 2, ' ') + quoted(key) + ": " + value;
    }
    std::string end() const { return text_.empty() ? "{}" : "{" + text_ + "\n" + std::string(indent_, ' ') + "}"; }

private:
    size_t indent_;
    std::string text_;
};

template <class Item, class Function> std::string list(const std::vector<Item>& items, int indent, Function&& each) {
    if (items.empty()) return "[]";
    std::string out = "[";
    for (const Item& item : items)
        out += (out.size() > 1 ? ",\n" : "\n") + std::string(size_t(indent) + 2, ' ') + each(item, indent + 2);
    return out + "\n" + std::string(size_t(indent), ' ') + "]";
}

void addShape(ObjectText& o, const Shape& shape) {
    std::string text = "{\"type\": " + quoted(shapeName(shape.type));
    switch (shape.type) {
    case ShapeType::mesh:
        o.add("mesh", quoted(shape.meshFile));
        return;
    case ShapeType::plane:
        break;
    case ShapeType::box:
        text += ", \"size\": " + vector(shape.size);
        break;
    case ShapeType::sphere:
        text += ", \"radius\": " + shortest(shape.radius);
        break;
    case ShapeType::cylinder:
    case ShapeType::cone:
        text += ", \"radius\": " + shortest(shape.radius) + ", \"height\": " + shortest(shape.height);
        break;
    case ShapeType::torus:
        text += ", \"radius\": " + shortest(shape.radius) + ", \"tubeRadius\": " + shortest(shape.tubeRadius);
        break;
    }
    o.add("shape", text + "}");
}

void addPlacement(ObjectText& o, const Placement& p) {
    const thawQuat& q = p.rotation;
    if (!same(p.position, {})) o.add("position", vector(p.position));
    if (q.x != 0.0f || q.y != 0.0f || q.z != 0.0f || q.w != 1.0f) o.add("rotation", array({q.x, q.y, q.z, q.w}));
    if (p.scale != 1.0f) o.add("scale", shortest(p.scale));
}

std::string materialText(const Material& material, int indent) {
    ObjectText o(indent);
    o.add("name", quoted(material.name));
    o.add("preset", quoted(thawMaterialPresetName(material.preset)));
    thawMaterialDef base;
    thawInitMaterialDef(&base, material.preset);
    const thawMaterialDef& d = material.def;
    // Only what differs from the preset: a later library may know better numbers for the rest.
    auto real = [&](const char* key, float value, float preset) {
        if (value != preset) o.add(key, shortest(value));
    };
    real("density", d.density, base.density);
    real("solidus", d.solidus, base.solidus);
    real("liquidus", d.liquidus, base.liquidus);
    real("latentHeat", d.latentHeat, base.latentHeat);
    real("specificHeatSolid", d.specificHeatSolid, base.specificHeatSolid);
    real("specificHeatLiquid", d.specificHeatLiquid, base.specificHeatLiquid);
    real("conductivitySolid", d.conductivitySolid, base.conductivitySolid);
    real("conductivityLiquid", d.conductivityLiquid, base.conductivityLiquid);
    real("viscositySolid", d.viscositySolid, base.viscositySolid);
    real("viscosityLiquid", d.viscosityLiquid, base.viscosityLiquid);
    real("yieldStress", d.yieldStress, base.yieldStress);
    if (d.flow != base.flow) o.add("flow", quoted(d.flow == thawFlow_casson ? "casson" : "bingham"));
    real("absorptivity", d.absorptivity, base.absorptivity);
    real("emissivity", d.emissivity, base.emissivity);
    real("cohesion", d.cohesion, base.cohesion);
    real("adhesion", d.adhesion, base.adhesion);
    real("setFraction", d.setFraction, base.setFraction);
    real("releaseFraction", d.releaseFraction, base.releaseFraction);
    real("youngModulus", d.youngModulus, base.youngModulus);
    real("solidYieldStress", d.solidYieldStress, base.solidYieldStress);
    real("relaxationTime", d.relaxationTime, base.relaxationTime);
    real("breakStrain", d.breakStrain, base.breakStrain);
    real("burnTemperature", d.burnTemperature, base.burnTemperature);
    real("vapourHeat", d.vapourHeat, base.vapourHeat);
    real("burnRate", d.burnRate, base.burnRate);
    real("undercooling", d.undercooling, base.undercooling);
    if (!same(d.color, base.color)) o.add("color", vector(d.color));
    return o.end();
}
} // namespace

const char* shapeName(ShapeType type) {
    switch (type) {
    case ShapeType::plane:
        return "plane";
    case ShapeType::box:
        return "box";
    case ShapeType::sphere:
        return "sphere";
    case ShapeType::cylinder:
        return "cylinder";
    case ShapeType::cone:
        return "cone";
    case ShapeType::torus:
        return "torus";
    case ShapeType::mesh:
        return "mesh";
    }
    return "";
}

std::string oneLine(const std::string& text, size_t limit) {
    std::string out = text;
    for (char& c : out)
        if (static_cast<unsigned char>(c) < 32 || c == 127) c = ' ';
    if (out.size() > limit) out = out.substr(0, limit - 3) + "...";
    return out;
}

std::string shortest(float value) {
    char text[32];
    const auto result = std::to_chars(text, text + sizeof text, value);
    return std::string(text, result.ptr);
}

std::string writeScene(const Scene& scene) {
    ObjectText root(0);
    root.add("thawScene", std::to_string(kSceneVersion));
    root.add("name", quoted(scene.name));

    ObjectText world(2);
    const WorldSettings& w = scene.world;
    world.add("particleSpacing", shortest(w.particleSpacing));
    if (w.maxParticles != 0) world.add("maxParticles", std::to_string(w.maxParticles));
    world.add("gravity", vector(w.gravity));
    world.add("ambientTemperature", shortest(w.ambientTemperature));
    world.add("convection", shortest(w.convection));
    world.add("thermalTimeScale", shortest(w.thermalTimeScale));
    root.add("world", world.end());

    root.add("materials", list(scene.materials, 2, materialText));
    root.add("bodies", list(scene.bodies, 2, [&](const Body& body, int indent) {
                 ObjectText o(indent);
                 o.add("name", quoted(body.name));
                 addShape(o, body.shape);
                 addPlacement(o, body.placement);
                 o.add("material", quoted(scene.materials[size_t(body.material)].name));
                 if (!std::isnan(body.temperature)) o.add("temperature", shortest(body.temperature));
                 if (!body.parts.empty())
                     o.add("parts", list(body.parts, indent + 2, [&](const Part& part, int deeper) {
                               ObjectText p(deeper);
                               p.add("material", quoted(scene.materials[size_t(part.material)].name));
                               if (part.depth > 0)
                                   p.add("depth", shortest(part.depth));
                               else
                                   addShape(p, part.shape), addPlacement(p, part.placement);
                               return p.end();
                           }));
                 if (!body.anchored) o.add("anchored", boolean(body.anchored));
                 if (!body.paint.empty())
                     o.add("paint", list(body.paint, indent + 2, [&](const Paint& paint, int deeper) {
                               ObjectText p(deeper);
                               p.add("position", vector(paint.brush.center));
                               p.add("radius", shortest(paint.brush.radius));
                               if (paint.brush.falloff != 0) p.add("falloff", shortest(paint.brush.falloff));
                               if (!std::isnan(paint.temperature)) p.add("temperature", shortest(paint.temperature));
                               if (!std::isnan(paint.absorptivity)) p.add("absorptivity", shortest(paint.absorptivity));
                               return p.end();
                           }));
                 if (body.coarsestLevel > 0) o.add("coarsestLevel", std::to_string(body.coarsestLevel));
                 return o.end();
             }));
    root.add("colliders", list(scene.colliders, 2, [](const Collider& collider, int indent) {
                 ObjectText o(indent);
                 o.add("name", quoted(collider.name));
                 addShape(o, collider.shape);
                 addPlacement(o, collider.placement);
                 o.add("adhesive", boolean(collider.adhesive));
                 o.add("occluder", boolean(collider.occluder));
                 o.add("slipLength", shortest(collider.slipLength));
                 o.add("friction", shortest(collider.friction));
                 if (!std::isnan(collider.temperature)) o.add("temperature", shortest(collider.temperature));
                 if (std::isfinite(collider.contactConductance))
                     o.add("contactConductance", shortest(collider.contactConductance));
                 o.add("visible", boolean(collider.visible));
                 o.add("color", vector(collider.color));
                 return o.end();
             }));
    root.add("heatSources", list(scene.heatSources, 2, [](const HeatSource& source, int indent) {
                 constexpr const char* kVisuals[] = {"none", "flame", "glow"};
                 ObjectText o(indent);
                 o.add("name", quoted(source.name));
                 o.add("position", vector(source.position));
                 constexpr const char* kTypes[] = {"point", "sphere", "rectangle", "disc", "directional"};
                 if (source.type != thawHeatSource_point) o.add("type", quoted(kTypes[size_t(source.type)]));
                 const thawQuat& q = source.rotation;
                 if (q.x != 0.0f || q.y != 0.0f || q.z != 0.0f || q.w != 1.0f)
                     o.add("rotation", array({q.x, q.y, q.z, q.w}));
                 const HeatSource plain;
                 if (source.size.x != plain.size.x || source.size.z != plain.size.z)
                     o.add("size", array({source.size.x, source.size.z}));
                 if (source.temperature != plain.temperature) o.add("temperature", shortest(source.temperature));
                 if (source.emissivity != plain.emissivity) o.add("emissivity", shortest(source.emissivity));
                 if (source.irradiance != plain.irradiance) o.add("irradiance", shortest(source.irradiance));
                 o.add("power", shortest(source.power));
                 o.add("radius", shortest(source.radius));
                 o.add("enabled", boolean(source.enabled));
                 o.add("visual", quoted(kVisuals[size_t(source.visual)]));
                 return o.end();
             }));
    if (!scene.paths.empty())
        root.add("paths", list(scene.paths, 2, [&](const Path& path, int indent) {
                     thawPathDef plain;
                     thawInitPathDef(&plain);
                     const thawPathDef& d = path.def;
                     ObjectText o(indent);
                     o.add("name", quoted(path.name));
                     std::string points;
                     for (const thawVec3& x : path.points) points += (points.empty() ? "" : ", ") + vector(x);
                     o.add("points", "[" + points + "]");
                     if (path.collider >= 0) o.add("collider", quoted(scene.colliders[size_t(path.collider)].name));
                     if (d.smooth != plain.smooth) o.add("smooth", boolean(d.smooth));
                     if (d.enabled != plain.enabled) o.add("enabled", boolean(d.enabled));
                     o.add("radius", shortest(d.radius));
                     if (d.reach != 0.0f) o.add("reach", shortest(d.reach));
                     o.add("strength", shortest(d.strength));
                     o.add("speed", shortest(d.speed));
                     if (d.arrivalTime != 0.0f) o.add("arrivalTime", shortest(d.arrivalTime));
                     if (d.share != plain.share) o.add("share", shortest(d.share));
                     if (d.priority != 0) o.add("priority", std::to_string(d.priority));
                     if (d.beadSpacing != 0.0f) o.add("beadSpacing", shortest(d.beadSpacing));
                     if (!std::isnan(d.startAbsorptivity)) o.add("startAbsorptivity", shortest(d.startAbsorptivity));
                     return o.end();
                 }));
    if (!scene.shapes.empty())
        root.add("shapes", list(scene.shapes, 2, [&](const FillShape& shape, int indent) {
                     thawShapeDef plain;
                     thawInitShapeDef(&plain);
                     const thawShapeDef& d = shape.def;
                     ObjectText o(indent);
                     o.add("name", quoted(shape.name));
                     if (shape.contours.empty()) {
                         addShape(o, shape.shape);
                         addPlacement(o, shape.placement);
                     } else {
                         std::string contours;
                         for (const std::vector<thawVec3>& contour : shape.contours) {
                             std::string points;
                             for (const thawVec3& x : contour) points += (points.empty() ? "" : ", ") + vector(x);
                             contours += (contours.empty() ? "[" : ", [") + points + "]";
                         }
                         o.add("contours", "[" + contours + "]");
                         if (d.normal.x != 0 || d.normal.y != 0 || d.normal.z != 0) o.add("normal", vector(d.normal));
                         if (d.depth != 0.0f) o.add("depth", shortest(d.depth));
                         if (d.thickness != 0.0f) o.add("thickness", shortest(d.thickness));
                     }
                     if (shape.collider >= 0) o.add("collider", quoted(scene.colliders[size_t(shape.collider)].name));
                     if (d.enabled != plain.enabled) o.add("enabled", boolean(d.enabled));
                     if (d.reach != 0.0f) o.add("reach", shortest(d.reach));
                     o.add("strength", shortest(d.strength));
                     o.add("speed", shortest(d.speed));
                     if (d.sets != plain.sets) o.add("sets", boolean(d.sets));
                     o.add("setFill", shortest(d.setFill));
                     o.add("setTime", shortest(d.setTime));
                     if (d.priority != 0) o.add("priority", std::to_string(d.priority));
                     return o.end();
                 }));
    root.add("props", list(scene.props, 2, [](const Prop& prop, int indent) {
                 ObjectText o(indent);
                 o.add("name", quoted(prop.name));
                 addShape(o, prop.shape);
                 addPlacement(o, prop.placement);
                 o.add("color", vector(prop.color));
                 return o.end();
             }));

    ObjectText camera(2);
    camera.add("eye", vector(scene.camera.eye));
    camera.add("target", vector(scene.camera.target));
    camera.add("fieldOfViewDegrees", shortest(scene.camera.fieldOfViewDegrees));
    if (!scene.camera.keys.empty())
        camera.add("keys", list(scene.camera.keys, 4, [](const CameraKey& key, int) {
                       return "{\"time\": " + shortest(key.time) + ", \"eye\": " + vector(key.eye) +
                              ", \"target\": " + vector(key.target) +
                              ", \"fieldOfViewDegrees\": " + shortest(key.fieldOfViewDegrees) + "}";
                   }));
    root.add("camera", camera.end());

    ObjectText look(2);
    look.add("sunDirection", vector(scene.look.sunDirection));
    look.add("exposure", shortest(scene.look.exposure));
    root.add("look", look.end());

    ObjectText defaults(2);
    defaults.add("seconds", shortest(scene.defaults.seconds));
    defaults.add("budgetMilliseconds", shortest(scene.defaults.budgetMilliseconds));
    std::string captures = "[";
    for (float t : scene.defaults.captures) captures += (captures.size() > 1 ? ", " : "") + shortest(t);
    defaults.add("captures", captures + "]");
    root.add("defaults", defaults.end());
    return root.end() + "\n";
}

void saveText(const std::string& text, const std::string& path) {
    std::error_code none;
    const std::filesystem::path place(path);
    view::PartFile file(std::filesystem::is_symlink(place, none) ? std::filesystem::canonical(place, none).string()
                                                                 : path);
    const auto refuse = [&](const std::string& why) { throw std::runtime_error(oneLine(path, 400) + ": " + why); };
    errno = 0;
    std::ofstream out(file.part(), std::ios::binary);
    if (!out) refuse(std::string("cannot be written: ") + std::strerror(errno));
    out << text;
    out.close();
    if (!out) refuse(std::string("cannot be written: ") + (errno ? std::strerror(errno) : "the disk may be full"));
    std::string error;
    if (!file.moveToPlace(error)) refuse(error);
}

void saveScene(const Scene& scene, const std::string& path) { saveText(writeScene(scene), path); }

} // namespace thaw::scene
