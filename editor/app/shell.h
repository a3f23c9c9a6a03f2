// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

namespace thaw::editor {

/// ImGui's context with its OpenGL side, in the OpenGL context that is current. One at a time.
class Shell {
public:
    /// Throws std::runtime_error.
    Shell();
    ~Shell();
    Shell(const Shell&) = delete;
    Shell& operator=(const Shell&) = delete;

    /// Draws what was shown since ImGui::NewFrame into the framebuffer that is bound.
    void render(int width, int height);
    void beginFrame();
};

} // namespace thaw::editor
