// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "model/presets.h"

#include <algorithm>
#include <filesystem>

namespace thaw::editor {

namespace fs = std::filesystem;

namespace {

fs::path folderOf(const Places& places) { return fs::path(places.config) / "presets"; }

/// A name as a file can have it.
std::string stemOf(const std::string& name) {
    std::string out;
    for (const char c : name) {
        const auto u = static_cast<unsigned char>(c);
        out += u < 32 || u == 127 || std::string("/\\:*?\"<>|").find(c) != std::string::npos ? '_' : c;
    }
    if (out.empty() || out[0] == '.') out = "_" + out;
    return out.substr(0, 100);
}

} // namespace

std::vector<std::string> ownPresets(const Places& places) {
    std::vector<std::string> out;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folderOf(places), error))
        if (entry.path().extension() == ".json") out.push_back(entry.path().stem().string());
    std::sort(out.begin(), out.end());
    return out;
}

scene::Material loadPreset(const Places& places, const std::string& name) {
    const std::string file = (folderOf(places) / (name + ".json")).string();
    const scene::Scene holds = scene::loadScene(file);
    if (holds.materials.size() != 1) throw scene::InputError(file + ": must hold one material");
    return holds.materials.front();
}

void savePreset(const Places& places, const scene::Material& material) {
    scene::Scene holder;
    holder.name = material.name;
    holder.materials.push_back(material);
    std::error_code error;
    fs::create_directories(folderOf(places), error);
    scene::saveScene(holder, (folderOf(places) / (stemOf(material.name) + ".json")).string());
}

} // namespace thaw::editor
