// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Light along a line of sight through a candle flame, whose layers are bodies of revolution with a teardrop outline: the
// chord through each layer is known in closed form, so no marching is needed. Additive.

in vec2 vLocal;
uniform int uShape; // 0 flame, 1 ball
uniform vec3 uTint;
uniform float uBrightness, uTime;
uniform sampler2DMS uDepths;
uniform int uSampleCount;
out vec4 oColor;

// Half width of the outline at height y (0 bottom, 1 tip).
float teardrop(float y) { return y <= 0.0 || y >= 1.0 ? 0.0 : 1.75 * pow(y, 0.55) * pow(1.0 - y, 1.15); }

// Chord through a layer, 1 at the widest place.
float layer(vec2 q, float bottom, float top, float width) {
    float y = (q.y - bottom) / (top - bottom);
    float w = teardrop(y) * width;
    if (w <= 1e-4) return 0.0;
    float x = q.x / w;
    return x * x < 1.0 ? sqrt(1.0 - x * x) * w / width : 0.0;
}

void main() {
    vec3 light = vec3(0.0);
    if (uShape == 0) {
        // The square leaves room for the halo; q.y is 0 at the bottom of the flame, 1 at its tip.
        vec2 q = vec2(vLocal.x * 3.0, vLocal.y * 0.8 + 0.5);
        float sway = 0.10 * sin(uTime * 7.3) + 0.06 * sin(uTime * 12.1 + 1.7);
        q.x += sway * max(q.y, 0.0) * max(q.y, 0.0);
        q.y *= 1.0 + 0.03 * sin(uTime * 9.7 + 0.4);
        float mantle = layer(q, -0.03, 1.0, 1.0);
        float body = layer(q, 0.02, 0.93, 0.80);
        float core = layer(q, 0.16, 0.80, 0.52);
        float dark = layer(q, -0.08, 0.40, 0.34);
        float base = layer(q, -0.05, 0.36, 0.86);
        float rise = smoothstep(0.02, 0.42, q.y);
        light += vec3(1.0, 0.27, 0.035) * mantle * mantle * 0.8 * mix(0.2, 1.0, rise);
        light += vec3(1.0, 0.52, 0.12) * pow(body, 1.6) * 2.0 * rise;
        light += vec3(1.0, 0.80, 0.42) * pow(core, 1.6) * 3.2 * smoothstep(0.12, 0.5, q.y);
        light *= 1.0 - 0.6 * dark * (1.0 - smoothstep(0.2, 0.45, q.y));
        light += vec3(0.10, 0.22, 0.9) * base * (1.0 - smoothstep(0.0, 0.3, q.y)) * 0.55;
        light *= uTint / vec3(1.0, 0.58, 0.22);
        vec2 h = vec2(q.x * 0.33, (q.y - 0.5) * 1.25);
        float halo = saturate(1.0 - dot(h, h));
        light += uTint * 0.05 * halo * halo;
    } else {
        float r = length(vLocal) * 2.0;
        float inside = r < 1.0 ? sqrt(1.0 - r * r) : 0.0;
        light = mix(uTint, vec3(1.0), 0.3 * inside) * 2.0 * smoothstep(0.0, 0.35, inside);
        float halo = saturate(1.0 - 0.5 * r);
        light += uTint * 0.35 * halo * halo;
    }
    float seen = 0.0;
    for (int s = 0; s < uSampleCount; ++s)
        seen += texelFetch(uDepths, ivec2(gl_FragCoord.xy), s).r > gl_FragCoord.z ? 1.0 : 0.0;
    oColor = vec4(light * (uBrightness * seen / float(uSampleCount)), 0.0);
}
