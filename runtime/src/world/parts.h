// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/tasks.h"
#include "base/types.h"
#include "geometry/mesh_fill.h"

#include <string>
#include <vector>

namespace thaw {

// Index of the material of each point of a body: its own, or that of the last part which holds the point. body: the
// cleaned mesh of the body, place: that of both meshes. On failure `message` names the part.
thawResult assignParts(const thawBodyDef& def, const CleanMesh& body, const Transform& place,
                       const std::vector<Vec3>& points, Tasks& tasks, std::vector<uint8_t>& material,
                       std::string& message);

} // namespace thaw
