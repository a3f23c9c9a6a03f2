// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/panels.h"
#include "app/widgets.h"

#include <algorithm>
#include <cmath>

namespace thaw::editor {

void showTransport(Studio& studio) {
    const Frame& f = studio.frame();
    if (ui::button(studio.playing() ? "Pause##play" : "Play##play", {4.2f * ImGui::GetFontSize(), 0}))
        studio.play(!studio.playing());
    ui::tip("Runs the scene. Whatever you change takes effect in the next frame.", "Space");
    ImGui::SameLine();
    if (ui::button("Step")) studio.stepOnce();
    ui::tip("One frame of 1/60 s.", "Right arrow");
    ImGui::SameLine();
    if (ui::button("Reset")) studio.reset();
    ui::tip("Back to the start, as it would be loaded.", "Home");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(6 * ImGui::GetFontSize());
    float speed = 100 * studio.orders().speed;
    if (ImGui::SliderFloat("##speed", &speed, 5, 100, "%.0f %% speed", ImGuiSliderFlags_AlwaysClamp))
        studio.orders().speed = speed / 100;
    ui::note("speed");
    ui::tip("Slow motion: the game against the clock.");
    ImGui::SameLine();
    bool loop = studio.orders().loopAt > 0;
    ui::toggle("loop", &loop);
    studio.orders().loopAt = loop ? studio.scene().defaults.seconds : 0;
    ui::tip("Starts again when the scene's length is over (World: length).");
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::Text("%6.2f s", f.time);
    ui::beside("", 14 * ImGui::GetFontSize());

    // The scrubber: what has been run can be gone back to.
    int64_t at = f.frame;
    const int64_t low = f.oldest, high = std::max(f.newest, f.oldest);
    ImGui::SetNextItemWidth(-1);
    char text[64];
    std::snprintf(text, sizeof text, "frame %lld of %lld%s", static_cast<long long>(at), static_cast<long long>(high),
                  f.working ? " ..." : "");
    if (ImGui::SliderScalar("##scrub", ImGuiDataType_S64, &at, &low, &high, text) && at != f.frame) studio.seek(at);
    ui::note("scrub");
    ui::tip("Goes back and forth through what has been run.", "Left and right arrow: a frame");
}

void showStatus(Studio& studio) {
    const Studio::Notice& notice = studio.notice();
    if (!notice.text.empty())
        ImGui::TextColored(notice.bad ? ImVec4(1, 0.55f, 0.45f, 1) : ImVec4(0.7f, 0.95f, 0.7f, 1), "%s",
                           notice.text.c_str());
    else
        ui::quiet(ToolKit::help(studio.tool));
}

} // namespace thaw::editor
