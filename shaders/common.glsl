// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Put before every other file by the renderer, behind the #version line. All light is linear; lengths are metres.

const float PI = 3.14159265;
const int MAX_FLAMES = 8;
const int SHADOWED_FLAMES = 4;
const int MAX_MATERIALS = 16;

uniform mat4 uView, uProjection;
uniform vec3 uEye, uCameraRight, uCameraUp, uCameraForward; // right and up scaled by the tangents of the half angles
uniform float uSceneRadius, uFloorHeight;
uniform vec2 uNearFar; // m

uniform vec3 uKeyDirection, uKeyColor; // towards the light; irradiance at normal incidence
uniform vec3 uKeyRight, uKeyUp;
uniform float uKeyAngle; // rad, radius of the light as seen from the scene
uniform mat4 uKeyMatrix; // world to 0..1 in the shadow map
uniform float uKeyExtent, uKeyDepth, uKeyTexel; // m across the map, m in depth, 1 / map size
uniform sampler2D uKeyMap;

uniform vec3 uZenith, uHorizon, uGround;
uniform vec3 uBackdropCenter, uBackdropEdge;

uniform int uFlameCount;
uniform vec4 uFlamePosition[MAX_FLAMES]; // w: softening radius
uniform vec3 uFlameColor[MAX_FLAMES];    // radiant intensity
uniform vec3 uFlameAxis[SHADOWED_FLAMES], uFlameRight[SHADOWED_FLAMES], uFlameUp[SHADOWED_FLAMES];
uniform float uFlameReach;
uniform sampler2DArray uFlameMap;

// What a pixel of the geometry buffer shows.
const float KIND_NOTHING = 0.0, KIND_THING = 1.0, KIND_FLOOR = 2.0, KIND_DATA = 3.0;
// Among the kinds of pixels that are shaded together: a thing that is clear.
const float KIND_CLEAR = 4.0, KIND_EDGE = 8.0;

// How deep one can see into a thing, m: 0.45 of a share goes onto its kind in the buffer.
const float CLEAR_SCALE = 0.05;
float clearDepth(float kind) {
    float share = fract(kind) / 0.45;
    return share < 0.02 ? 0.0 : CLEAR_SCALE * share / max(1.0 - share, 0.01);
}

float saturate(float x) { return clamp(x, 0.0, 1.0); }
float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }

// Octahedral normals: Cigolle et al., "A survey of efficient representations for independent unit vectors", 2014.
vec2 octEncode(vec3 n) {
    n /= abs(n.x) + abs(n.y) + abs(n.z);
    return n.z >= 0.0 ? n.xy : (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
}
vec3 octDecode(vec2 e) {
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return normalize(n);
}

// Interleaved gradient noise: J. Jimenez, "Next generation post processing in Call of Duty", 2014.
float gradientNoise(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))); }

// Point i of n on a disc, turned by phase: Vogel's sunflower.
vec2 vogel(int i, int n, float phase) {
    float r = sqrt((float(i) + 0.5) / float(n));
    float a = float(i) * 2.39996323 + phase;
    return r * vec2(cos(a), sin(a));
}

// What light keeps of each colour on its way through wax: red goes deepest.
vec3 throughWax(float transmission, vec3 albedo) {
    return pow(vec3(max(transmission, 1e-4)), vec3(0.78, 1.06, 1.75)) * sqrt(albedo);
}

// A dim room with a large softbox at the key light and a strip behind: what shiny things reflect.
vec3 studio(vec3 d, float roughness, float keyShadow) {
    float blur = 0.06 + 0.9 * roughness;
    vec3 light = mix(uGround, uHorizon, smoothstep(-0.25 - blur, 0.15 + blur, d.y));
    light = mix(light, uZenith, smoothstep(0.1 - blur, 0.9 + blur, d.y));
    float front = dot(d, uKeyDirection);
    vec2 q = vec2(dot(d, uKeyRight), dot(d, uKeyUp)) / max(front, 0.05);
    vec2 box = smoothstep(vec2(0.36 + blur), vec2(max(0.36 - blur, 0.0)), abs(q));
    light += uKeyColor * (front > 0.0 ? box.x * box.y : 0.0) * keyShadow * 1.1 / (1.0 + 9.0 * roughness * roughness);
    vec3 back = normalize(vec3(-uKeyDirection.x, 0.35, -uKeyDirection.z));
    float side = dot(d, normalize(cross(back, vec3(0, 1, 0)))), facing = dot(d, back);
    float strip = smoothstep(0.16 + blur, max(0.16 - blur, 0.0), abs(side)) * smoothstep(-0.2, 0.2 + blur, d.y);
    light += uKeyColor * (facing > 0.0 ? strip : 0.0) * 0.55 / (1.0 + 9.0 * roughness * roughness);
    return light;
}

// GGX lobe times pi, for a light of the given colour and direction.
float ggx(vec3 n, vec3 v, vec3 l, float roughness) {
    vec3 h = normalize(v + l);
    float a = max(roughness * roughness, 0.002), a2 = a * a;
    float nh = saturate(dot(n, h)), nl = saturate(dot(n, l)), nv = saturate(dot(n, v)) + 1e-3;
    float d = a2 / max((nh * nh * (a2 - 1.0) + 1.0) * (nh * nh * (a2 - 1.0) + 1.0), 1e-7);
    float k = a * 0.5 + 0.05;
    float g = nl / ((nl * (1.0 - k) + k) * (nv * (1.0 - k) + k));
    return 0.25 * d * g;
}

vec3 backdrop(vec2 uv) {
    vec2 d = (uv - vec2(0.5, 0.56)) * vec2(1.15, 1.25);
    return mix(uBackdropCenter, uBackdropEdge, smoothstep(0.0, 0.78, length(d)));
}

// Distance along the line of sight of a value in the depth buffer.
float viewDepth(float d) {
    return 2.0 * uNearFar.x * uNearFar.y / (uNearFar.y + uNearFar.x - (2.0 * d - 1.0) * (uNearFar.y - uNearFar.x));
}

vec3 worldAt(vec2 uv, float depth) {
    vec2 ndc = uv * 2.0 - 1.0;
    return uEye + depth * (uCameraForward + ndc.x * uCameraRight + ndc.y * uCameraUp);
}

// Place in the map of a shadowed flame (a paraboloid that looks along its axis); z is the distance over the reach.
vec3 flameCoordinates(int i, vec3 p) {
    vec3 d = p - uFlamePosition[i].xyz;
    float r = max(length(d), 1e-6);
    d /= r;
    vec3 local = vec3(dot(d, uFlameRight[i]), dot(d, uFlameUp[i]), dot(d, uFlameAxis[i]));
    return vec3(local.xy / (1.0 + max(local.z, -0.6)) * 0.8, r / uFlameReach);
}
