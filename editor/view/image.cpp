// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "view/image.h"

#include "view/font.h"
#include "view/part_file.h"
#include "view/png.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

namespace thaw::view {

bool writePng(const std::string& path, const Image& image, std::string& error) {
    if (image.width < 1 || image.height < 1) return error = "cannot write " + path + ": the picture is empty", false;
    PartFile place(path);
    std::FILE* file = std::fopen(place.part().c_str(), "wb");
    if (!file) return error = "cannot write " + path, false;
    const bool opaque = std::all_of(image.pixels.begin(), image.pixels.end(), [](Rgba c) { return c.a == 255; });
    const PngBytes data = packedPng(image, {0, 0, image.width, image.height}, opaque ? 3 : 4);
    startPng(file, image.width, image.height, opaque ? 3 : 4);
    writePngChunk(file, "IDAT", data);
    writePngChunk(file, "IEND", {});
    const bool bad = data.empty() || std::ferror(file) != 0;
    if (std::fclose(file) != 0 || bad) return error = "cannot write " + path, false;
    return place.moveToPlace(error);
}

std::optional<Image> readPng(const std::string& path, std::string& error) {
    int width = 0, height = 0, channels = 0;
    unsigned char* data = stbi_load(path.c_str(), &width, &height, &channels, 4);
    if (!data) {
        const char* why = stbi_failure_reason();
        error = "cannot read " + path + ": " + (why ? why : "unknown");
        return std::nullopt;
    }
    Image image(width, height);
    static_assert(sizeof(Rgba) == 4);
    std::memcpy(image.pixels.data(), data, image.pixels.size() * 4);
    stbi_image_free(data);
    return image;
}

static void over(Rgba& below, Rgba top) {
    if (top.a == 255) return void(below = top);
    const auto mix = [&](int b, int t) { return static_cast<uint8_t>((b * (255 - top.a) + t * top.a + 127) / 255); };
    // Alpha of the result, so that text may be laid on an empty picture that is blended later.
    const int alpha = top.a + below.a * (255 - top.a) / 255;
    if (below.a == 255)
        below = {mix(below.r, top.r), mix(below.g, top.g), mix(below.b, top.b), 255};
    else if (alpha > 0) {
        const auto unmultiplied = [&](int b, int t) {
            return static_cast<uint8_t>((t * top.a + b * below.a * (255 - top.a) / 255) / alpha);
        };
        below = {unmultiplied(below.r, top.r), unmultiplied(below.g, top.g), unmultiplied(below.b, top.b),
                 static_cast<uint8_t>(alpha)};
    }
}

void blend(Image& image, const Image& part, int x, int y) {
    for (int j = std::max(0, -y); j < std::min(part.height, image.height - y); ++j)
        for (int i = std::max(0, -x); i < std::min(part.width, image.width - x); ++i)
            over(image.at(x + i, y + j), part.at(i, j));
}

void fillRectangle(Image& image, int x, int y, int width, int height, Rgba color) {
    for (int j = std::max(0, y); j < std::min(image.height, y + height); ++j)
        for (int i = std::max(0, x); i < std::min(image.width, x + width); ++i) over(image.at(i, j), color);
}

// One byte a character; the degree sign (C2 B0) becomes 127, other bytes beyond ASCII '?'.
static std::string toGlyphs(std::string_view text) {
    std::string out;
    for (size_t i = 0; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]);
        if (c == 0xC2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) == 0xB0)
            out += '\x7f', ++i;
        else if (c >= 0x80) {
            out += '?';
            while (i + 1 < text.size() && (static_cast<unsigned char>(text[i + 1]) & 0xC0) == 0x80) ++i;
        } else
            out += c < 32 ? ' ' : static_cast<char>(c);
    }
    return out;
}

int textWidth(std::string_view text, int scale) {
    const size_t n = toGlyphs(text).size();
    return n ? (static_cast<int>(n) * kGlyphAdvance - 1) * scale : 0;
}

int textHeight(int scale) { return kGlyphHeight * scale; }

// Where two set pixels meet at a corner only, the two empty ones beside them get half the colour in a triangle: large
// text loses its stairs, at scale 1 nothing changes.
static float glyphCoverage(unsigned char c, int column, int row, float u, float v) {
    if (glyphBit(c, column, row)) return 1;
    const int dx = u < 0.5f ? -1 : 1, dy = v < 0.5f ? -1 : 1;
    if (glyphBit(c, column + dx, row) && glyphBit(c, column, row + dy) && !glyphBit(c, column + dx, row + dy)) {
        const float a = std::fabs(u - 0.5f) + std::fabs(v - 0.5f);
        return a > 0.5f ? 1.0f : 0.0f;
    }
    return 0;
}

