// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "thaw/thaw.h"

namespace thaw {

// In every definition that a thawInit function filled.
inline constexpr uint32_t kDefCookie = 0x77616874; // "thaw"

thawMaterialDef materialPreset(thawMaterialPreset preset);
const char* materialPresetName(thawMaterialPreset preset);

} // namespace thaw
