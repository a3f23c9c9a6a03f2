// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/safe_points.h"
#include "base/tasks.h"
#include "control/control.h"
#include "geometry/colliders.h"
#include "geometry/mesh_fill.h"
#include "heat/heat.h"
#include "levels/group.h"
#include "levels/levels.h"
#include "motion/anchors.h"
#include "motion/bonds.h"
#include "motion/hold.h"
#include "motion/motion.h"
#include "motion/rigid_liquid.h"
#include "neighbors/neighbors.h"
#include "particles/material.h"
#include "particles/particles.h"
#include "particles/splats.h"
#include "surface/maker.h"
#include "world/governor.h"
#include "world/plan.h"
#include "world/surface_level.h"

#include <atomic>
#include <string>
#include <vector>

namespace thaw {

// rotation of any length but 0.
Transform toTransform(thawVec3 position, thawQuat rotation, float scale);

struct Slot {
    uint16_t generation = 0; // counts who lived here; never 0 for a valid id
    bool alive = false;
    void state(StateIo& io) { io(generation, alive); }
    void take() {
        if (++generation == 0) generation = 1;
        alive = true;
    }
};

// The first slot that is free, maybe one behind the last; false, with the reason, when `most` are in use. field: the
// maximum's name in thawWorldDef; what: plural of what lives there.
bool freeSlot(const std::vector<Slot>& slots, int most, const char* field, const char* what, size_t& slot,
              std::string& message);

// One independent world. Arguments are validated by the C boundary (src/api); what can still fail here returns a
// thawResult and a message, or throws std::bad_alloc, with the world unchanged.
class World {
public:
    explicit World(const thawWorldDef& def);
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    // The whole frame.
    uint32_t step(float dt, const thawBudget& budget);
    // The plan that a step with this budget would run.
    thawPlan previewPlan(const thawBudget& budget) const;

    thawResult addBody(const thawBodyDef& def, thawMeshReport& report, std::string& message, uint32_t& index1);
    void removeBody(uint32_t index);
    int paintTemperature(uint32_t body, const thawBrush& brush, float temperature);
    int paintAbsorptivity(uint32_t body, const thawBrush& brush, float value);
    thawBodyState bodyState(uint32_t index) const;
    // Replaces what is set of one, also where there is matter of it.
    thawResult setMaterial(uint32_t index, const thawMaterialDef& def, std::string& message);
    thawResult addCollider(const thawColliderDef& def, thawMeshReport& report, std::string& message, uint32_t& index1);
    void removeCollider(uint32_t index);
    void setColliderTarget(uint32_t index, const Transform& target);
    void teleportCollider(uint32_t index, const Transform& to);
    void setColliderSurface(uint32_t index, bool adhesive, bool occluder, float slipLength, float friction);
    // Makes one (index1 0) or replaces what is set of one.
    thawResult setPath(const thawPathDef& def, std::string& message, uint32_t& index1);
    void removePath(uint32_t index);
    thawPathState pathState(uint32_t index) const;
    // The same of a shape.
    thawResult setShape(const thawShapeDef& def, std::string& message, uint32_t& index1);
    void removeShape(uint32_t index);
    thawShapeState shapeState(uint32_t index) const;
    void extractSurface(const thawSurfaceDef& def, thawSurfaceView& out);
    bool surfaceUnderWay() const { return surface_.busy(); }
    void startSurface(const thawSurfaceDef& def);
    void finishSurface(thawSurfaceView& out);
    thawSplatView splats();
    uint64_t stateHash() const;
    // Images: see thawWorld_Save. save() returns how many bytes it wrote, 0 when there was not enough room.
    size_t snapshotSize(bool full) const;
    size_t save(void* buffer, size_t capacity, bool full) const;
    thawResult restore(const void* image, size_t size, std::string& message);
    bool forgetSnapshots(const void* oldest, size_t size, std::string& message);
    thawLedger ledger() const;
    thawCounters counters() const;
    int pieces(thawPieceState* out, int capacity) const;
    // Of all rows, m; for pictures and tools: it takes lists of its own and changes nothing that a step reads.
    const float* featureSizes();
    void wakePieces() { rigid_.wakeAll(); }

