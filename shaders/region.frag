// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Paths and shapes over the finished picture, in its own colours; what is behind something stays as a hint.

in vec3 vPosition;
in vec3 vNormal;
uniform vec3 uColor; // sRGB
uniform float uOpacity;
uniform sampler2DMS uDepths;
out vec4 oColor;

void main() {
    float facing = abs(dot(normalize(vNormal), normalize(uEye - vPosition)));
    // Lines drawn on a surface lie half in it: they are to be seen whole.
    float before = viewDepth(texelFetch(uDepths, ivec2(gl_FragCoord.xy), 0).r) + 0.015 * uSceneRadius;
    float seen = viewDepth(gl_FragCoord.z) < before ? 1.0 : 0.3;
    // Outlines fade within a pixel or two: there is one sample a pixel here.
    oColor = vec4(uColor * (0.62 + 0.38 * facing), uOpacity * seen * smoothstep(0.0, 0.3, facing));
}
