// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// The scene reader and writer belong to the player's program; the tests compile them once more to call them directly.
// NOLINTBEGIN(bugprone-suspicious-include)
#include "../../samples/player/camera.cpp"
#include "../../samples/player/scene_read.cpp"
#include "../../samples/player/scene_write.cpp"
// NOLINTEND(bugprone-suspicious-include)
