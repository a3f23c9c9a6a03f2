// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Puts light on the geometry buffer, one kind of pixel per pass: BACKDROP_PASS, THING_PASS, CLEAR_PASS, FLOOR_PASS, DATA_PASS, and
// EDGE_PASS for pixels whose samples differ and are shaded one by one. The passes are for software rasterisers: they run
// both sides of an if for every pixel, but leave a block of pixels when all of it is discarded.

in vec2 vUv;
uniform sampler2DMS uNormals, uAlbedos, uDepths;
uniform sampler2D uGeometry, uLight, uFlame, uMirror, uKinds;
uniform int uSampleCount;
uniform vec2 uLightScale, uPictureSize; // pixels of the light buffers per pixel; pixels
uniform vec3 uFloorCenter;
uniform float uReflectivity, uFadeRadius;
uniform int uPlain; // 1: beside a data view, without studio light
uniform sampler2D uBehind, uBack; // the scene without the melt, alpha: something is there; depth of the melt's back
uniform vec3 uFloorColor;
uniform int uFloorShown;
out vec4 oColor;

struct SlowLight {
    float occlusion, keyShadow, keyThrough;
    vec3 flame;
};

// The light buffers between their pixels, from the same surface only.
SlowLight slowLight(vec3 n, float depth) {
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
        float facing = saturate(dot(n, octDecode(g.xy)));
        w *= (0.02 + facing * facing * facing * facing) / (1e-3 + abs(g.z - depth) / (0.02 * depth));
        if (g.z <= 0.0) w = 1e-6;
        light += w * texelFetch(uLight, q, 0);
        flame += w * texelFetch(uFlame, q, 0);
        sum += w;
    }
    light /= sum;
    return SlowLight(light.x, light.y, light.z, flame.rgb / sum);
}

vec3 flameHighlights(vec3 p, vec3 n, vec3 v, float roughness) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < uFlameCount; ++i) {
        vec3 toLight = uFlamePosition[i].xyz - p;
        float inverse = inversesqrt(dot(toLight, toLight) + 1e-12);
        // A flame has a size: its highlight is as wide as it looks from here.
        float wide = min(roughness + 0.1 * uFlamePosition[i].w * inverse, 1.0);
        float soft = 1.0 / (inverse * inverse) + uFlamePosition[i].w * uFlamePosition[i].w;
        sum += uFlameColor[i] / soft * ggx(n, v, toLight * inverse, wide);
    }
    return sum;
}

vec3 thing(vec3 p, vec3 n, SlowLight slow, vec3 albedo, float translucency, float roughness) {
    vec3 v = normalize(uEye - p);
    // At outlines the normal of a vertex may turn away from the eye: bend it back, or single pixels mirror the room.
    n = normalize(n + v * max(0.05 - dot(n, v), 0.0));
    // Wrapped by colour: red travels furthest under the surface, which warms the edge of the shade.
    vec3 wrap = translucency * vec3(0.46, 0.30, 0.18);
    vec3 facing = clamp((vec3(dot(n, uKeyDirection)) + wrap) / (1.0 + wrap), 0.0, 1.0);
    vec3 key = uKeyColor * facing * facing * mix(slow.keyShadow, 1.0, 0.10 * translucency);
    vec3 through = uKeyColor * throughWax(slow.keyThrough, albedo) * translucency * 0.6 *
                   (1.0 - saturate(dot(n, uKeyDirection)) * slow.keyShadow);
    // Light between neighbouring parts of one colour keeps creases warm (Jimenez et al., "Practical real-time strategies for
    // accurate indirect occlusion", 2016).
    vec3 open = mix(vec3(slow.occlusion), pow(vec3(slow.occlusion), 1.0 / (1.0 + 1.4 * albedo)), 0.85);
    vec3 sky = mix(uGround, mix(uHorizon, uZenith, saturate(n.y)), saturate(n.y * 0.5 + 0.5));
    vec3 back = normalize(vec3(-uKeyDirection.x, 0.2, -uKeyDirection.z));
    float behind = saturate(0.5 + 0.5 * dot(n, back));
    vec3 rim = uKeyColor * 0.15 * behind * behind * behind;
    vec3 color = albedo * ((sky + rim) * open + (key + through + slow.flame) * (0.3 + 0.7 * open));

    float nv = saturate(dot(n, v)), grazing = 1.0 - nv;
    float grazing2 = grazing * grazing;
    float smoothness = max(1.0 - roughness, 0.2);
    float fresnel = 0.04 + (smoothness * smoothness - 0.04) * grazing2 * grazing2 * grazing;
    float openSpecular = saturate((nv + slow.occlusion) * (nv + slow.occlusion) - 1.0 + slow.occlusion);
    vec3 mirror = studio(reflect(-v, n), roughness, mix(0.15, 1.0, slow.keyShadow)) * fresnel * openSpecular;
    vec3 sparkle = 0.04 * flameHighlights(p, n, v, roughness) * openSpecular;
    return color * (1.0 - fresnel) + mirror + min(sparkle, vec3(5.0));
}

