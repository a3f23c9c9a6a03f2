// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "model/autosave.h"

#include <nlohmann/json.hpp>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace thaw::editor {

namespace fs = std::filesystem;

Autosave::Autosave(const Places& places)
    : folder_((fs::path(places.state) / "autosave").string()),
      file_((fs::path(folder_) / (std::to_string(getpid()) + ".json")).string()) {}

Autosave::~Autosave() {
    std::error_code ignored;
    fs::remove(file_, ignored);
}

std::string Autosave::keep(const Document& document) {
    if (document.revision() == kept_) return {};
    std::error_code ignored;
    if (!document.unsaved()) {
        fs::remove(file_, ignored);
        kept_ = document.revision();
        return {};
    }
    const std::string& directory = document.scene().directory;
    const nlohmann::json j{{"path", document.path().empty() ? "" : fs::absolute(document.path()).string()},
                           {"directory", fs::absolute(directory.empty() ? "." : directory).string()},
                           {"scene", scene::writeScene(document.scene())}};
    try {
        fs::create_directories(folder_, ignored);
        scene::saveText(j.dump(1, ' ', false, nlohmann::json::error_handler_t::replace), file_);
    } catch (const std::exception& e) {
        return e.what();
    }
    kept_ = document.revision();
    return {};
}

std::vector<Lost> Autosave::lost() const {
    std::vector<Lost> out;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_, error)) {
        const std::string stem = entry.path().stem().string();
        if (entry.path().extension() != ".json" || stem.find_first_not_of("0123456789") != std::string::npos) continue;
        const long pid = std::strtol(stem.c_str(), nullptr, 10);
        if (pid <= 0 || pid == getpid() || kill(pid_t(pid), 0) == 0 || errno == EPERM) continue;
        std::ifstream in(entry.path(), std::ios::binary);
        const nlohmann::json j = nlohmann::json::parse(in, nullptr, false);
        if (!j.is_object() || !j.contains("scene") || !j["scene"].is_string()) continue;
        Lost lost;
        lost.file = entry.path().string();
        const auto text = [&](const char* key) {
            const auto f = j.find(key);
            return f != j.end() && f->is_string() ? f->get<std::string>() : std::string();
        };
        lost.path = text("path"), lost.directory = text("directory"), lost.text = text("scene");
        const auto written = fs::last_write_time(entry.path(), error);
        lost.age = std::chrono::duration<double>(fs::file_time_type::clock::now() - written).count();
        out.push_back(std::move(lost));
    }
    return out;
}

void Autosave::discard(const Lost& lost) {
    std::error_code ignored;
    fs::remove(lost.file, ignored);
}

} // namespace thaw::editor
