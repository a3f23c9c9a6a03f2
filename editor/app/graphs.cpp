// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/fields.h"
#include "app/panels.h"

#include <algorithm>
#include <array>

namespace thaw::editor {

namespace {

struct Part {
    const char* name;
    ImU32 color;
    std::array<thawStage, 4> stages;
    int count;
};
// What an artist can act on: stages that cost for the same reason are one.
constexpr Part kParts[] = {
    {"lists", IM_COL32(120, 130, 150, 255), {thawStage_inputs, thawStage_neighbors, thawStage_stats}, 3},
    {"surface", IM_COL32(190, 160, 230, 255), {thawStage_exposure}, 1},
    {"rays", IM_COL32(255, 205, 90, 255), {thawStage_radiation}, 1},
    {"heat", IM_COL32(235, 120, 70, 255), {thawStage_conduction, thawStage_loss, thawStage_phase}, 3},
    {"control", IM_COL32(110, 200, 255, 255), {thawStage_control}, 1},
    {"viscosity", IM_COL32(90, 190, 120, 255), {thawStage_forces, thawStage_viscosity}, 2},
    {"pressure", IM_COL32(70, 130, 220, 255), {thawStage_pressure}, 1},
    {"walls", IM_COL32(170, 120, 80, 255), {thawStage_collision}, 1},
    {"levels", IM_COL32(220, 100, 160, 255), {thawStage_levels}, 1}};

float msOf(const Part& part, const thawProfile& p) {
    float sum = 0;
    for (int i = 0; i < part.count; ++i) sum += p.stage[part.stages[size_t(i)]];
    return sum;
}

void frameGraph(const Frame& f, float budget, ImVec2 size) {
    const ImVec2 low = ImGui::GetCursorScreenPos(), high(low.x + size.x, low.y + size.y);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(low, high, ImGui::GetColorU32(ImGuiCol_FrameBg), 3);
    const int shown = std::min(f.steps.size(), int(size.x / 3));
    float top = 1.4f * budget;
    for (int i = 0; i < shown; ++i)
        top = std::max(top, std::min(f.steps[f.steps.size() - 1 - i].profile.step, 4 * budget));
    const auto y = [&](float ms) { return high.y - std::min(ms / top, 1.0f) * size.y; };
    const float width = size.x / float(std::max(int(size.x / 3), 1));
    int hovered = -1;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    for (int i = 0; i < shown; ++i) {
        const StepSample& s = f.steps[f.steps.size() - 1 - i];
        const float right = high.x - width * float(i);
        float sum = 0;
        for (const Part& part : kParts) {
            const float ms = msOf(part, s.profile);
            if (ms <= 0) continue;
            list.AddRectFilled({right - width + 0.5f, y(sum + ms)}, {right, y(sum)}, part.color);
            sum += ms;
        }
        if (s.status & thawStep_overBudget)
            list.AddRectFilled({right - width + 0.5f, low.y}, {right, low.y + 3}, IM_COL32(255, 80, 80, 255));
        if (mouse.x >= right - width && mouse.x < right && mouse.y >= low.y && mouse.y < high.y) hovered = i;
    }
    list.AddLine({low.x, y(budget)}, {high.x, y(budget)}, IM_COL32(255, 255, 255, 200));
    char text[48];
    std::snprintf(text, sizeof text, "%.1f ms", double(budget));
    const ImVec2 label(low.x + 4, std::max(low.y, y(budget) - ImGui::GetFontSize() - 2)),
        room = ImGui::CalcTextSize(text);
    list.AddRectFilled({label.x - 3, label.y}, {label.x + room.x + 3, label.y + room.y}, IM_COL32(20, 20, 22, 200), 2);
    list.AddText(label, IM_COL32(255, 255, 255, 230), text);
    ImGui::InvisibleButton("frame graph", size);
    ui::note("frame graph");
    if (hovered >= 0 && ImGui::IsItemHovered()) {
        const StepSample& s = f.steps[f.steps.size() - 1 - hovered];
        ImGui::BeginTooltip();
        ImGui::Text("frame %lld: %.2f ms", static_cast<long long>(s.frame), double(s.profile.step));
        for (const Part& part : kParts) {
            ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(part.color), "%s", part.name);
            ImGui::SameLine(7 * ImGui::GetFontSize());
            ImGui::Text("%.2f ms", double(msOf(part, s.profile)));
        }
        if (s.surfaceMs > 0) ImGui::Text("and its mesh %.2f ms", double(s.surfaceMs));
        for (uint32_t bit = 1; bit; bit <<= 1)
            if (s.status & bit) ImGui::TextColored({1, 0.7f, 0.4f, 1}, "%s", thawStepStatusString(bit));
        ImGui::EndTooltip();
    }
}

void lanes(const Studio& studio, ImVec2 size) {
    const Frame& f = studio.frame();
    const ImVec2 low = ImGui::GetCursorScreenPos(), high(low.x + size.x, low.y + size.y);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(low, high, ImGui::GetColorU32(ImGuiCol_FrameBg), 3);
    const double end = now(), span = 0.5;
    const auto x = [&](double t) { return high.x - float((end - t) / span) * size.x; };
    static constexpr ImU32 colors[] = {IM_COL32(70, 130, 220, 255),  IM_COL32(190, 160, 230, 255),
                                       IM_COL32(120, 200, 190, 255), IM_COL32(235, 120, 70, 255),
                                       IM_COL32(220, 100, 160, 255), IM_COL32(120, 130, 150, 255),
                                       IM_COL32(90, 190, 120, 255)};
    const auto lane = [&](const Last<Span, 512>& spans, float top, const char* name) {
        const float height = 0.5f * size.y - 2;
        for (int i = 0; i < spans.size(); ++i) {
            const Span& s = spans[i];
            if (s.end < end - span) continue;
            list.AddRectFilled({std::max(x(s.start), low.x), top}, {std::max(x(s.end), x(s.start) + 1), top + height},
                               colors[size_t(s.kind)]);
        }
        list.AddText({low.x + 4, top + 1}, IM_COL32(255, 255, 255, 220), name);
    };
    lane(f.spans, low.y, "simulation: step, mesh, copy");
    lane(studio.spans, low.y + 0.5f * size.y, "window: panels, picture");
    ImGui::InvisibleButton("lanes", size);
    ui::note("lanes");
    ui::tip("What both threads did in the last half second. Neither waits for the other: a slow picture takes nothing "
            "from the simulation.");
}

} // namespace

