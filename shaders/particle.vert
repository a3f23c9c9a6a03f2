// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// A particle as a square that its fragment turns into a sphere; same passes as mesh.vert but for flames.

layout(location = 0) in vec4 aSphere; // x y z r
layout(location = 1) in float aValue; // 0..1 in the colour ramp

uniform vec4 uClip; // drops what is behind this plane: dot(xyz, position) + w < 0; 0 0 0 1: nothing

out vec3 vCenter; // in the view
out vec2 vCorner;
out vec3 vTint;
flat out float vRadius;

uniform sampler2D uRamp;

void main() {
    vCorner = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID >> 1) * 2 - 1);
    vRadius = aSphere.w;
    gl_ClipDistance[0] = dot(uClip.xyz, aSphere.xyz) + uClip.w;
    vTint = textureLod(uRamp, vec2((aValue * 255.0 + 0.5) / 256.0, 0.5), 0.0).rgb;
#if defined(KEY_PASS)
    vec3 p = aSphere.xyz + (vCorner.x * uKeyRight + vCorner.y * uKeyUp) * vRadius;
    vCenter = aSphere.xyz;
    gl_Position = vec4((uKeyMatrix * vec4(p, 1.0)).xyz * 2.0 - 1.0, 1.0);
#else
    vec4 c = uView * vec4(aSphere.xyz, 1.0);
    vCenter = c.xyz;
    gl_Position = uProjection * (c + vec4(vCorner * vRadius, 0.0, 0.0));
#endif
}
