// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Normal, view depth and translucency for the screen-space light passes.

in vec3 vNormal;
in float vDepth;
in vec4 vAlbedo;
out vec4 oGeometry;

void main() { oGeometry = vec4(octEncode(normalize(vNormal)), vDepth, vAlbedo.w); }
