// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

layout(location = 0) in vec3 aPosition;
layout(location = 1) in vec3 aNormal;

out vec3 vPosition;
out vec3 vNormal;

void main() {
    vPosition = aPosition;
    vNormal = aNormal;
    gl_ClipDistance[0] = 1.0;
    gl_Position = uProjection * uView * vec4(aPosition, 1.0);
}
