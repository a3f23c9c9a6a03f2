// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Sums of what the particles at the surface carry, from around each pixel.

uniform sampler2D uSmooth;
uniform vec2 uPictureSize, uTargetSize;
uniform float uSpacing;
layout(location = 0) out vec4 oAlbedo; // colour, weight
layout(location = 1) out vec4 oState;  // place on the scale of temperature, liquid fraction, roughness, translucency

void main() {
    float z = texelFetch(uSmooth, ivec2(gl_FragCoord.xy / uTargetSize * uPictureSize), 0).r;
    vec3 place, normal;
    float inside = meet(normalize(vPoint - uEye), place, normal);
    float behind = abs(dot(vCenter.xyz - uEye, uCameraForward) - z) / (1.8 * uSpacing);
    float w = z > 0.0 ? max(inside, 0.0) * max(1.0 - behind * behind, 0.0) : 0.0;
    if (w <= 0.0) discard;
    w *= w;
    oAlbedo = vec4(vAlbedo.rgb, 1.0) * w;
    oState = vec4(vState, vAlbedo.a) * w;
}