void showGraphs(Studio& studio, const Viewport& viewport) {
    const Frame& f = studio.frame();
    ui::real(
        studio, "budget", [](auto& s) -> auto& { return s.defaults.budgetMilliseconds; }, {0.25f, 33, "%.2f ms", true},
        "What a step may take. The governor makes do with it: fewer iterations, coarser particles.");
    const float space = ImGui::GetContentRegionAvail().y;
    const float forLanes = studio.settings.showTimeline ? 2.4f * ImGui::GetFontSize() : 0;
    const float line = ImGui::GetTextLineHeightWithSpacing() + ImGui::GetStyle().ItemSpacing.y;
    // The numbers below stand in one line, or two where there is little room.
    const float lines = ImGui::GetContentRegionAvail().x > 38 * ImGui::GetFontSize() ? 2.0f : 3.0f;
    frameGraph(
        f, studio.budget(),
        {ImGui::GetContentRegionAvail().x, std::max(40.0f, space - lines * line - forLanes - (forLanes > 0 ? 4 : 0))});
    if (forLanes > 0) lanes(studio, {ImGui::GetContentRegionAvail().x, forLanes});
    for (size_t i = 0; i < std::size(kParts); ++i) {
        if (i) ui::beside(kParts[i].name, 0);
        ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kParts[i].color), "%s", kParts[i].name);
    }
    const float last = f.steps.size() ? f.steps.newest().profile.step : 0;
    char counts[80];
    std::snprintf(counts, sizeof counts, "%d particles, %d moving", f.counters.particles, f.counters.moving);
    ui::quietf("step %.2f ms  mesh %.2f ms  picture %.0f ms", double(last),
               double(f.steps.size() ? f.steps.newest().surfaceMs : 0), double(viewport.drawMs()));
    ui::beside(counts, 0);
    ui::quiet(counts);
    ui::beside("threads", 2 * ImGui::GetFrameHeight());
    ui::toggle("threads", &studio.settings.showTimeline);
    ui::tip("Shows what the simulation and the window do when.");
}

