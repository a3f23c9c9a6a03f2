// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Where a ray meets the ellipsoid of splat.vert.

flat in vec4 vCenter;
flat in vec4 vAxis;
flat in vec4 vAlbedo;
flat in vec3 vState;
in vec3 vPoint;

vec3 toUnitSphere(vec3 v) {
    return (v + vAxis.xyz * (dot(vAxis.xyz, v) * (1.0 / vAxis.w - 1.0))) / vCenter.w;
}

// 1 through the middle, 0 at the outline, negative outside.
float meet(vec3 direction, out vec3 place, out vec3 normal) {
    vec3 o = toUnitSphere(vPoint - vCenter.xyz), d = toUnitSphere(direction);
    float a = dot(d, d), b = dot(o, d), inside = (b * b - a * (dot(o, o) - 1.0)) / a;
    float t = (-b - sqrt(max(inside * a, 0.0))) / a;
    place = vPoint + direction * t;
    normal = normalize(toUnitSphere(toUnitSphere(place - vCenter.xyz)));
    return inside;
}
