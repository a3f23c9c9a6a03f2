// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

in vec3 vPosition;
in vec3 vNormal;
in vec4 vAlbedo;
in vec3 vState;

void main() { writeMirror(vPosition, normalize(vNormal), vAlbedo.rgb); }
