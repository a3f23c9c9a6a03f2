// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// What the world does with the paths and shapes of its host.
#include "motion/carry.h"
#include "world/world.h"

namespace thaw {

ControlFrame World::controlFrame(float dt) {
    return {particles,
            neighbors_,
            colliders.data(),
            static_cast<int>(colliders.size()),
            wallVersion_,
            materials.data(),
            tasks,
            dt,
            steps_,
            {def.gravity.x, def.gravity.y, def.gravity.z},
            def.particleSpacing};
}

thawResult World::setPath(const thawPathDef& d, std::string& message, uint32_t& index1) {
    size_t slot = 0;
    if (index1 > 0) {
        slot = index1 - 1;
    } else {
        while (slot < control_.paths().size() && control_.paths()[slot].alive) ++slot;
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
    if (control_.paths().size() <= slot) {
        control_.paths().reserve(slot + 1), pathSlots.reserve(slot + 1), spots_.reserve(slot + 1);
        control_.paths().resize(slot + 1), pathSlots.resize(slot + 1);
    }
    Path& path = control_.paths()[slot];
    if (index1 == 0) {
        path = {};
        pathSlots[slot].take();
        index1 = static_cast<uint32_t>(slot) + 1;
    }
    path.alive = true, path.enabled = d.enabled, path.line = std::move(line), path.collider = d.collider.index1;
    path.radius = d.radius, path.reach = reach, path.strength = d.strength, path.speed = d.speed,
    path.arrivalTime = d.arrivalTime;
    path.share = d.share, path.beadSpacing = d.beadSpacing, path.startAbsorptivity = d.startAbsorptivity,
    path.priority = d.priority;
    // What follows it was somewhere else along the line as it was.
    for (int i = 0; i < particles.count; ++i) {
        const size_t k = static_cast<size_t>(i);
        if (particles.follows[k] != slot + 1) continue;
        Foot foot;
        if (path.line.nearest(OwnSpace(path.collider, colliders.data()).into(particles.position[k].xyz()), foot))
            particles.along[k] = foot.along;
        else
            particles.follows[k] = 0;
    }
    return thawResult_ok;
}

void World::removePath(uint32_t index) {
    control_.forgetPath(particles, index);
    control_.paths()[index] = {};
    pathSlots[index].alive = false;
}

thawPathState World::pathState(uint32_t index) const {
    const Path& p = control_.paths()[index];
    const auto f = [](double v) { return static_cast<float>(v); };
    return {p.line.length(),  f(p.mass),     f(p.captured), f(p.arrived),
            f(p.spilled),     f(p.distance), p.front,       p.arrival < 0 ? NAN : f(p.arrival),
            p.asked + p.boost};
}

thawResult World::setShape(const thawShapeDef& d, std::string& message, uint32_t& index1) {
    std::vector<Shape>& shapes = control_.shapes();
    size_t slot = 0;
    if (index1 > 0) {
        slot = index1 - 1;
    } else {
        while (slot < shapes.size() && shapes[slot].alive) ++slot;
        if (slot >= static_cast<size_t>(def.maxShapes)) {
            message = "maxShapes: all " + std::to_string(def.maxShapes) + " shapes of the world are in use";
            return thawResult_capacity;
        }
    }
    Region region;
    if (d.contourCount > 0) {
        std::vector<Vec3> points;
        int64_t count = 0;
        for (int32_t k = 0; k < d.contourCount; ++k) count += d.contourSizes[k];
        points.reserve(static_cast<size_t>(count));
        for (int64_t k = 0; k < count; ++k) points.push_back({d.points[k].x, d.points[k].y, d.points[k].z});
        const OwnSpace space(d.collider.index1, colliders.data());
        const Vec3 up = -space.turnInto({def.gravity.x, def.gravity.y, def.gravity.z});
        if (!region.make(points.data(), d.contourSizes, d.contourCount, {d.normal.x, d.normal.y, d.normal.z}, up,
                         def.particleSpacing, message))
            return thawResult_invalidArgument;
    } else {
        CleanMesh mesh;
        const thawResult r = cleanMesh(d.mesh, toTransform(d.position, d.rotation, d.scale), mesh, message);
        if (r != thawResult_ok) return r;
        if (!region.make(mesh, def.particleSpacing, tasks, message)) return thawResult_badMesh;
    }
    const Vec3 extent = region.bounds().upper - region.bounds().lower;
    const float half = 0.5f * std::max(extent.x, std::max(extent.y, region.flat() ? 0.0f : extent.z));
    const float reach = d.reach > 0 ? d.reach : half;
    if (shapes.size() <= slot) {
        shapes.reserve(slot + 1), shapeSlots.reserve(slot + 1), mouldOn_.reserve(slot + 1);
        shapes.resize(slot + 1), shapeSlots.resize(slot + 1), mouldOn_.resize(slot + 1);
    }
    Shape& s = shapes[slot];
    const bool held = s.on() && s.setting && !s.region.flat();
    if (index1 == 0 || s.region.hash() != region.hash() || s.reach != reach || s.collider != d.collider.index1) {
        FillFlow flow;
        flow.make(region, reach, def.particleSpacing);
        if (index1 == 0) {
            s = {};
            shapeSlots[slot].take();
            index1 = static_cast<uint32_t>(slot) + 1;
        }
        s.flow = std::move(flow), s.region = std::move(region);
        s.setting = false, s.filledAfter = -1;
    }
    s.alive = true, s.enabled = d.enabled, s.sets = d.sets, s.collider = d.collider.index1;
    s.reach = reach, s.depth = d.depth > 0 ? d.depth : reach, s.thickness = d.thickness;
    s.strength = d.strength, s.speed = d.speed, s.setFill = d.setFill, s.setTime = d.setTime, s.priority = d.priority;
    s.setting &= s.sets && s.on();
    control_.findWalls(controlFrame(0), slot);
    s.walls = wallVersion_, s.wallsLeft = 0;
    if (!(s.captured > 0)) control_.empty(controlFrame(0), slot);
    if (held && !s.setting) unmould(slot);
    return thawResult_ok;
}

// What each shape's moulded rows hang on, of the colliders that are told apart.
void World::findMoulds() {
    for (size_t k = 0; k < mouldOn_.size(); ++k) {
        const uint32_t on = control_.shapes()[k].collider;
        mouldOn_[k] = on && toldApart(colliders[on - 1]) ? static_cast<uint16_t>(on) : uint16_t{0};
    }
}

// What a shape held in the air has lost its hold.
void World::unmould(size_t shape) {
    for (size_t k = 0; k < static_cast<size_t>(particles.count); ++k)
        if (shapeOf(particles.follows[k]) == shape + 1)
            particles.flags[k] = static_cast<uint8_t>(particles.flags[k] & ~kMoulded);
    lookForHold();
}

void World::removeShape(uint32_t index) {
    unmould(index);
    control_.forgetShape(particles, index);
    control_.shapes()[index] = {};
    shapeSlots[index].alive = false;
}

thawShapeState World::shapeState(uint32_t index) const {
    const Shape& s = control_.shapes()[index];
    const auto f = [](double v) { return static_cast<float>(v); };
    return {s.region.size(),
            f(s.mass),
            f(s.inside),
            f(s.spilled),
            f(s.set),
            f(s.captured),
            f(s.lost),
            f(s.distance),
            s.flow.fill(),
            s.flow.level(),
            s.filledAfter < 0 ? NAN : f(s.filledAfter)};
}

} // namespace thaw
