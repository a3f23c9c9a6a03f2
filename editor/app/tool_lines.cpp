// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/toolkit.h"

#include "model/lines.h"
#include "model/stroke.h"
#include "view/math.h"

#include <algorithm>
#include <cmath>

namespace thaw::editor {

using namespace thaw::view;

bool ToolKit::removeNode(Studio& studio) {
    const Item item = studio.selection();
    if ((item.kind != Kind::path && item.kind != Kind::shape) || studio.node < 0) return false;
    const int node = studio.node, contour = studio.contour;
    bool gone = false;
    studio.edit("Delete node", [&](scene::Scene& s) {
        std::vector<thawVec3>* points = pointsOf(s, item, contour);
        if (!points || size_t(node) >= points->size()) return;
        points->erase(points->begin() + node);
        if (item.kind == Kind::path && points->size() < 2) erase(s, item), gone = true;
        if (item.kind == Kind::shape && points->size() < 3) {
            auto& contours = s.shapes[size_t(item.index)].contours;
            contours.erase(contours.begin() + contour);
            if (contours.empty()) erase(s, item), gone = true;
        }
    });
    if (gone) studio.select({});
    studio.node = -1;
    return true;
}

bool ToolKit::dragNode(Studio& studio, const Lens& lens, const Pointer& pointer) {
    if (pointer.pressed) {
        const std::optional<Touch> touch = touched(studio, lens, pointer.at);
        if (touch && touch->node >= 0) {
            dragging_ = true, grabbed_ = *touch, ++strokes_;
            studio.node = touch->node, studio.contour = touch->contour;
            return true;
        }
        return false;
    }
    if (!dragging_) return false;
    if (!pointer.held) {
        dragging_ = false;
        studio.endGesture();
        return true;
    }
    const Item item = grabbed_.item;
    if (!exists(studio.scene(), item)) return dragging_ = false;
    const std::vector<Line> lines = linesOf(studio.scene(), item);
    if (size_t(grabbed_.contour) >= lines.size() ||
        size_t(grabbed_.node) >= lines[size_t(grabbed_.contour)].points.size())
        return dragging_ = false;
    const thawVec3 was = lines[size_t(grabbed_.contour)].points[size_t(grabbed_.node)];
    thawVec3 to = was;
    if (const std::optional<Hit> hit = under(studio, lens, pointer.at)) {
        to = hit->point;
    } else { // in the air: at the depth that it had
        const Ray ray = lens.ray(pointer.at);
        const Vec3 forward = normalize(lens.camera().target - lens.camera().eye);
        to =
            ray.origin + ray.direction * (dot(was - ray.origin, forward) / std::max(dot(ray.direction, forward), 0.1f));
    }
    studio.edit(
        "Move node",
        [&](scene::Scene& s) {
            (*pointsOf(s, item, grabbed_.contour))[size_t(grabbed_.node)] = fromWorld(s, colliderOf(s, item), to);
        },
        "node " + std::to_string(strokes_));
    return true;
}

void ToolKit::insertNode(Studio& studio, const Lens& lens, const Pointer& pointer) {
    const Item item = studio.selection();
    const std::optional<Hit> hit = under(studio, lens, pointer.at);
    const std::vector<Line> lines = linesOf(studio.scene(), item);
    if (lines.empty() || !hit) return;
    size_t c = 0;
    Nearest best;
    best.distance = INFINITY;
    for (size_t i = 0; i < lines.size(); ++i)
        if (const Nearest n = nearestOn(lines[i].points, hit->point, lines[i].closed); n.distance < best.distance)
            best = n, c = i;
    if (best.distance > 3 * kReach * lens.pixelSize(hit->point)) return;
    studio.edit("Insert node", [&](scene::Scene& s) {
        std::vector<thawVec3>& points = *pointsOf(s, item, int(c));
        points.insert(points.begin() + int(best.segment) + 1, fromWorld(s, colliderOf(s, item), best.point));
    });
    studio.node = int(best.segment) + 1, studio.contour = int(c);
}

void ToolKit::drawLine(Studio& studio, const Lens& lens, const Pointer& pointer, bool closed) {
    if (line_.empty()) {
        if (dragNode(studio, lens, pointer)) return;
        if (pointer.clickedTwice && studio.selection().kind == (closed ? Kind::shape : Kind::path))
            return insertNode(studio, lens, pointer);
    }
    if (pointer.pressed)
        if (const std::optional<Hit> hit = under(studio, lens, pointer.at))
            line_ = {hit->point}, lineColliders_ = {hit->item.kind == Kind::collider ? hit->item.index : -1};
    if (line_.empty()) return;
    // All the way that it went, however long the last picture took.
    for (size_t i = 0; i < pointer.trail.size() && pointer.held && !pointer.pressed; ++i) {
        const std::optional<Hit> hit = under(studio, lens, pointer.trail[i]);
        if (!hit) continue;
        const float step = std::max(0.7f * studio.scene().world.particleSpacing, 2 * lens.pixelSize(hit->point));
        if (length(hit->point - line_.back()) > step) {
            line_.push_back(hit->point);
            lineColliders_.push_back(hit->item.kind == Kind::collider ? hit->item.index : -1);
        }
    }
    if (!pointer.held) finishLine(studio, lens, closed);
}

void ToolKit::finishLine(Studio& studio, const Lens& lens, bool closed) {
    std::vector<thawVec3> line;
    std::vector<int> colliders;
    line.swap(line_), colliders.swap(lineColliders_);
    const float spacing = studio.scene().world.particleSpacing;
    const float length = lengthOf(line, closed);
    if (line.size() < (closed ? 3u : 2u) || length < 3 * spacing) {
        // A click: what is there is chosen instead.
        if (!line.empty())
            if (const auto at = lens.project(line.front()))
                if (const std::optional<Touch> touch = touched(studio, lens, *at)) return studio.select(touch->item);
        return studio.tell(closed ? "drag around an area to draw a shape" : "drag along a surface to draw a path");
    }
    const scene::Scene& now = studio.scene();
    const bool one = std::all_of(colliders.begin(), colliders.end(), [&](int c) { return c == colliders.front(); });
    const int collider =
        one && colliders.front() >= 0 && now.colliders[size_t(colliders.front())].shape.type != scene::ShapeType::plane
            ? colliders.front()
            : -1;
    // A hand trembles by a pixel or two; nodes that an artist can take hold of are some spacings apart.
    const std::vector<thawVec3> even = resampled(line, std::max(spacing, length / 400), closed);
    const std::vector<thawVec3> smooth = smoothed(even, int(studio.tools.pathSmoothing), closed);
    const std::vector<thawVec3> nodes = resampled(smooth, std::max(4 * spacing, length / 100), closed);
    Item made;
    if (!closed) {
        if (studio.edit("Draw path", [&](scene::Scene& s) { made = addPath(s, nodes, collider); })) studio.select(made);
        return;
    }
    const Item chosen = studio.selection();
    const auto inside = [&](const Line& outer) {
        const auto p = lens.project(nodes.front());
        bool in = false;
        for (size_t i = 0, n = outer.points.size(); p && i < n; ++i) {
            const auto a = lens.project(outer.points[i]), b = lens.project(outer.points[(i + 1) % n]);
            if (a && b && (a->y > p->y) != (b->y > p->y) && p->x < (b->x - a->x) * (p->y - a->y) / (b->y - a->y) + a->x)
                in = !in;
        }
        return in;
    };
    bool joins = false;
    if (chosen.kind == Kind::shape)
        for (const Line& outer : linesOf(now, chosen)) joins = joins || inside(outer);
    joins = joins || (chosen.kind == Kind::shape && ImGui::GetIO().KeyShift);
    if (joins) {
        studio.edit("Draw contour", [&](scene::Scene& s) {
            std::vector<thawVec3>& points = s.shapes[size_t(chosen.index)].contours.emplace_back();
            for (const thawVec3& x : nodes) points.push_back(fromWorld(s, s.shapes[size_t(chosen.index)].collider, x));
        });
    } else if (studio.edit("Draw shape", [&](scene::Scene& s) { made = addShape(s, nodes, collider); })) {
        studio.select(made);
    }
}

} // namespace thaw::editor