    thawWorldDef def; // with hooks and the settings that may change
    Allocator allocator;
    Tasks tasks;
    uint16_t tag; // in every id of this world
    std::string lastError;

    std::vector<Material> materials;
    std::vector<Slot> bodies;
    std::vector<Collider> colliders; // and their slots, of the same index
    std::vector<Slot> colliderSlots;
    std::vector<HeatSource> sources;
    std::vector<Slot> sourceSlots;
    std::vector<Slot> pathSlots, shapeSlots;
    Particles particles;
    thawPlan plan{};
    thawProfile profile{};

private:
    struct Totals { // sums over a block of particles
        double mass, energy, liquid;
        float minTemperature, maxTemperature;
        int surface, bad, undercooled;
    };
    Needs needs() const;
    // What this step runs: the host's work, or a governor's choice.
    Governor::Choice chooseWork(Governor& milliseconds, Governor& units, const Needs& needs, const thawBudget& budget,
                                int subStepsWanted) const;
    bool heatDue(const thawWork& work) const;
    int subStepsWanted(float dt) const;
    void refreshNeighbors();
    void refreshExposure();
    void boundStartPressure(uint16_t body);
    void fillMassArrays();
    MotionFrame motionFrame(float dt, int subSteps, const thawWork& work, const Guide& guide);
    HeatFrame heatFrame(double dt, const thawWork& work);
    HoldFrame holdFrame(float dt, bool relabel);
    AnchorFrame anchorFrame();
    void holdAndRelease(float dt);
    bool collidersMove() const;
    void startColliders(float dt, int subStep, int subSteps);
    void arrive();
    void lookForHold();
    void carryHeld(float dt, int subStep, int subSteps);
    void findAnchors();
    BondFrame bondFrame(float dt);
    bool anySoft() const; // some material is elastic
    void state(StateIo& io);
    void rowState(StateIo& io);
    void bodyState(StateIo& io);
    void hostState(StateIo& io);
    void reportState(StateIo& io);
    void formState(StateIo& io, bool full);
    StateIo::Limits limits() const;
    void pruneForms();
    void ensureLists();
    thawResult makeRoomForBonds(uint32_t material, std::string& message);
    void soften(uint32_t material);
    void harden(uint32_t material);
    void measure();
    // Of all rows k for which remove(k); adds what they had to mass and energy. Returns how many.
    template <class F> int removeParticles(F&& remove, double& mass, double& energy);
    void burnOff(double heatSeconds);
    ControlFrame controlFrame(float dt);
    void findMoulds();
    void unmould(size_t shape);
    thawResult makeRegion(const thawShapeDef& def, Region& region, std::string& message);
    LevelFrame levelFrame(const thawWork& work, float dt);
    void splitUnder(uint32_t body, const thawBrush& brush);
    // Adds the points of a body to the reference, in the order of their groups. Returns where its origin is.
    Vec3 refer(size_t slot, const std::vector<Vec3>& points, const Groups& groups, float volume, bool bends);
    void forget(size_t slot);
    SurfaceInput surfaceInput();
    void meetWalls(SurfaceInput& input);
    SurfaceMaker::Wanted surfaceWanted(const thawSurfaceDef& d) const;
    void learnSurface(int level);
    int chooseSurfaceLevel(SurfaceLevel& learnt, SurfaceLevel& units, const thawBudget& b) const;
    bool mayBeCoarse() const; // some body

