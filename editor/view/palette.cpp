// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "view/palette.h"

#include <algorithm>
#include <array>

namespace thaw::view {

namespace {
// How much of a difference the eye sees, by channel.
constexpr double kWeight[3] = {2, 4, 1};
// Of the pattern, in steps of a channel: about what lies between neighbours of a palette of 255 for one scene.
constexpr int kAmplitude = 10;
} // namespace

ColorCount::ColorCount() : bins_(size_t(1) << (3 * kBits)) {}

void ColorCount::add(const Image& image) {
    constexpr int kShift = 8 - kBits;
    for (const Rgba& c : image.pixels) {
        Bin& bin = bins_[(size_t(c.r >> kShift) << (2 * kBits)) | (size_t(c.g >> kShift) << kBits) | (c.b >> kShift)];
        ++bin.count, bin.sum[0] += c.r, bin.sum[1] += c.g, bin.sum[2] += c.b;
    }
}

std::vector<Rgba> ColorCount::palette(size_t most) const {
    struct Color {
        double count;
        std::array<double, 3> value;
    };
    std::vector<Color> colors;
    for (const Bin& b : bins_)
        if (b.count > 0)
            colors.push_back({double(b.count),
                              {double(b.sum[0]) / double(b.count), double(b.sum[1]) / double(b.count),
                               double(b.sum[2]) / double(b.count)}});
    // A run of colours, its mean, and the channel that differs most, weighed.
    struct Box {
        size_t begin, end, channel = 0;
        std::array<double, 3> mean{};
        double spread = 0;
        Box(const std::vector<Color>& all, size_t from, size_t to) : begin(from), end(to) {
            double n = 0, square[3] = {};
            for (size_t i = from; i < to; ++i) {
                n += all[i].count;
                for (size_t a = 0; a < 3; ++a)
                    mean[a] += all[i].count * all[i].value[a],
                        square[a] += all[i].count * all[i].value[a] * all[i].value[a];
            }
            for (size_t a = 0; a < 3; ++a) {
                mean[a] /= n;
                const double s = kWeight[a] * (square[a] - n * mean[a] * mean[a]);
                if (s > spread) spread = s, channel = a;
            }
            if (to - from < 2) spread = 0;
        }
    };
    std::vector<Box> boxes;
    if (!colors.empty()) boxes.emplace_back(colors, 0, colors.size());
    while (!boxes.empty() && boxes.size() < most) {
        const auto worst = std::max_element(boxes.begin(), boxes.end(),
                                            [](const Box& a, const Box& b) { return a.spread < b.spread; });
        if (!(worst->spread > 0)) break;
        const Box box = *worst;
        const auto middle =
            std::partition(colors.begin() + ptrdiff_t(box.begin), colors.begin() + ptrdiff_t(box.end),
                           [&](const Color& c) { return c.value[box.channel] < box.mean[box.channel]; });
        const size_t at = size_t(middle - colors.begin());
        if (at == box.begin || at == box.end) { // all alike but for rounding
            worst->spread = 0;
            continue;
        }
        *worst = Box(colors, box.begin, at);
        boxes.emplace_back(colors, at, box.end);
    }
    std::vector<Rgba> out;
    for (const Box& box : boxes)
        out.push_back({uint8_t(box.mean[0] + 0.5), uint8_t(box.mean[1] + 0.5), uint8_t(box.mean[2] + 0.5), 255});
    return out;
}

Dither::Dither(std::vector<Rgba> palette) : palette_(std::move(palette)), known_(size_t(1) << 18, int16_t(-1)) {}

uint8_t Dither::nearest(int r, int g, int b) {
    int16_t& known = known_[(size_t(r >> 2) << 12) | (size_t(g >> 2) << 6) | size_t(b >> 2)];
    if (known >= 0) return uint8_t(known);
    double best = 1e30;
    for (size_t i = 0; i < palette_.size(); ++i) {
        const double d[3] = {(r | 3) - 1.5 - palette_[i].r, (g | 3) - 1.5 - palette_[i].g,
                             (b | 3) - 1.5 - palette_[i].b};
        const double far = kWeight[0] * d[0] * d[0] + kWeight[1] * d[1] * d[1] + kWeight[2] * d[2] * d[2];
        if (far < best) best = far, known = int16_t(i);
    }
    return uint8_t(known);
}

std::vector<uint8_t> Dither::indices(const Image& image) {
    // Bayer's order of 8 x 8, 0..63.
    static const std::array<int, 64> kOrder = [] {
        std::array<int, 64> order{};
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x)
                for (int bit = 0; bit < 3; ++bit)
                    order[size_t(8 * y + x)] |=
                        (((x ^ y) >> bit & 1) << (5 - 2 * bit)) | ((y >> bit & 1) << (4 - 2 * bit));
        return order;
    }();
    std::vector<uint8_t> out(image.pixels.size());
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const int shift = kOrder[size_t(8 * (y & 7) + (x & 7))] * kAmplitude / 64 - kAmplitude / 2;
            const Rgba& c = image.at(x, y);
            const auto moved = [&](int v) { return std::clamp(v + shift, 0, 255); };
            out[size_t(y) * size_t(image.width) + size_t(x)] = nearest(moved(c.r), moved(c.g), moved(c.b));
        }
    return out;
}

} // namespace thaw::view
