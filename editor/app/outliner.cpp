// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/panels.h"
#include "app/widgets.h"

namespace thaw::editor {

namespace {

struct Group {
    Kind kind;
    const char* title;
};
constexpr Group kGroups[] = {{Kind::body, "Bodies"},       {Kind::source, "Heat sources"}, {Kind::path, "Paths"},
                             {Kind::shape, "Shapes"},      {Kind::collider, "Colliders"},  {Kind::prop, "Props"},
                             {Kind::material, "Materials"}};

/// Whether it is on, or seen; null where it is neither.
bool* switchOf(scene::Scene& s, Item item) {
    const size_t i = size_t(item.index);
    switch (item.kind) {
    case Kind::source:
        return &s.heatSources[i].enabled;
    case Kind::path:
        return &s.paths[i].def.enabled;
    case Kind::shape:
        return &s.shapes[i].def.enabled;
    case Kind::collider:
        return &s.colliders[i].visible;
    default:
        return nullptr;
    }
}

bool isOn(const scene::Scene& s, Item item) {
    const size_t i = size_t(item.index);
    return item.kind == Kind::source     ? s.heatSources[i].enabled
           : item.kind == Kind::path     ? s.paths[i].def.enabled
           : item.kind == Kind::shape    ? s.shapes[i].def.enabled
           : item.kind == Kind::collider ? s.colliders[i].visible
                                         : true;
}

bool hasSwitch(Kind kind) {
    return kind == Kind::source || kind == Kind::path || kind == Kind::shape || kind == Kind::collider;
}

void addMenu(Studio& studio) {
    static const char* const shapes[] = {"box", "sphere", "cylinder", "cone", "torus"};
    static const char* const sources[] = {"point", "sphere", "rectangle", "disc", "directional"};
    const float spacing = studio.scene().world.particleSpacing;
    Item made;
    const auto primitive = [&](int type) {
        scene::Shape shape;
        shape.type = scene::ShapeType(type + 1);
        return shape;
    };
    if (ImGui::BeginMenu("Body")) {
        for (int k = 0; k < 5; ++k)
            if (ImGui::MenuItem(shapes[k]))
                studio.edit("Add body", [&](scene::Scene& s) {
                    const scene::Shape shape = primitive(k);
                    made = addBody(s, shape, {0, footOf(shape), 0});
                });
        if (ImGui::MenuItem("mesh ...")) studio.asksForMesh = true;
        ImGui::EndMenu();
    }
    ui::note("add body");
    if (ImGui::BeginMenu("Collider")) {
        if (ImGui::MenuItem("floor"))
            studio.edit("Add floor", [&](scene::Scene& s) {
                scene::Shape shape;
                shape.type = scene::ShapeType::plane;
                made = addCollider(s, shape, {0, 0, 0});
                s.colliders.back().name = freeName(s, Kind::collider, "floor");
            });
        for (int k = 0; k < 5; ++k)
            if (ImGui::MenuItem(shapes[k]))
                studio.edit("Add collider", [&](scene::Scene& s) {
                    const scene::Shape shape = primitive(k);
                    made = addCollider(s, shape, {0, footOf(shape), 0});
                });
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Heat source")) {
        for (int k = 0; k < 5; ++k)
            if (ImGui::MenuItem(sources[k]))
                studio.edit("Add heat source", [&](scene::Scene& s) {
                    made = addSource(s, thawHeatSourceType(k), {0, 60 * spacing, 0});
                });
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Prop")) {
        for (int k = 0; k < 5; ++k)
            if (ImGui::MenuItem(shapes[k]))
                studio.edit("Add prop", [&](scene::Scene& s) {
                    const scene::Shape shape = primitive(k);
                    made = addProp(s, shape, {0, footOf(shape), 0});
                });
        ImGui::EndMenu();
    }
    if (ImGui::BeginMenu("Material")) {
        for (int p = 0; p < int(thawMaterial_presetCount); ++p)
            if (ImGui::MenuItem(thawMaterialPresetName(thawMaterialPreset(p))))
                studio.edit("Add material", [&](scene::Scene& s) { made = addMaterial(s, thawMaterialPreset(p)); });
        ImGui::EndMenu();
    }
    if (made) studio.select(made);
}

} // namespace

void showAddMenu(Studio& studio) { addMenu(studio); }

void showOutliner(Studio& studio) {
    if (ui::button("Add ...", {-1, 0})) ImGui::OpenPopup("add");
    ui::tip("Bodies that melt, colliders, heat sources, props, materials. Meshes can be dropped into the window.");
    if (ImGui::BeginPopup("add")) {
        addMenu(studio);
        ImGui::EndPopup();
    }
    const auto row = [&](Item item, const char* title) {
        const bool chosen = studio.selection() == item;
        ImGui::PushID(int(item.kind) * 100000 + item.index);
        const bool on = isOn(studio.scene(), item);
        if (!on) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
        const float room = hasSwitch(item.kind) ? ImGui::GetFrameHeight() + 4 : 0;
        if (ImGui::Selectable(title, chosen, ImGuiSelectableFlags_AllowItemOverlap,
                              {ImGui::GetContentRegionAvail().x - room, 0}))
            studio.select(item);
        if (!on) ImGui::PopStyleColor();
        ui::note(std::string("item ") + title);
        if (ImGui::BeginPopupContextItem("item menu")) {
            studio.select(item);
            if (ImGui::MenuItem("Duplicate", "Ctrl+D")) studio.duplicateSelection();
            if (ImGui::MenuItem("Delete", "Del")) studio.removeSelection();
            ImGui::EndPopup();
        }
        if (hasSwitch(item.kind) && exists(studio.scene(), item)) {
            ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::GetFrameHeight());
            bool value = isOn(studio.scene(), item);
            ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {2, 0});
            if (ImGui::Checkbox("##on", &value))
                studio.edit(value ? "Switch on" : "Switch off", [&](scene::Scene& s) { *switchOf(s, item) = value; });
            ImGui::PopStyleVar();
            ui::tip(item.kind == Kind::collider ? "Seen. It is solid in any case." : "On.");
        }
        ImGui::PopID();
    };
    row({Kind::world, 0}, "World");
    row({Kind::camera, 0}, "Camera");
    for (const Group& group : kGroups) {
        const int count = countOf(studio.scene(), group.kind);
        if (!ui::section(group.title)) continue;
        if (count == 0) ui::quiet("  none");
        // What was deleted in a row's own menu is gone from the next row on.
        for (int i = 0; i < countOf(studio.scene(), group.kind); ++i)
            row({group.kind, i}, titleOf(studio.scene(), {group.kind, i}).c_str());
    }
}

} // namespace thaw::editor
