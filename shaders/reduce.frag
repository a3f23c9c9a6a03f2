// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Geometry at the size of the light buffers: octahedral normal, view depth (0 where nothing is), translucency.

in vec2 vUv;
uniform sampler2DMS uNormals, uAlbedos, uDepths;
uniform vec2 uPictureSize;
out vec4 oGeometry;

void main() {
    ivec2 at = min(ivec2(vUv * uPictureSize), ivec2(uPictureSize) - 1);
    vec4 n = texelFetch(uNormals, at, 0);
    bool there = n.w > 0.5;
    float depth = viewDepth(texelFetch(uDepths, at, 0).r);
    float translucency = texelFetch(uAlbedos, at, 0).a;
    oGeometry = there ? vec4(n.xy, depth, n.w > 1.5 ? 0.0 : translucency) : vec4(0.0);
}
