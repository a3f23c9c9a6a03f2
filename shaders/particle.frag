// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

out vec4 oColor;

void main() {
    raiseSphere();
    oColor = vec4(shadeData(sphereNormal, sphereDepth, vTint), 1.0);
    if (uCheap > 0.5) oColor.a = saturate((spherePosition.y - uFloorHeight) / (0.35 * uSceneRadius)) * 0.9 + 0.1;
}