// What is seen through a clear thing: along the ray that its surface bends, past its back.
vec3 through(vec3 p, vec3 n, vec3 v, float depth, float thickness) {
    vec3 inside = refract(-v, n, 1.0 / 1.31), outside = normalize(inside - 0.6 * v), exit = p + inside * thickness;
    // Where the floor ends the ray, or well behind.
    float way = outside.y < -0.01 ? (exit.y - uFloorHeight) / -outside.y : 1e3 * uSceneRadius;
    vec3 near = exit + outside * min(max(way, 0.0), 0.6 * uSceneRadius);
    vec4 clip = uProjection * uView * vec4(near, 1.0);
    vec2 uv = clip.xy / clip.w * 0.5 + 0.5;
    vec4 thing = textureLod(uBehind, uv, 0.0);
    vec3 far = backdrop(clamp(uv, 0.0, 1.0));
    if (uFloorShown == 1 && way < 1e2 * uSceneRadius) {
        vec3 hit = exit + outside * max(way, 0.0);
        float away = length(hit.xz - uFloorCenter.xz) / uFadeRadius, spot = 1.0 / (1.0 + 7.0 * away * away);
        // Under a clear thing it is neither lit nor dark: it bends the light to where its shadow would be.
        vec3 light = uKeyColor * saturate(uKeyDirection.y) * spot * 0.75 + mix(uHorizon, uZenith, 0.6);
        far = mix(uFloorColor * light, far, smoothstep(0.35, 1.0, away));
    }
    // The room's lights, focused by the far side.
    vec3 facet = normalize(vec3(n.z, 0.7, -n.x) + 0.8 * n);
    vec3 lights = studio(reflect(inside, facet), 0.12, 1.0) + studio(reflect(inside, normalize(facet - 1.2 * n)), 0.12, 1.0);
    return mix(far, thing.rgb, thing.a > 0.0 ? 1.0 : 0.0) + 0.22 * lights;
}

vec3 clearThing(vec3 p, vec3 n, SlowLight slow, vec3 albedo, float translucency, float roughness, float depth, float clear) {
    vec3 milky = thing(p, n, slow, albedo, translucency, roughness), v = normalize(uEye - p);
    // The farthest back nearby that is not open: at half size the pixel itself may show what is before or beside it.
    ivec2 size = textureSize(uBack, 0), base = ivec2(floor(vUv * vec2(size) - 0.5));
    float back = -1.0;
    for (int i = 0; i < 4; ++i) {
        float d = texelFetch(uBack, clamp(base + ivec2(i & 1, i >> 1), ivec2(0), size - 1), 0).r;
        if (d < 1.0) back = max(back, viewDepth(d));
    }
    if (back < depth) return milky;
    float thickness = (back - depth) / max(dot(-v, uCameraForward), 0.1);
    n = normalize(n + v * max(0.05 - dot(n, v), 0.0));
    float passes = exp(-thickness / clear), grazing = 1.0 - saturate(dot(n, v)), grazing2 = grazing * grazing;
    float fresnel = 0.03 + 0.6 * grazing2 * grazing2 * grazing;
    float open = saturate(1.0 - grazing + slow.occlusion);
    // Colour deepens with the way.
    vec3 tint = pow(max(albedo, vec3(0.02)), vec3(min(thickness / clear, 3.0)));
    vec3 bare = through(p, n, v, depth, thickness) * tint * (1.0 - fresnel);
    vec3 mirror = studio(reflect(-v, n), 0.08, mix(0.3, 1.0, slow.keyShadow)) * fresnel * open;
    vec3 sparkle = min(0.04 * flameHighlights(p, n, v, 0.1), vec3(5.0));
    return mix(milky, bare + mirror + sparkle, passes);
}

