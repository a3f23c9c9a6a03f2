// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/input_queue.h"

#include <algorithm>
#include <cfloat>
#include <iterator>

namespace thaw::editor {

namespace {
constexpr double kDoubleClickSeconds = 0.3; // as ImGui has it
}

void InputQueue::left() { moved({-FLT_MAX, -FLT_MAX}); }

void InputQueue::button(int button, bool down, double seconds) {
    if (button >= 0 && button < 5) events_.push_back({Event::button, button, down, {0, 0}, seconds});
}

void InputQueue::key(int key, bool down) {
    if (key >= 0 && key < 512) events_.push_back({Event::key, key, down, {0, 0}});
}

void InputQueue::feed(const Modifiers& keys) {
    ImGuiIO& io = ImGui::GetIO();
    const auto held = [&](const int(&pair)[2]) { return io.KeysDown[pair[0]] || io.KeysDown[pair[1]]; };
    const auto modifier = [&](int key) {
        for (const auto* pair : {&keys.ctrl, &keys.shift, &keys.alt, &keys.super})
            if (key == (*pair)[0] || key == (*pair)[1]) return true;
        return false;
    };
    trail_.clear();
    std::vector<int> turned; // keys that went down or up in this frame
    bool clicked = false, wheeled = false, command = false, typed = false;
    while (!events_.empty()) {
        const Event& e = events_.front();
        if (e.kind == Event::move) {
            // What was pressed is pressed where it was.
            if (clicked || wheeled) break;
            at_ = e.at;
            trail_.push_back(at_);
        } else if (e.kind == Event::button) {
            if (clicked || wheeled || command || typed) break;
            // A window needs one frame to learn that the pointer is over it, and another for the end of a drag.
            if (!trail_.empty()) break;
            clicked = true;
            if (e.down) {
                const bool twice = e.seconds - clicked_[e.code] < kDoubleClickSeconds;
                io.MouseDoubleClickTime = twice ? FLT_MAX : 0;
                clicked_[e.code] = e.seconds;
            }
            buttons_[e.code] = e.down;
        } else if (e.kind == Event::wheel) {
            if (clicked || command) break;
            wheeled = true;
            io.MouseWheel += e.at.y, io.MouseWheelH += e.at.x;
        } else if (e.kind == Event::key) {
            if (clicked || wheeled) break;
            // In a text field what counts are the characters: one may type faster than pictures come.
            const bool letter =
                io.WantTextInput && e.code >= ' ' && e.code < 128 && !held(keys.ctrl) && !held(keys.alt);
            const bool again = std::find(turned.begin(), turned.end(), e.code) != turned.end();
            if (!letter && (again || typed)) break;
            // A command has the modifiers that were held when its key went down.
            if (modifier(e.code) && command) break;
            if (e.down && !letter && !modifier(e.code)) {
                if (command) break;
                command = true;
            }
            turned.push_back(e.code);
            io.KeysDown[e.code] = e.down;
        } else {
            if (clicked) break;
            typed = true;
            io.AddInputCharacter(unsigned(e.code));
        }
        events_.pop_front();
    }
    io.MousePos = at_;
    std::copy(std::begin(buttons_), std::end(buttons_), io.MouseDown);
    io.KeyCtrl = held(keys.ctrl), io.KeyShift = held(keys.shift), io.KeyAlt = held(keys.alt),
    io.KeySuper = held(keys.super);
}

} // namespace thaw::editor
