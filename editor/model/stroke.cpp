// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "model/stroke.h"

#include <algorithm>
#include <cmath>

namespace thaw::editor {

namespace {
thawVec3 mix(thawVec3 a, thawVec3 b, float u) {
    return {a.x + u * (b.x - a.x), a.y + u * (b.y - a.y), a.z + u * (b.z - a.z)};
}
float distance(thawVec3 a, thawVec3 b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }
} // namespace

float lengthOf(const std::vector<thawVec3>& line, bool closed) {
    double sum = 0;
    for (size_t i = 1; i < line.size(); ++i) sum += double(distance(line[i - 1], line[i]));
    if (closed && line.size() > 1) sum += double(distance(line.back(), line.front()));
    return float(sum);
}

std::vector<thawVec3> resampled(const std::vector<thawVec3>& line, float step, bool closed) {
    const float length = lengthOf(line, closed);
    if (line.size() < 2 || !(length > 0) || !(step > 0)) return line;
    const size_t least = closed ? 3 : 1;
    const size_t pieces = std::clamp(size_t(std::lround(length / step)), least, size_t(100000));
    std::vector<thawVec3> out{line.front()};
    const size_t corners = line.size() + (closed ? 1 : 0);
    const auto corner = [&](size_t i) { return line[i % line.size()]; };
    double walked = 0; // up to the corner before
    size_t at = 1;
    for (size_t k = 1; k < pieces; ++k) {
        const double want = double(length) * double(k) / double(pieces);
        while (at + 1 < corners && walked + double(distance(corner(at - 1), corner(at))) < want)
            walked += double(distance(corner(at - 1), corner(at))), ++at;
        const float piece = distance(corner(at - 1), corner(at));
        const float u = piece > 0 ? std::clamp(float((want - walked) / double(piece)), 0.0f, 1.0f) : 0;
        out.push_back(mix(corner(at - 1), corner(at), u));
    }
    if (!closed) out.push_back(line.back());
    return out;
}

std::vector<thawVec3> smoothed(std::vector<thawVec3> line, int passes, bool closed) {
    if (line.size() < 3) return line;
    std::vector<thawVec3> before;
    const auto go = [&](float share) {
        before = line;
        const size_t n = line.size();
        for (size_t i = 0; i < n; ++i) {
            if (!closed && (i == 0 || i + 1 == n)) continue;
            line[i] = mix(before[i], mix(before[(i + n - 1) % n], before[(i + 1) % n], 0.5f), share);
        }
    };
    for (int i = 0; i < std::clamp(passes, 0, 100); ++i) go(0.5f), go(-0.53f);
    return line;
}

Nearest nearestOn(const std::vector<thawVec3>& line, thawVec3 to, bool closed) {
    Nearest best;
    best.point = line.front(), best.distance = distance(line.front(), to);
    const size_t segments = closed ? line.size() : line.size() - 1;
    for (size_t i = 0; i < segments; ++i) {
        const thawVec3 a = line[i], b = line[(i + 1) % line.size()];
        const thawVec3 d{b.x - a.x, b.y - a.y, b.z - a.z};
        const float square = d.x * d.x + d.y * d.y + d.z * d.z;
        const float u =
            square > 0 ? std::clamp(((to.x - a.x) * d.x + (to.y - a.y) * d.y + (to.z - a.z) * d.z) / square, 0.0f, 1.0f)
                       : 0;
        const thawVec3 p = mix(a, b, u);
        if (const float far = distance(p, to); far < best.distance) best = {i, u, far, p};
    }
    return best;
}

std::vector<std::vector<thawVec3>> cutOut(const std::vector<thawVec3>& line, thawVec3 center, float radius) {
    std::vector<std::vector<thawVec3>> out(1);
    const auto inside = [&](thawVec3 p) { return distance(p, center) < radius; };
    // Where a segment enters or leaves the ball: the ends of what is left lie on its surface.
    for (size_t i = 0; i < line.size(); ++i) {
        if (i > 0) {
            const thawVec3 a = line[i - 1], b = line[i];
            const thawVec3 d{b.x - a.x, b.y - a.y, b.z - a.z}, m{a.x - center.x, a.y - center.y, a.z - center.z};
            const double A = double(d.x) * double(d.x) + double(d.y) * double(d.y) + double(d.z) * double(d.z),
                         B = double(d.x) * double(m.x) + double(d.y) * double(m.y) + double(d.z) * double(m.z),
                         C = double(m.x) * double(m.x) + double(m.y) * double(m.y) + double(m.z) * double(m.z) -
                             double(radius) * double(radius);
            const double D = B * B - A * C;
            if (A > 0 && D > 0) {
                const double in = (-B - std::sqrt(D)) / A, leave = (-B + std::sqrt(D)) / A;
                if (in > 0 && in < 1) out.back().push_back(mix(a, b, float(in))), out.emplace_back();
                if (leave > 0 && leave < 1) {
                    if (!out.back().empty()) out.emplace_back();
                    out.back().push_back(mix(a, b, float(leave)));
                }
            }
        }
        if (!inside(line[i])) out.back().push_back(line[i]);
    }
    out.erase(std::remove_if(out.begin(), out.end(), [](const auto& l) { return l.size() < 2; }), out.end());
    return out;
}

} // namespace thaw::editor
