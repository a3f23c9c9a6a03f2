// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "scene.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace thaw::player {

// A run that failed its own check, or a file that could not be written: exit code 1.
struct RunError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

constexpr int kExitOk = 0, kExitFailed = 1, kExitBadInput = 2;
constexpr double kFrameSeconds = 1.0 / 60.0;

// Throws InputError "NAME: must be in lower..upper unit, got value"; NaN is refused too.
void checkRange(const std::string& name, double value, double lower, double upper, const char* unit = "");
// "2,4,8" to numbers, each checked. Throws InputError.
std::vector<double> parseNumbers(const std::string& name, const std::string& text, double lower, double upper,
                                 const char* unit, size_t minCount, size_t maxCount);
struct PictureSize {
    int width = 960, height = 540;
};
// "960x540"; each side in 16..8192.
PictureSize parseSize(const std::string& name, const std::string& text);
// Threads to use when nobody says: those of the machine, at most 4, leaving the rest to the game.
int defaultThreads();
// Makes a folder and those above it. Throws RunError.
void makeFolder(const std::string& path);

// Each adds one command with its options; the command runs in its callback and leaves its exit code.
void addRun(CLI::App& app, int& exitCode);
void addCapture(CLI::App& app, int& exitCode);
void addMelt(CLI::App& app, int& exitCode);
void addInfo(CLI::App& app, int& exitCode);
void addBench(CLI::App& app, int& exitCode);
void addValidate(CLI::App& app, int& exitCode);
void addMakeMesh(CLI::App& app, int& exitCode);

} // namespace thaw::player
