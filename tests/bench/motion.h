// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

// `thaw bench motion`: what the motion of a liquid costs a particle, stage by stage, beside the density pass. argv[0]
// is the name; see --help for the rest. Returns an exit code.
int thawBenchMotion(int argc, char** argv);
