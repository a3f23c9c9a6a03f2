// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include <string>

namespace thaw::view {

/// A file that is written beside its place and put there when it is whole: what stood there before stays until then,
/// and stays for good when the new one never gets finished.
class PartFile {
public:
    /// Nothing is opened; write to part(). It has the ending of path, which some programs go by.
    explicit PartFile(std::string path);
    ~PartFile(); // removes the part, unless it was moved
    PartFile(const PartFile&) = delete;
    PartFile& operator=(const PartFile&) = delete;

    const std::string& part() const { return part_; }
    /// False, with the reason in error, when the part is not there or cannot be moved.
    bool moveToPlace(std::string& error);

private:
    std::string path_, part_;
};

} // namespace thaw::view
