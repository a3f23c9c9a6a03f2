// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/toolkit.h"

#include "model/stroke.h"
#include "view/math.h"

#include <algorithm>
#include <cmath>

namespace thaw::editor {

using namespace thaw::view;

namespace {

constexpr float kReach = 9; // pixels, of what can be taken hold of

float between(ImVec2 a, ImVec2 b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// Contours and paths alike: the points, in the world.
std::vector<thawVec3> worldPoints(const scene::Scene& s, const std::vector<thawVec3>& points, int collider) {
    std::vector<thawVec3> out;
    out.reserve(points.size());
    for (const thawVec3& p : points) out.push_back(toWorld(s, collider, p));
    return out;
}

struct Line {
    std::vector<thawVec3> points; // in the world
    bool closed = false;
};

/// The lines of a path or shape.
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

} // namespace

const char* ToolKit::help(Tool tool) {
    switch (tool) {
    case Tool::select:
        return "Click what you want to change. Right drag turns the view, Shift + right drag moves it, the wheel "
               "zooms.";
    case Tool::move:
        return "Drag an arrow, a square or the middle of the handle. Ctrl: in steps.";
    case Tool::turn:
        return "Drag a ring of the handle. Ctrl: in steps.";
    case Tool::scale:
        return "Drag the ring of the handle. Ctrl: in steps.";
    case Tool::path:
        return "Drag over a surface to draw where the melt runs. Drag a node to move it, double click the line for "
               "another, "
               "Delete takes it out.";
    case Tool::shape:
        return "Drag around what the melt shall fill. Inside a chosen shape: a hole. Shift: another part of it.";
    case Tool::source:
        return "Click a surface to place heat before it; drag to choose how far.";
    case Tool::collider:
        return "Click a surface to stand something solid on it.";
    case Tool::temperature:
        return "Drag over a body: it starts with this temperature there. Ctrl + wheel: size of the brush.";
    case Tool::absorptivity:
        return "Drag over a body: it takes up this share of radiation there. Ctrl + wheel: size of the brush.";
    case Tool::erase:
        return "Drag over paths, contours and paint to take them away. Ctrl + wheel: size.";
    case Tool::probe:
        return "Click a particle to see all that it knows.";
    }
    return "";
}

std::optional<Hit> ToolKit::under(Studio& studio, const Lens& lens, ImVec2 at) const {
    std::optional<Hit> hit = studio.picker().cast(lens.ray(at));
    // The picture may be older than the last edit.
    if (hit && !exists(studio.scene(), hit->item)) hit->item = {};
    return hit;
}

std::optional<ToolKit::Touch> ToolKit::touched(const Studio& studio, const Lens& lens, ImVec2 at) const {
    const scene::Scene& s = studio.scene();
    // Nodes of what is chosen come first, then what is nearest.
    const Item chosen = studio.selection();
    if (chosen.kind == Kind::path || chosen.kind == Kind::shape) {
        float best = kReach;
        Touch found{chosen, 0, -1};
        const std::vector<Line> lines = linesOf(s, chosen);
        for (size_t c = 0; c < lines.size(); ++c)
            for (size_t i = 0; i < lines[c].points.size(); ++i)
                if (const auto p = lens.project(lines[c].points[i]))
                    if (const float d = between(*p, at); d < best)
                        best = d, found.contour = int(c), found.node = int(i);
        if (found.node >= 0) return found;
    }
    float best = kReach;
    std::optional<Touch> found;
    for (size_t i = 0; i < s.heatSources.size(); ++i) {
        if (s.heatSources[i].type == thawHeatSource_directional) continue;
        if (const auto p = lens.project(s.heatSources[i].position))
            if (const float d = between(*p, at) - 4; d < best) best = d, found = Touch{{Kind::source, int(i)}, 0, -1};
    }
    const auto along = [&](Item item) {
        const std::vector<Line> lines = linesOf(s, item);
        for (size_t c = 0; c < lines.size(); ++c) {
            const std::vector<thawVec3>& points = lines[c].points;
            const size_t n = points.size(), segments = lines[c].closed ? n : n - 1;
            for (size_t i = 0; i < segments; ++i) {
                const auto a = lens.project(points[i]), b = lens.project(points[(i + 1) % n]);
                if (!a || !b) continue;
                const ImVec2 d(b->x - a->x, b->y - a->y);
                const float square = d.x * d.x + d.y * d.y;
                const float u =
                    square > 0 ? std::clamp(((at.x - a->x) * d.x + (at.y - a->y) * d.y) / square, 0.0f, 1.0f) : 0;
                const float far = between(at, {a->x + u * d.x, a->y + u * d.y});
                if (far < best) best = far, found = Touch{item, int(c), -1};
            }
        }
    };
    if (studio.view.icons) {
        for (size_t i = 0; i < s.paths.size(); ++i) along({Kind::path, int(i)});
        for (size_t i = 0; i < s.shapes.size(); ++i) along({Kind::shape, int(i)});
    }
    return found;
}

bool ToolKit::cancel() {
    const bool was = !line_.empty() || anchor_.has_value() || dragging_ || gizmo_.held();
    line_.clear(), lineColliders_.clear(), anchor_.reset(), dragging_ = false;
    gizmo_.drop();
    return was;
}

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

void ToolKit::select(Studio& studio, const Lens& lens, const Pointer& pointer) {
    if (dragNode(studio, lens, pointer)) return;
    if (pointer.clickedTwice && (studio.selection().kind == Kind::path || studio.selection().kind == Kind::shape))
        return insertNode(studio, lens, pointer);
    if (!pointer.pressed) return;
    if (const std::optional<Touch> touch = touched(studio, lens, pointer.at)) return studio.select(touch->item);
    const std::optional<Hit> hit = under(studio, lens, pointer.at);
    studio.select(hit ? hit->item : Item{});
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

void ToolKit::placeSource(Studio& studio, const Lens& lens, const Pointer& pointer, ImDrawList& draw) {
    const float spacing = studio.scene().world.particleSpacing;
    const float usual = studio.tools.sourceDistance > 0 ? studio.tools.sourceDistance : 10 * spacing;
    if (pointer.pressed) {
        if (const std::optional<Touch> touch = touched(studio, lens, pointer.at);
            touch && touch->item.kind == Kind::source)
            return studio.select(touch->item);
        anchor_ = under(studio, lens, pointer.at), pushed_ = usual;
    }
    const std::optional<Hit> at = anchor_ ? anchor_ : pointer.over ? under(studio, lens, pointer.at) : std::nullopt;
    if (!at) return;
    if (anchor_ && pointer.held) {
        const std::optional<ImVec2> from = lens.project(anchor_->point);
        if (from && between(*from, pointer.at) > 12)
            pushed_ = between(*from, pointer.at) * lens.pixelSize(anchor_->point);
    }
    const float off = anchor_ ? pushed_ : usual;
    const thawVec3 place = at->point + at->normal * off;
    if (const auto a = lens.project(at->point), b = lens.project(place); a && b) {
        draw.AddLine(*a, *b, IM_COL32(255, 190, 90, 220), 2);
        draw.AddCircle(*b, 9, IM_COL32(255, 190, 90, 255), 24, 2.5f);
        char text[32];
        std::snprintf(text, sizeof text, "%.0f mm", double(1000 * off));
        draw.AddText({b->x + 13, b->y - 7}, IM_COL32(255, 230, 190, 255), text);
    }
    if (!anchor_ || pointer.held) return;
    anchor_.reset();
    Item made;
    if (studio.edit("Place heat source", [&](scene::Scene& s) { made = addSource(s, studio.tools.source, place); }))
        studio.select(made);
}

void ToolKit::placeCollider(Studio& studio, const Lens& lens, const Pointer& pointer) {
    if (!pointer.pressed) return;
    const std::optional<Hit> hit = under(studio, lens, pointer.at);
    if (!hit) return studio.tell("click on a surface");
    scene::Shape shape;
    shape.type = studio.tools.collider;
    const float size = studio.tools.colliderSize;
    shape.size = {size, size, size}, shape.radius = size / 2, shape.height = size;
    if (shape.type == scene::ShapeType::torus) shape.tubeRadius = size / 8;
    const float off = footOf(shape);
    const thawVec3 place = hit->point + hit->normal * off;
    Item made;
    if (studio.edit("Place collider", [&](scene::Scene& s) { made = addCollider(s, shape, place); }))
        studio.select(made);
}

void ToolKit::paint(Studio& studio, const Lens& lens, const Pointer& pointer) {
    if (pointer.pressed) ++strokes_, last_.reset();
    if (!pointer.held) {
        if (last_) studio.endGesture(), last_.reset();
        return;
    }
    for (const ImVec2 at : pointer.trail) {
        const std::optional<Hit> hit = under(studio, lens, at);
        if (!hit || hit->item.kind != Kind::body) continue;
        const float radius = studio.tools.brushRadius;
        if (last_ && length(last_->point - hit->point) < 0.5f * radius) continue;
        last_ = hit;
        scene::Paint dab;
        dab.brush = {hit->point, radius, studio.tools.falloff};
        const bool heat = studio.tool == Tool::temperature;
        (heat ? dab.temperature : dab.absorptivity) =
            heat ? studio.tools.paintTemperature : studio.tools.paintAbsorptivity;
        studio.edit(
            heat ? "Paint temperature" : "Paint absorptivity",
            [&](scene::Scene& s) { s.bodies[size_t(hit->item.index)].paint.push_back(dab); },
            "paint " + std::to_string(strokes_));
    }
}

void ToolKit::wipe(Studio& studio, const Lens& lens, const Pointer& pointer) {
    if (pointer.pressed) ++strokes_;
    if (pointer.released) studio.endGesture();
    if (!pointer.held) return;
    const std::optional<Hit> hit = under(studio, lens, pointer.at);
    if (!hit) return;
    const thawVec3 at = hit->point;
    const float radius = studio.tools.brushRadius;
    const auto near = [&](thawVec3 p) { return length(p - at) < radius; };
    studio.edit(
        "Erase",
        [&](scene::Scene& s) {
            for (size_t i = 0; i < s.paths.size();) {
                const scene::Path path = s.paths[i];
                const std::vector<thawVec3> line = worldPoints(s, path.points, path.collider);
                const Nearest nearest = nearestOn(line, at, false);
                if (nearest.distance >= radius) {
                    ++i;
                    continue;
                }
                const auto rest = cutOut(line, at, radius);
                s.paths.erase(s.paths.begin() + int(i));
                for (size_t k = 0; k < rest.size(); ++k, ++i) {
                    scene::Path piece = path;
                    piece.points.clear();
                    for (const thawVec3& p : rest[k]) piece.points.push_back(fromWorld(s, path.collider, p));
                    if (k > 0) piece.name = freeName(s, Kind::path, path.name);
                    s.paths.insert(s.paths.begin() + int(i), piece);
                }
            }
            for (size_t i = 0; i < s.shapes.size();) {
                scene::FillShape& shape = s.shapes[i];
                const bool drawn = !shape.contours.empty();
                for (auto& contour : shape.contours)
                    std::erase_if(contour, [&](thawVec3 p) { return near(toWorld(s, shape.collider, p)); });
                std::erase_if(shape.contours, [](const auto& c) { return c.size() < 3; });
                if (drawn && shape.contours.empty())
                    s.shapes.erase(s.shapes.begin() + int(i));
                else
                    ++i;
            }
            for (scene::Body& body : s.bodies)
                std::erase_if(body.paint, [&](const scene::Paint& p) { return near(p.brush.center); });
        },
        "erase " + std::to_string(strokes_));
}

void ToolKit::update(Studio& studio, const Lens& lens, const Pointer& pointer, ImDrawList& draw) {
    overlay(studio, lens, pointer, draw);
    const ImGuiIO& io = ImGui::GetIO();
    if (pointer.over && io.KeyCtrl && io.MouseWheel != 0)
        studio.tools.brushRadius = std::clamp(studio.tools.brushRadius * std::pow(1.1f, io.MouseWheel), 1e-4f, 1.0f);
    switch (studio.tool) {
    case Tool::select:
        return select(studio, lens, pointer);
    case Tool::move:
    case Tool::turn:
    case Tool::scale:
        if (!gizmo_.update(studio, lens, pointer, draw)) select(studio, lens, pointer);
        return;
    case Tool::path:
        return drawLine(studio, lens, pointer, false);
    case Tool::shape:
        return drawLine(studio, lens, pointer, true);
    case Tool::source:
        return placeSource(studio, lens, pointer, draw);
    case Tool::collider:
        return placeCollider(studio, lens, pointer);
    case Tool::temperature:
    case Tool::absorptivity:
        return paint(studio, lens, pointer);
    case Tool::erase:
        return wipe(studio, lens, pointer);
    case Tool::probe:
        return probe(studio, lens, pointer);
    }
}

void ToolKit::probe(Studio& studio, const Lens& lens, const Pointer& pointer) const {
    if (!pointer.pressed) return;
    // The first ball of half a spacing that the ray meets.
    const thawParticleView all = studio.frame().particles.view();
    const Ray ray = lens.ray(pointer.at);
    float best = INFINITY;
    for (int i = 0; i < all.count; ++i) {
        const float* p = all.positions + 4 * size_t(i);
        const Vec3 d = Vec3{p[0], p[1], p[2]} - ray.origin;
        const float along = dot(d, ray.direction), square = dot(d, d) - along * along;
        const float r = 0.6f * studio.scene().world.particleSpacing * std::exp2(float(all.levels[i]) / 3);
        if (along > 0 && square < r * r && along < best)
            best = along, studio.pickedParticle = all.ids[i], studio.hasPickedParticle = true;
    }
    if (best == INFINITY) studio.tell("no particle there");
}

void ToolKit::overlay(Studio& studio, const Lens& lens, const Pointer& pointer, ImDrawList& draw) const {
    const scene::Scene& s = studio.scene();
    const Item chosen = studio.selection();
    const auto polyline = [&](const std::vector<thawVec3>& points, bool closed, ImU32 color, float width) {
        std::vector<ImVec2> run;
        const auto flush = [&](bool whole) {
            if (run.size() > 1)
                draw.AddPolyline(run.data(), int(run.size()), color, whole && closed ? ImDrawFlags_Closed : 0, width);
            run.clear();
        };
        bool whole = true;
        for (const thawVec3& p : points) {
            if (const auto at = lens.project(p))
                run.push_back(*at);
            else
                whole = false, flush(false);
        }
        flush(whole);
    };
    if (studio.view.icons) {
        const auto lines = [&](Item item, ImU32 color) {
            for (const Line& line : linesOf(s, item)) {
                const bool on = item == chosen;
                polyline(line.points, line.closed, on ? IM_COL32(255, 230, 90, 255) : color, on ? 2.5f : 1.5f);
            }
        };
        for (size_t i = 0; i < s.paths.size(); ++i) lines({Kind::path, int(i)}, IM_COL32(110, 200, 255, 200));
        for (size_t i = 0; i < s.shapes.size(); ++i) lines({Kind::shape, int(i)}, IM_COL32(120, 235, 160, 200));
        for (size_t i = 0; i < s.heatSources.size(); ++i) {
            const scene::HeatSource& h = s.heatSources[i];
            if (h.type == thawHeatSource_directional) continue;
            const auto p = lens.project(h.position);
            if (!p) continue;
            const bool on = chosen == Item{Kind::source, int(i)};
            const ImU32 color = on          ? IM_COL32(255, 230, 90, 255)
                                : h.enabled ? IM_COL32(255, 160, 60, 230)
                                            : IM_COL32(150, 150, 150, 200);
            draw.AddCircle(*p, 7, color, 20, 2);
            for (int k = 0; k < 8; ++k) {
                const float a = 0.785398f * float(k);
                draw.AddLine({p->x + 10 * std::cos(a), p->y + 10 * std::sin(a)},
                             {p->x + 14 * std::cos(a), p->y + 14 * std::sin(a)}, color, 2);
            }
        }
    }
    if (exists(s, chosen) && (chosen.kind == Kind::path || chosen.kind == Kind::shape)) {
        const std::vector<Line> lines = linesOf(s, chosen);
        for (size_t c = 0; c < lines.size(); ++c)
            for (size_t i = 0; i < lines[c].points.size(); ++i)
                if (const auto p = lens.project(lines[c].points[i])) {
                    const bool on = studio.node == int(i) && studio.contour == int(c);
                    draw.AddCircleFilled(*p, on ? 6.0f : 4.0f,
                                         on ? IM_COL32(255, 120, 60, 255) : IM_COL32(255, 240, 160, 255));
                    draw.AddCircle(*p, on ? 6.0f : 4.0f, IM_COL32(40, 30, 0, 255), 12, 1);
                }
    } else if (exists(s, chosen)) {
        box(studio, lens, chosen, draw);
    }
    if (!line_.empty()) {
        polyline(line_, false, IM_COL32(255, 230, 90, 255), 3);
        if (studio.tool == Tool::shape && line_.size() > 2)
            polyline({line_.back(), line_.front()}, false, IM_COL32(255, 230, 90, 110), 1.5f);
    }
    const Tool tool = studio.tool;
    const bool brush = tool == Tool::temperature || tool == Tool::absorptivity || tool == Tool::erase;
    if ((brush || tool == Tool::path) && pointer.over)
        if (const std::optional<Hit> hit = under(studio, lens, pointer.at)) {
            const float spacing = s.world.particleSpacing;
            const float radius = brush                       ? studio.tools.brushRadius
                                 : chosen.kind == Kind::path ? s.paths[size_t(chosen.index)].def.radius
                                                             : 4 * spacing;
            const Vec3 u = perpendicular(hit->normal), v = cross(hit->normal, u);
            std::vector<thawVec3> ring;
            for (int k = 0; k < 40; ++k) {
                const float a = 0.15707963f * float(k);
                ring.push_back(hit->point + u * (radius * std::cos(a)) + v * (radius * std::sin(a)));
            }
            polyline(ring, true, tool == Tool::erase ? IM_COL32(255, 110, 110, 230) : IM_COL32(255, 255, 255, 200),
                     1.5f);
        }
}

void ToolKit::box(const Studio& studio, const Lens& lens, Item item, ImDrawList& draw) const {
    const Frame& f = studio.frame();
    const scene::Scene& s = studio.scene();
    if (!f.meshes) return;
    const scene::TriMesh* mesh = nullptr;
    const scene::Placement* at = nullptr;
    const size_t i = size_t(item.index);
    if (item.kind == Kind::body && i < f.meshes->bodies.size())
        mesh = &f.meshes->bodies[i], at = &s.bodies[i].placement;
    if (item.kind == Kind::collider && i < f.meshes->colliders.size())
        mesh = &f.meshes->colliders[i], at = &s.colliders[i].placement;
    if (item.kind == Kind::prop && i < f.meshes->props.size()) mesh = &f.meshes->props[i], at = &s.props[i].placement;
    if (!mesh || mesh->vertices.empty()) return;
    if (f.meshes != boxMeshes_ || item != boxItem_)
        boxMeshes_ = f.meshes, boxItem_ = item, boxBounds_ = scene::boundsOf(*mesh);
    const scene::Bounds& b = boxBounds_;
    std::optional<ImVec2> corner[8];
    for (int k = 0; k < 8; ++k) {
        const Vec3 p{k & 1 ? b.upper.x : b.lower.x, k & 2 ? b.upper.y : b.lower.y, k & 4 ? b.upper.z : b.lower.z};
        corner[k] = lens.project(rotate(at->rotation, p * at->scale) + at->position);
    }
    for (int k = 0; k < 8; ++k)
        for (const int bit : {1, 2, 4})
            if (!(k & bit) && corner[k] && corner[k | bit])
                draw.AddLine(*corner[k], *corner[k | bit], IM_COL32(255, 230, 90, 170), 1.5f);
}

} // namespace thaw::editor
