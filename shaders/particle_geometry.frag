// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

layout(location = 0) out vec4 oNormal;
layout(location = 1) out vec4 oAlbedo;

void main() {
    raiseSphere();
    oNormal = vec4(octEncode(sphereNormal), 0.5, KIND_DATA);
    oAlbedo = vec4(sqrt(vTint), 0.0);
}
