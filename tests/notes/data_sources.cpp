// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// The table in third_party_notes/data_sources.md and the presets of the library are the same numbers.
#include "thaw/thaw.h"

#include <doctest/doctest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace {

std::vector<std::string> cellsOf(const std::string& line) {
    std::vector<std::string> cells;
    std::stringstream stream(line);
    std::string cell;
    std::getline(stream, cell, '|');
    while (std::getline(stream, cell, '|')) {
        const size_t first = cell.find_first_not_of(' ');
        cells.push_back(first == std::string::npos ? "" : cell.substr(first, cell.find_last_not_of(' ') - first + 1));
    }
    return cells;
}

const std::map<std::string, float thawMaterialDef::*> kFields = {
    {"density", &thawMaterialDef::density},
    {"solidus", &thawMaterialDef::solidus},
    {"liquidus", &thawMaterialDef::liquidus},
    {"latentHeat", &thawMaterialDef::latentHeat},
    {"specificHeatSolid", &thawMaterialDef::specificHeatSolid},
    {"specificHeatLiquid", &thawMaterialDef::specificHeatLiquid},
    {"conductivitySolid", &thawMaterialDef::conductivitySolid},
    {"conductivityLiquid", &thawMaterialDef::conductivityLiquid},
    {"viscositySolid", &thawMaterialDef::viscositySolid},
    {"viscosityLiquid", &thawMaterialDef::viscosityLiquid},
    {"yieldStress", &thawMaterialDef::yieldStress},
    {"absorptivity", &thawMaterialDef::absorptivity},
    {"emissivity", &thawMaterialDef::emissivity},
};

} // namespace

TEST_CASE("presets are the numbers of data_sources.md") {
    std::ifstream file(THAW_SOURCE_DIR "/third_party_notes/data_sources.md");
    REQUIRE(file.is_open());
    std::string line;
    while (std::getline(file, line) && line.rfind("| preset |", 0) != 0) {
    }
    const std::vector<std::string> head = cellsOf(line);
    REQUIRE(head.size() == kFields.size() + 1);
    std::getline(file, line);

    int rows = 0;
    for (; std::getline(file, line) && line.rfind("|", 0) == 0; ++rows) {
        const std::vector<std::string> cells = cellsOf(line);
        REQUIRE(cells.size() == head.size());
        REQUIRE(rows < thawMaterial_presetCount);
        const auto preset = static_cast<thawMaterialPreset>(rows);
        CHECK(cells[0] == thawMaterialPresetName(preset));
        thawMaterialDef def;
        thawInitMaterialDef(&def, preset);
        for (size_t i = 1; i < head.size(); ++i) {
            CAPTURE(cells[0]);
            CAPTURE(head[i]);
            REQUIRE(kFields.count(head[i]) == 1);
            CHECK(def.*kFields.at(head[i]) == std::stof(cells[i]));
        }
    }
    CHECK(rows == thawMaterial_presetCount);
}
