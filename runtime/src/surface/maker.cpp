// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/maker.h"

#include <chrono>

namespace thaw {
namespace {

thawTaskSystem oneWorker() {
    thawTaskSystem system{};
    system.workerCount = 1;
    return system;
}

float millisecondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<float, std::milli>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

void SurfaceMaker::Rows::clear() {
    positions.clear(), temperatures.clear(), liquidFractions.clear(), materials.clear(), bodies.clear();
}

void SurfaceMaker::Rows::copy(const SurfaceInput& from) {
    const size_t count = size_t(from.count);
    const auto take = [count](const auto* source, auto& to) {
        to.resizeRaw(count);
        if (count > 0) std::memcpy(static_cast<void*>(to.data()), source, count * sizeof *source);
    };
    take(from.positions, positions), take(from.temperatures, temperatures);
    take(from.liquidFractions, liquidFractions), take(from.materials, materials), take(from.bodies, bodies);
}

SurfaceInput SurfaceMaker::Rows::input(float spacing) const {
    return {int(positions.size()), positions.data(), temperatures.data(), liquidFractions.data(), materials.data(),
            bodies.data(),         spacing};
}

SurfaceMaker::SurfaceMaker(Allocator& allocator, const thawTaskSystem& system)
    : rows(allocator), surface_(allocator), alone_(oneWorker()), shown_(allocator), next_(allocator),
      background_(system) {}

const SurfaceMesh& SurfaceMaker::extract(const SurfaceInput& input, const Wanted& wanted, Tasks& tasks) {
    time(input, wanted, tasks);
    return surface_;
}

void SurfaceMaker::time(const SurfaceInput& input, const Wanted& wanted, Tasks& tasks) {
    const auto start = std::chrono::steady_clock::now();
    const int64_t before = surface_.meshedBlocks();
    surface_.extract(input, wanted.cellSize, wanted.smoothing, tasks);
    milliseconds_ = millisecondsSince(start), blocks_ = surface_.meshedBlocks() - before;
}

void SurfaceMaker::begin(const Wanted& wanted) {
    wanted_ = wanted;
    background_.start([](void* self) { static_cast<SurfaceMaker*>(self)->make(); }, this);
}

void SurfaceMaker::make() {
    other_ = failed_ = false;
    try {
        time(rows.input(wanted_.spacing), wanted_, alone_);
        other_ = surface_.made() != shownMade_;
        if (other_) next_.copy(surface_), nextMade_ = surface_.made();
    } catch (...) {
        failed_ = true; // only memory can be short
    }
}

const SurfaceMesh& SurfaceMaker::finish() {
    background_.wait();
    if (failed_) {
        failed_ = false;
        throw std::bad_alloc();
    }
    if (other_) std::swap(shown_, next_), std::swap(shownMade_, nextMade_);
    other_ = false;
    return shown_;
}

} // namespace thaw
