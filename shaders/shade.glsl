// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Looks up the slow light of lighting.frag and puts light on wax, colliders and particles.

uniform sampler2D uGeometry, uLight, uFlame;
uniform vec2 uLightScale; // pixels of the light buffers per pixel of the picture
uniform float uCheap;     // 1: in the mirror image of the floor, without the light buffers

struct SlowLight {
    float occlusion, keyShadow, keyThrough;
    vec3 flame;
};

SlowLight slowLight(vec3 n, float depth) {
    if (uCheap > 0.5) return SlowLight(0.8, 0.75, 0.0, vec3(0.0));
    vec2 at = gl_FragCoord.xy * uLightScale - 0.5;
    ivec2 base = ivec2(floor(at)), last = textureSize(uGeometry, 0) - 1;
    vec2 f = at - vec2(base);
    vec4 light = vec4(0.0), flame = vec4(0.0);
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 offset = ivec2(i & 1, i >> 1), q = clamp(base + offset, ivec2(0), last);
        vec4 g = texelFetch(uGeometry, q, 0);
        vec2 side = mix(1.0 - f, f, vec2(offset));
        float w = side.x * side.y + 1e-3;
        w *= 1.0 / (1e-3 + abs(g.z - depth) / (0.02 * depth));
        w *= 0.02 + pow(saturate(dot(n, octDecode(g.xy))), 4.0);
        if (g.z <= 0.0) w = 1e-6;
        light += w * texelFetch(uLight, q, 0);
        flame += w * texelFetch(uFlame, q, 0);
        sum += w;
    }
    light /= sum;
    flame /= sum;
    return SlowLight(light.x, light.y, light.z, flame.rgb);
}

// Flames without shadows, for the mirror image and for highlights.
vec3 openFlames(vec3 p, vec3 n, vec3 v, float roughness, bool highlight) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < uFlameCount; ++i) {
        vec3 toLight = uFlamePosition[i].xyz - p;
        float d2 = dot(toLight, toLight);
        vec3 l = toLight * inversesqrt(d2 + 1e-12);
        vec3 irradiance = uFlameColor[i] / (d2 + uFlamePosition[i].w * uFlamePosition[i].w);
        // A flame has a size: its highlight is as wide as it looks from here.
        float wide = clamp(roughness + 0.35 * uFlamePosition[i].w * inversesqrt(d2 + 1e-12), roughness, 1.0);
        sum += irradiance * (highlight ? ggx(n, v, l, wide) : saturate(0.15 + 0.85 * dot(n, l)));
    }
    return sum;
}

vec3 shade(vec3 p, vec3 n, float depth, vec3 albedo, float translucency, float roughness, float wet) {
    vec3 v = normalize(uEye - p);
    SlowLight slow = slowLight(n, depth);
    // Melt lets more light in before it sends it back: deeper colour, and a film that mirrors.
    albedo = mix(albedo, pow(albedo, vec3(1.45)), wet * 0.8);
    roughness = mix(roughness, 0.12, wet);
    // Wrapped by colour: red travels furthest under the surface, which warms the edge of the shade.
    vec3 wrap = translucency * vec3(0.42, 0.30, 0.20);
    vec3 facing = clamp((vec3(dot(n, uKeyDirection)) + wrap) / (1.0 + wrap), 0.0, 1.0);
    vec3 key = uKeyColor * facing * facing * mix(vec3(1.0), vec3(1.12, 1.0, 0.9), translucency);
    key *= mix(slow.keyShadow, 1.0, 0.12 * translucency);
    vec3 through = uKeyColor * throughWax(slow.keyThrough, albedo) * translucency * 0.55 *
                   (1.0 - saturate(dot(n, uKeyDirection)) * slow.keyShadow);
    // Light between neighbouring parts of the same colour keeps its creases warm (Jimenez et al. 2016, multi-bounce).
    vec3 open = vec3(slow.occlusion);
    open = mix(open, pow(open, 1.0 / (1.0 + 1.4 * albedo)), 0.85);
    vec3 sky = mix(uGround, mix(uHorizon, uZenith, saturate(n.y)), saturate(n.y * 0.5 + 0.5));
    vec3 back = normalize(vec3(-uKeyDirection.x, 0.25, -uKeyDirection.z));
    vec3 rim = uKeyColor * 0.28 * pow(saturate(0.5 + 0.5 * dot(n, back)), 3.0);
    vec3 flame = uCheap > 0.5 ? 0.35 * openFlames(p, n, v, roughness, false) : slow.flame;
    vec3 color = albedo * ((sky + rim) * open + (key + through + flame) * (0.35 + 0.65 * open));

    float nv = saturate(dot(n, v));
    float fresnel = 0.04 + 0.96 * pow(1.0 - nv, 5.0) * (1.0 - 0.75 * roughness);
    float openSpecular = saturate(pow(nv + slow.occlusion, 2.0) - 1.0 + slow.occlusion);
    vec3 mirror = studio(reflect(-v, n), roughness, mix(0.15, 1.0, slow.keyShadow)) * fresnel * openSpecular;
    vec3 sparkle = 0.04 * openFlames(p, n, v, roughness, true) * openSpecular;
    color = color * (1.0 - fresnel) + mirror + min(sparkle, vec3(6.0));
    return color;
}

// Form without falsifying the colour of a scale.
vec3 shadeData(vec3 n, float depth, vec3 color) {
    SlowLight slow = slowLight(n, depth);
    float light = 0.62 + 0.38 * saturate(0.5 + 0.5 * dot(n, uKeyDirection));
    return color * light * mix(0.55, 1.0, slow.occlusion) * mix(0.92, 1.0, slow.keyShadow);
}
