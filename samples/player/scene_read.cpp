// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "scene.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

namespace thaw::scene {

namespace {
using nlohmann::json;

constexpr size_t kMaxSceneBytes = size_t(16) << 20;
constexpr size_t kMaxDepth = 32;
constexpr double kFar = 1e4; // m, no coordinate lies beyond

bool meet(const thawVec3& a, const thawVec3& b) {
    return std::hypot(double(a.x) - b.x, double(a.y) - b.y, double(a.z) - b.z) < 1e-4;
}

std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.10g", value);
    return text;
}

// A JSON value for a message.
std::string brief(const json& value) {
    if (value.is_object()) return "an object";
    if (value.is_array()) return "an array of " + std::to_string(value.size());
    return oneLine(value.dump(-1, ' ', true, json::error_handler_t::replace), 60);
}

std::string pointerToken(const std::string& key) {
    std::string out;
    for (char c : key) {
        if (c == '~')
            out += "~0";
        else if (c == '/')
            out += "~1";
        else
            out += c;
    }
    return oneLine(out, 60);
}

[[noreturn]] void fail(const std::string& file, const std::string& place, const std::string& what) {
    throw InputError(oneLine(file, 400) + ": at " + (place.empty() ? "/" : place) + ": " + what);
}

// Builds the tree, and refuses what json::parse lets through: keys given twice, and nesting deep enough to hurt.
class TreeBuilder : public nlohmann::json_sax<json> {
public:
    TreeBuilder(const std::string& text, const std::string& file) : text_(text), file_(file) {}

    bool null() override { return put(json(nullptr)); }
    bool boolean(bool value) override { return put(json(value)); }
    bool number_integer(number_integer_t value) override { return put(json(value)); }
    bool number_unsigned(number_unsigned_t value) override { return put(json(value)); }
    bool number_float(number_float_t value, const string_t&) override { return put(json(value)); }
    bool string(string_t& value) override { return put(json(value)); }
    bool binary(binary_t&) override { return false; }
    bool start_object(std::size_t) override { return open(json::object()); }
    bool start_array(std::size_t) override { return open(json::array()); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool key(string_t& name) override {
        json& object = *stack_.back();
        if (object.contains(name)) fail(file_, place(name), "key given twice");
        key_ = name;
        return true;
    }
    bool parse_error(std::size_t position, const std::string& token, const nlohmann::detail::exception& e) override {
        size_t line = 1, column = 0;
        const size_t end = std::min(position, text_.size());
        for (size_t i = 0; i < end; ++i) {
            ++column;
            if (text_[i] == '\n' && i + 1 < end) ++line, column = 0;
        }
        const bool overflow = std::strstr(e.what(), "number overflow") != nullptr;
        std::string what = overflow ? "number too large" : "not valid JSON";
        if (position > text_.size())
            what += ", the file ends too early";
        else if (!token.empty())
            what += " near '" + tail(token) + "'";
        throw InputError(oneLine(file_, 400) + ":" + std::to_string(line) + ":" +
                         std::to_string(std::max<size_t>(column, 1)) + ": " + what);
    }

    json root;

private:
    static std::string tail(const std::string& token) {
        std::string out;
        for (unsigned char c : token) out += c < 32 || c >= 127 ? '?' : char(c);
        return out.size() > 40 ? "..." + out.substr(out.size() - 37) : out;
    }
    std::string place(const std::string& last) const {
        std::string out;
        for (size_t i = 0; i + 1 < stack_.size(); ++i) {
            const json& parent = *stack_[i];
            out += "/" + (parent.is_array() ? std::to_string(parent.size() - 1) : pointerToken(keys_[i + 1]));
        }
        return out + "/" + pointerToken(last);
    }
    json* insert(json&& value) {
        if (stack_.empty()) {
            root = std::move(value);
            return &root;
        }
        json& parent = *stack_.back();
        if (parent.is_array()) {
            parent.push_back(std::move(value));
            return &parent.back();
        }
        return &(parent[key_] = std::move(value));
    }
    bool put(json&& value) {
        insert(std::move(value));
        return true;
    }
    bool open(json&& value) {
        if (stack_.size() >= kMaxDepth) fail(file_, "", "nested more than " + std::to_string(kMaxDepth) + " deep");
        keys_.push_back(key_);
        stack_.push_back(insert(std::move(value)));
        return true;
    }
    bool close() {
        stack_.pop_back();
        keys_.pop_back();
        return true;
    }

    const std::string& text_;
    const std::string& file_;
    std::string key_;
    std::vector<json*> stack_;
    std::vector<std::string> keys_; // key under which stack_[i] hangs
};

size_t editDistance(const std::string& a, const std::string& b) {
    std::vector<size_t> row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (size_t i = 1; i <= a.size(); ++i) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t above = row[j];
            row[j] =
                std::min({row[j] + 1, row[j - 1] + 1, diagonal + (std::tolower(a[i - 1]) != std::tolower(b[j - 1]))});
            diagonal = above;
        }
    }
    return row[b.size()];
}

