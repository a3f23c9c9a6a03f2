// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

in vec3 vPosition;
in vec3 vNormal;
in float vDepth;
in vec4 vAlbedo;
in vec3 vState;

uniform int uMode;             // 0 shaded, 1 temperature, 2 phase, 3 neutral grey beside a data view
uniform vec2 uTemperatureRange; // K
uniform sampler2D uRamp;
uniform vec3 uPhaseColor[3];
uniform vec2 uPhaseLimits;
out vec4 oColor;

void main() {
    vec3 n = normalize(vNormal);
    if (uMode == 1) {
        float t = saturate((vState.x - uTemperatureRange.x) / max(uTemperatureRange.y - uTemperatureRange.x, 1e-6));
        oColor = vec4(shadeData(n, vDepth, textureLod(uRamp, vec2((t * 255.0 + 0.5) / 256.0, 0.5), 0.0).rgb), 1.0);
    } else if (uMode == 2) {
        vec3 c = vState.y < uPhaseLimits.x ? uPhaseColor[0] : vState.y > uPhaseLimits.y ? uPhaseColor[2] : uPhaseColor[1];
        oColor = vec4(shadeData(n, vDepth, c), 1.0);
    } else if (uMode == 3) {
        oColor = vec4(shadeData(n, vDepth, vec3(0.33)), 1.0);
    } else {
        float wet = smoothstep(0.25, 0.95, vState.y);
        oColor = vec4(shade(vPosition, n, vDepth, vAlbedo.rgb, vAlbedo.w, vState.z, wet), 1.0);
    }
    if (uCheap > 0.5) oColor.a = saturate((vPosition.y - uFloorHeight) / (0.35 * uSceneRadius)) * 0.9 + 0.1;
}
