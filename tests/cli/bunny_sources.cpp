// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "../../samples/player/mesh_bunny.cpp" // NOLINT(bugprone-suspicious-include)
