// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "heat/frame.h"

namespace thaw {

// What a row exchanges with walls that have a temperature: conductance x (temperature - its own), W.
struct WallContact {
    float conductance = 0; // W/K, 0 where no such wall is touched
    float temperature = 0; // K, mean of the walls by conductance
    float covered = 1;     // share of the support that the walls leave free
};

// Finds who touches a wall with a temperature. The wall and the half layer of melt between it and the particle's centre
// conduct in series, 1 / (1 / h + d / k), over the area that the particle has against the wall. Areas of the layers
// along a wall add up to that of the wall, wherever the first layer rests.
class Contact {
public:
    explicit Contact(Allocator& allocator) : rows_(allocator) {}

    static bool any(const Collider* colliders, int count); // some wall has a temperature
    // Per row; null when nothing touches such a wall.
    const WallContact* find(const HeatFrame& f);

private:
    Array<WallContact> rows_;
};

} // namespace thaw
