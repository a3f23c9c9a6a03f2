// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "model/live_world.h"

#include <filesystem>

namespace thaw::editor {

namespace {

int64_t timeOf(const std::string& path) {
    std::error_code error;
    const auto time = std::filesystem::last_write_time(path, error);
    return error ? -1 : int64_t(time.time_since_epoch().count());
}

/// All that the meshes of a scene are made of.
std::string keyOf(const scene::Scene& s) {
    std::string key;
    const auto add = [&](const scene::Shape& shape) {
        key += scene::shapeName(shape.type);
        if (shape.type == scene::ShapeType::mesh) {
            const std::filesystem::path file = std::filesystem::path(s.directory) / shape.meshFile;
            key += " " + file.string() + " " + std::to_string(timeOf(file.string()));
        }
        for (const float f : {shape.size.x, shape.size.y, shape.size.z, shape.radius, shape.height, shape.tubeRadius})
            key += " " + scene::shortest(f);
        key += "\n";
    };
    const auto place = [&](const scene::Placement& p) {
        for (const float f : {p.position.x, p.position.y, p.position.z, p.rotation.x, p.rotation.y, p.rotation.z,
                              p.rotation.w, p.scale})
            key += " " + scene::shortest(f);
    };
    for (const scene::Body& body : s.bodies) {
        add(body.shape);
        for (const scene::Part& part : body.parts)
            key += "part ", place(part.placement), add(part.shape), key += scene::shortest(part.depth);
    }
    key += "colliders\n";
    for (const scene::Collider& c : s.colliders) add(c.shape);
    key += "shapes\n";
    for (const scene::FillShape& f : s.shapes) {
        if (f.contours.empty())
            add(f.shape);
        else
            key += "contours\n";
    }
    key += "props\n";
    for (const scene::Prop& p : s.props) add(p.shape);
    return key;
}

} // namespace

std::shared_ptr<const scene::SceneMeshes> MeshStore::load(const scene::Scene& s) {
    std::string key = keyOf(s);
    if (last_ && key == key_) return last_;
    auto made = std::make_shared<scene::SceneMeshes>(scene::loadMeshes(s, [&](const std::string& path) {
        File& file = files_[path];
        const int64_t time = timeOf(path);
        if (file.mesh.vertices.empty() || file.time != time) file = {scene::importMesh(path), time};
        return file.mesh;
    }));
    last_ = std::move(made), key_ = std::move(key);
    return last_;
}

} // namespace thaw::editor
