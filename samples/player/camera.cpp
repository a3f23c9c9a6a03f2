// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "scene.h"

#include <algorithm>

namespace thaw::scene {

namespace {
constexpr size_t kNumbers = 7;

double numberOf(const CameraKey& key, size_t i) {
    const float all[kNumbers] = {
        key.eye.x, key.eye.y, key.eye.z, key.target.x, key.target.y, key.target.z, key.fieldOfViewDegrees};
    return double(all[i]);
}

// Slope of a number at a key: the weighted harmonic mean of those of the chords beside it, 0 where they differ in sign
// and at both ends, where the camera sets off and stops.
double slopeAt(const std::vector<CameraKey>& keys, size_t k, size_t i) {
    if (k == 0 || k + 1 == keys.size()) return 0;
    const double before = double(keys[k].time) - double(keys[k - 1].time),
                 after = double(keys[k + 1].time) - double(keys[k].time);
    const double m0 = (numberOf(keys[k], i) - numberOf(keys[k - 1], i)) / before,
                 m1 = (numberOf(keys[k + 1], i) - numberOf(keys[k], i)) / after;
    if (m0 * m1 <= 0) return 0;
    const double w0 = 2 * after + before, w1 = after + 2 * before;
    return (w0 + w1) / (w0 / m0 + w1 / m1);
}
} // namespace

Camera cameraAt(const Camera& camera, double time) {
    const std::vector<CameraKey>& keys = camera.keys;
    Camera out = camera;
    out.keys.clear();
    if (keys.empty()) return out;
    const auto next = std::upper_bound(keys.begin(), keys.end(), time,
                                       [](double t, const CameraKey& key) { return t < double(key.time); });
    double value[kNumbers];
    if (next == keys.begin() || next == keys.end()) {
        const CameraKey& held = next == keys.begin() ? keys.front() : keys.back();
        for (size_t i = 0; i < kNumbers; ++i) value[i] = numberOf(held, i);
    } else {
        const size_t k = size_t(next - keys.begin()) - 1;
        const double span = double(keys[k + 1].time) - double(keys[k].time), u = (time - double(keys[k].time)) / span;
        for (size_t i = 0; i < kNumbers; ++i) {
            const double a = numberOf(keys[k], i), b = numberOf(keys[k + 1], i);
            value[i] = a + (b - a) * u * u * (3 - 2 * u) +
                       span * u * (1 - u) * ((1 - u) * slopeAt(keys, k, i) - u * slopeAt(keys, k + 1, i));
        }
    }
    out.eye = {float(value[0]), float(value[1]), float(value[2])};
    out.target = {float(value[3]), float(value[4]), float(value[5])};
    out.fieldOfViewDegrees = float(value[6]);
    return out;
}

} // namespace thaw::scene
