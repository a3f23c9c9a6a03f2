// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "report.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace thaw::player {

namespace {
// The library's promise is a ledger that closes to 1e-5 over a run of seconds; ten times that is called a fault.
constexpr double kMassTolerance = 1e-6, kEnergyTolerance = 1e-4;

std::string planText(const thawPlan& plan) {
    const thawWork& w = plan.work;
    return formatted("at most %d sub-steps, %d pressure, %d viscosity, heat every %d, rays %.2f", w.subSteps,
                     w.pressureIterations, w.viscosityIterations, w.heatInterval, double(w.rayRefresh));
}
} // namespace

std::string budgetText(const thawBudget& budget) {
    switch (budget.mode) {
    case thawBudget_milliseconds:
        return formatted("budget %g ms", double(budget.milliseconds));
    case thawBudget_units:
        return formatted("budget %g units", double(budget.units));
    default:
        return "fixed work";
    }
}

double Report::heatShare() const {
    double all = 0, heat = 0;
    for (int s = 0; s < thawStage_count; ++s) all += stageMs_[s];
    for (const thawStage s : {thawStage_radiation, thawStage_conduction, thawStage_loss, thawStage_phase})
        heat += stageMs_[s];
    return all > 0 ? heat / all : 0;
}

std::string formatted(const char* format, ...) {
    char text[512];
    va_list list;
    va_start(list, format);
    std::vsnprintf(text, sizeof text, format, list);
    va_end(list);
    return text;
}

std::string hashText(uint64_t hash) { return formatted("0x%016llx", static_cast<unsigned long long>(hash)); }

std::string statusWords(uint32_t status) {
    std::string out;
    for (uint32_t bit = 1; bit; bit <<= 1) {
        if (!(status & bit)) continue;
        const std::string words = thawStepStatusString(bit);
        out += (out.empty() ? "" : "; ") + (words.empty() ? "bit " + std::to_string(bit) : words);
    }
    return out.empty() ? "nothing" : out;
}

void Report::addStep(const thawWorld* world, double ms, uint32_t status) {
    milliseconds_.push_back(ms);
    lastStatus_ = status;
    for (size_t b = 0; b < 32; ++b) statusCounts_[b] += (status >> b) & 1u;
    thawWorld_GetProfile(world, &profile_);
    thawWorld_GetPlan(world, &plan_);
    thawWorld_GetCounters(world, &counters_);
    for (size_t s = 0; s < thawStage_count; ++s) {
        stageMs_[s] += double(profile_.stage[s]);
        stageRuns_[s] += plan_.enabled[s];
    }
    subSteps_ += counters_.subSteps;
    pressure_ += counters_.pressureIterations;
    viscosity_ += counters_.viscosityIterations;
    rays_ += counters_.rays;
    mostSubSteps_ = std::max(mostSubSteps_, counters_.subSteps);
    mostPressure_ = std::max(mostPressure_, counters_.pressureIterations);
    mostViscosity_ = std::max(mostViscosity_, counters_.viscosityIterations);
}

void Report::finish(const thawWorld* world) {
    thawWorld_GetCounters(world, &counters_);
    thawWorld_GetLedger(world, &ledger_);
    thawWorld_GetPlan(world, &plan_);
    hash_ = thawWorld_GetStateHash(world);
}

double percentile(std::vector<double> values, double share) {
    if (values.empty()) return 0.0;
    std::sort(values.begin(), values.end());
    const double rank = std::ceil(share * double(values.size()));
    return values[std::min(values.size(), size_t(std::max(rank, 1.0))) - 1];
}

double Report::percentile(double share) const { return player::percentile(milliseconds_, share); }

size_t Report::framesOver() const {
    return size_t(
        std::count_if(milliseconds_.begin(), milliseconds_.end(), [&](double ms) { return ms > double(limitMs); }));
}

uint32_t Report::statusUnion() const {
    uint32_t all = 0;
    for (size_t b = 0; b < 32; ++b) all |= statusCounts_[b] ? 1u << b : 0u;
    return all;
}

