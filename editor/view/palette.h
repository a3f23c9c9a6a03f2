// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include "view/image.h"

namespace thaw::view {

/// Counts the colours of pictures, and finds the few that stand for them best.
class ColorCount {
public:
    ColorCount();
    void add(const Image& image);
    /// At most this many: boxes of colours, split where they differ most from their mean (after Wu, Graphics Gems II).
    std::vector<Rgba> palette(size_t most) const;

private:
    static constexpr int kBits = 6; // of a channel
    struct Bin {
        uint64_t count = 0, sum[3] = {};
    };
    std::vector<Bin> bins_;
};

/// Indices of the colours of a palette for a picture, with an ordered pattern where they do not fit: what does not
/// change from picture to picture keeps its indices.
class Dither {
public:
    /// The palette holds 1 to 256 colours.
    explicit Dither(std::vector<Rgba> palette);
    std::vector<uint8_t> indices(const Image& image);

private:
    uint8_t nearest(int r, int g, int b);
    std::vector<Rgba> palette_;
    std::vector<int16_t> known_; // of colours of 6 bits a channel; -1: not asked for yet
};

} // namespace thaw::view
