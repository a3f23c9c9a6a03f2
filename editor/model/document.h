// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "player/scene.h"

#include <cstdint>
#include <deque>
#include <functional>
#include <string>

namespace thaw::editor {

/// The scene that is edited, with everything that it was before, and its file.
///
/// A state is the scene's text, as it would be saved: undo brings back the same scene bit for bit, an edit that makes
/// the scene what it was is none, and what would not be read back is never let in.
class Document {
public:
    /// An empty scene without a file. historyBytes: of the texts that undo keeps; the oldest go first, the newest two
    /// stay.
    explicit Document(size_t historyBytes = size_t{256} << 20);

    const scene::Scene& scene() const { return scene_; }
    /// Another number after every edit, undo, redo and file: who shows the scene looks at it.
    uint64_t revision() const { return revision_; }

    /// Changes the scene. what: in words, for the menu ("Move candle"). Edits that follow one another with the same
    /// gesture, not empty, are one (a drag), until endGesture or another edit. Throws scene::InputError when the scene
    /// would not be valid, and has then changed nothing. False when it is what it was.
    bool edit(const std::string& what, const std::function<void(scene::Scene&)>& change,
              const std::string& gesture = {});
    void endGesture() { gesture_.clear(); }

    bool canUndo() const { return at_ > 0; }
    bool canRedo() const { return at_ + 1 < states_.size(); }
    /// What undo would take back and redo bring again; "" when there is nothing.
    std::string undoText() const { return canUndo() ? states_[at_].what : std::string(); }
    std::string redoText() const { return canRedo() ? states_[at_ + 1].what : std::string(); }
    void undo();
    void redo();
    size_t historyBytes() const;

    /// The file, "" before the first save.
    const std::string& path() const { return path_; }
    /// Whether the scene differs from its file, or from an empty one without a file.
    bool unsaved() const { return states_[at_].text != savedText_; }
    /// An empty scene without a file.
    void create();
    /// Throws scene::InputError; everything then is as it was.
    void open(const std::string& path);
    /// Takes a scene that was saved by itself after a crash; it is unsaved.
    void recover(const std::string& text, const std::string& directory, const std::string& path);
    /// Into its file, or another one, which then is its file: mesh files are named relative to that. Throws
    /// std::runtime_error with the reason; the file is then what it was before, and the document unsaved.
    void save();
    void saveAs(const std::string& path);

private:
    struct State {
        std::string text, what;
        std::string directory; // that its mesh files are relative to
    };
    void start(scene::Scene scene, const std::string& path, bool saved);
    void show(State& state);
    void trim();

    size_t limit_;
    scene::Scene scene_;
    std::deque<State> states_;
    size_t at_ = 0;
    std::string gesture_, path_, savedText_;
    uint64_t revision_ = 0;
};

/// Names mesh files relative to another directory, so that they are the same files.
void moveDirectory(scene::Scene& scene, const std::string& directory);

} // namespace thaw::editor
