// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// The C boundary: every argument is checked here, every exception stops here, every refusal leaves the world as it was
// and a message that names the field and the value.
#include "api/defs.h"
#include "api/surface_buffers.h"
#include "base/build.h"
#include "thaw/thaw.h"
#include "world/world.h"

#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <limits>
#include <system_error>

struct thawWorld {
    explicit thawWorld(const thawWorldDef& def) : world(def) {}
    thaw::World world;
};

namespace {

using thaw::SurfaceAttribute;
using thaw::surfaceAttributes;
using thaw::World;
using thaw::writeSurface;

// C lets a host store any int in an enum; reading that as the enum is undefined in C++.
template <class Enum> int valueOf(const Enum& e) {
    int value;
    static_assert(sizeof e == sizeof value);
    std::memcpy(&value, &e, sizeof value);
    return value;
}

// Collects the first complaint about the arguments of one call.
class Check {
public:
    bool ok() const { return result == thawResult_ok; }
    void fail(thawResult r, const char* format, ...) __attribute__((format(printf, 3, 4))) {
        if (!ok()) return;
        result = r;
        char text[512];
        va_list args;
        va_start(args, format);
        std::vsnprintf(text, sizeof text, format, args);
        va_end(args);
        message = text;
    }
    // low <= value <= high; refuses NaN.
    void range(const char* field, double value, double low, double high) {
        if (!(value >= low && value <= high))
            fail(thawResult_invalidArgument, "%s: must be in %g..%g, got %g", field, low, high, value);
    }
    // K, or NaN for none, and W/(m^2 K).
    void wallHeat(float temperature, float conductance) {
        if (!std::isnan(temperature)) range("temperature", temperature, 0, 1e5);
        range("contactConductance", conductance, 0, std::numeric_limits<double>::infinity());
    }
    void finite(const char* field, thawVec3 v, double limit) {
        range(field, v.x, -limit, limit), range(field, v.y, -limit, limit), range(field, v.z, -limit, limit);
    }
    void rotation(const char* field, thawQuat q) {
        const double l = double(q.x) * q.x + double(q.y) * q.y + double(q.z) * q.z + double(q.w) * q.w;
        if (!(l > 0.98 && l < 1.02))
            fail(thawResult_invalidArgument, "%s: must be a unit quaternion, got (%g, %g, %g, %g)", field,
                 static_cast<double>(q.x), static_cast<double>(q.y), static_cast<double>(q.z),
                 static_cast<double>(q.w));
    }
    void places(const char* field, const thawVec3* points, int64_t count) {
        for (int64_t k = 0; ok() && k < count; ++k)
            if (const thawVec3 x = points[k]; !(std::abs(x.x) <= 1e5 && std::abs(x.y) <= 1e5 && std::abs(x.z) <= 1e5))
                fail(thawResult_invalidArgument, "%s[%lld]: must be within 1e5 m, got (%g, %g, %g)", field,
                     static_cast<long long>(k), static_cast<double>(x.x), static_cast<double>(x.y),
                     static_cast<double>(x.z));
    }
    template <class Def> void initialised(const char* name, const Def* def) {
        if (!def)
            fail(thawResult_invalidArgument, "%s: is NULL", name);
        else if (def->cookie != thaw::kDefCookie || def->structSize != sizeof(Def))
            fail(thawResult_notInitialised, "%s: was not filled by its thawInit function", name);
    }
    void mesh(const char* field, const thawMesh& m) {
        if (!m.vertices || m.vertexCount == 0)
            fail(thawResult_badMesh, "%s: has no vertices", field);
        else if (!m.indices || m.triangleCount == 0)
            fail(thawResult_badMesh, "%s: has no triangles", field);
        else if (m.vertexCount > 50000000)
            fail(thawResult_capacity, "%s.vertexCount: at most 50000000, got %zu", field, m.vertexCount);
        else if (m.triangleCount > 100000000)
            fail(thawResult_capacity, "%s.triangleCount: at most 100000000, got %zu", field, m.triangleCount);
    }

