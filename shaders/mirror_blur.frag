// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Blurs the mirror image with the height of what is in it, and fades it. alpha: how much of it there is.

in vec2 vUv;
uniform sampler2D uMirror;
out vec4 oColor;

void main() {
    ivec2 size = textureSize(uMirror, 0);
    float phase = 2.0 * PI * gradientNoise(gl_FragCoord.xy);
    float reach = 0.016 * float(size.y) * max(0.12, texelFetch(uMirror, ivec2(gl_FragCoord.xy), 0).a);
    vec4 image = vec4(0.0);
    for (int i = 0; i < 12; ++i) {
        vec2 q = gl_FragCoord.xy + vogel(i, 12, phase) * reach * vec2(1.0, 1.7);
        vec4 m = texelFetch(uMirror, clamp(ivec2(q), ivec2(0), size - 1), 0);
        image += (m.a > 0.0 ? 1.0 - 0.85 * m.a : 0.0) * vec4(m.rgb, 1.0);
    }
    oColor = image / 12.0;
}
