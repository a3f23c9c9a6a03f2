// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "model/settings.h"

#include "player/scene.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace thaw::editor {

namespace fs = std::filesystem;

namespace {
std::string folder(const char* variable, const char* below) {
    const char* set = std::getenv(variable);
    if (set && *set == '/') return (fs::path(set) / "thaw").string();
    const char* home = std::getenv("HOME");
    if (home && *home == '/') return (fs::path(home) / below / "thaw").string();
    std::error_code error;
    return (fs::temp_directory_path(error) / "thaw").string();
}
} // namespace

Places standardPlaces() { return {folder("XDG_CONFIG_HOME", ".config"), folder("XDG_STATE_HOME", ".local/state")}; }

void Settings::remember(const std::string& file) {
    const std::string whole = fs::absolute(file).lexically_normal().string();
    recent.erase(std::remove(recent.begin(), recent.end(), whole), recent.end());
    recent.insert(recent.begin(), whole);
    if (recent.size() > 12) recent.resize(12);
}

Settings loadSettings(const Places& places) {
    Settings out;
    std::ifstream in(fs::path(places.config) / "settings.json");
    const nlohmann::json j = nlohmann::json::parse(in, nullptr, false);
    if (!j.is_object()) return out;
    const auto real = [&](const char* key, float& to, float low, float high) {
        if (const auto f = j.find(key); f != j.end() && f->is_number()) to = std::clamp(f->get<float>(), low, high);
    };
    const auto whole = [&](const char* key, int& to, int low, int high) {
        if (const auto f = j.find(key); f != j.end() && f->is_number_integer())
            to = int(std::clamp<int64_t>(f->get<int64_t>(), low, high));
    };
    const auto flag = [&](const char* key, bool& to) {
        if (const auto f = j.find(key); f != j.end() && f->is_boolean()) to = f->get<bool>();
    };
    real("outlinerWidth", out.outlinerWidth, 100, 2000), real("inspectorWidth", out.inspectorWidth, 150, 2000);
    real("lowerHeight", out.lowerHeight, 60, 2000), real("scale", out.scale, 0.5f, 4);
    whole("windowWidth", out.windowWidth, 320, 16384), whole("windowHeight", out.windowHeight, 240, 16384);
    real("snapStep", out.snapStep, 1e-5f, 10), real("snapDegrees", out.snapDegrees, 0.1f, 90);
    flag("snap", out.snap), flag("showTimeline", out.showTimeline);
    if (const auto f = j.find("recent"); f != j.end() && f->is_array())
        for (const auto& file : *f)
            if (file.is_string() && out.recent.size() < 12) out.recent.push_back(file.get<std::string>());
    return out;
}

bool saveSettings(const Places& places, const Settings& s) {
    const nlohmann::json j{{"outlinerWidth", s.outlinerWidth},
                           {"inspectorWidth", s.inspectorWidth},
                           {"lowerHeight", s.lowerHeight},
                           {"windowWidth", s.windowWidth},
                           {"windowHeight", s.windowHeight},
                           {"scale", s.scale},
                           {"snapStep", s.snapStep},
                           {"snapDegrees", s.snapDegrees},
                           {"snap", s.snap},
                           {"showTimeline", s.showTimeline},
                           {"recent", s.recent}};
    std::error_code error;
    fs::create_directories(places.config, error);
    try {
        scene::saveText(j.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n",
                        (fs::path(places.config) / "settings.json").string());
    } catch (const std::exception&) {
        return false;
    }
    return true;
}

} // namespace thaw::editor
