// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/file_browser.h"

#include "app/widgets.h"

#include <imgui/imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace thaw::editor {

namespace fs = std::filesystem;

namespace {
std::string lower(std::string text) {
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
}
} // namespace

void FileBrowser::open(const std::string& title, const std::string& start, std::vector<std::string> endings, bool saves,
                       Done done) {
    title_ = title, endings_ = std::move(endings), saves_ = saves, done_ = std::move(done);
    folders_ = false, open_ = appears_ = true, asksToReplace_ = false;
    std::error_code error;
    const fs::path at = fs::absolute(start.empty() ? fs::path(".") : fs::path(start), error);
    if (fs::is_directory(at, error)) {
        name_.clear();
        go(at.string());
    } else {
        name_ = at.filename().string();
        go(at.parent_path().string());
    }
}

void FileBrowser::openFolder(const std::string& title, const std::string& start, Done done) {
    open(title, start, {}, false, std::move(done));
    folders_ = true;
    name_.clear();
}

void FileBrowser::go(const std::string& folder) {
    error_.clear();
    entries_.clear();
    std::error_code error;
    fs::path at = fs::weakly_canonical(folder, error);
    if (error) at = folder;
    folder_ = at.string();
    for (fs::directory_iterator it(at, fs::directory_options::skip_permission_denied, error), end; !error && it != end;
         it.increment(error)) {
        std::error_code none;
        const std::string name = it->path().filename().string();
        if (name.empty() || name[0] == '.') continue;
        const bool isFolder = it->is_directory(none);
        const std::string ending = lower(it->path().extension().string());
        if (!isFolder &&
            (folders_ || (!endings_.empty() && std::find(endings_.begin(), endings_.end(), ending) == endings_.end())))
            continue;
        entries_.push_back({name, isFolder});
    }
    if (error) error_ = error.message();
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
        return a.folder != b.folder ? a.folder : lower(a.name) < lower(b.name);
    });
}

void FileBrowser::finish(const std::string& name) {
    fs::path path = folders_                       ? fs::path(folder_)
                    : fs::path(name).is_absolute() ? fs::path(name)
                                                   : fs::path(folder_) / name;
    std::error_code error;
    if (!folders_) {
        if (name.empty()) return void(error_ = "a name is missing");
        if (fs::is_directory(path, error)) return go(path.string());
        if (saves_ && path.extension().empty() && !endings_.empty()) path += endings_.front();
        if (!saves_ && !fs::exists(path, error)) return void(error_ = path.filename().string() + " is not there");
        if (saves_ && fs::exists(path, error) && !asksToReplace_) return void(asksToReplace_ = true);
    }
    open_ = false;
    ImGui::CloseCurrentPopup();
    done_(path.string());
}

void FileBrowser::show() {
    if (!open_) return;
    const std::string id = title_ + "###file browser";
    if (appears_) ImGui::OpenPopup(id.c_str()), appears_ = false;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float font = ImGui::GetFontSize();
    ImGui::SetNextWindowSize({std::min(44 * font, screen.x - 20), std::min(32 * font, screen.y - 20)},
                             ImGuiCond_Appearing);
    ImGui::SetNextWindowPos({0.5f * screen.x, 0.5f * screen.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
    if (!ImGui::BeginPopupModal(id.c_str(), nullptr)) {
        open_ = false;
        return;
    }
    if (ui::button("Up")) go(fs::path(folder_).parent_path().string());
    ImGui::SameLine();
    ImGui::TextUnformatted(folder_.c_str());
    const float below = 3.2f * ImGui::GetFrameHeightWithSpacing();
    ImGui::BeginChild("entries", {0, -below}, true);
    std::string entered, chosen;
    for (const Entry& e : entries_) {
        const std::string label = e.folder ? e.name + "/" : e.name;
        if (ImGui::Selectable(label.c_str(), e.name == name_, ImGuiSelectableFlags_AllowDoubleClick)) {
            asksToReplace_ = false;
            if (e.folder) {
                if (ImGui::IsMouseDoubleClicked(0)) entered = e.name;
            } else {
                name_ = e.name;
                if (ImGui::IsMouseDoubleClicked(0)) chosen = e.name;
            }
        }
        ui::note("file " + e.name);
    }
    if (entries_.empty()) ui::quiet(error_.empty() ? "nothing here" : error_.c_str());
    ImGui::EndChild();
    if (!entered.empty()) go((fs::path(folder_) / entered).string());
    bool accept = !chosen.empty();
    if (!folders_) {
        ImGui::SetNextItemWidth(-1);
        // A name can be typed at once.
        if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
        if (ImGui::InputTextWithHint("##name", "file name", &name_, ImGuiInputTextFlags_EnterReturnsTrue))
            accept = true;
        if (ImGui::IsItemEdited()) asksToReplace_ = false;
        ui::note("file name");
    }
    if (!error_.empty()) ImGui::TextColored({1, 0.55f, 0.45f, 1}, "%s", error_.c_str());
    if (asksToReplace_) ImGui::TextColored({1, 0.8f, 0.45f, 1}, "%s is there already", name_.c_str());
    const char* word = asksToReplace_ ? "Replace it##replace"
                       : saves_       ? "Save##accept"
                       : folders_     ? "Choose##accept"
                                      : "Open##accept";
    if (ui::button(word)) accept = true;
    ImGui::SameLine();
    if (ui::button("Cancel##cancel") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
        open_ = false;
        ImGui::CloseCurrentPopup();
    } else if (accept) {
        finish(chosen.empty() ? name_ : chosen);
    }
    ImGui::EndPopup();
}

} // namespace thaw::editor