    thawResult result = thawResult_ok;
    std::string message;
};

thawResult report(World& w, thawResult result, const std::string& message) noexcept {
    try {
        w.lastError = message;
    } catch (...) {
        w.lastError.clear();
    }
    if (result != thawResult_ok && w.def.logger.log)
        w.def.logger.log(thawLog_error, result, w.lastError.c_str(), w.def.logger.user);
    return result;
}

// Runs f(Check&), which may return a result of its own; reports what it says.
template <class F> thawResult guarded(thawWorld* world, F&& f) noexcept {
    if (!world) return thawResult_invalidArgument;
    try {
        Check check;
        f(world->world, check);
        return check.ok() ? thawResult_ok : report(world->world, check.result, check.message);
    } catch (const std::bad_alloc&) {
        return report(world->world, thawResult_outOfMemory, "out of memory");
    } catch (const std::exception& e) {
        return report(world->world, thawResult_internal, e.what());
    } catch (...) {
        return report(world->world, thawResult_internal, "unknown fault");
    }
}

template <class Id> bool alive(const World& w, Id id, const std::vector<thaw::Slot>& slots) {
    return id.index1 != 0 && id.world == w.tag && id.index1 <= slots.size() && slots[id.index1 - 1].alive &&
           slots[id.index1 - 1].generation == id.generation;
}

void checkWorldDef(Check& c, const thawWorldDef* d) {
    c.initialised("worldDef", d);
    if (!c.ok()) return;
    c.range("particleSpacing", d->particleSpacing, 1e-4, 1);
    c.range("maxParticles", d->maxParticles, 8, 4000000);
    c.range("maxMaterials", d->maxMaterials, 1, 255);
    c.range("maxBodies", d->maxBodies, 1, 65535);
    c.range("maxColliders", d->maxColliders, 1, 65535);
    c.range("maxHeatSources", d->maxHeatSources, 1, 1024);
    c.range("maxPaths", d->maxPaths, 1, 1024);
    c.range("maxShapes", d->maxShapes, 1, 1024);
    c.finite("gravity", d->gravity, 1000);
    c.range("ambientTemperature", d->ambientTemperature, 0, 1e5);
    c.range("convection", d->convection, 0, 1e4);
    c.range("thermalTimeScale", d->thermalTimeScale, 0, 1e5);
    if (!d->allocator.alloc != !d->allocator.free)
        c.fail(thawResult_invalidArgument, "allocator: alloc and free must both be given or both be NULL");
    if (!d->tasks.enqueue != !d->tasks.finish)
        c.fail(thawResult_invalidArgument, "tasks: enqueue and finish must both be given or both be NULL");
    c.range("tasks.workerCount", d->tasks.workerCount, 1, 64);
}

void checkMaterial(Check& c, const thawMaterialDef* d) {
    c.initialised("materialDef", d);
    if (!c.ok()) return;
    c.range("density", d->density, 1, 3e4);
    c.range("solidus", d->solidus, 1e-3, 1e5);
    c.range("liquidus", d->liquidus, 1e-3, 1e5);
    if (c.ok() && d->liquidus < d->solidus)
        c.fail(thawResult_invalidArgument, "liquidus: must not be below solidus %g, got %g",
               static_cast<double>(d->solidus), static_cast<double>(d->liquidus));
    c.range("latentHeat", d->latentHeat, 0, 1e7);
    c.range("specificHeatSolid", d->specificHeatSolid, 1, 1e5);
    c.range("specificHeatLiquid", d->specificHeatLiquid, 1, 1e5);
    c.range("conductivitySolid", d->conductivitySolid, 0, 1e4);
    c.range("conductivityLiquid", d->conductivityLiquid, 0, 1e4);
    c.range("viscositySolid", d->viscositySolid, 1e-3, 1e7);
    c.range("viscosityLiquid", d->viscosityLiquid, 1e-4, 1e6);
    c.range("yieldStress", d->yieldStress, 0, 1e6);
    const int flow = valueOf(d->flow);
    if (flow != thawFlow_bingham && flow != thawFlow_casson)
        c.fail(thawResult_invalidArgument, "flow: is not a thawFlow, got %d", flow);
    c.range("absorptivity", d->absorptivity, 0, 1);
    c.range("emissivity", d->emissivity, 0, 1);
    c.range("cohesion", d->cohesion, 0, 20);
    c.range("adhesion", d->adhesion, 0, 5);
    c.range("setFraction", d->setFraction, 0, 1);
    c.range("releaseFraction", d->releaseFraction, 0, 1);
    c.range("youngModulus", d->youngModulus, 0, 1e8);
    c.range("solidYieldStress", d->solidYieldStress, 0, 1e8);
    c.range("relaxationTime", d->relaxationTime, 0, 1e9);
    c.range("breakStrain", d->breakStrain, 0, 1);
    c.range("burnTemperature", d->burnTemperature, 0, 1e5);
    c.range("vapourHeat", d->vapourHeat, 0, 1e8);
    c.range("burnRate", d->burnRate, 0, 1e6);
    c.range("undercooling", d->undercooling, 0, 1000);
    if (c.ok() && d->undercooling >= d->solidus)
        c.fail(thawResult_invalidArgument, "undercooling: must be below solidus %g, got %g",
               static_cast<double>(d->solidus), static_cast<double>(d->undercooling));
    if (c.ok() && d->burnTemperature > 0 && d->burnTemperature < d->liquidus)
        c.fail(thawResult_invalidArgument, "burnTemperature: must be 0 or not below liquidus %g, got %g",
               static_cast<double>(d->liquidus), static_cast<double>(d->burnTemperature));
    if (c.ok() && d->setFraction > d->releaseFraction)
        c.fail(thawResult_invalidArgument, "setFraction: must not be above releaseFraction %g, got %g",
               static_cast<double>(d->releaseFraction), static_cast<double>(d->setFraction));
    c.finite("color", d->color, 1e6);
}

void checkSource(Check& c, const thawHeatSourceDef* d) {
    c.initialised("heatSourceDef", d);
    if (!c.ok()) return;
    c.finite("position", d->position, 1e6);
    const int type = valueOf(d->type);
    if (type < thawHeatSource_point || type > thawHeatSource_directional)
        c.fail(thawResult_invalidArgument, "type: is not a thawHeatSourceType, got %d", type);
    c.range("power", d->power, -1e12, 1e12);
    c.range("radius", d->radius, 1e-4, 10);
    c.rotation("rotation", d->rotation);
    if (type == thawHeatSource_rectangle)
        c.range("size.x", d->size.x, 1e-4, 1e4), c.range("size.z", d->size.z, 1e-4, 1e4);
    c.range("temperature", d->temperature, 0, 1e9);
    c.range("emissivity", d->emissivity, 0, 1);
    c.range("irradiance", d->irradiance, -1e12, 1e12);
}

// The collider that a control moves with, or null.
void checkCarrier(Check& c, const World& w, thawColliderId id) {
    if (id.index1 != 0 && !alive(w, id, w.colliderSlots))
        c.fail(thawResult_staleId, "collider: is not alive in this world");
}

void checkPath(Check& c, const World& w, const thawPathDef* d) {
    c.initialised("pathDef", d);
    if (!c.ok()) return;
    c.range("pointCount", d->pointCount, 2, 1e6);
    if (c.ok() && !d->points) c.fail(thawResult_invalidArgument, "points: is NULL");
    c.places("points", d->points, d->pointCount);
    checkCarrier(c, w, d->collider);
    c.range("radius", d->radius, 1e-4, 10);
    if (d->reach != 0) c.range("reach", d->reach, d->radius, 10);
    c.range("strength", d->strength, 0, 1);
    c.range("speed", d->speed, 0, 100);
    c.range("arrivalTime", d->arrivalTime, 0, 1e4);
    c.range("share", d->share, 0, 1e6);
    if (d->beadSpacing != 0) c.range("beadSpacing", d->beadSpacing, 2 * static_cast<double>(d->radius), 10);
    if (!std::isnan(d->startAbsorptivity)) c.range("startAbsorptivity", d->startAbsorptivity, 0, 1);
}

void checkShape(Check& c, const World& w, const thawShapeDef* d) {
    c.initialised("shapeDef", d);
    if (!c.ok()) return;
    const bool mesh = d->mesh.vertices || d->mesh.indices;
    c.range("contourCount", d->contourCount, mesh ? 0 : 1, mesh ? 0 : 10000);
    if (mesh) {
        c.mesh("mesh", d->mesh);
    } else if (c.ok()) {
        if (!d->points) c.fail(thawResult_invalidArgument, "points: is NULL");
        if (!d->contourSizes) c.fail(thawResult_invalidArgument, "contourSizes: is NULL");
        int64_t count = 0;
        for (int32_t k = 0; c.ok() && k < d->contourCount; ++k) {
            if (!(d->contourSizes[k] >= 3 && d->contourSizes[k] <= 1000000))
                c.fail(thawResult_invalidArgument, "contourSizes[%d]: must be in 3..1000000, got %d", k,
                       d->contourSizes[k]);
            else if ((count += d->contourSizes[k]) > 1000000)
                c.fail(thawResult_capacity, "points: at most 1000000 in all contours, got more in the first %d", k + 1);
        }
        if (c.ok()) c.places("points", d->points, count);
    }
    c.finite("normal", d->normal, 1e5);
    c.finite("position", d->position, 1e5);
    c.rotation("rotation", d->rotation);
    c.range("scale", d->scale, 1e-6, 1e6);
    checkCarrier(c, w, d->collider);
    if (d->reach != 0) c.range("reach", d->reach, 1e-4, 10);
    if (d->depth != 0) c.range("depth", d->depth, 1e-4, 10);
    c.range("thickness", d->thickness, 0, 10);
    c.range("strength", d->strength, 0, 1);
    c.range("speed", d->speed, 1e-4, 100);
    c.range("setFill", d->setFill, 0, 1);
    c.range("setTime", d->setTime, 0, 1e4);
}

void checkWork(Check& c, const char* of, const thawWork& w) {
    const auto range = [&](const char* field, double value, double low, double high) {
        if (!(value >= low && value <= high))
            c.fail(thawResult_invalidArgument, "budget.%s.%s: must be in %g..%g, got %g", of, field, low, high, value);
    };
    range("subSteps", w.subSteps, 1, 16);
    range("leastSubSteps", w.leastSubSteps, 1, 16);
    range("pressureIterations", w.pressureIterations, 1, 64);
    range("viscosityIterations", w.viscosityIterations, 1, 200);
    range("heatInterval", w.heatInterval, 1, 8);
    range("rayRefresh", w.rayRefresh, 0.05, 1);
    range("heatCycles", w.heatCycles, 1, 1000);
    range("raysPerSource", w.raysPerSource, 1, 64);
    range("finestLevel", w.finestLevel, 0, 3);
    range("coarsestLevel", w.coarsestLevel, 0, 3);
    range("splits", w.splits, 1, 1e6);
    range("surfaceLevel", w.surfaceLevel, 0, 3);
    range("lateAfter", w.lateAfter, 0, 1e9);
}

void checkSurfaceDef(Check& c, const thawSurfaceDef* d) {
    c.initialised("surfaceDef", d);
    if (!c.ok()) return;
    c.range("cellSize", d->cellSize, 0.25, 4);
    c.range("smoothing", d->smoothing, 0, 10);
}

void checkSurfaceBuffers(Check& c, const thawSurfaceView& view, const thawSurfaceBuffers& b) {
    c.range("vertexStride", b.vertexStride, 4, 4096);
    if (c.ok() && (b.vertexStride % 4 != 0 || reinterpret_cast<uintptr_t>(b.vertices) % 4 != 0))
        c.fail(thawResult_invalidArgument, "vertices, vertexStride: must be multiples of 4");
    for (const SurfaceAttribute& f : surfaceAttributes(b))
        if (f.offset != -1 && (f.offset < 0 || f.offset > b.vertexStride - f.bytes || f.offset % f.align != 0))
            c.fail(thawResult_invalidArgument, "%s: %d bytes there are not within vertexStride, or not aligned to %d",
                   f.name, f.bytes, f.align);
    if (b.indexSize != 2 && b.indexSize != 4)
        c.fail(thawResult_invalidArgument, "indexSize: must be 2 or 4, got %d", b.indexSize);
    if (c.ok() && reinterpret_cast<uintptr_t>(b.indices) % static_cast<uintptr_t>(b.indexSize) != 0)
        c.fail(thawResult_invalidArgument, "indices: must be aligned to indexSize");
    if (!c.ok()) return;
    if (!b.vertices && view.vertexCount > 0) c.fail(thawResult_invalidArgument, "vertices: is NULL");
    if (!b.indices && view.triangleCount > 0) c.fail(thawResult_invalidArgument, "indices: is NULL");
    if (b.indexSize == 2 && view.vertexCount > 65536)
        c.fail(thawResult_invalidArgument, "indexSize: 2 bytes cannot number %d vertices", view.vertexCount);
    if (b.vertexCapacity < view.vertexCount)
        c.fail(thawResult_capacity, "vertexCapacity: %d vertices are needed, got room for %d", view.vertexCount,
               b.vertexCapacity);
    if (b.indexCapacity < 3 * view.triangleCount)
        c.fail(thawResult_capacity, "indexCapacity: %d indices are needed, got room for %d", 3 * view.triangleCount,
               b.indexCapacity);
}

void checkBudget(Check& c, const thawBudget& b) {
    c.initialised("budget", &b);
    if (!c.ok()) return;
    const int mode = valueOf(b.mode);
    if (mode != thawBudget_work && mode != thawBudget_milliseconds && mode != thawBudget_units)
        c.fail(thawResult_invalidArgument, "budget.mode: is not a thawBudgetMode, got %d", mode);
    if (mode == thawBudget_milliseconds) c.range("budget.milliseconds", b.milliseconds, 0, 1e9);
    if (mode == thawBudget_units) c.range("budget.units", b.units, 0, 1e12);
    if (mode != thawBudget_work) c.range("budget.surfaceMilliseconds", b.surfaceMilliseconds, 0, 1e9);
    if (mode == thawBudget_work) return checkWork(c, "work", b.work);
    checkWork(c, "least", b.least);
    checkWork(c, "most", b.most);
}

void checkParts(const World& w, Check& c, const thawBodyDef& def) {
    c.range("partCount", def.partCount, 0, 64);
    if (def.partCount > 0 && !def.parts) c.fail(thawResult_invalidArgument, "parts: is NULL");
    for (int32_t k = 0; c.ok() && k < def.partCount; ++k) {
        const thawBodyPart& part = def.parts[k];
        const std::string name = "parts[" + std::to_string(k) + "]";
        if (part.material.index1 == 0 || part.material.world != w.tag || part.material.index1 > w.materials.size())
            c.fail(thawResult_staleId, "%s.material: is not a material of this world", name.c_str());
        if (part.mesh.vertices || part.mesh.indices || part.mesh.vertexCount || part.mesh.triangleCount) {
            c.range((name + ".depth").c_str(), part.depth, 0, 0);
            c.mesh((name + ".mesh").c_str(), part.mesh);
        } else {
            c.range((name + ".depth").c_str(), part.depth, 1e-6, 1e4);
        }
    }
}

void checkBrush(const World& w, Check& c, thawBodyId id, const thawBrush* brush) {
    if (!alive(w, id, w.bodies)) c.fail(thawResult_staleId, "body: is not alive in this world");
    if (!brush) return c.fail(thawResult_invalidArgument, "brush: is NULL");
    c.finite("brush.center", brush->center, 1e6);
    c.range("brush.radius", brush->radius, 1e-6, 1e4);
    c.range("brush.falloff", brush->falloff, 0, 1);
}

void checkPlace(const World& w, Check& c, thawColliderId id, thawVec3 position, thawQuat rotation) {
    if (!alive(w, id, w.colliderSlots)) c.fail(thawResult_staleId, "collider: is not alive in this world");
    c.finite("position", position, 1e5);
    c.rotation("rotation", rotation);
}

thawBudget defaultBudget() {
    thawBudget b{};
    b.structSize = sizeof b, b.cookie = thaw::kDefCookie;
    b.mode = thawBudget_work;
    b.milliseconds = 4, b.units = 4000;
    b.work = {4, 8, 12, 1, 1.0f, 1, 80, 16, 0, 3, 2048, 0, 0};
    b.least = {1, 3, 6, 8, 0.05f, 1, 8, 4, 3, 3, 2048, 3, 0};
    b.most = {16, 64, 200, 1, 1.0f, 8, 1000, 64, 0, 3, 2048, 0, 0};
    return b;
}

thaw::HeatSource toSource(const thawHeatSourceDef& d) {
    const thaw::Transform t = thaw::toTransform(d.position, d.rotation, 1);
    return {t.position,    d.power,      d.radius,    d.enabled,
            true,          d.type,       t.rotation,  {d.size.x, d.size.y, d.size.z},
            d.temperature, d.emissivity, d.irradiance};
}

} // namespace

