// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

namespace thaw::editor {

/// Colours, roundings, fonts of the current ImGui context. scale: of text and controls.
void applyTheme(float scale);
/// What ImGui's FontGlobalScale is at a scale of 1: fonts are made larger than they are shown, so that they stay sharp.
float fontScale();

} // namespace thaw::editor