// Reads one object: every key must be asked for, or done() refuses it.
class Reader {
public:
    Reader(const json& value, std::string place, const std::string& file)
        : value_(value), place_(std::move(place)), file_(file) {
        if (!value.is_object()) bad(place_, "must be an object, got " + brief(value));
    }

    const std::string& file() const { return file_; }
    std::string at(const std::string& key) const { return place_ + "/" + key; }
    [[noreturn]] void bad(const std::string& place, const std::string& what) const { fail(file_, place, what); }

    const json* find(const char* key) {
        known_.push_back(key);
        const auto it = value_.find(key);
        return it == value_.end() ? nullptr : &*it;
    }
    const json& need(const char* key) {
        const json* value = find(key);
        if (!value) bad(place_, std::string("key '") + key + "' is missing");
        return *value;
    }

    double checked(const json& value, const std::string& place, double lower, double upper, const char* unit,
                   const char* hint = "") const {
        const std::string tailText = std::string(*unit ? " " : "") + unit;
        if (!value.is_number())
            bad(place, "must be a number" + (*unit ? " (" + std::string(unit) + ")" : "") + ", got " + brief(value));
        const double got = value.get<double>();
        if (!(got >= lower && got <= upper))
            bad(place,
                "must be in " + number(lower) + ".." + number(upper) + tailText + ", got " + brief(value) + hint);
        return got;
    }
    void real(const char* key, float& out, double lower, double upper, const char* unit = "", const char* hint = "") {
        if (const json* value = find(key)) out = float(checked(*value, at(key), lower, upper, unit, hint));
    }
    void kelvin(const char* key, float& out) { real(key, out, 100.0, 10000.0, "K", " (temperatures are in kelvin)"); }
    void integer(const char* key, int& out, int lower, int upper) {
        const json* value = find(key);
        if (!value) return;
        const double got = checked(*value, at(key), lower, upper, "");
        if (got != std::floor(got)) bad(at(key), "must be a whole number, got " + brief(*value));
        out = int(got);
    }
    void flag(const char* key, bool& out) {
        const json* value = find(key);
        if (!value) return;
        if (!value->is_boolean()) bad(at(key), "must be true or false, got " + brief(*value));
        out = value->get<bool>();
    }
    void text(const char* key, std::string& out) {
        const json* value = find(key);
        if (!value) return;
        if (!value->is_string()) bad(at(key), "must be a text, got " + brief(*value));
        out = value->get<std::string>();
        if (out.size() > 4096) bad(at(key), "is longer than 4096 characters");
        if (out.find('\0') != std::string::npos) bad(at(key), "holds a zero character");
    }
    bool numbers(const char* key, size_t count, double lower, double upper, const char* unit, double* out) {
        const json* value = find(key);
        if (!value) return false;
        if (!value->is_array() || value->size() != count)
            bad(at(key), "must be an array of " + std::to_string(count) + " numbers, got " + brief(*value));
        for (size_t i = 0; i < count; ++i)
            out[i] = checked((*value)[i], at(key) + "/" + std::to_string(i), lower, upper, unit);
        return true;
    }
    bool vector(const char* key, thawVec3& out, double lower, double upper, const char* unit = "") {
        double v[3];
        if (!numbers(key, 3, lower, upper, unit, v)) return false;
        out = {float(v[0]), float(v[1]), float(v[2])};
        return true;
    }
    template <class Enum>
    void choice(const char* key, Enum& out, std::initializer_list<std::pair<const char*, Enum>> choices) {
        const json* value = find(key);
        if (!value) return;
        std::string names;
        for (const auto& [name, e] : choices) {
            if (value->is_string() && value->get_ref<const std::string&>() == name) {
                out = e;
                return;
            }
            names += (names.empty() ? "" : ", ") + std::string(name);
        }
        bad(at(key), "must be one of " + names + ", got " + brief(*value));
    }
    template <class Function> void list(const char* key, size_t limit, Function&& each) {
        const json* value = find(key);
        if (!value) return;
        if (!value->is_array()) bad(at(key), "must be an array, got " + brief(*value));
        if (value->size() > limit)
            bad(at(key), "must hold at most " + std::to_string(limit) + ", got " + std::to_string(value->size()));
        for (size_t i = 0; i < value->size(); ++i) each((*value)[i], at(key) + "/" + std::to_string(i));
    }

