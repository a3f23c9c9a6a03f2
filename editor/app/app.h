// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "app/dialogs.h"
#include "app/exporter.h"
#include "app/studio.h"
#include "app/viewport.h"
#include "app/widgets.h"

#include <string>

namespace thaw::editor {

/// The editor, without a window: what one frame of it shows and does. Belongs to an ImGui context and the OpenGL
/// context that was current when it was made, and is used on that thread.
class App {
public:
    /// Throws std::runtime_error when the context cannot draw.
    explicit App(const Studio::Options& options);

    /// Between ImGui::NewFrame and ImGui::Render.
    void frame();
    /// A file was dropped into the window: a scene, or a mesh.
    void drop(const std::string& path);
    /// The window is asked to close: what is unsaved is asked about first.
    void close();
    bool closed() const { return studio_.closing; }
    /// Nothing moves and nothing was touched lately: a frame shows what the last one did.
    bool idle() const;
    /// "candle.json* - thaw"
    std::string title() const;

    Studio& studio() { return studio_; }
    const Studio& studio() const { return studio_; }
    Viewport& viewport() { return viewport_; }
    const Viewport& viewport() const { return viewport_; }
    const Controls& controls() const { return controls_; }
    Dialogs& dialogs() { return dialogs_; }
    Exporter& exporter() { return exporter_; }
    /// ms that the panels of the last frame took, without the picture.
    float panelMs() const { return panelMs_; }
    float worstPanelMs() const { return worstPanelMs_; }

private:
    void menu();
    void shortcuts();
    void layout();

    Studio studio_;
    Viewport viewport_;
    Exporter exporter_;
    Dialogs dialogs_;
    Controls controls_;
    float panelMs_ = 0, worstPanelMs_ = 0;
    int frames_ = 0;
    double lastActive_ = 0;
};

} // namespace thaw::editor
