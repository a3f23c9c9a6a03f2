// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "view/part_file.h"

#include <filesystem>

namespace thaw::view {

PartFile::PartFile(std::string path) : path_(std::move(path)) {
    const std::filesystem::path place(path_);
    part_ = (place.parent_path() / (place.stem().string() + ".part" + place.extension().string())).string();
}

PartFile::~PartFile() {
    std::error_code ignored;
    if (!part_.empty()) std::filesystem::remove(part_, ignored);
}

bool PartFile::moveToPlace(std::string& error) {
    std::error_code why;
    std::filesystem::rename(part_, path_, why);
    if (why) return error = "cannot write " + path_ + ": " + why.message(), false;
    part_.clear();
    return true;
}

} // namespace thaw::view
