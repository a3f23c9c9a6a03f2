// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// A square that stands upright and turns to the eye, around one flame or ball.

uniform vec3 uFlameCenter;
uniform vec2 uFlameSize; // m, half width and half height of the square
uniform int uUpright;    // 0: turned fully to the eye

out vec2 vLocal;

void main() {
    vLocal = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID >> 1) * 2 - 1);
    vec3 toEye = normalize(uEye - uFlameCenter);
    vec3 up = vec3(0.0, 1.0, 0.0);
    if (uUpright == 0 || abs(toEye.y) > 0.97) up = normalize(uCameraUp);
    vec3 right = normalize(cross(up, toEye));
    vec3 p = uFlameCenter + right * vLocal.x * uFlameSize.x + up * vLocal.y * uFlameSize.y;
    gl_ClipDistance[0] = 1.0;
    gl_Position = uProjection * uView * vec4(p, 1.0);
}
