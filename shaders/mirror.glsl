// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// What the table reflects: rough light without the screen's buffers. alpha: 0.1..1 by height over the floor.

out vec4 oColor;

void writeMirror(vec3 p, vec3 n, vec3 albedo) {
    vec3 light = mix(uGround, uHorizon, 0.5 + 0.5 * n.y) + uKeyColor * 0.6 * saturate(dot(n, uKeyDirection) * 0.7 + 0.3);
    for (int i = 0; i < uFlameCount; ++i) {
        vec3 d = uFlamePosition[i].xyz - p;
        light += 0.25 * uFlameColor[i] / (dot(d, d) + uFlamePosition[i].w * uFlamePosition[i].w);
    }
    float height = saturate((p.y - uFloorHeight) / (0.5 * uSceneRadius));
    oColor = vec4(albedo * light, height * 0.9 + 0.1);
}
