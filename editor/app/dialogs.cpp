// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/dialogs.h"

#include "app/widgets.h"

#include <imgui/imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

namespace thaw::editor {

namespace fs = std::filesystem;

namespace {

/// A window in the middle that takes all input. end() only when true.
bool modal(const char* id, float widthInLetters) {
    if (!ImGui::IsPopupOpen(id)) ImGui::OpenPopup(id);
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowSize({std::min(widthInLetters * ImGui::GetFontSize(), screen.x - 20), 0});
    ImGui::SetNextWindowPos({0.5f * screen.x, 0.45f * screen.y}, ImGuiCond_Always, {0.5f, 0.5f});
    return ImGui::BeginPopupModal(id, nullptr, ImGuiWindowFlags_AlwaysAutoResize);
}

bool escape() { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false); }

std::string folderOf(const Studio& studio) {
    if (!studio.document().path().empty()) return fs::path(studio.document().path()).parent_path().string();
    if (!studio.settings.recent.empty()) return fs::path(studio.settings.recent.front()).parent_path().string();
    return ".";
}

} // namespace

void Dialogs::complaints(Studio& studio) {
    const Studio::Complaint now = studio.complaints.front();
    if (!modal((now.title + "###complaint").c_str(), 34)) return;
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(now.text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
    if (ui::button("Close##close message") || escape()) {
        studio.complaints.pop_front();
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

void Dialogs::unsaved(Studio& studio) {
    if (!studio.document().unsaved()) {
        const auto then = std::exchange(studio.pending, nullptr);
        return then();
    }
    if (!modal("Unsaved changes###unsaved", 30)) return;
    ImGui::PushTextWrapPos(0);
    const std::string& path = studio.document().path();
    ImGui::Text("%s has changes that are not saved.",
                path.empty() ? "This scene" : fs::path(path).filename().string().c_str());
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
    if (ui::button("Save##save first")) {
        ImGui::CloseCurrentPopup();
        studio.save();
    }
    ImGui::SameLine();
    if (ui::button("Don't save##discard")) {
        ImGui::CloseCurrentPopup();
        const auto then = std::exchange(studio.pending, nullptr);
        ImGui::EndPopup();
        return then();
    }
    ImGui::SameLine();
    if (ui::button("Cancel##keep editing") || escape()) {
        ImGui::CloseCurrentPopup();
        studio.pending = nullptr;
    }
    ImGui::EndPopup();
}

void Dialogs::lost(Studio& studio) {
    const Lost found = studio.lost.front();
    if (!modal("Unsaved work was found###lost", 34)) return;
    ImGui::PushTextWrapPos(0);
    const std::string name = found.path.empty() ? "a scene without a name" : found.path;
    if (found.age < 7200)
        ImGui::Text("The editor ended %.0f minutes ago with unsaved changes to %s.", std::max(1.0, found.age / 60),
                    name.c_str());
    else
        ImGui::Text("The editor ended %.0f hours ago with unsaved changes to %s.", found.age / 3600, name.c_str());
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
    const auto done = [&] {
        studio.lost.erase(studio.lost.begin());
        ImGui::CloseCurrentPopup();
    };
    if (ui::button("Recover")) studio.recover(found), done();
    ImGui::SameLine();
    if (ui::button("Later") || escape()) done();
    ui::tip("It is asked again at the next start.");
    ImGui::SameLine();
    if (ui::button("Throw away")) Autosave::discard(found), done();
    ImGui::EndPopup();
}

void Dialogs::import(Studio& studio) {
    static const char* const units[] = {"metres", "centimetres", "millimetres", "inches"};
    static constexpr float factors[] = {1, 0.01f, 0.001f, 0.0254f};
    static const char* const axes[] = {"Y", "Z"};
    static const char* const kinds[] = {"a body that melts", "a collider", "a prop"};
    if (loadingFile_ != studio.importing) {
        loadingFile_ = studio.importing;
        loaded_ = {};
        loading_ = std::async(std::launch::async, [file = studio.importing] {
            Loaded out;
            try {
                const scene::TriMesh mesh = scene::importMesh(file);
                out.bounds = scene::boundsOf(mesh), out.volume = scene::volumeOf(mesh);
                out.triangles = mesh.triangleCount();
            } catch (const std::exception& e) {
                out.error = e.what();
            }
            return out;
        });
    }
    const bool ready = loading_.valid() && loading_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    if (ready) {
        loaded_ = loading_.get();
        if (!loaded_.error.empty()) {
            studio.complain("This mesh cannot be read", studio.importing + ": " + loaded_.error);
            studio.importing.clear(), loadingFile_.clear();
            return;
        }
        // What is larger than a house is likely in other units.
        const scene::Bounds& b = loaded_.bounds;
        const float most = std::max({b.upper.x - b.lower.x, b.upper.y - b.lower.y, b.upper.z - b.lower.z});
        unit_ = most > 20 ? 2 : most > 2 ? 1 : 0;
    }
    if (!modal("Add a mesh###import", 32)) return;
    ImGui::TextUnformatted(fs::path(studio.importing).filename().string().c_str());
    if (loaded_.triangles == 0) {
        ui::quiet("reading ...");
    } else {
        const scene::Bounds& b = loaded_.bounds;
        const float f = 1000 * factors[unit_];
        ui::value("triangles", "%zu", loaded_.triangles);
        ui::field("its unit");
        ImGui::Combo("##unit", &unit_, units, 4);
        ui::note("import unit");
        ui::field("its up axis");
        ImGui::Combo("##up", &up_, axes, 2);
        ui::note("import up");
        ui::value("size", "%.1f x %.1f x %.1f mm", double(f * (b.upper.x - b.lower.x)),
                  double(f * (b.upper.y - b.lower.y)), double(f * (b.upper.z - b.lower.z)));
        const double particles = std::fabs(loaded_.volume) *
                                 std::pow(double(factors[unit_]) / double(studio.scene().world.particleSpacing), 3.0);
        ui::value("particles", "about %.0f", particles);
        if (particles > 60000 && as_ == 0)
            ImGui::TextColored({1, 0.8f, 0.45f, 1},
                               "that is more than runs in real time: a larger spacing\n(World) or a "
                               "smaller unit helps");
        if (particles < 100 && as_ == 0) ImGui::TextColored({1, 0.8f, 0.45f, 1}, "that is too small to melt well");
        ui::field("as");
        ImGui::Combo("##as", &as_, kinds, 3);
        ui::note("import as");
    }
    ImGui::Spacing();
    if (loaded_.triangles > 0 && ui::button("Add##accept import")) {
        scene::Shape shape;
        shape.type = scene::ShapeType::mesh;
        // Absolute until the scene has a folder; saving makes it relative to that.
        fs::path file = fs::absolute(studio.importing).lexically_normal();
        if (!studio.scene().directory.empty() || !studio.document().path().empty()) {
            const fs::path base =
                fs::weakly_canonical(studio.scene().directory.empty() ? "." : studio.scene().directory);
            if (const fs::path relative = file.lexically_relative(base); !relative.empty()) file = relative;
        }
        shape.meshFile = file.generic_string();
        const float factor = factors[unit_];
        const scene::Bounds& b = loaded_.bounds;
        // On the floor, over the origin.
        const float foot = up_ == 0 ? b.lower.y : b.lower.z;
        const thawVec3 at{-0.5f * factor * (b.lower.x + b.upper.x), -factor * foot,
                          up_ == 0 ? -0.5f * factor * (b.lower.z + b.upper.z)
                                   : 0.5f * factor * (b.lower.y + b.upper.y)};
        Item made;
        const bool added = studio.edit("Add mesh", [&](scene::Scene& s) {
            made = as_ == 0 ? addBody(s, shape, at) : as_ == 1 ? addCollider(s, shape, at) : addProp(s, shape, at);
            scene::Placement& p = as_ == 0   ? s.bodies.back().placement
                                  : as_ == 1 ? s.colliders.back().placement
                                             : s.props.back().placement;
            p.scale = factor;
            if (up_ == 1) p.rotation = scene::quatFromDegrees(-90, 0, 0);
        });
        if (added) studio.select(made);
        studio.importing.clear(), loadingFile_.clear();
        ImGui::CloseCurrentPopup();
    }
    if (loaded_.triangles > 0) ImGui::SameLine();
    if (ui::button("Cancel##cancel import") || escape()) {
        studio.importing.clear(), loadingFile_.clear();
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

void Dialogs::exports(Studio& studio, Exporter& exporter) {
    if (exporter.running()) {
        if (!modal("Exporting###export", 30)) return;
        ImGui::ProgressBar(exporter.progress());
        ui::quietf("%d files", exporter.written());
        if (ui::button("Cancel##cancel export") || escape()) {
            exporter.cancel(studio);
            ImGui::CloseCurrentPopup();
        }
        if (!exporter.running()) ImGui::CloseCurrentPopup();
        ImGui::EndPopup();
        return;
    }
    if (!exporting) return;
    if (export_.folder.empty()) export_.folder = (fs::absolute(folderOf(studio)) / "export").string();
    if (!modal("Export###export", 34)) return;
    static const char* const formats[] = {"PLY, with temperature and liquid fraction", "OBJ"};
    ui::field("folder");
    ImGui::InputText("##folder", &export_.folder);
    ui::note("export folder");
    if (ui::button("Choose ...##choose folder")) {
        files_.openFolder("A folder for the export", folderOf(studio),
                          [this](const std::string& path) { export_.folder = path; });
        ImGui::CloseCurrentPopup();
    }
    ui::field("pictures (PNG)");
    ui::toggle("##export pictures", &export_.pictures);
    if (export_.pictures) {
        int size[2] = {export_.width, export_.height};
        ui::field("size");
        if (ImGui::InputInt2("##size", size))
            export_.width = std::clamp(size[0], 16, 8192), export_.height = std::clamp(size[1], 16, 8192);
    }
    ui::field("meshes");
    ui::toggle("##export meshes", &export_.meshes);
    if (export_.meshes) {
        int format = export_.obj ? 1 : 0;
        ui::field("format");
        if (ImGui::Combo("##format", &format, formats, 2)) export_.obj = format == 1;
    }
    ui::field("every");
    ImGui::SliderInt("##every", &export_.every, 1, 60, "%d. frame of 1/60 s", ImGuiSliderFlags_AlwaysClamp);
    if (export_.seconds <= 0) export_.seconds = studio.scene().defaults.seconds;
    ui::field("length");
    ImGui::SliderFloat("##seconds", &export_.seconds, 0.1f, 120, "%.1f s", ImGuiSliderFlags_Logarithmic);
    ui::note("export length");
    ui::quietf("%d steps from the start", int(std::lround(60 * export_.seconds)) / std::max(export_.every, 1) + 1);
    ImGui::Spacing();
    if (ui::button("Export##begin export")) {
        const std::string why = exporter.begin(studio, export_);
        if (why.empty())
            exporting = false;
        else
            studio.complain("This cannot be exported", why), exporting = false;
        ImGui::CloseCurrentPopup();
    }
    ImGui::SameLine();
    if (ui::button("Cancel##no export") || escape()) {
        exporting = false;
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

void Dialogs::keys() {
    if (!shortcuts) return;
    static constexpr const char* const rows[][2] = {{"Q W E R", "select, move, turn, scale"},
                                                    {"P O", "draw a path, a shape"},
                                                    {"H C", "place heat, a collider"},
                                                    {"T A", "paint warmth, soot"},
                                                    {"X I", "erase, probe a particle"},
                                                    {"Space", "play, pause"},
                                                    {"Left, Right", "a frame back, forth"},
                                                    {"Home", "back to the start"},
                                                    {"F", "look at what is chosen, or at all"},
                                                    {"V", "next way to look"},
                                                    {"Right drag", "turn the view (or Alt + left)"},
                                                    {"Shift + right drag", "move the view"},
                                                    {"Wheel", "nearer, farther"},
                                                    {"Ctrl + wheel", "size of the brush"},
                                                    {"[ ]", "radius of the chosen path"},
                                                    {"Ctrl + drag", "in steps, where they are off"},
                                                    {"Del", "delete the node, or what is chosen"},
                                                    {"Ctrl+D", "duplicate"},
                                                    {"Ctrl+Z, Ctrl+Y", "undo, redo"},
                                                    {"Ctrl+N, Ctrl+O", "new, open"},
                                                    {"Ctrl+S, Ctrl+Shift+S", "save, save as"},
                                                    {"Ctrl+I, Ctrl+E", "add a mesh, export"},
                                                    {"Esc", "give up what is being drawn; choose nothing"},
                                                    {"?", "this list"}};
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5f * screen.x, 0.5f * screen.y}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowBgAlpha(0.98f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
    if (ImGui::Begin("Keys", &shortcuts, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse)) {
        for (const auto& row : rows) {
            ImGui::TextColored({1, 0.85f, 0.45f, 1}, "%s", row[0]);
            ImGui::SameLine(12 * ImGui::GetFontSize());
            ImGui::TextUnformatted(row[1]);
        }
    }
    ImGui::End();
    ImGui::PopStyleVar();
}

void Dialogs::show(Studio& studio, Exporter& exporter) {
    if (std::exchange(studio.asksForFile, false))
        files_.open("Open a scene", folderOf(studio), {".json"}, false,
                    [&studio](const std::string& path) { studio.open(path); });
    if (std::exchange(studio.asksForName, false)) {
        const std::string& path = studio.document().path();
        files_.open("Save the scene as", path.empty() ? (fs::path(folderOf(studio)) / "untitled.json").string() : path,
                    {".json"}, true, [&studio](const std::string& to) { studio.saveAs(to); });
    }
    if (std::exchange(studio.asksForMesh, false))
        files_.open("Add a mesh", folderOf(studio), {".obj", ".ply", ".stl", ".gltf", ".glb"}, false,
                    [&studio](const std::string& path) { studio.import(path); });
    const bool asked = files_.isOpen();
    files_.show();
    // Who gives up choosing a name keeps editing.
    if (asked && !files_.isOpen() && studio.document().unsaved() && studio.document().path().empty())
        studio.pending = nullptr;
    keys();
    // One at a time: each would close the other.
    if (!studio.complaints.empty()) return complaints(studio);
    if (files_.isOpen()) return;
    if (!studio.lost.empty()) return lost(studio);
    if (studio.pending) return unsaved(studio);
    if (!studio.importing.empty()) return import(studio);
    exports(studio, exporter);
}

} // namespace thaw::editor
