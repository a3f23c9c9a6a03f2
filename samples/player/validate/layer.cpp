// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "validate/layer.h"

#include <algorithm>
#include <cmath>

namespace thaw::player {

Layer::Layer(const thawMaterialDef& material, float dx, int layers, double slope, int along, int across, bool channel,
             Ground on)
    : lab(dx, along * across * (layers + (on == kHeld ? 5 : 0)) + 1024,
          {0, static_cast<float>(-kG * std::cos(slope)), 0}),
      spacing(static_cast<double>(dx)), length(along * spacing), ground(on) {
    const float w = 0.5f * static_cast<float>(across) * dx, l = static_cast<float>(along) * dx;
    lab.floor(on == kHeld ? -4 * dx : 0);
    if (channel) lab.channel(w);
    const thawMaterialId id = lab.material(material);
    if (on == kHeld) lab.box(id, {-3.5f * dx, -4 * dx, -w}, {l + 0.5f * dx, 0, w}, Lab::kSolid);
    lab.box(id, {0, 0, -w}, {l, static_cast<float>(layers) * dx, w}, Lab::kLiquid);
    // Only now: a liquid body is born with the pressure that it would have at rest, and on a slope it is not.
    thawWorld_SetGravity(lab.world(),
                         {static_cast<float>(kG * std::sin(slope)), static_cast<float>(-kG * std::cos(slope)), 0});
}

Layer::Middle Layer::middle(double at, int window, int side) const {
    const thawParticleView p = lab.particles();
    double volume = 0, flow = 0;
    const auto inside = [&](int i) {
        return !(p.flags[i] & thawParticle_fixed) &&
               std::abs(static_cast<double>(p.positions[4 * i]) - at) < 0.5 * window * spacing &&
               std::abs(static_cast<double>(p.positions[4 * i + 2])) < side * spacing;
    };
    for (int i = 0; i < p.count; ++i)
        if (inside(i)) volume += 1, flow += static_cast<double>(p.velocities[4 * i]);
    Middle m{volume * spacing / (2.0 * window * side), 0, volume > 0 ? flow / volume : 0, 0};
    double n = 0, low = 0;
    for (int i = 0; i < p.count; ++i) {
        const double y = static_cast<double>(p.positions[4 * i + 1]), H = m.thickness;
        if (!inside(i)) continue;
        if (y < 0.95 * spacing) m.first += y, ++low;
        if (y < H - spacing) continue;
        m.surface += static_cast<double>(p.velocities[4 * i]) * H * H /
                     std::max(1e-12, std::min(y, H) * (2 * H - std::min(y, H))),
            ++n;
    }
    if (n > 0) m.surface /= n;
    if (low > 0) m.first /= low;
    return m;
}

} // namespace thaw::player
