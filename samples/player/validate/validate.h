// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <string>
#include <vector>

// Cases with known answers, run through the public header alone: what `thaw validate` prints.
namespace thaw::player {

// One row: what was asked and what came out.
struct Check {
    enum Kind { kWithin, kAtMost, kAtLeast };
    std::string what; // with the unit, e.g. "surface speed, m/s"
    Kind kind;
    double expected, got;
    double error;     // kWithin: |got - expected| / |expected|; else how far over the limit, 0 when inside
    double tolerance; // kWithin: of error; else 0
    bool ok;
};

class Findings {
public:
    // got within `tolerance` (relative) of a theory's value, which must not be 0.
    void within(const std::string& what, double expected, double got, double tolerance);
    void atMost(const std::string& what, double limit, double got);
    void atLeast(const std::string& what, double limit, double got);
    const std::vector<Check>& checks() const { return checks_; }

private:
    std::vector<Check> checks_;
};

struct ValidationCase {
    const char* name; // lower case with hyphens
    const char* what; // one line: set-up and source of the expected value
    void (*run)(Findings&);
};

// Where the sample scenes are: --scenes, or where they lay when this was built.
const std::string& scenesFolder();

// One list per file; validate.cpp puts them together.
using CaseList = std::vector<ValidationCase>;
CaseList liquidCases();
CaseList levelCases();
CaseList colliderCases();
CaseList materialCases();
CaseList impactCases();
CaseList filmCases();
CaseList heldCases();
CaseList softCases();
CaseList softContactCases();
CaseList softFrictionCases();
CaseList rigidCases();
CaseList pieceCases();
CaseList conductionCases();
CaseList heatLevelCases();
CaseList radiationCases();
CaseList stefanCases();
CaseList surfaceCases();
CaseList undercoolingCases();
CaseList pathCases();
CaseList shapeCases();
CaseList meshCases();
CaseList sceneCases();

} // namespace thaw::player
