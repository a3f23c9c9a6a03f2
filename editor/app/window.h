// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "app/studio.h"

#include <string>

namespace thaw::editor {

struct WindowOptions {
    std::string size;     // "1440x900"; "": as it was
    std::string controls; // file for reportOf(), see report.h; "": none
    double seconds = 0;   // after which it is asked to close; 0: never
};

/// Opens the window and runs until it closes. file: a scene to open, a mesh to add, or "". Returns the exit code.
/// Throws std::runtime_error when there is no display or no OpenGL 3.3.
int runWindow(const Studio::Options& studio, const WindowOptions& options, const std::string& file);

} // namespace thaw::editor
