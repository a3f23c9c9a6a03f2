// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/toolkit.h"

#include "view/math.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace thaw::editor {

using namespace thaw::view;

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

} // namespace thaw::editor
