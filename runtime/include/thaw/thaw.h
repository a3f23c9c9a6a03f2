/* SPDX-FileCopyrightText: 2026 the thaw authors
 * SPDX-License-Identifier: MIT
 *
 * thaw: objects that melt, drip, pool and set again, inside a fixed slice of every frame, on the CPU.
 *
 * Conventions that hold for every function:
 *  - SI units, kelvin, seconds; right-handed; +y is up in the default gravity.
 *  - A world is a pointer that the host owns. What is in a world is an 8-byte id by value: all zero is null; a stale id
 *    and the id of another world are refused.
 *  - Definitions are filled by the library (thawInit*): fill, change what you like, pass. A definition that was not
 *    filled is refused. Pointers in a definition are read during the call only.
 *  - Nothing throws, prints or aborts. A refused call changes nothing, and thawWorld_GetLastError names the field and
 *    the value.
 *  - A world is used from one thread at a time; calls that take a const world may run together between steps; different
 *    worlds are independent of each other. There is no global state.
 *  - Views (const pointers into a world) stay valid until the next call that takes that world without const.
 */
#ifndef THAW_H
#define THAW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(THAW_STATIC)
#define THAW_API
#elif defined(_WIN32)
#if defined(THAW_BUILDING)
#define THAW_API __declspec(dllexport)
#else
#define THAW_API __declspec(dllimport)
#endif
#else
#define THAW_API __attribute__((visibility("default")))
#endif

/* major * 10000 + minor * 100 + patch */
#define THAW_VERSION 100