extern "C" {

int thawGetVersion(void) { return THAW_VERSION; }

const char* thawGetBuildString(void) { return thaw::buildString(); }

const char* thawResultString(thawResult result) {
    switch (result) {
    case thawResult_ok:
        return "ok";
    case thawResult_invalidArgument:
        return "invalid argument";
    case thawResult_notInitialised:
        return "definition not initialised";
    case thawResult_staleId:
        return "stale id";
    case thawResult_outOfMemory:
        return "out of memory";
    case thawResult_capacity:
        return "capacity reached";
    case thawResult_badMesh:
        return "mesh cannot be filled";
    case thawResult_internal:
        return "internal fault";
    case thawResult_badImage:
        return "image cannot be read";
    }
    return "unknown";
}

const char* thawStepStatusString(uint32_t bit) {
    switch (bit) {
    case thawStep_refused:
        return "an argument was refused";
    case thawStep_iterationsClipped:
        return "viscosity stopped at its iteration cap";
    case thawStep_subStepsClipped:
        return "fewer sub-steps than depth or speed asked for";
    case thawStep_velocityClamped:
        return "a particle was slowed to the speed limit";
    case thawStep_neighborsClipped:
        return "a neighbour list was full";
    case thawStep_badParticlesRemoved:
        return "a particle that was not finite was removed";
    case thawStep_raysReduced:
        return "only part of the rays was refreshed";
    case thawStep_splitsClipped:
        return "some particles stayed coarser than they should be: maxParticles is reached, or splits too low";
    case thawStep_overBudget:
        return "the step took longer than its budget";
    case thawStep_late:
        return "the step ran late and gave up some of its work";
    default:
        return "";
    }
}

const char* thawStageName(thawStage stage) {
    static constexpr const char* kNames[thawStage_count] = {
        "inputs",  "neighbors", "exposure",  "radiation", "conduction", "loss",   "phase",
        "control", "forces",    "viscosity", "pressure",  "collision",  "levels", "stats"};
    return stage >= 0 && stage < thawStage_count ? kNames[stage] : "";
}

const char* thawReasonString(thawReason reason) {
    switch (reason) {
    case thawReason_needed:
        return "needed";
    case thawReason_noParticles:
        return "no particles";
    case thawReason_nothingMoves:
        return "nothing moves";
    case thawReason_nothingChanged:
        return "nothing changed";
    case thawReason_noSource:
        return "no source is on";
    case thawReason_nothingExposed:
        return "nothing is exposed";
    case thawReason_equilibrium:
        return "all at one temperature";
    case thawReason_timeScaleZero:
        return "thermalTimeScale is 0";
    case thawReason_interval:
        return "not due in this step";
    case thawReason_oneLevel:
        return "no solid that could be coarse";
    case thawReason_noControl:
        return "no path or shape is on";
    }
    return "";
}

void thawInitWorldDef(thawWorldDef* def) {
    if (!def) return;
    *def = thawWorldDef{};
    def->structSize = sizeof *def, def->cookie = thaw::kDefCookie;
    def->particleSpacing = 0.002f;
    def->maxParticles = 32768;
    def->maxMaterials = 16, def->maxBodies = 64, def->maxColliders = 64, def->maxHeatSources = 16, def->maxPaths = 64,
    def->maxShapes = 64;
    def->gravity = {0, -9.81f, 0};
    def->ambientTemperature = 293.15f;
    def->convection = 10;
    def->thermalTimeScale = 1;
    def->tasks.workerCount = 1;
}

thawResult thawCreateWorld(const thawWorldDef* def, thawWorld** outWorld, char* message, size_t messageSize) {
    auto say = [&](thawResult result, const char* text) {
        if (message && messageSize > 0) std::snprintf(message, messageSize, "%s", text);
        return result;
    };
    if (!outWorld) return say(thawResult_invalidArgument, "outWorld: is NULL");
    *outWorld = nullptr;
    try {
        Check c;
        checkWorldDef(c, def);
        if (!c.ok()) return say(c.result, c.message.c_str());
        *outWorld = new thawWorld(*def);
        return say(thawResult_ok, "");
    } catch (const std::bad_alloc&) {
        return say(thawResult_outOfMemory, "out of memory: lower maxParticles");
    } catch (const std::system_error& e) {
        return say(thawResult_internal, e.what());
    } catch (...) {
        return say(thawResult_internal, "unknown fault");
    }
}

void thawDestroyWorld(thawWorld* world) { delete world; }

const char* thawWorld_GetLastError(const thawWorld* world) { return world ? world->world.lastError.c_str() : ""; }

thawResult thawWorld_SetGravity(thawWorld* world, thawVec3 gravity) {
    return guarded(world, [&](World& w, Check& c) {
        c.finite("gravity", gravity, 1000);
        if (c.ok()) w.def.gravity = gravity, w.wakePieces();
    });
}

thawResult thawWorld_SetAmbient(thawWorld* world, float temperature, float convection) {
    return guarded(world, [&](World& w, Check& c) {
        c.range("temperature", temperature, 0, 1e5);
        c.range("convection", convection, 0, 1e4);
        if (c.ok()) w.def.ambientTemperature = temperature, w.def.convection = convection;
    });
}

thawResult thawWorld_SetThermalTimeScale(thawWorld* world, float scale) {
    return guarded(world, [&](World& w, Check& c) {
        c.range("scale", scale, 0, 1e5);
        if (c.ok()) w.def.thermalTimeScale = scale;
    });
}

void thawInitMaterialDef(thawMaterialDef* def, thawMaterialPreset preset) {
    if (def) *def = thaw::materialPreset(preset);
}

const char* thawMaterialPresetName(thawMaterialPreset preset) { return thaw::materialPresetName(preset); }

thawResult thawCreateMaterial(thawWorld* world, const thawMaterialDef* def, thawMaterialId* outId) {
    if (outId) *outId = {};
    return guarded(world, [&](World& w, Check& c) {
        checkMaterial(c, def);
        if (!outId) c.fail(thawResult_invalidArgument, "outId: is NULL");
        if (w.materials.size() >= static_cast<size_t>(w.def.maxMaterials))
            c.fail(thawResult_capacity, "maxMaterials: all %d materials of the world are in use", w.def.maxMaterials);
        if (!c.ok()) return;
        w.materials.emplace_back(*def);
        *outId = {static_cast<uint32_t>(w.materials.size()), w.tag, 1};
    });
}

thawResult thawMaterial_Set(thawWorld* world, thawMaterialId id, const thawMaterialDef* def) {
    return guarded(world, [&](World& w, Check& c) {
        checkMaterial(c, def);
        if (c.ok() && (id.index1 == 0 || id.world != w.tag || id.index1 > w.materials.size() || id.generation != 1))
            c.fail(thawResult_staleId, "material: is not a material of this world");
        if (!c.ok()) return;
        std::string message;
        if (const thawResult r = w.setMaterial(id.index1 - 1, *def, message); r != thawResult_ok)
            c.fail(r, "%s", message.c_str());
    });
}

void thawInitBodyDef(thawBodyDef* def) {
    if (!def) return;
    *def = thawBodyDef{};
    def->structSize = sizeof *def, def->cookie = thaw::kDefCookie;
    def->rotation = {0, 0, 0, 1};
    def->scale = 1;
    def->temperature = std::numeric_limits<float>::quiet_NaN();
    def->anchored = true;
}

thawResult thawCreateBody(thawWorld* world, const thawBodyDef* def, thawBodyId* outId, thawMeshReport* meshReport) {
    if (outId) *outId = {};
    thawMeshReport found{};
    const thawResult result = guarded(world, [&](World& w, Check& c) {
        c.initialised("bodyDef", def);
        if (!c.ok()) return;
        if (!outId) c.fail(thawResult_invalidArgument, "outId: is NULL");
        if (def->material.index1 == 0 || def->material.world != w.tag || def->material.index1 > w.materials.size())
            c.fail(thawResult_staleId, "material: is not a material of this world");
        c.finite("position", def->position, 1e5);
        c.rotation("rotation", def->rotation);
        c.range("scale", def->scale, 1e-6, 1e6);
        if (!std::isnan(def->temperature)) c.range("temperature", def->temperature, 0, 1e5);
        c.finite("velocity", def->velocity, 1000);
        c.finite("angularVelocity", def->angularVelocity, 1000);
        c.range("coarsestLevel", def->coarsestLevel, 0, 3);
        if (c.ok()) c.mesh("mesh", def->mesh);
        if (c.ok()) checkParts(w, c, *def);
        if (!c.ok()) return;
        std::string message;
        uint32_t index1 = 0;
        const thawResult r = w.addBody(*def, found, message, index1);
        if (r != thawResult_ok) return c.fail(r, "%s", message.c_str());
        *outId = {index1, w.tag, w.bodies[index1 - 1].generation};
    });
    if (meshReport) *meshReport = found;
    return result;
}

thawResult thawDestroyBody(thawWorld* world, thawBodyId id) {
    return guarded(world, [&](World& w, Check& c) {
        if (!alive(w, id, w.bodies)) return c.fail(thawResult_staleId, "body: is not alive in this world");
        w.removeBody(id.index1 - 1);
    });
}

thawResult thawBody_GetState(const thawWorld* world, thawBodyId id, thawBodyState* out) {
    if (!world || !out) return thawResult_invalidArgument;
    if (!alive(world->world, id, world->world.bodies)) return thawResult_staleId;
    *out = world->world.bodyState(id.index1 - 1);
    return thawResult_ok;
}

thawResult thawBody_PaintTemperature(thawWorld* world, thawBodyId id, const thawBrush* brush, float temperature,
                                     int32_t* painted) {
    if (painted) *painted = 0;
    return guarded(world, [&](World& w, Check& c) {
        checkBrush(w, c, id, brush);
        c.range("temperature", temperature, 0, 1e5);
        if (!c.ok()) return;
        const int n = w.paintTemperature(id.index1 - 1, *brush, temperature);
        if (painted) *painted = n;
    });
}

thawResult thawBody_PaintAbsorptivity(thawWorld* world, thawBodyId id, const thawBrush* brush, float absorptivity,
                                      int32_t* painted) {
    if (painted) *painted = 0;
    return guarded(world, [&](World& w, Check& c) {
        checkBrush(w, c, id, brush);
        c.range("absorptivity", absorptivity, 0, 1);
        if (!c.ok()) return;
        const int n = w.paintAbsorptivity(id.index1 - 1, *brush, absorptivity);
        if (painted) *painted = n;
    });
}

void thawInitColliderDef(thawColliderDef* def, thawColliderType type) {
    if (!def) return;
    *def = thawColliderDef{};
    def->structSize = sizeof *def, def->cookie = thaw::kDefCookie;
    def->type = type;
    def->rotation = {0, 0, 0, 1};
    def->size = {1, 1, 1};
    def->scale = 1;
    def->adhesive = def->occluder = true;
    def->friction = 0.5f;
    def->temperature = std::numeric_limits<float>::quiet_NaN();
    def->contactConductance = std::numeric_limits<float>::infinity();
}

thawResult thawCreateCollider(thawWorld* world, const thawColliderDef* def, thawColliderId* outId,
                              thawMeshReport* meshReport) {
    if (outId) *outId = {};
    thawMeshReport found{};
    const thawResult result = guarded(world, [&](World& w, Check& c) {
        c.initialised("colliderDef", def);
        if (!c.ok()) return;
        if (!outId) c.fail(thawResult_invalidArgument, "outId: is NULL");
        const int type = valueOf(def->type);
        if (type < thawCollider_plane || type > thawCollider_mesh)
            c.fail(thawResult_invalidArgument, "type: is not a thawColliderType, got %d", type);
        c.finite("position", def->position, 1e5);
        c.rotation("rotation", def->rotation);
        if (type == thawCollider_box || type == thawCollider_sphere) c.range("size.x", def->size.x, 1e-6, 1e4);
        if (type == thawCollider_box)
            c.range("size.y", def->size.y, 1e-6, 1e4), c.range("size.z", def->size.z, 1e-6, 1e4);
        if (type == thawCollider_mesh) c.range("scale", def->scale, 1e-6, 1e6);
        c.range("slipLength", def->slipLength, 0, 1e4);
        c.range("friction", def->friction, 0, 10);
        c.wallHeat(def->temperature, def->contactConductance);
        if (c.ok() && type == thawCollider_mesh) c.mesh("mesh", def->mesh);
        if (!c.ok()) return;
        std::string message;
        uint32_t index1 = 0;
        const thawResult r = w.addCollider(*def, found, message, index1);
        if (r != thawResult_ok) return c.fail(r, "%s", message.c_str());
        *outId = {index1, w.tag, w.colliderSlots[index1 - 1].generation};
    });
    if (meshReport) *meshReport = found;
    return result;
}

thawResult thawDestroyCollider(thawWorld* world, thawColliderId id) {
    return guarded(world, [&](World& w, Check& c) {
        if (!alive(w, id, w.colliderSlots)) return c.fail(thawResult_staleId, "collider: is not alive in this world");
        w.removeCollider(id.index1 - 1);
    });
}

thawResult thawCollider_SetTransform(thawWorld* world, thawColliderId id, thawVec3 position, thawQuat rotation) {
    return guarded(world, [&](World& w, Check& c) {
        checkPlace(w, c, id, position, rotation);
        if (c.ok()) w.setColliderTarget(id.index1 - 1, thaw::toTransform(position, rotation, 1));
    });
}

thawResult thawCollider_Teleport(thawWorld* world, thawColliderId id, thawVec3 position, thawQuat rotation) {
    return guarded(world, [&](World& w, Check& c) {
        checkPlace(w, c, id, position, rotation);
        if (c.ok()) w.teleportCollider(id.index1 - 1, thaw::toTransform(position, rotation, 1));
    });
}

thawResult thawCollider_GetTransform(const thawWorld* world, thawColliderId id, thawVec3* position,
                                     thawQuat* rotation) {
    if (!world || !position || !rotation) return thawResult_invalidArgument;
    if (!alive(world->world, id, world->world.colliderSlots)) return thawResult_staleId;
    const thaw::Transform& t = world->world.colliders[id.index1 - 1].transform;
    *position = {t.position.x, t.position.y, t.position.z};
    *rotation = {t.rotation.x, t.rotation.y, t.rotation.z, t.rotation.w};
    return thawResult_ok;
}

thawResult thawCollider_SetSurface(thawWorld* world, thawColliderId id, bool adhesive, bool occluder, float slipLength,
                                   float friction) {
    return guarded(world, [&](World& w, Check& c) {
        if (!alive(w, id, w.colliderSlots)) c.fail(thawResult_staleId, "collider: is not alive in this world");
        c.range("slipLength", slipLength, 0, 1e4);
        c.range("friction", friction, 0, 10);
        if (c.ok()) w.setColliderSurface(id.index1 - 1, adhesive, occluder, slipLength, friction);
    });
}

thawResult thawCollider_SetHeat(thawWorld* world, thawColliderId id, float temperature, float contactConductance) {
    return guarded(world, [&](World& w, Check& c) {
        if (!alive(w, id, w.colliderSlots)) c.fail(thawResult_staleId, "collider: is not alive in this world");
        c.wallHeat(temperature, contactConductance);
        if (!c.ok()) return;
        thaw::Collider& wall = w.colliders[id.index1 - 1];
        wall.temperature = temperature, wall.conductance = contactConductance;
    });
}

thawResult thawCollider_GetImpulse(const thawWorld* world, thawColliderId id, thawColliderImpulse* out) {
    if (!world || !out) return thawResult_invalidArgument;
    *out = {};
    if (!alive(world->world, id, world->world.colliderSlots)) return thawResult_staleId;
    const thaw::Collider& c = world->world.colliders[id.index1 - 1];
    if (!c.report) return thawResult_invalidArgument;
    const auto f = [&](int k) { return static_cast<float>(c.impulse[k]); };
    *out = {{f(0), f(1), f(2)}, {f(3), f(4), f(5)}};
    return thawResult_ok;
}

void thawInitHeatSourceDef(thawHeatSourceDef* def) {
    if (!def) return;
    *def = thawHeatSourceDef{};
    def->structSize = sizeof *def, def->cookie = thaw::kDefCookie;
    def->power = 20;
    def->radius = 0.005f;
    def->enabled = true;
    def->rotation = {0, 0, 0, 1};
    def->size = {0.05f, 0.05f, 0.05f};
    def->temperature = 1300, def->emissivity = 1;
    def->irradiance = 1000;
}

thawResult thawCreateHeatSource(thawWorld* world, const thawHeatSourceDef* def, thawHeatSourceId* outId) {
    if (outId) *outId = {};
    return guarded(world, [&](World& w, Check& c) {
        checkSource(c, def);
        if (!outId) c.fail(thawResult_invalidArgument, "outId: is NULL");
        size_t slot = 0;
        while (slot < w.sources.size() && w.sources[slot].alive) ++slot;
        if (slot >= static_cast<size_t>(w.def.maxHeatSources))
            c.fail(thawResult_capacity, "maxHeatSources: all %d sources of the world are in use", w.def.maxHeatSources);
        if (!c.ok()) return;
        if (w.sources.size() <= slot) w.sourceSlots.resize(slot + 1), w.sources.resize(slot + 1);
        w.sources[slot] = toSource(*def);
        w.sourceSlots[slot].take();
        *outId = {static_cast<uint32_t>(slot) + 1, w.tag, w.sourceSlots[slot].generation};
    });
}

thawResult thawHeatSource_Set(thawWorld* world, thawHeatSourceId id, const thawHeatSourceDef* def) {
    return guarded(world, [&](World& w, Check& c) {
        checkSource(c, def);
        if (c.ok() && !alive(w, id, w.sourceSlots))
            c.fail(thawResult_staleId, "heatSource: is not alive in this world");
        if (!c.ok()) return;
        w.sources[id.index1 - 1] = toSource(*def);
    });
}

thawResult thawDestroyHeatSource(thawWorld* world, thawHeatSourceId id) {
    return guarded(world, [&](World& w, Check& c) {
        if (!alive(w, id, w.sourceSlots)) return c.fail(thawResult_staleId, "heatSource: is not alive in this world");
        w.sources[id.index1 - 1] = {};
        w.sourceSlots[id.index1 - 1].alive = false;
    });
}

void thawInitPathDef(thawPathDef* def) {
    if (!def) return;
    *def = thawPathDef{};
    def->structSize = sizeof *def, def->cookie = thaw::kDefCookie;
    def->smooth = def->enabled = true;
    def->radius = 0.01f, def->strength = 0.8f, def->speed = 0.05f, def->share = 1;
    def->startAbsorptivity = std::numeric_limits<float>::quiet_NaN();
}

thawResult thawCreatePath(thawWorld* world, const thawPathDef* def, thawPathId* outId) {
    return guarded(world, [&](World& w, Check& c) {
        if (!outId) return c.fail(thawResult_invalidArgument, "outId: is NULL");
        *outId = {};
        checkPath(c, w, def);
        if (!c.ok()) return;
        std::string message;
        uint32_t index1 = 0;
        if (const thawResult r = w.setPath(*def, message, index1); r != thawResult_ok)
            return c.fail(r, "%s", message.c_str());
        *outId = {index1, w.tag, w.pathSlots[index1 - 1].generation};
    });
}

thawResult thawPath_Set(thawWorld* world, thawPathId id, const thawPathDef* def) {
    return guarded(world, [&](World& w, Check& c) {
        checkPath(c, w, def);
        if (c.ok() && !alive(w, id, w.pathSlots)) c.fail(thawResult_staleId, "path: is not alive in this world");
        if (!c.ok()) return;
        std::string message;
        uint32_t index1 = id.index1;
        if (const thawResult r = w.setPath(*def, message, index1); r != thawResult_ok) c.fail(r, "%s", message.c_str());
    });
}

thawResult thawDestroyPath(thawWorld* world, thawPathId id) {
    return guarded(world, [&](World& w, Check& c) {
        if (!alive(w, id, w.pathSlots)) return c.fail(thawResult_staleId, "path: is not alive in this world");
        w.removePath(id.index1 - 1);
    });
}

thawResult thawPath_GetState(const thawWorld* world, thawPathId id, thawPathState* out) {
    if (!world || !out) return thawResult_invalidArgument;
    *out = {};
    if (!alive(world->world, id, world->world.pathSlots)) return thawResult_staleId;
    *out = world->world.pathState(id.index1 - 1);
    return thawResult_ok;
}

void thawInitShapeDef(thawShapeDef* def) {
    if (!def) return;
    *def = thawShapeDef{};
    def->structSize = sizeof *def, def->cookie = thaw::kDefCookie;
    def->rotation = {0, 0, 0, 1}, def->scale = 1;
    def->enabled = def->sets = true;
    def->strength = 1, def->speed = 0.1f, def->setFill = 0.9f, def->setTime = 2;
}

thawResult thawCreateShape(thawWorld* world, const thawShapeDef* def, thawShapeId* outId) {
    return guarded(world, [&](World& w, Check& c) {
        if (!outId) return c.fail(thawResult_invalidArgument, "outId: is NULL");
        *outId = {};
        checkShape(c, w, def);
        if (!c.ok()) return;
        std::string message;
        uint32_t index1 = 0;
        if (const thawResult r = w.setShape(*def, message, index1); r != thawResult_ok)
            return c.fail(r, "%s", message.c_str());
        *outId = {index1, w.tag, w.shapeSlots[index1 - 1].generation};
    });
}

thawResult thawShape_Set(thawWorld* world, thawShapeId id, const thawShapeDef* def) {
    return guarded(world, [&](World& w, Check& c) {
        checkShape(c, w, def);
        if (c.ok() && !alive(w, id, w.shapeSlots)) c.fail(thawResult_staleId, "shape: is not alive in this world");
        if (!c.ok()) return;
        std::string message;
        uint32_t index1 = id.index1;
        if (const thawResult r = w.setShape(*def, message, index1); r != thawResult_ok)
            c.fail(r, "%s", message.c_str());
    });
}

thawResult thawDestroyShape(thawWorld* world, thawShapeId id) {
    return guarded(world, [&](World& w, Check& c) {
        if (!alive(w, id, w.shapeSlots)) return c.fail(thawResult_staleId, "shape: is not alive in this world");
        w.removeShape(id.index1 - 1);
    });
}

thawResult thawShape_GetState(const thawWorld* world, thawShapeId id, thawShapeState* out) {
    if (!world || !out) return thawResult_invalidArgument;
    *out = {};
    if (!alive(world->world, id, world->world.shapeSlots)) return thawResult_staleId;
    *out = world->world.shapeState(id.index1 - 1);
    return thawResult_ok;
}

void thawInitBudget(thawBudget* budget) {
    if (budget) *budget = defaultBudget();
}

void thawWorld_GetPlan(const thawWorld* world, thawPlan* out) {
    if (world && out) *out = world->world.plan;
}

thawResult thawWorld_PreviewPlan(const thawWorld* world, const thawBudget* budget, thawPlan* out) {
    if (!world || !out) return thawResult_invalidArgument;
    const thawBudget b = budget ? *budget : defaultBudget();
    Check c;
    try {
        checkBudget(c, b);
    } catch (...) {
        return thawResult_outOfMemory;
    }
    if (!c.ok()) return c.result;
    *out = world->world.previewPlan(b);
    return thawResult_ok;
}

uint32_t thawWorld_Step(thawWorld* world, float timeStep, const thawBudget* budget) {
    if (!world) return thawStep_refused;
    uint32_t status = thawStep_refused;
    const thawResult result = guarded(world, [&](World& w, Check& c) {
        c.range("timeStep", timeStep, 1e-5, 0.25);
        const thawBudget b = budget ? *budget : defaultBudget();
        checkBudget(c, b);
        if (c.ok()) status = w.step(timeStep, b);
    });
    return result == thawResult_ok ? status : static_cast<uint32_t>(thawStep_refused);
}

void thawWorld_GetParticles(const thawWorld* world, thawParticleView* out) {
    if (!out) return;
    *out = {};
    if (!world) return;
    const thaw::Particles& p = world->world.particles;
    out->count = p.count;
    out->moving = p.moverCount;
    out->positions = &p.position[0].x;
    out->velocities = &p.velocity[0].x;
    out->temperatures = p.temperature.data();
    out->liquidFractions = p.liquidFraction.data();
    out->normals = &p.normal[0].x;
    out->ids = p.id.data();
    out->bodies = p.body.data();
    out->materials = p.material.data();
    out->flags = p.flags.data();
    out->absorptivities = p.absorbs.data();
    out->levels = p.level.data();
}

thawResult thawWorld_GetFeatureSizes(thawWorld* world, const float** out) {
    if (out) *out = nullptr;
    return guarded(world, [&](World& w, Check& c) {
        if (!out) c.fail(thawResult_invalidArgument, "out: is NULL");
        if (c.ok()) *out = w.featureSizes();
    });
}

thawResult thawWorld_GetSplats(thawWorld* world, thawSplatView* out) {
    if (out) *out = {};
    return guarded(world, [&](World& w, Check& c) {
        if (!out) c.fail(thawResult_invalidArgument, "out: is NULL");
        if (c.ok()) *out = w.splats();
    });
}

void thawInitSurfaceDef(thawSurfaceDef* def) {
    if (!def) return;
    *def = thawSurfaceDef{};
    def->structSize = sizeof *def, def->cookie = thaw::kDefCookie;
    def->cellSize = 0.75f;
    def->smoothing = 1;
}

thawResult thawWorld_ExtractSurface(thawWorld* world, const thawSurfaceDef* def, thawSurfaceView* out) {
    if (out) *out = {};
    return guarded(world, [&](World& w, Check& c) {
        checkSurfaceDef(c, def);
        if (!out) c.fail(thawResult_invalidArgument, "out: is NULL");
        if (w.surfaceUnderWay()) c.fail(thawResult_invalidArgument, "a surface is under way: finish it first");
        if (c.ok()) w.extractSurface(*def, *out);
    });
}

thawResult thawWorld_StartSurface(thawWorld* world, const thawSurfaceDef* def) {
    return guarded(world, [&](World& w, Check& c) {
        checkSurfaceDef(c, def);
        if (w.surfaceUnderWay()) c.fail(thawResult_invalidArgument, "a surface is under way: finish it first");
        if (c.ok()) w.startSurface(*def);
    });
}

thawResult thawWorld_FinishSurface(thawWorld* world, thawSurfaceView* out) {
    if (out) *out = {};
    return guarded(world, [&](World& w, Check& c) {
        if (!out) c.fail(thawResult_invalidArgument, "out: is NULL");
        if (!w.surfaceUnderWay()) c.fail(thawResult_invalidArgument, "no surface is under way: start one first");
        if (c.ok()) w.finishSurface(*out);
    });
}

void thawInitSurfaceBuffers(thawSurfaceBuffers* buffers) {
    if (!buffers) return;
    *buffers = thawSurfaceBuffers{};
    buffers->structSize = sizeof *buffers, buffers->cookie = thaw::kDefCookie;
    buffers->vertexStride = 32, buffers->indexSize = 4;
    buffers->normalOffset = 12, buffers->temperatureOffset = 24, buffers->liquidFractionOffset = 28;
    buffers->materialOffset = buffers->bodyOffset = buffers->mixtureOffset = -1;
}

thawResult thawWorld_WriteSurface(thawWorld* world, const thawSurfaceView* view, const thawSurfaceBuffers* buffers) {
    return guarded(world, [&](World& w, Check& c) {
        if (!view) c.fail(thawResult_invalidArgument, "view: is NULL");
        c.initialised("surfaceBuffers", buffers);
        if (c.ok()) checkSurfaceBuffers(c, *view, *buffers);
        if (c.ok()) writeSurface(*view, *buffers, w.tasks);
    });
}

int32_t thawWorld_GetPieces(const thawWorld* world, thawPieceState* out, int32_t capacity) {
    return world ? world->world.pieces(out, out ? capacity : 0) : 0;
}

void thawWorld_GetLedger(const thawWorld* world, thawLedger* out) {
    if (world && out) *out = world->world.ledger();
}

void thawWorld_GetCounters(const thawWorld* world, thawCounters* out) {
    if (world && out) *out = world->world.counters();
}

void thawWorld_GetProfile(const thawWorld* world, thawProfile* out) {
    if (world && out) *out = world->world.profile;
}

size_t thawWorld_GetSnapshotSize(const thawWorld* world, thawSnapshotKind kind) {
    const int k = valueOf(kind);
    if (!world || (k != thawSnapshot_world && k != thawSnapshot_full)) return 0;
    try {
        return world->world.snapshotSize(k == thawSnapshot_full);
    } catch (...) {
        return 0;
    }
}

thawResult thawWorld_Save(const thawWorld* world, thawSnapshotKind kind, void* buffer, size_t capacity,
                          size_t* written) {
    if (written) *written = 0;
    const int k = valueOf(kind);
    if (!world || (!buffer && capacity > 0) || (k != thawSnapshot_world && k != thawSnapshot_full))
        return thawResult_invalidArgument;
    try {
        const size_t n = world->world.save(buffer, capacity, k == thawSnapshot_full);
        if (written) *written = n;
        return n > 0 ? thawResult_ok : thawResult_capacity;
    } catch (...) {
        return thawResult_outOfMemory;
    }
}

thawResult thawWorld_Restore(thawWorld* world, const void* image, size_t size) {
    return guarded(world, [&](World& w, Check& c) {
        if (!image) return c.fail(thawResult_invalidArgument, "image: is NULL");
        std::string message;
        if (const thawResult r = w.restore(image, size, message); r != thawResult_ok) c.fail(r, "%s", message.c_str());
    });
}

thawResult thawWorld_ForgetSnapshots(thawWorld* world, const void* oldest, size_t size) {
    return guarded(world, [&](World& w, Check& c) {
        std::string message;
        if (!w.forgetSnapshots(oldest, size, message)) c.fail(thawResult_badImage, "%s", message.c_str());
    });
}

uint16_t thawWorld_GetIdTag(const thawWorld* world) { return world ? world->world.tag : uint16_t{0}; }

uint64_t thawWorld_GetStateHash(const thawWorld* world) { return world ? world->world.stateHash() : 0; }

} // extern "C"
