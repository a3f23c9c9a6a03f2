// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "model/lines.h"

namespace thaw::editor {

std::vector<thawVec3> worldPoints(const scene::Scene& s, const std::vector<thawVec3>& points, int collider) {
    std::vector<thawVec3> out;
    out.reserve(points.size());
    for (const thawVec3& p : points) out.push_back(toWorld(s, collider, p));
    return out;
}

std::vector<Line> linesOf(const scene::Scene& s, Item item) {
    std::vector<Line> out;
    if (item.kind == Kind::path) {
        const scene::Path& path = s.paths[size_t(item.index)];
        out.push_back({worldPoints(s, path.points, path.collider), false});
    } else if (item.kind == Kind::shape) {
        const scene::FillShape& shape = s.shapes[size_t(item.index)];
        for (const auto& contour : shape.contours) out.push_back({worldPoints(s, contour, shape.collider), true});
    }
    return out;
}

std::vector<thawVec3>* pointsOf(scene::Scene& s, Item item, int contour) {
    if (item.kind == Kind::path) return &s.paths[size_t(item.index)].points;
    if (item.kind != Kind::shape) return nullptr;
    auto& contours = s.shapes[size_t(item.index)].contours;
    return size_t(contour) < contours.size() ? &contours[size_t(contour)] : nullptr;
}

int colliderOf(const scene::Scene& s, Item item) {
    return item.kind == Kind::path ? s.paths[size_t(item.index)].collider : s.shapes[size_t(item.index)].collider;
}

} // namespace thaw::editor