#ifdef __cplusplus
extern "C" {
#endif

/* ---- results ---------------------------------------------------------------------------------------------------- */

typedef enum thawResult {
    thawResult_ok = 0,
    thawResult_invalidArgument, /* a pointer, an enum, a number out of range or not finite */
    thawResult_notInitialised,  /* a definition that no thawInit function filled */
    thawResult_staleId,         /* the id is null, destroyed, or of another world */
    thawResult_outOfMemory,     /* the allocator refused */
    thawResult_capacity,        /* a maximum of the world definition is reached */
    thawResult_badMesh,         /* a mesh that encloses nothing that can be filled; the message says why */
    thawResult_internal,        /* a fault of the library; please report it with the message */
    thawResult_badImage         /* an image of a world that cannot be read; the message says why */
} thawResult;

/* Bits that thawWorld_Step returns. The step always finishes; the bits say what it had to give up. */
typedef enum thawStepStatus {
    thawStep_ok = 0,
    thawStep_refused = 1 << 0,           /* an argument was refused, nothing was stepped: see thawWorld_GetLastError */
    thawStep_iterationsClipped = 1 << 1, /* the viscosity solve stopped at its cap before it met its tolerance */
    thawStep_subStepsClipped = 1 << 2,   /* depth or speed asked for more sub-steps than the plan allowed */
    thawStep_velocityClamped = 1 << 3,   /* some particle was faster than the speed limit and was slowed */
    thawStep_neighborsClipped = 1 << 4,  /* some particle had more neighbours than a list holds */
    thawStep_badParticlesRemoved = 1 << 5, /* some particle became not finite and was taken out; see the ledger */
    thawStep_raysReduced = 1 << 6,         /* only part of the visibility rays was refreshed */
    thawStep_overBudget = 1 << 7,    /* the step took longer than its budget, or its least work costs more units */
    thawStep_splitsClipped = 1 << 8, /* some particles stayed coarser than they should be: maxParticles, or splits */
    thawStep_late = 1 << 9 /* the step ran late and gave up iterations, rays or splits on its way; see lateAfter */
} thawStepStatus;

/* THAW_VERSION of the library that runs; differs from the macro when headers and library differ. */
THAW_API int thawGetVersion(void);
/* Compiler, version and instruction set in use; for bug reports and golden files. Static storage. */
THAW_API const char* thawGetBuildString(void);
/* Name of a result, "unknown" when out of range. Static storage. */
THAW_API const char* thawResultString(thawResult result);
/* What one thawStepStatus bit means, in words; "" for 0 or several bits. Static storage. */
THAW_API const char* thawStepStatusString(uint32_t bit);

/* ---- handles and small types ------------------------------------------------------------------------------------ */

typedef struct thawWorld thawWorld;
typedef struct thawMaterialId {
    uint32_t index1;
    uint16_t world, generation;
} thawMaterialId;
typedef struct thawBodyId {
    uint32_t index1;
    uint16_t world, generation;
} thawBodyId;
typedef struct thawColliderId {
    uint32_t index1;
    uint16_t world, generation;
} thawColliderId;
typedef struct thawHeatSourceId {
    uint32_t index1;
    uint16_t world, generation;
} thawHeatSourceId;
typedef struct thawPathId {
    uint32_t index1;
    uint16_t world, generation;
} thawPathId;

typedef struct thawShapeId {
    uint32_t index1;
    uint16_t world, generation;
} thawShapeId;

typedef struct thawVec3 {
    float x, y, z;
} thawVec3;
typedef struct thawQuat {
    float x, y, z, w;
} thawQuat; /* unit quaternion; {0,0,0,1} is no rotation */

/* ---- hooks ------------------------------------------------------------------------------------------------------ */

/* Memory of what a world steps: particles, lists, scratch, surface. Both NULL: the C++ runtime's. alloc must return
 * memory aligned to `alignment` (a power of two, at most 64) or NULL. Called from the thread that calls thaw, and
 * from the one that makes a mesh after thawWorld_StartSurface, one at a time.
 * Creating bodies and colliders also uses the C++ runtime while it works, and rays use Embree's own memory. */
typedef struct thawAllocator {
    void* (*alloc)(size_t size, size_t alignment, void* user);
    void (*free)(void* memory, size_t size, void* user);
    void* user;
} thawAllocator;

typedef enum thawLogLevel { thawLog_info = 0, thawLog_warning = 1, thawLog_error = 2 } thawLogLevel;

/* Messages of a world; NULL: none. `message` is valid during the call only. */
typedef struct thawLogger {
    void (*log)(thawLogLevel level, thawResult code, const char* message, void* user);
    void* user;
} thawLogger;

typedef void thawTask(void* context);

/* The host's threads. enqueue hands over one task and returns a handle for finish, or NULL when it already ran it
 * inline; finish blocks until that task is done. Both are called from the thread that calls thaw, at most workerCount -
 * 1 tasks are in flight, and one more between thawWorld_StartSurface and thawWorld_FinishSurface. All NULL: a pool of
 * workerCount - 1 own threads, and one more from the first thawWorld_StartSurface on. */
typedef struct thawTaskSystem {
    int workerCount; /* threads that take part, the caller included; range 1..64, default 1 */
    void* (*enqueue)(thawTask* task, void* context, void* user);
    void (*finish)(void* handle, void* user);
    void* user;
} thawTaskSystem;

/* A way from a particle's surface to a point of a heat source. */
typedef struct thawRay {
    thawVec3 origin;    /* m, half a spacing out of the particle's centre */
    thawVec3 direction; /* unit, to the source */
    float distance;     /* m, to the source; 1e5 for directional light */
    uint32_t particle;  /* id of the particle that looks */
} thawRay;

/* The host's own ray casts in place of Embree: who stands between the melt and the heat. occluded sets blocked[i],
 * which comes in false, for every ray whose way is not free. It is called during steps from the thread that calls thaw,
 * with at most 512 rays. The same answers give the same bits. NULL: colliders that are occluders, through Embree. */
typedef struct thawRaySystem {
    void (*occluded)(const thawRay* rays, int32_t count, bool* blocked, void* user);
    bool melt; /* true: it answers for the melt as well and Embree is never started; false: the melt shades itself */
    void* user;
} thawRaySystem;

/* ---- world ------------------------------------------------------------------------------------------------------ */

typedef struct thawWorldDef {
    uint32_t structSize, cookie;
    float particleSpacing;    /* m, distance of neighbouring particles at level 0; range 1e-4..1, default 0.002 */
    int32_t maxParticles;     /* range 8..4000000, default 32768; memory for them is taken at creation */
    int32_t maxMaterials;     /* range 1..255, default 16 */
    int32_t maxBodies;        /* range 1..65535, default 64 */
    int32_t maxColliders;     /* range 1..65535, default 64 */
    int32_t maxHeatSources;   /* range 1..1024, default 16 */
    int32_t maxPaths;         /* range 1..1024, default 64 */
    int32_t maxShapes;        /* range 1..1024, default 64 */
    thawVec3 gravity;         /* m/s^2, each |.| <= 1000, default (0, -9.81, 0) */
    float ambientTemperature; /* K, range 0..1e5, default 293.15; air and far surroundings */
    float convection;         /* W/(m^2 K), heat transfer to ambient air; range 0..1e4, default 10 */
    float
        thermalTimeScale; /* heat seconds per second of motion; range 0..1e5, default 1. Real melting takes minutes. */
    thawAllocator allocator;
    thawLogger logger;
    thawTaskSystem tasks;
    thawRaySystem rays;
} thawWorldDef;

THAW_API void thawInitWorldDef(thawWorldDef* def);
/* Makes a world. On success *outWorld is set and is to be given to thawDestroyWorld. On failure *outWorld is NULL and,
 * when message is not NULL, up to messageSize - 1 characters say why. */
THAW_API thawResult thawCreateWorld(const thawWorldDef* def, thawWorld** outWorld, char* message, size_t messageSize);
/* NULL is allowed. Ends the world's own threads. */
THAW_API void thawDestroyWorld(thawWorld* world);
/* Message of the last refused call on this world, "" when there was none. */
THAW_API const char* thawWorld_GetLastError(const thawWorld* world);

THAW_API thawResult thawWorld_SetGravity(thawWorld* world, thawVec3 gravity);
THAW_API thawResult thawWorld_SetAmbient(thawWorld* world, float temperature, float convection);
THAW_API thawResult thawWorld_SetThermalTimeScale(thawWorld* world, float scale);

/* ---- materials -------------------------------------------------------------------------------------------------- */

typedef enum thawMaterialPreset {
    thawMaterial_wax = 0,   /* paraffin */
    thawMaterial_chocolate, /* milk */
    thawMaterial_butter,
    thawMaterial_ice,
    thawMaterial_icecream,
    thawMaterial_darkchocolate,
    thawMaterial_aluminium,
    thawMaterial_iron,
    thawMaterial_lava, /* basalt */
    thawMaterial_presetCount
} thawMaterialPreset;

/* Shear stress tau of a melt with a yield stress tau_y, at shear rate g and viscosity mu. */
typedef enum thawFlow {
    thawFlow_bingham = 0, /* tau = tau_y + mu g */
    thawFlow_casson       /* sqrt(tau) = sqrt(tau_y) + sqrt(mu g) */
} thawFlow;

typedef struct thawMaterialDef {
    uint32_t structSize, cookie;
    float density;           /* kg/m^3, range 1..3e4. One value for both phases: volume does not change on melting */
    float solidus, liquidus; /* K, melting begins and ends; 0 < solidus <= liquidus <= 1e5 */
    float latentHeat;        /* J/kg, range 0..1e7 */
    float specificHeatSolid, specificHeatLiquid; /* J/(kg K), range 1..1e5 */
    float conductivitySolid, conductivityLiquid; /* W/(m K), range 0..1e4 */
    float viscositySolid;  /* Pa s at liquid fraction 0 for mush and pieces that lost their hold; range 1e-3..1e7 */
    float viscosityLiquid; /* Pa s at liquid fraction 1; range 1e-4..1e6. log-blended between (RESEARCH 3.4) */
    float yieldStress;  /* Pa, below which the melt does not flow; range 0..1e6, 0: flows at any stress (Newtonian) */
    thawFlow flow;      /* how stress grows above yieldStress; not read when that is 0 */
    float absorptivity; /* 1, share of incoming radiation that is taken up; range 0..1 */
    float emissivity;   /* 1, of thermal radiation; range 0..1 */
    float cohesion;     /* 1, pull between particles in units of g / 10; range 0..20; makes beads */
    float adhesion;     /* 1, pull toward solid wax and walls in units of g; range 0..5; makes films cling */
    float setFraction;  /* liquid fraction below which liquid that touches a solid sets; range 0..releaseFraction */
    float releaseFraction; /* liquid fraction above which solid lets go; range setFraction..1 */
    thawVec3 color;        /* linear RGB 0..1, for whoever draws it */
    /* Elastic solid; Poisson's ratio is 1/4 and viscositySolid damps it. */
    float youngModulus; /* Pa at liquid fraction 0, falls to nothing at releaseFraction as (1 - phi/release)^2; range
                           0..1e8; 0, the default: rigid. What stiffness a step can follow, see docs/step.md */
    float solidYieldStress; /* Pa, von Mises stress above which the solid flows; range 0..1e8; 0, the default: never */
    float relaxationTime; /* s, shear stress of the solid falls as e^(-t / this); range 0..1e9; 0, the default: never */
    float breakStrain;    /* 1, elastic stretch at which the solid tears; range 0..1; 0, the default: never */
    /* Burn-off: what is hotter than this turns to vapour, particle by particle. */
    float burnTemperature; /* K, range liquidus..1e5, or 0, the default: never */
    float vapourHeat;      /* J/kg above burnTemperature that a particle must have to go, and takes along; range 0..1e8,
                              default 0 */
    float burnRate; /* 1/s of heat time, of what may go; range 0..1e6, default 1: a share 1 - e^(-burnRate t) is gone */
    /* Undercooling: what has molten through stays liquid below solidus (its liquid fraction stays 1) until it is this
       much colder, or until a neighbour of the same material that is not all liquid touches it, which is looked for
       once in each step of heat. Then it goes, its enthalpy kept, to where that is between solidus and liquidus: it
       warms. */
    float undercooling; /* K, range 0..1000 and below solidus; 0, the default: sets at liquidus to solidus */
} thawMaterialDef;

/* Fills with a preset. An unknown preset fills with wax. Sources of the numbers: third_party_notes/data_sources.md. */
THAW_API void thawInitMaterialDef(thawMaterialDef* def, thawMaterialPreset preset);
/* "wax", "chocolate", ...; NULL when out of range. Static storage. */
THAW_API const char* thawMaterialPresetName(thawMaterialPreset preset);
/* Materials live as long as their world. */
THAW_API thawResult thawCreateMaterial(thawWorld* world, const thawMaterialDef* def, thawMaterialId* outId);
/* Replaces every property, also while there is matter of it; takes effect in the next step and costs one look at all
 * particles, so that it may be called before every step. What is there keeps
 *  - its temperature: it is as liquid as the new melting range makes it, and without a range, exactly at its melting
 *    point, as it was. The heat is in thawLedger.redefined. Where nothing of solidus, liquidus, latentHeat and the
 *    specific heats is another, its heat stays to the last bit. Below solidus and liquid, it stays so down to the new
 *    undercooling, and without one it sets and warms, its heat kept.
 *  - its volume and velocity: with another density it has another mass, and pressure by as much. The difference is in
 *    massAdded, energyAdded, massRemoved and energyRemoved of the ledger.
 *  - its form: rigid solid that becomes elastic (youngModulus) is free of stress as it is, elastic solid that becomes
 *    rigid stays as it is bent. Elastic solid that sleeps wakes.
 * thawResult_capacity when coarse particles have to split to become elastic and maxParticles leaves no room for it. */
THAW_API thawResult thawMaterial_Set(thawWorld* world, thawMaterialId id, const thawMaterialDef* def);

/* ---- meshes ----------------------------------------------------------------------------------------------------- */

typedef struct thawMesh {
    const float* vertices;   /* x y z of each vertex, m */
    size_t vertexCount;      /* at most 50 million */
    const uint32_t* indices; /* three per triangle, counter-clockwise seen from outside (repaired when not) */
    size_t triangleCount;    /* at most 100 million */
} thawMesh;

/* What was found in a mesh and repaired while it was filled. */
typedef struct thawMeshReport {
    uint32_t duplicateVertices;   /* welded */
    uint32_t degenerateTriangles; /* without area, or naming a vertex twice: ignored */
    uint32_t openEdges;           /* edges with one triangle: holes, closed by the winding number */
    uint32_t nonManifoldEdges;    /* edges with more than two triangles */
    uint32_t inconsistentEdges;   /* edges whose two triangles disagree about the outside */
    uint32_t components;          /* pieces that share no edge */
    bool inverted;                /* faces looked inward as a whole and were turned */
    double volume;                /* m^3 enclosed */
    double area;                  /* m^2 */
} thawMeshReport;

/* ---- bodies ----------------------------------------------------------------------------------------------------- */

/* A part of a body that is of another material: a shell around a core, a wick. */
typedef struct thawBodyPart {
    thawMaterialId material;
    thawMesh mesh; /* closed, in the space of the body's mesh; what lies inside of it. All zero: use depth */
    float depth;   /* m, what lies deeper beneath the body's surface; range 1e-6..1e4 without a mesh, 0 with one */
} thawBodyPart;

typedef struct thawBodyDef {
    uint32_t structSize, cookie;
    thawMaterialId material;
    thawMesh mesh;             /* closed, or nearly so; filled with particles */
    thawVec3 position;         /* m, default 0 */
    thawQuat rotation;         /* default none */
    float scale;               /* 1, range 1e-6..1e6, default 1 */
    float temperature;         /* K at the start, range 0..1e5; default: the world's ambient (NaN stands for it) */
    thawVec3 velocity;         /* m/s at the start, of what is liquid or free; each |.| <= 1000, default 0 */
    thawVec3 angularVelocity;  /* rad/s about the centre of mass, right-handed; each |.| <= 1000, default 0 */
    const thawBodyPart* parts; /* partCount of them; where parts overlap the later one counts; default NULL */
    int32_t partCount;         /* range 0..64, default 0 */
    int32_t coarsestLevel; /* its solid starts with particles of up to 2^this times the mass of the finest, which split
                              before heat or anything that moves gets to them; its liquid merges to as much where it
                              is thick (half of the extended local feature size); range 0..3, default 0. Elastic
                              solids are either at 3 or at 0: coarse where this is 3 */
    bool anchored; /* default true: solid that hangs together with a collider is stuck to it. false: it stands free, a
                      rigid piece that can be pushed and fall over */
} thawBodyDef;

THAW_API void thawInitBodyDef(thawBodyDef* def);
/* Fills the mesh with particles. Refused, with the reason, when the mesh encloses nothing or the particles do not fit.
 * report may be NULL; it is filled also when the mesh is refused. */
THAW_API thawResult thawCreateBody(thawWorld* world, const thawBodyDef* def, thawBodyId* outId, thawMeshReport* report);
THAW_API thawResult thawDestroyBody(thawWorld* world, thawBodyId id);

typedef struct thawBodyState {
    int32_t particles;     /* that belong to it now */
    float mass;            /* kg */
    float meltedFraction;  /* 1, mass-weighted liquid fraction */
    float meanTemperature; /* K, mass-weighted */
    thawVec3 center;       /* m, centre of mass */
    thawVec3 lower, upper; /* m, bounds of the particle centres */
} thawBodyState;
THAW_API thawResult thawBody_GetState(const thawWorld* world, thawBodyId id, thawBodyState* out);

/* Where paint goes: a ball in the world. */
typedef struct thawBrush {
    thawVec3 center; /* m, each within 1e6 */
    float radius;    /* m, range 1e-6..1e4 */
    float falloff;   /* 1, the outer share of the radius over which the effect fades to none; range 0..1, 0: a sharp
                        edge, all of it inside */
} thawBrush;
/* Gives the body's particles in the brush a temperature (K, range 0..1e5), or where the brush fades what lies so much
 * of the way to it from their own. They melt or set as if made with it; the heat is in thawLedger.painted. *painted,
 * which may be NULL, is how many were in it. Deterministic; paint again for more than one spot. Coarse particles that
 * the brush touches split to the finest first (thawBodyDef.coarsestLevel); where maxParticles leaves no room for that,
 * they stay and are painted whole when their middle is in the brush. */
THAW_API thawResult thawBody_PaintTemperature(thawWorld* world, thawBodyId id, const thawBrush* brush,
                                              float temperature, int32_t* painted);
/* The same with the share of incoming radiation that they take up (range 0..1, in steps of 1/254), in place of their
 * material's, which it is until then. It stays with the particles: black wax that runs is black. */
THAW_API thawResult thawBody_PaintAbsorptivity(thawWorld* world, thawBodyId id, const thawBrush* brush,
                                               float absorptivity, int32_t* painted);

/* ---- colliders -------------------------------------------------------------------------------------------------- */

typedef enum thawColliderType {
    thawCollider_plane = 0, /* solid below: normal is local +y through the position */
    thawCollider_box,       /* half extents in size */
    thawCollider_sphere,    /* radius in size.x */
    thawCollider_mesh       /* solid inside a closed mesh */
} thawColliderType;

typedef struct thawColliderDef {
    uint32_t structSize, cookie;
    thawColliderType type;
    thawVec3 position; /* m */
    thawQuat rotation;
    thawVec3 size;      /* m, see the type; each > 0, at most 1e4 */
    thawMesh mesh;      /* for thawCollider_mesh; copied */
    float scale;        /* 1, of the mesh; range 1e-6..1e6, default 1 */
    bool adhesive;      /* melt clings to it; default true. Floors are not clung to whatever is set. */
    bool occluder;      /* shades heat sources; default true */
    float slipLength;   /* m, Navier slip of liquids: their speed would be the wall's so far behind it; range 0..1e4,
                           default 0 (sticks), 1e4 slides freely */
    float friction;     /* 1, Coulomb coefficient for what is solid; range 0..10, default 0.5 */
    bool reportImpulse; /* measure what acts on it, for thawCollider_GetImpulse; default false */
    float temperature;  /* K, heats and cools what touches it; range 0..1e5; NaN, the default: exchanges no heat */
    float contactConductance; /* W/(m^2 K), of the contact, in series with the melt's own conduction; range 0..infinity,
                                 default infinity (perfect contact); a hand about 500, a pan on metal 3000 */
} thawColliderDef;

THAW_API void thawInitColliderDef(thawColliderDef* def, thawColliderType type);
THAW_API thawResult thawCreateCollider(thawWorld* world, const thawColliderDef* def, thawColliderId* outId,
                                       thawMeshReport* report);
THAW_API thawResult thawDestroyCollider(thawWorld* world, thawColliderId id);
/* Kinematic motion: where the collider shall be at the end of the next step, which gives it the velocity that takes it
 * there: straight, and turning the short way round (less than half a turn a step). Held material that hangs on it goes
 * along rigidly; what it runs into is pushed. To be called before every step in which it moves; without, it stands
 * still. position: m, each within 1e5. */
THAW_API thawResult thawCollider_SetTransform(thawWorld* world, thawColliderId id, thawVec3 position,
                                              thawQuat rotation);
/* A jump without velocity, at once. What hung on it stays behind; what it lands on is pushed out. */
THAW_API thawResult thawCollider_Teleport(thawWorld* world, thawColliderId id, thawVec3 position, thawQuat rotation);
THAW_API thawResult thawCollider_GetTransform(const thawWorld* world, thawColliderId id, thawVec3* position,
                                              thawQuat* rotation);

/* How it touches from the next step on: adhesive, occluder, slipLength and friction as in thawColliderDef. What hangs
 * on it goes on hanging, what sleeps wakes. May be called before every step. */
THAW_API thawResult thawCollider_SetSurface(thawWorld* world, thawColliderId id, bool adhesive, bool occluder,
                                            float slipLength, float friction);

/* What it heats or cools from the next step on: temperature and contactConductance as in thawColliderDef; a NaN
 * temperature switches it off. May be called before every step. */
THAW_API thawResult thawCollider_SetHeat(thawWorld* world, thawColliderId id, float temperature,
                                         float contactConductance);

/* What acted on a collider during the last step: pressure, drag, adhesion and contact of the melt, weight and inertia
 * of what hangs on it. Divided by the time step: force in N and torque in N m, for a host's rigid body. */
typedef struct thawColliderImpulse {
    thawVec3 linear;  /* N s */
    thawVec3 angular; /* N m s, about the collider's position */
} thawColliderImpulse;
/* invalidArgument for a collider that was made without reportImpulse. */
THAW_API thawResult thawCollider_GetImpulse(const thawWorld* world, thawColliderId id, thawColliderImpulse* out);

/* ---- heat sources ----------------------------------------------------------------------------------------------- */

/* Sources with a temperature radiate evenly from all over their surface (Lambert). What they give is net of the ambient
 * radiation that they hide: at ambient temperature nothing, below it they cool. Colliders that are occluders and the
 * melt itself shade; what is half hidden gives half. */
typedef enum thawHeatSourceType {
    thawHeatSource_point = 0, /* power in all directions alike, inverse square */
    thawHeatSource_sphere, /* radius, temperature: a flame, a lamp, a coal. Inside of it all is lit from all around */
    thawHeatSource_rectangle,  /* size.x by size.z about position, shines to local +y only: a heater, an oven's door */
    thawHeatSource_disc,       /* radius, shines to local +y only */
    thawHeatSource_directional /* irradiance, along local +y, everywhere: the sun */
} thawHeatSourceType;

typedef struct thawHeatSourceDef {
    uint32_t structSize, cookie;
    thawVec3 position; /* m, each within 1e6; the centre; not read for directional */
    float power;       /* W, point: radiated evenly in all directions; range -1e12..1e12 (negative cools), default 20 */
    float radius;      /* m, range 1e-4..10, default 0.005; point: no surface gets closer in the inverse-square law */
    bool enabled;      /* default true */
    thawHeatSourceType type; /* default thawHeatSource_point */
    thawQuat rotation;       /* rectangle, disc, directional; default none: shines upward */
    thawVec3
        size; /* m, rectangle: half extents in size.x and size.z, each 1e-4..1e4, default 0.05; size.y is not read */
    float temperature; /* K, sphere, rectangle, disc; range 0..1e9, default 1300. Nothing that it heats passes 1e5 K */
    float emissivity;  /* 1, of the same; range 0..1, default 1. exitance: emissivity sigma (T^4 - ambient^4) */
    float irradiance;  /* W/m^2, directional, on a surface that faces it; range -1e12..1e12, default 1000 */
} thawHeatSourceDef;

THAW_API void thawInitHeatSourceDef(thawHeatSourceDef* def);
THAW_API thawResult thawCreateHeatSource(thawWorld* world, const thawHeatSourceDef* def, thawHeatSourceId* outId);
/* Replaces every property; takes effect in the next step. */
THAW_API thawResult thawHeatSource_Set(thawWorld* world, thawHeatSourceId id, const thawHeatSourceDef* def);
THAW_API thawResult thawDestroyHeatSource(thawWorld* world, thawHeatSourceId id);

/* ---- control: where the melt goes ------------------------------------------------------------------------------- */

/* A line that melt flows along. What comes within `reach` of it is drawn to it and follows it until it is at the end or
 * a quarter more than the reach away. Within `radius`, the half width of the stream, it is driven at the speed of the
 * path; outside of the inner half of the radius it is drawn back. Both as by a drag inside the viscous solve. What is
 * finer than a particle's neighbourhood stays as it is, the more the less the strength. Where several paths begin
 * together and part later, what follows is shared among them by their `share`. */
typedef struct thawPathDef {
    uint32_t structSize, cookie;
    const thawVec3* points;  /* m, pointCount of them, in the order of the flow, each within 1e5; points that coincide
                                count  once. In the space of the collider, if one is given */
    int32_t pointCount;      /* range 2..1000000; at least two must differ */
    bool smooth;             /* default true: a spline through the points (centripetal Catmull-Rom); false: straight */
    bool enabled;            /* default true */
    thawColliderId collider; /* that it moves with, and is destroyed with; default null: it stands still */
    float radius;            /* m, half the width of the stream, range 1e-4..10, default 0.01 */
    float reach;       /* m, from where melt is drawn to it, range 1e-4..10, at least the radius; default 0: twice the
                          radius */
    float strength;    /* 0: nothing, 0.5: a hint, 1: a lock; range 0..1, default 0.8 */
    float speed;       /* m/s along it, range 0..100, default 0.05; 0: its own */
    float arrivalTime; /* s from when the first melt follows it to when it is at the end, goes before speed; range
                          0..1e4, default 0: speed counts */
    float share;       /* of what flows where paths part, in relation to theirs; range 0..1e6, default 1 */
    int32_t priority;  /* where paths cross, melt that follows none yet takes the highest; default 0 */
    float beadSpacing; /* m along it between beads that the stream is drawn together into; range 2 radius..10, default
                          0: none, it is even */
    float startAbsorptivity; /* 1, of thermal radiation, at the first point, fading over a radius: melting starts there;
                               range 0..1, default NaN: the material's */
} thawPathDef;
THAW_API void thawInitPathDef(thawPathDef* def);
THAW_API thawResult thawCreatePath(thawWorld* world, const thawPathDef* def, thawPathId* outId);
/* Replaces every property; takes effect in the next step. What follows it goes on from where it is nearest. */
THAW_API thawResult thawPath_Set(thawWorld* world, thawPathId id, const thawPathDef* def);
/* What followed it flows freely. */
THAW_API thawResult thawDestroyPath(thawWorld* world, thawPathId id);

typedef struct thawPathState {
    float length;                     /* m */
    float mass;                       /* kg of melt that follows it */
    float captured, arrived, spilled; /* kg, ever: that came to follow it, that went off its end, that got lost */
    float meanDistance;               /* m from it, of what follows it */
    float front;                      /* m along it, of the foremost twentieth */
    float
        arrivalTime; /* s from the first capture until a twentieth of what was captured was at the end; NaN: not yet */
    float speed;     /* m/s that it asks for now */
} thawPathState;
THAW_API thawResult thawPath_GetState(const thawWorld* world, thawPathId id, thawPathState* out);

/* A form that melt fills and sets in. All melt that comes within `reach` obeys it: it is led to where it is missing,
 * round holes and obstacles, and held at the rim; what lies outside is brought back. When the share `setFill` of the
 * shape is filled, all melt inside is cooled until it sets; the heat is in thawLedger.controlHeat.
 *
 * Either flat, closed contours drawn on a surface: the shape is what lies inside an odd number of them, so that a
 * contour in a contour is a hole; contours that cross themselves or each other follow the same rule, and each is closed
 * from its last point to its first. Melt fills it as deep as there is melt for. It works along the plane that the
 * contours fit best and `depth` to both sides of it, and leaves the motion across the plane to gravity: a surface that
 * turns by more than about 60 degrees takes several shapes.
 *
 * Or a closed mesh: melt gathers in it from the bottom up, its weight carried, and what has set is held in the air, and
 * goes where the collider goes, as long as the shape is on. What finds no room is let go. */
typedef struct thawShapeDef {
    uint32_t structSize, cookie;
    const thawVec3* points;      /* m, of all contours one after the other, each within 1e5; at most 1000000 in all */
    const int32_t* contourSizes; /* contourCount of them: points of each, range 3..1000000 */
    int32_t contourCount;        /* range 1..10000; 0 with a mesh */
    thawVec3 normal;   /* out of the surface, any length; default 0: across the plane that fits, to its upper side */
    thawMesh mesh;     /* instead of contours, default none */
    thawVec3 position; /* m, of the mesh; default 0 */
    thawQuat rotation; /* of the mesh, default none */
    float scale;       /* 1, of the mesh; range 1e-6..1e6, default 1 */
    thawColliderId collider; /* that it moves with, in whose space all of it is, and is destroyed with; default null: it
                                stands still in the world */
    bool enabled;            /* default true */
    float reach;             /* m beyond the rim from where melt is drawn, range 1e-4..10; default 0: half its size */
    float depth;             /* m off the surface, of contours; range 1e-4..10; default 0: as `reach` */
    float thickness;         /* m, at which contours are full and take up no more; range 0..10, default 0: at none */
    float strength;          /* 0: nothing, 0.5: a hint, 1: a lock; range 0..1, default 1 */
    float speed;             /* m/s, at most, at which melt is led; range 1e-4..100, default 0.1 */
    bool sets;               /* cools what is in it when it is filled; default true */
    float setFill;    /* 1, share of it that is covered, or filled, when that begins; no more than the rest to 1 of what
                         obeys is outside and melts then, and without a `thickness` hardly any more comes; range 0..1,
                         default 0.9 */
    float setTime;    /* s that it takes about; range 0..1e4, default 2 */
    int32_t priority; /* where shapes overlap, melt that obeys none yet takes the highest. Before a path of the same
                         priority inside, after it around; default 0 */
} thawShapeDef;
THAW_API void thawInitShapeDef(thawShapeDef* def);
THAW_API thawResult thawCreateShape(thawWorld* world, const thawShapeDef* def, thawShapeId* outId);
/* Replaces every property; takes effect in the next step. Another form, reach or collider starts to fill anew, all else
 * costs little and may be set before every step. */
THAW_API thawResult thawShape_Set(thawWorld* world, thawShapeId id, const thawShapeDef* def);
/* What obeyed it flows freely; what has set stays, and falls where nothing else holds it. */
THAW_API thawResult thawDestroyShape(thawWorld* world, thawShapeId id);

typedef struct thawShapeState {
    float size;            /* m^2 inside of contours, m^3 inside of a mesh */
    float mass;            /* kg that obey it, 0 while it is off, of which: */
    float inside, spilled; /* kg inside; more than half a spacing outside */
    float set;             /* kg that have set */
    float captured, lost;  /* kg, ever: that came to obey it; that went out of its reach, or found no room */
    float meanDistance;    /* m from it, of what is spilled */
    float fill;            /* 1, share of it that is covered, or filled */
    float level;           /* m, of contours: how deep all that obeys it stands, or would */
    float filledAfter;     /* s from the first capture until it was filled (setFill); NaN: not yet */
} thawShapeState;
THAW_API thawResult thawShape_GetState(const thawWorld* world, thawShapeId id, thawShapeState* out);

/* ---- plan and budget -------------------------------------------------------------------------------------------- */

typedef enum thawStage {
    thawStage_inputs = 0, /* pending changes of the host */
    thawStage_neighbors,  /* sort and neighbour lists */
    thawStage_exposure,   /* which particles are surface; normal and area */
    thawStage_radiation,  /* rays and irradiance from the sources */
    thawStage_conduction,
    thawStage_loss,    /* emission and convection to ambient */
    thawStage_phase,   /* temperature, liquid fraction, letting go and setting */
    thawStage_control, /* who follows which path or shape, and how fast */
    thawStage_forces,  /* gravity, cohesion, adhesion */
    thawStage_viscosity,
    thawStage_pressure,
    thawStage_collision, /* walls, swept motion, positions */
    thawStage_levels,    /* coarse particles split, fine ones merge */
    thawStage_stats,     /* ledger and counters */
    thawStage_count
} thawStage;

/* Why a stage runs or does not. */
typedef enum thawReason {
    thawReason_needed = 0,     /* the scene asks for it */
    thawReason_noParticles,    /* nothing there */
    thawReason_nothingMoves,   /* no liquid and no loose piece */
    thawReason_nothingChanged, /* last step's result still holds */
    thawReason_noSource,       /* no enabled source that differs from ambient */
    thawReason_nothingExposed, /* no surface that loses or takes up heat */
    thawReason_equilibrium,    /* all at ambient temperature and no source */
    thawReason_timeScaleZero,  /* heat is switched off by thermalTimeScale = 0 */
    thawReason_interval,       /* not due in this step: see heatInterval */
    thawReason_oneLevel,       /* no solid that was filled with coarse particles */
    thawReason_noControl       /* no path or shape that is on */
} thawReason;
/* A stage's name and a reason in words; "" when out of range. Static storage. */
THAW_API const char* thawStageName(thawStage stage);
THAW_API const char* thawReasonString(thawReason reason);

/* Work units: how much a step may do. The same units and inputs give the same bits on any number of threads. */
typedef struct thawWork {
    int32_t subSteps;            /* at most this many; range 1..16 */
    int32_t pressureIterations;  /* range 1..64; 4 is enough for looks, 8 keeps what is at rest within 3 % */
    int32_t viscosityIterations; /* cap of the conjugate gradients; range 1..200 */
    int32_t heatInterval;        /* heat every n-th step, energy-exact; range 1..8 */
    float rayRefresh; /* largest share of the lit surface that looks anew in a step who is in the way, where that may
                         have changed most; range 0.05..1. What cannot have changed is not looked at again */
    int32_t leastSubSteps; /* at least this many, for accuracy; range 1..16, default 1; subSteps goes before it */
    int32_t heatCycles;    /* explicit sub-cycles of conduction at most; range 1..1000. A step that needs more (a
                              large thermalTimeScale) goes implicitly: bounded, exact in energy, but late where
                              something melts: a melt front by up to a quarter at steps of Fourier number 10
                              (heat time x diffusivity / particleSpacing^2), by up to 80 % at 40 to 160 */
    int32_t raysPerSource; /* of a particle to a source with an extent; range 1..64, default 16 */
    int32_t finestLevel;   /* particles get no finer than 2^this times the finest mass; range 0..3, default 0 */
    int32_t coarsestLevel; /* and no coarser; range 0..3, default 3; finestLevel goes before it */
    int32_t splits;        /* particles that may come to be by splitting in a step; range 1..1e6, default 2048 */
    int32_t surfaceLevel;  /* of the mesh: its cells are 2^(surfaceLevel / 3) times as wide as thawSurfaceDef.cellSize;
                              range 0..3, default 0. A step leaves it to the extractions that follow */
    int32_t lateAfter;     /* range 0..1e9, default 0: never. A step that ran late notes here in its plan after how many
                              of its safe points that was; with the same number it gives up the same again */
} thawWork;

typedef enum thawBudgetMode {
    thawBudget_work = 0,     /* do exactly budget.work; never looks at a clock */
    thawBudget_milliseconds, /* the governor chooses the work so that the step takes no longer than budget.milliseconds
                                of this machine, and a step that runs late all the same gives up iterations */
    thawBudget_units /* the governor chooses the work by a fixed price list, budget.units: never looks at a clock,
                        chooses the same on every machine, for lockstep and replay */
} thawBudgetMode;

typedef struct thawBudget {
    uint32_t structSize, cookie;
    thawBudgetMode mode;       /* default thawBudget_work */
    float milliseconds;        /* range 0..1e9, default 4; 0: the least work there is */
    float surfaceMilliseconds; /* that making the mesh may take where the governor chooses: it chooses surfaceLevel by
                                  what the last meshes took, or fixed prices with units; range 0..1e9, default 0: any */
    float units;    /* range 0..1e12, default 4000; 1000 are about what a quiet machine with two cores does in 1 ms */
    thawWork work;  /* of thawBudget_work. Default: 4 sub-steps at most, 8 pressure, 12 viscosity, heat every step, all
                       rays, 80 sub-cycles of conduction, 16 rays a source */
    thawWork least; /* what the governor never goes below. Default: 1 sub-step, 3 pressure, 6 viscosity, heat every 8th
                       step, 0.05 of the rays, 8 sub-cycles, 4 rays a source, finestLevel 3, surfaceLevel 3 */
    thawWork most;  /* and never above; goes before it. Default: 16 sub-steps, 8 of them at least, 64 pressure, 200
                       viscosity, heat every step, all rays, 1000 sub-cycles, 64 rays a source, levels 0 to 3.
                       One knob the same in both: it stays there */
} thawBudget;
THAW_API void thawInitBudget(thawBudget* budget);

/* What the last step did and why. */
typedef struct thawPlan {
    bool enabled[thawStage_count];
    thawReason reason[thawStage_count];
    thawWork work;     /* as chosen; feed it back with thawBudget_work for the same bits */
    float predictedMs; /* by the governor of milliseconds, from what the last steps took */
    float units;       /* predicted for this work by the price list of thawBudget_units */
    int32_t workers;   /* threads that took part: fewer than the world has while the system keeps taking some away */
} thawPlan;
THAW_API void thawWorld_GetPlan(const thawWorld* world, thawPlan* out);
/* The plan that a step with this budget would run now; steps nothing. */
THAW_API thawResult thawWorld_PreviewPlan(const thawWorld* world, const thawBudget* budget, thawPlan* out);

/* Advances by timeStep seconds (range 1e-5..0.25). budget NULL: defaults. Returns thawStepStatus bits. */
THAW_API uint32_t thawWorld_Step(thawWorld* world, float timeStep, const thawBudget* budget);

/* ---- results ---------------------------------------------------------------------------------------------------- */

typedef enum thawParticleFlags {
    thawParticle_fixed = 1 << 0,   /* solid: held, or part of a rigid piece */
    thawParticle_surface = 1 << 1, /* exposed to air */
    thawParticle_asleep = 1 << 2,  /* elastic and held as long as its load stays what it is */
    thawParticle_rigid = 1 << 3    /* solid that nothing anchors: moves with its rigid piece, or rests with it */
} thawParticleFlags;

/* Structure of arrays, `count` long each. Order changes from step to step; ids are stable. */
typedef struct thawParticleView {
    int32_t count;
    int32_t moving; /* the first `moving` rows flowed in the last step; the rest was held, or rigid; flags are newer */
    const float* positions;        /* x y z r: m; r is the radius of the particle's sphere of influence for drawing */
    const float* velocities;       /* x y z m: m/s, and mass in kg */
    const float* temperatures;     /* K */
    const float* liquidFractions;  /* 0..1 */
    const float* normals;          /* x y z a: outward unit normal and exposed area in m^2; zero inside */
    const uint32_t* ids;           /* stable, never used twice in a world */
    const uint16_t* bodies;        /* index1 - 1 of the thawBodyId */
    const uint8_t* materials;      /* index1 - 1 of the thawMaterialId */
    const uint8_t* flags;          /* thawParticleFlags */
    const uint8_t* absorptivities; /* 1 + 254 x the painted one; 0: the material's */
    const uint8_t* levels;         /* mass 2^level of the finest, 0..3 */
} thawParticleView;
THAW_API void thawWorld_GetParticles(const thawWorld* world, thawParticleView* out);
/* Extended local feature size of every particle, m, in the order of the view: how near the surface is, plus how thick
 * the melt is there (distance of the surface to its medial axis; Adams et al. 2007). About 1 spacing in films and
 * drips, 32 spacings at the most, right within a spacing. Takes a neighbour search: for pictures and tools. Changes
 * nothing that a step depends on. The array belongs to the world, until the next call of this or a step. */
THAW_API thawResult thawWorld_GetFeatureSizes(thawWorld* world, const float** out);

/* Particles as ellipsoids of revolution, for hosts that draw splats or a surface in screen space: balls inside and
 * where one is alone, flat where there is a surface, and there moved along it so that beads at outlines go (after Yu &
 * Turk 2013). In the order of thawParticleView. */
typedef struct thawSplatView {
    int32_t count;
    const float* centers; /* x y z a: m; a is the half axis along the surface */
    const float* axes;    /* x y z b: unit, out of the surface; b is the half axis along it, m */
} thawSplatView;
/* 0.6 us a particle of the surface. Changes nothing that a step depends on. The arrays belong to the world, until the
 * next call of this. */
THAW_API thawResult thawWorld_GetSplats(thawWorld* world, thawSplatView* out);

/* A piece of solid that nothing anchors: cut loose by melting, or a body that stands free. It falls, lands, is pushed
 * and floats as one rigid body until it melts. */
typedef struct thawPieceState {
    uint32_t id;       /* stable, never used twice in a world; of a piece that falls apart, the largest part keeps it */
    int32_t particles; /* that it had in the last step */
    float mass;        /* kg */
    thawVec3 center;   /* m, centre of mass */
    thawVec3 velocity; /* m/s, of the centre */
    thawVec3 angularVelocity; /* rad/s */
    bool asleep;              /* rests, at no cost, until something wakes it */
} thawPieceState;
/* Writes up to `capacity` pieces to out (NULL when capacity is 0) and returns how many there are. */
THAW_API int32_t thawWorld_GetPieces(const thawWorld* world, thawPieceState* out, int32_t capacity);

typedef struct thawSurfaceDef {
    uint32_t structSize, cookie;
    float cellSize;    /* in particle spacings; range 0.25..4, default 0.75 */
    int32_t smoothing; /* passes over the mesh, of which one takes what is shorter than three cells; range 0..10,
                          default 1 */
} thawSurfaceDef;
THAW_API void thawInitSurfaceDef(thawSurfaceDef* def);

typedef struct thawSurfaceView {
    int32_t vertexCount, triangleCount;
    const float* positions;       /* x y z, m */
    const float* normals;         /* x y z, unit, outward */
    const float* temperatures;    /* K */
    const float* liquidFractions; /* 0..1 */
    const uint8_t* materials;     /* index1 - 1 of the nearest particle's material */
    const uint16_t* bodies;       /* index1 - 1 of its thawBodyId */
    const uint8_t* mixtures; /* 8 of each vertex: index1 - 1 of up to four materials around it, then their shares in
                                255ths, the largest first; they sum to 255, what is not used is 0 */
    const uint32_t* indices; /* three per triangle, counter-clockwise from outside */
    int32_t level;           /* thawWork.surfaceLevel that it was made with */
} thawSurfaceView;
/* Makes the mesh of everything that is in the world. Watertight; empty when there are no particles. What has not
 * changed since the last time is not made again: only blocks of 8 cells around what moved. The same bits on any number
 * of threads, whatever was extracted before. The arrays belong to the world, until the next extraction or
 * thawWorld_StartSurface. */
THAW_API thawResult thawWorld_ExtractSurface(thawWorld* world, const thawSurfaceDef* def, thawSurfaceView* out);

/* The same beside what the caller goes on with. Start copies what is in the world now (0.1 ms for 16,000 particles) and
 * begins its mesh on a thread of the world's own, or on a task of thawTaskSystem; finish waits for it. In between the
 * world may be stepped, changed and destroyed; the mesh is that of the start. A host that finishes the last frame's
 * mesh before it starts the next one draws with a frame of latency and never waits. One at a time. The arrays belong to
 * the world, until the next thawWorld_FinishSurface: they can be drawn from while the next one is made. */
THAW_API thawResult thawWorld_StartSurface(thawWorld* world, const thawSurfaceDef* def);
THAW_API thawResult thawWorld_FinishSurface(thawWorld* world, thawSurfaceView* out);

/* How a host's vertices look. Offsets are bytes into a vertex, multiples of the size of the number there, or -1: left
 * out. */
typedef struct thawSurfaceBuffers {
    uint32_t structSize, cookie;
    void* vertices;         /* aligned to 4; a mapped vertex buffer, say: written vertex by vertex, never read */
    int32_t vertexCapacity; /* vertices that there is room for */
    int32_t vertexStride;   /* bytes from one to the next, a multiple of 4; range 4..4096, default 32 */
    int32_t positionOffset, normalOffset;              /* three floats; default 0 and 12 */
    int32_t temperatureOffset, liquidFractionOffset;   /* a float; default 24 and 28 */
    int32_t materialOffset, bodyOffset, mixtureOffset; /* 1, 2 and 8 bytes as in thawSurfaceView; default -1 */
    void* indices;                                     /* aligned to indexSize */
    int32_t indexCapacity;
    int32_t indexSize; /* bytes, 2 or 4; default 4. Two number 65,536 vertices */
} thawSurfaceBuffers;
THAW_API void thawInitSurfaceBuffers(thawSurfaceBuffers* buffers);
/* Writes a mesh in the host's own layout. Fails, with nothing written, with thawResult_capacity when it does not fit;
 * the message says how much is needed, and view says it before. */
THAW_API thawResult thawWorld_WriteSurface(thawWorld* world, const thawSurfaceView* view,
                                           const thawSurfaceBuffers* buffers);

typedef struct thawLedger {
    double massAdded, massRemoved, massNow; /* kg */
    double massBurnt, energyBurnt;          /* kg and J that turned to vapour */
    double energyAdded;                     /* J, enthalpy that bodies brought, relative to each material's solidus */
    double energyRemoved;                   /* J, taken out with destroyed bodies and bad particles */
    double painted;                         /* J, by thawBody_PaintTemperature */
    double redefined;                       /* J, by thawMaterial_Set: the same temperatures in another curve */
    double absorbed;                        /* J from sources */
    double contact;                         /* J from colliders with a temperature */
    double emitted;                         /* J by thermal radiation, net of what ambient sends back */
    double convected;                       /* J to the air */
    double energyNow;                       /* J, sum of m H */
    double controlImpulse[3];               /* N s, momentum that paths and shapes gave */
    double controlEnergy;                   /* J, kinetic energy that they gave, < 0: took */
    double controlHeat;                     /* J that shapes took until what is in them set */
    double massError;                       /* |massNow - added + removed + burnt| / added */
    double energyError; /* |energyNow - (added - removed - burnt + painted + redefined + absorbed + contact - emitted -
                           convected
                           - controlHeat)| / largest sum moved */
} thawLedger;
THAW_API void thawWorld_GetLedger(const thawWorld* world, thawLedger* out);

typedef struct thawCounters {
    int32_t particles, moving, fixed, surface, capacity; /* moving: liquid, and rigid pieces that are awake */
    int32_t pieces;                                      /* rigid ones, awake or asleep */
    int32_t bodies, colliders, heatSources, materials, paths, shapes;
    int32_t subSteps, pressureIterations, viscosityIterations; /* of the last step; iterations summed over sub-steps */
    int32_t rays, neighborsMax;
    int32_t levels[4];      /* particles by level */
    int32_t splits, merges; /* particles that came and went by them in the last step */
    float neighborsMean;
    float maxSpeed;          /* m/s */
    float maxCompression;    /* 1, largest density error of moving particles */
    float meanCompression;   /* 1 */
    float apparentViscosity; /* Pa s, largest that a moving particle was solved with above its own: floor of fast
                              * liquid, share of its pressure times the step, stiff start or landing; 0 if none */
    float meltedFraction;    /* 1, of all mass */
    float minTemperature, maxTemperature; /* K */
    uint64_t steps;
    double time;        /* s, of motion */
    size_t memoryBytes; /* taken from the allocator now */
} thawCounters;
THAW_API void thawWorld_GetCounters(const thawWorld* world, thawCounters* out);

/* Wall-clock cost of the last step, ms. Never feeds back into state except through thawBudget_milliseconds. */
typedef struct thawProfile {
    float step;
    float stage[thawStage_count];
} thawProfile;
THAW_API void thawWorld_GetProfile(const thawWorld* world, thawProfile* out);

/* ---- images of a world ------------------------------------------------------------------------------------------ */

/* An image holds all that the next step depends on, and what is reported: particles, pieces, bonds, what colliders,
 * sources, materials, paths and shapes are and where, what steps remember (the shadows that were seen, loads, the
 * governor of thawBudget_units), ledger and counters. After a restore the steps have the same bits as those that
 * followed the save, and the state hash is the same. Not in it: hooks, capacities, what the governor of
 * thawBudget_milliseconds has learnt about this machine, meshes and views. See docs/snapshot.md.
 *
 * Meshes of colliders and forms of shapes are large and never change. An image names them, and a full image has them.
 * The world keeps what an image may name, also when it is destroyed, until thawWorld_ForgetSnapshots. */
typedef enum thawSnapshotKind {
    thawSnapshot_world = 0, /* for the world that it was made of */
    thawSnapshot_full /* with the forms: also for another world of the same particleSpacing that has room for it */
} thawSnapshotKind;
/* Bytes that thawWorld_Save would write now; looks at all particles, as that does. 0 without a world or kind. */
THAW_API size_t thawWorld_GetSnapshotSize(const thawWorld* world, thawSnapshotKind kind);
/* Writes an image of the world to the caller's buffer of so many bytes. *written, which may be NULL, is how many it
 * has; at most 140 for each particle, and more for elastic and coarse solid. thawResult_capacity when there is not
 * enough room: what was written then is no image. Allocates nothing, but for thawSnapshot_full. */
THAW_API thawResult thawWorld_Save(const thawWorld* world, thawSnapshotKind kind, void* buffer, size_t capacity,
                                   size_t* written);
/* Puts the world back to where it was. The image is looked at whole before anything is touched: one that is cut short,
 * damaged, of another version of the library, of another particleSpacing, with more than the world has room for, or
 * that names what the world does not have, is refused with thawResult_badImage or thawResult_capacity, and the world
 * stays as it is to the last bit.
 * Ids: what was destroyed since is back with its id, what was created since is stale again, and what is created then
 * gets the ids that it would have had. A world other than the image's has its own thawWorld_GetIdTag in them. A mesh
 * under way (thawWorld_StartSurface) stays that of its start. */
THAW_API thawResult thawWorld_Restore(thawWorld* world, const void* image, size_t size);
/* Frees what is kept only for images older than `oldest`, or for any when that is NULL: such images, unless full, may
 * be refused from then on. For a ring that has dropped its oldest image, now and then. */
THAW_API thawResult thawWorld_ForgetSnapshots(thawWorld* world, const void* oldest, size_t size);
/* `world` in all ids of this world. */
THAW_API uint16_t thawWorld_GetIdTag(const thawWorld* world);

/* Hash of everything that the next step depends on. Equal for equal inputs and plans at any number of threads. */
THAW_API uint64_t thawWorld_GetStateHash(const thawWorld* world);

#ifdef __cplusplus
}
#endif
#endif
