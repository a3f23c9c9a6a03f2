// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "app/app.h"
#include "app/shell.h"
#include "view/context.h"
#include "view/gl_objects.h"
#include "view/image.h"
#include "view/passes.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

/// A folder of a test's own, gone with it.
class Folder {
public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    std::string operator/(const std::string& name) const { return (root_ / name).string(); }
    std::string path() const { return root_.string(); }

private:
    std::filesystem::path root_;
};

/// The editor without a window system, and a hand on its mouse and keys. One at a time.
class Hand {
public:
    /// Settings and autosaves go into the folder. Throws std::runtime_error where nothing can be drawn.
    explicit Hand(const Folder& folder, int width = 1100, int height = 720);
    ~Hand();

    thaw::editor::App& app() { return *app_; }
    thaw::editor::Studio& studio() { return app_->studio(); }

    void frame(int count = 1);
    /// Frames until it is so; false after so many, which no machine needs.
    bool wait(const std::function<bool()>& so, int frames = 4000);
    /// Until the simulation shows the scene as it is now.
    bool settle();

    struct Point {
        float x = 0, y = 0;
    };
    /// The middle of a control. Throws std::runtime_error when it is not on the screen.
    Point at(const std::string& control);
    bool sees(const std::string& control);
    /// Where a point of the world is. Throws when it is not in the picture.
    Point at(thawVec3 point);
    void move(Point to);
    void press(int button = 0);
    void release(int button = 0);
    void click(Point where, int button = 0);
    void click(const std::string& control) { click(at(control)); }
    void clickTwice(Point where);
    void drag(Point from, Point to, int steps = 8, int button = 0);
    void wheel(float steps, bool ctrl = false);
    /// A key of GLFW, with Ctrl or Shift.
    void key(int code, bool ctrl = false, bool shift = false);
    void type(const std::string& text);
    /// The window has another size. Throws std::runtime_error where there is no memory for it.
    void resize(int width, int height);
    int width() const { return width_; }
    int height() const { return height_; }
    /// What the window would show.
    thaw::view::Image picture();

private:
    std::unique_ptr<thaw::view::HeadlessContext> context_;
    std::unique_ptr<thaw::editor::Shell> shell_;
    thaw::view::Target screen_;
    std::unique_ptr<thaw::editor::App> app_;
    int width_, height_;
};
