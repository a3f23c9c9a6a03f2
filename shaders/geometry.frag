// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Kept short: software rasterisers shade blocks of 16 pixels for every triangle, however small, so everything costly waits for
// the whole picture (shade.frag).

in vec3 vPosition;
uniform bool uInside; // what is cut open: its far wall is looked at from inside

in vec3 vNormal;
in vec4 vAlbedo;
in vec3 vState;
in vec2 vClear;

uniform vec2 uTemperatureRange; // K

void main() {
    float t = (vState.x - uTemperatureRange.x) / max(uTemperatureRange.y - uTemperatureRange.x, 1e-6);
    writeSurface(vAlbedo.rgb, vAlbedo.w, vec3(t, vState.yz), vClear, normalize(vNormal) * (uInside && !gl_FrontFacing ? -1.0 : 1.0));
}
