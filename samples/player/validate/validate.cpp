// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "validate/validate.h"

#include "args.h"
#include "report.h"
#include "validate/lab.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <unistd.h>

namespace thaw::player {
namespace {

std::string scenesPlace = THAW_SCENES_DIR;

struct Suite {
    const char* name;
    const char* what;
    std::vector<CaseList> lists;
};

std::vector<Suite> suites() {
    return {
        {"motion",
         "liquids, solids and colliders at one step per frame",
         {liquidCases(), levelCases(), filmCases(), heldCases(), impactCases(), colliderCases(), materialCases(),
          softCases(), softContactCases(), softFrictionCases(), rigidCases(), pieceCases()}},
        {"heat",
         "conduction, contact, phase change, radiation and loss",
         {conductionCases(), stefanCases(), radiationCases(), surfaceCases(), heatLevelCases(), undercoolingCases()}},
        {"control", "where paths and shapes take the melt", {pathCases(), shapeCases()}},
        {"surface", "the mesh of what melts", {meshCases(), sceneCases()}}};
}

struct Options {
    std::string suite, out;
    std::vector<std::string> cases;
    bool list = false, quiet = false;
};

const char* limitText(Check::Kind kind) { return kind == Check::kWithin ? "" : kind == Check::kAtMost ? "<= " : ">= "; }

int validate(const Options& o) {
    const std::vector<Suite> all = suites();
    const auto suite = std::find_if(all.begin(), all.end(), [&](const Suite& s) { return o.suite == s.name; });
    if (suite == all.end()) {
        std::string known;
        for (const Suite& s : all) known += (known.empty() ? "" : ", ") + std::string(s.name);
        throw scene::InputError("validate: unknown suite '" + scene::oneLine(o.suite, 40) + "' (known: " + known + ")");
    }
    CaseList cases;
    for (const CaseList& list : suite->lists) cases.insert(cases.end(), list.begin(), list.end());
    if (o.list) {
        for (const ValidationCase& c : cases) std::printf("%-28s %s\n", c.name, c.what);
        return kExitOk;
    }
    // A name picks the case, or all that begin with it.
    const auto picks = [](const std::string& wanted, const ValidationCase& c) {
        return std::string(c.name).compare(0, wanted.size(), wanted) == 0;
    };
    for (const std::string& wanted : o.cases)
        if (std::none_of(cases.begin(), cases.end(), [&](const ValidationCase& c) { return picks(wanted, c); }))
            throw scene::InputError("validate: no case '" + scene::oneLine(wanted, 40) + "' (see --list)");
    std::ofstream csv;
    if (!o.out.empty()) {
        csv.open(o.out, std::ios::binary);
        if (!csv) throw RunError(scene::oneLine(o.out, 400) + ": cannot be written");
        csv << "case,what,limit,expected,got,error,tolerance,ok\n";
    }
    std::printf("%-26s %-46s %13s %12s %9s %9s\n", "case", "what", "expected", "got", "error", "tolerance");
    int rows = 0, out = 0;
    const auto start = std::chrono::steady_clock::now();
    for (const ValidationCase& c : cases) {
        if (!o.cases.empty() &&
            std::none_of(o.cases.begin(), o.cases.end(), [&](const std::string& wanted) { return picks(wanted, c); }))
            continue;
        const bool tell = !o.quiet && isatty(STDERR_FILENO);
        if (tell) std::fprintf(stderr, "\r%s ...\033[K", c.name);
        Findings found;
        std::string failure;
        try {
            c.run(found);
        } catch (const LabError& e) {
            failure = e.what();
        } catch (const scene::InputError& e) {
            failure = e.what();
        }
        if (tell) std::fprintf(stderr, "\r\033[K");
        const char* name = c.name;
        for (const Check& k : found.checks()) {
            const std::string expected = formatted("%s%.4g", limitText(k.kind), k.expected);
            const std::string tolerance = k.kind == Check::kWithin ? formatted("%.2f%%", 100 * k.tolerance) : "";
            std::printf("%-26s %-46s %13s %12.4g %8.2f%% %9s%s\n", name, k.what.c_str(), expected.c_str(), k.got,
                        100 * k.error, tolerance.c_str(), k.ok ? "" : "  OUT");
            if (csv)
                csv << c.name << ",\"" << k.what << "\","
                    << (k.kind == Check::kWithin   ? "within"
                        : k.kind == Check::kAtMost ? "at most"
                                                   : "at least")
                    << formatted(",%.9g,%.9g,%.6g,%.6g,%d\n", k.expected, k.got, k.error, k.tolerance, int(k.ok));
            name = "";
            ++rows, out += !k.ok;
        }
        if (!failure.empty() || found.checks().empty()) {
            std::printf("%-26s could not be run: %s  OUT\n", c.name,
                        failure.empty() ? "it found nothing" : scene::oneLine(failure, 300).c_str());
            ++rows, ++out;
        }
        std::fflush(stdout);
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::printf("%d rows, %d out, %.0f s\n", rows, out, seconds);
    if (csv && !csv.flush()) throw RunError(scene::oneLine(o.out, 400) + ": cannot be written");
    return out ? kExitFailed : kExitOk;
}

} // namespace

const std::string& scenesFolder() { return scenesPlace; }

void Findings::within(const std::string& what, double expected, double got, double tolerance) {
    const double error = std::abs(got - expected) / std::abs(expected);
    checks_.push_back({what, Check::kWithin, expected, got, error, tolerance, error <= tolerance});
}

void Findings::atMost(const std::string& what, double limit, double got) {
    const double over = got > limit ? (got - limit) / std::max(std::abs(limit), 1e-300) : 0;
    checks_.push_back({what, Check::kAtMost, limit, got, over, 0, got <= limit});
}

void Findings::atLeast(const std::string& what, double limit, double got) {
    const double under = got < limit ? (limit - got) / std::max(std::abs(limit), 1e-300) : 0;
    checks_.push_back({what, Check::kAtLeast, limit, got, under, 0, got >= limit});
}

void addValidate(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand(
        "validate", "Run cases with known answers and print expected, got, error and tolerance; 1 when any is out");
    auto o = std::make_shared<Options>();
    command->add_option("suite", o->suite, "motion, heat, control or surface")->required();
    command->add_option("case", o->cases, "Only these cases, or those whose names begin so");
    command->add_option("--scenes", scenesPlace, "Folder of the sample scenes, for surface")->capture_default_str();
    command->add_flag("--list", o->list, "Name the cases and what they are");
    command->add_option("--out", o->out, "CSV file for the rows as well");
    command->add_flag("--quiet", o->quiet, "No progress");
    command->callback([=, &exitCode] { exitCode = validate(*o); });
}

} // namespace thaw::player
