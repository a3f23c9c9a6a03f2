// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/background.h"
#include "surface/surface.h"

namespace thaw {

// Makes the mesh at once, or beside what the caller goes on with.
class SurfaceMaker {
public:
    SurfaceMaker(Allocator& allocator, const thawTaskSystem& system);

    // The particles as they are when a mesh is begun.
    struct Rows {
        explicit Rows(Allocator& a) : positions(a), temperatures(a), liquidFractions(a), materials(a), bodies(a) {}
        void clear();
        void copy(const SurfaceInput& from);
        SurfaceInput input(float spacing) const;

        Array<Vec4> positions;
        Array<float> temperatures, liquidFractions;
        Array<uint8_t> materials;
        Array<uint16_t> bodies;
    };
    struct Wanted {
        float spacing = 0, cellSize = 0; // m; in spacings
        int smoothing = 0;
    };

    // Nothing may be under way. The mesh stays what it is until the next one is made or begun.
    const SurfaceMesh& extract(const SurfaceInput& input, const Wanted& wanted, Tasks& tasks);
    // Begins a mesh of rows, which stay as they are until finish(). The mesh of the last finish() stays as well.
    void begin(const Wanted& wanted);
    bool busy() const { return background_.busy(); }
    // Waits for it. Throws std::bad_alloc when there was not enough memory.
    const SurfaceMesh& finish();

    Rows rows;
    const Surface& surface() const { return surface_; }  // while nothing is under way
    float milliseconds() const { return milliseconds_; } // that the last mesh took
    int64_t meshedBlocks() const { return blocks_; }     // for it, without those of one that failed

private:
    void make();
    void time(const SurfaceInput& input, const Wanted& wanted, Tasks& tasks);

    Surface surface_;
    Tasks alone_; // the thread that makes it
    Wanted wanted_;
    SurfaceMesh shown_, next_;            // of meshes that were begun
    int shownMade_ = -1, nextMade_ = -1;  // which of the surface's they are
    bool other_ = false, failed_ = false; // of the one under way: it is not the one that is shown
    float milliseconds_ = 0;
    int64_t blocks_ = 0;
    Background background_; // last: is done before the rest goes
};

} // namespace thaw
