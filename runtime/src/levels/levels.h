// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/tasks.h"
#include "geometry/colliders.h"
#include "levels/feature_size.h"
#include "neighbors/neighbors.h"
#include "particles/material.h"
#include "particles/particles.h"
#include "particles/reference.h"

namespace thaw {

class Bonds;

struct LevelFrame {
    Particles& particles;
    const Neighbors& neighbors; // of the rows as they are
    Reference& reference;
    const Material* materials;
    Tasks& tasks;
    float spacing;        // m, of level 0
    int finest, coarsest; // levels of the plan, 0..3
    int mostSplits;       // particles that may come to be in a step
    uint64_t step;
    uint32_t& nextId;
    const Collider* colliders;
    int colliderCount;
    const uint8_t* coarsestOf; // per body: levels that its liquid may have where it is thick; null: nobody's may
    const Vec4* errors;        // per mover, w: density error that the pressure saw; to apply() only
    Bonds* bonds = nullptr;    // when there are elastic solids
    float dt = 0;              // s, of the step
};

struct LevelResult {
    int split = 0, merged = 0; // particles that came and went
    bool refused = false;      // capacity or mostSplits left some coarser than wanted
};

// How coarse solids are. Untouched solid is coarse; it splits to the finest particles of its reference before anything
// happens to it, and merges back when nothing did:
//  - within two spacings of what flows, of what was melted and set again, and of other bodies it is fine, and a level
//    coarser for about a spacing and a half more each (kBand);
//  - where temperature changes within a particle by a share of what it lacks to melt, it is as fine as that asks for.
// Liquid, in bodies that may be coarse, is as coarse as half of its extended local feature size allows by the same
// bands (FeatureSize): a thick pool up to its surface, while films, drips and necks are fine; and it is fine at walls,
// at solids and other liquids, where it sets and melts. It splits in two where there is most room and merges with
// its nearest of the same kind, a few at a time. (Levels of mass 2^l by feature size: thesis 3.4, Adams et al. 2007.)
// Elastic solids are as other solids are, also while they move, but either the coarsest or the finest.
class Levels {
public:
    static constexpr uint8_t kFar = 255; // of Particles::want: nothing near

    explicit Levels(Allocator& allocator)
        : next_(allocator), gone_(allocator), picked_(allocator), groups_(allocator), features_(allocator) {}

    // Demand of the rows (Particles::want), of a fourth of them in each step: it spreads by a support every fourth
    // step. flux: W that a row takes from sources, or null. all: of every row.
    void choose(const LevelFrame& f, const float* flux, bool all);
    // Splits and merges. Rows are added behind the others and taken out: all lists are stale after it.
    LevelResult apply(const LevelFrame& f);
    // Splits these rows to the finest, whatever they want: the others come behind the last row. Left as they are: what
    // is not coarse, and what there is no room for. Whether any has split.
    bool splitFully(const LevelFrame& f, const uint32_t* rows, size_t count);

private:
    // Of Particles::want, eighths of a spacing. What merged would split again at once if nothing lay between.
    static constexpr int kMergeMargin = 6;
    static void splitRow(const LevelFrame& f, size_t row, int to);
    void splitPicked(const LevelFrame& f, bool fully);
    static int levelOf(int want);
    // Whether so many more rows may come in this step; then they are counted.
    bool takeRoom(int more, LevelResult& result);
    int target(const LevelFrame& f, size_t row, int margin = 0) const;
    int targetOfBonded(const LevelFrame& f, size_t row) const;
    void mergeGroups(const LevelFrame& f);
    int mergeBonded(const LevelFrame& f, size_t row);
    uint8_t wantOfSolid(const LevelFrame& f, int row, const float* flux) const;
    uint8_t wantOfLiquid(const LevelFrame& f, int row) const;
    void solids(const LevelFrame& f, LevelResult& result);
    void bonded(const LevelFrame& f, LevelResult& result);
    void liquids(const LevelFrame& f, LevelResult& result);
    bool mergeSolid(const LevelFrame& f, size_t row);
    void splitLiquid(const LevelFrame& f, size_t row, bool calm);
    bool mergeLiquid(const LevelFrame& f, size_t row, bool calm);
    void disturb(const LevelFrame& f, size_t row, bool calm) const;

    int rows_ = 0, room_ = 0; // that the lists know; that may still come
    Array<uint8_t> next_, gone_;
    Array<uint32_t> picked_, groups_; // rows with bonds: that split, and that merge by eights
    FeatureSize features_;
};

} // namespace thaw
