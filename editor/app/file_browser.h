// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace thaw::editor {

/// A window to choose a file to read or to write.
class FileBrowser {
public:
    using Done = std::function<void(const std::string& path)>;
    /// endings: ".json", ...; empty: all files. saves: a name may be typed that is not there, and one that is there is
    /// asked about; the first ending is added where there is none.
    void open(const std::string& title, const std::string& start, std::vector<std::string> endings, bool saves,
              Done done);
    /// Folders only.
    void openFolder(const std::string& title, const std::string& start, Done done);
    void show();
    bool isOpen() const { return open_; }

private:
    struct Entry {
        std::string name;
        bool folder = false;
    };
    void go(const std::string& folder);
    void finish(const std::string& name);

    bool open_ = false, appears_ = false, saves_ = false, folders_ = false, asksToReplace_ = false;
    std::string title_, folder_, name_, error_;
    std::vector<std::string> endings_;
    std::vector<Entry> entries_;
    Done done_;
};

} // namespace thaw::editor
