// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/panels.h"
#include "app/widgets.h"

#include "app/toolkit.h"

namespace thaw::editor {

namespace {

struct Entry {
    Tool tool;
    const char *label, *key, *what;
};
constexpr Entry kEntries[] = {
    {Tool::select, "Select", "Q", "Choose what to change."},
    {Tool::move, "Move", "W", "Move what is chosen."},
    {Tool::turn, "Turn", "E", "Turn what is chosen."},
    {Tool::scale, "Scale", "R", "Make what is chosen larger or smaller."},
    {Tool::path, "Path", "P", "Draw where the melt runs."},
    {Tool::shape, "Shape", "O", "Draw what the melt fills, and sets in."},
    {Tool::source, "Heat", "H", "Place a heat source before a surface."},
    {Tool::collider, "Collider", "C", "Stand something solid on a surface."},
    {Tool::temperature, "Warmth", "T", "Paint the temperature that a body starts with."},
    {Tool::absorptivity, "Soot", "A", "Paint how much radiation a surface takes up: melting starts where it is dark."},
    {Tool::erase, "Erase", "X", "Take away paths, contours and paint."},
    {Tool::probe, "Probe", "I", "See all that a particle knows."}};

} // namespace

const char* toolName(Tool tool) {
    for (const Entry& entry : kEntries)
        if (entry.tool == tool) return entry.label;
    return "";
}

void showToolbar(Studio& studio) {
    for (const Entry& entry : kEntries) {
        if (ui::choice((std::string(entry.label) + "##tool " + entry.label).c_str(), studio.tool == entry.tool,
                       {-1, 0}))
            studio.tool = entry.tool;
        ui::tip(entry.what, entry.key);
        if (entry.tool == Tool::scale || entry.tool == Tool::shape || entry.tool == Tool::collider ||
            entry.tool == Tool::absorptivity)
            ImGui::Spacing();
    }
}

bool toolShortcuts(Studio& studio) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput || io.KeyCtrl || io.KeyAlt) return false;
    for (const Entry& entry : kEntries)
        if (ImGui::IsKeyPressed(entry.key[0], false)) {
            studio.tool = entry.tool;
            return true;
        }
    return false;
}

void showToolSettings(Studio& studio) {
    ToolSettings& t = studio.tools;
    static const char* const sources[] = {"point", "sphere", "rectangle", "disc", "directional"};
    static const char* const shapes[] = {"box", "sphere", "cylinder", "cone", "torus"};
    const auto slider = [](const char* label, float& value, float low, float high, float unit, const char* format,
                           const char* help, bool logarithmic = false) {
        float shown = value * unit;
        ui::field(label);
        ImGui::PushID(label);
        if (ImGui::SliderFloat("##v", &shown, low * unit, high * unit, format,
                               ImGuiSliderFlags_AlwaysClamp | (logarithmic ? ImGuiSliderFlags_Logarithmic : 0)))
            value = shown / unit;
        ui::note(label);
        ui::tip(help);
        ImGui::PopID();
    };
    switch (studio.tool) {
    case Tool::path:
    case Tool::shape:
        if (!ui::section("Tool##tool settings")) return;
        slider("smoothing", t.pathSmoothing, 0, 20, 1, "%.0f", "How much of a hand's trembling is taken out.");
        break;
    case Tool::source: {
        if (!ui::section("Tool##tool settings")) return;
        int type = int(t.source);
        ui::field("type");
        if (ImGui::Combo("##source type", &type, sources, 4)) t.source = thawHeatSourceType(type);
        float usual = t.sourceDistance > 0 ? t.sourceDistance : 10 * studio.scene().world.particleSpacing;
        slider("off surface", usual, 0.001f, 0.5f, 1000, "%.0f mm", "How far before the surface it is placed.", true);
        if (ImGui::IsItemEdited()) t.sourceDistance = usual;
        break;
    }
    case Tool::collider: {
        if (!ui::section("Tool##tool settings")) return;
        int type = int(t.collider) - 1;
        ui::field("shape");
        if (ImGui::Combo("##collider shape", &type, shapes, 5)) t.collider = scene::ShapeType(type + 1);
        slider("size", t.colliderSize, 0.001f, 1, 1000, "%.0f mm", "Across.", true);
        break;
    }
    case Tool::temperature:
    case Tool::absorptivity:
    case Tool::erase:
        if (!ui::section("Tool##tool settings")) return;
        slider("brush", t.brushRadius, 1e-4f, 0.2f, 1000, "%.1f mm", "Radius of the brush.", true);
        if (studio.tool == Tool::erase) break;
        slider("soft edge", t.falloff, 0, 1, 1, "%.2f", "Outer share of the radius over which it fades.");
        if (studio.tool == Tool::temperature)
            slider("temperature", t.paintTemperature, 100, 2000, 1, "%.1f K", "That is painted.", true);
        else
            slider("takes up", t.paintAbsorptivity, 0, 1, 1, "%.2f", "Share of radiation that is painted. 1: soot.");
        break;
    case Tool::move:
    case Tool::turn:
    case Tool::scale: {
        if (!ui::section("Tool##tool settings")) return;
        ui::field("snap");
        ui::toggle("##snap", &studio.settings.snap);
        ui::tip("In steps. Ctrl while dragging: the other way.");
        slider("step", studio.settings.snapStep, 1e-4f, 0.1f, 1000, "%.1f mm", "Of moves that snap.", true);
        slider("angle", studio.settings.snapDegrees, 1, 90, 1, "%.0f°", "Of turns that snap.");
        break;
    }
    case Tool::probe:
        showParticle(studio);
        break;
    case Tool::select:
        if (!studio.selection()) ui::quiet("Nothing is chosen.");
        break;
    }
}

