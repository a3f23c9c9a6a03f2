// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// What the shading needs of a melt surface, a mesh or the floor.

uniform int uMode; // 0 shaded, 1 temperature, 2 phase, 3 liquid fraction, 4 plain beside a data view, 5 floor
uniform sampler2D uRamp;
uniform vec3 uPhaseColor[3];
uniform vec2 uPhaseLimits;

layout(location = 0) out vec4 oNormal; // octahedral normal, roughness, kind
layout(location = 1) out vec4 oAlbedo; // square root of the colour; translucency

// state: place on the scale of temperature, liquid fraction, roughness. clear: share for clearDepth, of the solid and the melt.
void writeSurface(vec3 albedo, float translucency, vec3 state, vec2 clear, vec3 n) {
    // Melt lets more light in before it sends it back: deeper colour, and a film that mirrors.
    float wet = smoothstep(0.3, 0.95, state.y);
    vec3 color = albedo * mix(vec3(1.0), albedo, 0.35 * wet);
    float kind = KIND_THING + 0.45 * mix(clear.x, clear.y, wet);
    if (uMode == 1 || uMode == 3) {
        float t = saturate(uMode == 1 ? state.x : state.y);
        color = textureLod(uRamp, vec2((t * 255.0 + 0.5) / 256.0, 0.5), 0.0).rgb;
    }
    if (uMode == 2) color = uPhaseColor[state.y < uPhaseLimits.x ? 0 : state.y > uPhaseLimits.y ? 2 : 1];
    if (uMode >= 1) kind = KIND_DATA;
    if (uMode == 5) kind = KIND_FLOOR;
    oNormal = vec4(octEncode(n), mix(state.z, 0.1, wet), kind);
    oAlbedo = vec4(sqrt(color), translucency);
}
