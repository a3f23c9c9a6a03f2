// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "app/studio.h"
#include "app/viewport.h"

#include <string>

namespace thaw::editor {

struct ExportSettings {
    std::string folder;
    bool pictures = true, meshes = false, obj = false; // PNG; PLY, or OBJ
    int every = 2;                                     // frames of 1/60 s
    float seconds = 0;                                 // 0: the scene's length
    int width = 960, height = 540;
};

/// Runs the scene from its start and writes what it shows into numbered files, while the window goes on. The work of a
/// step is fixed meanwhile, so that the same comes out on every machine.
class Exporter {
public:
    /// "" or why it cannot begin.
    std::string begin(Studio& studio, const ExportSettings& settings);
    void update(Studio& studio, Viewport& viewport);
    void cancel(Studio& studio);
    bool running() const { return running_; }
    float progress() const { return frames_ > 0 ? float(next_) / float(frames_) : 0; }
    int written() const { return written_; }

private:
    void end(Studio& studio, const std::string& error);
    ExportSettings settings_;
    thawBudget before_{};
    bool running_ = false;
    int64_t frames_ = 0, next_ = 0;
    uint64_t revision_ = 0, resets_ = 0;
    int written_ = 0;
};

} // namespace thaw::editor