    // Refuses keys that nothing asked for.
    void done() const {
        for (const auto& [key, value] : value_.items()) {
            if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
            std::string hint;
            size_t best = 4;
            for (const std::string& known : known_) {
                const bool starts = key.size() >= 4 && known.compare(0, key.size(), key) == 0;
                const size_t distance = starts ? 1 : key.size() > 60 ? 99 : editDistance(key, known);
                if (distance < best) best = distance, hint = " (did you mean '" + known + "'?)";
            }
            fail(file_, place_ + "/" + pointerToken(key), "unknown key" + hint);
        }
    }

private:
    const json& value_;
    std::string place_;
    const std::string& file_;
    std::vector<std::string> known_;
};

void readRotation(Reader& r, thawQuat& rotation) {
    double degrees[3];
    const bool turned = r.numbers("rotationDegrees", 3, -3600.0, 3600.0, "degrees", degrees);
    if (turned) rotation = quatFromDegrees(degrees[0], degrees[1], degrees[2]);
    double q[4];
    if (r.numbers("rotation", 4, -1.01, 1.01, "", q)) {
        if (turned) r.bad(r.at("rotation"), "give either rotation or rotationDegrees");
        const double length2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
        if (std::abs(length2 - 1.0) > 0.02)
            r.bad(r.at("rotation"), "must have length 1, has " + number(std::sqrt(length2)));
        // A float quaternion that is of unit length already stays as it is, so that what was saved reads back the same.
        const double factor = std::abs(length2 - 1.0) > 1e-6 ? 1.0 / std::sqrt(length2) : 1.0;
        rotation = {float(q[0] * factor), float(q[1] * factor), float(q[2] * factor), float(q[3] * factor)};
    }
}

void readPlacement(Reader& r, Placement& out) {
    r.vector("position", out.position, -kFar, kFar, "m");
    readRotation(r, out.rotation);
    r.real("scale", out.scale, 1e-6, 1e6);
}

thawVec3 readPoint(Reader& r, const json& value, const std::string& at) {
    if (!value.is_array() || value.size() != 3) r.bad(at, "must be three numbers (m), got " + brief(value));
    float x[3];
    for (size_t k = 0; k < 3; ++k) x[k] = float(r.checked(value[k], at + "/" + std::to_string(k), -kFar, kFar, "m"));
    return {x[0], x[1], x[2]};
}

// Index of the collider that is named, -1 when none is.
int readCollider(Reader& r, const Scene& scene) {
    std::string name;
    r.text("collider", name);
    if (name.empty()) return -1;
    for (size_t c = 0; c < scene.colliders.size(); ++c)
        if (scene.colliders[c].name == name) return int(c);
    r.bad(r.at("collider"), "names no entry of /colliders, got \"" + oneLine(name, 40) + "\"");
}

