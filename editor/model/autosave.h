// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "model/document.h"
#include "model/settings.h"

#include <string>
#include <vector>

namespace thaw::editor {

/// What an editor that ended without saying so had not saved.
struct Lost {
    std::string file;      // of the autosave
    std::string path;      // of the scene, "" when it had none
    std::string directory; // that mesh files are relative to
    std::string text;      // of the scene
    double age = 0;        // s since it was written
};

/// Keeps a copy of unsaved work beside the settings while the editor runs: one file for each process.
class Autosave {
public:
    explicit Autosave(const Places& places);
    ~Autosave(); // ended as it should: the copy goes

    /// Writes when the document is unsaved and something changed since the last copy, and takes the copy away when all
    /// is saved. "" or why it cannot be written.
    std::string keep(const Document& document);
    /// Of processes that are gone.
    std::vector<Lost> lost() const;
    static void discard(const Lost& lost);

private:
    std::string folder_, file_;
    uint64_t kept_ = 0; // revision
};

} // namespace thaw::editor
