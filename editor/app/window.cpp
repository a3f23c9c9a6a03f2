// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/window.h"

#include "app/app.h"
#include "app/input_queue.h"
#include "app/report.h"
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

/// The clipboard, the shape of the pointer and the size of the window; input comes through the queue.
struct Backend {
    explicit Backend(GLFWwindow* window) { ImGui_ImplGlfw_InitForOpenGL(window, false); }
    ~Backend() { ImGui_ImplGlfw_Shutdown(); }
};

constexpr InputQueue::Modifiers kModifiers{{GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL},
                                           {GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT},
                                           {GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT},
                                           {GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER}};

/// What callbacks of the window reach.
struct Wiring {
    App& app;
    InputQueue queue;
};

Wiring& wiringOf(GLFWwindow* window) { return *static_cast<Wiring*>(glfwGetWindowUserPointer(window)); }

/// The key that has this letter on it: GLFW names keys by where they are on an American keyboard.
int lettered(int key, int scancode) {
    if (key < GLFW_KEY_A || key > GLFW_KEY_Z) return key;
    const char* name = glfwGetKeyName(key, scancode);
    if (!name || name[1] != '\0') return key;
    if (name[0] >= 'a' && name[0] <= 'z') return GLFW_KEY_A + (name[0] - 'a');
    return name[0] >= 'A' && name[0] <= 'Z' ? GLFW_KEY_A + (name[0] - 'A') : key;
}

void connect(GLFWwindow* window, Wiring& wiring) {
    glfwSetWindowUserPointer(window, &wiring);
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
        wiringOf(w).queue.moved({float(x), float(y)});
    });
    glfwSetCursorEnterCallback(window, [](GLFWwindow* w, int entered) {
        if (!entered) wiringOf(w).queue.left();
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
        double x = 0, y = 0;
        glfwGetCursorPos(w, &x, &y);
        wiringOf(w).queue.moved({float(x), float(y)});
        wiringOf(w).queue.button(button, action == GLFW_PRESS, glfwGetTime());
    });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double x, double y) {
        wiringOf(w).queue.scrolled({float(x), float(y)});
    });
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int) {
        if (action != GLFW_REPEAT) wiringOf(w).queue.key(lettered(key, scancode), action == GLFW_PRESS);
    });
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned character) { wiringOf(w).queue.text(character); });
    glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
        for (int i = 0; i < count; ++i) wiringOf(w).app.drop(paths[i]);
    });
    glfwSetWindowCloseCallback(window, [](GLFWwindow* w) {
        glfwSetWindowShouldClose(w, GLFW_FALSE);
        wiringOf(w).app.close();
    });
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
    Wiring wiring{app, {}};
    connect(window.get(), wiring);
    if (!file.empty()) app.drop(file);

    std::string title;
    std::string noted;
    const double start = glfwGetTime();
    bool asked = false;
    double shown = 0;
    while (!app.closed()) {
        // Nothing to show: input wakes it, and a look ten times a second keeps messages and the simulation's news
        // going.
        if (app.idle() && wiring.queue.empty())
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
        wiring.queue.feed(kModifiers);
        app.viewport().trail = wiring.queue.trail();
        ImGui::NewFrame();
        app.frame();
        int pixelsX = 0, pixelsY = 0;
        glfwGetFramebufferSize(window.get(), &pixelsX, &pixelsY);
        shell.render(pixelsX, pixelsY);
        glfwSwapBuffers(window.get());
        if (const std::string now = app.title(); now != title) glfwSetWindowTitle(window.get(), (title = now).c_str());
        if (!options.controls.empty()) writeReport(app, options.controls, noted);
        if (options.seconds > 0 && !asked && glfwGetTime() - start > options.seconds) asked = true, app.close();
    }
    std::fprintf(stderr, "thaw-editor: panels took at most %.1f ms a frame beside the picture\n",
                 double(app.worstPanelMs()));
    return 0;
}

} // namespace thaw::editor