void readShape(Reader& r, Shape& out, bool planeAllowed) {
    const json* shape = r.find("shape");
    const json* mesh = r.find("mesh");
    if (!shape && !mesh) r.bad(r.at("shape"), "is missing: give 'shape' or 'mesh'");
    if (shape && mesh) r.bad(r.at("mesh"), "give either shape or mesh");
    if (mesh) {
        out.type = ShapeType::mesh;
        r.text("mesh", out.meshFile);
        if (out.meshFile.empty()) r.bad(r.at("mesh"), "is an empty file name");
        return;
    }
    Reader s(*shape, r.at("shape"), r.file());
    s.need("type");
    if (planeAllowed)
        s.choice("type", out.type,
                 {{"plane", ShapeType::plane},
                  {"box", ShapeType::box},
                  {"sphere", ShapeType::sphere},
                  {"cylinder", ShapeType::cylinder},
                  {"cone", ShapeType::cone},
                  {"torus", ShapeType::torus}});
    else
        s.choice("type", out.type,
                 {{"box", ShapeType::box},
                  {"sphere", ShapeType::sphere},
                  {"cylinder", ShapeType::cylinder},
                  {"cone", ShapeType::cone},
                  {"torus", ShapeType::torus}});
    constexpr double kLeast = 1e-5, kMost = 1e3;
    switch (out.type) {
    case ShapeType::box:
        s.need("size");
        s.vector("size", out.size, kLeast, kMost, "m");
        break;
    case ShapeType::torus:
        s.need("radius");
        s.real("radius", out.radius, kLeast, kMost, "m");
        s.need("tubeRadius");
        s.real("tubeRadius", out.tubeRadius, kLeast, out.radius, "m");
        break;
    case ShapeType::cylinder:
    case ShapeType::cone:
        s.need("height");
        s.real("height", out.height, kLeast, kMost, "m");
        [[fallthrough]];
    case ShapeType::sphere:
        s.need("radius");
        s.real("radius", out.radius, kLeast, kMost, "m");
        break;
    case ShapeType::plane:
    case ShapeType::mesh:
        break;
    }
    s.done();
}

thawMaterialPreset presetByName(const std::string& name) {
    for (int p = 0; p < thawMaterial_presetCount; ++p)
        if (name == thawMaterialPresetName(thawMaterialPreset(p))) return thawMaterialPreset(p);
    return thawMaterial_presetCount;
}

std::string presetNames() {
    std::string out;
    for (int p = 0; p < thawMaterial_presetCount; ++p)
        out += (p ? ", " : "") + std::string(thawMaterialPresetName(thawMaterialPreset(p)));
    return out;
}

