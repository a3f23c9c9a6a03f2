// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// The parts of a PNG file (PNG specification, third edition), of which stills and animations are made.
#pragma once

#include "view/image.h"

#include <cstdio>

namespace thaw::view {

using PngBytes = std::vector<uint8_t>;

struct Rectangle {
    int x = 0, y = 0, width = 0, height = 0;
};

/// The most significant of so many bytes first.
void putPngNumber(PngBytes& out, uint32_t value, int bytes);
/// Signature and header. channels: 3 without alpha, 4 with it.
void startPng(std::FILE* file, int width, int height, int channels);
void writePngChunk(std::FILE* file, const char* type, const PngBytes& data);
/// Filtered and deflated rows of a part of a picture, behind `head` bytes of room. Empty when that fails.
PngBytes packedPng(const Image& image, const Rectangle& part, int channels, size_t head = 0);

} // namespace thaw::view
