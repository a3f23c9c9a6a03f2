// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/app.h"

#include "app/panels.h"
#include "app/theme.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <filesystem>

namespace thaw::editor {

namespace fs = std::filesystem;

namespace {

constexpr ImGuiWindowFlags kPane = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoBringToFrontOnFocus |
                                   ImGuiWindowFlags_NoSavedSettings;

/// A bar between two panes that can be dragged. vertical: the bar stands, and moves left and right.
void splitter(const char* id, ImVec2 low, ImVec2 size, bool vertical, float& value, float sign, float least,
              float most) {
    ImGui::SetNextWindowPos(low);
    ImGui::SetNextWindowSize(size);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
    ImGui::Begin(id, nullptr, kPane | ImGuiWindowFlags_NoScrollbar);
    ImGui::InvisibleButton(id, size);
    ui::note(id);
    if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
        ImGui::SetMouseCursor(vertical ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
        ImGui::GetWindowDrawList()->AddRectFilled(low, {low.x + size.x, low.y + size.y},
                                                  ImGui::GetColorU32(ImGuiCol_SeparatorHovered));
    }
    if (ImGui::IsItemActive()) {
        const ImVec2 way = ImGui::GetIO().MouseDelta;
        value = std::clamp(value + sign * (vertical ? way.x : way.y), least, std::max(least, most));
    }
    ImGui::End();
    ImGui::PopStyleVar(3);
}

bool pane(const char* id, ImVec2 low, ImVec2 size, ImGuiWindowFlags more = 0) {
    ImGui::SetNextWindowPos(low);
    ImGui::SetNextWindowSize({std::max(size.x, 1.0f), std::max(size.y, 1.0f)});
    return ImGui::Begin(id, nullptr, kPane | more);
}

std::string ending(const std::string& path) {
    std::string out = fs::path(path).extension().string();
    for (char& c : out) c = char(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

} // namespace

App::App(const Studio::Options& options) : studio_(options) { applyTheme(studio_.settings.scale); }

std::string App::title() const {
    const std::string& path = studio_.document().path();
    return (path.empty() ? std::string("untitled") : fs::path(path).filename().string()) +
           (studio_.document().unsaved() ? "*" : "") + " - thaw";
}

void App::drop(const std::string& path) {
    const std::string kind = ending(path);
    if (kind == ".json")
        studio_.guarded([this, path] { studio_.open(path); });
    else if (kind == ".obj" || kind == ".ply" || kind == ".stl" || kind == ".gltf" || kind == ".glb")
        studio_.import(path);
    else
        studio_.complain("This file cannot be used",
                         path + ": a scene (.json) or a mesh (.obj, .ply, .stl, .gltf, .glb) can "
                                "be dropped here.");
}

void App::close() {
    studio_.guarded([this] {
        saveSettings(studio_.places, studio_.settings);
        studio_.closing = true;
    });
}

bool App::idle() const {
    // What input and news begin goes on for some frames: windows that appear, pictures that are drawn finer.
    return !studio_.playing() && !exporter_.running() && now() - lastActive_ > 1.0;
}

void App::menu() {
    if (!ImGui::BeginMainMenuBar()) return;
    Studio& s = studio_;
    if (ImGui::BeginMenu("File")) {
        if (ImGui::MenuItem("New", "Ctrl+N")) s.guarded([this] { studio_.create(); });
        ui::note("menu New");
        if (ImGui::MenuItem("Open ...", "Ctrl+O")) s.guarded([this] { studio_.asksForFile = true; });
        ui::note("menu Open");
        if (ImGui::BeginMenu("Open recent", !s.settings.recent.empty())) {
            const std::vector<std::string> recent = s.settings.recent;
            for (const std::string& file : recent)
                if (ImGui::MenuItem(file.c_str())) s.guarded([this, file] { studio_.open(file); });
            ImGui::EndMenu();
        }
        if (ImGui::MenuItem("Save", "Ctrl+S")) s.save();
        ui::note("menu Save");
        if (ImGui::MenuItem("Save as ...", "Ctrl+Shift+S")) s.asksForName = true;
        ui::note("menu Save as");
        ImGui::Separator();
        if (ImGui::MenuItem("Add a mesh ...", "Ctrl+I")) s.asksForMesh = true;
        ui::note("menu Add a mesh");
        if (ImGui::MenuItem("Export ...", "Ctrl+E")) dialogs_.exporting = true;
        ui::note("menu Export");
        ImGui::Separator();
        if (ImGui::MenuItem("Quit", "Ctrl+Q")) close();
        ui::note("menu Quit");
        ImGui::EndMenu();
    }
    ui::note("menu File");
    if (ImGui::BeginMenu("Edit")) {
        const std::string undo = s.document().undoText(), redo = s.document().redoText();
        if (ImGui::MenuItem(undo.empty() ? "Undo" : ("Undo: " + undo).c_str(), "Ctrl+Z", false, !undo.empty()))
            s.undo();
        if (ImGui::MenuItem(redo.empty() ? "Redo" : ("Redo: " + redo).c_str(), "Ctrl+Y", false, !redo.empty()))
            s.redo();
        ImGui::Separator();
        const bool any = bool(s.selection());
        if (ImGui::MenuItem("Duplicate", "Ctrl+D", false, any)) s.duplicateSelection();
        if (ImGui::MenuItem("Delete", "Del", false, any)) s.removeSelection();
        ImGui::EndMenu();
    }
    ui::note("menu Edit");
    if (ImGui::BeginMenu("Add")) {
        showAddMenu(s);
        ImGui::EndMenu();
    }
    ui::note("menu Add");
    if (ImGui::BeginMenu("Window")) {
        if (ImGui::MenuItem("Timeline of the threads", nullptr, s.settings.showTimeline))
            s.settings.showTimeline = !s.settings.showTimeline;
        float scale = s.settings.scale;
        ImGui::SetNextItemWidth(8 * ImGui::GetFontSize());
        if (ImGui::SliderFloat("size of text", &scale, 0.7f, 2.0f, "x %.1f", ImGuiSliderFlags_AlwaysClamp)) {
            s.settings.scale = scale;
            ImGui::GetIO().FontGlobalScale = scale * fontScale();
        }
        if (ImGui::MenuItem("Usual layout")) {
            const Settings usual;
            s.settings.outlinerWidth = usual.outlinerWidth, s.settings.inspectorWidth = usual.inspectorWidth;
            s.settings.lowerHeight = usual.lowerHeight, s.settings.scale = 1;
            ImGui::GetIO().FontGlobalScale = fontScale();
        }
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Help")) {
        if (ImGui::MenuItem("Keys", "?")) dialogs_.shortcuts = true;
        ImGui::Separator();
        ui::quiet(thawGetBuildString());
        ImGui::EndMenu();
    }
    ImGui::EndMainMenuBar();
}

void App::shortcuts() {
    ImGuiIO& io = ImGui::GetIO();
    Studio& s = studio_;
    if (ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel)) return;
    if (io.WantTextInput) return;
    const auto key = [](int code) { return ImGui::IsKeyPressed(code, false); };
    const auto repeated = [](int code) { return ImGui::IsKeyPressed(code, true); };
    if (io.KeyCtrl) {
        if (key(GLFW_KEY_N)) s.guarded([this] { studio_.create(); });
        if (key(GLFW_KEY_O)) s.guarded([this] { studio_.asksForFile = true; });
        if (key(GLFW_KEY_S)) io.KeyShift ? void(s.asksForName = true) : void(s.save());
        if (key(GLFW_KEY_Q)) close();
        if (key(GLFW_KEY_I)) s.asksForMesh = true;
        if (key(GLFW_KEY_E)) dialogs_.exporting = true;
        if (key(GLFW_KEY_D)) s.duplicateSelection();
        // Y and Z change places on some keyboards: ImGui knows where they are.
        if (repeated(GLFW_KEY_Z)) io.KeyShift ? s.redo() : s.undo();
        if (repeated(GLFW_KEY_Y)) s.redo();
        return;
    }
    if (io.KeyAlt) return;
    if (key(GLFW_KEY_SPACE)) s.play(!s.playing());
    if (repeated(GLFW_KEY_RIGHT)) s.frame().frame < s.frame().newest ? s.seek(s.frame().frame + 1) : s.stepOnce();
    if (repeated(GLFW_KEY_LEFT) && s.frame().frame > s.frame().oldest) s.seek(s.frame().frame - 1);
    if (key(GLFW_KEY_HOME)) s.reset();
    if (key(GLFW_KEY_F)) viewport_.focus(s);
    if (key(GLFW_KEY_V)) {
        const int count = int(std::size(scene::kNamedViews));
        s.view.picture = scene::PictureView((int(s.view.picture) + (io.KeyShift ? count - 1 : 1)) % count);
        s.tell(std::string("view: ") + scene::kNamedViews[size_t(s.view.picture)].name);
    }
    if (key(GLFW_KEY_DELETE) || key(GLFW_KEY_BACKSPACE))
        if (!viewport_.tools().removeNode(s)) s.removeSelection();
    if (key(GLFW_KEY_ESCAPE))
        if (!viewport_.tools().cancel()) dialogs_.shortcuts ? void(dialogs_.shortcuts = false) : s.select({});
    if (key(GLFW_KEY_SLASH) && io.KeyShift) dialogs_.shortcuts = !dialogs_.shortcuts;
    const float wider = repeated(GLFW_KEY_RIGHT_BRACKET) ? 1.1f : repeated(GLFW_KEY_LEFT_BRACKET) ? 1 / 1.1f : 0;
    if (wider > 0 && s.selection().kind == Kind::path) {
        const size_t i = size_t(s.selection().index);
        s.edit(
            "Set radius",
            [&](scene::Scene& t) {
                thawPathDef& d = t.paths[i].def;
                d.radius = std::clamp(d.radius * wider, 1e-4f, 10.0f);
                if (d.reach > 0) d.reach = std::max(d.reach, d.radius);
                if (d.beadSpacing > 0) d.beadSpacing = std::max(d.beadSpacing, 2 * d.radius);
            },
            "radius keys");
    }
    toolShortcuts(s);
}

void App::layout() {
    Studio& s = studio_;
    Settings& set = s.settings;
    const ImGuiIO& io = ImGui::GetIO();
    const float font = ImGui::GetFontSize(), top = ImGui::GetFrameHeight(), bar = 5;
    const float unit = set.scale;
    const float tools = 5.6f * font, status = 1.7f * font, width = io.DisplaySize.x, height = io.DisplaySize.y;
    // A small window still shows a picture.
    const float mostSide = std::max(60.0f, 0.36f * (width - tools));
    const float left = std::min(set.outlinerWidth * unit, mostSide),
                right = std::min(set.inspectorWidth * unit, mostSide);
    const float lower = std::clamp(set.lowerHeight * unit, 40.0f, std::max(40.0f, 0.6f * (height - top - status)));
    const float middle = std::max(40.0f, width - tools - left - right - 2 * bar);
    const float upper = std::max(40.0f, height - top - status - lower - bar);
    float x = 0;
    pane("tools", {x, top}, {tools, height - top - status});
    showToolbar(s);
    ImGui::End();
    x += tools;
    pane("outliner", {x, top}, {left, height - top - status});
    showOutliner(s);
    ImGui::End();
    x += left;
    splitter("split left", {x, top}, {bar, height - top - status}, true, set.outlinerWidth, 1 / unit, 100,
             mostSide / unit);
    x += bar;

    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {4, 3});
    pane("picture", {x, top}, {middle, upper}, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
    ImGui::PopStyleVar();
    showViewPanel(s, viewport_);
    viewport_.show(s);
    ImGui::End();
    splitter("split lower", {x, top + upper}, {middle, bar}, false, set.lowerHeight, -1 / unit, 60,
             0.6f * (height - top - status) / unit);
    pane("time", {x, top + upper + bar}, {middle, height - status - top - upper - bar});
    showTransport(s);
    showGraphs(s, viewport_);
    ImGui::End();
    x += middle;

    splitter("split right", {x, top}, {bar, height - top - status}, true, set.inspectorWidth, -1 / unit, 150,
             mostSide / unit);
    x += bar;
    pane("inspector", {x, top}, {std::max(width - x, 1.0f), height - top - status});
    if (ImGui::BeginTabBar("right")) {
        if (ImGui::BeginTabItem("Properties")) {
            showInspector(s);
            ImGui::EndTabItem();
        }
        ui::note("tab Properties");
        if (ImGui::BeginTabItem("Plan")) {
            showPlan(s);
            ImGui::EndTabItem();
        }
        ui::note("tab Plan");
        ImGui::EndTabBar();
    }
    ImGui::End();

    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8, 3});
    pane("status", {0, height - status}, {width, status}, ImGuiWindowFlags_NoScrollbar);
    ImGui::PopStyleVar();
    showStatus(s);
    ImGui::End();
}

void App::frame() {
    const double start = now();
    controls_.begin();
    ui::noteIn(&controls_);
    const uint64_t taken = studio_.framesTaken();
    studio_.update();
    const ImGuiIO& io = ImGui::GetIO();
    if (taken != studio_.framesTaken() || io.MouseDelta.x != 0 || io.MouseDelta.y != 0 || io.MouseWheel != 0 ||
        ImGui::IsAnyMouseDown() || io.InputQueueCharacters.Size > 0 ||
        std::any_of(std::begin(io.KeysDown), std::end(io.KeysDown), [](bool down) { return down; }))
        lastActive_ = start;
    exporter_.update(studio_, viewport_);
    shortcuts();
    menu();
    const double before = viewport_.drawnMs();
    layout();
    dialogs_.show(studio_, exporter_);
    ui::noteIn(nullptr);
    controls_.end();
    const double end = now();
    panelMs_ = float(1000 * (end - start) - (viewport_.drawnMs() - before));
    // The first frames make fonts and shaders.
    if (++frames_ > 10) worstPanelMs_ = std::max(worstPanelMs_, panelMs_);
    studio_.spans.add({start, end, SpanKind::panels});
}

} // namespace thaw::editor