Material readMaterial(const json& value, const std::string& place, const std::string& file,
                      const std::string& fallbackName) {
    Reader r(value, place, file);
    Material out;
    out.name = fallbackName;
    r.text("name", out.name);
    if (out.name.empty()) r.bad(r.at("name"), "is empty");
    std::string preset = "wax";
    r.text("preset", preset);
    out.preset = presetByName(preset);
    if (out.preset == thawMaterial_presetCount)
        r.bad(r.at("preset"), "must be one of " + presetNames() + ", got \"" + oneLine(preset, 40) + "\"");
    thawMaterialDef& d = out.def;
    thawInitMaterialDef(&d, out.preset);
    r.real("density", d.density, 1.0, 3e4, "kg/m^3");
    r.kelvin("solidus", d.solidus);
    r.kelvin("liquidus", d.liquidus);
    if (d.solidus > d.liquidus)
        r.bad(r.at("solidus"),
              "must not be above liquidus (" + shortest(d.liquidus) + " K), got " + shortest(d.solidus));
    r.real("latentHeat", d.latentHeat, 0.0, 1e7, "J/kg");
    r.real("specificHeatSolid", d.specificHeatSolid, 1.0, 1e5, "J/(kg K)");
    r.real("specificHeatLiquid", d.specificHeatLiquid, 1.0, 1e5, "J/(kg K)");
    r.real("conductivitySolid", d.conductivitySolid, 0.0, 1e4, "W/(m K)");
    r.real("conductivityLiquid", d.conductivityLiquid, 0.0, 1e4, "W/(m K)");
    r.real("viscositySolid", d.viscositySolid, 1e-3, 1e7, "Pa s");
    r.real("viscosityLiquid", d.viscosityLiquid, 1e-4, 1e6, "Pa s");
    r.real("yieldStress", d.yieldStress, 0.0, 1e6, "Pa");
    std::string flow = d.flow == thawFlow_casson ? "casson" : "bingham";
    r.text("flow", flow);
    if (flow != "bingham" && flow != "casson")
        r.bad(r.at("flow"), "must be one of bingham, casson, got \"" + oneLine(flow, 40) + "\"");
    d.flow = flow == "casson" ? thawFlow_casson : thawFlow_bingham;
    r.real("absorptivity", d.absorptivity, 0.0, 1.0);
    r.real("emissivity", d.emissivity, 0.0, 1.0);
    r.real("cohesion", d.cohesion, 0.0, 20.0);
    r.real("adhesion", d.adhesion, 0.0, 5.0);
    r.real("setFraction", d.setFraction, 0.0, 1.0);
    r.real("releaseFraction", d.releaseFraction, 0.0, 1.0);
    r.real("youngModulus", d.youngModulus, 0.0, 1e8);
    r.real("solidYieldStress", d.solidYieldStress, 0.0, 1e8);
    r.real("relaxationTime", d.relaxationTime, 0.0, 1e9);
    r.real("breakStrain", d.breakStrain, 0.0, 1.0);
    r.real("burnTemperature", d.burnTemperature, 0.0, 10000.0);
    r.real("vapourHeat", d.vapourHeat, 0.0, 1e8);
    r.real("burnRate", d.burnRate, 0.0, 1e6);
    r.real("undercooling", d.undercooling, 0.0, 1000.0);
    if (d.undercooling >= d.solidus)
        r.bad(r.at("undercooling"),
              "must be below solidus (" + shortest(d.solidus) + "), got " + shortest(d.undercooling));
    if (d.burnTemperature > 0 && d.burnTemperature < d.liquidus)
        r.bad(r.at("burnTemperature"),
              "must be 0 or not below liquidus (" + shortest(d.liquidus) + "), got " + shortest(d.burnTemperature));
    if (d.setFraction > d.releaseFraction)
        r.bad(r.at("setFraction"), "must not be above releaseFraction (" + shortest(d.releaseFraction) + "), got " +
                                       shortest(d.setFraction));
    r.vector("color", d.color, 0.0, 1.0);
    r.done();
    return out;
}

void readName(Reader& r, std::string& out, const char* kind, size_t index) {
    out = std::string(kind) + " " + std::to_string(index);
    r.text("name", out);
}

int readBodyMaterial(Reader& r, Scene& scene, const std::string& bodyName) {
    const json* value = r.find("material");
    if (value && value->is_object()) {
        scene.materials.push_back(readMaterial(*value, r.at("material"), r.file(), bodyName + " material"));
    } else {
        std::string name = "wax";
        r.text("material", name);
        for (size_t m = 0; m < scene.materials.size(); ++m)
            if (scene.materials[m].name == name) return int(m);
        Material material;
        material.name = name;
        material.preset = presetByName(name);
        if (material.preset == thawMaterial_presetCount)
            r.bad(r.at("material"), "names no entry of /materials and no preset (" + presetNames() + "), got \"" +
                                        oneLine(name, 40) + "\"");
        thawInitMaterialDef(&material.def, material.preset);
        scene.materials.push_back(material);
    }
    if (scene.materials.size() > 255) r.bad(r.at("material"), "is the 256th material, at most 255 are possible");
    return int(scene.materials.size()) - 1;
}

void checkNames(const std::string& file, const char* list, const std::vector<Material>& items) {
    std::set<std::string> names;
    for (size_t i = 0; i < items.size(); ++i)
        if (!names.insert(items[i].name).second)
            fail(file, std::string("/") + list + "/" + std::to_string(i) + "/name",
                 "is used twice: \"" + oneLine(items[i].name, 40) + "\"");
}
// Eye and look of a camera, or of one of its keys.
void readSight(Reader& r, thawVec3& eye, thawVec3& target, float& fieldOfView) {
    r.vector("eye", eye, -kFar, kFar, "m");
    r.vector("target", target, -kFar, kFar, "m");
    r.real("fieldOfViewDegrees", fieldOfView, 1.0, 150.0, "degrees");
    if (meet(eye, target)) r.bad(r.at("target"), "lies in the eye");
}

