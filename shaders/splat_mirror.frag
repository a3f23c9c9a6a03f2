// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

void main() {
    vec3 place, normal;
    if (meet(normalize(vPoint - uEye), place, normal) < 0.0) discard;
    vec4 clip = uProjection * uView * vec4(place, 1.0);
    gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
    writeMirror(place, normal, vAlbedo.rgb);
}
