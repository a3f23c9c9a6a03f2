// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Melt surfaces, still meshes and the floor. The pass is one of CAMERA_PASS, KEY_PASS, FLAME_PASS.

layout(location = 0) in vec3 aPosition;
layout(location = 1) in vec3 aNormal;
layout(location = 2) in float aTemperature;
layout(location = 3) in float aLiquid;
layout(location = 4) in vec4 aMaterials; // up to four
layout(location = 5) in vec4 aShares;    // of each; nothing: all of the first

uniform mat4 uModel;
uniform vec4 uMaterialColor[MAX_MATERIALS]; // w: translucency
uniform float uMaterialRoughness[MAX_MATERIALS];
uniform vec2 uMaterialClear[MAX_MATERIALS]; // shares for clearDepth, of the solid and the melt
uniform int uFlameLayer;
uniform vec4 uClip; // drops what is behind this plane: dot(xyz, position) + w < 0; 0 0 0 1: nothing

out vec3 vPosition;
out vec3 vNormal;
out vec4 vAlbedo; // w: translucency
out vec3 vState;  // temperature, liquid fraction, roughness
out vec2 vClear;

void main() {
    vec4 world = uModel * vec4(aPosition, 1.0);
    gl_ClipDistance[0] = 1.0;
#if defined(KEY_PASS)
    gl_Position = vec4((uKeyMatrix * world).xyz * 2.0 - 1.0, 1.0);
#elif defined(FLAME_PASS)
    vec3 d = normalize(world.xyz - uFlamePosition[uFlameLayer].xyz);
    gl_ClipDistance[0] = dot(d, uFlameAxis[uFlameLayer]) + 0.3;
    vec3 c = flameCoordinates(uFlameLayer, world.xyz);
    gl_Position = vec4(c.xy, c.z * 2.0 - 1.0, 1.0);
#else
    vPosition = world.xyz;
    vNormal = mat3(uModel) * aNormal;
    vec4 shares = aShares.x > 0.0 ? aShares : vec4(1.0, 0.0, 0.0, 0.0);
    vAlbedo = vec4(0.0);
    vClear = vec2(0.0);
    float roughness = 0.0;
    for (int k = 0; k < 4; ++k) {
        int material = clamp(int(aMaterials[k] + 0.5), 0, MAX_MATERIALS - 1);
        vAlbedo += shares[k] * uMaterialColor[material];
        roughness += shares[k] * uMaterialRoughness[material];
        vClear += shares[k] * uMaterialClear[material];
    }
    vState = vec3(aTemperature, aLiquid, roughness);
    gl_ClipDistance[0] = dot(uClip.xyz, world.xyz) + uClip.w;
    gl_Position = uProjection * uView * world;
#endif
}