void readCamera(const json& value, const std::string& file, Camera& camera) {
    Reader r(value, "/camera", file);
    readSight(r, camera.eye, camera.target, camera.fieldOfViewDegrees);
    r.list("keys", 1000, [&](const json& item, const std::string& place) {
        Reader k(item, place, file);
        CameraKey key{0.0f, camera.eye, camera.target, camera.fieldOfViewDegrees};
        k.need("time");
        k.real("time", key.time, 0.0, 3600.0, "s");
        readSight(k, key.eye, key.target, key.fieldOfViewDegrees);
        if (!camera.keys.empty() && !(key.time > camera.keys.back().time))
            k.bad(k.at("time"), "must be later than the key before it, at " + shortest(camera.keys.back().time) +
                                    " s, got " + shortest(key.time));
        k.done();
        camera.keys.push_back(key);
        // On its way from the last key the eye must not pass through what it looks at.
        for (int step = 1; camera.keys.size() > 1 && step < 64; ++step) {
            const double from = double(camera.keys[camera.keys.size() - 2].time);
            const Camera now = cameraAt(camera, from + (double(key.time) - from) * step / 64);
            if (meet(now.eye, now.target)) k.bad(k.at("target"), "meets the eye on the way to this key");
        }
    });
    r.done();
}

} // namespace

