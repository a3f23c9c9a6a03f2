// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "model/settings.h"
#include "player/scene.h"

#include <string>
#include <vector>

namespace thaw::editor {

/// Materials that an artist keeps for other scenes: each a scene file that holds one material.
std::vector<std::string> ownPresets(const Places& places);
/// Throws scene::InputError.
scene::Material loadPreset(const Places& places, const std::string& name);
/// By its name; one of that name is replaced. Throws std::runtime_error.
void savePreset(const Places& places, const scene::Material& material);

} // namespace thaw::editor
