/* SPDX-FileCopyrightText: 2026 the thaw authors
 * SPDX-License-Identifier: MIT
 *
 * A host in plain C that knows nothing but the installed header: a cube of wax under a lamp must take up heat, melt and
 * run.
 */
#include <stdio.h>
#include <thaw/thaw.h>

#define CHECK(condition)                                                                                               \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            fprintf(stderr, "hello: line %d: %s is false: %s\n", __LINE__, #condition,                                 \
                    world ? thawWorld_GetLastError(world) : message);                                                  \
            thawDestroyWorld(world);                                                                                   \
            return 1;                                                                                                  \
        }                                                                                                              \
    } while (0)

int main(void) {
    static const float vertices[] = {-0.01f, 0,      -0.01f, 0.01f, 0,      -0.01f, 0.01f,  0,
                                     0.01f,  -0.01f, 0,      0.01f, -0.01f, 0.02f,  -0.01f, 0.01f,
                                     0.02f,  -0.01f, 0.01f,  0.02f, 0.01f,  -0.01f, 0.02f,  0.01f};
    static const uint32_t indices[] = {0, 1, 2, 0, 2, 3, 4, 6, 5, 4, 7, 6, 0, 5, 1, 0, 4, 5,
                                       3, 2, 6, 3, 6, 7, 0, 3, 7, 0, 7, 4, 1, 5, 6, 1, 6, 2};
    char message[256] = "";
    thawWorld* world = NULL;

    CHECK(thawGetVersion() == THAW_VERSION);

    thawWorldDef worldDef;
    thawInitWorldDef(&worldDef);
    worldDef.maxParticles = 4096;
    worldDef.thermalTimeScale = 200;
    CHECK(thawCreateWorld(&worldDef, &world, message, sizeof message) == thawResult_ok);

    thawMaterialDef materialDef;
    thawMaterialId material;
    thawInitMaterialDef(&materialDef, thawMaterial_wax);
    CHECK(thawCreateMaterial(world, &materialDef, &material) == thawResult_ok);

    thawColliderDef floorDef;
    thawColliderId floorId;
    thawInitColliderDef(&floorDef, thawCollider_plane);
    CHECK(thawCreateCollider(world, &floorDef, &floorId, NULL) == thawResult_ok);

    thawBodyDef bodyDef;
    thawBodyId body;
    thawInitBodyDef(&bodyDef);
    bodyDef.material = material;
    bodyDef.mesh.vertices = vertices;
    bodyDef.mesh.vertexCount = 8;
    bodyDef.mesh.indices = indices;
    bodyDef.mesh.triangleCount = 12;
    CHECK(thawCreateBody(world, &bodyDef, &body, NULL) == thawResult_ok);

    thawHeatSourceDef lampDef;
    thawHeatSourceId lamp;
    thawInitHeatSourceDef(&lampDef);
    lampDef.position.y = 0.05f;
    lampDef.power = 60;
    CHECK(thawCreateHeatSource(world, &lampDef, &lamp) == thawResult_ok);

    uint64_t before = thawWorld_GetStateHash(world);
    for (int frame = 0; frame < 120; ++frame)
        CHECK((thawWorld_Step(world, 1.0f / 60.0f, NULL) & thawStep_refused) == 0);

    thawBodyState state;
    thawLedger ledger;
    thawSurfaceDef surfaceDef;
    thawSurfaceView surface;
    CHECK(thawBody_GetState(world, body, &state) == thawResult_ok);
    thawWorld_GetLedger(world, &ledger);
    thawInitSurfaceDef(&surfaceDef);
    CHECK(thawWorld_ExtractSurface(world, &surfaceDef, &surface) == thawResult_ok);
    CHECK(thawWorld_GetStateHash(world) != before);
    CHECK(state.particles > 500);
    CHECK(state.meltedFraction > 0.01f);
    CHECK(ledger.absorbed > 0);
    CHECK(ledger.massError < 1e-5);
    CHECK(surface.triangleCount > 100);

    thawBodyId stale = {12345, 0, 0};
    CHECK(thawBody_GetState(world, stale, &state) == thawResult_staleId);

    printf("hello: %s, %d particles, %.1f %% melted, %d triangles\n", thawGetBuildString(), (int)state.particles,
           100.0 * state.meltedFraction, (int)surface.triangleCount);
    thawDestroyWorld(world);
    return 0;
}
