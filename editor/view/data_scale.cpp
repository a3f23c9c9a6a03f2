// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "view/data_scale.h"

#include "view/legend.h"

#include <algorithm>
#include <cmath>

namespace thaw::view {

namespace {

void temperatureEnds(const Scene& scene, const View& view, DataScale& scale) {
    float &low = scale.temperatureLow, &high = scale.temperatureHigh;
    low = view.temperatureLow, high = view.temperatureHigh;
    if (low < high) return;
    low = INFINITY, high = -INFINITY;
    const auto take = [&](const float* kelvin, int32_t count) {
        for (int32_t i = 0; kelvin && i < count; ++i)
            low = std::fmin(low, kelvin[i]), high = std::fmax(high, kelvin[i]);
    };
    take(scene.surface.temperatures, scene.surface.vertexCount);
    if (scene.particles) take(scene.particles->temperatures, scene.particles->count);
    if (!(low <= high)) low = 273.15f, high = 373.15f;
    if (high - low < 1) low -= 0.5f, high += 0.5f;
}

// The next 1, 2 or 5 times a power of ten, so that the scale of one frame is mostly that of the next.
float roundUp(float value) {
    const float power = std::pow(10.0f, std::floor(std::log10(std::max(value, 1e-6f))));
    for (const float f : {1.0f, 2.0f, 5.0f})
        if (value <= f * power * 1.0001f) return f * power;
    return 10 * power;
}

} // namespace

DataScale dataScale(const Scene& scene, const View& view, std::vector<float>& values) {
    DataScale scale;
    temperatureEnds(scene, view, scale);
    values.clear();
    if (!scene.particles || scene.particles->count <= 0) return scale;
    const thawParticleView& p = *scene.particles;
    const auto count = static_cast<size_t>(p.count);
    values.assign(count, 0);
    bool reversed = false;
    switch (scene.particleColor) {
    case ParticleColor::temperature:
        if (p.temperatures) values.assign(p.temperatures, p.temperatures + count);
        scale.low = scale.temperatureLow, scale.high = scale.temperatureHigh;
        break;
    case ParticleColor::liquidFraction:
        if (p.liquidFractions) values.assign(p.liquidFractions, p.liquidFractions + count);
        break;
    case ParticleColor::speed:
        for (size_t i = 0; p.velocities && i < count; ++i) {
            const float* v = p.velocities + i * 4;
            values[i] = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        }
        scale.high = view.speedHigh > 0 ? view.speedHigh
                                        : roundUp(std::max(*std::max_element(values.begin(), values.end()), 1e-3f));
        break;
    case ParticleColor::level:
        for (size_t i = 0; p.levels && i < count; ++i)
            values[i] = levelTint(p.levels[i]), ++scale.levelCounts[std::min<size_t>(p.levels[i], kLevelColors - 1)];
        if (scene.levelCounts != std::array<int, kLevelColors>{}) scale.levelCounts = scene.levelCounts;
        break;
    case ParticleColor::values: {
        const ParticleValues& own = scene.particleValues;
        if (own.values) values.assign(own.values, own.values + count);
        scale.low = own.low, scale.high = own.high;
        if (!(scale.low < scale.high))
            scale.high = std::max(*std::max_element(values.begin(), values.end()), scale.low + 1e-6f);
        reversed = own.reversed;
        break;
    }
    }
    for (float& v : values) {
        v = (v - scale.low) / (scale.high - scale.low);
        v = std::isfinite(v) ? std::clamp(v, 0.0f, 1.0f) : 0.0f;
        if (reversed) v = 1 - v;
    }
    return scale;
}

Image legendOf(const Scene& scene, const View& view, const DataScale& scale, int size) {
    switch (view.mode) {
    case ViewMode::temperature:
        return temperatureLegend(scale.temperatureLow, scale.temperatureHigh, size);
    case ViewMode::phase:
        return phaseLegend(size);
    case ViewMode::liquid:
        return rangeLegend("liquid", "fraction", 0, 1, size);
    case ViewMode::shaded:
        break;
    }
    if (!scene.particles || scene.particles->count <= 0)
        return scene.regions.empty() ? Image{} : regionLegend(scene.regions, size);
    switch (scene.particleColor) {
    case ParticleColor::temperature:
        return temperatureLegend(scale.low, scale.high, size);
    case ParticleColor::liquidFraction:
        return rangeLegend("liquid", "fraction", 0, 1, size);
    case ParticleColor::speed:
        return rangeLegend("speed", "m/s", 0, scale.high, size);
    case ParticleColor::level:
        return levelLegend(scale.levelCounts, size);
    case ParticleColor::values:
        break;
    }
    const ParticleValues& own = scene.particleValues;
    return rangeLegend(own.title, own.unit, scale.low, scale.high, size, own.reversed);
}

} // namespace thaw::view
