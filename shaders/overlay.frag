// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

in vec2 vUv;
uniform sampler2D uSource;
out vec4 oColor;

void main() { oColor = textureLod(uSource, vec2(vUv.x, 1.0 - vUv.y), 0.0); }
