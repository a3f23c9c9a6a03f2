// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "run.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace thaw::player {

namespace {
struct Options {
    std::vector<std::string> scenes;
    std::string at, size = "960x540", view = "shaded", out, work = "4,4,12";
    int threads = defaultThreads();
    bool sheet = false, quiet = false;
};

// Draws one scene at its times; `index` counts the files. Returns the pictures for a sheet.
std::unique_ptr<Pictures> captureScene(const Options& o, const std::string& path, PictureSize size, PictureView view,
                                       int& index, std::string& name) {
    const scene::Scene scene = scene::loadScene(path);
    std::vector<double> times;
    if (!o.at.empty())
        times = parseNumbers("--at", o.at, 0, 3600, "s", 1, 1000);
    else
        times.assign(scene.defaults.captures.begin(), scene.defaults.captures.end());
    if (times.empty()) times = {0.0, double(scene.defaults.seconds)};
    std::sort(times.begin(), times.end());
    // Work units and not milliseconds: the same pictures on a slow machine.
    const thawBudget budget = makeBudget(scene, 0.0, o.work);

    const scene::SceneMeshes meshes = scene::loadMeshes(scene);
    const scene::SceneWorld built = scene::buildWorld(scene, meshes, o.threads);
    makeFolder(o.out);
    auto pictures = std::make_unique<Pictures>(scene, meshes, size);
    Report report;
    report.name = name = scene::oneLine(scene.name, 80);
    report.budget = budget;
    report.limitMs = budget.milliseconds;
    int frame = 0, taken = 0;
    {
        const int frames = int(std::lround(times.back() / kFrameSeconds));
        Progress progress(report.name, frames, o.quiet);
        for (double time : times) {
            for (const int due = int(std::lround(time / kFrameSeconds)); frame < due; ++frame) {
                if (timedStep(built.world.get(), budget, report) & thawStep_refused)
                    throw RunError(std::string("a step was refused: ") + thawWorld_GetLastError(built.world.get()));
                progress.frame(frame + 1, report);
            }
            const std::string when = formatted("t = %.2f s", frame * kFrameSeconds);
            pictures->take(built.world.get(), view, o.scenes.size() > 1 ? report.name + ", " + when : when,
                           (std::filesystem::path(o.out) / formatted("capture_%03d.png", index++)).string());
            ++taken;
        }
    }
    std::printf("%s: %d pictures in %s, state hash %s\n", report.name.c_str(), taken,
                scene::oneLine(o.out, 400).c_str(), hashText(thawWorld_GetStateHash(built.world.get())).c_str());
    return pictures;
}

int capture(const Options& o) {
    const PictureSize size = parseSize("--size", o.size);
    const PictureView view = parseView("--view", o.view);
    checkRange("--threads", o.threads, 1, 64);
    std::unique_ptr<Pictures> all;
    std::string name;
    int index = 0;
    for (const std::string& path : o.scenes) {
        std::unique_ptr<Pictures> pictures = captureScene(o, path, size, view, index, name);
        if (all)
            all->append(*pictures);
        else
            all = std::move(pictures);
    }
    if (o.sheet)
        all->writeSheet((std::filesystem::path(o.out) / "sheet.png").string(),
                        o.scenes.size() > 1 ? formatted("%zu scenes", o.scenes.size()) : name);
    return kExitOk;
}
} // namespace

void addCapture(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("capture", "Pictures of a scene at given times, the same on every machine");
    auto o = std::make_shared<Options>();
    command->add_option("scenes", o->scenes, "Scene files (JSON); several come one after the other")->required();
    command->add_option("--at", o->at, "Times of the game, s, with commas between (default: what the scene says)");
    command->add_option("--size", o->size, "Pixels of a picture")->capture_default_str();
    command->add_option("--view", o->view, "shaded, temperature or phase")->capture_default_str();
    command->add_option("--out", o->out, "Folder for the pictures; made when it is not there")->required();
    command->add_option("--work", o->work, "Work of a step: sub-steps,pressure,viscosity iterations[,least sub-steps]")
        ->capture_default_str();
    command->add_option("--threads", o->threads, "Threads that take part, 1 to 64; changes no picture")
        ->capture_default_str();
    command->add_flag("--sheet", o->sheet, "Also sheet.png with all pictures");
    command->add_flag("--quiet", o->quiet, "No progress on stderr");
    command->callback([=, &exitCode] { exitCode = capture(*o); });
}

} // namespace thaw::player
