// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "app/exporter.h"
#include "app/file_browser.h"
#include "app/studio.h"

#include <future>
#include <memory>

namespace thaw::editor {

/// Windows that lie over everything, while there is a reason for them.
class Dialogs {
public:
    void show(Studio& studio, Exporter& exporter);
    bool shortcuts = false; // the overlay of keys
    bool exporting = false; // the export window

private:
    void complaints(Studio& studio);
    void unsaved(Studio& studio);
    void lost(Studio& studio);
    void import(Studio& studio);
    void exports(Studio& studio, Exporter& exporter);
    void keys();

    struct Loaded {
        scene::Bounds bounds;
        double volume = 0;
        size_t triangles = 0;
        std::string error;
    };
    FileBrowser files_;
    std::string loadingFile_;
    std::future<Loaded> loading_;
    Loaded loaded_;
    int unit_ = 0, up_ = 0, as_ = 0;
    ExportSettings export_;
};

} // namespace thaw::editor
