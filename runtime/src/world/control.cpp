// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// What the world does with the paths of its host.
#include "world/world.h"

namespace thaw {

ControlFrame World::controlFrame(float dt) {
    return {particles, neighbors_, colliders.data(), static_cast<int>(colliders.size()),
            tasks,     dt,         steps_,           {def.gravity.x, def.gravity.y, def.gravity.z}};
}

thawResult World::setPath(const thawPathDef& d, std::string& message, uint32_t& index1) {
    size_t slot = 0;
    if (index1 > 0) {
        slot = index1 - 1;
    } else {
        while (slot < paths_.paths.size() && paths_.paths[slot].alive) ++slot;
        if (slot >= static_cast<size_t>(def.maxPaths)) {
            message = "maxPaths: all " + std::to_string(def.maxPaths) + " paths of the world are in use";
            return thawResult_capacity;
        }
    }
    const float reach = d.reach > 0 ? d.reach : 2 * d.radius;
    PathLine line;
    std::vector<Vec3> points;
    for (int32_t k = 0; k < d.pointCount; ++k) points.push_back({d.points[k].x, d.points[k].y, d.points[k].z});
    if (!line.make(points.data(), points.size(), d.smooth, d.radius, reach, message)) return thawResult_invalidArgument;
    if (paths_.paths.size() <= slot) {
        paths_.paths.reserve(slot + 1), pathSlots.reserve(slot + 1), spots_.reserve(slot + 1);
        paths_.paths.resize(slot + 1), pathSlots.resize(slot + 1);
    }
    Path& path = paths_.paths[slot];
    if (index1 == 0) {
        path = {};
        pathSlots[slot].take();
        index1 = static_cast<uint32_t>(slot) + 1;
    }
    path.alive = true, path.enabled = d.enabled, path.line = std::move(line), path.collider = d.collider.index1;
    path.radius = d.radius, path.reach = reach, path.strength = d.strength, path.speed = d.speed,
    path.arrivalTime = d.arrivalTime;
    path.share = d.share, path.startAbsorptivity = d.startAbsorptivity, path.priority = d.priority;
    // What follows it was somewhere else along the line as it was.
    for (int i = 0; i < particles.count; ++i) {
        const size_t k = static_cast<size_t>(i);
        if (particles.follows[k] != slot + 1) continue;
        Foot foot;
        if (path.line.nearest(PathSpace(path, colliders.data()).into(particles.position[k].xyz()), foot))
            particles.along[k] = foot.along;
        else
            particles.follows[k] = 0;
    }
    return thawResult_ok;
}

void World::removePath(uint32_t index) {
    paths_.forget(particles, index);
    paths_.paths[index] = {};
    pathSlots[index].alive = false;
}

thawPathState World::pathState(uint32_t index) const {
    const Path& p = paths_.paths[index];
    const auto f = [](double v) { return static_cast<float>(v); };
    return {p.line.length(),  f(p.mass),     f(p.captured), f(p.arrived),
            f(p.spilled),     f(p.distance), p.front,       p.arrival < 0 ? NAN : f(p.arrival),
            p.asked + p.boost};
}

} // namespace thaw
