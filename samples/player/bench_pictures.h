// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

namespace thaw::player {

void addBenchPictures(CLI::App& bench, int& exitCode);

} // namespace thaw::player
