// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "app/report.h"

#include "app/app.h"
#include "app/toolkit.h"

#include <cstdio>

namespace thaw::editor {

std::string reportOf(const App& app) {
    std::string text;
    for (const auto& [name, p] : app.controls().all())
        if (app.controls().still(name, p))
            text += std::to_string(int(p.x)) + " " + std::to_string(int(p.y)) + " " + std::to_string(int(p.width)) +
                    " " + std::to_string(int(p.height)) + " " + name + "\n";
    const auto state = [&](const char* name, const std::string& value) {
        text += std::string("0 0 0 0 state ") + name + " " + scene::oneLine(value, 300) + "\n";
    };
    const auto number = [&](const char* name, double value) {
        char digits[40];
        std::snprintf(digits, sizeof digits, "%.9g", value);
        state(name, digits);
    };
    const auto yes = [&](const char* name, bool is) { state(name, is ? "yes" : "no"); };
    const Studio& s = app.studio();
    const Frame& f = s.frame();
    number("frame", double(f.frame));
    yes("playing", s.playing());
    yes("up-to-date", f.revision == s.document().revision() && f.resets == s.orders().resets);
    yes("sharp", app.viewport().sharp());
    yes("saved", !s.document().unsaved());
    state("file", s.document().path());
    state("tool", toolName(s.tool));
    state("chosen", s.selection() ? kindName(s.selection().kind) : "nothing");
    number("bodies", double(s.scene().bodies.size()));
    number("paths", double(s.scene().paths.size()));
    number("shapes", double(s.scene().shapes.size()));
    number("sources", double(s.scene().heatSources.size()));
    number("particles", f.counters.particles);
    number("melted", double(f.counters.meltedFraction));
    double captured = 0;
    for (const thawPathState& path : f.paths) captured += double(path.captured);
    number("captured", captured); // kg
    yes("typing", ImGui::GetIO().WantTextInput);
    state("undo", s.document().undoText());
    state("redo", s.document().redoText());
    state("error", f.error);
    state("complaint", s.complaints.empty() ? std::string() : s.complaints.front().text);
    state("size",
          std::to_string(int(ImGui::GetIO().DisplaySize.x)) + "x" + std::to_string(int(ImGui::GetIO().DisplaySize.y)));
    return text;
}

void writeReport(const App& app, const std::string& file, std::string& last) {
    std::string text = reportOf(app);
    if (text == last) return;
    try {
        scene::saveText(text, file);
        last = std::move(text);
    } catch (const std::exception&) {
        // The next frame tries again.
    }
}

} // namespace thaw::editor
