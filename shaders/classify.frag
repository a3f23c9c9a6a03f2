// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// What a pixel shows, for the passes of shade.frag: its kind, and KIND_EDGE more where its samples differ.

in vec2 vUv;
uniform sampler2DMS uNormals, uAlbedos, uDepths;
uniform int uSampleCount;
out vec4 oColor;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 normal = texelFetch(uNormals, at, 0);
    float kind = normal.w;
    kind = clearDepth(kind) > 0.0 ? KIND_CLEAR : floor(kind + 0.01);
    vec4 first = texelFetch(uAlbedos, at, 0);
    float z = viewDepth(texelFetch(uDepths, at, 0).r), spread = 0.0, change = 0.0;
    for (int s = 1; s < uSampleCount; ++s) {
        spread = max(spread, abs(viewDepth(texelFetch(uDepths, at, s).r) - z));
        vec4 d = abs(texelFetch(uAlbedos, at, s) - first);
        change = max(change, max(max(d.r, d.g), max(d.b, d.a)));
        // Creases: the sides of a box have one colour.
        vec2 turn = abs(texelFetch(uNormals, at, s).xy - normal.xy);
        change = max(change, 0.2 * (max(turn.x, turn.y) - 0.2));
    }
    // On the floor depth differs within a pixel of itself; its edges show in the colours.
    bool edge = change > 0.06 || (spread > 0.012 * uSceneRadius && z < 0.4 * uNearFar.y && kind != KIND_FLOOR);
    oColor = vec4((kind + (edge ? KIND_EDGE : 0.0)) / 255.0);
}
