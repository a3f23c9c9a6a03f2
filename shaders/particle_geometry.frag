// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

out vec4 oGeometry;

void main() {
    raiseSphere();
    oGeometry = vec4(octEncode(sphereNormal), sphereDepth, 0.0);
}
