// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace thaw::editor {

/// Where the editor keeps what is not part of a scene.
struct Places {
    std::string config; // settings.json, presets/
    std::string state;  // autosave/
};
/// By the XDG rules: XDG_CONFIG_HOME and XDG_STATE_HOME, or below HOME; below the temporary folder where there is none.
Places standardPlaces();

/// What survives a restart.
struct Settings {
    float outlinerWidth = 230, inspectorWidth = 330, lowerHeight = 210; // points, at a scale of 1
    int windowWidth = 1440, windowHeight = 900;                         // pixels
    float scale = 1;                                                    // of text and controls, range 0.5..4
    float snapStep = 0.005f, snapDegrees = 15;                          // m, degrees
    bool snap = false;
    bool showTimeline = false;       // of the threads
    std::vector<std::string> recent; // scene files, the newest first

    /// Puts a file at the head of recent; at most 12 stay.
    void remember(const std::string& file);
};
/// Defaults for what is missing or out of range; a file that cannot be read at all gives the defaults.
Settings loadSettings(const Places& places);
/// False when they cannot be written; the old ones are then whole.
bool saveSettings(const Places& places, const Settings& settings);

} // namespace thaw::editor
