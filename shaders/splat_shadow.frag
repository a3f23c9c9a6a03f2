// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Into the depth maps of the lights.

uniform int uFlameLayer;

void main() {
    vec3 place, normal;
#if defined(KEY_PASS)
    if (meet(-uKeyDirection, place, normal) < 0.0) discard;
    gl_FragDepth = (uKeyMatrix * vec4(place, 1.0)).z;
#else
    vec3 from = uFlamePosition[uFlameLayer].xyz;
    if (meet(normalize(vPoint - from), place, normal) < 0.0) discard;
    gl_FragDepth = length(place - from) / uFlameReach;
#endif
}
