// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "film.h"
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
    std::string at, size = "960x540", view = "shaded", out, work = kCaptureWork;
    std::string levels; // coarsest ones, a run for each
    int threads = defaultThreads();
    bool sheet = false, cut = false, quiet = false;
    bool sequence = false;
    std::string animation;
    int framesPerSecond = 30;
    double seconds = 0, hold = 1;
};

std::vector<PictureView> parseViews(const std::string& text) {
    std::vector<PictureView> views;
    for (size_t at = 0; at <= text.size();) {
        const size_t end = std::min(text.find(',', at), text.size());
        views.push_back(parseView("--view", text.substr(at, end - at)));
        at = end + 1;
    }
    return views;
}

// Draws one scene at its times; `index` counts the files. Returns the pictures for a sheet.
std::unique_ptr<Pictures> captureScene(const Options& o, const std::string& path, PictureSize size,
                                       const std::vector<PictureView>& views, int coarsest, int& index,
                                       std::string& name) {
    scene::Scene scene = scene::loadScene(path);
    for (scene::Body& b : scene.bodies)
        if (coarsest >= 0) b.coarsestLevel = coarsest;
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
    auto pictures = std::make_unique<Pictures>(scene, meshes, size, o.cut);
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
                stepOrThrow(built.world.get(), budget, report);
                progress.frame(frame + 1, report);
            }
            std::string when = formatted("t = %.2f s", frame * kFrameSeconds);
            if (o.scenes.size() > 1) when = report.name + ", " + when;
            thawCounters counters;
            thawWorld_GetCounters(built.world.get(), &counters);
            if (coarsest >= 0) when += formatted(coarsest > 0 ? ", adaptive, %d" : ", uniform, %d", counters.particles);
            for (const PictureView view : views) {
                pictures->take(built.world.get(), view, when,
                               (std::filesystem::path(o.out) / formatted("capture_%03d.png", index++)).string());
                ++taken;
            }
        }
    }
    std::printf("%s: %d pictures in %s, state hash %s\n", report.name.c_str(), taken,
                scene::oneLine(o.out, 400).c_str(), hashText(thawWorld_GetStateHash(built.world.get())).c_str());
    return pictures;
}

int captureFilm(const Options& o, PictureSize size, const std::vector<PictureView>& views) {
    if (o.scenes.size() > 1) throw scene::InputError("--sequence and --animation take one scene");
    if (views.size() > 1) throw scene::InputError("--sequence and --animation take one view");
    if (o.sequence && o.out.empty()) throw scene::InputError("--sequence needs --out FOLDER");
    if (!o.sequence && !o.out.empty()) throw scene::InputError("--out: pictures beside an animation need --sequence");
    const Film film{o.sequence ? o.out : "",
                    o.animation,
                    o.framesPerSecond,
                    o.seconds,
                    o.hold,
                    views[0],
                    size,
                    o.threads,
                    o.cut,
                    o.quiet};
    checkFilm(film);
    const scene::Scene scene = scene::loadScene(o.scenes[0]);
    shoot(film, scene, makeBudget(scene, 0.0, o.work));
    return kExitOk;
}

int capture(const Options& o) {
    const PictureSize size = parseSize("--size", o.size);
    const std::vector<PictureView> views = parseViews(o.view);
    if (o.sequence || !o.animation.empty()) return captureFilm(o, size, views);
    if (o.out.empty()) throw scene::InputError("--out is required");
    std::vector<double> levels{-1};
    if (!o.levels.empty()) levels = parseNumbers("--coarsest-level", o.levels, 0, 3, "", 1, 4);
    for (const double level : levels)
        if (level != std::floor(level)) throw scene::InputError("--coarsest-level: must be whole numbers");
    checkRange("--threads", o.threads, 1, 64);
    std::unique_ptr<Pictures> all;
    std::string name;
    int index = 0;
    for (const std::string& path : o.scenes) {
        std::unique_ptr<Pictures> pictures;
        for (size_t k = 0; k < levels.size(); ++k) {
            std::unique_ptr<Pictures> run = captureScene(o, path, size, views, int(levels[k]), index, name);
            if (pictures)
                pictures->beside(*run, int(k));
            else
                pictures = std::move(run);
        }
        if (all)
            all->append(*pictures);
        else
            all = std::move(pictures);
    }
    if (o.sheet)
        all->writeSheet((std::filesystem::path(o.out) / "sheet.png").string(),
                        o.scenes.size() > 1 ? formatted("%zu scenes", o.scenes.size()) : name,
                        levels.size() > 1 ? int(levels.size()) : 0);
    return kExitOk;
}
} // namespace

void addCapture(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("capture", "Pictures of a scene at given times, the same on every machine");
    auto o = std::make_shared<Options>();
    command->add_option("scenes", o->scenes, "Scene files (JSON); several come one after the other")->required();
    CLI::Option* at =
        command->add_option("--at", o->at, "Times of the game, s, with commas between (default: what the scene says)");
    command->add_option("--size", o->size, "Pixels of a picture")->capture_default_str();
    command->add_option("--view", o->view, pictureViews() + "; with commas between, several")->capture_default_str();
    command->add_option("--out", o->out, "Folder for the pictures; made when it is not there");
    command->add_option("--work", o->work, "Work of a step: sub-steps,pressure,viscosity iterations[,least sub-steps]")
        ->capture_default_str();
    command->add_option("--threads", o->threads, "Threads that take part, 1 to 64; changes no picture")
        ->capture_default_str();
    CLI::Option* levels =
        command->add_option("--coarsest-level", o->levels,
                            "Of all bodies, 0 to 3; with commas between, a run for each, side by side on the sheet");
    command->add_flag("--cut", o->cut, "Of particles (views particles, level, elfs), only those behind the middle");
    CLI::Option* sheet = command->add_flag("--sheet", o->sheet, "Also sheet.png with all pictures");
    CLI::Option* sequence = command->add_flag("--sequence", o->sequence,
                                              "Numbered pictures of all of the melt instead: frame_0000.png and so on");
    CLI::Option* animation = command->add_option("--animation", o->animation,
                                                 "All of the melt in one file instead, or as well: .png (APNG), .gif, "
                                                 "or .mp4 and .webm by ffmpeg");
    CLI::Option* fps =
        command->add_option("--fps", o->framesPerSecond, "Frames a second of these, 1 to 60")->capture_default_str();
    CLI::Option* seconds =
        command->add_option("--seconds", o->seconds, "Time of the game in them, s (default: what the scene says)");
    CLI::Option* hold =
        command->add_option("--hold", o->hold, "Time that the last frame of an APNG or GIF stays, s, 0 to 60")
            ->capture_default_str();
    for (CLI::Option* moving : {sequence, animation})
        for (CLI::Option* still : {at, levels, sheet}) moving->excludes(still);
    command->add_flag("--quiet", o->quiet, "No progress on stderr");
    command->callback([=, &exitCode] {
        for (const CLI::Option* moving : {fps, seconds, hold})
            if (*moving && !o->sequence && o->animation.empty())
                throw scene::InputError(moving->get_name() + " needs --sequence or --animation FILE");
        exitCode = capture(*o);
    });
}

} // namespace thaw::player
