// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "particles/material.h"

#include <cstdint>

namespace thaw {

// Whether a particle turns to vapour in a step of so many seconds of heat. The dice are a hash of who and when: the
// same on any number of threads, and in a replay. What goes takes its enthalpy along, so it must have the heat of
// vapour.
inline bool turnsToVapour(const Material& m, double enthalpy, uint32_t id, uint64_t step, double seconds) {
    const thawMaterialDef& d = m.def;
    if (!(d.burnTemperature > 0) || enthalpy < m.enthalpy(d.burnTemperature) + static_cast<double>(d.vapourHeat))
        return false;
    const uint64_t hash = hashCombine(hashCombine(hashCombine(0x766170ULL, id), step), 0x6f7572ULL);
    const float dice = static_cast<float>(hash >> 40) * 0x1p-24f;
    return dice < 1 - detExp(static_cast<float>(-d.burnRate * seconds));
}

} // namespace thaw
