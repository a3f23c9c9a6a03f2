// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "player.h"

#include <doctest/doctest.h>

#include <set>

using namespace thaw::test;

TEST_CASE("every view is another picture of the same melt, and takes nothing along to the next") {
    const Folder folder;
    std::string text = replaced(kSmallScene, "\"heatSources\"",
                                "\"paths\": [{\"points\": [[0, 0.04, 0], [0.03, 0.02, 0], [0.03, 0, 0.02]], "
                                "\"radius\": 0.006}],\n  \"heatSources\"");
    text = replaced(text, "\"temperature\": 300}",
                    "\"temperature\": 300, \"coarsestLevel\": 3, \"paint\": [{\"position\": [0, 0.03, 0.015], "
                    "\"radius\": 0.012, \"absorptivity\": 0.1}]}");
    const std::string scene = folder.write("s.json", text), out = folder.path("o");
    // In two orders: what one of them leaves behind would change the other.
    const std::vector<std::string> views{"shaded",    "temperature", "phase", "liquid",   "control",  "splats",
                                         "particles", "level",       "elfs",  "velocity", "exposure", "absorptivity"};
    std::string forth, back;
    for (size_t i = 0; i < views.size(); ++i) {
        forth += (i ? "," : "") + views[i];
        back += (i ? "," : "") + views[views.size() - 1 - i];
    }
    const auto take = [&](const std::string& names, const std::string& to) {
        const Answer answer = player({"capture", scene, "--at", "0.2", "--size", "160x120", "--view", names, "--out",
                                      folder.path(to), "--quiet"});
        CAPTURE(answer.err);
        REQUIRE(answer.exitCode == 0);
        std::vector<std::string> pictures;
        for (size_t i = 0; i < views.size(); ++i) {
            const std::string number = (i < 10 ? "00" : "0") + std::to_string(i);
            pictures.push_back(readFile(folder.path(to) + "/capture_" + number + ".png"));
            REQUIRE(pictures.back().size() > 1000);
        }
        return pictures;
    };
    const std::vector<std::string> first = take(forth, "a"), second = take(back, "b");
    CHECK(std::set<std::string>(first.begin(), first.end()).size() == views.size());
    for (size_t i = 0; i < views.size(); ++i) CHECK_MESSAGE(first[i] == second[views.size() - 1 - i], views[i]);
    // What is asked for wrongly is told all names.
    const Answer wrong = player({"capture", scene, "--out", out, "--view", "xray"});
    CHECK(wrong.exitCode == 2);
    for (const std::string& view : views) CHECK_MESSAGE(contains(wrong.err, view), view);
}
