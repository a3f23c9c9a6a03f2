// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

namespace thaw {

// No centre of a particle gets nearer to a wall than this, in spacings.
inline constexpr float kWallStandoff = 0.3f;
// Nor to the surface of what is held, half a spacing outside of the outermost fixed particles.
inline constexpr float kHeldStandoff = 0.3f;
// Nor moves a particle that is nearer already out faster than this many spacings in a step.
inline constexpr float kWallRecovery = 0.2f;

} // namespace thaw
