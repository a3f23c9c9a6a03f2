// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "hand.h"

#include <GLFW/glfw3.h>
#include <imgui/imgui.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <dlfcn.h>
#include <link.h>
#include <stdexcept>
#include <thread>
#include <unistd.h>

using namespace thaw::editor;
namespace fs = std::filesystem;

namespace {
/// Mesa's driver stays loaded: what it keeps for its next start is then not a leak to the leak checker, which looks for
/// ours.
void keepDriver() {
    dl_iterate_phdr(
        [](dl_phdr_info* info, size_t, void*) {
            if (info->dlpi_name && std::strstr(info->dlpi_name, "_dri.so"))
                dlopen(info->dlpi_name, RTLD_LAZY | RTLD_NOLOAD | RTLD_NODELETE);
            return 0;
        },
        nullptr);
}
} // namespace

Folder::Folder() {
    static std::atomic<int> number{0};
    root_ = fs::temp_directory_path() / ("thaw-editor-" + std::to_string(getpid()) + "-" + std::to_string(number++));
    fs::create_directories(root_);
}

Folder::~Folder() {
    std::error_code ignored;
    fs::remove_all(root_, ignored);
}

Hand::Hand(const Folder& folder, int width, int height) : width_(width), height_(height) {
    std::string error;
    context_ = thaw::view::HeadlessContext::create(error);
    if (!context_) throw std::runtime_error(error);
    keepDriver();
    shell_ = std::make_unique<Shell>();
    ImGuiIO& io = ImGui::GetIO();
    resize(width, height);
    // As ImGui's backend for GLFW has them.
    const std::pair<ImGuiKey, int> keys[] = {{ImGuiKey_Tab, GLFW_KEY_TAB},
                                             {ImGuiKey_LeftArrow, GLFW_KEY_LEFT},
                                             {ImGuiKey_RightArrow, GLFW_KEY_RIGHT},
                                             {ImGuiKey_UpArrow, GLFW_KEY_UP},
                                             {ImGuiKey_DownArrow, GLFW_KEY_DOWN},
                                             {ImGuiKey_Home, GLFW_KEY_HOME},
                                             {ImGuiKey_End, GLFW_KEY_END},
                                             {ImGuiKey_Delete, GLFW_KEY_DELETE},
                                             {ImGuiKey_Backspace, GLFW_KEY_BACKSPACE},
                                             {ImGuiKey_Enter, GLFW_KEY_ENTER},
                                             {ImGuiKey_Escape, GLFW_KEY_ESCAPE},
                                             {ImGuiKey_Space, GLFW_KEY_SPACE},
                                             {ImGuiKey_A, GLFW_KEY_A},
                                             {ImGuiKey_Z, GLFW_KEY_Z},
                                             {ImGuiKey_Y, GLFW_KEY_Y}};
    for (const auto& [name, code] : keys) io.KeyMap[name] = code;
    Studio::Options options;
    options.places = {folder / "config", folder / "state"};
    options.threads = 1;
    app_ = std::make_unique<App>(options);
    io.MousePos = {float(width) / 2, float(height) / 2};
    frame(3);
}

Hand::~Hand() {
    app_.reset();
    shell_.reset();
    screen_ = {};
}

void Hand::frame(int count) {
    for (int i = 0; i < count; ++i) {
        ImGui::GetIO().DeltaTime = 1.0f / 60;
        shell_->beginFrame();
        ImGui::NewFrame();
        app_->frame();
        glBindFramebuffer(GL_FRAMEBUFFER, screen_.framebuffer.get());
        shell_->render(width_, height_);
    }
}

bool Hand::wait(const std::function<bool()>& so, int frames) {
    for (int i = 0; i < frames; ++i) {
        if (so()) return true;
        frame();
        // The other thread needs the time, not this one.
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return so();
}

bool Hand::settle() {
    frame();
    return wait([&] {
        return studio().frame().revision == studio().document().revision() &&
               studio().frame().resets == studio().orders().resets;
    });
}

bool Hand::sees(const std::string& control) { return app_->controls().all().count(control) > 0; }

Hand::Point Hand::at(const std::string& control) {
    const auto found = app_->controls().all().find(control);
    if (found == app_->controls().all().end()) throw std::runtime_error("no control " + control);
    const Controls::Place& p = found->second;
    return {p.x + p.width / 2, p.y + p.height / 2};
}

Hand::Point Hand::at(thawVec3 point) {
    const auto p = app_->viewport().lens.project(point);
    if (!p || !app_->viewport().lens.contains(*p)) throw std::runtime_error("that point is not in the picture");
    return {p->x, p->y};
}

void Hand::move(Point to) {
    ImGui::GetIO().MousePos = {to.x, to.y};
    frame();
}

void Hand::press(int button) {
    ImGui::GetIO().MouseDown[button] = true;
    frame();
}

void Hand::release(int button) {
    ImGui::GetIO().MouseDown[button] = false;
    frame();
}

void Hand::click(Point where, int button) {
    move(where);
    frame();
    press(button), release(button);
    frame(2);
}

void Hand::clickTwice(Point where) {
    move(where);
    press(), release(), press(), release();
    frame(2);
}

void Hand::drag(Point from, Point to, int steps, int button) {
    move(from);
    press(button);
    for (int i = 1; i <= steps; ++i) {
        const float u = float(i) / float(steps);
        move({from.x + u * (to.x - from.x), from.y + u * (to.y - from.y)});
    }
    release(button);
    frame();
}

void Hand::wheel(float steps, bool ctrl) {
    ImGuiIO& io = ImGui::GetIO();
    io.KeyCtrl = ctrl, io.MouseWheel = steps;
    frame();
    io.KeyCtrl = false;
}

void Hand::resize(int width, int height) {
    std::string error;
    if (!thaw::view::makeTarget(screen_, GL_RGBA8, width, height, GL_LINEAR, nullptr, error))
        throw std::runtime_error(error);
    width_ = width, height_ = height;
    ImGui::GetIO().DisplaySize = {float(width), float(height)};
}

void Hand::key(int code, bool ctrl, bool shift) {
    ImGuiIO& io = ImGui::GetIO();
    io.KeyCtrl = ctrl, io.KeyShift = shift;
    io.KeysDown[code] = true;
    frame();
    io.KeysDown[code] = false;
    frame();
    io.KeyCtrl = io.KeyShift = false;
    frame();
}

void Hand::type(const std::string& text) {
    for (const char c : text) {
        ImGui::GetIO().AddInputCharacter(static_cast<unsigned char>(c));
        frame();
    }
}

thaw::view::Image Hand::picture() {
    glBindFramebuffer(GL_FRAMEBUFFER, screen_.framebuffer.get());
    thaw::view::Image image(width_, height_);
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data());
    for (int y = 0; y < height_ / 2; ++y)
        std::swap_ranges(&image.at(0, y), &image.at(0, y) + width_, &image.at(0, height_ - 1 - y));
    return image;
}
