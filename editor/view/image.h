// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace thaw::view {

struct Rgba {
    uint8_t r = 0, g = 0, b = 0, a = 255;
    bool operator==(const Rgba&) const = default;
};

/// A picture in sRGB, 8 bits a channel, rows from the top.
struct Image {
    int width = 0, height = 0;
    std::vector<Rgba> pixels; // width * height

    Image() = default;
    Image(int w, int h, Rgba fill = {0, 0, 0, 255}) : width(w), height(h), pixels(size_t(w) * size_t(h), fill) {}

    /// x in 0..width-1, y in 0..height-1, not checked.
    Rgba& at(int x, int y) { return pixels[size_t(y) * size_t(width) + size_t(x)]; }
    const Rgba& at(int x, int y) const { return pixels[size_t(y) * size_t(width) + size_t(x)]; }
};

/// False, with the reason in error, when the file cannot be written; one that was there is whole then.
bool writePng(const std::string& path, const Image& image, std::string& error);
/// nullopt, with the reason in error, when there is no such file or it is no picture.
std::optional<Image> readPng(const std::string& path, std::string& error);

/// Lays part over image with its alpha; what lies outside is cut off.
void blend(Image& image, const Image& part, int x, int y);
/// Fills a rectangle; what lies outside is cut off.
void fillRectangle(Image& image, int x, int y, int width, int height, Rgba color);

/// Pixels that drawText takes at a scale (1 = a font 5 x 7).
int textWidth(std::string_view text, int scale);
int textHeight(int scale);
/// Text in the built-in font from its upper left corner. ASCII 32..126 and the degree sign in UTF-8.
void drawText(Image& image, int x, int y, std::string_view text, int scale, Rgba color);

struct CaptionedImage {
    Image image;
    std::string caption; // "t = 2.0 s"; may be empty
};
/// All pictures in a grid, each over its caption. columns 0: as square as it gets. Cells take the size of the largest.
/// An empty list gives an empty image.
Image contactSheet(const std::vector<CaptionedImage>& parts, int columns = 0, std::string_view title = {});

/// How much two pictures differ.
struct ImageDifference {
    bool sameSize = false;
    int maxChannel = 0;      // largest difference of any of red, green, blue; 0..255
    double shareOver = 0;    // 0..1, pixels with a channel that differs by more than the tolerance
    double meanAbsolute = 0; // 0..255, over all channels
    Image picture;           // where: grey for equal, red for more than the tolerance
};
/// tolerance in 0..255. Sizes that differ give sameSize = false, maxChannel 255 and shareOver 1.
ImageDifference compare(const Image& a, const Image& b, int tolerance);

} // namespace thaw::view
