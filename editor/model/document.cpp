// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "model/document.h"

#include <filesystem>
#include <stdexcept>

namespace thaw::editor {

namespace fs = std::filesystem;

namespace {

std::string directoryOf(const std::string& path) { return fs::path(path).parent_path().string(); }

fs::path whole(const std::string& path) { return fs::weakly_canonical(path.empty() ? fs::path(".") : fs::path(path)); }

template <class F> void forMeshFiles(scene::Scene& s, F&& f) {
    const auto look = [&](scene::Shape& shape) {
        if (shape.type == scene::ShapeType::mesh && !shape.meshFile.empty()) f(shape.meshFile);
    };
    for (scene::Body& b : s.bodies) {
        look(b.shape);
        for (scene::Part& p : b.parts) look(p.shape);
    }
    for (scene::Collider& c : s.colliders) look(c.shape);
    for (scene::FillShape& h : s.shapes) look(h.shape);
    for (scene::Prop& p : s.props) look(p.shape);
}

} // namespace

void moveDirectory(scene::Scene& s, const std::string& directory) {
    const fs::path from = whole(s.directory), to = whole(directory);
    if (from != to)
        forMeshFiles(s, [&](std::string& file) {
            const fs::path place = fs::path(file).is_absolute() ? fs::path(file) : from / file;
            const fs::path relative = place.lexically_normal().lexically_relative(to);
            file = (relative.empty() ? place.lexically_normal() : relative).generic_string();
        });
    s.directory = directory;
}

Document::Document(size_t historyBytes) : limit_(historyBytes) { create(); }

void Document::create() { start({}, {}, true); }

void Document::open(const std::string& path) { start(scene::loadScene(path), path, true); }

void Document::recover(const std::string& text, const std::string& directory, const std::string& path) {
    start(scene::parseScene(text, path, directory), path, false);
}

void Document::start(scene::Scene made, const std::string& path, bool saved) {
    std::string text = scene::writeScene(made);
    std::string directory = made.directory;
    states_.clear();
    states_.push_back({text, {}, std::move(directory)});
    at_ = 0;
    scene_ = std::move(made);
    path_ = path, gesture_.clear();
    savedText_ = saved ? std::move(text) : std::string();
    ++revision_;
}

bool Document::edit(const std::string& what, const std::function<void(scene::Scene&)>& change,
                    const std::string& gesture) {
    scene::Scene changed = scene_;
    change(changed);
    std::string text = scene::writeScene(changed);
    if (text == states_[at_].text) return false;
    changed = scene::parseScene(text, path_, scene_.directory); // throws: it would not be read back
    const bool same = !gesture.empty() && gesture == gesture_ && at_ > 0 && !canRedo();
    if (same) {
        states_[at_].text = std::move(text);
        // Back to where the gesture began: it was none.
        if (states_[at_].text == states_[at_ - 1].text && states_[at_].directory == states_[at_ - 1].directory)
            states_.pop_back(), --at_, gesture_.clear();
    } else {
        states_.resize(at_ + 1);
        states_.push_back({std::move(text), what, scene_.directory});
        ++at_;
        gesture_ = gesture;
    }
    scene_ = std::move(changed);
    ++revision_;
    trim();
    return true;
}

void Document::undo() {
    if (!canUndo()) return;
    show(states_[at_ - 1]);
    --at_;
}

void Document::redo() {
    if (!canRedo()) return;
    show(states_[at_ + 1]);
    ++at_;
}

void Document::show(State& state) {
    scene::Scene shown = scene::parseScene(state.text, path_, state.directory);
    if (state.directory != scene_.directory) { // saved elsewhere since
        moveDirectory(shown, scene_.directory);
        state.text = scene::writeScene(shown), state.directory = shown.directory;
    }
    scene_ = std::move(shown);
    gesture_.clear();
    ++revision_;
}

size_t Document::historyBytes() const {
    size_t sum = 0;
    for (const State& s : states_) sum += s.text.size() + s.what.size() + s.directory.size();
    return sum;
}

void Document::trim() {
    size_t bytes = historyBytes();
    while (bytes > limit_ && at_ > 1) {
        const State& oldest = states_.front();
        bytes -= oldest.text.size() + oldest.what.size() + oldest.directory.size();
        states_.pop_front();
        --at_;
    }
}

void Document::save() {
    if (path_.empty()) throw std::runtime_error("the scene has no file yet");
    saveAs(path_);
}

void Document::saveAs(const std::string& path) {
    scene::Scene moved = scene_;
    moveDirectory(moved, directoryOf(path));
    moved.file = path;
    scene::saveScene(moved, path);
    states_[at_].text = savedText_ = scene::writeScene(moved);
    states_[at_].directory = moved.directory;
    scene_ = std::move(moved);
    path_ = path;
    gesture_.clear();
    ++revision_;
}

} // namespace thaw::editor
