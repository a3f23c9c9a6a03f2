// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// A satin table that runs into the backdrop: shadows, contact, light of the flames, and a mirror image that blurs with height.

in vec3 vPosition;
in vec3 vNormal;
in float vDepth;

uniform vec3 uFloorColor, uFloorCenter;
uniform float uReflectivity;
uniform float uFadeRadius; // m
uniform sampler2D uMirror; // alpha: 0.1..1 by height over the floor, 0 where nothing is
uniform vec2 uPictureSize;
uniform int uMode;
out vec4 oColor;

void main() {
    vec3 n = vec3(0.0, 1.0, 0.0);
    vec2 uv = gl_FragCoord.xy / uPictureSize;
    vec3 behind = backdrop(uv);
    float fade = smoothstep(0.25, 1.0, length(vPosition.xz - uFloorCenter.xz) / uFadeRadius);
    if (uMode != 0) {
        oColor = vec4(mix(shadeData(n, vDepth, uFloorColor), behind, fade), 1.0);
        return;
    }
    SlowLight slow = slowLight(n, vDepth);
    vec3 v = normalize(uEye - vPosition);
    vec3 light = uKeyColor * saturate(uKeyDirection.y) * slow.keyShadow + mix(uHorizon, uZenith, 0.6) * slow.occlusion;
    // The ground under and close to things sees little of the room.
    vec3 color = uFloorColor * (light * (0.3 + 0.7 * slow.occlusion) + slow.flame);
    float nv = saturate(v.y);
    float fresnel = (0.04 + 0.96 * pow(1.0 - nv, 5.0)) * uReflectivity;
    vec4 mirror = vec4(0.0);
    float phase = 2.0 * PI * gradientNoise(gl_FragCoord.xy);
    float reach = 0.012 * max(0.15, textureLod(uMirror, uv, 0.0).a);
    for (int i = 0; i < 6; ++i) {
        vec2 d = vogel(i, 6, phase) * reach * vec2(uPictureSize.y / uPictureSize.x, 1.6);
        vec4 m = textureLod(uMirror, uv + d, 0.0);
        mirror += vec4(m.rgb * (m.a > 0.0 ? 1.0 - 0.75 * m.a : 0.0), m.a > 0.0 ? 1.0 - 0.75 * m.a : 0.0);
    }
    mirror /= 6.0;
    vec3 room = mix(behind, studio(reflect(-v, n), 0.45, slow.keyShadow), 0.2);
    color = mix(color, room, fresnel * (1.0 - mirror.a) * 0.5 * slow.occlusion);
    color += mirror.rgb * (fresnel + 0.05 * uReflectivity);
    oColor = vec4(mix(color, behind, fade), 1.0);
}
