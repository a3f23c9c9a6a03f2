// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Blended by the maximum: the nearest surface without a depth test, and how far inside the outline of all a pixel is.

out vec4 oColor; // -view depth; pixels to the outline, > 0 inside

void main() {
    vec3 place, normal;
    float inside = meet(normalize(vPoint - uEye), place, normal);
    float slope = length(vec2(dFdx(inside), dFdy(inside)));
    float depth = dot(place - uEye, uCameraForward);
    oColor = vec4(inside > 0.0 ? -depth : -1e9, clamp(inside / max(slope, 1e-6), -3.0, 3.0), 0.0, 0.0);
}
