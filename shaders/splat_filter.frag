// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// One direction of a narrow-range filter: N. Truong, C. Yuksel, "A narrow-range filter for screen-space fluid rendering",
// 2018. Beads become one surface, edges between what is near and what is far stay. 0 where nothing is.

in vec2 vUv;
uniform sampler2D uSource;
uniform vec2 uPictureSize;
uniform ivec2 uStep;
uniform int uFirst;      // 1: the source is what splat_depth.frag wrote
uniform float uSpacing;  // m, of the particles
uniform float uFilterReach; // in spacings, to each side
out vec4 oColor;

float depthAt(ivec2 at) {
    vec4 s = texelFetch(uSource, at, 0);
    return uFirst == 0 ? s.r : s.r > -1e8 ? -s.r : 0.0;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(uSource, 0) - 1;
    float z = depthAt(at);
    if (z <= 0.0) discard;
    const int kTaps = 10;
    float reach = uFilterReach * uSpacing * uPictureSize.y / (2.0 * length(uCameraUp) * z);
    int stride = max(1, int(ceil(reach / float(kTaps)))), taps = clamp(int(reach / float(stride) + 0.5), 1, kTaps);
    float narrow = 1.2 * uSpacing, low = narrow, high = narrow, sum = z, weights = 1.0, sigma = 0.5 * reach;
    for (int i = 1; i <= taps; ++i) {
        ivec2 step = i * stride * uStep, p = at - step, q = at + step;
        float a = any(lessThan(p, ivec2(0))) ? 0.0 : depthAt(p), b = any(greaterThan(q, last)) ? 0.0 : depthAt(q);
        // What is much nearer is another thing, and takes its mirror image with it; what is much farther pulls no more than
        // the range allows.
        if ((a > 0.0 && a < z - low) || (b > 0.0 && b < z - low)) continue;
        // Nothing pulls a little: it rounds clusters of beads. As much as the range would sink drops into what they run on.
        if (a <= 0.0) a = z + 0.3 * uSpacing;
        if (b <= 0.0) b = z + 0.3 * uSpacing;
        float far = z + high, w = exp(-float(i * i * stride * stride) / (2.0 * sigma * sigma));
        if (a <= far && b <= far) {
            // A slope widens the range as it goes on.
            low = max(low, z - min(a, b) + narrow);
            high = max(high, max(a, b) - z + narrow);
        }
        sum += w * ((a > far ? z + narrow : a) + (b > far ? z + narrow : b));
        weights += 2.0 * w;
    }
    oColor = vec4(sum / weights);
}
