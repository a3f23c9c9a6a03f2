// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

// `thaw bench kicks`: what one split or merge does to a liquid at rest. argv[0] is the name; see --help for the rest.
// Returns an exit code.
int thawBenchKicks(int argc, char** argv);