// A satin table that runs into the backdrop: shadows, contact, light of the flames, and a mirror image that blurs with height.
vec3 table(vec3 p, SlowLight slow, vec3 albedo, vec3 behind) {
    vec3 n = vec3(0.0, 1.0, 0.0), v = normalize(uEye - p);
    float away = length(p.xz - uFloorCenter.xz) / uFadeRadius;
    // A pool of light, as a softbox over a table makes it: it falls off long before the table ends.
    float spot = 1.0 / (1.0 + 7.0 * away * away);
    vec3 key = uKeyColor * saturate(uKeyDirection.y) * slow.keyShadow * spot;
    vec3 light = key + mix(uHorizon, uZenith, 0.6) * slow.occlusion * mix(0.4, 1.0, spot);
    vec3 color = albedo * (light * (0.25 + 0.75 * slow.occlusion) + slow.flame);
    float nv = saturate(v.y), grazing = 1.0 - nv;
    float fresnel = (0.05 + 0.95 * grazing * grazing * grazing * grazing * grazing) * uReflectivity;
    vec4 image = textureLod(uMirror, vUv, 0.0);
    vec3 room = 0.8 * behind + 0.02 * uKeyColor * slow.keyShadow;
    color = mix(color, room, fresnel * (1.0 - image.a) * slow.occlusion);
    color += image.rgb * (fresnel + 0.05 * uReflectivity) * slow.occlusion;
    return mix(color, behind, smoothstep(0.35, 1.0, away));
}

// Form without falsifying the colours of a scale.
vec3 data(vec3 n, SlowLight slow, vec3 color) {
    float light = 0.66 + 0.34 * saturate(0.5 + 0.5 * dot(n, uKeyDirection));
    return color * light * mix(0.6, 1.0, slow.occlusion) * mix(0.93, 1.0, slow.keyShadow);
}

vec3 floorPixel(vec3 p, vec3 n, SlowLight slow, vec3 albedo, vec3 behind) {
    float fade = smoothstep(0.3, 1.0, length(p.xz - uFloorCenter.xz) / uFadeRadius);
    if (uPlain == 1) return mix(data(n, slow, albedo), behind, fade);
    return table(p, slow, albedo, behind);
}

vec3 pixel(ivec2 at, int s) {
    vec3 behind = backdrop(vUv);
#if defined(BACKDROP_PASS)
    return behind;
#else
    vec4 normal = texelFetch(uNormals, at, s), albedo = texelFetch(uAlbedos, at, s);
    float depth = viewDepth(texelFetch(uDepths, at, s).r);
    vec3 n = octDecode(normal.xy), p = worldAt(vUv, depth), base = albedo.rgb * albedo.rgb;
    SlowLight slow = slowLight(n, depth);
#if defined(THING_PASS)
    return thing(p, n, slow, base, albedo.a, normal.z);
#elif defined(CLEAR_PASS)
    return clearThing(p, n, slow, base, albedo.a, normal.z, depth, clearDepth(normal.w));
#elif defined(FLOOR_PASS)
    return floorPixel(p, n, slow, base, behind);
#elif defined(DATA_PASS)
    return data(n, slow, base);
#else
    float clear = clearDepth(normal.w);
    if (clear > 0.0) return clearThing(p, n, slow, base, albedo.a, normal.z, depth, clear);
    if (normal.w < KIND_THING - 0.5) return behind;
    if (normal.w < KIND_FLOOR - 0.5) return thing(p, n, slow, base, albedo.a, normal.z);
    if (normal.w == KIND_FLOOR) return floorPixel(p, n, slow, base, behind);
    if (normal.w == KIND_DATA) return data(n, slow, base);
    return behind;
#endif
#endif
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float kind = texelFetch(uKinds, at, 0).r * 255.0;
#if defined(EDGE_PASS)
    if (kind < KIND_EDGE - 0.5) discard;
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int s = 0; s < uSampleCount; ++s) {
        vec3 c = pixel(at, s);
        // Against single very bright samples (B. Karis, "Tone mapping", 2013).
        float w = 1.0 / (1.0 + luminance(c));
        sum += c * w;
        weights += w;
    }
    oColor = vec4(sum / weights, 1.0);
#else
#if defined(BACKDROP_PASS)
    const float wanted = KIND_NOTHING;
#elif defined(THING_PASS)
    const float wanted = KIND_THING;
#elif defined(CLEAR_PASS)
    const float wanted = KIND_CLEAR;
#elif defined(FLOOR_PASS)
    const float wanted = KIND_FLOOR;
#else
    const float wanted = KIND_DATA;
#endif
    if (abs(kind - wanted) > 0.5) discard;
    oColor = vec4(pixel(at, 0), 1.0);
#endif
}
