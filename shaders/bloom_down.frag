// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

in vec2 vUv;
uniform sampler2D uSource;
uniform float uThreshold;
out vec4 oColor;

void main() {
    vec2 texel = 1.0 / vec2(textureSize(uSource, 0));
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        vec2 d = vec2((i & 1) * 2 - 1, (i >> 1) * 2 - 1) * texel;
        vec3 c = min(textureLod(uSource, vUv + d, 0.0).rgb, vec3(20.0));
        float l = luminance(c);
        sum += c * (uThreshold > 0.0 ? max(l - uThreshold, 0.0) / max(l, 1e-4) : 1.0);
    }
    oColor = vec4(sum * 0.25, 1.0);
}
