// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// A particle of melt as a square that faces the light or the eye and holds its ellipsoid (splat.glsl). The pass is one of
// CAMERA_PASS, KEY_PASS, FLAME_PASS.

layout(location = 0) in vec4 aCenter; // x y z; half axis along the surface, m
layout(location = 1) in vec4 aAxis;   // out of the surface, unit; the half axis along it, m
layout(location = 2) in vec3 aState;  // temperature, liquid fraction, material

uniform vec4 uMaterialColor[MAX_MATERIALS]; // w: translucency
uniform float uMaterialRoughness[MAX_MATERIALS];
uniform vec2 uTemperatureRange, uPictureSize;
uniform int uFlameLayer;
uniform vec4 uClip; // drops what is behind this plane: dot(xyz, position) + w < 0; 0 0 0 1: nothing
uniform float uSplatSize; // of the half axes

flat out vec4 vCenter;
flat out vec4 vAxis;
flat out vec4 vAlbedo; // w: translucency
flat out vec3 vState;  // place on the scale of temperature, liquid fraction, roughness
out vec3 vPoint;       // in the world

void main() {
    vec2 corner = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID >> 1) * 2 - 1);
    vCenter = vec4(aCenter.xyz, aCenter.w * uSplatSize);
    vAxis = vec4(aAxis.xyz, aAxis.w / aCenter.w);
    int material = clamp(int(aState.z + 0.5), 0, MAX_MATERIALS - 1);
    vAlbedo = uMaterialColor[material];
    float t = (aState.x - uTemperatureRange.x) / max(uTemperatureRange.y - uTemperatureRange.x, 1e-6);
    vState = vec3(saturate(t), aState.y, uMaterialRoughness[material]);
    gl_ClipDistance[0] = dot(uClip.xyz, aCenter.xyz) + uClip.w;
#if defined(KEY_PASS)
    vPoint = aCenter.xyz + (corner.x * uKeyRight + corner.y * uKeyUp) * vCenter.w;
    gl_Position = vec4((uKeyMatrix * vec4(vPoint, 1.0)).xyz * 2.0 - 1.0, 1.0);
#elif defined(FLAME_PASS)
    vec3 d = normalize(aCenter.xyz - uFlamePosition[uFlameLayer].xyz);
    vec3 right = normalize(cross(d, abs(d.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0))), up = cross(right, d);
    vPoint = aCenter.xyz + (corner.x * right + corner.y * up) * vCenter.w;
    gl_ClipDistance[0] = dot(d, uFlameAxis[uFlameLayer]) + 0.3;
    vec3 c = flameCoordinates(uFlameLayer, vPoint);
    gl_Position = vec4(c.xy, c.z * 2.0 - 1.0, 1.0);
#else
    vec3 d = aCenter.xyz - uEye;
    vec3 right = normalize(cross(d, vec3(uView[0].y, uView[1].y, uView[2].y))), up = normalize(cross(right, d));
    // A pixel more, for the share of pixels at the outline.
    float pixel = 2.0 * length(uCameraUp) * length(d) / uPictureSize.y;
    vPoint = aCenter.xyz + (corner.x * right + corner.y * up) * (vCenter.w + pixel);
    gl_Position = uProjection * uView * vec4(vPoint, 1.0);
#endif
}
