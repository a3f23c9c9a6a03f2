// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "film.h"

#include "run.h"
#include "view/animation.h"
#include "view/part_file.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace thaw::player {

using scene::InputError;
using scene::oneLine;

void checkFilm(const Film& film) {
    checkRange("--fps", film.framesPerSecond, 1, 60);
    if (film.seconds != 0) checkRange("--seconds", film.seconds, 0.01, 3600, "s");
    checkRange("--hold", film.hold, 0, 60, "s");
    checkRange("--threads", film.threads, 1, 64);
    if (film.animation.empty()) return;
    const std::optional<view::AnimationKind> kind = view::animationKind(film.animation);
    if (!kind)
        throw InputError("--animation: must end in .png, .apng, .gif, .mp4 or .webm, got '" +
                         oneLine(film.animation, 200) + "'");
    if (*kind == view::AnimationKind::gif && film.framesPerSecond > 50)
        throw InputError(formatted("--fps: a GIF shows 50 frames a second at most, got %d", film.framesPerSecond));
    if (*kind == view::AnimationKind::video && (film.size.width % 2 || film.size.height % 2))
        throw InputError(formatted("--size: a video needs even sides, got %dx%d", film.size.width, film.size.height));
}

void shoot(const Film& film, const scene::Scene& scene, const thawBudget& budget) {
    checkFilm(film);
    const double seconds = film.seconds != 0 ? film.seconds : double(scene.defaults.seconds);
    const int frames = int(std::floor(seconds * film.framesPerSecond + 1e-6)) + 1;
    if (frames > 100000) throw InputError(formatted("--seconds: %d frames, the most are 100000", frames));
    const auto frameFile = [&](int k) {
        return (std::filesystem::path(film.folder) / formatted("frame_%04d.png", k)).string();
    };
    std::string error;
    std::unique_ptr<view::AnimationWriter> writer;
    if (!film.animation.empty()) {
        writer = view::AnimationWriter::create(
            {film.animation, film.size.width, film.size.height, frames, film.framesPerSecond, film.hold}, error);
        if (!writer) throw RunError(oneLine(error, 600));
    }
    if (!film.folder.empty()) {
        makeFolder(film.folder);
        const view::PartFile probe(frameFile(0));
        if (!std::ofstream(probe.part())) throw RunError(oneLine(film.folder, 400) + ": no file can be written there");
    }
    const scene::SceneMeshes meshes = scene::loadMeshes(scene);
    const scene::SceneWorld built = scene::buildWorld(scene, meshes, film.threads);
    Pictures pictures(scene, meshes, film.size, film.cut);
    Report report;
    report.name = oneLine(scene.name, 80);
    report.budget = budget;
    report.limitMs = budget.milliseconds;
    {
        const auto stepOf = [&](int k) { return int(std::lround(k / (film.framesPerSecond * kFrameSeconds))); };
        Progress progress(report.name, stepOf(frames - 1), film.quiet);
        for (int k = 0, step = 0; k < frames; ++k) {
            for (; step < stepOf(k); ++step) {
                stepOrThrow(built.world.get(), budget, report);
                progress.frame(step + 1, report);
            }
            const view::Image image = pictures.draw(built.world.get(), film.view);
            if (!film.folder.empty() && !view::writePng(frameFile(k), image, error))
                throw RunError(oneLine(error, 600));
            if (writer && !writer->add(image, error)) throw RunError(oneLine(error, 600));
        }
    }
    if (writer && !writer->finish(error)) throw RunError(oneLine(error, 600));
    std::string places = film.folder.empty() ? "" : oneLine(film.folder, 400);
    if (!film.animation.empty()) places += (places.empty() ? "" : " and ") + oneLine(film.animation, 400);
    std::printf("%s: %d frames, %d a second, in %s, state hash %s\n", report.name.c_str(), frames, film.framesPerSecond,
                places.c_str(), hashText(thawWorld_GetStateHash(built.world.get())).c_str());
}

} // namespace thaw::player
