// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>

#if defined(_WIN32)
#include <io.h>
#define THAW_ISATTY(fd) _isatty(fd)
#else
#include <unistd.h>
#define THAW_ISATTY(fd) isatty(fd)
#endif

namespace thaw::player {

using scene::InputError;
using scene::oneLine;

namespace {
std::ofstream openFile(const std::string& path) {
    std::ofstream file(path, std::ios::binary);
    if (!file) throw RunError(oneLine(path, 400) + ": cannot be written");
    return file;
}

void closeFile(std::ofstream& file, const std::string& path) {
    file.flush();
    if (!file) throw RunError(oneLine(path, 400) + ": cannot be written to the end");
}

std::string within(const std::string& folder, const std::string& name) {
    return (std::filesystem::path(folder) / name).string();
}
} // namespace

void RunOptions::addTo(CLI::App& command) {
    command.add_option("--seconds", seconds, "Time of the game to run, s (default: what the scene says)");
    CLI::Option* ms =
        command.add_option("--budget-ms", budgetMs, "Time a step may take, ms (default: what the scene says)");
    CLI::Option* fixedWork =
        command
            .add_option("--work", work,
                        "Fixed work instead: sub-steps,pressure,viscosity iterations[,least sub-steps], such as 4,4,12")
            ->excludes(ms);
    command
        .add_option("--work-units", units,
                    "Budget by the fixed price list instead, the same on every machine; about 1000 a millisecond")
        ->excludes(ms)
        ->excludes(fixedWork);
    CLI::Option* fixed = command.add_option(
        "--fixed-level", fixedLevel, "All particles of one level, 0 (finest) to 3, as far as they can be that coarse");
    command
        .add_option("--coarsest-level", coarsestLevel,
                    "Solids start and stay as coarse as this, 0 to 3, until heat or melt comes near (default: what the "
                    "scene says)")
        ->excludes(fixed);
    command.add_flag("--no-adaptive", notAdaptive, "The finest particles everywhere: --fixed-level 0")->excludes(fixed);
    command.add_option("--threads", threads, "Threads that take part, 1 to 64")->capture_default_str();
    command.add_option("--out", out,
                       "Folder for table.txt, table.json, pictures and meshes; made when it is not there");
    command.add_option("--pictures", pictures,
                       "How many pictures to spread over the run, the first and last frame among them");
    command.add_option("--view", view, "What pictures show: " + pictureViews())->capture_default_str();
    command.add_option("--picture-size", size, "Pixels of a picture")->capture_default_str();
    command.add_option("--mesh", mesh, "Write the last surface: ply or obj");
    command.add_option("--json", json, "File for the report, for programs");
    command.add_option("--csv", csv, "File for one line a step");
    command.add_option("--most-over", mostOver, "Fail when more than this share of the frames is over the budget, %")
        ->capture_default_str();
    command.add_flag("--quiet", quiet, "No progress on stderr");
}

thawBudget makeBudget(const scene::Scene& scene, double budgetMs, const std::string& work, double units) {
    thawBudget budget;
    thawInitBudget(&budget);
    budget.milliseconds = scene.defaults.budgetMilliseconds;
    if (!work.empty()) {
        const std::vector<double> w = parseNumbers("--work", work, 1, 200, "", 3, 4);
        checkRange("--work sub-steps", w[0], 1, 16);
        checkRange("--work pressure", w[1], 1, 64);
        for (double v : w)
            if (v != std::floor(v)) throw InputError("--work: must be whole numbers, got '" + oneLine(work, 60) + "'");
        budget.mode = thawBudget_work;
        budget.work.subSteps = int32_t(w[0]);
        budget.work.pressureIterations = int32_t(w[1]);
        budget.work.viscosityIterations = int32_t(w[2]);
        if (w.size() > 3) {
            checkRange("--work least sub-steps", w[3], 1, 16);
            budget.work.leastSubSteps = int32_t(w[3]);
        }
        return budget;
    }
    if (units != -1) {
        checkRange("--work-units", units, 0, 1e12);
        budget.mode = thawBudget_units;
        budget.units = float(units);
        return budget;
    }
    budget.mode = thawBudget_milliseconds;
    if (budgetMs != 0.0) {
        checkRange("--budget-ms", budgetMs, 0.05, 1e4, "ms");
        budget.milliseconds = float(budgetMs);
    }
    return budget;
}

void applyLevels(const RunOptions& o, scene::Scene& scene, thawBudget& budget) {
    const int fixed = o.notAdaptive ? 0 : o.fixedLevel;
    const int coarsest = fixed >= 0 ? fixed : o.coarsestLevel;
    if (o.fixedLevel != -1) checkRange("--fixed-level", o.fixedLevel, 0, 3);
    if (o.coarsestLevel != -1) checkRange("--coarsest-level", o.coarsestLevel, 0, 3);
    if (coarsest < 0) return;
    for (scene::Body& b : scene.bodies) b.coarsestLevel = coarsest;
    for (thawWork* work : {&budget.work, &budget.least, &budget.most}) {
        work->coarsestLevel = coarsest;
        if (fixed >= 0) work->finestLevel = fixed;
    }
}

int framesOf(double seconds) { return std::max(1, int(std::lround(seconds / kFrameSeconds))); }

uint32_t timedStep(thawWorld* world, const thawBudget& budget, Report& report) {
    const auto start = std::chrono::steady_clock::now();
    const uint32_t status = thawWorld_Step(world, float(kFrameSeconds), &budget);
    const std::chrono::duration<double, std::milli> ms = std::chrono::steady_clock::now() - start;
    report.addStep(world, ms.count(), status);
    return status;
}

void stepOrThrow(thawWorld* world, const thawBudget& budget, Report& report) {
    if (timedStep(world, budget, report) & thawStep_refused)
        throw RunError(std::string("a step was refused: ") + thawWorld_GetLastError(world));
}

Progress::Progress(std::string name, int frames, bool quiet)
    : name_(std::move(name)), frames_(frames), quiet_(quiet), terminal_(THAW_ISATTY(2) != 0) {}

Progress::~Progress() {
    if (open_) std::fputc('\n', stderr);
}

void Progress::frame(int done, const Report& report) {
    if (quiet_ || (done % (terminal_ ? 6 : 60) != 0 && done != frames_)) return;
    std::fprintf(stderr, "%s%s: %.1f of %.1f s, %.1f %% melted, p50 %.2f ms, %zu frames over%s", terminal_ ? "\r" : "",
                 name_.c_str(), done * kFrameSeconds, frames_ * kFrameSeconds,
                 100.0 * double(report.counters().meltedFraction), report.percentile(0.5), report.framesOver(),
                 terminal_ ? "\033[K" : "\n");
    std::fflush(stderr);
    open_ = terminal_;
}

int runScene(scene::Scene scene, const RunOptions& o) {
    const double seconds = o.seconds != 0.0 ? o.seconds : double(scene.defaults.seconds);
    checkRange("--seconds", seconds, 0.01, 3600.0, "s");
    checkRange("--threads", o.threads, 1, 64);
    checkRange("--pictures", o.pictures, 0, 1000);
    checkRange("--most-over", o.mostOver, 0, 100, "%");
    thawBudget budget = makeBudget(scene, o.budgetMs, o.work, o.units);
    applyLevels(o, scene, budget);
    const PictureView view = parseView("--view", o.view);
    const PictureSize size = parseSize("--picture-size", o.size);
    if (!o.mesh.empty() && o.mesh != "ply" && o.mesh != "obj")
        throw InputError("--mesh: must be ply or obj, got '" + oneLine(o.mesh, 40) + "'");
    if (o.out.empty() && (o.pictures > 0 || !o.mesh.empty()))
        throw InputError("--pictures and --mesh need --out FOLDER");

    const scene::SceneMeshes meshes = scene::loadMeshes(scene);
    const scene::SceneWorld built = scene::buildWorld(scene, meshes, o.threads);
    thawWorld* world = built.world.get();

    // Whatever cannot be written is found out before the run, not after it.
    if (!o.out.empty()) makeFolder(o.out);
    std::ofstream csv, json, table, tableJson;
    if (!o.csv.empty()) csv = openFile(o.csv);
    if (!o.json.empty()) json = openFile(o.json);
    if (!o.out.empty()) table = openFile(within(o.out, "table.txt")), tableJson = openFile(within(o.out, "table.json"));
    std::unique_ptr<Pictures> pictures;
    if (o.pictures > 0) pictures = std::make_unique<Pictures>(scene, meshes, size);

    Report report;
    report.name = oneLine(scene.name, 80);
    report.threads = o.threads;
    report.budget = budget;
    report.limitMs = budget.milliseconds;
    const int frames = framesOf(seconds);
    int nextPicture = 0;
    auto takePictures = [&](int done) {
        while (pictures && nextPicture < o.pictures) {
            const int due = o.pictures == 1 ? frames : int(int64_t(frames) * nextPicture / (o.pictures - 1));
            if (due > done) return;
            const std::string caption =
                formatted("%.1f s, melted %.0f %%, p95 %.1f ms", done * kFrameSeconds,
                          100.0 * double(report.counters().meltedFraction), report.percentile(0.95));
            pictures->take(world, view, caption, within(o.out, formatted("picture_%03d.png", nextPicture)));
            ++nextPicture;
        }
    };
    if (csv.is_open()) csv << report.csvHeader();
    {
        Progress progress(report.name, frames, o.quiet);
        takePictures(0);
        for (int f = 1; f <= frames; ++f) {
            const uint32_t status = timedStep(world, budget, report);
            if (csv.is_open()) csv << report.csvLine();
            progress.frame(f, report);
            if (status & thawStep_refused)
                throw RunError("step " + std::to_string(f) + " was refused: " + thawWorld_GetLastError(world));
            takePictures(f);
        }
    }
    report.finish(world);
    for (size_t k = 0; k < built.paths.size(); ++k) {
        Report::PathNote& note = report.paths.emplace_back();
        note.name = oneLine(scene.paths[k].name, 40);
        if (thawPath_GetState(world, built.paths[k], &note.state) != thawResult_ok) report.paths.pop_back();
    }
    for (size_t k = 0; k < built.shapes.size(); ++k) {
        Report::ShapeNote& note = report.shapes.emplace_back();
        note.name = oneLine(scene.shapes[k].name, 40);
        if (thawShape_GetState(world, built.shapes[k], &note.state) != thawResult_ok) report.shapes.pop_back();
    }

    const std::string text = report.table();
    std::cout << text << std::flush;
    if (table.is_open()) table << text, closeFile(table, within(o.out, "table.txt"));
    if (tableJson.is_open()) tableJson << report.json(), closeFile(tableJson, within(o.out, "table.json"));
    if (json.is_open()) json << report.json(), closeFile(json, o.json);
    if (csv.is_open()) closeFile(csv, o.csv);
    if (pictures) pictures->writeSheet(within(o.out, "sheet.png"), report.name);
    if (!o.mesh.empty()) writeSurface(world, scene, within(o.out, "surface." + o.mesh));

    bool failed = !report.faults().empty();
    const double over = 100.0 * double(report.framesOver()) / double(frames);
    if (over > o.mostOver) {
        std::fprintf(stderr, "thaw: %.2f %% of the frames are over %g ms, --most-over allows %g %%\n", over,
                     double(report.limitMs), o.mostOver);
        failed = true;
    }
    return failed ? kExitFailed : kExitOk;
}

void addRun(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("run", "Step a scene at 60 Hz, print what it costs and how well it went");
    auto file = std::make_shared<std::string>();
    auto options = std::make_shared<RunOptions>();
    command->add_option("scene", *file, "Scene file (JSON)")->required();
    options->addTo(*command);
    command->callback([=, &exitCode] { exitCode = runScene(scene::loadScene(*file), *options); });
}

} // namespace thaw::player
