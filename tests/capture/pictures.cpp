// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "pictures.h"

#include <algorithm>
#include <filesystem>

namespace thaw::test {

Mean meanOf(const view::Image& image, double x0, double y0, double x1, double y1) {
    Mean mean;
    const int left = int(x0 * image.width), right = std::max(left + 1, int(x1 * image.width));
    const int top = int(y0 * image.height), bottom = std::max(top + 1, int(y1 * image.height));
    for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x) {
            const view::Rgba p = image.at(x, y);
            mean.r += p.r, mean.g += p.g, mean.b += p.b;
        }
    const double n = double(right - left) * (bottom - top);
    return {mean.r / n, mean.g / n, mean.b / n};
}

std::string artefact(const char* name) {
    const std::filesystem::path folder = std::filesystem::path(THAW_BINARY_DIR) / "capture-artefacts";
    std::filesystem::create_directories(folder);
    return (folder / name).string();
}

} // namespace thaw::test