void drawText(Image& image, int x, int y, std::string_view text, int scale, Rgba color) {
    scale = std::max(scale, 1);
    int penX = x;
    for (const char c : toGlyphs(text)) {
        const auto glyph = static_cast<unsigned char>(c);
        for (int j = 0; j < kGlyphHeight * scale; ++j)
            for (int i = 0; i < kGlyphWidth * scale; ++i) {
                const int px = penX + i, py = y + j;
                if (px < 0 || py < 0 || px >= image.width || py >= image.height) continue;
                float cover = 0;
                if (scale == 1)
                    cover = glyphBit(glyph, i, j) ? 1 : 0;
                else
                    for (int s = 0; s < 4; ++s) {
                        const float u = (i + 0.25f + 0.5f * (s & 1)) / scale, v = (j + 0.25f + 0.5f * (s >> 1)) / scale;
                        cover += 0.25f * glyphCoverage(glyph, int(u), int(v), u - std::floor(u), v - std::floor(v));
                    }
                if (cover > 0) {
                    Rgba top = color;
                    top.a = static_cast<uint8_t>(color.a * cover + 0.5f);
                    over(image.at(px, py), top);
                }
            }
        penX += kGlyphAdvance * scale;
    }
}

Image contactSheet(const std::vector<CaptionedImage>& parts, int columns, std::string_view title) {
    if (parts.empty()) return {};
    int cellWidth = 0, cellHeight = 0;
    bool captions = false;
    for (const CaptionedImage& part : parts) {
        cellWidth = std::max(cellWidth, part.image.width);
        cellHeight = std::max(cellHeight, part.image.height);
        captions = captions || !part.caption.empty();
    }
    const int count = static_cast<int>(parts.size());
    if (columns < 1) columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
    columns = std::min(columns, count);
    const int rows = (count + columns - 1) / columns;
    const int scale = cellWidth >= 300 ? 2 : 1, gap = 6 * scale;
    const int captionHeight = captions ? textHeight(scale) + 3 * scale : 0;
    const int head = title.empty() ? gap : gap + textHeight(scale + 1) + gap;
    const Rgba paper{24, 24, 27, 255}, ink{226, 224, 218, 255};
    Image sheet(gap + columns * (cellWidth + gap), head + rows * (cellHeight + captionHeight + gap), paper);
    if (!title.empty()) drawText(sheet, gap, gap, title, scale + 1, ink);
    for (int i = 0; i < count; ++i) {
        const CaptionedImage& part = parts[static_cast<size_t>(i)];
        const int x = gap + (i % columns) * (cellWidth + gap);
        const int y = head + (i / columns) * (cellHeight + captionHeight + gap);
        blend(sheet, part.image, x, y);
        drawText(sheet, x + scale, y + cellHeight + 3 * scale, part.caption, scale, ink);
    }
    return sheet;
}

ImageDifference compare(const Image& a, const Image& b, int tolerance) {
    ImageDifference result;
    if (a.width != b.width || a.height != b.height) {
        result.maxChannel = 255, result.shareOver = 1, result.meanAbsolute = 255;
        return result;
    }
    result.sameSize = true;
    result.picture = Image(a.width, a.height);
    size_t over = 0;
    double sum = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        const Rgba p = a.pixels[i], q = b.pixels[i];
        const int r = std::abs(p.r - q.r), g = std::abs(p.g - q.g), bl = std::abs(p.b - q.b);
        const int most = std::max({r, g, bl});
        sum += r + g + bl;
        result.maxChannel = std::max(result.maxChannel, most);
        const auto grey = static_cast<uint8_t>((p.r * 54 + p.g * 183 + p.b * 19) / 256 / 3);
        if (most > tolerance) {
            ++over;
            result.picture.pixels[i] = {static_cast<uint8_t>(128 + most / 2), grey, grey, 255};
        } else
            result.picture.pixels[i] = {grey, grey, grey, 255};
    }
    if (!a.pixels.empty()) {
        result.shareOver = static_cast<double>(over) / static_cast<double>(a.pixels.size());
        result.meanAbsolute = sum / (3.0 * static_cast<double>(a.pixels.size()));
    }
    return result;
}

} // namespace thaw::view
