// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "model/reference.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace thaw::editor {

namespace {
constexpr const char* kHead = "# thaw reference, scene ";
constexpr const char* kColumns = "time,melted,mean_temperature";
} // namespace

uint64_t meltHash(const scene::Scene& scene) {
    nlohmann::json j = nlohmann::json::parse(scene::writeScene(scene));
    for (const char* key : {"name", "camera", "look", "defaults", "props"}) j.erase(key);
    for (auto& list : j)
        if (list.is_array())
            for (auto& item : list)
                for (const char* key : {"color", "visible", "visual"})
                    if (item.is_object()) item.erase(key);
    uint64_t hash = 0xcbf29ce484222325ull; // FNV-1a
    for (const char c : j.dump()) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
    return hash;
}

std::optional<Reference::Row> Reference::at(double time) const {
    const auto after =
        std::lower_bound(rows.begin(), rows.end(), time, [](const Row& row, double t) { return double(row.time) < t; });
    if (after == rows.end()) return {};
    if (double(after->time) == time) return *after;
    if (after == rows.begin()) return {};
    const Row &a = *std::prev(after), &b = *after;
    const float u = float((time - double(a.time)) / (double(b.time) - double(a.time)));
    return Row{float(time), a.melted + u * (b.melted - a.melted),
               a.meanTemperature + u * (b.meanTemperature - a.meanTemperature)};
}

std::string referencePath(const std::string& scenePath) {
    const std::filesystem::path path(scenePath);
    return (path.parent_path() / (path.stem().string() + ".reference.csv")).string();
}

std::optional<Reference> loadReference(const std::string& path) {
    std::ifstream in(path);
    std::string line;
    Reference out;
    if (!std::getline(in, line) || line.rfind(kHead, 0) != 0) return {};
    out.hash = std::strtoull(line.c_str() + std::string(kHead).size(), nullptr, 16);
    if (!std::getline(in, line) || line != kColumns) return {};
    while (std::getline(in, line)) {
        Reference::Row row;
        if (std::sscanf(line.c_str(), "%f,%f,%f", &row.time, &row.melted, &row.meanTemperature) != 3 ||
            !std::isfinite(row.time + row.melted + row.meanTemperature) ||
            (!out.rows.empty() && row.time <= out.rows.back().time))
            return {};
        out.rows.push_back(row);
    }
    if (out.rows.empty()) return {};
    return out;
}

void saveReference(const Reference& reference, const std::string& path) {
    char number[32];
    std::snprintf(number, sizeof number, "%016llx", static_cast<unsigned long long>(reference.hash));
    std::string text = kHead + std::string(number) + "\n" + kColumns + "\n";
    for (const Reference::Row& row : reference.rows)
        text += scene::shortest(row.time) + "," + scene::shortest(row.melted) + "," +
                scene::shortest(row.meanTemperature) + "\n";
    scene::saveText(text, path);
}

void ReferenceRun::start(const scene::Scene& scene, int threads) {
    cancel();
    quit_ = done_ = false;
    progress_ = 0;
    result_ = {};
    thread_ = std::thread([this, scene, threads] { run(scene, threads); });
}

void ReferenceRun::cancel() {
    quit_ = true;
    if (thread_.joinable()) thread_.join();
}

std::optional<ReferenceRun::Result> ReferenceRun::take() {
    if (!thread_.joinable() || !done_) return {};
    thread_.join();
    return std::move(result_);
}

void ReferenceRun::run(const scene::Scene& scene, int threads) {
    try {
        const scene::SceneWorld made = scene::buildWorld(scene, scene::loadMeshes(scene), threads);
        thawBudget budget;
        thawInitBudget(&budget);
        budget.mode = thawBudget_work;
        // Twice as many sub-steps and four times the iterations that suffice for looks: what more changes less than a
        // percent of what melts.
        budget.work.subSteps = 16, budget.work.leastSubSteps = 4;
        budget.work.pressureIterations = 16, budget.work.viscosityIterations = 60;
        budget.work.heatInterval = 1, budget.work.heatCycles = 1000, budget.work.rayRefresh = 1;
        budget.work.raysPerSource = 64, budget.work.finestLevel = budget.work.coarsestLevel = 0;
        const int frames = std::max(1, int(std::lround(60 * double(scene.defaults.seconds))));
        result_.reference.hash = meltHash(scene);
        for (int frame = 0; frame <= frames && !quit_; ++frame) {
            if (frame > 0) thawWorld_Step(made.world.get(), 1.0f / 60, &budget);
            double mass = 0, heat = 0, melted = 0;
            for (const thawBodyId id : made.bodies) {
                thawBodyState s;
                if (thawBody_GetState(made.world.get(), id, &s) != thawResult_ok) continue;
                mass += double(s.mass), heat += double(s.mass) * double(s.meanTemperature);
                melted += double(s.mass) * double(s.meltedFraction);
            }
            result_.reference.rows.push_back(
                {float(frame) / 60, mass > 0 ? float(melted / mass) : 0, mass > 0 ? float(heat / mass) : 0});
            progress_ = float(frame) / float(frames);
        }
        if (quit_) result_.error = "cancelled";
    } catch (const std::exception& e) {
        result_.error = e.what();
    }
    done_ = true;
}

} // namespace thaw::editor
