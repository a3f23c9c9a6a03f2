// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/window.h"

#include "app/app.h"
#include "app/shell.h"

#include <epoxy/gl.h>
// After epoxy, which brings OpenGL itself.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui/backends/imgui_impl_glfw.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <stdexcept>

namespace thaw::editor {

namespace {

struct Glfw {
    Glfw() {
        if (!glfwInit()) throw std::runtime_error("no window can be opened: " + reason());
    }
    ~Glfw() { glfwTerminate(); }
    static std::string reason() {
        const char* text = nullptr;
        glfwGetError(&text);
        return text ? text : "unknown";
    }
};

struct CloseWindow {
    void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};

struct Backend {
    explicit Backend(GLFWwindow* window) { ImGui_ImplGlfw_InitForOpenGL(window, true); }
    ~Backend() { ImGui_ImplGlfw_Shutdown(); }
};

App& appOf(GLFWwindow* window) { return *static_cast<App*>(glfwGetWindowUserPointer(window)); }

void writeControls(const App& app, const std::string& file, std::map<std::string, Controls::Place>& last) {
    if (app.controls().all() == last) return;
    std::string text;
    for (const auto& [name, p] : app.controls().all())
        text += std::to_string(int(p.x)) + " " + std::to_string(int(p.y)) + " " + std::to_string(int(p.width)) + " " +
                std::to_string(int(p.height)) + " " + name + "\n";
    try {
        scene::saveText(text, file);
        last = app.controls().all();
    } catch (const std::exception&) {
        // The next frame tries again.
    }
}

} // namespace

int runWindow(const Studio::Options& studio, const WindowOptions& options, const std::string& file) {
    const Settings settings = loadSettings(studio.places);
    int width = settings.windowWidth, height = settings.windowHeight;
    if (!options.size.empty() && std::sscanf(options.size.c_str(), "%dx%d", &width, &height) != 2)
        throw std::runtime_error("--size: must be WIDTHxHEIGHT, got " + scene::oneLine(options.size, 40));
    width = std::clamp(width, 320, 16384), height = std::clamp(height, 240, 16384);

    const Glfw glfw;
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    const std::unique_ptr<GLFWwindow, CloseWindow> window(glfwCreateWindow(width, height, "thaw", nullptr, nullptr));
    if (!window) throw std::runtime_error("no window with OpenGL 3.3: " + Glfw::reason());
    glfwMakeContextCurrent(window.get());
    glfwSwapInterval(1);

    Shell shell;
    const Backend backend(window.get());
    App app(studio);
    glfwSetWindowUserPointer(window.get(), &app);
    glfwSetDropCallback(window.get(), [](GLFWwindow* w, int count, const char** paths) {
        for (int i = 0; i < count; ++i) appOf(w).drop(paths[i]);
    });
    glfwSetWindowCloseCallback(window.get(), [](GLFWwindow* w) {
        glfwSetWindowShouldClose(w, GLFW_FALSE);
        appOf(w).close();
    });
    if (!file.empty()) app.drop(file);

    std::string title;
    std::map<std::string, Controls::Place> noted;
    const double start = glfwGetTime();
    bool asked = false;
    double shown = 0;
    while (!app.closed()) {
        // Nothing to show: input wakes it, and a look ten times a second keeps messages and the simulation's news
        // going.
        if (app.idle())
            glfwWaitEventsTimeout(0.1);
        else
            glfwPollEvents();
        // Where vertical sync does not hold, a window need not be drawn more often than a screen shows it.
        const double since = glfwGetTime() - shown;
        if (since < 0.008) glfwWaitEventsTimeout(0.008 - since);
        shown = glfwGetTime();
        glfwGetWindowSize(window.get(), &width, &height);
        app.studio().settings.windowWidth = std::clamp(width, 320, 16384);
        app.studio().settings.windowHeight = std::clamp(height, 240, 16384);
        shell.beginFrame();
        ImGui_ImplGlfw_NewFrame();
        ImGui::NewFrame();
        app.frame();
        int pixelsX = 0, pixelsY = 0;
        glfwGetFramebufferSize(window.get(), &pixelsX, &pixelsY);
        shell.render(pixelsX, pixelsY);
        glfwSwapBuffers(window.get());
        if (const std::string now = app.title(); now != title) glfwSetWindowTitle(window.get(), (title = now).c_str());
        if (!options.controls.empty()) writeControls(app, options.controls, noted);
        if (options.seconds > 0 && !asked && glfwGetTime() - start > options.seconds) asked = true, app.close();
    }
    std::fprintf(stderr, "thaw-editor: panels took at most %.1f ms a frame beside the picture\n",
                 double(app.worstPanelMs()));
    return 0;
}

} // namespace thaw::editor