namespace {

void accuracy(Studio& studio) {
    const Frame& f = studio.frame();
    ReferenceRun& run = studio.referenceRun();
    if (run.running()) {
        ImGui::ProgressBar(run.progress(), {-1, 0}, "reference run");
        if (ui::button("Cancel##cancel reference")) run.cancel();
        return;
    }
    const Reference* reference = studio.reference();
    if (!reference)
        ui::quiet("no reference run of this scene");
    else if (!studio.referenceFits())
        ui::quiet("the scene has changed since its reference was made");
    else if (const std::optional<Reference::Row> row = reference->at(f.time)) {
        const float melted = f.counters.meltedFraction;
        ui::value("molten", "%.2f %%, reference %.2f %%", double(100 * melted), double(100 * row->melted));
        ui::value("differs by", "%+.2f points", double(100 * (melted - row->melted)));
        ui::tip("What the budget costs in accuracy: molten mass against a run in which time does not count.");
        if (f.steps.size() && f.steps.newest().frame == f.frame)
            ui::value("mean temperature", "%+.2f K", double(f.steps.newest().meanTemperature - row->meanTemperature));
        float now[120], then[120];
        int count = 0;
        for (int i = std::max(0, f.steps.size() - 480); i < f.steps.size() && count < 120; i += 4) {
            const StepSample& s = f.steps[i];
            const auto r = reference->at(double(s.frame) / 60);
            if (!r) continue;
            now[count] = 100 * s.melted, then[count] = 100 * r->melted, ++count;
        }
        if (count > 1) {
            const float most =
                std::max({1e-3f, *std::max_element(now, now + count), *std::max_element(then, then + count)});
            const ImVec2 at = ImGui::GetCursorPos(), size(ImGui::GetContentRegionAvail().x, 4 * ImGui::GetFontSize());
            ImGui::PushStyleColor(ImGuiCol_PlotLines, ImVec4(0.6f, 0.6f, 0.6f, 1));
            ImGui::PlotLines("##reference", then, count, 0, nullptr, 0, most, size);
            ImGui::PopStyleColor();
            ImGui::SetCursorPos(at);
            ImGui::PushStyleColor(ImGuiCol_FrameBg, ImVec4(0, 0, 0, 0));
            ImGui::PushStyleColor(ImGuiCol_PlotLines, ImVec4(1, 0.65f, 0.25f, 1));
            ImGui::PlotLines("##molten", now, count, 0, "molten: now, and reference (grey)", 0, most, size);
            ImGui::PopStyleColor(2);
        }
    } else {
        ui::quietf("the reference ends at %.1f s", double(reference->rows.back().time));
    }
    if (ui::button(reference ? "Make it again##make reference" : "Make a reference##make reference"))
        studio.makeReference();
    ui::tip("Runs the scene with the finest particles and many iterations, which takes some minutes, and stores what "
            "melts when "
            "beside the scene.");
}

} // namespace

void showPlan(Studio& studio) {
    const Frame& f = studio.frame();
    const thawCounters& c = f.counters;
    const thawWork& w = f.plan.work;
    if (!f.built) return ui::quiet("no world");
    ui::value("levels", "%d / %d / %d / %d", c.levels[0], c.levels[1], c.levels[2], c.levels[3]);
    ui::tip("Particles of 1, 2, 4 and 8 times the finest mass.");
    ui::value("sub-steps", "%d (%d to %d)", c.subSteps, w.leastSubSteps, w.subSteps);
    ui::value("pressure", "%d iterations", w.pressureIterations);
    ui::value("viscosity", "%d of %d iterations", c.viscosityIterations, w.viscosityIterations);
    ui::value("rays", "%d, %.0f %% anew", c.rays, double(100 * w.rayRefresh));
    ui::value("heat", "every %d. step, %d cycles", w.heatInterval, w.heatCycles);
    ui::value("finest, coarsest", "%d, %d", w.finestLevel, w.coarsestLevel);
    ui::value("predicted", "%.2f ms on %d threads", double(f.plan.predictedMs), f.plan.workers);
    ui::value("molten", "%.2f %%", double(100 * c.meltedFraction));
    ui::value("compression", "%.1f %% mean, %.1f %% most", double(100 * c.meanCompression),
              double(100 * c.maxCompression));
    ui::tip("Error of the density of what moves: what the budget costs in accuracy, now.");
    ui::value("mass error", "%.1e", f.ledger.massError);
    ui::value("energy error", "%.1e", f.ledger.energyError);
    const uint32_t status = f.steps.size() ? f.steps.newest().status : 0;
    for (uint32_t bit = 1; bit; bit <<= 1)
        if (status & bit) {
            ImGui::PushTextWrapPos(0);
            ImGui::TextColored({1, 0.7f, 0.4f, 1}, "%s", thawStepStatusString(bit));
            ImGui::PopTextWrapPos();
        }
    if (ui::section("Accuracy")) accuracy(studio);
    if (ui::section("Why each stage runs##stages", false))
        for (int s = 0; s < int(thawStage_count); ++s) {
            ui::field(thawStageName(thawStage(s)));
            if (f.plan.enabled[s])
                ImGui::Text("%.2f ms", double(f.steps.size() ? f.steps.newest().profile.stage[s] : 0));
            else
                ui::quiet(thawReasonString(f.plan.reason[s]));
        }
}

} // namespace thaw::editor
