// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "control/control.h"

namespace thaw {

double Control::track(const ControlFrame& f) {
    if (paths_.any()) paths_.track(f);
    if (!shapes_.any()) return 0;
    shapes_.track(f, paths_.paths);
    return shapes_.cool(f);
}

Guide Control::guide(const ControlFrame& f) {
    const size_t padded = static_cast<size_t>(8 * f.neighbors.moverGroups);
    guide_.assign(padded, {});
    Guide guide{guide_.data()};
    if (paths_.any()) paths_.guide(f, guide.drag);
    if (!shapes_.any()) return guide;
    free_.assign(padded, {}), guide.free = free_.data();
    if (shapes_.hold()) {
        rim_.assign(padded, {0, 0, 0, INFINITY}), guide.rim = rim_.data();
        if (shapes_.move(f)) rimVelocity_.assign(padded, {}), guide.rimVelocity = rimVelocity_.data();
    }
    shapes_.guide(f, guide);
    return guide;
}

} // namespace thaw
