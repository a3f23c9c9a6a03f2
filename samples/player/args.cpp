// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "args.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <thread>

namespace thaw::player {

using scene::InputError;
using scene::oneLine;

namespace {
std::string plain(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.10g", value);
    return text;
}
} // namespace

void checkRange(const std::string& name, double value, double lower, double upper, const char* unit) {
    if (value >= lower && value <= upper) return;
    throw InputError(name + ": must be in " + plain(lower) + ".." + plain(upper) + (*unit ? " " : "") + unit +
                     ", got " + plain(value));
}

std::vector<double> parseNumbers(const std::string& name, const std::string& text, double lower, double upper,
                                 const char* unit, size_t minCount, size_t maxCount) {
    std::vector<double> out;
    size_t at = 0;
    while (at <= text.size()) {
        const size_t comma = std::min(text.find(',', at), text.size());
        const std::string part = text.substr(at, comma - at);
        double value = 0.0;
        const auto result = std::from_chars(part.data(), part.data() + part.size(), value);
        if (result.ec != std::errc() || result.ptr != part.data() + part.size())
            throw InputError(name + ": must be numbers with commas between them, got '" + oneLine(text, 60) + "'");
        checkRange(name, value, lower, upper, unit);
        out.push_back(value);
        at = comma + 1;
    }
    if (out.size() < minCount || out.size() > maxCount)
        throw InputError(name + ": must be " + std::to_string(minCount) +
                         (minCount == maxCount ? "" : " to " + std::to_string(maxCount)) + " numbers, got " +
                         std::to_string(out.size()));
    return out;
}

PictureSize parseSize(const std::string& name, const std::string& text) {
    PictureSize size;
    const char* end = text.data() + text.size();
    const auto w = std::from_chars(text.data(), end, size.width);
    if (w.ec == std::errc() && w.ptr != end && *w.ptr == 'x') {
        const auto h = std::from_chars(w.ptr + 1, end, size.height);
        if (h.ec == std::errc() && h.ptr == end) {
            checkRange(name + " width", size.width, 16, 8192, "pixels");
            checkRange(name + " height", size.height, 16, 8192, "pixels");
            return size;
        }
    }
    throw InputError(name + ": must look like 960x540, got '" + oneLine(text, 60) + "'");
}

int defaultThreads() { return std::clamp(int(std::thread::hardware_concurrency()), 1, 4); }

void makeFolder(const std::string& path) {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (!std::filesystem::is_directory(path, error)) throw RunError(oneLine(path, 400) + ": cannot be made a folder");
}

} // namespace thaw::player
