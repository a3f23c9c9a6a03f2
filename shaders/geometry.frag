// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// What the shading needs of a melt surface, a mesh or the floor. Kept short: software rasterisers shade blocks of 16 pixels
// for every triangle, however small, so everything costly waits for the whole picture (shade.frag).

in vec3 vPosition;
in vec3 vNormal;
in vec4 vAlbedo;
in vec3 vState;

uniform int uMode;              // 0 shaded, 1 temperature, 2 phase, 3 liquid fraction, 4 plain beside a data view, 5 floor
uniform vec2 uTemperatureRange; // K
uniform sampler2D uRamp;
uniform vec3 uPhaseColor[3];
uniform vec2 uPhaseLimits;

layout(location = 0) out vec4 oNormal; // octahedral normal, roughness, kind
layout(location = 1) out vec4 oAlbedo; // square root of the colour; translucency

void main() {
    float t = saturate((vState.x - uTemperatureRange.x) / max(uTemperatureRange.y - uTemperatureRange.x, 1e-6));
    // Melt lets more light in before it sends it back: deeper colour, and a film that mirrors.
    float wet = smoothstep(0.3, 0.95, vState.y);
    vec3 color = vAlbedo.rgb * mix(vec3(1.0), vAlbedo.rgb, 0.35 * wet);
    float kind = KIND_THING;
    if (uMode == 1) color = textureLod(uRamp, vec2((t * 255.0 + 0.5) / 256.0, 0.5), 0.0).rgb;
    if (uMode == 2) color = uPhaseColor[vState.y < uPhaseLimits.x ? 0 : vState.y > uPhaseLimits.y ? 2 : 1];
    if (uMode == 3) color = textureLod(uRamp, vec2((saturate(vState.y) * 255.0 + 0.5) / 256.0, 0.5), 0.0).rgb;
    if (uMode >= 1) kind = KIND_DATA;
    if (uMode == 5) kind = KIND_FLOOR;
    oNormal = vec4(octEncode(normalize(vNormal)), mix(vState.z, 0.1, wet), kind);
    oAlbedo = vec4(sqrt(color), vAlbedo.w);
}
