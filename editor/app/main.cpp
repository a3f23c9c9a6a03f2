// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/app.h"
#include "app/window.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <thread>

int main(int count, char** values) {
    CLI::App command("Draws where melt goes: an editor of scenes for thaw. Press ? in it for the keys.", "thaw-editor");
    std::string scene, controls;
    thaw::editor::WindowOptions options;
    int threads = std::clamp(int(std::thread::hardware_concurrency()), 1, 8);
    command.add_option("scene", scene, "Scene (JSON) to open, or a mesh to add to an empty one");
    command.add_option("--threads", threads, "Threads that step, 1 to 64")
        ->check(CLI::Range(1, 64))
        ->capture_default_str();
    command.add_option("--size", options.size, "WIDTHxHEIGHT of the window in pixels; else that of the last time");
    command.add_option(
        "--controls", options.controls,
        "Write into this file where every control is on the screen and how things stand, whenever that changes: for "
        "scripts that drive the window");
    command.add_option("--seconds", options.seconds, "Close after so many seconds, as if asked to; for tests")
        ->check(CLI::PositiveNumber);
    CLI11_PARSE(command, count, values);
    try {
        thaw::editor::Studio::Options studio;
        studio.places = thaw::editor::standardPlaces();
        studio.threads = threads;
        return thaw::editor::runWindow(studio, options, scene);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "thaw-editor: %s\n", e.what());
        return 1;
    }
}
