// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Mean of the samples, weighted against single very bright ones (B. Karis, "Tone mapping", 2013), so that edges beside a
// flame stay smooth.

in vec2 vUv;
uniform sampler2DMS uSamples;
uniform int uSampleCount;
out vec4 oColor;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 first = texelFetch(uSamples, at, 0).rgb;
    float w = 1.0 / (1.0 + luminance(first)), weights = w;
    vec3 sum = first * w;
    for (int i = 1; i < uSampleCount; ++i) {
        vec3 c = texelFetch(uSamples, at, i).rgb;
        w = 1.0 / (1.0 + luminance(c));
        sum += c * w;
        weights += w;
    }
    oColor = vec4(sum / weights, 1.0);
}
