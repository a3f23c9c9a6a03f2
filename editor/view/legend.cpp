// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "view/legend.h"

#include "view/color_map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace thaw::view {

namespace {

constexpr Rgba kPanel{18, 18, 22, 205}, kInk{236, 234, 228, 255}, kTick{236, 234, 228, 190};

Rgba toRgba(thawVec3 c) { return {encodeSrgb(c.x), encodeSrgb(c.y), encodeSrgb(c.z), 255}; }

std::string number(double value, double step) {
    const int digits = step >= 1 ? 0 : step >= 0.1 ? 1 : step >= 0.01 ? 2 : 3;
    const long long whole = std::llround(value * std::pow(10.0, digits));
    // By hand: printf would take the decimal sign of the host's locale.
    std::string text = std::to_string(whole < 0 ? -whole : whole);
    if (digits) {
        while (static_cast<int>(text.size()) <= digits) text.insert(text.begin(), '0');
        text.insert(text.size() - static_cast<size_t>(digits), 1, '.');
    }
    return whole < 0 ? "-" + text : text;
}

// A step of 1, 2 or 5 times a power of ten that parts the range into about four.
double niceStep(double range) {
    const double raw = std::max(range, 1e-9) / 4, power = std::pow(10.0, std::floor(std::log10(raw)));
    const double f = raw / power;
    return power * (f < 1.5 ? 1 : f < 3.5 ? 2 : f < 7.5 ? 5 : 10);
}

struct Column {
    std::string unit;
    double low, high;
};

// Titles on top, then the bar with one or two columns of numbers.
Image bar(const std::string& title, const std::vector<Column>& columns, int s, bool reversed = false) {
    const int barWidth = 12 * s, barHeight = 104 * s, pad = 6 * s, line = textHeight(s) + 2 * s;
    std::vector<int> widths;
    for (const Column& c : columns) {
        const double step = niceStep(c.high - c.low);
        int w = textWidth(c.unit, s);
        for (double v = std::ceil(c.low / step - 1e-6) * step; v <= c.high + step * 1e-6; v += step)
            w = std::max(w, textWidth(number(v, step), s));
        widths.push_back(w);
    }
    const int left = widths.size() > 1 ? widths[0] + 7 * s : 0;
    const int inner = left + barWidth + 7 * s + widths.back();
    const int width = std::max(inner, textWidth(title, s)) + 2 * pad;
    Image panel(width, pad + line + line + barHeight + pad + 5 * s, kPanel);
    drawText(panel, pad, pad, title, s, kInk);
    const int barX = pad + left, top = pad + 2 * line + 3 * s;
    for (int j = 0; j < barHeight; ++j) {
        const float down = (static_cast<float>(j) + 0.5f) / static_cast<float>(barHeight);
        fillRectangle(panel, barX, top + j, barWidth, 1, toRgba(heatColor(reversed ? down : 1 - down)));
    }
    for (size_t k = 0; k < columns.size(); ++k) {
        const Column& c = columns[k];
        const bool onLeft = k == 0 && columns.size() > 1;
        const auto place = [&](const std::string& text) {
            return onLeft ? barX - 7 * s - textWidth(text, s) : barX + barWidth + 7 * s;
        };
        drawText(panel, place(c.unit), pad + line, c.unit, s, kInk);
        const double step = niceStep(c.high - c.low);
        for (double v = std::ceil(c.low / step - 1e-6) * step; v <= c.high + step * 1e-6; v += step) {
            const double t = c.high > c.low ? (v - c.low) / (c.high - c.low) : 0;
            const int y = top + static_cast<int>(std::lround((1 - t) * (barHeight - 1)));
            fillRectangle(panel, onLeft ? barX - 4 * s : barX + barWidth + s, y, 3 * s, s, kTick);
            drawText(panel, place(number(v, step)), y - 3 * s, number(v, step), s, kInk);
        }
    }
    return panel;
}

struct KeyRow {
    std::string text;
    thawVec3 color;
};

Image key(const std::string& title, const std::vector<KeyRow>& rows, int s) {
    const int pad = 6 * s, line = textHeight(s) + 5 * s, swatch = 9 * s;
    int width = textWidth(title, s);
    for (const KeyRow& row : rows) width = std::max(width, swatch + 4 * s + textWidth(row.text, s));
    Image panel(2 * pad + width, pad + line * (static_cast<int>(rows.size()) + 1) + pad - 5 * s, kPanel);
    drawText(panel, pad, pad, title, s, kInk);
    int y = pad;
    for (const KeyRow& row : rows) {
        y += line;
        fillRectangle(panel, pad, y - s, swatch, swatch, toRgba(row.color));
        drawText(panel, pad + swatch + 4 * s, y, row.text, s, kInk);
    }
    return panel;
}

} // namespace

Image temperatureLegend(float lowKelvin, float highKelvin, int scale) {
    constexpr double kZeroCelsius = 273.15;
    return bar("temperature",
               {{"\xC2\xB0"
                 "C",
                 lowKelvin - kZeroCelsius, highKelvin - kZeroCelsius},
                {"K", lowKelvin, highKelvin}},
               std::max(scale, 1));
}

Image rangeLegend(const std::string& title, const std::string& unit, float low, float high, int scale, bool reversed) {
    return bar(title, {{unit, low, high}}, std::max(scale, 1), reversed);
}

Image levelLegend(const std::array<int, kLevelColors>& counts, int s) {
    s = std::max(s, 1);
    const int pad = 6 * s, line = textHeight(s) + 5 * s, swatch = 9 * s;
    int number = textWidth("particles", s), all = 0;
    for (const int n : counts) number = std::max(number, textWidth(std::to_string(n), s)), all += n;
    const int left = pad + std::max(swatch + 4 * s + textWidth("3", s), textWidth("level", s)) + 8 * s;
    Image panel(left + number + pad, pad + line * (kLevelColors + 2) + pad - 5 * s, kPanel);
    const auto right = [&](const std::string& text, int y) {
        drawText(panel, left + number - textWidth(text, s), y, text, s, kInk);
    };
    drawText(panel, pad, pad, "level", s, kInk);
    right("particles", pad);
    for (int level = 0; level < kLevelColors; ++level) {
        const int y = pad + line * (level + 1);
        fillRectangle(panel, pad, y - s, swatch, swatch, toRgba(heatColor(levelTint(level))));
        drawText(panel, pad + swatch + 4 * s, y, std::to_string(level), s, kInk);
        right(std::to_string(counts[static_cast<size_t>(level)]), y);
    }
    right(std::to_string(all), pad + line * (kLevelColors + 1));
    return panel;
}

Image phaseLegend(int s) {
    return key("phase",
               {{"liquid", phaseColor(Phase::liquid)},
                {"mushy", phaseColor(Phase::mushy)},
                {"solid", phaseColor(Phase::solid)}},
               std::max(s, 1));
}

Image regionLegend(const std::vector<Region>& regions, int s) {
    std::vector<KeyRow> rows;
    for (int k = 0; k < kRegionKinds; ++k) {
        const auto kind = static_cast<RegionKind>(k);
        if (std::any_of(regions.begin(), regions.end(), [&](const Region& r) { return r.kind == kind; }))
            rows.push_back({regionName(kind), regionColor(kind)});
    }
    return key("control", rows, std::max(s, 1));
}

} // namespace thaw::view
