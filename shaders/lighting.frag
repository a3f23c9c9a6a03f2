// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Everything that needs many samples and changes slowly, at half size: ambient occlusion, the soft shadow of the key light,
// light that comes through wax, and the flames with their shadows. Blurred afterwards, then looked up by surface.frag.

in vec2 vUv;
uniform sampler2D uGeometry;
uniform float uOcclusionRadius; // m
uniform float uScatter;         // m, mean way of light in wax of translucency 1
layout(location = 0) out vec4 oLight; // occlusion, key shadow, key transmission, -
layout(location = 1) out vec4 oFlame; // diffuse light of the flames

const int kOcclusionTaps = 10;
const int kContactTaps = 6;
const int kBlockerTaps = 8;
const int kShadowTaps = 12;
const int kFlameTaps = 7;

// A cone of taps over the hemisphere seen on screen, each weighted by its cosine and distance.
float occlusion(vec3 p, vec3 n, float depth, float phase, float radius, int taps) {
    vec2 size = vec2(textureSize(uGeometry, 0));
    float reach = radius * size.y * 0.5 / (depth * length(uCameraUp));
    reach = clamp(reach, 2.0, 0.12 * size.y);
    float worldReach = reach * depth * length(uCameraUp) / (0.5 * size.y);
    float sum = 0.0;
    for (int i = 0; i < taps; ++i) {
        vec2 at = gl_FragCoord.xy + vogel(i, taps, phase) * reach;
        if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, size))) continue;
        float z = texelFetch(uGeometry, ivec2(at), 0).z;
        if (z <= 0.0) continue;
        vec3 v = worldAt(at / size, z) - p;
        float d2 = dot(v, v);
        float near = saturate(1.0 - d2 / (4.0 * worldReach * worldReach));
        sum += near * saturate(dot(v, n) * inversesqrt(d2 + 1e-12) - 0.08);
    }
    return saturate(1.0 - 1.9 * sum / float(taps));
}

// R. Fernando, "Percentage-closer soft shadows", 2005; the same taps give the way of the light through the body.
vec2 keyLight(vec3 p, vec3 n, float translucency, float phase) {
    float texelSize = uKeyExtent * uKeyTexel;
    vec3 at = (uKeyMatrix * vec4(p + n * texelSize * 1.8, 1.0)).xyz;
    if (any(lessThan(at.xy, vec2(0.0))) || any(greaterThan(at.xy, vec2(1.0)))) return vec2(1.0, 0.0);
    float bias = texelSize / uKeyDepth;
    float search = clamp(uKeyAngle * 0.7 * uSceneRadius / uKeyExtent, 2.0 * uKeyTexel, 0.1);
    float blockers = 0.0, depthSum = 0.0;
    for (int i = 0; i < kBlockerTaps; ++i) {
        float z = textureLod(uKeyMap, at.xy + vogel(i, kBlockerTaps, phase) * search, 0.0).r;
        if (z < at.z - bias) blockers += 1.0, depthSum += z;
    }
    if (blockers < 0.5) return vec2(1.0, 1.0);
    float gap = (at.z - depthSum / blockers) * uKeyDepth;
    float width = clamp(gap * uKeyAngle / uKeyExtent, 1.5 * uKeyTexel, search);
    float lit = 0.0, through = 0.0;
    float way = uScatter * max(translucency, 0.02) / uKeyDepth;
    for (int i = 0; i < kShadowTaps; ++i) {
        float z = textureLod(uKeyMap, at.xy + vogel(i, kShadowTaps, phase + 1.3) * width, 0.0).r;
        float inside = max(at.z - z, 0.0);
        lit += inside < bias * 1.5 ? 1.0 : 0.0;
        through += exp(-inside / way);
    }
    return vec2(lit, through) / float(kShadowTaps);
}

vec3 flames(vec3 p, vec3 n, float translucency, float phase) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < uFlameCount; ++i) {
        vec3 toLight = uFlamePosition[i].xyz - p;
        float d2 = dot(toLight, toLight);
        vec3 l = toLight * inversesqrt(d2 + 1e-12);
        vec3 irradiance = uFlameColor[i] / (d2 + uFlamePosition[i].w * uFlamePosition[i].w);
        float wrap = 0.25 * translucency;
        float facing = saturate((dot(n, l) + wrap) / (1.0 + wrap));
        float lit = 1.0, through = 0.0;
        if (i < SHADOWED_FLAMES && dot(-l, uFlameAxis[i]) > -0.25) {
            float r = sqrt(d2);
            float bias = 0.012 * r + 0.006 * uSceneRadius;
            vec3 at = flameCoordinates(i, p);
            float width = clamp(0.3 * uFlamePosition[i].w / r, 0.012, 0.07);
            float way = uScatter * max(translucency, 0.02) * 1.35;
            lit = 0.0;
            for (int k = 0; k < kFlameTaps; ++k) {
                vec2 uv = at.xy + vogel(k, kFlameTaps, phase) * width;
                float inside = (at.z - textureLod(uFlameMap, vec3(uv * 0.5 + 0.5, float(i)), 0.0).r) * uFlameReach;
                lit += inside < bias ? 1.0 : 0.0;
                through += exp(-max(inside, 0.0) / way);
            }
            lit /= float(kFlameTaps);
            through /= float(kFlameTaps);
        }
        vec3 inner = translucency * 0.75 * pow(vec3(max(through, 1e-4)), vec3(0.8, 1.2, 2.0));
        sum += irradiance * (lit * facing + inner * (1.0 - 0.6 * lit * facing));
    }
    return sum;
}

void main() {
    vec4 g = texelFetch(uGeometry, ivec2(gl_FragCoord.xy), 0);
    if (g.z <= 0.0) discard; // of no use to anyone, and leaves the pass early
    vec3 n = octDecode(g.xy);
    vec3 p = worldAt(vUv, g.z);
    float phase = 2.0 * PI * gradientNoise(gl_FragCoord.xy);
    // Wide, and close up for the line where things touch.
    float contact = occlusion(p, n, g.z, phase + 2.1, 0.2 * uOcclusionRadius, kContactTaps);
    oLight.x = occlusion(p, n, g.z, phase, uOcclusionRadius, kOcclusionTaps) * mix(1.0, contact, 0.6);
    oLight.yz = keyLight(p, n, g.w, phase);
    oFlame.rgb = min(flames(p, n, g.w, phase), vec3(200.0));
    oLight.w = 1.0;
    oFlame.a = 1.0;
}
