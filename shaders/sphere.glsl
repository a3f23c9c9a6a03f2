// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Turns the square of particle.vert into a sphere: its normal in the world and its depth.

in vec3 vCenter;
in vec2 vCorner;
in vec3 vTint;
flat in float vRadius;

vec3 spherePosition, sphereNormal;

void raiseSphere() {
    float r2 = dot(vCorner, vCorner);
    if (r2 > 1.0) discard;
    vec3 n = vec3(vCorner, sqrt(1.0 - r2));
#if defined(KEY_PASS)
    gl_FragDepth = gl_FragCoord.z - n.z * vRadius / uKeyDepth;
#else
    vec3 p = vCenter + n * vRadius;
    vec4 clip = uProjection * vec4(p, 1.0);
    gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
    sphereNormal = transpose(mat3(uView)) * n;
    spherePosition = transpose(mat3(uView)) * (p - uView[3].xyz);
#endif
}
