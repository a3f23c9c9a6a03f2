// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
// What the world does with the paths and shapes of its host.
#include "world/world.h"

#include "base/math.h"
#include "motion/carry.h"

#include <algorithm>
#include <bit>

namespace thaw {
namespace {

// Of all that a shape's region is made from.
uint64_t formOf(const thawShapeDef& d) {
    uint64_t h = d.contourCount > 0 ? 1 : 2;
    const auto put = [&](float v) { h = hashCombine(h, std::bit_cast<uint32_t>(v)); };
    const auto place = [&](thawVec3 x) { put(x.x), put(x.y), put(x.z); };
    if (d.contourCount > 0) {
        place(d.normal);
        for (int64_t c = 0, k = 0; c < d.contourCount; ++c) {
            h = hashCombine(h, static_cast<uint64_t>(d.contourSizes[c]));
            for (const int64_t end = k + d.contourSizes[c]; k < end; ++k) place(d.points[k]);
        }
        return h;
    }
    place(d.position), put(d.rotation.x), put(d.rotation.y), put(d.rotation.z), put(d.rotation.w), put(d.scale);
    h = hashCombine(h, d.mesh.vertexCount);
    for (size_t k = 0; k < 3 * d.mesh.vertexCount; ++k) put(d.mesh.vertices[k]);
    for (size_t k = 0; k < 3 * d.mesh.triangleCount; ++k) h = hashCombine(h, d.mesh.indices[k]);
    return h;
}

} // namespace

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
    size_t slot = index1 - 1;
    if (index1 == 0 && !freeSlot(pathSlots, def.maxPaths, "maxPaths", "paths", slot, message))
        return thawResult_capacity;
    const float reach = d.reach > 0 ? d.reach : 2 * d.radius;
    const auto made = std::make_shared<PathLine>();
    PathLine& line = *made;
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
    path.alive = true, path.enabled = d.enabled, path.line = made, path.collider = d.collider.index1;
    path.radius = d.radius, path.reach = reach, path.strength = d.strength, path.speed = d.speed,
    path.arrivalTime = d.arrivalTime;
    path.share = d.share, path.beadSpacing = d.beadSpacing, path.startAbsorptivity = d.startAbsorptivity,
    path.priority = d.priority;
    // What follows it was somewhere else along the line as it was.
    for (int i = 0; i < particles.count; ++i) {
        const size_t k = static_cast<size_t>(i);
        if (particles.follows[k] != slot + 1) continue;
        Foot foot;
        if (path.line->nearest(OwnSpace(path.collider, colliders.data()).into(particles.position[k].xyz()), foot))
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
    return {p.line->length(), f(p.mass),     f(p.captured), f(p.arrived),
            f(p.spilled),     f(p.distance), p.front,       p.arrival < 0 ? NAN : f(p.arrival),
            p.asked + p.boost};
}

// What a shape shall fill.
thawResult World::makeRegion(const thawShapeDef& d, Region& region, std::string& message) {
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
    return thawResult_ok;
}

thawResult World::setShape(const thawShapeDef& d, std::string& message, uint32_t& index1) {
    std::vector<Shape>& shapes = control_.shapes();
    size_t slot = index1 - 1;
    if (index1 == 0 && !freeSlot(shapeSlots, def.maxShapes, "maxShapes", "shapes", slot, message))
        return thawResult_capacity;
    const uint64_t form = formOf(d);
    const bool same = index1 > 0 && shapes[slot].form == form && shapes[slot].collider == d.collider.index1;
    const auto made = std::make_shared<ShapeForm>();
    if (!same)
        if (const thawResult r = makeRegion(d, made->region, message); r != thawResult_ok) return r;
    const Region& region = same ? shapes[slot].region() : made->region;
    const Vec3 extent = region.bounds().upper - region.bounds().lower;
    const float half = 0.5f * std::max(extent.x, std::max(extent.y, region.flat() ? 0.0f : extent.z));
    const float reach = d.reach > 0 ? d.reach : half;
    if (shapes.size() <= slot) {
        shapes.reserve(slot + 1), shapeSlots.reserve(slot + 1), mouldOn_.reserve(slot + 1);
        shapes.resize(slot + 1), shapeSlots.resize(slot + 1), mouldOn_.resize(slot + 1);
    }
    Shape& s = shapes[slot];
    const bool sets = s.on() && s.setting, anew = !same || s.reach != reach;
    if (anew) {
        made->flow.make(region, reach, def.particleSpacing);
        if (same) made->region = region;
        made->key = hashCombine(hashCombine(made->region.hash(), std::bit_cast<uint32_t>(reach)),
                                std::bit_cast<uint32_t>(def.particleSpacing));
        shapeForms_.add(made, saves_);
        if (index1 == 0) {
            s = {};
            shapeSlots[slot].take();
            index1 = static_cast<uint32_t>(slot) + 1;
        }
        s.flow = made->flow, s.made = made, s.form = form;
        s.setting = false, s.filledAfter = -1;
    }
    const bool otherRoom = anew || s.thickness != d.thickness;
    s.alive = true, s.enabled = d.enabled, s.sets = d.sets, s.collider = d.collider.index1;
    s.reach = reach, s.depth = d.depth > 0 ? d.depth : reach, s.thickness = d.thickness;
    s.strength = d.strength, s.speed = d.speed, s.setFill = d.setFill, s.setTime = d.setTime, s.priority = d.priority;
    s.setting &= s.sets && s.on();
    if (anew) control_.findWalls(controlFrame(0), slot), s.walls = wallVersion_, s.wallsLeft = 0;
    if (otherRoom) control_.refill(controlFrame(0), slot), led_ = true;
    if (sets && !s.setting) unmould(slot);
    if (!s.on()) s.mass = s.inside = s.spilled = s.set = s.distance = 0; // also when no other one is on
    if (anew) pruneForms();
    return thawResult_ok;
}

// What each shape's moulded rows hang on, of the colliders that are told apart.
void World::findMoulds() {
    for (size_t k = 0; k < mouldOn_.size(); ++k) {
        const uint32_t on = control_.shapes()[k].collider;
        mouldOn_[k] = on && toldApart(colliders[on - 1]) ? static_cast<uint16_t>(on) : uint16_t{0};
    }
}

// A shape cools no more what is in it, and holds none of it in the air.
void World::unmould(size_t shape) {
    bool held = false;
    for (size_t k = 0; k < static_cast<size_t>(particles.count); ++k) {
        if (shapeOf(particles.follows[k]) != shape + 1) continue;
        held |= particles.flags[k] & kMoulded;
        particles.flags[k] = static_cast<uint8_t>(particles.flags[k] & ~kMoulded);
        particles.along[k] = 0; // another time it starts from what it finds
    }
    if (held) lookForHold();
}

void World::removeShape(uint32_t index) {
    unmould(index);
    control_.forgetShape(particles, index);
    control_.shapes()[index] = {};
    shapeSlots[index].alive = false;
    pruneForms();
}

thawShapeState World::shapeState(uint32_t index) const {
    const Shape& s = control_.shapes()[index];
    const auto f = [](double v) { return static_cast<float>(v); };
    return {s.region().size(),
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
