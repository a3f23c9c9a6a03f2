// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

in vec2 vUv;
uniform sampler2D uSource;
uniform vec2 uDirection;
out vec4 oColor;

void main() {
    vec2 texel = uDirection / vec2(textureSize(uSource, 0));
    vec3 sum = textureLod(uSource, vUv, 0.0).rgb * 0.2270;
    sum += (textureLod(uSource, vUv + texel * 1.3846, 0.0).rgb + textureLod(uSource, vUv - texel * 1.3846, 0.0).rgb) * 0.3162;
    sum += (textureLod(uSource, vUv + texel * 3.2308, 0.0).rgb + textureLod(uSource, vUv - texel * 3.2308, 0.0).rgb) * 0.0703;
    oColor = vec4(sum, 1.0);
}
