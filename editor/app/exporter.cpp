// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/exporter.h"

#include "view/image.h"
#include "view/mesh_io.h"

#include <cmath>
#include <cstdio>
#include <filesystem>

namespace thaw::editor {

namespace fs = std::filesystem;

std::string Exporter::begin(Studio& studio, const ExportSettings& settings) {
    if (!settings.pictures && !settings.meshes) return "nothing is chosen";
    std::error_code error;
    fs::create_directories(settings.folder, error);
    if (error) return settings.folder + ": " + error.message();
    settings_ = settings;
    const double seconds = settings.seconds > 0 ? double(settings.seconds) : double(studio.scene().defaults.seconds);
    frames_ = std::lround(seconds * 60), next_ = 0, written_ = 0;
    running_ = true;
    revision_ = studio.document().revision();
    before_ = studio.orders().budget;
    studio.play(false);
    thawInitBudget(&studio.orders().budget);
    studio.reset();
    resets_ = studio.orders().resets;
    return {};
}

void Exporter::end(Studio& studio, const std::string& error) {
    running_ = false;
    studio.orders().budget = before_;
    if (!error.empty())
        studio.complain("The export ended early", error);
    else
        studio.tell("exported " + std::to_string(written_) + " files into " + settings_.folder);
}

void Exporter::cancel(Studio& studio) {
    running_ = false;
    studio.orders().budget = before_;
    studio.tell("export cancelled after " + std::to_string(written_) + " files");
}

void Exporter::update(Studio& studio, Viewport& viewport) {
    if (!running_) return;
    const Frame& f = studio.frame();
    if (f.resets != resets_) return; // not back at the start yet
    if (!f.built) return end(studio, f.error.empty() ? "there is no world" : f.error);
    if (studio.document().revision() != revision_) return end(studio, "the scene was changed meanwhile");
    if (f.frame < next_) return;
    char number[32];
    std::snprintf(number, sizeof number, "_%05lld", static_cast<long long>(next_));
    std::string error;
    const auto path = [&](const char* stem, const char* ending) {
        return (fs::path(settings_.folder) / (stem + std::string(number) + ending)).string();
    };
    try {
        if (settings_.pictures) {
            const view::Image image = viewport.picture(studio, settings_.width, settings_.height);
            if (!view::writePng(path("picture", ".png"), image, error)) return end(studio, error);
            ++written_;
        }
    } catch (const std::exception& e) {
        return end(studio, e.what());
    }
    if (settings_.meshes) {
        std::vector<view::Vec3> colors;
        for (const int i : f.materialOfIndex)
            colors.push_back(i >= 0 ? f.scene->materials[size_t(i)].def.color : view::Vec3{0.7f, 0.7f, 0.7f});
        const bool ok = settings_.obj ? view::writeObj(path("mesh", ".obj"), f.mesh.view(), colors, error)
                                      : view::writePly(path("mesh", ".ply"), f.mesh.view(), colors, error);
        if (!ok) return end(studio, error);
        ++written_;
    }
    if (next_ >= frames_) return end(studio, {});
    const int64_t to = std::min(next_ + std::max(settings_.every, 1), frames_);
    studio.orders().steps += uint64_t(to - next_);
    next_ = to;
}

} // namespace thaw::editor
