// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include <memory>
#include <string>

namespace thaw::view {

/// An OpenGL 3.3 core context without a window. Made current on the thread that created it; use it from that thread.
class HeadlessContext {
public:
    /// Tries EGL's surfaceless platform, then its devices, then the default display. nullptr when none works, and error
    /// says what each answered.
    static std::unique_ptr<HeadlessContext> create(std::string& error);
    ~HeadlessContext();
    HeadlessContext(const HeadlessContext&) = delete;
    HeadlessContext& operator=(const HeadlessContext&) = delete;

    /// GL_RENDERER and GL_VERSION, for golden pictures and bug reports.
    const std::string& renderer() const { return rendererString; }
    /// Which of the ways of create worked: "surfaceless", "device 0", "default display".
    const std::string& platform() const { return platformString; }
    /// Makes it current again on this thread after another context was. False when EGL refuses.
    bool makeCurrent();

private:
    HeadlessContext() = default;
    void* display = nullptr;
    void* context = nullptr;
    void* surface = nullptr;
    std::string rendererString, platformString;
};

} // namespace thaw::view