std::vector<std::string> Report::faults() const {
    std::vector<std::string> out;
    // Negated so that NaN is a fault too.
    if (!(ledger_.massError <= kMassTolerance))
        out.push_back(formatted("mass error %.3g is above %.0e", ledger_.massError, kMassTolerance));
    if (!(ledger_.energyError <= kEnergyTolerance))
        out.push_back(formatted("energy error %.3g is above %.0e", ledger_.energyError, kEnergyTolerance));
    const uint32_t status = statusUnion();
    if (status & thawStep_refused) out.push_back("a step was refused");
    if (status & thawStep_badParticlesRemoved) out.push_back("particles became not finite and were removed");
    return out;
}

std::string Report::table() const {
    const size_t n = std::max<size_t>(steps(), 1);
    const thawCounters& c = counters_;
    std::string out =
        formatted("%s: %zu steps of 1/60 s, %d thread%s, ", name.c_str(), steps(), threads, threads == 1 ? "" : "s");
    out += budgetText(budget) + "\n";
    out += formatted("  particles      %d  (%d moving, %d at the surface), %.1f MB\n", c.particles, c.moving, c.surface,
                     double(c.memoryBytes) / 1e6);
    out += formatted("  melted         %.1f %%  (%.1f to %.1f K)\n", 100.0 * double(c.meltedFraction),
                     double(c.minTemperature), double(c.maxTemperature));
    out += formatted("  step           p50 %.2f  p95 %.2f  p99 %.2f  max %.2f ms  (the first, %.2f ms, is counted)\n",
                     percentile(0.5), percentile(0.95), percentile(0.99), percentile(1.0),
                     milliseconds_.empty() ? 0.0 : milliseconds_.front());
    out += formatted("  over %-9s %zu of %zu frames (%.2f %%)\n", formatted("%g ms", double(limitMs)).c_str(),
                     framesOver(), steps(), 100.0 * double(framesOver()) / double(n));
    out += formatted("  mass error     %.2e\n", ledger_.massError);
    out += formatted("  energy error   %.2e  (absorbed %.4g J, by contact %.4g J, emitted %.4g J, convected %.4g J)\n",
                     ledger_.energyError, ledger_.absorbed, ledger_.contact, ledger_.emitted, ledger_.convected);
    const auto after = [](float seconds, const char* verb) {
        return seconds >= 0 ? formatted(", %s after %.2f s", verb, double(seconds)) : std::string();
    };
    for (const PathNote& p : paths)
        out +=
            formatted("  path %-9s led %.3g g, of which %.3g g arrived and %.3g g got lost; %.2g mm from it on average",
                      p.name.c_str(), 1e3 * double(p.state.captured), 1e3 * double(p.state.arrived),
                      1e3 * double(p.state.spilled), 1e3 * double(p.state.meanDistance)) +
            after(p.state.arrivalTime, "arrived") + "\n";
    for (const ShapeNote& s : shapes)
        out += formatted("  shape %-8s %.1f %% filled with %.3g g, of which %.3g g has set; %.3g g outside",
                         s.name.c_str(), 100.0 * double(s.state.fill), 1e3 * double(s.state.inside),
                         1e3 * double(s.state.set), 1e3 * double(s.state.spilled)) +
               after(s.state.filledAfter, "full") + "\n";
    if (ledger_.controlHeat > 0) out += formatted("  control        took %.4g J until it set\n", ledger_.controlHeat);
    out += formatted("  compression    %.2f %% mean, %.2f %% most; fastest %.2f m/s; solved with up to %.3g Pa s\n",
                     100.0 * double(c.meanCompression), 100.0 * double(c.maxCompression), double(c.maxSpeed),
                     double(c.apparentViscosity));
    out += "  work a step    ";
    out += formatted("%.1f sub-steps (most %d), %.1f pressure (%d), %.1f viscosity (%d), %.0f rays\n",
                     subSteps_ / double(n), mostSubSteps_, pressure_ / double(n), mostPressure_, viscosity_ / double(n),
                     mostViscosity_, rays_ / double(n));
    bool any = false;
    for (size_t b = 0; b < 32; ++b) {
        if (!statusCounts_[b]) continue;
        out += formatted("  %-14s %zu frames: ", any ? "" : "gave up", statusCounts_[b]) + statusWords(1u << b) + "\n";
        any = true;
    }
    if (!any) out += "  gave up        nothing\n";
    out += "  last plan      " + planText(plan_) + "\n";
    std::string off;
    for (int s = 0; s < thawStage_count; ++s)
        if (!plan_.enabled[s])
            off += (off.empty() ? "" : ", ") + std::string(thawStageName(thawStage(s))) + " (" +
                   thawReasonString(plan_.reason[s]) + ")";
    if (!off.empty()) out += "  stages off     " + off + "\n";
    out += "  state hash     " + hashText(hash_) + "\n";
    const std::vector<std::string> wrong = faults();
    out += "  check          ";
    if (wrong.empty()) out += "ok\n";
    for (size_t i = 0; i < wrong.size(); ++i) out += (i ? "                 " : "FAILED: ") + wrong[i] + "\n";
    return out;
}

