// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "view/color_map.h"

#include <algorithm>
#include <cmath>

namespace thaw::view {

namespace {

// OKLab to linear RGB (B. Ottosson, "A perceptual color space for image processing", 2020).
thawVec3 fromOklab(float lightness, float a, float b) {
    const float l = lightness + 0.3963377774f * a + 0.2158037573f * b;
    const float m = lightness - 0.1055613458f * a - 0.0638541728f * b;
    const float s = lightness - 0.0894841775f * a - 1.2914855480f * b;
    const float l3 = l * l * l, m3 = m * m * m, s3 = s * s * s;
    const auto clip = [](float v) { return std::clamp(v, 0.0f, 1.0f); };
    return {clip(4.0767416621f * l3 - 3.3077115913f * m3 + 0.2309699292f * s3),
            clip(-1.2684380046f * l3 + 2.6097574011f * m3 - 0.3413193965f * s3),
            clip(-0.0041960863f * l3 - 0.7034186147f * m3 + 1.7076147010f * s3)};
}

} // namespace

thawVec3 heatColor(float t) {
    // Hue from blue over magenta to orange at lightness 0.34..0.78; chroma stays inside sRGB at each stop.
    struct Stop {
        float chroma, hue; // hue in degrees
    };
    constexpr std::array<Stop, 5> kStops{{{0.17f, 264}, {0.19f, 300}, {0.20f, 355}, {0.20f, 390}, {0.165f, 427}}};
    t = std::clamp(std::isfinite(t) ? t : 0.0f, 0.0f, 1.0f);
    const float x = t * (kStops.size() - 1);
    const size_t i = std::min(static_cast<size_t>(x), kStops.size() - 2);
    const float f = x - static_cast<float>(i);
    const float chroma = kStops[i].chroma + f * (kStops[i + 1].chroma - kStops[i].chroma);
    const float hue = (kStops[i].hue + f * (kStops[i + 1].hue - kStops[i].hue)) * 0.01745329f;
    return fromOklab(0.34f + 0.44f * t, chroma * std::cos(hue), chroma * std::sin(hue));
}

Phase phaseOf(float liquidFraction) {
    return liquidFraction < kSolidBelow ? Phase::solid : liquidFraction > kLiquidAbove ? Phase::liquid : Phase::mushy;
}

thawVec3 phaseColor(Phase phase) {
    switch (phase) {
    case Phase::solid:
        return {0.10f, 0.21f, 0.40f};
    case Phase::mushy:
        return {0.80f, 0.56f, 0.14f};
    default:
        return {0.62f, 0.075f, 0.09f};
    }
}

unsigned char encodeSrgb(float linear) {
    linear = std::clamp(linear, 0.0f, 1.0f);
    const float s = linear <= 0.0031308f ? linear * 12.92f : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
    return static_cast<unsigned char>(s * 255 + 0.5f);
}

} // namespace thaw::view
