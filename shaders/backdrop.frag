// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

in vec2 vUv;
out vec4 oColor;

void main() { oColor = vec4(backdrop(vUv), 1.0); }
