// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Glow, exposure, film curve, vignette, sRGB, and a dither of one step against bands in the backdrop.

in vec2 vUv;
uniform sampler2D uPicture, uBloomNear, uBloomFar;
uniform float uExposure;
uniform int uMode;
out vec4 oColor;

vec3 toSrgb(vec3 c) {
    c = clamp(c, 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(vec3(0.0031308), c));
}

// K. Narkowicz, "ACES filmic tone mapping curve", 2015; with a little of each channel in the others first, so that a bright
// flame runs to white instead of staying orange.
vec3 film(vec3 c) {
    c = mix(c, vec3(luminance(c)), 0.06);
    return c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14);
}

void main() {
    vec3 c = textureLod(uPicture, vUv, 0.0).rgb;
    if (uMode == 0) {
        c += 0.16 * textureLod(uBloomNear, vUv, 0.0).rgb + 0.20 * textureLod(uBloomFar, vUv, 0.0).rgb;
        vec2 d = vUv - 0.5;
        c *= 1.0 - 0.55 * dot(d, d);
        c = film(c * uExposure);
    }
    c = toSrgb(c);
    c += (gradientNoise(gl_FragCoord.xy) - 0.5) / 255.0;
    oColor = vec4(c, 1.0);
}