Scene parseScene(const std::string& text, const std::string& file, const std::string& directory) {
    TreeBuilder tree(text, file);
    json::sax_parse(text, &tree);

    Scene scene;
    scene.file = file;
    scene.directory = directory;
    Reader root(tree.root, "", file);
    int version = 0;
    root.need("thawScene");
    root.integer("thawScene", version, 0, 1'000'000);
    if (version != kSceneVersion)
        root.bad("/thawScene", "is version " + std::to_string(version) + ", this program reads version " +
                                   std::to_string(kSceneVersion));
    root.text("name", scene.name);

    if (const json* value = root.find("world")) {
        Reader r(*value, "/world", file);
        WorldSettings& w = scene.world;
        r.real("particleSpacing", w.particleSpacing, 1e-4, 1.0, "m");
        r.integer("maxParticles", w.maxParticles, 8, kMaxParticles);
        r.vector("gravity", w.gravity, -1000.0, 1000.0, "m/s^2");
        r.kelvin("ambientTemperature", w.ambientTemperature);
        r.real("convection", w.convection, 0.0, 1e4, "W/(m^2 K)");
        r.real("thermalTimeScale", w.thermalTimeScale, 0.0, 1e5);
        r.done();
    }
    root.list("materials", 255, [&](const json& value, const std::string& place) {
        scene.materials.push_back(
            readMaterial(value, place, file, "material " + std::to_string(scene.materials.size())));
    });
    checkNames(file, "materials", scene.materials);
    root.list("bodies", 65535, [&](const json& value, const std::string& place) {
        Reader r(value, place, file);
        Body body;
        readName(r, body.name, "body", scene.bodies.size());
        readShape(r, body.shape, false);
        readPlacement(r, body.placement);
        r.kelvin("temperature", body.temperature);
        r.flag("anchored", body.anchored);
        r.integer("coarsestLevel", body.coarsestLevel, 0, 3);
        body.material = readBodyMaterial(r, scene, body.name);
        r.list("parts", 64, [&](const json& part, const std::string& where) {
            Reader q(part, where, file);
            Part out;
            if (q.find("depth"))
                q.real("depth", out.depth, 1e-6, 1e4, "m");
            else
                readShape(q, out.shape, false), readPlacement(q, out.placement);
            q.need("material");
            out.material = readBodyMaterial(q, scene, body.name + " part " + std::to_string(body.parts.size()));
            q.done();
            body.parts.push_back(std::move(out));
        });
        r.list("paint", 4096, [&](const json& paint, const std::string& where) {
            Reader q(paint, where, file);
            Paint out;
            q.need("position"), q.need("radius");
            q.vector("position", out.brush.center, -1e6, 1e6, "m");
            q.real("radius", out.brush.radius, 1e-6, 1e4, "m");
            q.real("falloff", out.brush.falloff, 0, 1);
            q.real("temperature", out.temperature, 0, 1e5, "K");
            q.real("absorptivity", out.absorptivity, 0, 1);
            q.done();
            body.paint.push_back(out);
        });
        r.done();
        scene.bodies.push_back(std::move(body));
    });
    root.list("colliders", 65535, [&](const json& value, const std::string& place) {
        Reader r(value, place, file);
        Collider collider;
        readName(r, collider.name, "collider", scene.colliders.size());
        readShape(r, collider.shape, true);
        readPlacement(r, collider.placement);
        r.flag("adhesive", collider.adhesive);
        r.flag("occluder", collider.occluder);
        r.real("slipLength", collider.slipLength, 0.0, 1e4, "m");
        r.real("friction", collider.friction, 0.0, 10.0);
        r.real("temperature", collider.temperature, 0.0, 1e5, "K");
        r.real("contactConductance", collider.contactConductance, 0.0, 1e30, "W/(m^2 K)");
        r.flag("visible", collider.visible);
        r.vector("color", collider.color, 0.0, 1.0);
        r.done();
        scene.colliders.push_back(std::move(collider));
    });
    root.list("heatSources", 1024, [&](const json& value, const std::string& place) {
        Reader r(value, place, file);
        HeatSource source;
        readName(r, source.name, "source", scene.heatSources.size());
        r.choice("type", source.type,
                 {{"point", thawHeatSource_point},
                  {"sphere", thawHeatSource_sphere},
                  {"rectangle", thawHeatSource_rectangle},
                  {"disc", thawHeatSource_disc},
                  {"directional", thawHeatSource_directional}});
        if (source.type != thawHeatSource_directional) r.need("position");
        r.vector("position", source.position, -kFar, kFar, "m");
        readRotation(r, source.rotation);
        r.real("power", source.power, -1e6, 1e6, "W");
        r.real("radius", source.radius, 1e-4, 10.0, "m");
        double edges[2];
        if (r.numbers("size", 2, 2e-4, 2e4, "m", edges)) source.size = {float(edges[0]), 0.0f, float(edges[1])};
        r.real("temperature", source.temperature, 0.0, 1e9, "K");
        r.real("emissivity", source.emissivity, 0.0, 1.0);
        r.real("irradiance", source.irradiance, -1e12, 1e12, "W/m^2");
        r.flag("enabled", source.enabled);
        r.choice("visual", source.visual,
                 {{"none", SourceVisual::none}, {"flame", SourceVisual::flame}, {"glow", SourceVisual::glow}});
        r.done();
        scene.heatSources.push_back(std::move(source));
    });
    root.list("paths", 1024, [&](const json& value, const std::string& place) {
        Reader r(value, place, file);
        Path path;
        readName(r, path.name, "path", scene.paths.size());
        thawInitPathDef(&path.def);
        r.need("points");
        r.list("points", 1'000'000,
               [&](const json& point, const std::string& at) { path.points.push_back(readPoint(r, point, at)); });
        if (path.points.size() < 2)
            r.bad(r.at("points"), "must be two or more, got " + std::to_string(path.points.size()));
        path.collider = readCollider(r, scene);
        thawPathDef& d = path.def;
        r.flag("smooth", d.smooth);
        r.flag("enabled", d.enabled);
        r.real("radius", d.radius, 1e-4, 10.0, "m");
        r.real("reach", d.reach, double(d.radius), 10.0, "m");
        r.real("strength", d.strength, 0.0, 1.0);
        r.real("speed", d.speed, 0.0, 100.0, "m/s");
        r.real("arrivalTime", d.arrivalTime, 0.0, 1e4, "s");
        r.real("share", d.share, 0.0, 1e6);
        r.integer("priority", d.priority, -1'000'000, 1'000'000);
        r.real("beadSpacing", d.beadSpacing, 2 * double(d.radius), 10.0, "m");
        r.real("startAbsorptivity", d.startAbsorptivity, 0.0, 1.0);
        r.done();
        scene.paths.push_back(std::move(path));
    });
    root.list("shapes", 1024, [&](const json& value, const std::string& place) {
        Reader r(value, place, file);
        FillShape shape;
        readName(r, shape.name, "shape", scene.shapes.size());
        thawInitShapeDef(&shape.def);
        thawShapeDef& d = shape.def;
        if (r.find("contours")) {
            if (r.find("shape") || r.find("mesh")) r.bad(r.at("contours"), "give either contours, shape or mesh");
            r.list("contours", 10'000, [&](const json& contour, const std::string& at) {
                if (!contour.is_array() || contour.size() < 3)
                    r.bad(at, "must be three points or more, got " + brief(contour));
                std::vector<thawVec3>& points = shape.contours.emplace_back();
                for (size_t k = 0; k < contour.size(); ++k)
                    points.push_back(readPoint(r, contour[k], at + "/" + std::to_string(k)));
            });
            if (shape.contours.empty()) r.bad(r.at("contours"), "must be one or more, got none");
            r.vector("normal", d.normal, -kFar, kFar);
            r.real("depth", d.depth, 1e-4, 10.0, "m");
            r.real("thickness", d.thickness, 0.0, 10.0, "m");
        } else {
            if (!r.find("shape") && !r.find("mesh"))
                r.bad(r.at("contours"), "is missing: give 'contours', 'shape' or 'mesh'");
            readShape(r, shape.shape, false);
            readPlacement(r, shape.placement);
        }
        shape.collider = readCollider(r, scene);
        r.flag("enabled", d.enabled);
        r.real("reach", d.reach, 1e-4, 10.0, "m");
        r.real("strength", d.strength, 0.0, 1.0);
        r.real("speed", d.speed, 1e-4, 100.0, "m/s");
        r.flag("sets", d.sets);
        r.real("setFill", d.setFill, 0.0, 1.0);
        r.real("setTime", d.setTime, 0.0, 1e4, "s");
        r.integer("priority", d.priority, -1'000'000, 1'000'000);
        r.done();
        scene.shapes.push_back(std::move(shape));
    });
    root.list("props", 1000, [&](const json& value, const std::string& place) {
        Reader r(value, place, file);
        Prop prop;
        readName(r, prop.name, "prop", scene.props.size());
        readShape(r, prop.shape, false);
        readPlacement(r, prop.placement);
        r.vector("color", prop.color, 0.0, 1.0);
        r.done();
        scene.props.push_back(std::move(prop));
    });
    if (const json* value = root.find("camera")) readCamera(*value, file, scene.camera);
    if (const json* value = root.find("look")) {
        Reader r(*value, "/look", file);
        if (r.vector("sunDirection", scene.look.sunDirection, -1e3, 1e3)) {
            const thawVec3& s = scene.look.sunDirection;
            const double length = std::hypot(double(s.x), double(s.y), double(s.z));
            if (length < 1e-6) r.bad("/look/sunDirection", "has no length");
        }
        r.real("exposure", scene.look.exposure, 0.01, 100.0);
        r.done();
    }
    if (const json* value = root.find("defaults")) {
        Reader r(*value, "/defaults", file);
        r.real("seconds", scene.defaults.seconds, 0.01, 3600.0, "s");
        r.real("budgetMilliseconds", scene.defaults.budgetMilliseconds, 0.05, 1e4, "ms");
        r.list("captures", 1000, [&](const json& time, const std::string& place) {
            scene.defaults.captures.push_back(float(r.checked(time, place, 0.0, 3600.0, "s")));
        });
        r.done();
    }
    root.done();
    checkNames(file, "materials", scene.materials);
    return scene;
}

Scene loadScene(const std::string& path) {
    namespace fs = std::filesystem;
    const std::string shown = oneLine(path, 400);
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) throw InputError(shown + ": no such file");
    if (fs::is_directory(status)) throw InputError(shown + ": is a folder, not a scene file");
    std::ifstream in(path, std::ios::binary);
    if (!in) throw InputError(shown + ": cannot be opened");
    std::string text;
    std::vector<char> block(1 << 16);
    while (in.read(block.data(), std::streamsize(block.size())) || in.gcount() > 0) {
        text.append(block.data(), size_t(in.gcount()));
        if (text.size() > kMaxSceneBytes) throw InputError(shown + ": is larger than 16 MiB");
    }
    if (in.bad()) throw InputError(shown + ": cannot be read");
    if (text.empty()) throw InputError(shown + ": is empty");
    return parseScene(text, path, fs::path(path).parent_path().string());
}

} // namespace thaw::scene
