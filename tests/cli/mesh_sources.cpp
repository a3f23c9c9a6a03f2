// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// NOLINTBEGIN(bugprone-suspicious-include)
#include "../../samples/player/mesh.cpp"
#include "../../samples/player/mesh_field.cpp"
#include "../../samples/player/mesh_pan.cpp"
// NOLINTEND(bugprone-suspicious-include)