    Neighbors neighbors_;
    Motion motion_;
    Rigid rigid_;
    RigidLiquid rigidLiquid_;
    Heat heat_;
    Hold hold_;
    Anchors anchors_;
    Bonds bonds_;
    SurfaceMaker surface_;
    SplatShapes splats_;
    SurfaceLevel surfaceLevel_{SurfaceLevel::Prices::learnt}, surfaceUnits_{SurfaceLevel::Prices::fixed};
    int startedLevel_ = 0; // of the mesh under way
    Reference reference_;
    Levels levels_;
    Control control_;
    ColliderForms colliderForms_;
    ShapeForms shapeForms_;
    mutable std::atomic<uint64_t> saves_{0}; // images that were made
    uint64_t oldestSave_ = 0;                // that may still be read
    // Of an image that is read; see StateIo::staged.
    struct Stage {
        std::vector<Material> materials;
        std::vector<Slot> bodies, colliderSlots, sourceSlots, pathSlots, shapeSlots;
        std::vector<Collider> colliders;
        std::vector<HeatSource> sources;
        size_t formsEnd = 0, rowsEnd = 0; // in the image
        uint32_t rows = 0, movers = 0;
    } stage_;
    StateIo::Limits imageLimits_;        // of the image that was checked
    std::vector<HeatFrame::Spot> spots_; // of this step
    std::vector<uint16_t> mouldOn_;      // per shape, see HoldFrame
    struct PointRange {                  // of a body in the reference
        uint32_t begin = 0, end = 0;
    };
    std::vector<PointRange> bodyPoints_; // per body
    std::vector<uint8_t> coarsestOf_;    // per body, its coarsestLevel
    Governor governor_{Governor::Prices::learnt}, units_{Governor::Prices::fixed};
    SafePoints safePoints_;
    Array<float> volume_, invDensity_;
    Array<float> featureSizes_; // of the last look that a host took
    Array<Totals> blockTotals_;

    // A piece that lost its hold may hang this many steps: looking for one costs about a millisecond at 12,000
    // particles.
    static constexpr uint32_t kRelabelInterval = 8;

    bool listsStale_ = true;
    bool listsGone_ = false;    // they are of before an image was read
    bool led_ = false;          // something moved when control last ran, or is gone since
    bool toldApart_ = false;    // some collider is: particles know what they hang on
    bool anchorsFresh_ = false; // some came to be since the anchors were found
    float heldSpeed_ = 0;       // m/s, of the fastest held particle in this sub-step
    bool holdStale_ = false;    // some fixed particle went: pieces may have lost their hold
    bool bodiesNew_ = false;    // nobody has looked yet what of them is held
    uint32_t stepsSinceRelabel_ = 0;
    uint64_t colliderVersion_ = 1;
    uint64_t wallVersion_ = 1;    // of all colliders and their places
    uint64_t surfaceVersion_ = 1; // of the rows, their places and what of them is surface
    uint32_t nextId_ = 1;
    uint64_t steps_ = 0;
    double time_ = 0;
    double heatTimePending_ = 0; // s of heat time not yet applied (heatInterval)
    int exposed_ = 0;
    bool anyCoarse_ = false;     // some particle of level 1 or higher
    bool levelsChanged_ = false; // in the last step
    bool full_ = false;          // and some could not split for want of room

    // Ledger and counters of the last measurement.
    double massAdded_ = 0, massRemoved_ = 0, energyAdded_ = 0, energyRemoved_ = 0;
    double massBurnt_ = 0, energyBurnt_ = 0;
    double controlImpulse_[3] = {}, controlEnergy_ = 0, controlHeat_ = 0;
    double painted_ = 0, redefined_ = 0, absorbed_ = 0, contact_ = 0, emitted_ = 0, convected_ = 0;
    double massNow_ = 0, energyNow_ = 0, liquidMass_ = 0;
    float minTemperature_ = 0, maxTemperature_ = 0;
    int undercooled_ = 0; // particles that solid would set, even where all has one temperature
    int badParticles_ = 0;
    int rigidRows_ = 0; // of pieces that are awake
    thawCounters counters_{};
};

} // namespace thaw
