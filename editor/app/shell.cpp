// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/shell.h"

#include <epoxy/gl.h>
#include <imgui/backends/imgui_impl_opengl3.h>
#include <imgui/imgui.h>

#include <stdexcept>

namespace thaw::editor {

Shell::Shell() {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr; // panes stand where settings say
    if (!ImGui_ImplOpenGL3_Init("#version 330 core")) {
        ImGui::DestroyContext();
        throw std::runtime_error("the user interface does not start in this OpenGL context");
    }
}

Shell::~Shell() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext();
}

void Shell::beginFrame() { ImGui_ImplOpenGL3_NewFrame(); }

void Shell::render(int width, int height) {
    ImGui::Render();
    glViewport(0, 0, width, height);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

} // namespace thaw::editor
