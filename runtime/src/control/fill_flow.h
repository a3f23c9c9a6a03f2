// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "control/region.h"

#include <vector>

namespace thaw {

// The way melt has to take to fill a region evenly. What each cell lacks (as deep as all of the melt would stand in the
// region, or from the bottom up in a mesh) is a sink of a potential flow (after Hong and Kim 2004, Shi and Yu 2005,
// steered by the melt's own density), which goes round holes, what is solid and colliders.
class FillFlow {
public:
    // Cells over the region and as much as `reach` around it.
    void make(const Region& region, float reach, float spacing);

    // Once a step: clear, add what is there, solve.
    void clear();
    void addLiquid(Vec3 regional, float volume) { add(liquid_, regional, volume, &beyond_); }
    void addSet(Vec3 regional, float volume) { add(set_, regional, volume, nullptr); }
    void addSolid(Vec3 regional, float volume) { add(solid_, regional, volume, nullptr); }
    // down: regional, unit or 0: what a mesh fills first. thickness: m, at which a flat region is full; 0: at none.
    void solve(Vec3 down, float thickness, float spacing);

    size_t cells() const { return share_.size(); }
    Vec3 middleOf(size_t cell) const;                                   // regional
    Box bounds() const { return {middleOf(0), middleOf(cells() - 1)}; } // of the middles
    void block(size_t cell, bool blocked) { blocked_[cell] = blocked; }

    // Whether the island of the region that is the nearest has more than it should: its rim is no hindrance.
    bool leaks(Vec3 regional) const;
    bool leak() const;                     // some do
    Vec3 velocity(Vec3 regional) const;    // m/s, regional; 0 beyond the cells
    float fill() const { return fill_; }   // share of the region that is covered, or filled
    float level() const { return level_; } // m, flat: how deep all melt would stand
    bool full() const { return full_; }    // there is more melt than room
    float room() const { return room_; }   // m^3 that it still takes, infinity: any
    bool open() const { return open_; }    // there is room for more
    // What lives on from step to step, of one that was made for its region; and all that making it found.
    void state(StateIo& io);
    void formState(StateIo& io);

private:
    // Between which cells a place is: the lowest of them, and how far it is on the way to the next ones.
    struct Spot {
        size_t first;
        float x, y, z;
    };
    bool locate(Vec3 regional, Spot& spot) const; // false: beyond the cells
    void limit(double most, double melt);
    void add(std::vector<float>& to, Vec3 regional, float volume, double* beyond);
    void setTargets(Vec3 down, float thickness, float least);
    void findIslands();
    void findLeaks();
    void findLayers(Vec3 down);
    void joinCells();
    void relax();
    void setVelocities(float least);
    size_t at(int x, int y, int z) const {
        return (static_cast<size_t>(z) * static_cast<size_t>(ny_) + static_cast<size_t>(y)) * static_cast<size_t>(nx_) +
               static_cast<size_t>(x);
    }

    template <class F> void forInner(F&& f) const { // all cells but the margin
        for (int z = flat_ ? 0 : 1; z < (flat_ ? 1 : nz_ - 1); ++z)
            for (int y = 1; y < ny_ - 1; ++y)
                for (size_t k = at(1, y, z), end = k + static_cast<size_t>(nx_ - 2); k < end; ++k) f(k);
    }

    bool flat_ = false;
    int nx_ = 0, ny_ = 0, nz_ = 0; // a margin of one cell all round, but for nz 1
    float cell_ = 0, unit_ = 0;    // m; m^2 or m^3 of a cell
    Vec3 origin_;                  // middle of the first cell
    // Per cell: share of the region in it; what melts there, has set in the shape and is another solid, as depth (m) or
    // share of its room; how much melt it should have.
    std::vector<float> share_, liquid_, set_, solid_, target_, potential_, conduct_, lack_;
    std::vector<Vec4> face_; // conductance to the next cell in x, y and z; w see joinCells()
    std::vector<Vec3> velocity_;
    std::vector<uint8_t> blocked_, layer_; // layer_: from the bottom up, along down_
    Vec3 down_{INFINITY, 0, 0};
    std::vector<uint16_t> island_; // per cell the nearest, if there are several
    struct Island {
        float has = 0, lacks = 0;
        bool leaks = false;
    };
    std::vector<Island> islands_;
    double beyond_ = 0; // m^3 of melt outside of all cells
    float fill_ = 0, level_ = 0, largest_ = 0;
    float room_ = INFINITY;
    bool facesStale_ = true;
    bool full_ = false, open_ = true, melts_ = false;
};

} // namespace thaw
