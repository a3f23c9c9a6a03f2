// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

namespace thaw::view {

constexpr int kGlyphWidth = 5, kGlyphHeight = 9; // pixels of the built-in font; 7 rows above the baseline, 2 below
constexpr int kGlyphAdvance = 6;                 // to the next character

/// Whether a pixel of the built-in font is set. Characters 32..126, and 127 for the degree sign; others are blank.
bool glyphBit(unsigned char character, int column, int row);

} // namespace thaw::view
