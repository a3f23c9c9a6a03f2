// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/input_queue.h"

#include <GLFW/glfw3.h>
#include <doctest/doctest.h>

#include <string>

using thaw::editor::InputQueue;

namespace {

constexpr InputQueue::Modifiers kKeys{{GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL},
                                      {GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT},
                                      {GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT},
                                      {GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER}};

struct Input {
    Input() { ImGui::CreateContext(); }
    ~Input() { ImGui::DestroyContext(); }
    ImGuiIO& frame() {
        queue.feed(kKeys);
        return ImGui::GetIO();
    }
    void tap(int key) { queue.key(key, true), queue.key(key, false); }
    InputQueue queue;
};

} // namespace

TEST_CASE("input: a drag that was over between two pictures has its beginning, its way and its end") {
    Input input;
    input.queue.moved({10, 10});
    input.queue.button(0, true, 1);
    for (int i = 1; i <= 20; ++i) input.queue.moved({10.0f + float(i), 10});
    input.queue.button(0, false, 1.1);
    input.queue.moved({300, 300});
    const ImGuiIO* io = &input.frame();
    CHECK(io->MousePos.x == 10);
    CHECK_FALSE(io->MouseDown[0]);
    io = &input.frame();
    CHECK(io->MouseDown[0]);
    CHECK(io->MousePos.x == 10);
    io = &input.frame();
    CHECK(io->MouseDown[0]);
    CHECK(io->MousePos.x == 30);
    CHECK(input.queue.trail().size() == 20);
    CHECK(input.queue.trail().front().x == 11);
    io = &input.frame();
    CHECK_FALSE(io->MouseDown[0]);
    CHECK(io->MousePos.x == 30);
    io = &input.frame();
    CHECK(io->MousePos.x == 300);
    CHECK(input.queue.empty());
}

TEST_CASE("input: what is a double click does not depend on how fast pictures come") {
    Input input;
    for (const double at : {1.0, 1.1, 1.6}) {
        input.queue.button(0, true, at);
        input.queue.button(0, false, at + 0.05);
    }
    CHECK(input.frame().MouseDoubleClickTime == 0);
    input.frame();
    CHECK(input.frame().MouseDoubleClickTime > 1e6f);
    input.frame();
    CHECK(input.frame().MouseDoubleClickTime == 0);
}

TEST_CASE("input: keys that went down and up between two pictures are all seen, with their modifiers") {
    Input input;
    input.queue.key(GLFW_KEY_LEFT_CONTROL, true);
    input.tap(GLFW_KEY_Z);
    input.tap(GLFW_KEY_Z);
    input.queue.key(GLFW_KEY_LEFT_CONTROL, false);
    input.tap(GLFW_KEY_P);
    std::string seen;
    bool z = false, p = false;
    for (int i = 0; i < 12; ++i) {
        const ImGuiIO& io = input.frame();
        if (io.KeysDown[GLFW_KEY_Z] && !z) seen += io.KeyCtrl ? "Z" : "z";
        if (io.KeysDown[GLFW_KEY_P] && !p) seen += io.KeyCtrl ? "P" : "p";
        z = io.KeysDown[GLFW_KEY_Z], p = io.KeysDown[GLFW_KEY_P];
    }
    CHECK(seen == "ZZp");
    CHECK(input.queue.empty());
    CHECK_FALSE((z || p));
}

TEST_CASE("input: a word typed into a field between two pictures is there in the next, and Enter after it") {
    Input input;
    ImGui::GetIO().WantTextInput = true;
    for (const char c : std::string("melt")) {
        input.queue.key(c - 'a' + GLFW_KEY_A, true);
        input.queue.text(unsigned(c));
        input.queue.key(c - 'a' + GLFW_KEY_A, false);
    }
    input.tap(GLFW_KEY_ENTER);
    const ImGuiIO* io = &input.frame();
    CHECK(io->InputQueueCharacters.Size == 4);
    CHECK_FALSE(io->KeysDown[GLFW_KEY_ENTER]);
    io = &input.frame();
    CHECK(io->KeysDown[GLFW_KEY_ENTER]);
    io = &input.frame();
    CHECK_FALSE(io->KeysDown[GLFW_KEY_ENTER]);
}

TEST_CASE("input: the pointer that leaves the window is nowhere; keys and buttons that there are not are not heard") {
    Input input;
    input.queue.moved({10, 10});
    input.queue.left();
    CHECK(input.frame().MousePos.x < -1e30f);
    input.queue.key(-1, true);
    input.queue.key(600, true);
    input.queue.button(7, true, 0);
    CHECK(input.queue.empty());
}
