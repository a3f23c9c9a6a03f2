// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "mesh.h"

namespace thaw::player {

// A sitting hare about 0.12 m high, centred: a body, a head, two ears, paws and a tail, run into one another. Closed,
// some 20,000 triangles of a surface 0 found by marching tetrahedra. Always the same; it shades itself from every side.
scene::TriMesh makeHare();

} // namespace thaw::player
