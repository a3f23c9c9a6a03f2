// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// The smoothed depths as a surface in the geometry buffer, where everything goes on as with a mesh. Pixels inside all samples at
// once; those at the outline sample by sample, as far as the outline covers them.

in vec2 vUv;
uniform sampler2D uSplats, uSmooth, uSplatAlbedos, uSplatStates;
uniform vec2 uPictureSize;
uniform int uOutline;      // 0: inside; 1: one sample at the outline
uniform vec2 uSampleOffset; // pixels from the middle

vec3 placeAt(ivec2 at, float z) { return worldAt((vec2(at) + 0.5) / uPictureSize, z); }

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), last = ivec2(uPictureSize) - 1;
    float edge = texelFetch(uSplats, at, 0).g;
    if (uOutline == 0 ? edge < 1.0 : (edge >= 1.0 || edge < -1.0)) discard;
    if (uOutline == 1) {
        vec2 slope = 0.5 * vec2(texelFetch(uSplats, min(at + ivec2(1, 0), last), 0).g - texelFetch(uSplats, max(at - ivec2(1, 0), ivec2(0)), 0).g,
                                texelFetch(uSplats, min(at + ivec2(0, 1), last), 0).g - texelFetch(uSplats, max(at - ivec2(0, 1), ivec2(0)), 0).g);
        slope /= max(length(slope), 1.0);
        if (edge + dot(slope, uSampleOffset) < 0.0) discard;
    }
    float z = texelFetch(uSmooth, at, 0).r;
    ivec2 home = at;
    if (z <= 0.0) {
        // The middle of the pixel is outside: the surface is beside it.
        for (int i = 0; i < 8; ++i) {
            ivec2 p = clamp(at + ivec2(i < 3 ? -1 : i < 5 ? 0 : 1, i < 3 ? i - 1 : i < 5 ? 2 * i - 7 : i - 6), ivec2(0), last);
            float there = texelFetch(uSmooth, p, 0).r;
            if (there > z) z = there, home = p;
        }
        if (z <= 0.0) discard;
    }
    vec3 p = placeAt(home, z), along[2];
    for (int axis = 0; axis < 2; ++axis) {
        ivec2 step = axis == 0 ? ivec2(1, 0) : ivec2(0, 1), after = min(home + step, last), before = max(home - step, ivec2(0));
        float a = texelFetch(uSmooth, after, 0).r, b = texelFetch(uSmooth, before, 0).r;
        bool ahead = b <= 0.0 || (a > 0.0 && abs(a - z) < abs(b - z));
        along[axis] = ahead ? placeAt(after, a > 0.0 ? a : z) - p : p - placeAt(before, b > 0.0 ? b : z);
    }
    vec3 n = normalize(cross(along[0], along[1]));
    vec2 uv = (vec2(home) + 0.5) / uPictureSize;
    vec4 albedo = textureLod(uSplatAlbedos, uv, 0.0), state = textureLod(uSplatStates, uv, 0.0);
    float w = max(albedo.a, 1e-6);
    writeSurface(albedo.rgb / w, state.a / w, state.xyz / w, vec2(0.0), n);
    gl_FragDepth = 0.5 + 0.5 * ((uNearFar.y + uNearFar.x) - 2.0 * uNearFar.x * uNearFar.y / z) / (uNearFar.y - uNearFar.x);
}
