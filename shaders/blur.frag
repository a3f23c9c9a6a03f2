// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// One direction of a blur that does not cross edges of depth or normal.

in vec2 vUv;
uniform sampler2D uGeometry, uLight, uFlame;
uniform ivec2 uStep;
layout(location = 0) out vec4 oLight;
layout(location = 1) out vec4 oFlame;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(uGeometry, 0) - 1;
    vec4 g = texelFetch(uGeometry, at, 0);
    vec4 light = texelFetch(uLight, at, 0), flame = texelFetch(uFlame, at, 0);
    if (g.z <= 0.0) discard;
    vec3 n = octDecode(g.xy);
    float sum = 1.0, sharp = 60.0 / g.z;
    for (int i = -3; i <= 3; ++i) {
        if (i == 0) continue;
        ivec2 q = clamp(at + i * uStep, ivec2(0), last);
        vec4 h = texelFetch(uGeometry, q, 0);
        float w = exp(-float(i * i) / 6.0) * saturate(1.0 - sharp * abs(h.z - g.z));
        float facing = saturate(dot(n, octDecode(h.xy)));
        w *= facing * facing * facing * facing;
        if (h.z <= 0.0) w = 0.0;
        light += w * texelFetch(uLight, q, 0);
        flame += w * texelFetch(uFlame, q, 0);
        sum += w;
    }
    light /= sum;
    flame /= sum;
    oLight = light;
    oFlame = flame;
}