void showParticle(Studio& studio) {
    if (!studio.hasPickedParticle) return ui::quiet("Click a particle.");
    const thawParticleView all = studio.frame().particles.view();
    int row = -1;
    for (int i = 0; i < all.count && row < 0; ++i)
        if (all.ids[i] == studio.pickedParticle) row = i;
    ui::value("particle", "%u", studio.pickedParticle);
    if (row < 0) return ui::quiet("It is gone: merged, split, burnt or deleted.");
    const size_t i = size_t(row);
    const float *x = all.positions + 4 * i, *v = all.velocities + 4 * i, *n = all.normals + 4 * i;
    const Frame& f = studio.frame();
    const auto named = [&](Kind kind, const std::vector<int>& map, size_t index) {
        const int at = index < map.size() ? map[index] : -1;
        return at >= 0 && f.scene && exists(*f.scene, {kind, at}) ? titleOf(*f.scene, {kind, at}) : std::string("gone");
    };
    ui::value("body", "%s", named(Kind::body, f.bodyOfIndex, all.bodies[i]).c_str());
    ui::value("material", "%s", named(Kind::material, f.materialOfIndex, all.materials[i]).c_str());
    ui::value("position", "%.2f %.2f %.2f mm", double(1000 * x[0]), double(1000 * x[1]), double(1000 * x[2]));
    ui::value("velocity", "%.1f %.1f %.1f mm/s", double(1000 * v[0]), double(1000 * v[1]), double(1000 * v[2]));
    ui::value("speed", "%.2f mm/s", 1000 * std::sqrt(double(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])));
    ui::value("mass", "%.4g mg", double(1e6f * v[3]));
    ui::value("level", "%d (mass x %d)", all.levels[i], 1 << all.levels[i]);
    ui::value("temperature", "%.2f K (%.2f °C)", double(all.temperatures[i]), double(all.temperatures[i]) - 273.15);
    ui::value("liquid", "%.1f %%", double(100 * all.liquidFractions[i]));
    ui::value("normal", "%.2f %.2f %.2f", double(n[0]), double(n[1]), double(n[2]));
    ui::value("exposed", "%.3f mm²", double(1e6f * n[3]));
    ui::value("influence", "%.2f mm", double(1000 * x[3]));
    if (all.absorptivities[i])
        ui::value("takes up", "%.2f (painted)", double(all.absorptivities[i] - 1) / 254);
    else
        ui::value("takes up", "as its material");
    const uint8_t flags = all.flags[i];
    std::string words;
    for (const auto& [bit, word] : {std::pair{thawParticle_fixed, "fixed"},
                                    {thawParticle_surface, "at the surface"},
                                    {thawParticle_asleep, "asleep"},
                                    {thawParticle_rigid, "rigid"}})
        if (flags & bit) words += std::string(words.empty() ? "" : ", ") + word;
    ui::value("state", "%s", words.empty() ? "flows" : words.c_str());
    if (i < f.particles.featureSizes().size())
        ui::value("feature size", "%.2f mm", double(1000 * f.particles.featureSizes()[i]));
}

