// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

namespace thaw::player {

void addBenchLevels(CLI::App& bench, int& exitCode);
void addBenchBudget(CLI::App& bench, int& exitCode); // and rest

} // namespace thaw::player
