// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/theme.h"

#include <imgui/imgui.h>

#include <filesystem>

namespace thaw::editor {

namespace {
constexpr float kFontSize = 16;
// The characters of units: degree, squares, cubes, micro.
constexpr ImWchar kRanges[] = {0x20, 0xff, 0};
} // namespace

float fontScale() { return 1; }

void applyTheme(float scale) {
    ImGuiIO& io = ImGui::GetIO();
    if (io.Fonts->Fonts.empty()) {
        std::error_code error;
        for (const char* file :
             {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
              "/usr/share/fonts/TTF/DejaVuSans.ttf"})
            if (std::filesystem::exists(file, error) && io.Fonts->Fonts.empty())
                io.Fonts->AddFontFromFileTTF(file, kFontSize, nullptr, kRanges);
        if (io.Fonts->Fonts.empty()) io.Fonts->AddFontDefault();
    }
    io.FontGlobalScale = scale * fontScale();
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 0, style.FrameRounding = 3, style.GrabRounding = 3, style.PopupRounding = 4;
    style.ScrollbarRounding = 4, style.WindowBorderSize = 0, style.FramePadding = {6, 3}, style.ItemSpacing = {6, 4};
    style.WindowPadding = {7, 6};
    ImVec4* c = style.Colors;
    c[ImGuiCol_Text] = {0.93f, 0.92f, 0.90f, 1}, c[ImGuiCol_TextDisabled] = {0.66f, 0.65f, 0.63f, 1};
    c[ImGuiCol_WindowBg] = {0.125f, 0.125f, 0.13f, 1}, c[ImGuiCol_PopupBg] = {0.16f, 0.16f, 0.165f, 0.99f};
    c[ImGuiCol_MenuBarBg] = {0.10f, 0.10f, 0.105f, 1}, c[ImGuiCol_Border] = {0.30f, 0.30f, 0.31f, 1};
    c[ImGuiCol_FrameBg] = {0.20f, 0.20f, 0.21f, 1}, c[ImGuiCol_FrameBgHovered] = {0.27f, 0.27f, 0.28f, 1};
    c[ImGuiCol_FrameBgActive] = {0.33f, 0.32f, 0.31f, 1};
    const ImVec4 warm{0.80f, 0.46f, 0.17f, 1}, warmer{0.92f, 0.55f, 0.22f, 1}, dim{0.36f, 0.27f, 0.20f, 1};
    c[ImGuiCol_Button] = {0.25f, 0.25f, 0.26f, 1}, c[ImGuiCol_ButtonHovered] = {0.36f, 0.34f, 0.32f, 1};
    c[ImGuiCol_ButtonActive] = warm, c[ImGuiCol_CheckMark] = warmer, c[ImGuiCol_SliderGrab] = warm;
    c[ImGuiCol_SliderGrabActive] = warmer, c[ImGuiCol_Header] = dim,
    c[ImGuiCol_HeaderHovered] = {0.45f, 0.32f, 0.22f, 1};
    c[ImGuiCol_HeaderActive] = warm, c[ImGuiCol_Tab] = {0.18f, 0.18f, 0.19f, 1}, c[ImGuiCol_TabActive] = dim;
    c[ImGuiCol_TabHovered] = warm, c[ImGuiCol_TitleBgActive] = dim, c[ImGuiCol_SeparatorHovered] = warm;
    c[ImGuiCol_PlotHistogram] = warm, c[ImGuiCol_ModalWindowDimBg] = {0, 0, 0, 0.5f};
}

} // namespace thaw::editor