void showViewPanel(Studio& studio, Viewport& viewport) {
    ViewSettings& v = studio.view;
    const float frame = 2 * ImGui::GetStyle().FramePadding.x;
    const float box = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x;
    static const char* const help[] = {"A studio picture: light, shadow, glow.",
                                       "The surface by temperature.",
                                       "Solid, mushy or liquid.",
                                       "The surface by liquid fraction.",
                                       "The studio picture with paths and shapes over it.",
                                       "The melt from its particles in screen space, without a mesh.",
                                       "Particles as balls of their spacing, by temperature.",
                                       "Particles by level: each has twice the mass of the one below.",
                                       "Particles by how thick the melt is around them.",
                                       "Particles by speed.",
                                       "Particles by the area that is exposed to air.",
                                       "Particles by the share of radiation that they take up."};
    ImGui::SetNextItemWidth(9 * ImGui::GetFontSize());
    const scene::NamedView& now = *std::find_if(std::begin(scene::kNamedViews), std::end(scene::kNamedViews),
                                                [&](const scene::NamedView& n) { return n.view == v.picture; });
    if (ImGui::BeginCombo("##view", now.name)) {
        for (size_t i = 0; i < std::size(scene::kNamedViews); ++i) {
            if (ImGui::Selectable(scene::kNamedViews[i].name, v.picture == scene::kNamedViews[i].view))
                v.picture = scene::kNamedViews[i].view;
            ui::note(std::string("view ") + scene::kNamedViews[i].name);
            ui::tip(help[i]);
        }
        ImGui::EndCombo();
    }
    ui::note("view");
    ui::tip("What the picture shows.", "V: the next one");
    ui::beside("controls", box);
    ui::toggle("controls", &v.controls);
    ui::tip("Paths and shapes as they reach, over the picture.");
    ui::beside("handles", box);
    ui::toggle("handles", &v.icons);
    ui::tip("Heat sources, lines and nodes.");
    ui::beside("cut", box);
    ui::toggle("cut", &v.clip);
    ui::tip("Leaves out what lies before a plane, to look inside.");
    if (v.clip) {
        static const char* const axes[] = {"x", "y", "z"};
        ui::beside("", 8.5f * ImGui::GetFontSize());
        ImGui::SetNextItemWidth(3 * ImGui::GetFontSize());
        ImGui::Combo("##cut axis", &v.clipAxis, axes, 3);
        ui::note("cut axis");
        ui::tip("Across which axis it is cut.");
        ImGui::SameLine();
        ImGui::SetNextItemWidth(5 * ImGui::GetFontSize());
        float offset = 1000 * v.clipOffset;
        if (ImGui::DragFloat("##cut offset", &offset, 0.2f, -1e5f, 1e5f, "%.1f mm")) v.clipOffset = offset / 1000;
        ui::note("cut offset");
        ui::tip("How far before the middle of the scene.");
    }
    ui::beside("Focus", frame);
    if (ui::button("Focus")) viewport.focus(studio);
    ui::tip("Looks at what is chosen, or at everything.", "F");
    ui::beside("Camera ...", frame);
    if (ui::button("Camera ...##camera menu")) ImGui::OpenPopup("camera");
    ui::tip("The scene's own camera, that of captures.");
    if (!ImGui::BeginPopup("camera")) return;
    if (ImGui::MenuItem("Look through it", nullptr, v.followCamera)) v.followCamera = !v.followCamera;
    ui::note("camera look");
    ui::tip("Along its keys, while the scene plays.");
    if (ImGui::MenuItem("Put it here"))
        studio.edit("Set camera", [&](scene::Scene& s) {
            const view::Camera c = viewport.lens.camera();
            s.camera.eye = c.eye, s.camera.target = c.target;
            s.camera.fieldOfViewDegrees = c.fieldOfView * 57.29578f;
        });
    ui::note("camera set");
    if (ImGui::MenuItem("Add a key here")) {
        const double time = studio.frame().time;
        studio.edit("Add camera key", [&](scene::Scene& s) {
            const view::Camera c = viewport.lens.camera();
            scene::CameraKey key;
            key.time = float(time), key.eye = c.eye, key.target = c.target;
            key.fieldOfViewDegrees = c.fieldOfView * 57.29578f;
            std::erase_if(s.camera.keys,
                          [&](const scene::CameraKey& k) { return std::fabs(k.time - key.time) < 1e-3f; });
            const auto at = std::find_if(s.camera.keys.begin(), s.camera.keys.end(),
                                         [&](const scene::CameraKey& k) { return k.time > key.time; });
            s.camera.keys.insert(at, key);
        });
    }
    ui::note("camera key");
    ui::tip("It is here at this time of the game.");
    ImGui::EndPopup();
}

} // namespace thaw::editor
