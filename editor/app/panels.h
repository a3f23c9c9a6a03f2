// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "app/studio.h"
#include "app/viewport.h"

namespace thaw::editor {

/// Each fills the current ImGui window.
void showToolbar(Studio& studio);
void showOutliner(Studio& studio);
/// What can be added, as entries of a menu.
void showAddMenu(Studio& studio);
void showInspector(Studio& studio);
void showMaterial(Studio& studio, int material);
void showPath(Studio& studio, size_t path);
void showShape(Studio& studio, size_t shape);
void showToolSettings(Studio& studio);
void showViewPanel(Studio& studio, Viewport& viewport);
void showParticle(Studio& studio);
void showTransport(Studio& studio);
void showGraphs(Studio& studio, const Viewport& viewport);
void showPlan(Studio& studio);
void showStatus(Studio& studio);
/// Letters that choose tools. True when one was pressed.
bool toolShortcuts(Studio& studio);

} // namespace thaw::editor