std::string Report::json() const {
    using Json = nlohmann::ordered_json;
    const size_t n = std::max<size_t>(steps(), 1);
    const thawCounters& c = counters_;
    Json root;
    root["thawReport"] = 1;
    root["library"] = {{"version", thawGetVersion()}, {"build", thawGetBuildString()}};
    root["scene"] = name;
    root["steps"] = steps();
    root["threads"] = threads;
    const char* const modes[] = {"work", "milliseconds", "units"};
    root["budget"] = {{"mode", modes[budget.mode]},
                      {"milliseconds", budget.milliseconds},
                      {"units", budget.units},
                      {"limitMilliseconds", limitMs}};
    root["particles"] = {{"count", c.particles},
                         {"moving", c.moving},
                         {"fixed", c.fixed},
                         {"surface", c.surface},
                         {"capacity", c.capacity}};
    root["memoryBytes"] = c.memoryBytes;
    root["meltedFraction"] = c.meltedFraction;
    root["temperature"] = {{"min", c.minTemperature}, {"max", c.maxTemperature}};
    root["stepMilliseconds"] = {{"p50", percentile(0.5)},
                                {"p95", percentile(0.95)},
                                {"p99", percentile(0.99)},
                                {"max", percentile(1.0)},
                                {"first", milliseconds_.empty() ? 0.0 : milliseconds_.front()}};
    root["framesOver"] = framesOver();
    root["framesOverShare"] = double(framesOver()) / double(n);
    Json stages;
    for (size_t s = 0; s < thawStage_count; ++s)
        stages[thawStageName(thawStage(s))] = {{"meanMilliseconds", stageMs_[s] / double(n)},
                                               {"steps", stageRuns_[s]},
                                               {"lastReason", thawReasonString(plan_.reason[s])}};
    root["stages"] = stages;
    root["work"] = {{"subSteps", {{"mean", subSteps_ / double(n)}, {"most", mostSubSteps_}}},
                    {"pressureIterations", {{"mean", pressure_ / double(n)}, {"most", mostPressure_}}},
                    {"viscosityIterations", {{"mean", viscosity_ / double(n)}, {"most", mostViscosity_}}},
                    {"rays", {{"mean", rays_ / double(n)}}}};
    root["lastPlan"] = {{"subSteps", plan_.work.subSteps},
                        {"pressureIterations", plan_.work.pressureIterations},
                        {"viscosityIterations", plan_.work.viscosityIterations},
                        {"heatInterval", plan_.work.heatInterval},
                        {"heatCycles", plan_.work.heatCycles},
                        {"rayRefresh", plan_.work.rayRefresh},
                        {"raysPerSource", plan_.work.raysPerSource},
                        {"finestLevel", plan_.work.finestLevel},
                        {"coarsestLevel", plan_.work.coarsestLevel},
                        {"splits", plan_.work.splits},
                        {"surfaceLevel", plan_.work.surfaceLevel},
                        {"lateAfter", plan_.work.lateAfter},
                        {"predictedMilliseconds", plan_.predictedMs},
                        {"units", plan_.units},
                        {"workers", plan_.workers}};
    root["motion"] = {{"maxSpeed", c.maxSpeed},
                      {"maxCompression", c.maxCompression},
                      {"meanCompression", c.meanCompression},
                      {"apparentViscosity", c.apparentViscosity}};
    root["ledger"] = {
        {"massBurnt", ledger_.massBurnt}, {"massError", ledger_.massError}, {"energyError", ledger_.energyError},
        {"massNow", ledger_.massNow},     {"energyNow", ledger_.energyNow}, {"absorbed", ledger_.absorbed},
        {"contact", ledger_.contact},     {"emitted", ledger_.emitted},     {"convected", ledger_.convected}};
    const Json impulse = {ledger_.controlImpulse[0], ledger_.controlImpulse[1], ledger_.controlImpulse[2]};
    root["ledger"]["controlImpulse"] = impulse;
    root["ledger"]["controlEnergy"] = ledger_.controlEnergy, root["ledger"]["controlHeat"] = ledger_.controlHeat;
    const auto time = [](float seconds) { return seconds >= 0 ? Json(seconds) : Json(nullptr); };
    for (const PathNote& p : paths)
        root["paths"].push_back({{"name", p.name},
                                 {"length", p.state.length},
                                 {"mass", p.state.mass},
                                 {"captured", p.state.captured},
                                 {"arrived", p.state.arrived},
                                 {"spilled", p.state.spilled},
                                 {"meanDistance", p.state.meanDistance},
                                 {"front", p.state.front},
                                 {"arrivalTime", time(p.state.arrivalTime)},
                                 {"speed", p.state.speed}});
    for (const ShapeNote& s : shapes)
        root["shapes"].push_back({{"name", s.name},
                                  {"size", s.state.size},
                                  {"mass", s.state.mass},
                                  {"inside", s.state.inside},
                                  {"spilled", s.state.spilled},
                                  {"set", s.state.set},
                                  {"captured", s.state.captured},
                                  {"lost", s.state.lost},
                                  {"meanDistance", s.state.meanDistance},
                                  {"fill", s.state.fill},
                                  {"level", s.state.level},
                                  {"filledAfter", time(s.state.filledAfter)}});
    Json status = Json::array();
    for (size_t b = 0; b < 32; ++b)
        if (statusCounts_[b])
            status.push_back({{"bit", 1u << b}, {"frames", statusCounts_[b]}, {"meaning", statusWords(1u << b)}});
    root["status"] = status;
    root["stateHash"] = hashText(hash_);
    root["faults"] = faults();
    return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string Report::csvHeader() const {
    std::string out =
        "frame,time,ms,predicted_ms,status,particles,moving,surface,melted,sub_steps,pressure,viscosity,rays,"
        "max_speed,max_compression,max_temperature,level0,level1,level2,level3,splits,merges,"
        "plan_sub_steps,plan_least_sub_steps,plan_pressure,plan_viscosity,plan_heat_interval,plan_heat_cycles,"
        "plan_ray_refresh,plan_rays_per_source,plan_finest_level,plan_coarsest_level,plan_splits,plan_late_after,"
        "plan_units,plan_workers";
    for (int s = 0; s < thawStage_count; ++s) out += ",ms_" + std::string(thawStageName(thawStage(s)));
    return out + "\n";
}

std::string Report::csvLine() const {
    const thawCounters& c = counters_;
    std::string out =
        formatted("%zu,%.6g,%.4f,%.4f,%u,%d,%d,%d,%.6g,%d,%d,%d,%d,%.6g,%.6g,%.6g,%d,%d,%d,%d,%d,%d", steps(), c.time,
                  milliseconds_.empty() ? 0.0 : milliseconds_.back(), double(plan_.predictedMs), lastStatus_,
                  c.particles, c.moving, c.surface, double(c.meltedFraction), c.subSteps, c.pressureIterations,
                  c.viscosityIterations, c.rays, double(c.maxSpeed), double(c.maxCompression), double(c.maxTemperature),
                  c.levels[0], c.levels[1], c.levels[2], c.levels[3], c.splits, c.merges);
    const thawWork& w = plan_.work;
    out +=
        formatted(",%d,%d,%d,%d,%d,%d,%.4g,%d,%d,%d,%d,%d,%.0f,%d", w.subSteps, w.leastSubSteps, w.pressureIterations,
                  w.viscosityIterations, w.heatInterval, w.heatCycles, double(w.rayRefresh), w.raysPerSource,
                  w.finestLevel, w.coarsestLevel, w.splits, w.lateAfter, double(plan_.units), plan_.workers);
    for (float ms : profile_.stage) out += formatted(",%.4f", double(ms));
    return out + "\n";
}

} // namespace thaw::player
